"""Fixtures that tests of one study in several files share."""

import drum_study
import pytest


@pytest.fixture(scope="session")
def drum_cache(tmp_path_factory):
    """A cache of poured drums that all tests of the drum study share."""
    return tmp_path_factory.mktemp("drums")


@pytest.fixture
def drum(monkeypatch, drum_cache):
    """The drum study as a module, in this process."""
    return drum_study.module(monkeypatch, drum_cache)
