"""What is bent: the link, the strut, its loads. Knows no solver of equations."""
