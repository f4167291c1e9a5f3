"""Planets that are two, differ or stand at unequal angles: modes in axes that turn with the carrier, against state transition.

The reference has the planets in their own axes and the sun, the ring and the carrier in axes at rest: its coefficients change
with time, and after a whole turn of the carrier both know the same coordinates.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
import pytest
import scipy.linalg as la
from scipy.integrate import solve_ivp

import rotorgear as rg
from rotorgear.errors import AnalysisError
from rotorgear.system.assembly import assemble
from rotorgear.system.contacts import contact_lines
from rotorgear.system.system import System
from tests.planetary import BODIES, GROUND, PIN, helical_stage, in_frame_of_the_carrier, springs

TEETH = (26, 36, 98)
CARRIER = 900.0
LOSS = 4e-7
# Pins may stand at multiples of 360/(26 + 98) deg, and their pulls balance.
UNEVEN = tuple(2.0 * np.pi / 124 * k for k in (0, 28, 62, 90))
OTHER = '[meshes."sun_planet#2"]\nstiffness = 4.1e8\n'


def stage(angles: tuple[float, ...], more: str, ground: dict[str, dict[str, float]] | None = None) -> str:
    """A stage with dampers to the ground without preferred directions, and in pins."""
    given = ground or GROUND
    text = helical_stage(len(angles), teeth=TEETH, ground=given, loss=LOSS, more=more)
    for name, values in given.items():
        losses = springs({key: 3e-6 * value for key, value in values.items()})
        text = text.replace(f"[supports.{name}]\n", f"[supports.{name}]\ndamping = {losses}\n")
    degrees = ", ".join(f'"{np.degrees(angle):.15g} deg"' for angle in angles)
    return text.replace(f"planets = {len(angles)}", f"angles = [{degrees}]")


@dataclass(frozen=True)
class Wave:
    """What has one wave over the angle of the carrier."""

    still: np.ndarray
    cosine: np.ndarray
    sine: np.ndarray

    def at(self, angle: float) -> np.ndarray:
        return self.still + self.cosine * np.cos(angle) + self.sine * np.sin(angle)

    def slope(self, angle: float) -> np.ndarray:
        return self.sine * np.cos(angle) - self.cosine * np.sin(angle)


def transition(angles: tuple[float, ...], more: str) -> np.ndarray:
    """Eigenvalues of the state transition over a turn of the carrier."""

    def system_at(offset: float) -> System:
        return System(rg.loads(stage(tuple(angle + offset for angle in angles), more)))

    def strains(system: System, prefix: str) -> np.ndarray:
        T = system.dofs.transform.toarray()
        own = [group for group in system.groups if group.part.startswith(prefix)]
        return np.hstack([(group.matrices.strain[0] @ T[group.dofs[0]]).T for group in own])  # type: ignore[index]

    systems = [system_at(offset) for offset in (0.0, 0.5 * np.pi, np.pi)]

    def wave(of) -> Wave:  # type: ignore[no-untyped-def]
        first, second, third = (of(system) for system in systems)
        still = 0.5 * (first + third)
        return Wave(still, first - still, second - still)

    system = systems[0]
    n = system.n
    contacts, pins = wave(lambda one: contact_lines(one).vectors), wave(lambda one: strains(one, "bearings.pin"))
    k = contact_lines(system).stiffness
    c = contact_lines(system).damping
    of_pins = np.tile([PIN["radial"], PIN["radial"], PIN["axial"], PIN["tilt"], PIN["tilt"]], len(angles))
    own = [group for group in system.groups if not group.part.startswith(("carriers.", "meshes.", "bearings."))]
    M = system.mass.toarray()
    K = assemble(own, system.dofs, lambda g: g.matrices.stiffness).toarray()
    C = assemble(own, system.dofs, lambda g: g.matrices.damping).toarray()
    spun = assemble(
        own, system.dofs, lambda g: None if g.matrices.gyroscopic is None else g.spin * g.matrices.gyroscopic
    )
    speed = CARRIER / float(system.train.ratio("carrier"))
    G = speed * spun.toarray()
    T = system.dofs.transform.tocoo()
    column = np.full(T.shape[0], -1)
    column[T.row] = T.col
    S, planets = np.zeros((n, n)), np.zeros((n, n))
    for number in range(len(angles)):
        node = system.nodes.on_shaft(f"planet#{number + 1}")[0]
        x, y, _, tilt_x, tilt_y, _ = dofs = column[6 * node + np.arange(6)]
        S[y, x], S[x, y], S[tilt_y, tilt_x], S[tilt_x, tilt_y] = 1.0, -1.0, 1.0, -1.0
        planets[dofs, dofs] = 1.0
    D = C + G + 2.0 * CARRIER * M @ S
    K = K + CARRIER**2 * M @ S @ S + CARRIER * planets @ G @ S
    rotations = column[6 * system.nodes.on_shaft("carrier")[0] + 3 + np.arange(3)]
    radius = system.layout.planets[0].radius
    mass = BODIES["planet"][0]
    pull = CARRIER**2 * mass * radius / (1.0 - CARRIER**2 * mass / PIN["radial"])
    inverse = np.linalg.inv(M)

    def slope(t: float, y: np.ndarray) -> np.ndarray:
        q, v = y.reshape(2, n, 2 * n)
        angle = CARRIER * t
        force = K @ q + D @ v
        for strain, stiffness, damping in ((contacts, k, c), (pins, of_pins, LOSS * of_pins)):
            V = strain.at(angle)
            rate = V.T @ v + CARRIER * strain.slope(angle).T @ q
            force += V @ (stiffness[:, None] * (V.T @ q) + damping[:, None] * rate)
        for place in angles:
            e = np.array([np.cos(place + angle), np.sin(place + angle), 0.0])
            force[rotations] += pull * radius * (np.eye(3) - np.outer(e, e)) @ q[rotations]
        return np.concatenate([v.ravel(), -(inverse @ force).ravel()])

    found = solve_ivp(slope, (0.0, 2.0 * np.pi / CARRIER), np.eye(2 * n).ravel(), "DOP853", rtol=1e-7, atol=1e-10)
    return la.eigvals(found.y[:, -1].reshape(2 * n, 2 * n))


@pytest.mark.parametrize(("angles", "more"), [pytest.param((0.0, np.pi), "", marks=pytest.mark.long), (UNEVEN, OTHER)])
def test_modes_are_those_of_the_state_transition_over_a_turn(angles: tuple[float, ...], more: str) -> None:
    model = rg.loads(stage(angles, more))
    speed = CARRIER / float(model.layout.train.ratio("carrier"))
    found = rg.modal(model, speed=speed, modes=100)
    multipliers = transition(angles, more)
    elastic = found.eigenvalues[~found.rigid]
    assert len(elastic) == 6 * (3 + len(angles)) - 1
    own = np.exp(elastic * 2.0 * np.pi / CARRIER)
    off = np.abs(own[:, None] - multipliers[None, :]).min(axis=1)
    assert np.all(off < 1e-5)
    assert any("seen from their carrier" in note for note in found.left_out)


def test_a_campbell_diagram_has_the_frequencies_of_modes_at_each_speed_and_lines_of_meshes() -> None:
    model = rg.loads(stage((0.0, np.pi), ""))
    speeds = [300.0, 305.0]
    diagram = rg.campbell(model, speeds=speeds, modes=8, mesh_orders=(1,), error_estimate=False)
    for k, speed in enumerate(speeds):
        found = rg.modal(model, speed=speed, modes=13)
        own = found.frequency_hz[~found.rigid & (found.frequency_hz > 0.0)][:7]
        told = np.sort(diagram.frequency_hz[k])
        assert np.abs(told[:, None] - own[None, :]).min(axis=0) == pytest.approx(np.zeros(7), abs=1e-6 * own[0])
    assert {line.kind for line in diagram.lines} == {"mesh"}
    assert diagram.carrier_frequency_hz == {}


def test_equal_planets_seen_from_the_carrier_have_the_frequencies_of_that_frame() -> None:
    """The same rule for all bodies, for a stage that axes at rest know as well."""
    model = rg.loads(helical_stage(4, teeth=TEETH))
    system = System(model)
    found = rg.modal(system.seen_from_carrier(), speed=310.0 / system.train.ratio("carrier"), modes=42)
    told = found.frequency_hz[~found.rigid]
    assert np.sort(told) == pytest.approx(in_frame_of_the_carrier(system, 310.0) / (2.0 * np.pi), rel=1e-7)


UNEQUAL = {
    name: {**values, "y": 1.6 * values["y"]} if name == "sun" else dict(values) for name, values in GROUND.items()
}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (stage((0.0, np.pi), "", UNEQUAL), "but supports.sun has preferred directions at rest"),
        (stage(tuple(2.0 * np.pi / 124 * k for k in (0, 40, 85)), ""), "but the pulls of its planets do not balance"),
        (stage((0.0, np.pi), '[gears."planet#2"]\nmass = 2.9\n'), "but the mass of gears.planet#2 is not that of"),
    ],
)
def test_what_would_change_with_the_angle_there_too_is_refused_by_name(text: str, words: str) -> None:
    with pytest.raises(AnalysisError, match=re.escape(words)):
        rg.modal(rg.loads(text), speed="1000 rpm")


def test_other_analyses_refuse_them() -> None:
    model = rg.loads(stage((0.0, np.pi), ""))
    with pytest.raises(AnalysisError, match="coefficients of two planets on a carrier that turns"):
        rg.frf(model, inputs=["gears.sun:x"], outputs=["gears.sun:x"], fmax=300.0, speed="1000 rpm")
