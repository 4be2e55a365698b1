"""Driven bodies: outlines of beads, and solids by distance."""
