"""What a finer mesh says about the largest forces of a response, and whether its speeds are dense enough to see the peaks."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from rotorgear.analysis.modal.refine import all_finer
from rotorgear.analysis.response.mesh import damped_modes
from rotorgear.analysis.response.orders import Order, orders_of
from rotorgear.analysis.response.plant import Plant, Readings
from rotorgear.analysis.response.run_up import solve_orders
from rotorgear.analysis.static.mean_state import Setup
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.system.contacts import contact_lines

_CHECKED_ON_FINER = 4
# Of an order: so many speeds where it is highest, and so many where its elements lack most.
_PEAKS = 2
# A resonance shows its height to this share when its half-power width spans so many speeds.
_SPEEDS_A_PEAK = 2.0
# An order pushes a mode that takes more than this share of what the most pushed one takes: the rest is rounding.
_PUSHED = 1e-9
# A width of a resonance below this share of the speed is rounding: nothing damps it.
_UNDAMPED = 1e-12


def mesh_error(
    plant: Plant,
    orders: list[Order],
    speeds: np.ndarray,
    readings: list[Readings],
    damping: tuple[float, float],
    setup: Setup,
) -> float:
    """Change of the forces of the strongest orders on a finer mesh, relative to the largest force of the order.

    The finer mesh has two orders more in every piece, or twice the elements. It is looked at where an order is highest, and where
    what the elements lack would change it most: that may be on the flank of a resonance, or at the low peak of a higher mode.
    """
    system = plant.system
    if not any(system.nodes.elements.values()):
        return 0.0
    finer = system.with_plan(all_finer(system))
    lines = contact_lines(finer)
    zeta, limit = damping
    rich = Plant(finer, lines, (*damped_modes(finer, limit, float(speeds[-1])), zeta) if zeta else None)
    forces = np.array([item.stacked for item in readings])  # (s, o, ...)
    if not forces.size:
        return float("nan")  # the model has no part and no point whose answer could be compared
    size = np.abs(forces).max(axis=2, initial=0.0)
    lacking = np.array([item.bubble_change for item in readings])  # (s, o)
    worst = 0.0
    wanted = {order.name: order for order in orders_of(replace(setup, system=finer, lines=lines))[0]}
    for o in strongest_orders(size):
        order = [wanted[orders[o].name]]
        changed = 0.0
        largest = float(size[:, o].max())
        for s in np.union1d(highest_peaks(size[:, [o]], _PEAKS), highest_peaks(lacking[:, [o]], _PEAKS)):
            w, f = rich.loads(order, float(speeds[s]))
            q = solve_orders(rich, rich.dynamics(float(speeds[s])), w, f)
            there = rich.read(order, float(speeds[s]), w, q).stacked[0]
            largest = max(largest, float(np.abs(there).max(initial=0.0)))
            changed = max(changed, float(np.abs(there - forces[s, o]).max()))
        if largest:
            worst = max(worst, changed / largest)
    return worst


def strongest_orders(size: np.ndarray) -> np.ndarray:
    """Numbers of the orders, largest first, for which the error is stated, from amplitudes (s, o)."""
    return np.argsort(-size.max(axis=0), kind="stable")[:_CHECKED_ON_FINER]


def highest_peaks(size: np.ndarray, count: int) -> np.ndarray:
    """Rows of the `count` highest local maxima of each column, the ends among them, of sizes (r, c): each row once, rising."""
    padded = np.pad(size, ((1, 1), (0, 0)), constant_values=-1.0)
    peaks = (size >= padded[:-2]) & (size > padded[2:])
    ranked = np.argsort(-np.where(peaks, size, -1.0), axis=0, kind="stable")[:count]
    return np.unique(ranked[np.take_along_axis(peaks, ranked, axis=0)])


def speed_warnings(
    plant: Plant, orders: list[Order], speeds: np.ndarray, modes: tuple[np.ndarray, np.ndarray, float]
) -> list[str]:
    """Sentences on damping that is missing, and on speeds too far apart for the sharpest resonance of the run-up."""
    shapes, w, zeta = modes
    elastic = w > 0.0
    if not elastic.any():
        return []
    C = (
        plant.system.damping(float(np.max(np.abs(speeds))))
        if not plant.has_tables
        else plant.system.damping(float(speeds[-1]))
    )
    ratios = np.einsum("nm,nm->m", shapes, C @ shapes)[elastic] / (2.0 * w[elastic]) + zeta
    if float(ratios.max()) <= 0.0:
        return [
            "nothing damps the model: amplitudes near a resonance are as high as the nearest speed happens to be; give a damping"
        ]
    if len(speeds) < 2:
        return []
    step = float(np.max(np.diff(np.sort(np.abs(speeds)))))
    top = float(np.max(np.abs(speeds)))
    width = np.inf
    for order in orders:
        if not order.ratio:  # its frequency does not sweep over resonances
            continue
        # A mode that the order does not push, as an axial one of spur gears, has no resonance with it.
        pushed = np.abs(shapes[:, elastic].T @ plant.loads([order], float(speeds[-1]))[1][:, 0])
        met = (w[elastic] >= order.ratio * float(np.min(np.abs(speeds)))) & (w[elastic] <= order.ratio * top)
        met &= pushed > _PUSHED * pushed.max(initial=0.0)
        if met.any():
            width = min(width, float(np.min(2.0 * ratios[met] * w[elastic][met])) / order.ratio)
    if width >= _SPEEDS_A_PEAK * step:
        return []
    apart = step * RPM_PER_RAD_S
    wide = width * RPM_PER_RAD_S
    if width <= _UNDAMPED * top:
        return [
            "nothing damps a resonance that is met: its peak is as high as the nearest speed happens to be; give a damping"
        ]
    return [
        f"speeds are {apart:.4g} rpm apart, but the sharpest resonance met is {wide:.2g} rpm wide at half power: "
        "its peak may be higher than shown; more points or a narrower range show it"
    ]


def parting(setup: Setup, force: np.ndarray, speeds: np.ndarray) -> list[str]:
    """A sentence for each mesh whose teeth would part: dynamic force (o, s, c) of one order above the mean force."""
    found = []
    lines = setup.lines
    for mesh in dict.fromkeys(lines.names):
        contacts = [k for k, name in enumerate(lines.names) if name == mesh]
        mean = np.maximum(setup.mean_force[contacts], 1e-300)
        share = np.abs(force[:, :, contacts]).max(axis=0) / mean  # (s, contacts)
        over = np.flatnonzero(share.max(axis=1) > 1.0)
        if not over.size:
            continue
        if not np.any(setup.mean_force[contacts] > 0.0):
            found.append(
                f"meshes.{mesh} carries no mean force: its teeth part, and the linear answer takes them as joined"
            )
            continue
        rpm = np.abs(speeds[over]) * RPM_PER_RAD_S
        found.append(
            f"meshes.{mesh}: its dynamic force exceeds the mean force at {len(over)} of {len(speeds)} speeds, between "
            f"{rpm.min():.6g} and {rpm.max():.6g} rpm; there the teeth part, and the linear answer ends"
        )
    return found
