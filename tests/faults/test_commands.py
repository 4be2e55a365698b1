"""The commands of scripts/: messages and exit codes when something is missing, wrong, busy or interrupted.

A miniature checkout (the real scripts, an empty CMake project) and stand-ins for Debian's programs make every fault
cheap to provoke; nothing here installs anything.
"""

import os
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
NO_PACKAGES = {"GRAINDRIVE_NO_PACKAGES": "1"}
# The target of runs, and one that only tests have. Each makes a file, so that a test can check what was built.
MINIATURE = """cmake_minimum_required(VERSION 3.25)
project(miniature LANGUAGES NONE)
add_custom_command(OUTPUT module COMMAND ${CMAKE_COMMAND} -E touch module)
add_custom_target(_engines DEPENDS module)
if(GRAINDRIVE_TESTS)
  add_custom_command(OUTPUT cpp_tests COMMAND ${CMAKE_COMMAND} -E touch cpp_tests)
  add_custom_target(cpp_programs ALL DEPENDS module cpp_tests)
endif()
"""


@pytest.fixture
def checkout(tmp_path):
    """A checkout with the real scripts, two studies and nothing to compile."""
    top = tmp_path / "checkout"
    (top / "studies").mkdir(parents=True)
    shutil.copytree(ROOT / "scripts", top / "scripts", ignore=shutil.ignore_patterns("__pycache__"))
    (top / "CMakeLists.txt").write_text(MINIATURE)
    (top / "studies" / "wiggle.py").write_text(
        '"""A triangle that wiggles."""\nimport sys\nsys.exit(int(sys.argv[1]))\n'
    )
    (top / "studies" / "magnus.py").write_text('"""A disk that spins."""\n')
    return top


@pytest.fixture
def stand_in(tmp_path):
    """A function that replaces a program on PATH by a shell script; the environment to use is its attribute."""
    folder = tmp_path / "stand-ins"
    folder.mkdir()

    def put(program, body):
        (folder / program).write_text(f"#!/bin/sh\n{body}\n")
        (folder / program).chmod(0o755)

    put.environment = {"PATH": f"{folder}:/usr/bin:/bin:/usr/sbin:/sbin"}
    return put


def call(checkout, *command, environment=NO_PACKAGES, **options):
    """Run `scripts/…` of the miniature checkout; returns the finished process with its text."""
    surroundings = {name: value for name, value in os.environ.items() if not name.startswith("GRAINDRIVE_")}
    return subprocess.run(
        [checkout / "scripts" / command[0], *command[1:]],
        env=surroundings | environment,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=60,
        **options,
    )


def test_run_alone_lists_studies_with_their_first_line(checkout):
    done = call(checkout, "run")
    assert done.returncode == 0
    assert "wiggle" in done.stdout and "A triangle that wiggles." in done.stdout


def test_unknown_study_names_the_nearest_and_sets_nothing_up(checkout):
    done = call(checkout, "run", "wigle")
    assert done.returncode == 2
    assert "'wigle'" in done.stderr and "did you mean 'wiggle'?" in done.stderr and "magnus wiggle" in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (checkout / "build").exists()


@pytest.mark.parametrize("threads", ["0", "two", "-1"])
def test_run_refuses_threads_that_are_no_number(checkout, threads):
    done = call(checkout, "run", "wiggle", environment={"GRAINDRIVE_THREADS": threads})
    assert done.returncode == 2 and f"got '{threads}'" in done.stderr


@pytest.mark.parametrize("study", ["wiggle", "wiggle.py", "studies/wiggle.py"])
@pytest.mark.parametrize("code", [0, 3])
def test_run_passes_the_exit_code_of_the_study(checkout, study, code):
    assert call(checkout, "run", study, str(code)).returncode == code


