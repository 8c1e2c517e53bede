"""A student's answer, judged: exercises, their properties, and a process apart for code that is not trusted. Knows no rods."""
