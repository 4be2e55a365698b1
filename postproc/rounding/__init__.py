"""Rounding: how runs with numbers of different length drift apart, and which of their averages agree all the same."""
