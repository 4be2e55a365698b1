"""Settings of levers in words, as one would type them."""


def in_words(setting):
    """Return a setting, a tuple of (lever, value), as one would type it; "reference" for the empty one."""
    return " ".join(f"{key}={shown(value)}" for key, value in setting) or "reference"


def shown(value):
    """Return a lever's value as one would type it."""
    if value is None:
        return "auto"
    return f"{value:g}" if isinstance(value, (int, float)) else value
