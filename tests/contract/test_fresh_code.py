"""Compiled code and stored compliances are never served stale: a copy of the package is run, changed in one place, and run again.

The places are chosen so that a cache that looks at one file only does not notice: a function that is compiled into others, and a
source that the computing module imports.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from rotorgear.fingerprint import PACKAGE, imported_files, with_imports

# A mass on a spring beside a tooth contact; a step of Newmark's method calls functions of three files.
INTEGRATE = """
from rotorgear.forces.mesh_contact import MeshContact
from validation.oscillators import integrate, local_system
import numpy as np
system = local_system(np.eye(1), np.zeros((1, 1)), np.eye(1), [0.0], [(MeshContact(3.0, gap="bilateral"), [1.0])])
print(repr(float(integrate(system, "average acceleration", 0.1, 20, [1.0], [0.0]).q[-1][0])))
"""
COMPLIANCE = """
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.tooth_fe.compliance_model import compliance_key, gear_compliance
from rotorgear.gears.tooth_fe.points import MeshSize
from rotorgear.gears.tooth_fe.settings import ToothFe
import math
gear = GearGeometry(teeth=30, normal_module=3e-3, normal_pressure_angle=math.radians(20.0), helix_angle=0.0)
key = compliance_key(gear, ToothFe(size=MeshSize(5, 2, 4, 2, 3, 4)), 0.3, 30e-3, 20e-3, space=False)
print(repr(float(gear_compliance(key).flexibility.max())))
"""


# What one contact does in a batch, as a trajectory, by Newmark's method, and at rest.
EVERYWHERE = """
from fractions import Fraction
import numpy as np
from rotorgear.analysis.sweep.point import ready, at_rest, table_of
from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.solvers.batch.run_block import BatchPlan, Start, run_block, trajectory
from rotorgear.solvers.time.contact_equilibrium import equilibrium
from validation.oscillators import integrate, local_system
law = MeshContact(3.0, 0.2, 0.5, ramp=0.05, order=1.0, error_cos=(0.1,))
system = local_system(np.eye(1), np.zeros((1, 1)), np.eye(1), [0.4], [(law, [1.0])], speed=0.9)
point = ready(at_rest(system, [Fraction(1)], ("contact",)), 0.9)
table = table_of(point, 50)
start = Start(np.array([0.2]), np.zeros(1))
print(repr([
    float(run_block([point.system], [start], [table], BatchPlan(50, 0, 1, 0))[0].section[-1, 0, 0]),
    float(trajectory(point.system, start, table, 50, 1)[-1, 0, 0]),
    float(integrate(system, "average acceleration", 0.1, 20, [0.2], [0.0]).q[-1][0]),
    float(equilibrium(system).q[0]),
]))
"""

# Run by Python instead of compiled: rows of a batch are numpy's, which the intrinsics of vectors.py stand for in compiled code.
INTERPRETED = """
import numpy as np
from rotorgear.solvers.contact import vectors
vectors.fill = lambda number: np.full(vectors.BATCH, number)
vectors.get = lambda array, row: array.reshape(-1, vectors.BATCH)[row].copy()
def put(array, row, value):
    array.reshape(-1, vectors.BATCH)[row] = value
