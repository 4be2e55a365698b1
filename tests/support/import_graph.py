"""Which module of the package imports which, read from their text."""

import ast
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
FOLDERS = {"graindrive": TOP / "scripts" / "graindrive", "graindrive.postproc": TOP / "postproc"}


def modules_of(folders):
    """Return {full name: file} of all modules below folders, {name of a package: its folder}."""
    found = {}
    for package, folder in folders.items():
        for file in folder.rglob("*.py"):
            parts = file.relative_to(folder).with_suffix("").parts
            found[".".join([package, *(parts[:-1] if parts[-1] == "__init__" else parts)])] = file
    return found


def imports_of(name, file):
    """Yield the full names that the module `name` imports anywhere in its text, `from a import b` as a and as a.b."""
    package = name if file.name == "__init__.py" else name.rpartition(".")[0]
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package.split(".")[: len(package.split(".")) + 1 - node.level] if node.level else []
            base = ".".join([*above, *([node.module] if node.module else [])])
            yield base
            yield from (f"{base}.{alias.name}" for alias in node.names)


def graph_of(folders):
    """Return {module: set of modules of the folders that it imports}; a package that it lies in does not count."""
    files = modules_of(folders)
    wanted = {name: set(imports_of(name, file)) & set(files) for name, file in files.items()}
    return {name: {w for w in found if not f"{name}.".startswith(f"{w}.")} for name, found in wanted.items()}


def circles(graph):
    """Return the cycles of a graph, each as the sorted list of modules that import themselves through each other."""

    def reached(start):
        seen, waiting = set(), list(graph[start])
        while waiting:
            name = waiting.pop()
            waiting += [] if name in seen else graph[name]
            seen.add(name)
        return seen

    reach = {name: reached(name) for name in graph}
    found = {tuple(sorted(other for other in reach[name] if name in reach[other])) for name in graph}
    return sorted(list(circle) for circle in found if circle)
