"""Scenes: YADE's archives of them are written to memory, and scenes that no loop can compute are refused."""

import gzip
import tempfile
from contextlib import contextmanager

import pytest

pytest.importorskip("yade")

from graindrive.scenes import scene  # noqa: E402
from graindrive.base.errors import UsageError  # noqa: E402
from graindrive.scenes.material import HertzHistoryMaterial  # noqa: E402

MATERIAL = HertzHistoryMaterial(2e6, 2.46e6, 2500, 2500, 0.1, 1.0)


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


@pytest.mark.parametrize("loop", ["grain", "yade"])
@pytest.mark.parametrize("width, fits", [(4, False), (4.1, True)])
def test_a_disk_that_another_could_touch_through_two_images_is_refused(loop, width, fits):
    from yade import O

    scene.start(width, 10)
    scene.add_disks([width / 2, 0.0], [1, 1], [1.5, 0.51], 1.0)
    O.dt = 1e-6
    if fits:
        scene.run_on(loop, MATERIAL, 0.0)
        return
    with pytest.raises(UsageError, match="the period in x must be at least 4.02, got 4"):
        scene.run_on(loop, MATERIAL, 0.0)
