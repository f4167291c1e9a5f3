"""The floors of the house: imports go down only, wherever in a file they stand, and there are no cycles.

An import inside a function counts like one at the top: it may save time, but it doesn't turn an arrow round.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.paths import ROOT

# The face (rotorgear/__init__.py) stands just below the command line, which uses it as any user does; __main__ stands above
# all; single modules at the top level are the ground.
GROUND = 0
FACE = 9
ROOF = 11
FLOORS = {
    "files": 0,
    "solvers": 1,
    "uff": 1,
    "records": 1,
    "gears": 2,
    "casings": 2,
    "forces": 2,
    "elements": 3,
    "model": 4,
    "system": 5,
    "results": 6,
    "analysis": 7,
    "rexs": 7,
    "export": 8,
    "plots": 8,
    "plot": 9,
    "page": 9,
    "app": 9,
    "cli": 10,
}


def planned_rooms() -> dict[str, dict[str, set[str]]]:
    """Which room of a floor may import which other one, from the table of CONTRIBUTING.md; "" holds files beside rooms."""
    rooms: dict[str, dict[str, set[str]]] = {}
    page = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    for name, imports in re.findall(r"^\| `([a-z_/]+)` \| .* \| ([a-z_, -]+) \|$", page, re.MULTILINE):
        floor, _, room = name.partition("/")
        rooms.setdefault(floor, {})[room] = set(imports.split(", ")) - {"-"}
    return rooms


ROOMS = planned_rooms()
# Modules that load others by a name which no walk can read in their source, and the package that the name may lead to.
BY_NAME = {
    "rotorgear.forces.registry": "rotorgear.forces",
    "rotorgear.gears.stiffness_models": "rotorgear.gears",
    "rotorgear.cli.commands": "rotorgear.cli",
    "rotorgear.lazy": "rotorgear",  # the loader of the face, which is where its names are listed
    "rotorgear.results.kinds": "rotorgear.results",
    "rotorgear.analysis.accuracy": "rotorgear.analysis",
    "rotorgear.analysis.sweep.cluster": "rotorgear",  # versions of packages, asked for on a worker
}
Arrows = dict[str, dict[str, int]]  # importing module -> imported module -> line


def module_name(file: Path, root: Path) -> str:
    """Return the dotted name of a file below `root`; a package goes by its own name."""
    parts = file.relative_to(root).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imported(node: ast.AST, package: str) -> Iterator[tuple[str, ...]]:
    """Yield what a statement imports, best guess first: `from a.b import c` is a.b.c if that is a module, else a.b."""
    if isinstance(node, ast.Import):
        for alias in node.names:
            yield (alias.name,)
    elif isinstance(node, ast.ImportFrom):
        above = package.split(".")
        start = ".".join(above[: len(above) - node.level + 1]) if node.level else ""
        source = ".".join(filter(None, (start, node.module)))
        for alias in node.names:
            yield (f"{source}.{alias.name}", source)


def arrows(root: Path, package: str = "rotorgear") -> Arrows:
    """Return every import of one module of the package by another, at the top of the file or inside a function."""
    files = {module_name(file, root): file for file in sorted((root / package).rglob("*.py"))}
    found: Arrows = {module: {} for module in files}
    for module, file in files.items():
        inside = module if file.name == "__init__.py" else module.rpartition(".")[0]
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"), str(file))):
            for names in imported(node, inside):
                target = next((name for name in names if name in files), None)
                if target is None and names[-1].split(".")[0] == package:
                    target = names[-1]  # names no file of the package: a mistake that floor_of reports
                if target and target != module:
                    found[module].setdefault(target, getattr(node, "lineno", 0))
    return found


def floor_of(module: str) -> int | None:
    """Return the floor of a module; None for a package that has no floor."""
    parts = module.split(".")
    if len(parts) == 1:
        return FACE
    if parts[1] == "__main__":
        return ROOF
    return FLOORS.get(parts[1], GROUND if len(parts) == 2 else None)


def unknown_modules(graph: Arrows) -> list[str]:
    """List the modules without a floor, and imports of modules that don't exist."""
    homeless = [f"{module} stands on no floor" for module in graph if floor_of(module) is None]
    missing = [
        f"{a}:{line} imports {b}, which is no file"
        for a, bs in graph.items()
        for b, line in bs.items()
        if b not in graph
    ]
    return homeless + missing


def upward_arrows(graph: Arrows) -> list[str]:
    """List the imports that go up a floor."""
    return [
        f"{module}:{line} (floor {floor_of(module)}) imports {target} (floor {floor_of(target)})"
        for module, targets in graph.items()
        for target, line in targets.items()
        if (floor_of(target) or 0) > (floor_of(module) or 0)
    ]