vectors.put = put
vectors.where_positive = lambda sign, then, otherwise: np.where(sign > 0.0, then, otherwise)[()]
vectors.larger = lambda a, b: np.where(a > b, a, b)[()]
vectors.smaller = lambda a, b: np.where(a < b, a, b)[()]
"""


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """The package and the helpers of its tests in a folder of their own, with a cache of their own."""
    leave = shutil.ignore_patterns("__pycache__")
    shutil.copytree(PACKAGE, tmp_path / "rotorgear", ignore=leave)
    shutil.copytree(PACKAGE.parent / "validation", tmp_path / "validation", ignore=leave)
    return tmp_path


def answers(copy: Path, program: str, **settings: str) -> str:
    environment = {**os.environ, "PYTHONPATH": str(copy), "ROTORGEAR_CACHE": str(copy / "cache"), **settings}
    environment.pop("NUMBA_CACHE_DIR", None)
    run = subprocess.run(
        [sys.executable, "-c", program], cwd=copy, env=environment, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
    return run.stdout


def answer(copy: Path, program: str) -> float:
    return float(answers(copy, program))


def change(copy: Path, file: str, old: str, new: str) -> None:
    path = copy / "rotorgear" / file
    text = path.read_text(encoding="utf-8")
    assert text.count(old) == 1, f"{file} no longer says {old!r} once"
    path.write_text(text.replace(old, new), encoding="utf-8")


def test_compiled_code_is_kept_in_a_folder_that_any_change_of_its_sources_renames(copy: Path) -> None:
    ask = "from rotorgear.solvers.time.compiled import cache_folder; print(cache_folder())"
    before = answers(copy, ask)
    assert answers(copy, ask) == before
    folders = {before}
    for file in ("solvers/time/kernel_contact.py", "solvers/contact/gap_contact.py", "forces/mesh_contact.py"):
        with (copy / "rotorgear" / file).open("a", encoding="utf-8") as source:
            source.write("\n# another word\n")
        folders.add(answers(copy, ask))
    assert len(folders) == 4


@pytest.mark.long  # compiles a loop twice
def test_a_change_of_an_inlined_function_reaches_the_compiled_loop(copy: Path) -> None:
    before = answer(copy, INTEGRATE)
    assert answer(copy, INTEGRATE) == before  # from the warm cache
    change(
        copy,
        "solvers/time/kernel_contact.py",
        "                F[i] = answer.F[i]",
        "                F[i] = 2.0 * answer.F[i]",
    )
    assert answer(copy, INTEGRATE) != pytest.approx(before, rel=1e-3)


def change_the_contact_formula(copy: Path) -> None:
    change(copy, "solvers/contact/gap_contact.py", "elastic = k * depth", "elastic = 1.5 * k * depth")


def interpreted(copy: Path) -> np.ndarray:
    return np.array(json.loads(answers(copy, INTERPRETED + EVERYWHERE, NUMBA_DISABLE_JIT="1")))


def test_the_contact_formula_stands_once_for_lanes_trajectory_integrator_and_equilibrium(copy: Path) -> None:
    before = interpreted(copy)
    change_the_contact_formula(copy)
    after = interpreted(copy)
    assert np.all(np.abs(after - before) > 1e-3 * np.abs(before)), (before, after)


@pytest.mark.long  # compiles all loops anew
def test_compiled_loops_follow_a_change_of_the_contact_formula_and_agree_with_python(copy: Path) -> None:
    before = np.array(json.loads(answers(copy, EVERYWHERE)))
    assert before == pytest.approx(interpreted(copy), rel=1e-9)
    change_the_contact_formula(copy)
    after = np.array(json.loads(answers(copy, EVERYWHERE)))
    assert after == pytest.approx(interpreted(copy), rel=1e-9)
    assert np.all(np.abs(after - before) > 1e-3 * np.abs(before)), (before, after)


def test_a_change_of_the_elements_reaches_the_stored_compliances(copy: Path) -> None:
    before = answer(copy, COMPLIANCE)
    assert answer(copy, COMPLIANCE) == before
    change(copy, "gears/tooth_fe/elasticity.py", "+= mu * trace", "+= 1.5 * mu * trace")
    assert answer(copy, COMPLIANCE) != pytest.approx(before, rel=1e-3)


def test_the_walk_over_imports_finds_modules_named_in_parentheses_and_functions(tmp_path: Path) -> None:
    file = tmp_path / "kernel.py"
    file.write_text(
        "from rotorgear.solvers.time import (\n    kernel_contact,\n    newmark,\n)\n"
        "def late():\n    from rotorgear.forces.law import ForceLaw\n",
        encoding="utf-8",
    )
    names = {path.relative_to(PACKAGE).as_posix() for path in imported_files(file)}
    assert names == {"solvers/time/kernel_contact.py", "solvers/time/newmark.py", "forces/law.py"}


def test_the_sources_of_compiled_code_hold_what_is_compiled_into_it() -> None:
    loop = PACKAGE / "solvers" / "time" / "kernel_newmark.py"
    names = {path.relative_to(PACKAGE).as_posix() for path in with_imports([loop])}
    assert {"solvers/time/kernel_newmark.py", "solvers/time/kernel_contact.py", "solvers/time/compiled.py"} <= names
