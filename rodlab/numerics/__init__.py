"""Linear algebra and quadrature. Knows no rods."""
