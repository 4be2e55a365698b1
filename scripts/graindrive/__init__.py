"""Graindrive: forces on bodies driven through granular media, a study package on YADE."""

__version__ = "0.1.0"
