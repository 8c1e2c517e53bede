"""Exercises as students, teachers and other programs meet them: found, read, judged by `grading`, a class, and made."""
