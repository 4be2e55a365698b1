"""What the books of measured settings say of a study, as a paragraph of its help."""

from ..base.columns import aligned
from . import book as books
from .effects import CONFIDENCE
from .words import in_words


def measured_trade(study):
    """Return a table for each book of a study: what settings change of the headline, and what they cost; "" without a book."""
    return "\n\n".join(told(made, study.headline.name) for made in books.of_study(study)) if study.headline else ""


def told(made, observable):
    """Return the lines of one book."""
    start = made.settings[0]
    heading = (
        f"measured trade ({made.file}: {made.in_words()}; reference {in_words(sorted(made.reference.items()))},"
        f" {start.core_seconds:.3g} core-seconds)"
    )
    rows = [("  setting", "cost", f"change of {observable} [%]", "one run off by less than [%]")]
    for setting in made.settings:
        effect = setting.effects.get(observable)
        if effect is None:
            continue
        change = f"{100 * effect.bias:.2g} ± {100 * effect.interval(CONFIDENCE):.2g}" if setting.levers else "-"
        share = setting.core_seconds / start.core_seconds
        bound = f"{100 * effect.bound(CONFIDENCE):.2g}"
        rows.append((f"  {in_words(sorted(setting.levers.items()))}", f"{share:.2f}", change, bound))
    return f"{heading}\n{aligned(rows)}"