def test_second_setup_says_nothing_and_is_quick(checkout):
    assert call(checkout, "setup").returncode == 0
    begin = time.monotonic()
    done = call(checkout, "setup")
    assert time.monotonic() - begin < 3  # a set-up that has nothing to do must be quick [s]
    assert done.returncode == 0 and done.stdout == done.stderr == ""


def test_two_setups_at_once_both_end_well(checkout):
    together = [subprocess.Popen([checkout / "scripts" / "setup"], env=os.environ | NO_PACKAGES) for _ in range(2)]
    assert [one.wait(60) for one in together] == [0, 0]


def test_moved_checkout_is_configured_anew(checkout):
    call(checkout, "setup")
    moved = checkout.rename(checkout.with_name("moved"))
    done = call(moved, "setup")
    assert done.returncode == 0 and "has moved" in done.stderr
    assert str(moved) in (moved / "build" / "CMakeCache.txt").read_text()


def test_settings_reach_cmake_once(checkout):
    assert "configuring" in call(checkout, "setup", "-DCOLOUR=blue").stderr
    assert "COLOUR:UNINITIALIZED=blue" in (checkout / "build" / "CMakeCache.txt").read_text()
    assert call(checkout, "setup", "-DCOLOUR=blue").stderr == ""


def test_unknown_option_is_refused(checkout):
    done = call(checkout, "setup", "--fast")
    assert done.returncode == 2 and "--fast" in done.stderr
    assert not (checkout / "build").exists()


def test_failed_download_names_the_way_out(checkout, stand_in):
    stand_in("dpkg-query", "exit 1")
    stand_in("dpkg", "exit 0")
    stand_in("sudo", '"$@"')
    stand_in("apt-get", "echo 'E: Failed to fetch' >&2; exit 100")
    done = call(checkout, "setup", environment=stand_in.environment)
    assert done.returncode == 1
    assert "E: Failed to fetch" in done.stderr and "network" in done.stderr and "apt-get install" in done.stderr


def test_only_missing_packages_are_installed(checkout, stand_in, tmp_path):
    stand_in("dpkg-query", f"sed 's/[ ?#].*//; /^$/d; /^yade/d; s/^/installed /' {checkout}/scripts/packages.txt")
    stand_in("dpkg", "exit 0")
    stand_in("sudo", '"$@"')
    stand_in("apt-get", f'echo "$@" >>{tmp_path}/calls')
    call(checkout, "setup", environment=stand_in.environment)
    update, install = (tmp_path / "calls").read_text().splitlines()
    assert update.endswith("update") and install.endswith("install --no-install-recommends yade")


@pytest.mark.parametrize("group", ["run", "compile"])
def test_compilers_are_installed_first_and_compile_while_the_rest_is_installed(checkout, stand_in, tmp_path, group):
    """The miniature has no target for the early compilation: that fails, and the build goes on. `compile` builds nothing."""
    stand_in(
        "dpkg-query",
        f"sed 's/[ ?#].*//; /^$/d; /^g++/d; /^python3-yade/d; s/^/installed /' {checkout}/scripts/packages.txt",
    )
    stand_in("dpkg", "exit 0")
    stand_in("sudo", '"$@"')
    stand_in("apt-get", f'echo "${{@#*=}}" | sed "s/.*recommends //" >>{tmp_path}/calls')
    done = call(checkout, "setup", group, environment=stand_in.environment)
    assert done.returncode == 0, done.stderr
    installed = (tmp_path / "calls").read_text().splitlines()[1:]
    assert installed == (["g++", "g++ python3-yade"] if group == "run" else ["g++"])
    assert (
        (checkout / "build" / "compile.log").exists()
        == (checkout / "build" / "build.ninja").exists()
        == (group == "run")
    )


def listed_packages():
    """Return [(name, groups, reason)] of scripts/packages.txt."""
    lines = (ROOT / "scripts" / "packages.txt").read_text(encoding="utf-8").splitlines()
    entries = [line.partition("#") for line in lines if line and not line.startswith("#")]
    return [(*(words.split() + ["", ""])[:2], reason.strip()) for words, _, reason in entries]


