"""A run's frames as files of other programs."""
