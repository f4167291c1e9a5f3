"""What a response leaves out of its loaded teeth, by its size at each peak.

The linear force of a contact is F_m + k (delta - delta_m) + f(u). Its map gives F(delta, u) on the linear solution; the rest,

    r = F(delta(t), u) - F_m - k (delta - delta_m) - f(u),

holds the product of varying stiffness and vibration, (k_t(u) - k)(delta - delta_0), and what the map bends beyond. At a crawl
it is zero. Put through the receptance of the linear plant it moves the contacts; r there, put through it once more, is the size
of what is left out. (One step would miss that the product of two harmonics comes back to the first of them.) That holds
as long as no teeth part; where the map says that they do, no size is given.

The orders of one mesh cycle shake together; what orders of other frequencies add to r is not in it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from rotorgear.analysis.response.order import Order
from rotorgear.analysis.response.plant import Plant, Readings, gathered
from rotorgear.analysis.response.run_up import answer
from rotorgear.analysis.static.joint_state import Cycle, JointState
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.response import Peak

_SAME_FREQUENCY = 1e-9
# Harmonics of r that move the contacts: the number of the strongest, down to this share of the largest.
_STRONG = 12
_WEAK = 0.02
# Quantities with an amplitude along each axis.
_ALONG_AXES = ("bearing force", "seat force", "ground force", "displacement")


def peaks_of(
    joint: JointState | None, plant: Plant, orders: Sequence[Order], speeds: np.ndarray, readings: Readings
) -> tuple[Peak, ...]:
    """The largest amplitude of each quantity of meshes, bearings and points, with the size of what is left out beside it.

    Args:
        joint: the state of the loaded teeth that the response is about; None without any.
        plant, orders, speeds: what was solved, (o,) orders at (s,) speeds in rad/s. readings: of all of them, (s, o, ...).
    """
    known: dict[tuple[int, int], tuple[Readings | None, bool]] = {}
    found = []
    for quantity, part, unit, values in _quantities(plant, readings):
        size = np.abs(values)  # (s, o, ...)
        s, o, *rest = (int(i) for i in np.unravel_index(int(np.argmax(size)), size.shape))
        amplitude = float(size[(s, o, *rest)])
        if not amplitude:
            continue
        if (s, o) not in known:
            known[s, o] = _left_out(joint, plant, orders, o, float(speeds[s]), readings.pressed[s])
        reading, parts = known[s, o]
        left = None
        if reading is not None and not parts:
            there = next(v for q, p, _, v in _quantities(plant, gathered([reading])) if (q, p) == (quantity, part))
            left = float(np.abs(there[(0, 0, *rest)]))
        found.append(
            Peak(
                quantity=quantity,
                part=part,
                axis="xyz"[rest[0]] if quantity in _ALONG_AXES else "",
                unit=unit,
                order=o,
                speed_rpm=float(abs(speeds[s]) * RPM_PER_RAD_S * np.sign(speeds[s])),
                frequency_hz=orders[o].frequency_at(float(speeds[s])) / (2.0 * math.pi),
                amplitude=amplitude,
                left_out=left,
                teeth_part=parts,
            )
        )
    return tuple(found)


def _quantities(plant: Plant, readings: Readings) -> Iterable[tuple[str, str, str, np.ndarray]]:
    """(quantity, part, unit, values (s, o, ...)) of all rows of the table of the largest amplitudes."""
    names = plant.lines.names
    model = plant.system.model
    for mesh in dict.fromkeys(names):
        contacts = [k for k, name in enumerate(names) if name == mesh]
        for field, unit in (("mesh_force", "N"), ("transmission_error", "m"), ("approach", "m")):
            yield field.replace("_", " "), mesh, unit, getattr(readings, field)[:, :, contacts]
    for k, name in enumerate(model.bearings):
        yield "bearing force", name, "N", readings.bearing_force[:, :, k]
    for k, name in enumerate(plant.points):
        unit = "rad/s^2" if model.points[name].turns else "m/s^2"
        yield "acceleration", name, unit, readings.acceleration[:, :, k]
    for k, (name, unit) in enumerate(plant.load_units.items()):
        yield "internal load", name, unit, readings.internal_load[:, :, k]
    for k, (name, standing) in enumerate(plant.seats.items()):
        # The load of a seat with one bearing and nothing else is that of the bearing.
        if len(standing) > 1 or not standing[0].startswith("bearings."):
            yield "seat force", name, "N", readings.casing_seat_force[:, :, k, :3]
    for k, name in enumerate(plant.ground.names):
        yield "ground force", name, "N", readings.casing_ground_force[:, :, k, :3]
    for k, name in enumerate(plant.surfaces):
        yield "normal velocity", name, "m/s", readings.normal_velocity[:, :, k]
    if not model.bearings and not names:
        for k, place in enumerate(plant.places):
            yield "displacement", place, "m", readings.displacement[:, :, k, :2]


def _left_out(
    joint: JointState | None, plant: Plant, orders: Sequence[Order], o: int, speed: float, pressed: np.ndarray
) -> tuple[Readings | None, bool]:
    """What the rest r adds to the readings of an order at a speed, None where no loaded teeth run at it; whether teeth part.

    `pressed` (o, c) are the approaches of all orders there.
    """
    for number, cycle in enumerate(joint.cycles if joint is not None else ()):
        multiple = _multiple(cycle, orders[o])
        if not multiple:
            continue
        assert joint is not None
        # Approach (p, c) of the linear solution over the cycle, along the flank normals at the places of contact, in m.
        count = len(cycle.position)
        spectrum = np.fft.rfft(joint.pressed(cycle), axis=0) / count
        for order, amplitudes in zip(orders, pressed, strict=True):
            n = _multiple(cycle, order)
            if 0 < n < len(spectrum):  # weak orders, which were not solved, follow as at a crawl
                spectrum[n] = 0.5 * amplitudes
        delta = np.fft.irfft(spectrum * count, count, axis=0)
        rest, parts = _rest(joint, number, delta)
        moved = _moved(plant, speed, joint, cycle, np.fft.rfft(rest, axis=0) / len(rest))
        again, part_again = _rest(joint, number, delta + moved)
        coefficient = 2.0 * np.fft.rfft(again, axis=0)[multiple] / len(again)
        return _answer(plant, speed, orders[o].ratio, coefficient), parts or part_again
    return None, False


def _multiple(cycle: Cycle, order: Order) -> int:
    """Which harmonic of a whole cycle an order is; 0 for none."""
    n = order.ratio * cycle.periods / cycle.ratio if cycle.ratio else 0.0
    return round(n) if n and abs(n - round(n)) <= _SAME_FREQUENCY * n else 0


def _rest(joint: JointState, number: int, delta: np.ndarray) -> tuple[np.ndarray, bool]:
    """r (p, c) in N at approaches (p, c) over a cycle, and whether a contact opens there."""
    cycle = joint.cycles[number]
    rest = np.zeros_like(delta)
    parts = False
    f = joint.excitation(cycle)
    for i in np.flatnonzero(joint.own == number):
        force = joint.pressed_force(int(i), cycle, delta[:, i])
        linear = joint.force[i] + joint.stiffness[i] * (delta[:, i] - joint.pressed(cycle)[:, i].mean()) + f[:, i]
        rest[:, i] = force - linear
        parts = parts or bool(np.any(force <= 0.0))
    return rest, parts


def _moved(plant: Plant, speed: float, joint: JointState, cycle: Cycle, rest: np.ndarray) -> np.ndarray:
    """Approach (p, c) in m that the spectrum (h, c) of r adds by the linear plant at a speed, by its strong harmonics."""
    size = np.abs(rest).max(axis=1)
    found = np.zeros_like(rest)
    found[0] = -joint.compliance @ rest[0].real
    strongest = 1 + np.argsort(-size[1:])[:_STRONG]
    for n in strongest[size[strongest] > _WEAK * size.max()]:
        found[n] = 0.5 * _answer(plant, speed, n / cycle.periods * cycle.ratio, 2.0 * rest[n]).pressed[0]
    return np.asarray(np.fft.irfft(found * len(cycle.position), len(cycle.position), axis=0))


def _answer(plant: Plant, speed: float, ratio: float, force: np.ndarray) -> Readings:
    """Readings of the linear plant at a speed under forces of the contacts (c,) in N at a multiple of the reference speed."""
    return answer(plant, [Order("", ratio, np.zeros(plant.system.released.n), 0.0 * force, force, 0.0 * force)], speed)
