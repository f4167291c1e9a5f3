"""Campbell diagram: the modes of a gearbox over the speed of its input shaft, followed as branches, with excitation lines.

Every shaft turns at its own ratio. Modes come from a certified basis (`snapshot_basis`), are followed by `branches`, and
are damped and gyroscopic as in `modal` at a speed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rotorgear.analysis.campbell.branches import Track, track
from rotorgear.analysis.campbell.crossings import Chain, crossings, margins, roots
from rotorgear.analysis.campbell.discretise import system_for_speeds
from rotorgear.analysis.campbell.snapshot_basis import Request, SpeedModes
from rotorgear.analysis.campbell.speed_family import merged
from rotorgear.analysis.campbell.speeds import DEFAULT_SPEEDS, chosen_speeds, highest_speed, mesh_reach, operating_speed
from rotorgear.analysis.common.casings import casing_warnings, reduction_errors, serving
from rotorgear.analysis.common.discretise import pieces
from rotorgear.analysis.common.excitation import MESH_ORDERS, SHAFT_ORDERS, excitation_orders
from rotorgear.analysis.common.left_out import left_out
from rotorgear.analysis.common.recorded import Clock, recorded
from rotorgear.analysis.common.request import check_request, check_whole, missed
from rotorgear.analysis.modal.branch_shapes import BasisShapes, Portraits, whirl_numbers
from rotorgear.analysis.modal.refine import errors_of, total_error
from rotorgear.analysis.static.lowest_speed import lowest_speed
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.campbell import CampbellResult, Crossing, ExcitationOrder, Margin, Onset
from rotorgear.results.laws import about as about_state
from rotorgear.results.laws import law_rows
from rotorgear.solvers.sparse.factor import single_thread
from rotorgear.system.system import System

DEFAULT_MODES = 24
# Share of the range by which two speeds are one but for rounding.
_SAME_SPEED = 1e-9


@recorded
def campbell(
    model: Model | System,
    *,
    start: float | str | None = None,
    stop: float | str | None = None,
    points: int = DEFAULT_SPEEDS,
    speeds: Sequence[float | str] | None = None,
    modes: int | None = None,
    fmax: float | None = None,
    elements: int | None = None,
    accuracy: float | None = None,
    only: Sequence[str] = (),
    shaft_orders: Sequence[float] = SHAFT_ORDERS,
    mesh_orders: Sequence[int] = MESH_ORDERS,
    sidebands: int = 0,
    error_estimate: bool = True,
    progress: Progress = silent,
) -> CampbellResult:
    """Return the modes of a model over a range of speeds, as branches.

    Args:
        model: a model, or its assembled system, which is then taken as it is.
        start: lowest speed of the input shaft in rad/s or with its unit (default: 0, with oil films the lowest speed at which
            they carry).
        stop: highest speed of the input shaft (default: 1.25 times the operating speed).
        points: number of speeds between them, evenly spaced.
        speeds: these speeds, all of one sense, in place of an evenly spaced range.
        modes: a branch is returned when it is among this many lowest oscillating modes at one of the speeds (default: 24, or
            all up to 1.05 times the first order of every mesh at the operating speed where that is further, some 120 at most).
        fmax: all modes up to this many Hz at one of the speeds, in place of a number.
        elements: as in `modal`.
        accuracy: as in `modal`; it is met at both ends of the range.
        only: as in `modal`.
        shaft_orders: orders of every shaft that are drawn as lines of excitation.
        mesh_orders: orders of every mesh that are drawn as lines of excitation.
        sidebands: number of sidebands on each side of a mesh order, at the distance of the speed of both shafts of the mesh.
        error_estimate: False leaves the estimate of the discretisation error out, for timing.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: no speeds, speeds of both senses, a speed outside of a bearing's table, nothing that oscillates.
        ConvergenceError: a guard of a solver was not met.
    """
    parts = model.model if isinstance(model, System) else model
    begun = ""
    if start is None and speeds is None:
        start, begun = lowest_speed(parts, None, highest_speed(parts, stop))
    asked = chosen_speeds(parts, speeds, start or 0.0, stop, points)
    beyond = ""
    if modes is None and fmax is None:
        if mesh_orders and not isinstance(model, System):  # a given system has the mesh it has
            fmax, beyond = mesh_reach(model)
        modes = DEFAULT_MODES if fmax is None else None
    _check(modes, fmax, sidebands)
    clock = Clock()
    about = linear_system(model, [float(speed) for speed in asked])
    model, few = (about, ()) if isinstance(model, System) else serving(model, fmax)
    ends = [float(asked[0]), float(asked[-1])]
    system = system_for_speeds(
        model,
        ends,
        modes=modes,
        fmax=fmax,
        elements=elements,
        accuracy=accuracy,
        only=tuple(only),
        state=about.state,
        progress=progress,
    )
    clock.lap("mesh")
    request = Request(modes, None if fmax is None else 2.0 * np.pi * fmax, tuple(only))
    with single_thread(system.n):
        found = SpeedModes(system, min(ends), max(ends), request, progress)
        clock.lap("basis")
        operating = operating_speed(system.model)
        grid = _grid(found, asked, operating)
        chains, tracks = _chains(found, grid, asked, request, progress)
        if not chains:
            raise AnalysisError("no mode oscillates in this range of speeds, so there is nothing to draw")
        clock.lap("modes over speed")
        estimate = _error_estimate(system, found, chains, grid, error_estimate)
        clock.lap("error estimate")
        lines = excitation_orders(system.model, shaft_orders, mesh_orders, sidebands)
        result = _result(system, found, (asked, grid, operating), chains, tracks, estimate, lines, clock, progress)
    worst = float(np.max(estimate, initial=0.0, where=np.isfinite(estimate)))
    short = missed(
        accuracy, worst, "branches that rise into the range between its ends are not refined for; ask for more modes"
    )
    return replace(
        result,
        model=parts,
        left_out=(*result.left_out, *(note for note in (begun, beyond) if note)),
        warnings=(*result.warnings, *few, *_reduction_warnings(system, found, chains), *([short] if short else [])),
        status=short or "success",
    )


def _check(modes: int | None, fmax: float | None, sidebands: int) -> None:
    check_request(None, modes, fmax, None, None)
    check_whole("the number of sidebands", sidebands, 0)


def _grid(found: SpeedModes, asked: np.ndarray, operating: float | None) -> np.ndarray:
    """Speeds of the track: those asked for, the operating speed, and those where a bearing's table has a row."""
    low = float(asked.min())
    high = float(asked.max())
    extra = [*found.family.knots] + ([operating] if operating is not None and low < operating < high else [])
    new = [speed for speed in extra if np.min(np.abs(asked - speed)) > _SAME_SPEED * max(high - low, 1e-300)]
    grid = merged(sorted([*map(float, asked), *map(float, new)]), high - low)
    return grid if abs(asked[-1]) >= abs(asked[0]) and asked[-1] >= 0.0 else grid[::-1]


