"""Runs one scene with several number types."""
