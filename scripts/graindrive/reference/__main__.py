"""The command `scripts/docs`: writes the folder that Sphinx reads, and has Sphinx make HTML of it; a broken link is an error."""

import importlib.util
import sys
from pathlib import Path

from ..base.errors import UsageError

PACKAGES = {
    "sphinx": "python3-sphinx",
    "myst_parser": "python3-myst-parser",
    "pandas": "python3-pandas",
}  # module -> Debian package


def missing():
    """Return the Debian packages that are needed and not here."""
    return [package for module, package in PACKAGES.items() if importlib.util.find_spec(module) is None]


def build(folder):
    """Make the HTML in `folder`; return Sphinx's exit code, 0 where there was not one warning."""
    if packages := missing():
        raise UsageError(
            f"needs Debian's {' and '.join(packages)}: apt-get install --no-install-recommends {' '.join(packages)}"
        )
    from sphinx.cmd.build import main as sphinx

    from . import sources

    sources.write(folder / ".sources")
    strict = ["-n", "-W", "--keep-going", "-q"]
    return sphinx([*strict, "-b", "html", "-d", str(folder / ".doctrees"), str(folder / ".sources"), str(folder)])


def main(arguments):
    """Build into the folder that the one argument names; return the exit code."""
    (folder,) = map(Path, arguments)
    try:
        code = build(folder)
    except UsageError as error:
        print(f"scripts/docs: error: {error}", file=sys.stderr)
        return 2
    print(
        f"scripts/docs: see {folder / 'index.html'}" if code == 0 else "scripts/docs: mend what is above",
        file=sys.stderr,
    )
    return code


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
