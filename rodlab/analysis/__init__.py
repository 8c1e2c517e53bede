"""What one asks of any equations F(u, lam) = 0. Knows no rods."""
