"""Names of run folders that a person can read: the study, what was given or varies, and a short digest where that is not all."""

LONGEST = 96  # characters
DIGITS = 8  # of a digest


def readable(first, told, digest=""):
    """Return `first-key=value-…` of a list of (key, text), as many whole pairs as `LONGEST` allows, then a digest if given.

    Signs that a shell or a path reads in its own way become `_`.
    """
    ending = f"-{digest[:DIGITS]}" if digest else ""
    name = plain(first)
    for key, text in told:
        longer = f"{name}-{plain(f'{key}={text}')}"
        if len(longer) + len(ending) > LONGEST:
            break
        name = longer
    return name + ending


def plain(text):
    """Return a text with only letters, digits and -_.+= in it."""
    return "".join(c if c.isalnum() or c in "-_.+=" else "_" for c in text)