def _chains(
    found: SpeedModes, grid: np.ndarray, asked: np.ndarray, request: Request, progress: Progress
) -> tuple[list[Chain], list[Track]]:
    """Branches that are asked for at one of the speeds asked for at least, lowest first."""
    for k, speed in enumerate(grid):
        progress(0.5 + 0.3 * k / len(grid), f"speed {k + 1} of {len(grid)}")
        parts = found.at(speed)
    wanted = [_wanted(found, speed, request) for speed in grid]
    of_interest = np.isin(grid, asked)
    chains = []
    tracks = []
    for group in range(len(parts)):
        watched = max((counts[group] for counts in wanted), default=0)
        if not watched:
            continue
        tracks.append(track(lambda speed, group=group: found.at(speed)[group], grid, watched + 1))  # type: ignore[misc]
        number = tracks[-1].number
        limit = np.array([counts[group] for counts in wanted])[:, None]
        kept = np.any((number >= 0) & (number < limit) & of_interest[:, None], axis=0)
        chains += [_chain(found, grid, group, number[:, k]) for k in np.flatnonzero(kept)]

    def first_place(chain: Chain) -> tuple[int, float]:
        first = int(np.argmax(np.isfinite(chain.s)))
        return first, float(np.abs(chain.s[first]))

    return sorted(chains, key=first_place), tracks


def _wanted(found: SpeedModes, speed: float, request: Request) -> list[int]:
    """How many of the lowest modes of each group are asked for at a speed."""
    frequencies = [np.abs(found.damped(part.s)) for part in found.at(speed)]
    together = np.sort(np.concatenate(frequencies))
    count = request.asked(together)
    if count == 0:
        return [0] * len(frequencies)
    # Equal frequencies of two groups count in both: rounding must not decide which of them is asked for.
    return [int(np.sum(group <= together[count - 1] * (1.0 + 1e-12))) for group in frequencies]


def _chain(found: SpeedModes, grid: np.ndarray, group: int, number: np.ndarray) -> Chain:
    r = found.at(grid[0])[group].q.shape[0]
    s = np.full(len(grid), np.nan + 0j)
    q = np.full((len(grid), r), np.nan + 0j)
    for k, place in enumerate(number):
        if place >= 0:
            part = found.at(grid[k])[group]
            s[k] = part.s[place]
            q[k] = part.q[:, place]
    return Chain(group, s, q)


