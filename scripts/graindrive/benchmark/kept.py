"""Keeps the scenes of the benchmark in the cache: they are made once and read afterwards."""

from ..beds import cache

RECIPE = 2  # version of the scenes; increase it when a scene changes


def kept(name, make):
    """Return the scene of that name, from the cache or by `make()`."""
    made = cache.cached(f"bench-{name}", {"scene": name}, RECIPE, make)
    return dict(made, kind=made["kind"].astype(int))