def test_each_package_is_listed_once_with_groups_that_setup_knows_and_a_reason(checkout):
    packages = listed_packages()
    names = [name.rstrip("?") for name, _, _ in packages]
    assert len(names) == len(set(names)) > 20
    assert all(reason for _, _, reason in packages)
    known = set(call(checkout, "setup", "nonsense").stderr.partition("there are: ")[2].split())
    assert {group for _, groups, _ in packages for group in groups.split(",")} == known - {"nonsense"}


@pytest.fixture
def asked_for(checkout, stand_in, tmp_path):
    """A function that calls a command without any package installed and returns the names that it gives to apt-get."""
    stand_in("dpkg-query", "exit 1")
    stand_in("dpkg", "exit 0")
    stand_in("sudo", '"$@"')
    stand_in("apt-get", f'echo "$@" >>{tmp_path}/calls')

    def names(*command):
        call(checkout, *command, environment=stand_in.environment)
        calls = (tmp_path / "calls").read_text().splitlines()
        (tmp_path / "calls").unlink()
        return [set(line.partition("--no-install-recommends ")[2].split()) for line in calls if " install " in line][-1]

    return names


def test_a_run_installs_nothing_that_only_other_commands_need(asked_for):
    names = asked_for("run", "wiggle", "0")
    assert names == {name for name, groups, _ in listed_packages() if "run" in groups.split(",")}
    assert {"python3-yade", "g++", "python3-h5py"} <= names
    others = "yade lammps liggghts black flake8 clang-format libgtest-dev ffmpeg snakemake python3-vtk9 python3-pytest"
    assert not names & set(others.split())


@pytest.mark.parametrize(
    "command, added",
    [
        (["run", "wiggle", "0", "export=xyz,vtk"], {"python3-vtk9"}),
        (["campaign", "some.yaml"], {"snakemake", "python3-pandas"}),
        (["tune", "help"], {"snakemake", "python3-pandas"}),
        (["bench", "--help"], {"lammps", "liggghts"}),
        (["env"], {"yade", "python3-pandas"}),
        (["setup"], {"yade", "python3-pandas"}),
        (["setup", "film"], {"ffmpeg"}),
        (["setup", "docs"], {"python3-sphinx", "python3-myst-parser", "python3-pandas"}),
    ],
)
def test_a_command_adds_its_own_packages_to_those_of_a_run(asked_for, command, added):
    assert asked_for(*command) - asked_for("run", "wiggle", "0") == added


def test_tests_ask_for_every_package(asked_for):
    assert asked_for("test", "--cpp") == {name.rstrip("?") for name, _, _ in listed_packages()}


def test_style_is_checked_without_a_build(checkout, asked_for):
    assert asked_for("lint") == {"flake8", "black", "clang-format"}
    assert not (checkout / "build" / "CMakeCache.txt").exists()


def test_unknown_group_is_refused(checkout):
    done = call(checkout, "setup", "films")
    assert done.returncode == 2 and "'films'" in done.stderr and "film vtk" in done.stderr
    assert not (checkout / "build").exists()


def test_a_run_builds_no_tests_and_leaves_those_that_were_asked_for(checkout):
    cache, programs = checkout / "build" / "CMakeCache.txt", checkout / "build" / "cpp_tests"
    assert call(checkout, "run", "wiggle", "0").returncode == 0
    assert "GRAINDRIVE_TESTS:UNINITIALIZED=OFF" in cache.read_text()
    assert (checkout / "build" / "module").exists() and not programs.exists()
    assert "configuring" in call(checkout, "setup", "test").stderr and programs.exists()
    programs.unlink()
    assert call(checkout, "setup", "run").stderr == ""  # neither configured nor built anew
    assert not programs.exists()
    assert "configuring" not in call(checkout, "setup", "test").stderr and programs.exists()


