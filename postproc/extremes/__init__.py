"""Runs and campaigns of the study of extremes: one case's figure, and the table of all cases."""
