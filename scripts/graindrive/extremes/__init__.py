"""Extremes: small cases at the ends of what scenes may hold, each with a closed form to compare with or a guard to meet."""