def _reduction_warnings(system: System, found: SpeedModes, chains: list[Chain]) -> tuple[str, ...]:
    """A sentence where the reduction of casings makes a mode as low as the branches wrong by more than a thousandth."""
    if not system.model.casings:
        return ()
    top = max(float(np.nanmax(np.abs(chain.s))) for chain in chains)
    first = found.snapshots[0]
    low = np.abs(first.s) <= top
    s = first.s[low]
    return tuple(casing_warnings(reduction_errors(system, s, first.vectors[:, low]), s))


def _error_estimate(
    system: System, found: SpeedModes, chains: list[Chain], grid: np.ndarray, wanted: bool
) -> np.ndarray:
    """Estimated relative discretisation error of each branch (b,), the larger of both ends of the range."""
    estimate = np.full(len(chains), np.nan)
    if not wanted:
        return estimate
    for snapshot in found.snapshots[:2]:
        k = int(np.argmin(np.abs(grid - snapshot.speed)))
        parts = errors_of(system, snapshot.speed, snapshot.s, snapshot.vectors, np.zeros(len(snapshot.s), bool))
        error = total_error(parts, len(snapshot.s)) + reduction_errors(system, snapshot.s, snapshot.vectors)
        for b, chain in enumerate(chains):
            if np.isfinite(chain.s[k]):
                distance = np.abs(snapshot.s - chain.s[k])
                near = int(np.argmin(distance))
                if distance[near] <= 1e-6 * abs(chain.s[k]):
                    estimate[b] = np.fmax(estimate[b], error[near])
    return estimate


def _onsets(found: SpeedModes, chains: list[Chain], grid: np.ndarray) -> tuple[Onset, ...]:
    """Where branches start to grow with speed, and where a motion that doesn't oscillate does."""
    onsets: list[Onset] = []
    if found.family.is_conservative:
        return ()
    for b, chain in enumerate(chains):
        first = chain.s[0]
        if np.isfinite(first) and first.real > 1e-9 * abs(first):
            onsets.append(Onset(b + 1, float(grid[0]), float(first.imag) / (2.0 * np.pi)))
        for root in roots(found, chains, grid, b, _growth):
            k = int(np.searchsorted(np.abs(grid), abs(root.speed)))
            if chain.s[min(k, len(grid) - 1)].real > 0.0:
                onsets.append(Onset(b + 1, root.speed, float(root.s.imag) / (2.0 * np.pi)))
    for speed in grid:
        if any(np.any(part.real > 0.0) for part in found.at(speed)):
            onsets.append(Onset(0, float(speed), 0.0))
            break
    return tuple(sorted(onsets, key=lambda onset: abs(onset.speed)))


def _growth(s: complex, speed: float) -> float:
    """Real part of s; what is rounding counts as decay."""
    return s.real - 1e-10 * abs(s)


