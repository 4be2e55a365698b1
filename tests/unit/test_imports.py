"""No module imports itself through others, at its top or inside a function; YADE is found by any import after the package's."""

import subprocess
import sys

import pytest
from import_graph import FOLDERS, circles, graph_of


def test_no_module_imports_itself_through_others():
    graph = graph_of(FOLDERS)
    assert len(graph) > 60 and "graindrive.runs.run_data" in graph["graindrive.postproc.reader"], "the imports are read"
    assert circles(graph) == []


@pytest.mark.parametrize("second", ["from .a import x\n", "def f():\n    from . import a\n", "import p.a\n"])
def test_a_circle_is_found_at_the_top_and_inside_a_function(tmp_path, second):
    for name, text in {"__init__": "", "a": "from . import b, c\n", "b": second, "c": ""}.items():
        (tmp_path / f"{name}.py").write_text(text)
    assert circles(graph_of({"p": tmp_path})) == [["p.a", "p.b"]]


@pytest.mark.parametrize("first", ["", "from graindrive import engines"])
def test_yade_is_found_without_a_word_after_the_package_in_any_order(first):
    lines = [
        "import graindrive",
        first,
        "from yade import O",
        "from graindrive import engines",
        "print(O.iter, engines.GrainLoop)",
    ]
    code = "\n".join(lines)
    ended = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert (ended.returncode, ended.stdout) == (0, "0 <class 'graindrive._engines.GrainLoop'>\n"), ended.stderr
