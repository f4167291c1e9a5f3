"""Campbell diagram: the modes of a gearbox over the speed of its input shaft, followed as branches, with excitation lines.

Every shaft turns at its own ratio. Modes come from a certified basis (`snapshot_basis`), are followed by `branches`, and
are damped and gyroscopic as in `modal` at a speed.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rotorgear.analysis.campbell.crossings import Chain, crossings, margins, roots, track
from rotorgear.analysis.campbell.snapshot_basis import SpeedModes
from rotorgear.analysis.campbell.speed_family import merged
from rotorgear.analysis.campbell.speeds import (
    DEFAULT_SPEEDS,
    chosen_speeds,
    highest_speed,
    mesh_reach,
    system_for_speeds,
)
from rotorgear.analysis.common.casings import casing_warnings, reduction_errors, with_casing_modes
from rotorgear.analysis.common.discretise import pieces
from rotorgear.analysis.common.excitation import MESH_ORDERS, SHAFT_ORDERS, excitation_orders
from rotorgear.analysis.common.forecast import Forecast
from rotorgear.analysis.common.left_out import left_out
from rotorgear.analysis.common.planet_notes import class_notes
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_request, check_whole, missed
from rotorgear.analysis.common.stream import Stream
from rotorgear.analysis.common.stream import pieces as kept_pieces
from rotorgear.analysis.modal.branch_shapes import BasisShapes, whirl_numbers
from rotorgear.analysis.modal.modal import ModalRequest
from rotorgear.analysis.modal.reach import Reach
from rotorgear.analysis.modal.refine import errors_of, total_error
from rotorgear.analysis.static.lowest_speed import lowest_speed
from rotorgear.analysis.static.state_at import linear_system
from rotorgear.cpu import Clock
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model, model_hash
from rotorgear.progress import Progress, silent
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.campbell import CampbellResult, ExcitationOrder, Margin, Onset
from rotorgear.results.laws import about_state, law_rows
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
    stream: Stream | None = None,
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
        stream: keeps modes while speeds are solved (`rotorgear.stream`), and starts an interrupted run again.
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
    check_request(modes=modes, fmax=fmax)
    check_whole("the number of sidebands", sidebands, 0)
    clock = Clock()
    about = linear_system(model, [float(speed) for speed in asked])
    model, few = (about, ()) if isinstance(model, System) else with_casing_modes(model, fmax)
    ends = [float(asked[0]), float(asked[-1])]
    request = ModalRequest(None, modes, fmax, elements, accuracy, tuple(only), from_carrier=True)
    system = system_for_speeds(model, ends, request, about.state, progress)
    if system.uneven_planets and any(ends):
        # What turns with a shaft has other orders there; meshes of planets have their own.
        system = system.seen_from_carrier()
        shaft_orders, sidebands = (), 0
    clock.lap("mesh")
    reach = Reach(modes, None if fmax is None else 2.0 * np.pi * fmax)
    drawn = (tuple(shaft_orders), tuple(mesh_orders), sidebands)
    run = (asked.tolist(), modes, fmax, accuracy, tuple(only), error_estimate, drawn, pieces(system))
    piece = kept_pieces(stream, {"model": model_hash(parts), "run": repr(run)})
    with single_thread(system.n):
        found = SpeedModes(system, min(ends), max(ends), reach, tuple(only), progress, piece)
        clock.lap("basis")
        diagram = _Diagram.of(found, asked, progress)
        if not diagram.chains:
            raise AnalysisError("no mode oscillates in this range of speeds, so there is nothing to draw")
        clock.lap("modes over speed")
        estimate = diagram.error_estimate() if error_estimate else np.full(len(diagram.chains), np.nan)
        clock.lap("error estimate")
        lines = excitation_orders(system.model, shaft_orders, mesh_orders, sidebands)
        result = diagram.result(lines, estimate, clock, progress)
        clock.lap("energies")
        progress(1.0, "done")
    worst = float(np.max(estimate, initial=0.0, where=np.isfinite(estimate)))
    remedy = "branches that rise into the range between its ends are not refined for; ask for more modes"
    short = missed(accuracy, worst, remedy)
    return replace(
        result,
        model=parts,
        seconds=clock.total(),
        left_out=(*result.left_out, *filter(None, [begun, beyond])),
        warnings=(*result.warnings, *few, *diagram.reduction_warnings(), *filter(None, [short])),
        status=short or "success",
    )


@dataclass(frozen=True)
class _Diagram:
    """Branches over the speeds of their track.

    Attributes:
        found: the modes at any speed.
        asked: speeds that were asked for; grid: those of the track, the operating speed and rows of bearing tables among them.
        chains: branches that are asked for at one of the speeds asked for at least, lowest first.
        halvings: how many speeds were put between those of the track, to follow the modes.
        unsure: speeds in rad/s at which two modes stayed hard to tell.
    """

    found: SpeedModes
    asked: np.ndarray
    grid: np.ndarray
    chains: list[Chain]
    halvings: int
    unsure: list[float]

    @classmethod
    def of(cls, found: SpeedModes, asked: np.ndarray, progress: Progress) -> _Diagram:
        """Follow the modes of each group that are asked for at any speed of the track."""
        low = float(asked.min())
        high = float(asked.max())
        operating = found.system.model.operating_speed or low
        extra = [*found.family.knots, *([operating] if low < operating < high else [])]
        new = [speed for speed in extra if np.min(np.abs(asked - speed)) > _SAME_SPEED * max(high - low, 1e-300)]
        grid = merged(sorted([*map(float, asked), *map(float, new)]), high - low)
        grid = grid if abs(asked[-1]) >= abs(asked[0]) and asked[-1] >= 0.0 else grid[::-1]
        measuring = Forecast("campbell", 0.0, whole="for the modes at the speeds asked for").measuring(progress, 0.8)
        wanted = []  # how many of the lowest modes of each group are asked for at each speed
        for number, speed in enumerate(grid, 1):
            measuring(0.5 + 0.3 * (number - 1) / len(grid), f"speed {number} of {len(grid)}")
            frequencies = [np.abs(found.damped(part.s)) for part in found.at(speed)]
            together = np.sort(np.concatenate(frequencies))
            count = found.reach.inside(together)
            # Equal frequencies of two groups count in both: rounding must not decide which of them is asked for.
            limit = together[count - 1] * (1.0 + 1e-12) if count else -1.0
            wanted.append([int(np.sum(group <= limit)) for group in frequencies])
        chains: list[Chain] = []
        halvings = 0
        unsure = []
        for group, counts in enumerate(np.array(wanted).T):
            watched = int(counts.max(initial=0))
            if not watched:
                continue
            places, halved, doubted = track(found, group, grid, watched + 1)
            halvings += len(halved)
            unsure += doubted
            kept = np.any((places >= 0) & (places < counts[:, None]) & np.isin(grid, asked)[:, None], axis=0)
            modes = [found.at(speed)[group] for speed in grid]
            for branch in places[:, kept].T:
                s = np.full(len(grid), np.nan + 0j)
                q = np.full((len(grid), modes[0].q.shape[0]), np.nan + 0j)
                for k in np.flatnonzero(branch >= 0):
                    s[k] = modes[k].s[branch[k]]
                    q[k] = modes[k].q[:, branch[k]]
                chains.append(Chain(group, s, q))

        def first_place(chain: Chain) -> tuple[int, float]:
            first = int(np.argmax(np.isfinite(chain.s)))
            return first, float(np.abs(chain.s[first]))

        return cls(found, asked, grid, sorted(chains, key=first_place), halvings, unsure)

    def error_estimate(self) -> np.ndarray:
        """Estimated relative discretisation error of each branch (b,), the larger of both ends of the range."""
        system = self.found.system
        estimate = np.full(len(self.chains), np.nan)
        for end in self.found.snapshots[:2]:
            k = int(np.argmin(np.abs(self.grid - end.speed)))
            parts = errors_of(system, end.speed, end.s, end.vectors, np.zeros(len(end.s), bool))
            error = total_error(parts, len(end.s)) + reduction_errors(system, end.s, end.vectors)
            for b, chain in enumerate(self.chains):
                if not np.isfinite(chain.s[k]):
                    continue
                near = int(np.argmin(np.abs(end.s - chain.s[k])))
                if abs(end.s[near] - chain.s[k]) <= 1e-6 * abs(chain.s[k]):
                    estimate[b] = np.fmax(estimate[b], error[near])
        return estimate

    def onsets(self) -> tuple[Onset, ...]:
        """Where branches start to grow with speed, and where a motion that doesn't oscillate does."""
        found = self.found
        grid = self.grid
        if found.family.is_conservative:
            return ()
        onsets: list[Onset] = []
        for b, chain in enumerate(self.chains):
            first = chain.s[0]
            if np.isfinite(first) and first.real > 1e-9 * abs(first):
                onsets.append(Onset(b + 1, float(grid[0]), float(first.imag) / (2.0 * np.pi)))
            # The real part of s; what is rounding counts as decay.
            for speed, s, _ in roots(found, self.chains, grid, b, lambda s, speed: s.real - 1e-10 * abs(s)):
                k = int(np.searchsorted(np.abs(grid), abs(speed)))
                if chain.s[min(k, len(grid) - 1)].real > 0.0:
                    onsets.append(Onset(b + 1, speed, float(s.imag) / (2.0 * np.pi)))
        grows = (speed for speed in grid if any(np.any(part.real > 0.0) for part in found.at(speed)))
        onsets += [Onset(0, float(speed), 0.0) for speed in itertools.islice(grows, 1)]
        return tuple(sorted(onsets, key=lambda onset: abs(onset.speed)))

    def operating_place(self) -> int | None:
        """Number of the operating speed on the track; None where it lies outside, or there is none."""
        grid = self.grid
        operating = self.found.system.model.operating_speed
        if operating is None:
            return None
        place = int(np.argmin(np.abs(grid - operating)))
        # A range that is cut evenly meets it to rounding only.
        return place if abs(grid[place] - operating) <= _SAME_SPEED * max(float(np.ptp(grid)), 1e-300) else None

    def result(
        self, lines: tuple[ExcitationOrder, ...], estimate: np.ndarray, clock: Clock, progress: Progress
    ) -> CampbellResult:
        """The branches at the speeds asked for, with their energies, whirl and crossings, and margins at the operating speed."""
        found = self.found
        system = found.system
        chains = self.chains
        grid = self.grid
        progress(0.85, "crossings")
        shapes = BasisShapes(system, found.basis())
        met = crossings(found, shapes, chains, grid, lines)
        onsets = self.onsets()
        clock.lap("crossings")
        progress(0.92, "energies")
        kept = np.flatnonzero(np.isin(grid, self.asked))
        branches = np.array([chain.s for chain in chains]).T
        s = found.damped(branches)
        there = np.isfinite(branches[kept])
        coordinates = np.zeros((len(kept), int(shapes.offsets[-1]), len(chains)), complex)
        for b, chain in enumerate(chains):
            coordinates[:, :, b] = np.nan_to_num(shapes.coordinates(chain.group, chain.q[kept].T).T)
        flat = np.moveaxis(coordinates, 1, 0)[:, there]
        seen = shapes.portraits(flat, np.broadcast_to(grid[kept][:, None], there.shape)[there])

        def spread(values: np.ndarray, empty: float = np.nan) -> np.ndarray:
            whole = np.full(there.shape, empty, dtype=values.dtype)
            whole[there] = values
            return whole

        def every(shares: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
            return {name: spread(values) for name, values in shares.items()}

        margin: tuple[Margin, ...] = ()
        operating = system.model.operating_speed
        place = self.operating_place()
        if operating is not None and place is not None and np.isfinite(branches[place]).any():
            known = [chain for chain in chains if np.isfinite(chain.s[place])]
            at = np.hstack([shapes.coordinates(chain.group, chain.q[place][:, None]) for chain in known])
            margin = margins(lines, met, operating, s[place], shapes.portraits(at, np.full(len(known), operating)))
        strain = {name: v for name, v in seen.energies.strain.items() if name.startswith("meshes.")}
        planetary: dict[str, Any] = {}
        if system.layout.planets:
            classes = shapes.classes(flat, np.broadcast_to(grid[kept][:, None], there.shape)[there], seen.energies)
            words = np.full(there.shape, "", dtype=object)
            words[there] = classes.words
            last = len(kept) - 1 - np.argmax(there[::-1], axis=0)
            planetary = {
                "mode_class": tuple(words[last, range(len(chains))]) if classes.energy else (),
                "class_energy": every(classes.energy),
                "carrier_frequency_hz": every(classes.seen_hz(s[kept][there])),
                "carrier_frequency_share": every(classes.seen_share),
            }
        # A branch is described by its mode at the last speed asked for at which it oscillates: its whirl is that there, too.
        told = [int(kept[np.flatnonzero(np.isfinite(chain.s[kept]))[-1]]) for chain in chains]
        columns = [shapes.coordinates(chain.group, chain.q[n][:, None]) for chain, n in zip(chains, told, strict=True)]
        bound = 10.0 ** np.ceil(np.log10(max(found.error, 1e-10)))  # what is below is rounding
        return CampbellResult(
            model=system.model,
            speeds=grid[kept],
            eigenvalues=s[kept],
            whirl=spread(whirl_numbers(seen.words), 0),
            whirl_by_shaft=every(seen.whirl.net),
            kinetic_by_motion=every(seen.energies.kinetic_by_motion),
            strain_by_motion=every(seen.energies.strain_by_motion),
            mesh_strain={name.removeprefix("meshes."): v for name, v in every(strain).items()},
            description=shapes.descriptions(np.hstack(columns), grid[told]),
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
            laws=law_rows(system.state.operating),
            left_out=self.left_out(),
            warnings=self.warnings(onsets),
            **planetary,
            method=f"basis of {found.size} columns from {len(found.snapshots)} true solutions, {len(found.checks)} more as a "
            f"check: off by at most {bound:.0e}; {len(grid)} speeds, {self.halvings} steps halved to follow the modes"
            f"{self._beyond_asked()}{about_state(system.state)}",
        )

    def _beyond_asked(self) -> str:
        """Why there are more branches than modes were asked for: other modes are the lowest ones at other speeds."""
        count = self.found.reach.modes
        return f"; each is among the {count} lowest at some speed" if count and len(self.chains) > count else ""

    def left_out(self) -> tuple[str, ...]:
        """What the model holds and the diagram does not."""
        found = self.found
        system = found.system
        notes: list[str] = [*left_out(system, "modes", float(self.grid[-1]))]
        if system.is_seen_from_carrier:
            notes.append("lines of shafts and sidebands: seen from a carrier they have other orders")
        rigid = found.snapshots[0].rigid.shape[1]
        if rigid:
            notes.append(f"{rigid} rigid-body mode{'s'[: rigid != 1]} at 0 Hz")
        if any(len(part.real) for speed in self.grid for part in found.at(speed)):
            notes.append("motions that do not oscillate (overdamped): they have no frequency to draw")
        if system.model.operating_speed is None:
            notes.append("margins: the model has no operating speed")
        elif self.operating_place() is None:
            notes.append("margins: the operating speed lies outside of the range")
        return (*notes, *class_notes(system), *found.notes)

    def warnings(self, onsets: tuple[Onset, ...]) -> tuple[str, ...]:
        """Motions that grow, and branches that can't be told apart."""
        notes = list(self.found.system.nodes.merged)
        for onset in onsets[:3]:
            what = f"branch {onset.branch}" if onset.branch else "a motion that does not oscillate"
            notes.append(f"{what} is unstable from {onset.speed * RPM_PER_RAD_S:.6g} rpm on: the motion grows")
        if self.unsure:
            places = ", ".join(f"{speed * RPM_PER_RAD_S:.6g}" for speed in self.unsure[:3])
            notes.append(f"two branches can't be told apart near {places} rpm: they meet or part there in a point")
        return tuple(notes)

    def reduction_warnings(self) -> tuple[str, ...]:
        """A sentence where the reduction of casings makes a mode as low as the branches wrong by more than a thousandth."""
        system = self.found.system
        if not system.model.casings:
            return ()
        first = self.found.snapshots[0]
        low = np.abs(first.s) <= max(float(np.nanmax(np.abs(chain.s))) for chain in self.chains)
        s = first.s[low]
        return tuple(casing_warnings(reduction_errors(system, s, first.vectors[:, low]), s))