def _result(
    system: System,
    found: SpeedModes,
    speeds: tuple[np.ndarray, np.ndarray, float | None],
    chains: list[Chain],
    tracks: list[Track],
    estimate: np.ndarray,
    lines: tuple[ExcitationOrder, ...],
    clock: Clock,
    progress: Progress,
) -> CampbellResult:
    asked, grid, operating = speeds
    progress(0.85, "crossings")
    shapes = BasisShapes(system, found.basis())
    met = crossings(found, shapes, chains, grid, lines)
    onsets = _onsets(found, chains, grid)
    clock.lap("crossings")
    progress(0.92, "energies")
    kept = np.flatnonzero(np.isin(grid, asked))
    s = found.damped(np.array([chain.s for chain in chains]).T)
    coordinates, seen = _looks(shapes, chains, grid, kept)
    margin = _margins(shapes, chains, grid, s, lines, met, operating)
    clock.lap("energies")
    k = len(kept)
    b = len(chains)
    there = np.isfinite(s[kept]).ravel()

    def spread(values: np.ndarray, empty: float = np.nan) -> np.ndarray:
        whole = np.full(k * b, empty, dtype=values.dtype)
        whole[there] = values
        return whole.reshape(k, b)

    def every(shares: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        return {name: spread(values) for name, values in shares.items()}

    strain = {name: v for name, v in seen.energies.strain.items() if name.startswith("meshes.")}
    # A branch is described by its mode at the first speed where it oscillates: all of them exist there, but not everywhere.
    first = [int(np.argmax(np.isfinite(chain.s))) for chain in chains]
    columns = [shapes.coordinates(chain.group, chain.q[n][:, None]) for chain, n in zip(chains, first, strict=True)]
    halvings = sum(branches.halvings for branches in tracks)
    bound = 10.0 ** np.ceil(np.log10(max(found.error, 1e-10)))  # what is below is rounding
    result = CampbellResult(
        model=system.model,
        speeds=grid[kept],
        eigenvalues=s[kept],
        whirl=spread(whirl_numbers(seen.words), 0),
        whirl_by_shaft=every(seen.whirl.net),
        kinetic_by_motion=every(seen.energies.kinetic_by_motion),
        strain_by_motion=every(seen.energies.strain_by_motion),
        mesh_strain={name.removeprefix("meshes."): v for name, v in every(strain).items()},
        description=shapes.descriptions(np.hstack(columns), grid[first]),
        error_estimate=estimate,
        basis_error=found.error,
        basis=shapes.stations,
        coordinates=coordinates,
        nodes=shapes.nodes,
        lines=lines,
        crossings=met,
        margins=margin,
        onsets=onsets,
        operating_speed=operating,
        dofs=system.n,
        discretisation=pieces(system),
        seconds=clock.total(),
        laws=law_rows(system.state.operating),
        left_out=_left_out(system, found, grid, operating),
        warnings=_warnings(system, found, tracks, onsets),
        method=f"basis of {found.size} columns from {len(found.snapshots)} true solutions, {len(found.checks)} more as a "
        f"check: off by at most {bound:.0e}; {len(grid)} speeds, {halvings} steps halved to follow the modes"
        + about_state(system.state),
    )
    progress(1.0, "done")
    return result


def _looks(
    shapes: BasisShapes, chains: list[Chain], grid: np.ndarray, kept: np.ndarray
) -> tuple[np.ndarray, Portraits]:
    """Coordinates (k, r, b) of all branches, and their portraits at all speeds where they exist, speed by speed."""
    r = int(shapes.offsets[-1])
    coordinates = np.zeros((len(kept), r, len(chains)), complex)
    for b, chain in enumerate(chains):
        whole = shapes.coordinates(chain.group, chain.q[kept].T)
        coordinates[:, :, b] = np.nan_to_num(whole.T)
    there = np.isfinite(np.array([chain.s[kept] for chain in chains]).T)
    flat = np.moveaxis(coordinates, 1, 0)[:, there]
    speeds = np.broadcast_to(grid[kept][:, None], there.shape)[there]
    return coordinates, shapes.portraits(flat, speeds)


def _margins(
    shapes: BasisShapes,
    chains: list[Chain],
    grid: np.ndarray,
    s: np.ndarray,
    lines: tuple[ExcitationOrder, ...],
    met: tuple[Crossing, ...],
    operating: float | None,
) -> tuple[Margin, ...]:
    if operating is None or (place := _place_of(operating, grid)) is None:
        return ()
    known = [chain for chain in chains if np.isfinite(chain.s[place])]
    if not known:
        return ()
    columns = np.hstack([shapes.coordinates(chain.group, chain.q[place][:, None]) for chain in known])
    seen = shapes.portraits(columns, np.full(len(known), operating))
    return margins(lines, met, operating, s[place], seen)


def _place_of(speed: float, grid: np.ndarray) -> int | None:
    """Number of a speed in the grid; None where it lies outside. A range that is cut evenly meets it to rounding only."""
    place = int(np.argmin(np.abs(grid - speed)))
    return place if abs(grid[place] - speed) <= _SAME_SPEED * max(float(np.ptp(grid)), 1e-300) else None


def _left_out(system: System, found: SpeedModes, grid: np.ndarray, operating: float | None) -> tuple[str, ...]:
    notes: list[str] = [*left_out(system, "modes", float(grid[-1]))]
    rigid = found.snapshots[0].rigid.shape[1]
    if rigid:
        notes.append(f"{rigid} rigid-body mode{'s'[: rigid != 1]} at 0 Hz")
    still = max(sum(len(part.real) for part in found.at(speed)) for speed in grid)
    if still:
        notes.append("motions that do not oscillate (overdamped): they have no frequency to draw")
    if operating is None:
        notes.append("margins: the model has no operating speed")
    elif _place_of(operating, grid) is None:
        notes.append("margins: the operating speed lies outside of the range")
    return (*notes, *found.notes)


def _warnings(system: System, found: SpeedModes, tracks: list[Track], onsets: tuple[Onset, ...]) -> tuple[str, ...]:
    notes = list(system.nodes.merged)
    for onset in onsets[:3]:
        what = f"branch {onset.branch}" if onset.branch else "a motion that does not oscillate"
        notes.append(f"{what} is unstable from {onset.speed * RPM_PER_RAD_S:.6g} rpm on: the motion grows")
    unsure = [speed for track in tracks for speed in track.unsure]
    if unsure:
        places = ", ".join(f"{speed * RPM_PER_RAD_S:.6g}" for speed in unsure[:3])
        notes.append(f"two branches can't be told apart near {places} rpm: they meet or part there in a point")
    return tuple(notes)