def cycle(graph: dict[str, set[str]]) -> list[str]:
    """Return the nodes of one cycle, the first one repeated at its end; empty where there is none."""
    done: set[str] = set()
    path: list[str] = []

    def walk(node: str) -> list[str]:
        if node in path:
            return [*path[path.index(node) :], node]
        if node in done:
            return []
        path.append(node)
        for target in sorted(graph.get(node, ())):
            if found := walk(target):
                return found
        done.add(path.pop())
        return []

    return next(filter(None, map(walk, sorted(graph))), [])


def module_cycle(graph: Arrows) -> list[str]:
    """Return a cycle of modules, or nothing."""
    return cycle({module: set(targets) for module, targets in graph.items()})


def room_cycle(graph: Arrows) -> list[str]:
    """Return a cycle between packages of one floor (gears and forces, export and plots), or nothing."""
    rooms: dict[str, set[str]] = {}
    for module, targets in graph.items():
        for target in targets:
            a, b = (name.split(".")[1] if "." in name else name for name in (module, target))
            if a != b and a in FLOORS and FLOORS[a] == FLOORS.get(b):
                rooms.setdefault(a, set()).add(b)
    return cycle(rooms)


def room_of(module: str) -> tuple[str, str] | None:
    """Return floor and room of a module; the room "" for a file beside the rooms; None where a floor has no rooms."""
    parts = module.split(".")
    if len(parts) < 3 or parts[1] not in ROOMS:
        return None
    return parts[1], parts[2] if len(parts) > 3 or parts[2] in ROOMS[parts[1]] else ""


def unplanned_arrows(graph: Arrows) -> list[str]:
    """List the imports between two rooms of a floor that the plan does not have, and rooms that it does not know."""
    found = []
    for module, targets in graph.items():
        here = room_of(module)
        if here is None:
            continue
        floor, room = here
        if room not in ROOMS[floor]:
            found.append(f"{module} stands in no room of {floor}/")
        for target, line in targets.items():
            there = room_of(target)
            if there is None or there[0] != floor or there[1] == room or target == f"rotorgear.{floor}":
                continue
            if there[1] not in ROOMS[floor].get(room, set()):
                found.append(f"{module}:{line} ({floor}/{room}) imports {target} ({floor}/{there[1]})")
    return found


def lazy_arrows(root: Path, graph: Arrows, package: str = "rotorgear") -> Arrows:
    """Return the graph with the imports that hide in strings, "rotorgear.gears.stiffness.iso:iso_stiffness"."""
    found = {module: dict(targets) for module, targets in graph.items()}
    for module in graph:
        place = root / module.replace(".", "/")
        file = place.with_suffix(".py") if place.with_suffix(".py").exists() else place / "__init__.py"
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                target = node.value.partition(":")[0]
                if target.startswith(f"{package}.") and target in graph and target != module:
                    found[module].setdefault(target, node.lineno)
    return found


@pytest.fixture(scope="module")
def house() -> Arrows:
    return arrows(ROOT)


def test_every_module_stands_on_a_floor(house: Arrows) -> None:
    assert len(house) > 10, "the walk found too few files to mean anything"
    assert unknown_modules(house) == []


def test_no_import_goes_up_a_floor(house: Arrows) -> None:
    assert upward_arrows(house) == []


def test_packages_of_one_floor_do_not_import_each_other_in_a_circle(house: Arrows) -> None:
    assert " -> ".join(room_cycle(house)) == ""


def test_modules_do_not_import_each_other_in_a_circle(house: Arrows) -> None:
    assert " -> ".join(module_cycle(house)) == ""


def test_rooms_import_each_other_as_planned(house: Arrows) -> None:
    assert unplanned_arrows(house) == []


def test_the_plan_names_every_room_that_there_is_and_no_other() -> None:
    there = {
        file.parent.relative_to(ROOT / "rotorgear").as_posix() for file in (ROOT / "rotorgear").rglob("*/__init__.py")
    }
    rooms = {name for name in there if "/" in name and not name.startswith("model/parts/")}
    assert rooms == {f"{floor}/{room}" for floor, planned in ROOMS.items() for room in planned if room}


def test_the_plan_of_the_rooms_has_no_circle() -> None:
    for floor, rooms in ROOMS.items():
        assert cycle(rooms) == [], floor


def test_imports_by_name_are_arrows_like_others(house: Arrows) -> None:
    # The face and the command line's entry load everything by name: that is their work.
    inside = {module: targets for module, targets in lazy_arrows(ROOT, house).items() if floor_of(module) != FACE}
    assert upward_arrows(inside) == []
    assert unplanned_arrows(inside) == []
    assert " -> ".join(module_cycle(inside)) == ""


def loads_by_name(module: str) -> bool:
    """Whether a module calls what imports by a name: import_module or __import__."""
    place = ROOT / module.replace(".", "/")
    file = place.with_suffix(".py") if place.with_suffix(".py").exists() else place / "__init__.py"
    calls = [node.func for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))) if isinstance(node, ast.Call)]
    names = {call.id if isinstance(call, ast.Name) else getattr(call, "attr", "") for call in calls}
    return bool(names & {"import_module", "__import__"})


