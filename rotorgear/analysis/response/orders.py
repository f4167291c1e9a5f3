"""What excites a gearbox harmonically, by order: unbalances at the speeds of their shafts, meshes at multiples of theirs.

A load A cos(order angle + phase) pushes A e^{i s phase} at its order, one of a frequency in Hz A e^{i phase} at that; a torque
ripples with its share of the mean torque, and a load over the angle of a shaft has the harmonics of its table.

An unbalance U at phase a on a shaft that turns with W_i puts m e W_i^2 (cos(W_i t + a), sin(W_i t + a)) on its node. In
Re(f e^{i w t}) with w = |W_i| that is f_x = U W_i^2 e^{i s a}, f_y = -i s U W_i^2 e^{i s a}, s the sign of W_i.

A transmission error e(t) and a stiffness k (1 + a(t)) turn the force of a contact under the mean force F_0 into
F = k (v.q - e) + c (v.q' - e') + F_0 a to first order; a may follow from a model of the teeth, and an impact adds to the last
term. Of loaded teeth the last term is f of their joint state, F_i - k_i delta_i, which holds all of their ripple
(analysis/static/joint_state.py), and e what the approach is at first touch. Mesh phases: model/layout/state.py.
"""

from __future__ import annotations

import cmath
from collections.abc import Iterable
from dataclasses import replace
from fractions import Fraction
from itertools import chain

import numpy as np

from rotorgear.analysis.response.cycle_harmonics import (
    ROUNDING,
    SEEN,
    harmonics_of_cycle,
    harmonics_of_line,
    harmonics_of_pieces,
    harmonics_of_pulse,
    strong,
    that_matter,
)
from rotorgear.analysis.response.order import Order
from rotorgear.analysis.response.sidebands import require_plain_teeth, with_sidebands
from rotorgear.analysis.static.joint_state import Cycle
from rotorgear.analysis.static.mean_state import Setup
from rotorgear.model.parts.carrier import written_name
from rotorgear.model.parts.load import COMPONENTS, LoadHistory
from rotorgear.model.parts.mesh import Mesh
from rotorgear.note import Note
from rotorgear.system.loads import varying_load, wrench_load
from rotorgear.system.local import cycle_pieces
from rotorgear.system.system import System

# What has one frequency: "shaft" or "mesh", the multiple of its frequency, and the ratio to the reference speed.
_Key = tuple[str, int | float | Fraction, float]
# With that, the name of what excites, and its part of the order, a `blank` one with what it adds.
_Part = tuple[_Key, str, Order]


def orders_of(setup: Setup) -> tuple[list[Order], tuple[Note, ...]]:
    """Return all orders of a system about its mean state, lowest ratio first, and notes on harmonics that are left out.

    What has one frequency is one order, with its phases, which follow from the teeth.
    """
    require_plain_teeth(setup.system)
    left: list[Note] = []
    # Loads on what rigid members hold are theirs alone, and count for their forces.
    free = setup.system.released
    nothing = np.zeros(free.n, complex)
    rest = np.zeros(len(setup.lines.states), complex)
    blank = Order("", 0.0, nothing, rest, rest, rest, minor=True)
    found: dict[_Key, tuple[list[str], Order]] = {}
    for key, name, part in chain(
        _unbalances(free, blank),
        _meshes(setup, blank, left),
        _loaded_teeth(setup, blank, left),
        _external_loads(free, blank, left),
    ):
        names, order = found.get(key, ([], blank))
        found[key] = names if name in names else [*names, name], order.plus(part)
    orders = []
    for (kind, harmonic, _), (names, order) in found.items():
        multiple = f"{harmonic:g}" if isinstance(harmonic, float) else f"{harmonic}"
        unit = " Hz" if order.fixed else "x"
        name = f"{kind} {', '.join(dict.fromkeys(map(written_name, names)))} {multiple}{unit}"
        orders += [
            replace(part, name=name + beside) for beside, part in with_sidebands(setup.system, setup.lines, order)
        ]
    return sorted(orders, key=lambda order: (order.ratio, order.fixed)), tuple(dict.fromkeys(left))


