"""No module of the package imports itself through others, neither at its top nor inside a function."""

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
