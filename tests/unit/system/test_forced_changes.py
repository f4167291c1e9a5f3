"""What a finer mesh would change of a forced response, against that change itself."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.sparse as sp

import rotorgear as rg
from rotorgear.solvers.frequency.harmonic import Dynamics
from rotorgear.system.bubble_errors import ForcedChanges
from rotorgear.system.plan import Plan
from rotorgear.system.system import System
from tests.models import STEEL


def rotor(shaft: dict[str, Any], damping: dict[str, float]) -> rg.Model:
    return rg.Model(
        motions=["bending"],
        materials=STEEL,
        shafts={
            "rotor": {
                "sections": [{"length": 0.2, "outer_diameter": 0.1}, {"length": 0.1, "outer_diameter": 0.1}],
                **shaft,
            }
        },
        bearings={end: {"shaft": "rotor", "at": end, "stiffness": {"radial": 1e9}} for end in ("start", "end")},
        operation={"input_shaft": "rotor"},
        damping=damping,
    )


def receptances(system: System, ws: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
    """Receptance along x 0.1 m from the end, (f,), and the displacements, (n, 1) each."""
    read = np.asarray(system.dofs.transform[[6 * system.nodes.at("rotor", 0.2)], :].toarray()[0])
    dynamics = Dynamics(system.mass, system.damping(0.0), sp.csc_array(system.stiffness(0.0)))
    found = [dynamics.solve(float(w), read[:, None]) for w in ws]
    return np.array([read @ q[:, 0] for q in found]), found


@pytest.mark.parametrize(
    ("shaft", "count"), [({}, 16), ({"internal_damping": 1e-7}, 16), ({"mass_matrix": "lumped"}, 64)]
)
def test_where_a_finer_mesh_matters_is_known_without_it(shaft: dict[str, Any], count: int) -> None:
    damping = {"rayleigh_beta": 1e-7, "rayleigh_alpha": 30.0}
    ws = 2.0 * np.pi * np.linspace(200.0, 6000.0, 120)
    coarse = System(rotor(shaft, damping), plan=Plan(count))
    fine = System(rotor({**shaft, "mass_matrix": "consistent"}, damping), plan=Plan(6, 5))
    rough, moved = receptances(coarse, ws)
    error = np.abs(rough - receptances(fine, ws)[0])
    changes = ForcedChanges.of(coarse)
    told = [changes.change(0.0, np.array([w]), q, turning=False)[0] for w, q in zip(ws, moved, strict=True)]
    assert np.argmax(told) == np.argmax(error)
    assert told == pytest.approx(error, rel=0.05, abs=0.02 * error.max())


def test_a_circular_whirl_is_not_overlooked() -> None:
    system = System(rotor({}, {}), plan=Plan(4))
    node = 6 * system.nodes.at("rotor", 0.2)
    x, y = np.asarray(system.dofs.transform[[node, node + 1], :].toarray())
    dynamics = Dynamics(system.mass, system.damping(0.0), sp.csc_array(system.stiffness(0.0)))
    w = np.array([1e3])
    changes = ForcedChanges.of(system)
    plain = changes.change(0.0, w, dynamics.solve(1e3, x[:, None]), turning=True)
    whirl = changes.change(0.0, w, dynamics.solve(1e3, (x - 1j * y)[:, None]), turning=True)
    assert whirl == pytest.approx(2.0 * plain, rel=1e-9)


@pytest.mark.parametrize("whirl", [1.0, -1.0])
@pytest.mark.parametrize(
    ("turned", "rough_plan"), [(0.0, Plan(16)), (0.25, Plan(16)), (0.9, Plan(16)), (0.9, Plan(4, 2))]
)
def test_a_whirl_of_a_shaft_that_damps_inside_and_turns_is_known_without_a_finer_mesh(
    whirl: float, turned: float, rough_plan: Plan
) -> None:
    """Rotating load f on a rotor alike in all directions, at eta times the speed = `turned`: the change of f^H q."""
    speed = 1500.0
    shaft = {"internal_damping": turned / speed}
    ws = 2.0 * np.pi * np.linspace(300.0, 3000.0, 40)
    model = rotor(shaft, {"rayleigh_alpha": 30.0}).with_("operation.speed", speed)

    def solved(plan: Plan) -> tuple[System, np.ndarray, list[np.ndarray]]:
        system = System(model, plan=plan)
        node = 6 * system.nodes.at("rotor", 0.2)
        x, y = np.asarray(system.dofs.transform[[node, node + 1], :].toarray())
        f = x - 1j * whirl * y
        K = sp.csc_array(system.stiffness(speed) + system.circulatory(speed))
        D = sp.csc_array(system.damping(speed) + speed * system.gyroscopic)
        found = [Dynamics(system.mass, D, K).solve(float(w), f[:, None]) for w in ws]
        return system, np.array([f.conj() @ q[:, 0] for q in found]), found

    coarse, rough, moved = solved(rough_plan)
    error = np.abs(rough - solved(Plan(6, 5))[1])
    changes = ForcedChanges.of(coarse)
    told = [changes.change(speed, np.array([w]), q, turning=True)[0] for w, q in zip(ws, moved, strict=True)]
    assert told == pytest.approx(error, rel=0.05, abs=0.02 * error.max())
