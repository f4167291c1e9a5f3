"""The system that a forced response solves, the modes that carry modal damping, and what a finer mesh says of the largest forces.

Beside it: whether the speeds are dense enough to see the peaks, and whether teeth part.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from rotorgear.analysis.common.discretise import cut_of
from rotorgear.analysis.common.left_out import GIVE_DAMPING
from rotorgear.analysis.common.request import FINEST
from rotorgear.analysis.modal.modal import ModalRequest, modes_about
from rotorgear.analysis.modal.refine import DEFAULT_ACCURACY, START, all_finer
from rotorgear.analysis.modal.solve import Wanted, solve
from rotorgear.analysis.response.order import Order
from rotorgear.analysis.response.orders import orders_of
from rotorgear.analysis.response.plant import Plant, Readings
from rotorgear.analysis.response.run_up import answer
from rotorgear.analysis.static.mean_state import Setup
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.model.layout.spring import constant_spring
from rotorgear.model.layout.state import State
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.system.plan import Plan
from rotorgear.system.system import System

# Up to this much above the highest excited frequency the mesh is refined.
_MARGIN = 1.25
# Each further round for an accuracy of amplitudes refines the frequencies by this much more.
_TIGHTER = 0.03
_CHECKED_ON_FINER = 4
# Number of speeds, of an order, where it is highest, and of those where its elements lack most.
_PEAKS = 2
# A resonance shows its height to this share when its half-power width spans this number of speeds.
_SPEEDS_A_PEAK = 2.0
# An order pushes a mode that takes more than this share of what the most pushed one takes: the rest is rounding.
_PUSHED = 1e-9
# A load below this share of the largest is rounding.
_NOTHING = 1e-9
# A width of a resonance below this share of the speed is rounding: nothing damps it.
_UNDAMPED = 1e-12
# Below this share of it a resonance is too narrow for any range of speeds: what lacks is damping, not points.
_NARROW = 1e-4


def meshed(
    model: Model,
    about: tuple[State, Setup],
    speed: float,
    fmax: float,
    elements: int | None = None,
    accuracy: float | None = None,
) -> System:
    """The system about its mean state, on the mesh that modes up to a frequency need, or on a fixed one.

    Args:
        model: a checked model. about: as `about_mean` has it.
        speed: of the reference shaft in rad/s. fmax: highest excited frequency in Hz.
        elements: number of basic elements in each shaft segment. accuracy: of the frequencies (default: 1e-3).
    """
    state, first = about
    plan = Plan() if elements is None else Plan(elements)
    if elements is None and any(shaft.sections for shaft in model.shafts.values()):
        asked = ModalRequest(fmax=_MARGIN * fmax, accuracy=accuracy or DEFAULT_ACCURACY)
        refined = modes_about(model, asked, at_speed(state, speed))
        plan = Plan(START.elements, START.order, cut_of(refined.discretisation))
    return linear_system(model, [speed], plan, state=first.with_tangents(state))


def aims(accuracy: float | None) -> Iterator[float | None]:
    """Accuracies of the frequencies to try, one after the other, for an accuracy of amplitudes.

    A light resonance turns a small error of its frequency into a large one of its height, by 1 / (2 zeta): how large is known
    from the amplitudes only.
    """
    yield accuracy
    if accuracy is not None:
        aim = accuracy * _TIGHTER
        while aim > FINEST:
            yield aim
            aim = aim * _TIGHTER


def at_speed(state: State, speed: float) -> State:
    """The conservative part of a state: bearings with tables as at a speed of the reference shaft in rad/s, no skew stiffness.

    Modes of this are real, so that a damping ratio can be given to each.

    Raises:
        AnalysisError: the speed lies outside a table.
    """
    changed = {}
    for address, spring in state.springs.items():
        stiffness, _ = state.spring_at(address, speed)
        if spring.varies or not np.array_equal(stiffness, stiffness.T):
            # The symmetric part, without directions in which it would push away: a light film has such.
            values, directions = np.linalg.eigh(0.5 * (stiffness + stiffness.T))
            kept = np.asarray((directions * np.maximum(values, 0.0)) @ directions.T)
            changed[address] = constant_spring(kept, np.zeros((6, 6)))
    return replace(state, tangents={**state.tangents, **changed}) if changed else state


def damped_modes(
    system: System, limit: float, speed: float, dofs: np.ndarray | None = None
) -> tuple[np.ndarray, np.ndarray]:
    """Undamped modes up to a frequency in rad/s: shapes (n, m) of modal mass 1, and w (m,), 0 where rigid.

    They are those of the conservative part of the model at standstill, with bearings as at a speed of the reference shaft; where
    dofs are given, only of the groups that have one of these.
    """
    conservative = at_speed(system.state, speed)
    if conservative is not system.state:
        system = system.with_state(conservative)
    among = None if dofs is None else frozenset(dofs.tolist())
    found = solve(system, Wanted(None, None, limit if np.isfinite(limit) else None, dofs=among))
    keep = np.flatnonzero(found.vectors.any(axis=0))
    return np.real(found.vectors[:, keep]), np.where(found.rigid, 0.0, np.abs(found.eigenvalues))[keep]


def damped_plant(system: System, speed: float, limit: float, zeta: float, dofs: np.ndarray | None = None) -> Plant:
    """The plant whose modes up to a limit have a damping ratio beside its own damping; arguments as for `damped_modes`."""
    return Plant(system, (*damped_modes(system, limit, speed, dofs), zeta) if zeta else None)


def mesh_error(
    plant: Plant,
    orders: list[Order],
    speeds: np.ndarray,
    readings: Readings,
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
    rich = damped_plant(finer, float(speeds[-1]), *damping)
    forces = readings.stacked  # (s, o, ...)
    if not forces.size:
        return float("nan")  # the model has no part and no point whose answer could be compared
    size = np.abs(forces).max(axis=2, initial=0.0)
    lacking = readings.bubble_change  # (s, o)
    worst = 0.0
    wanted = {order.name: order for order in orders_of(replace(setup, system=finer, lines=rich.lines))[0]}
    for o in strongest_orders(size):
        order = [wanted[orders[o].name]]
        known = [judged[:, o] for judged in readings.judged]
        changed = np.zeros(len(known))
        largest = np.array([np.abs(judged).max(initial=0.0) for judged in known])
        for s in np.union1d(highest_peaks(size[:, [o]], _PEAKS), highest_peaks(lacking[:, [o]], _PEAKS)):
            for b, there in enumerate(answer(rich, order, float(speeds[s])).judged):
                largest[b] = max(largest[b], np.abs(there).max(initial=0.0))
                changed[b] = max(changed[b], np.abs(there[0] - known[b][s]).max(initial=0.0))
        felt = largest > _NOTHING * largest.max(initial=0.0)
        worst = max(worst, float(np.max(changed[felt] / largest[felt], initial=0.0)))
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
) -> list[Note]:
    """Facts on damping that is missing, and on speeds too far apart for the sharpest resonance of the run-up."""
    shapes, w, zeta = modes
    elastic = w > 0.0
    if not elastic.any():
        return []
    top = float(np.max(np.abs(speeds)))
    C = plant.system.damping(float(speeds[-1]) if plant.has_tables else top)
    ratios = np.einsum("nm,nm->m", shapes, C @ shapes)[elastic] / (2.0 * w[elastic]) + zeta
    if float(ratios.max()) <= 0.0:
        why = f"amplitudes near a resonance are as high as the nearest speed happens to be; {GIVE_DAMPING}, or --modal-damping"
        return [Note("", "nothing damps the model", why)]
    if len(speeds) < 2:
        return []
    step = float(np.max(np.diff(np.sort(np.abs(speeds)))))
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
    if width <= _UNDAMPED * top:
        why = f"its peak is as high as the nearest speed happens to be; {GIVE_DAMPING}, or --modal-damping"
        return [Note("", "nothing damps a resonance that is met", why)]
    if width <= _NARROW * top:
        what = f"the sharpest resonance met is {width * RPM_PER_RAD_S:.2g} rpm wide at half power"
        why = (
            "its peak is as high as the nearest speed happens to be; damping of meshes reaches a mode by its strain energy in "
            f"them alone: {GIVE_DAMPING}, or --modal-damping (1 to 3 % is usual)"
        )
        return [Note("", what, why)]
    apart = f"speeds are {step * RPM_PER_RAD_S:.4g} rpm apart"
    wide = f"the sharpest resonance met is {width * RPM_PER_RAD_S:.2g} rpm wide at half power"
    why = "its peak may be higher than shown; more points or a narrower range show it"
    return [Note("", f"{apart}, but {wide}", why)]


def parting(setup: Setup, force: np.ndarray, speeds: np.ndarray) -> list[Note]:
    """A fact for each mesh whose teeth would part: dynamic force (s, o, c) of one order above the mean force."""
    found = []
    names = np.array(setup.lines.names)
    for mesh in dict.fromkeys(setup.lines.names):
        mean = setup.mean_force[names == mesh]
        share = np.abs(force[:, :, names == mesh]).max(axis=1) / np.maximum(mean, 1e-300)  # (s, contacts)
        over = np.flatnonzero(share.max(axis=1) > 1.0)
        if over.size and not np.any(mean > 0.0):
            why = "its teeth part, and the linear answer takes them as joined"
            found.append(Note("", f"meshes.{mesh} carries no mean force", why))
        elif over.size:
            rpm = np.abs(speeds[over]) * RPM_PER_RAD_S
            where = f"{len(over)} of {len(speeds)} speeds, between {rpm.min():.6g} and {rpm.max():.6g} rpm"
            what = f"its dynamic force exceeds the mean force at {where}"
            found.append(Note(f"meshes.{mesh}", what, "there the teeth part, and the linear answer ends"))
    return found
