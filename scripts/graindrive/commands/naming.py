"""Makes readable names of run folders: the study, the keys given or varied, and a short digest if this is not all."""

LONGEST = 96  # characters
DIGITS = 8  # of a digest


def readable(first, told, digest=""):
    """Return `first-key=value-…` for a list of (key, text), with as many whole pairs as `LONGEST` allows, and the digest.

    Characters with a special meaning in a shell or a path become `_`.
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