def _external_loads(system: System, blank: Order, left: list[Note]) -> Iterable[_Part]:
    """Each harmonic of loads and torque ripples."""
    T = system.dofs.transform

    def turning(order: float, shaft: str, ratio: float, applied: np.ndarray) -> _Part:
        """An order of a shaft; one of a whole number is that of its unbalances."""
        multiple = int(order) if order == int(order) else order
        part = replace(blank, ratio=order * ratio, applied=applied, minor=False)
        return ("shaft", multiple, round(order * ratio, 9)), shaft, part

    for item in system.state.applied:
        torque = varying_load(system, item.name)
        ratio = abs(system.train.ratio(item.shaft))
        if torque is None or not torque.ripple or not ratio:
            continue
        f = np.zeros(T.shape[0], complex)
        f[6 * system.nodes.at(item.shaft, item.z) + 5] = item.torque * torque.ripple
        yield turning(torque.ripple_order, item.shaft, ratio, T.T @ f)
    for load in system.layout.external_loads:
        sense = system.direction * np.sign(load.ratio)
        if load.frequency:
            applied = T.T @ wrench_load(system, load, load.amplitude * cmath.exp(1j * load.phase))
            name = load.address.removeprefix("loads.")
            part = replace(blank, fixed=2.0 * np.pi * load.frequency, applied=applied, minor=False)
            yield ("load", load.frequency, 0.0), name, part
        elif load.order:
            applied = T.T @ wrench_load(system, load, load.amplitude * cmath.exp(1j * sense * load.phase))
            yield turning(abs(load.order / load.ratio), load.counted, abs(load.ratio), applied)
        elif load.history is not None and load.history.over == "angle":
            coefficients, rest = _of_history(load.history)
            for n, wrench in coefficients:
                own = load.frame.own(wrench if sense > 0 else wrench.conj())
                applied = T.T @ wrench_load(system, load, own)
                yield turning(float(n), load.counted, abs(load.ratio), applied)
            left += _weak(load.address, "table over the angle", rest)


def _of_history(history: LoadHistory) -> tuple[list[tuple[int, np.ndarray]], float]:
    """Harmonics of a load over the angle that count, each (6,), and the largest other one relative to the strongest."""
    found = np.zeros((SEEN, 6), complex)
    for name, values in zip(history.components, history.values, strict=True):
        angles, turned = history.whole_turn(values)
        column = harmonics_of_line(angles / (2.0 * np.pi), turned)
        column[np.abs(column) <= ROUNDING * np.abs(turned).max()] = 0.0
        found[:, COMPONENTS.index(name)] = column
    scale = np.maximum(np.abs(found).max(axis=0), 1e-300)
    size = (np.abs(found) / scale).max(axis=1)
    kept, rest = strong(size.astype(complex))
    return [(n, found[n - 1]) for n, _ in kept], rest


def _unbalances(system: System, blank: Order) -> Iterable[_Part]:
    """Every unbalance that turns."""
    model = system.model
    nodes = system.nodes
    for name, item in model.unbalances.items():
        ratio = system.train.ratio(item.shaft)
        if ratio == 0.0:
            continue
        # In the axes of a planet, which go round with its carrier, it turns with what is left of the speed.
        turns = system.layout.turns(item.shaft)
        sense = system.direction * (-1 if turns < 0.0 else 1)
        f = np.zeros(system.dofs.transform.shape[0], complex)
        node = nodes.at(*system.layout.place(f"unbalances.{name}"))
        size = item.magnitude * ratio**2 * cmath.exp(1j * sense * item.phase)
        f[6 * node] = size
        f[6 * node + 1] = -1j * sense * size
        part = replace(blank, ratio=abs(turns), unbalance=system.dofs.transform.T @ f, minor=False)
        yield ("shaft", 1, round(abs(turns), 9)), item.shaft, part


def _meshes(setup: Setup, blank: Order, left: list[Note]) -> Iterable[_Part]:
    """Every harmonic that a mesh is given."""
    system = setup.system
    load = system.state.about_nominal_flanks
    for k, state in enumerate(setup.lines.states):
        mesh = system.layout.mesh(state.contact.mesh)
        phase = load.phase(state.contact)
        ratio = mesh.order
        if phase is None or ratio == 0.0:
            continue
        for row, harmonic, amplitude in _harmonics(setup, k, mesh.part, left):
            term = np.zeros(len(setup.lines.states), complex)
            term[k] = amplitude * cmath.exp(1j * harmonic * phase)
            part = replace(blank, ratio=harmonic * ratio, minor=False)
            part = replace(part, force=term) if row else replace(part, error=term)
            yield ("mesh", harmonic, round(harmonic * ratio, 9)), mesh.name, part


