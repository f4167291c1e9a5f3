"""What excites a gearbox harmonically, by order: unbalances at the speeds of their shafts, meshes at multiples of theirs.

An unbalance U at phase a on a shaft that turns with W_i puts m e W_i^2 (cos(W_i t + a), sin(W_i t + a)) on its node. In
Re(f e^{i w t}) with w = |W_i| that is f_x = U W_i^2 e^{i s a}, f_y = -i s U W_i^2 e^{i s a}, s the sign of W_i.

A transmission error e(t) and a stiffness k (1 + a(t)) turn the force of a contact under the mean force F_0 into
F = k (v.q - e) + c (v.q' - e') + F_0 a to first order; a may follow from a model of the teeth, and an impact adds to the last
term. Mesh phases: model/layout/mean_load.py.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from rotorgear.analysis.response.cycle_harmonics import harmonics_of_pieces, harmonics_of_pulse, strong
from rotorgear.model.layout.mean_load import MeshForce
from rotorgear.model.parts.mesh import Mesh
from rotorgear.system.contacts import ContactLines
from rotorgear.system.local import cycle_pieces
from rotorgear.system.system import System


@dataclass(frozen=True)
class Order:
    """Excitations of one frequency.

    Attributes:
        name: "shaft input 1x" or "mesh stage_1a, stage_1b 2x".
        ratio: frequency in rad/s over the size of the reference speed.
        unbalance: force per square of the reference speed at the free dofs, (n,).
        error: transmission error of each contact, (c,) m; force: F_0 times the stiffness variation, and impacts, (c,) N.
    """

    name: str
    ratio: float
    unbalance: np.ndarray
    error: np.ndarray
    force: np.ndarray

    def load(self, lines: ContactLines, speed: float) -> np.ndarray:
        """Force on the free dofs at a reference speed in rad/s, (n,)."""
        w = self.ratio * abs(speed)
        return np.asarray(
            speed**2 * self.unbalance
            + lines.vectors @ ((lines.stiffness + 1j * w * lines.damping) * self.error - self.force)
        )


def orders_of(system: System, lines: ContactLines, mean_force: np.ndarray) -> list[Order]:
    """Return all orders of a system, lowest ratio first; what has one frequency is one order, with its phases.

    `mean_force` (c,) in N is that of the contacts. Phases follow from the teeth.
    """
    found: dict[tuple[str, int, float], tuple[list[str], Order]] = {}
    for shaft, ratio, load in _unbalances(system):
        key = ("shaft", 1, round(ratio, 9))
        _add(found, key, shaft, ratio, load, np.zeros((2, len(lines.stiffness)), complex))
    for mesh, harmonic, ratio, terms in _meshes(system, lines, mean_force):
        key = ("mesh", harmonic, round(ratio, 9))
        _add(found, key, mesh, ratio, np.zeros(system.n, complex), terms)
    orders = [
        Order(f"{kind} {', '.join(names)} {harmonic}x", o.ratio, o.unbalance, o.error, o.force)
        for (kind, harmonic, _), (names, o) in found.items()
    ]
    return sorted(orders, key=lambda order: order.ratio)


def _add(
    found: dict[tuple[str, int, float], tuple[list[str], Order]],
    key: tuple[str, int, float],
    name: str,
    ratio: float,
    load: np.ndarray,
    terms: np.ndarray,
) -> None:
    names, old = found.get(
        key, ([], Order("", ratio, np.zeros_like(load), np.zeros_like(terms[0]), np.zeros_like(terms[1])))
    )
    if name not in names:
        names.append(name)
    found[key] = names, Order("", old.ratio, old.unbalance + load, old.error + terms[0], old.force + terms[1])


def _unbalances(system: System) -> Iterable[tuple[str, float, np.ndarray]]:
    """(shaft, size of its speed ratio, force per square of the reference speed) of every unbalance that turns."""
    model = system.model
    nodes = system.nodes
    for name, item in model.unbalances.items():
        ratio = system.train.ratio(item.shaft)
        if ratio == 0.0:
            continue
        sense = system.direction * system.train.sense(item.shaft)
        f = np.zeros(system.dofs.transform.shape[0], complex)
        node = nodes.at(*system.layout.place(f"unbalances.{name}"))
        size = item.magnitude * ratio**2 * cmath.exp(1j * sense * item.phase)
        f[6 * node] = size
        f[6 * node + 1] = -1j * sense * size
        yield item.shaft, abs(ratio), system.dofs.transform.T @ f


def _meshes(
    system: System, lines: ContactLines, mean_force: np.ndarray
) -> Iterable[tuple[str, int, float, np.ndarray]]:
    """(mesh, harmonic, ratio, [errors; forces] of all contacts) of every harmonic that a mesh is given."""
    load = system.load.about_nominal_flanks
    for k, state in enumerate(lines.states):
        mesh = system.layout.mesh(state.contact.mesh)
        phase = load.phase(state.contact)
        teeth = mesh.pinion.part.teeth
        ratio = abs(system.train.ratio(mesh.pinion.shaft)) * (teeth or 0)
        if phase is None or ratio == 0.0:
            continue
        for row, harmonic, amplitude in _harmonics(system, mesh.part, state, float(mean_force[k])):
            terms = np.zeros((2, len(lines.states)), complex)
            terms[row, k] = amplitude * cmath.exp(1j * harmonic * phase)
            yield mesh.name, harmonic, harmonic * ratio, terms


def _harmonics(system: System, mesh: Mesh, state: MeshForce, mean_force: float) -> Iterable[tuple[int, int, complex]]:
    """(0: error in m, 1: force in N; harmonic; amplitude) of everything that varies in a contact over the mesh cycle."""
    # What opens the nominal flanks closes the others.
    opens = 1.0 if system.load.is_nominal(state) else -1.0
    for item in mesh.transmission_error:
        yield 0, item.harmonic, opens * item.amplitude * cmath.exp(1j * item.phase)
    for share in mesh.stiffness_variation:
        yield 1, share.harmonic, mean_force * share.amplitude * cmath.exp(1j * share.phase)
    pieces = cycle_pieces(system, state) if mean_force else ()
    if pieces:
        yield from ((1, n, mean_force * c) for n, c in strong(harmonics_of_pieces(pieces)))
    if mesh.corner_impact is not None:
        pulse = mesh.corner_impact
        yield from ((1, n, opens * pulse.force * c) for n, c in strong(harmonics_of_pulse(pulse.duration, pulse.at)))
