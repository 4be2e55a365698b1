"""Scenes as checkpoints keep them: what YADE writes goes through memory, not through a disk that may be full."""

import gzip
import tempfile
from contextlib import contextmanager

import pytest

pytest.importorskip("yade")

from graindrive import scene  # noqa: E402


def test_yades_scene_is_saved_through_memory(tmp_path, monkeypatch):
    from yade import O, utils

    @contextmanager
    def kept():
        yield str(tmp_path)

    O.reset()
    O.bodies.append(utils.sphere((0, 0, 0), 1))
    O.save(str(tmp_path / "expected.yade.gz"), True)
    monkeypatch.setattr(tempfile, "TemporaryDirectory", kept)
    saved = scene.saved_by_yade()
    O.reset()
    assert gzip.decompress(saved) == gzip.decompress((tmp_path / "expected.yade.gz").read_bytes())
    assert (tmp_path / scene.YADES_FILE).is_symlink(), "O.save never returns from a disk that is full"