def _harmonics(setup: Setup, contact: int, mesh: Mesh, left: list[Note]) -> Iterable[tuple[int, int, complex]]:
    """(0: error in m, 1: force in N; harmonic; amplitude) of what the file lets vary in a contact over its cycle."""
    state = setup.lines.states[contact]
    address = f"meshes.{state.contact.mesh}"
    first_order = Note(
        address, "the product of its varying stiffness and the vibration", "it acts to first order, as a force"
    )
    mean_force = float(setup.mean_force[contact])
    # What opens the nominal flanks closes the others.
    opens = 1.0 if setup.system.state.is_nominal(state) else -1.0
    for item in mesh.transmission_error:
        yield 0, item.harmonic, opens * item.amplitude * cmath.exp(1j * item.phase)
    for share in mesh.stiffness_variation:
        yield 1, share.harmonic, mean_force * share.amplitude * cmath.exp(1j * share.phase)
    if mesh.stiffness_variation and mean_force:
        left.append(first_order)
    loaded_teeth = setup.joint is not None and setup.joint.own[contact] >= 0
    pieces = cycle_pieces(setup.system, state) if mean_force and not loaded_teeth else ()
    if pieces:
        kept, rest = strong(harmonics_of_pieces(pieces))
        yield from ((1, n, mean_force * c) for n, c in kept)
        left += [first_order, *_weak(address, "stiffness", rest)]
    if mesh.corner_impact is not None:
        pulse = mesh.corner_impact
        kept, rest = strong(harmonics_of_pulse(pulse.duration, pulse.at))
        yield from ((1, n, opens * pulse.force * c) for n, c in kept)
        left += _weak(address, "corner impact", rest)


def _weak(part: str, what: str, rest: float) -> list[Note]:
    """A note on the largest of the harmonics that are left out, relative to the strongest of all."""
    return [Note(part, f"harmonics of its {what} of up to {100.0 * rest:.2g} % of the strongest")] if rest > 0.0 else []


def _loaded_teeth(setup: Setup, blank: Order, left: list[Note]) -> Iterable[_Part]:
    """The harmonics of the joint state of loaded teeth.

    The damping of a contact is that of its deflection: what the approach is at first touch acts as a transmission error e, and
    the force f + k e makes up for it in k (v.q - e).
    """
    joint = setup.joint
    for cycle in () if joint is None else joint.cycles:
        assert joint is not None
        if not cycle.ratio:
            continue
        f = joint.excitation(cycle)
        # Contacts are weighed by the deflection of their force, and by the approach that it makes at a crawl: where
        # helices share a load these are two curves.
        k = np.where(joint.stiffness > 0.0, joint.stiffness, np.inf)
        approach = np.where(joint.own >= 0, joint.pressed(cycle), 0.0)
        deflections = np.hstack([f / k, approach - approach.mean(axis=0)])
        sizes = np.hstack([np.abs(setup.mean_force) / k, np.abs(approach).max(axis=0)])
        numbers, major, weak, change = that_matter(deflections, cycle.periods, sizes)
        if weak > 0.0:
            which = f"orders of their loaded teeth of up to {100.0 * weak:.2g} % of the strongest"
            size = f"they would change its peak to peak at a crawl by {100.0 * change:.2g} %"
            left.append(Note("", f"meshes {', '.join(cycle.meshes)}", f"{which}; {size}"))
        error = joint.no_load(cycle)
        errors, forces, couples = (
            harmonics_of_cycle(values) for values in (error, f + joint.stiffness * error, joint.couple(cycle))
        )
        for n in numbers:
            ratio = n / cycle.periods * cycle.ratio
            minor = n not in major
            part = Order("", ratio, blank.unbalance, errors[n - 1], forces[n - 1], couples[n - 1], minor)
            for kind, name, harmonic in _named(setup.system, cycle, Fraction(n, cycle.periods)):
                yield (kind, harmonic, round(ratio, 9)), name, part
                part = replace(blank, ratio=ratio, minor=minor)  # further names of one order add nothing to it


def _named(system: System, cycle: Cycle, multiple: Fraction) -> Iterable[tuple[str, str, int | Fraction]]:
    """(kind, name, harmonic) of a multiple of the mesh frequency: of the meshes, or of a shaft whose teeth are not alike."""
    if multiple.denominator == 1:
        yield from (("mesh", mesh, multiple.numerator) for mesh in cycle.meshes)
        return
    shafts: dict[str, int] = {}
    for name in cycle.meshes:
        for gear in system.layout.mesh(name).gears:
            turns = multiple * (gear.part.teeth or 0)
            if turns.denominator == 1:
                shafts.setdefault(gear.shaft, turns.numerator)
    if not shafts:
        yield from (("mesh", mesh, multiple) for mesh in cycle.meshes)
    yield from (("shaft", shaft, harmonic) for shaft, harmonic in shafts.items())
