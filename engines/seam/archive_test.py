"""A saved scene goes on as if it had not been saved, from every archive that YADE writes.

To the last bit, as long as the list of contacts keeps its order. YADE does not save its collider: after a load it looks
for pairs at once, so later contacts are listed, and their forces added, in another order.
"""

import numpy as np
import pytest
from disks import engine, everything, run, shaken_bed
from yade import O

BEFORE, AFTER = 4000, 1000
ENDINGS = ["yade", "yade.gz", "xml", "xml.gz", "xml.bz2"]
LABELS = ["shake", "spin", "drum", "bins", "gauss"]


def snapshot():
    drives = [engine(label).dict() for label in LABELS[:3]]
    binners = [engine(label) for label in LABELS[3:]]
    contacts = sorted(
        (i.id1, i.id2, *i.phys.slip, *i.phys.normalForce, *i.phys.shearForce, i.phys.slipping, i.phys.effectiveMass)
        for i in O.interactions
        if i.isReal
    )
    sums = [(b.samples, list(b.normalForce), list(b.tangentialForceVariance), *b.force, *b.torque) for b in binners]
    return everything().tolist(), contacts, sums, drives


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    """The bed saved in every way, with what it was then, some steps later, and at the end."""
    folder = tmp_path_factory.mktemp("archives")
    shaken_bed()
    run(BEFORE)
    for ending in ENDINGS:
        O.save(str(folder / f"bed.{ending}"), quiet=True)
    states = [snapshot()]
    for steps in (5, AFTER - 5):
        run(steps)
        states.append(snapshot())
    return folder, states


def load(saved, ending):
    O.reset()
    O.load(str(saved[0] / f"bed.{ending}"), quiet=True)
    assert O.iter == BEFORE


def test_the_bed_is_worth_the_test(saved):
    _, contacts, sums, drives = saved[1][-1]
    touching = np.array(contacts)
    assert len(touching) > 20
    assert np.any(touching[:, 2:5] != 0) and np.any(touching[:, 11])  # springs, some slipping
    assert all(s[0] > 0 and any(s[1]) for s in sums)
    assert all(abs(d["work"]) > 0 for d in drives)


@pytest.mark.parametrize("ending", ENDINGS)
def test_a_loaded_scene_is_the_saved_one_and_goes_on_to_the_last_bit(saved, ending):
    load(saved, ending)
    assert snapshot() == saved[1][0]
    run(5)
    assert snapshot() == saved[1][1]


@pytest.mark.parametrize("ending", ENDINGS)
def test_every_archive_leads_to_the_same_end(saved, ending):
    ends = []
    for one in ("yade", ending):
        load(saved, one)
        run(AFTER)
        ends.append(snapshot())
    assert ends[0] == ends[1]


def test_the_order_of_contacts_costs_round_off_only(saved):
    load(saved, "xml")
    run(AFTER)
    bodies, _, sums, drives = snapshot()
    expected = saved[1][2]
    # Round-off of 1e-16 grows by collisions, in 1,000 steps by less than six digits.
    np.testing.assert_allclose(bodies, expected[0], rtol=0, atol=1e-10)
    for drive, other in zip(drives, expected[3]):
        assert drive["work"] == pytest.approx(other["work"], rel=1e-9)
    for mine, other in zip(sums, expected[2]):
        assert mine[0] == other[0]
        np.testing.assert_allclose(mine[1], other[1], rtol=1e-9, atol=1e-9)


def test_saving_does_not_disturb_the_run(saved):
    shaken_bed()
    run(BEFORE + AFTER)
    assert snapshot() == saved[1][2]


def test_the_memory_of_yade_holds_scenes_too(saved):
    load(saved, "yade")
    O.saveTmp("half", quiet=True)
    O.reset()
    O.loadTmp("half", quiet=True)
    assert snapshot() == saved[1][0]
    run(5)
    assert snapshot() == saved[1][1]


def test_a_truncated_archive_is_an_error_and_no_crash(tmp_path):
    shaken_bed()
    O.save(str(tmp_path / "bed.xml"), quiet=True)
    whole = (tmp_path / "bed.xml").read_text()
    (tmp_path / "half.xml").write_text(whole[: len(whole) // 2])
    with pytest.raises(RuntimeError, match="input stream error"):
        O.load(str(tmp_path / "half.xml"), quiet=True)
    shaken_bed()
    run(10)


def test_loaded_attributes_are_checked(tmp_path):
    shaken_bed()
    O.save(str(tmp_path / "bed.xml"), quiet=True)
    text = (tmp_path / "bed.xml").read_text()
    assert text.count("<period>5.0") == 1
    (tmp_path / "bed.xml").write_text(text.replace("<period>5.0", "<period>-5.0"))
    with pytest.raises(Exception, match="period must be positive"):
        O.load(str(tmp_path / "bed.xml"), quiet=True)
    O.reset()
