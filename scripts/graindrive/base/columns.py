"""Tables of text for a terminal: columns one under the other."""


def aligned(rows):
    """Return rows of cells as lines of text with aligned columns, without blanks at the ends of lines."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]) - 1)]
    return "\n".join("  ".join([*(cell.ljust(w) for cell, w in zip(row, widths)), row[-1]]).rstrip() for row in rows)
