"""The packing cache: one build per key, damaged entries built anew, concurrent builders and read-only places."""

import subprocess
import sys

import numpy as np
import pytest

from graindrive.beds import cache


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.setenv("GRAINDRIVE_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


class Builder:
    """A builder that counts its calls and makes two arrays of different types."""

    def __init__(self):
        self.calls = 0

    def __call__(self):
        self.calls += 1
        return {"x": np.arange(1000) / 7, "id": np.arange(3)}


def test_built_once_and_returned_bit_for_bit(folder):
    build = Builder()
    first = cache.cached("bed", {"seed": 1}, 1, build)
    again = cache.cached("bed", {"seed": 1}, 1, build)
    assert build.calls == 1 and set(again) == {"x", "id"}
    assert all(np.array_equal(first[name], again[name]) and first[name].dtype == again[name].dtype for name in first)
    assert [p.suffix for p in folder.iterdir()] == [".npz"]


@pytest.mark.parametrize(
    "kind, parameters, recipe", [("bed", {"seed": 2}, 1), ("bed", {"seed": 1}, 2), ("lid", {"seed": 1}, 1)]
)
def test_another_key_is_another_entry(kind, parameters, recipe):
    build = Builder()
    cache.cached("bed", {"seed": 1}, 1, build)
    cache.cached(kind, parameters, recipe, build)
    assert build.calls == 2


def truncate(data):
    return data[: len(data) // 2]


def flip(data):
    return data[:300] + bytes([data[300] ^ 255]) + data[301:]


@pytest.mark.parametrize("damage", [truncate, flip, lambda data: b"", lambda data: b"not a zip file at all"])
def test_a_damaged_entry_is_built_anew_with_a_note(folder, damage, capsys):
    build = Builder()
    cache.cached("bed", {}, 1, build)
    (entry,) = folder.iterdir()
    entry.write_bytes(damage(entry.read_bytes()))
    assert np.array_equal(cache.cached("bed", {}, 1, build)["x"], np.arange(1000) / 7)
    assert build.calls == 2 and "is damaged" in capsys.readouterr().err
    cache.cached("bed", {}, 1, build)
    assert build.calls == 2 and capsys.readouterr().err == ""


def test_no_changed_bit_of_an_entry_is_an_error_or_another_array(folder, capsys):
    """Change the lowest bit of each byte: flags of encryption and compression, versions, names, sizes, contents."""
    cache.cached("bed", {}, 1, lambda: dict(x=np.arange(2.0)))
    (entry,) = folder.iterdir()
    whole, refused = entry.read_bytes(), 0
    for at in range(len(whole)):
        entry.write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :])
        found = cache.load(entry)
        refused += found is None
        assert found is None or np.array_equal(found["x"], [0, 1])
    assert refused > 200 and capsys.readouterr().err.count("building it again") == refused


def test_an_array_in_place_of_an_entry_is_damage(folder, capsys):
    build = Builder()
    cache.cached("bed", {}, 1, build)
    (entry,) = folder.iterdir()
    with open(entry, "wb") as file:
        np.save(file, np.zeros(3))
    assert len(cache.cached("bed", {}, 1, build)) and build.calls == 2
    assert "is damaged" in capsys.readouterr().err


def test_an_unwritable_cache_costs_a_note_not_the_run(tmp_path, monkeypatch, capsys):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("GRAINDRIVE_CACHE", str(tmp_path / "file"))
    assert cache.cached("bed", {}, 1, Builder())["id"].sum() == 3
    assert "cannot write cache" in capsys.readouterr().err


def test_a_build_that_fails_leaves_nothing(folder):
    with pytest.raises(ZeroDivisionError):
        cache.cached("bed", {}, 1, lambda: 1 / 0)
    assert list(folder.iterdir()) == []


BUILD = """
import sys, numpy, graindrive.beds.cache as c
def build():
    print("building", flush=True)
    sys.stdin.read()
    return {"x": numpy.ones(10**6)}
print(c.cached("bed", {}, 1, build)["x"].sum(), flush=True)
"""


def builder():
    """Start a process that requests the entry. If it has to build it, it prints this and waits for the end of its input."""
    pipes = dict(stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    return subprocess.Popen([sys.executable, "-c", BUILD], **pipes)


def test_of_builders_at_the_same_time_one_builds_and_the_others_wait(folder):
    processes = [builder() for _ in range(4)]
    for process in processes:
        process.stdin.close()
        process.stdin = None  # for communicate
    words = [process.communicate()[0].split() for process in processes]
    assert [w[-1] for w in words] == ["1000000.0"] * 4
    assert sum("building" in w for w in words) == 1
    assert [p.suffix for p in folder.iterdir()] == [".npz"]


def test_a_builder_that_is_killed_blocks_nobody(folder):
    first = builder()
    assert first.stdout.readline() == "building\n"
    second = builder()
    assert "is being made by another run; waiting for it" in second.stderr.readline()
    first.kill()
    assert second.communicate("")[0].split() == ["building", "1000000.0"]
    first.communicate()


def test_the_folder_follows_the_environment(monkeypatch, tmp_path):
    assert cache.cache_folder().name == "cache"
    monkeypatch.delenv("GRAINDRIVE_CACHE")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert cache.cache_folder() == tmp_path / "graindrive"