def test_a_configuration_that_fails_leaves_the_one_before_it(checkout):
    call(checkout, "setup")
    description = checkout / "CMakeLists.txt"
    description.write_text(MINIATURE + 'if(GRAINDRIVE_TESTS)\n  message(FATAL_ERROR "no GoogleTest")\nendif()\n')
    done = call(checkout, "setup", "test")
    assert done.returncode == 1 and "no GoogleTest" in done.stderr
    assert call(checkout, "setup", "run").returncode == 0


def test_setup_goes_on_without_a_peer_that_cannot_be_had(checkout, stand_in):
    stand_in("dpkg-query", f"sed 's/[ ?#].*//; /^$/d; /^liggghts/d; s/^/installed /' {checkout}/scripts/packages.txt")
    stand_in("dpkg", "exit 0")
    stand_in("sudo", '"$@"')
    stand_in("apt-get", "exit 100")
    done = call(checkout, "setup", "bench", environment=stand_in.environment)
    assert done.returncode == 0 and "going on without liggghts" in done.stderr


def test_no_sudo_tells_what_to_ask_for(checkout, stand_in, tmp_path):
    stand_in("dpkg-query", "exit 1")
    if os.geteuid() == 0:
        pytest.skip("root needs no sudo")
    (tmp_path / "bin").mkdir()
    for program in "bash dirname sed comm sort flock mkdir apt-get".split():
        (tmp_path / "bin" / program).symlink_to(shutil.which(program, path="/usr/bin:/bin"))
    done = call(checkout, "setup", environment={"PATH": f"{tmp_path}/stand-ins:{tmp_path}/bin"})
    assert done.returncode == 1 and "no sudo" in done.stderr and "apt-get install" in done.stderr


def test_read_only_checkout_is_named(checkout):
    (checkout / "build").write_text("")  # a file in place of the folder cannot be written even by root
    done = call(checkout, "setup")
    assert done.returncode == 1 and f"cannot write to {checkout}/build" in done.stderr


def test_interrupted_setup_exits_130_and_the_next_call_completes(checkout, stand_in):
    stand_in("cmake", "sleep 30")
    setup = subprocess.Popen(
        [checkout / "scripts" / "setup"], env=os.environ | NO_PACKAGES | stand_in.environment, start_new_session=True
    )
    time.sleep(0.5)
    os.killpg(setup.pid, signal.SIGINT)  # as Ctrl-C does: to the whole foreground group
    assert setup.wait(20) == 130
    assert call(checkout, "setup").returncode == 0


def test_a_stopped_run_stops_the_study(checkout):
    (checkout / "studies" / "wiggle.py").write_text("import time\nprint('ready', flush=True)\ntime.sleep(60)\n")
    call(checkout, "setup")
    run = subprocess.Popen(
        [checkout / "scripts" / "run", "wiggle"], env=os.environ | NO_PACKAGES, stdout=subprocess.PIPE, text=True
    )
    while "ready" not in run.stdout.readline():
        pass
    run.send_signal(signal.SIGTERM)
    assert run.wait(20) == -signal.SIGTERM  # the study itself, in the place of scripts/run


def test_a_study_hears_by_which_command_it_was_called(checkout):
    """Its help names that command: the path that was typed, or `graindrive run` of an installed tree."""
    (checkout / "studies" / "wiggle.py").write_text("import os\nprint(os.environ['GRAINDRIVE_CALLED'])\n")
    typed, path = call(checkout, "run", "wiggle"), checkout / "scripts" / "run"
    assert typed.stdout.splitlines()[-1] == f"{path} wiggle", typed.stderr
    installed = call(checkout, "run", "wiggle", environment={**NO_PACKAGES, "GRAINDRIVE_COMMAND": "graindrive run"})
    assert installed.stdout.splitlines()[-1] == "graindrive run wiggle"
