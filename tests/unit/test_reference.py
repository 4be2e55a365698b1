"""The HTML reference: docstrings as text, every attribute of every engine, and errors for broken links."""

import importlib.util

import pytest

from graindrive import engines
from graindrive.base import attribute_help
from graindrive.base.errors import UsageError
from graindrive.reference import __main__ as docs
from graindrive.reference import docstrings, pages, sources

needs_sphinx = pytest.mark.skipif(
    not all(map(importlib.util.find_spec, docs.PACKAGES)), reason=f"needs {' and '.join(docs.PACKAGES.values())}"
)


# ---- attributes ------------------------------------------------------------------------------------------------------


def attribute(cls, name):
    return next(a for a in attribute_help.attributes_of(cls) if a.name == name)


def test_an_attribute_has_type_unit_default_and_whether_it_can_be_set():
    velocity = attribute(engines.SpinTranslateDrive, "velocity")
    assert (velocity.type, velocity.unit, velocity.default, velocity.settable) == (
        "Vector3",
        "m/s",
        "Vector3(0,0,0)",
        True,
    )
    positions = attribute(engines.GrainLoop, "positions")  # it has no value before the loop is in O.engines
    assert (positions.type, positions.unit, positions.default, positions.settable) == ("", "m", "", False)
    assert positions.in_words() == "read only"


@pytest.mark.parametrize("cls", engines.classes(), ids=lambda cls: cls.__name__)
def test_what_is_told_of_an_attribute_is_so(cls):
    """Every attribute can be set to its default if it says so, and cannot be set at all if not."""
    fresh = cls()
    for told in attribute_help.attributes_of(cls):
        if told.type == "NoneType":
            continue  # the default is an empty value, which cannot be assigned
        if told.settable:
            setattr(fresh, told.name, getattr(cls(), told.name))
            assert repr(getattr(fresh, told.name)) == told.default, told.name
        else:
            with pytest.raises(AttributeError, match="can't set attribute|has no setter|read.only"):
                setattr(fresh, told.name, 0)


def test_help_tells_it_beside_the_meaning_and_only_once():
    documented = engines.OscillationDrive.amplitude.__doc__
    attribute_help.extend([engines.OscillationDrive])
    assert documented == engines.OscillationDrive.amplitude.__doc__
    assert documented.endswith("\n(type float, default 0.0, can be set)") and "of displacement [m]" in documented
    assert "(type" not in attribute(engines.OscillationDrive, "amplitude").meaning


def test_the_page_of_engines_has_a_row_for_every_attribute_of_every_class():
    page = pages.engines_page()
    for cls in engines.classes():
        section = page.split(f"py:class:: graindrive.engines.{cls.__name__}(")[1].split(".. py:class::")[0]
        rows = {line.split("* - ")[1] for line in section.splitlines() if "* - " in line}
        assert {a.name for a in attribute_help.attributes_of(cls)} <= rows, cls.__name__
    assert "py:function:: graindrive.engines.contact_laws(" in page


# ---- docstrings ------------------------------------------------------------------------------------------------------


def test_marks_in_a_docstring_stay_as_they_are_but_for_code():
    assert docstrings.escaped("F_n = *k* |d| `p_1`, Law2_") == r"F\_n = \*k\* \|d\| ``p_1``\ , Law2\_"
    assert (
        docstrings.escaped("every `syncEvery`\nsteps") == "every ``syncEvery``\nsteps"
    )  # "\\ " takes a blank or line break away


def test_a_formula_keeps_its_lines_and_a_sentence_does_not():
    text = "Return it.\n\n  F = k x\n  U = F x/2\n\nA sentence\nof two lines."
    rst = docstrings.as_rst(text)
    assert rst == [
        "Return it.",
        "",
        "::",
        "",
        "      F = k x",
        "      U = F x/2",
        "",
        "A sentence",
        "of two lines.",
        "",
    ]


# ---- pages -----------------------------------------------------------------------------------------------------------


def checkout(folder, guide):
    """Make a folder with those files of a checkout that the reference reads."""
    for page in sources.READMES:
        (folder / page).parent.mkdir(parents=True, exist_ok=True)
        (folder / page).write_text("# A page\n")
    (folder / "studies" / "guides").mkdir()
    (folder / "studies" / "guides" / "README.md").write_text(guide)
    (folder / "picture.png").touch()
    return folder


def test_pages_are_copied_with_what_they_show_and_link_to(tmp_path, monkeypatch):
    monkeypatch.setattr(sources, "modules", lambda: ["graindrive.base.errors"])
    top = checkout(
        tmp_path / "top",
        "# Guides\n![p](../../picture.png) [l](../../LICENSE) [o](../../own.md#a) [w](https://x.y/z.md)\n",
    )
    (top / "LICENSE").write_text("free\n")
    (top / "own.md").write_text("# A\n")
    sources.write(tmp_path / "made", top)
    names = {
        path.relative_to(tmp_path / "made").as_posix() for path in (tmp_path / "made").rglob("*") if path.is_file()
    }
    assert names == {
        *sources.READMES,
        "studies/guides/README.md",
        "picture.png",
        "LICENSE",
        "own.md",
        "conf.py",
        "engines.rst",
        "package/base.rst",
        "index.md",
    }
    listed = (tmp_path / "made/index.md").read_text().splitlines()
    assert {"README", "studies/guides/README", "engines", "package/base", "own"} <= set(listed)


def test_every_module_but_programs_is_in_a_room():
    found = pages.rooms(sources.modules())
    assert "graindrive.beds.lid" in found["beds"] and "graindrive.postproc.drum.flow" in found["postproc.drum"]
    assert "graindrive.postproc.reader" in found["postproc"] and not any(
        "__main__" in m for ms in found.values() for m in ms
    )


@needs_sphinx
@pytest.mark.parametrize(
    "link, broken",
    [
        ("[a](../../own.md#two)", False),
        ("[a](../../gone.md)", True),
        ("[a](../../own.md#gone)", True),
        ("![a](gone.png)", True),
    ],
)
def test_a_link_that_leads_nowhere_is_an_error(tmp_path, monkeypatch, link, broken):
    from sphinx.cmd.build import main as sphinx

    monkeypatch.setattr(sources, "modules", lambda: [])
    monkeypatch.setattr(pages, "engines_page", lambda: "Engines\n=======\n")
    top = checkout(tmp_path / "top", f"# Guides\n{link} [b](../../own.md)\n")
    (top / "own.md").write_text("# One\n## Two\n")
    sources.write(tmp_path / "made", top)
    code = sphinx(["-n", "-W", "-q", "-b", "html", str(tmp_path / "made"), str(tmp_path / "html")])
    assert (code != 0) is broken


def test_missing_packages_are_named(monkeypatch, capsys, tmp_path):
    monkeypatch.setattr(docs, "PACKAGES", {"sphinks": "python3-sphinks", "sys": "python3-sys"})
    assert docs.main([str(tmp_path / "docs")]) == 2
    assert (
        "needs Debian's python3-sphinks: apt-get install" in capsys.readouterr().err
        and not (tmp_path / "docs").exists()
    )


def test_without_guides_it_is_no_checkout(tmp_path):
    with pytest.raises(UsageError, match="call scripts/docs in a checkout"):
        sources.write(tmp_path / "made", tmp_path)
