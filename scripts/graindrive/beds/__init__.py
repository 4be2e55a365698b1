"""Packings of grains, made once and kept in a cache."""
