"""film=1: the film is made when the run has ended; a run whose film cannot be made is refused before it begins."""

from dataclasses import replace

import pytest

from graindrive.base.errors import UsageError
from graindrive.commands import headless
from graindrive.commands.command_line import parse
from graindrive.parameters import StudyParameters, quantity
from graindrive.postproc import films
from graindrive.study import Study, house, loaded


class Keys(StudyParameters):
    frames: int = quantity(1, "-", "pictures", ge=1)


class Made:
    """A study that records its runs and its films."""

    def __init__(self):
        self.done = []
        self.study = Study("made_up", Keys, {"demo": {}}, run=self.run, film=self.film)

    def run(self, p, folder):
        self.done.append("run")

    def film(self, path):
        self.done.append("film")
        (path / films.NAME).write_bytes(b"a film")


def call(study, tmp_path, *arguments):
    """Run the study as its command does; return the exit code."""
    p = parse(study, [f"out={tmp_path}/run", *arguments], environment={})
    return headless.guarded(lambda: headless.carry_out(study, p), study.name)


def test_a_run_is_filmed_once_it_is_done_and_found_again_where_the_film_is_missing(tmp_path):
    made = Made()
    assert call(made.study, tmp_path, "film=1", "frames=2") == 0 and made.done == ["run", "film"]
    assert call(made.study, tmp_path, "film=1", "frames=2") == 0 and made.done == ["run", "film"]
    (tmp_path / "run" / films.NAME).unlink()
    assert call(made.study, tmp_path, "film=1", "frames=2") == 0 and made.done == ["run", "film", "film"]


def test_no_film_is_made_unasked(tmp_path):
    made = Made()
    assert call(made.study, tmp_path, "frames=2") == 0 and made.done == ["run"]


@pytest.mark.parametrize(
    "changes, arguments, words",
    [
        ({}, ["frames=1"], "film=1 needs frames=2 or more, got frames=1; frames=200 makes 10 s"),
        ({"film": None}, ["frames=9"], "film=1: runs of made_up cannot be filmed; leave it out"),
    ],
)
def test_a_film_that_cannot_be_is_refused_before_the_run(tmp_path, capsys, changes, arguments, words):
    made = Made()
    assert call(replace(made.study, **changes), tmp_path, "film=1", *arguments) == 2
    assert words in capsys.readouterr().err and made.done == [] and not (tmp_path / "run").exists()


def test_a_missing_ffmpeg_is_told_before_the_run(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(films.FFMpegWriter, "isAvailable", lambda: False)
    made = Made()
    assert call(made.study, tmp_path, "film=1", "frames=9") == 2 and made.done == []
    assert "install Debian's package ffmpeg" in capsys.readouterr().err


@pytest.mark.parametrize("name, filmed", [("magnus", True), ("wiggle", True), ("shear", False)])
def test_the_house_knows_which_studies_have_films(name, filmed):
    study = loaded(house()[name])
    p = parse(study, ["film=1"] + ["frames=9"] * ("frames" in study.parameters.__fields__), environment={})
    if filmed:
        films.require_possible(study, p)
    else:
        with pytest.raises(UsageError, match=f"runs of {name} cannot be filmed"):
            films.require_possible(study, p)
