"""The continuum solver as a March, and the continuum in a drum."""
