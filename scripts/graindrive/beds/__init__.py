"""Packings of grains, which are made once and stored in a cache."""