def test_what_loads_modules_by_a_name_is_declared(house: Arrows) -> None:
    assert {module for module in house if loads_by_name(module)} == set(BY_NAME)
    # The ground's loader and the cluster's look at versions serve the face; all others stay on their own floor.
    for module, package in BY_NAME.items():
        assert package == "rotorgear" or floor_of(package) == floor_of(module)


def build(root: Path, files: dict[str, str]) -> Arrows:
    """Write a small rotorgear below `root` and return its arrows."""
    for name, text in {"__init__.py": "", **files}.items():
        file = root / "rotorgear" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")
    return arrows(root)


@pytest.mark.parametrize(
    "statement",
    [
        "import rotorgear.system.dofs",
        "from rotorgear.system import dofs",
        "from rotorgear.system.dofs import DofMap",
        "from ..system.dofs import DofMap",
        "from .. import system",
        "def late():\n    from rotorgear.system.dofs import DofMap",
        "import rotorgear",
    ],
)
def test_the_walk_catches_an_import_that_goes_up(tmp_path: Path, statement: str) -> None:
    parts = {
        "system/__init__.py": "",
        "system/dofs.py": "DofMap = dict",
        "solvers/__init__.py": "",
        "solvers/eigen.py": statement,
    }
    found = upward_arrows(build(tmp_path, parts))
    assert len(found) == 1
    assert found[0].startswith("rotorgear.solvers.eigen:")


def test_the_walk_allows_imports_that_go_down_or_leave_the_house(tmp_path: Path) -> None:
    graph = build(
        tmp_path,
        {
            "__init__.py": "def __getattr__(name):\n    from rotorgear.solvers import eigen",
            "__main__.py": "from rotorgear.cli import main",
            "errors.py": "import numpy",
            "cli/main.py": "from rotorgear.errors import RotorgearError\nfrom rotorgear.solvers import eigen",
            "solvers/__init__.py": "from rotorgear.solvers.eigen import modes",
            "solvers/eigen.py": "from rotorgear import errors\nimport rotorgears_cousin.cli",
        },
    )
    assert graph["rotorgear.solvers.eigen"] == {"rotorgear.errors": 1}
    assert graph["rotorgear.cli.main"] == {"rotorgear.errors": 1, "rotorgear.solvers.eigen": 2}
    assert (unknown_modules(graph), upward_arrows(graph), module_cycle(graph)) == ([], [], [])


def test_the_walk_catches_a_circle_that_is_closed_inside_a_function(tmp_path: Path) -> None:
    inner = "def late():\n    import rotorgear.model.part"
    graph = build(tmp_path, {"model/part.py": "from rotorgear.model import rules", "model/rules.py": inner})
    assert module_cycle(graph) == ["rotorgear.model.part", "rotorgear.model.rules", "rotorgear.model.part"]


def test_the_walk_catches_a_circle_between_rooms_that_is_none_between_modules(tmp_path: Path) -> None:
    graph = build(
        tmp_path,
        {
            "gears/tooth.py": "from rotorgear.forces import law",
            "gears/geometry/geometry.py": "",
            "forces/law.py": "",
            "forces/oil_film.py": "from rotorgear.gears import geometry",
            "cli/main.py": "import rotorgear.gears.tooth, rotorgear.forces.oil_film",
        },
    )
    assert module_cycle(graph) == []
    assert upward_arrows(graph) == []
    assert room_cycle(graph) == ["forces", "gears", "forces"]


def test_the_walk_catches_a_package_without_a_floor_and_an_import_of_nothing(tmp_path: Path) -> None:
    graph = build(tmp_path, {"attic/box.py": "", "errors.py": "import rotorgear.gone"})
    assert unknown_modules(graph) == [
        "rotorgear.attic.box stands on no floor",
        "rotorgear.errors:1 imports rotorgear.gone, which is no file",
    ]


def test_the_walk_catches_an_arrow_between_rooms_that_the_plan_does_not_have(tmp_path: Path) -> None:
    files = {
        "analysis/static/solve.py": "from rotorgear.analysis.modal import modal",
        "analysis/modal/modal.py": "from rotorgear.analysis.common import clock",
        "analysis/common/clock.py": "",
        "analysis/attic/box.py": "",
    }
    assert unplanned_arrows(build(tmp_path, files)) == [
        "rotorgear.analysis.attic.box stands in no room of analysis/",
        "rotorgear.analysis.static.solve:1 (analysis/static) imports rotorgear.analysis.modal.modal (analysis/modal)",
    ]


def test_the_walk_sees_an_import_that_hides_in_a_string(tmp_path: Path) -> None:
    files = {
        "gears/stiffness/models.py": 'MODELS = {"fe": "rotorgear.gears.loaded.curve:make"}',
        "gears/loaded/curve.py": "",
    }
    graph = lazy_arrows(tmp_path, build(tmp_path, files))
    assert len(unplanned_arrows(graph)) == 1
