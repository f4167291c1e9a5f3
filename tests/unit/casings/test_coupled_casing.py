"""Two geared rotors in a box of 36 thousand dofs: the reduced box against the whole mesh, solved with the rotors at once."""

from __future__ import annotations

import re
import subprocess
import sys

import numpy as np
import pytest
import scipy.sparse as sp
import scipy.sparse.linalg as sla

import rotorgear as rg
from rotorgear.casings.fe_body import finite_element_body
from rotorgear.model.layout.casings import casing_settings
from rotorgear.system.assembly import assemble
from rotorgear.system.system import System
from tests.paths import ROOT


def geared_box() -> rg.Model:
    """The model of docs/casings.md."""
    page = (ROOT / "docs" / "casings.md").read_text(encoding="utf-8")
    text = page.split("<!-- file: geared_box.toml -->\n```toml\n")[1].split("\n```")[0]
    return rg.loads(text, folder=ROOT)


def on_ground(model: rg.Model) -> rg.Model:
    """The same without its casing."""
    return model.with_({**{f"bearings.{name}.casing": None for name in model.bearings}, "casings": {}})


def whole_frequencies(model: rg.Model, count: int) -> np.ndarray:
    """Frequencies of rotors and mesh as one sparse eigenproblem, x = [u of the free nodes; dofs of the rotors]."""
    system = System(model)
    fe = finite_element_body(casing_settings(model, "box"))
    space = fe.free_space(held=True, rigid_seats=False)
    W = fe.mean_weights(fe.seats)[space.dofs]
    of_casing = system.nodes.of_casing("box")
    numbers = np.flatnonzero(system.dofs.transform[of_casing, :].sum(axis=0))
    rotors = np.setdiff1d(np.arange(system.n), numbers)
    # Motions of the seats are means of the nodes'; the reduced body's other coordinates have no part in the rotors' matrices.
    seats = numbers[: W.shape[1]]
    rows = sp.csr_array((np.ones(len(rotors)), (rotors, np.arange(len(rotors)))), shape=(system.n, len(rotors)))
    means = sp.coo_array(W.T)
    mean_rows = sp.csr_array((means.data, (seats[means.row], means.col)), shape=(system.n, W.shape[0]))
    P = sp.hstack([mean_rows, rows], format="csr")
    groups = [group for group in system.groups if not group.part.startswith("casings.")]
    free = space.dofs
    unit = sp.csr_array((np.ones(len(free)), (np.arange(len(free)), free)), shape=(len(free), fe.dofs))
    mass = sp.csr_array(unit @ sp.kron(fe.matrices.mass, sp.eye_array(3), format="csr") @ unit.T)
    empty = sp.csr_array((len(rotors), len(rotors)))
    K = (
        sp.block_diag([fe.stiffness_in(space.shapes), empty])
        + P.T @ assemble(groups, system.dofs, lambda g: g.matrices.stiffness) @ P
    )
    M = sp.block_diag([mass, empty]) + P.T @ assemble(groups, system.dofs, lambda g: g.matrices.mass) @ P
    squares = sla.eigsh(
        sp.csc_array(K), count, sp.csc_array(M), sigma=-((2.0 * np.pi * 200.0) ** 2), return_eigenvectors=False
    )
    return np.sort(np.sqrt(np.maximum(squares, 0.0))) / (2.0 * np.pi)


@pytest.mark.long
def test_the_reduced_box_agrees_with_the_whole_mesh_within_the_error_it_states() -> None:
    model = geared_box()
    reduced = rg.modal(System(model), modes=16)
    whole = whole_frequencies(model, 16)
    elastic = slice(1, None)
    difference = np.abs(reduced.natural_frequency_hz[elastic] / whole[elastic] - 1.0)
    assert difference.max() < 1e-3
    # What the eigensolver of the whole leaves is some 1e-9.
    assert np.all(difference <= 1.5 * reduced.error_estimate[elastic] + 1e-8)


@pytest.mark.long
def test_the_box_on_its_feet_has_the_modes_of_another_program() -> None:
    held = rg.casing(geared_box(), modes=10).casings["box"].held_frequency_hz
    # CalculiX 2.20, quadratic tetrahedra with straight edges on the same corners.
    calculix = [814.485, 968.480, 1147.871, 1244.692, 1310.403, 1362.833, 1487.954, 1519.576, 1544.298, 1679.773]
    assert held == pytest.approx(calculix, rel=1e-4)


@pytest.mark.long
def test_140_000_unknowns_take_a_minute_and_two_gigabytes_and_a_half_at_most() -> None:
    pytest.importorskip("pymetis")
    program = [sys.executable, "-m", "validation.benchmarks.casing", "--large"]
    done = subprocess.run(program, cwd=ROOT, capture_output=True, text=True, check=True)
    found = re.search(r"in all ([\d.]+) CPU s and ([\d.]+) GB", done.stdout)
    assert found is not None, done.stdout
    assert float(found[1]) < 60.0
    assert float(found[2]) < 2.5


@pytest.mark.long
def test_a_box_a_million_times_as_stiff_is_the_ground() -> None:
    model = geared_box()
    stiff = model.with_("materials.box_aluminium.youngs_modulus", 71e15)
    inside = rg.modal(System(stiff), modes=7, error_estimate=False).natural_frequency_hz[1:]
    ground = rg.modal(System(on_ground(model)), modes=7, error_estimate=False).natural_frequency_hz[1:]
    assert ground == pytest.approx([576.29, 718.06, 864.73, 1061.03, 1167.43, 1299.49], rel=1e-5)
    assert inside == pytest.approx(ground, rel=1e-5)
