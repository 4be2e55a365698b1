"""The folder that Sphinx reads: the checkout's pages in Markdown with what they show or link to, and pages made of code."""

import re
import shutil
from pathlib import Path

from ..base.errors import UsageError
from . import pages

TOP = Path(__file__).resolve().parents[3]
PACKAGE = {"graindrive": TOP / "scripts" / "graindrive", "graindrive.postproc": TOP / "postproc"}
READMES = (
    "README.md",
    "studies/README.md",
    "scripts/campaigns.md",
    "scripts/accuracy.md",
    "engines/loop/README.md",
    "engines/README.md",
    "scripts/README.md",
    "postproc/README.md",
    "studies/RESULTS.md",
)
LINK = re.compile(r"!?\[[^\]]*\]\((?!\w+:)([^)#\s]+)")
PROGRAMS = ("__main__", "rounding_script", "conf")  # files that do something, or need Sphinx, when they are imported


def write(folder, top=TOP):
    """Make the folder anew; UsageError if the checkout's pages are not there, as where the package is installed."""
    guides = sorted(path.relative_to(top).as_posix() for path in (top / "studies" / "guides").glob("*.md"))
    if not guides:
        raise UsageError(f"there are no guides in {top / 'studies' / 'guides'}; call scripts/docs in a checkout")
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    markdown = with_linked_pages([*READMES, *guides], top)
    for page in markdown:
        copy_with_targets(page, top, folder)
    shutil.copy(Path(__file__).with_name("conf.py"), folder / "conf.py")
    (folder / "engines.rst").write_text(pages.engines_page(), encoding="utf-8")
    made = write_rooms(folder / "package")
    index = next(page for page in guides if page.endswith("README.md"))
    others = [page for page in markdown if page not in (*guides, READMES[0])]
    parts = (READMES[0], index, *(g for g in guides if g != index), "engines.rst", *made, *others)
    (folder / "index.md").write_text(index_page(parts), encoding="utf-8")


def with_linked_pages(markdown, top):
    """Return the pages with all that they link to in Markdown, without end."""
    found = list(markdown)
    for page in found:
        targets = [linked(page, link, top) for link in links(top / page)]
        found += [t for t in dict.fromkeys(targets) if t and t.endswith(".md") and t not in found]
    return found


def links(page):
    """Return the files that a page links to or shows, as it names them."""
    return LINK.findall(page.read_text(encoding="utf-8"))


def linked(page, link, top):
    """Return a link's file from the top of the checkout; None if it is no file there, which Sphinx then says."""
    target = (top / page).parent / link
    inside = target.is_file() and target.resolve().is_relative_to(top)
    return target.resolve().relative_to(top).as_posix() if inside else None


def copy_with_targets(page, top, folder):
    """Copy a page, and the files that it shows or links to, to the same places below `folder`."""
    for file in [page, *(linked(page, link, top) for link in links(top / page))]:
        if file and not (folder / file).exists():
            (folder / file).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(top / file, folder / file)


def modules():
    """Return the full names of the package's modules, programs left out."""
    found = []
    for package, folder in PACKAGE.items():
        for path in sorted(folder.rglob("*.py")):
            parts = path.relative_to(folder).with_suffix("").parts
            if parts[-1] not in PROGRAMS:
                found.append(".".join([package, *(part for part in parts if part != "__init__")]))
    return [name for name in found if name not in PACKAGE and name != "graindrive.engines"]


def write_rooms(folder):
    """Write a page for each room of the package; return their names from the top."""
    folder.mkdir()
    found = pages.rooms(modules())
    for room, members in found.items():
        (folder / f"{room}.rst").write_text(pages.room_page(room, members), encoding="utf-8")
    return [f"package/{room}.rst" for room in found]


def index_page(parts):
    """Return the first page: a list of all others."""
    listed = "\n".join(str(Path(part).with_suffix("")) for part in parts)
    return f"# Graindrive\n\n```{{toctree}}\n:maxdepth: 1\n\n{listed}\n```\n"
