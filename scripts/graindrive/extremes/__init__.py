"""Extremes: small cases at the limits of what scenes may hold; each has a closed form or a guard that must act."""
