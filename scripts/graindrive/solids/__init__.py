"""Solids by distance and normal: how one makes them, joins them, and draws them."""
