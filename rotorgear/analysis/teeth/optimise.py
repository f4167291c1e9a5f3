"""The verb behind `rotorgear optimise-flanks`: flanks with the smallest transmission error over torques and misalignments.

The mean of the peak to peak over the operating points, weighted, is the smallest within the bounds:

    min over x of  sum_i w_i ptp TE_i(x) / sum_i w_i,    p_max,i(x) <= p_lim.

It has kinks and flat valleys, so that no derivatives are taken: differential evolution (Storn and Price, Journal of Global
Optimization 11 (1997) 341) finds the valley, Nelder and Mead's simplex its bottom. Flanks beyond the pressure limit count with
their excess, so that the search finds back. Then modifications are varied evenly within their tolerances, by Sobol's points,
for the band that holds 90 % of them. Only gaps change from one flank to the next: compliances of the teeth are computed once.

An optimisation may change amounts and lengths of modifications within bounds, and says them as a model file writes them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import quantity
from rotorgear.analysis.teeth.mesh import POSITIONS, require_positions
from rotorgear.analysis.teeth.mesh_map import MeshFigures, figures_at, operating_points, operating_values
from rotorgear.cpu import Clock
from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.gears.loaded.tooth_contact import contact_problem
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.model.model import Model
from rotorgear.progress import Progress, part_of, silent
from rotorgear.quantity import QuantityError, did_you_mean, parse_quantity
from rotorgear.results.mesh_optimum import FlankVariable, MeshOptimum

# Flanks that are tried for each variable, and the share of them that the evolution takes; the simplex has the rest.
_TRIES = 60
_EVOLUTION = 0.6
_POPULATION = 6
# A flank that exceeds the pressure limit by a share e counts as 1 + e times this many means of the model's flanks: worse than
# any within the limit.
_EXCESS = 100.0
_BAND = (0.05, 0.95)
# Default tolerance as a share of the width of the bounds.
_TOLERANCE = 0.1
_SHARES = (0.05, 0.8)  # of the progress: after the teeth, and after the search


class _EnoughError(Exception):
    """All flanks that were asked for are tried."""


@dataclass
class _Search:
    """Tries flanks, counts them and keeps the best one; `points` gives the figures of flanks at all operating points."""

    teeth: ToothPair
    variables: tuple[Variable, ...]
    points: Callable[[ToothPair], MeshFigures]
    weight: np.ndarray
    limit: float | None
    most: int
    progress: Progress
    scale: float = 0.0
    tried: int = 0
    best: np.ndarray | None = None
    least: float = np.inf

    def mean(self, points: MeshFigures) -> float:
        """Weighted mean of the peak to peak (m)."""
        return float(np.dot(self.weight.ravel(), points.ste_peak_to_peak.ravel()))

    def excess(self, points: MeshFigures) -> float:
        """Share by which the largest pressure is above its limit, 0 below."""
        if self.limit is None:
            return 0.0
        return max(0.0, float(points.largest_pressure.max()) / self.limit - 1.0)

    def __call__(self, shares: np.ndarray) -> float:
        """The objective, for variables (v,) as shares of their bounds."""
        if self.tried >= self.most:
            raise _EnoughError
        shares = np.clip(shares, 0.0, 1.0)
        points = self.points(with_values(self.teeth, self.variables, self.values(shares)))
        excess = self.excess(points)
        value = _EXCESS * self.scale * (1.0 + excess) if excess else self.mean(points)
        self.tried += 1
        if value < self.least:
            self.least = value
            self.best = shares.copy()
        self.progress(min(self.tried / self.most, 1.0), f"flank {self.tried}, best {1e6 * self.least:.3f} um")
        return value

    def values(self, shares: np.ndarray) -> np.ndarray:
        """Variables (v,) in m."""
        low, high = np.array([(variable.low, variable.high) for variable in self.variables]).T
        return np.asarray(low + (high - low) * shares)

    def run(self) -> str:
        """Look for the best flanks; "success", or how far it came before Ctrl-C."""
        from scipy.optimize import differential_evolution, minimize

        v = len(self.variables)
        bounds = [(0.0, 1.0)] * v
        try:
            differential_evolution(
                self,
                bounds,
                maxiter=max(1, int(_EVOLUTION * self.most / (_POPULATION * v)) - 1),
                popsize=_POPULATION,
                init="sobol" if v > 1 else "latinhypercube",
                tol=1e-3,
                polish=False,
                seed=np.random.default_rng(12),  # the same question has the same answer; "rng" is new in scipy 1.15
            )
            assert self.best is not None
            # A simplex as wide as what the evolution leaves open, and pointing inwards.
            start = self.best.copy()
            minimize(
                self,
                start,
                method="Nelder-Mead",
                bounds=bounds,
                options={
                    "initial_simplex": start + np.vstack([np.zeros(v), np.diag(np.where(start > 0.5, -0.08, 0.08))]),
                    "xatol": 1e-3,
                    "fatol": 1e-4 * self.scale,
                    "maxfev": 10 * self.most,
                },
            )
        except _EnoughError:
            pass
        except KeyboardInterrupt:
            if self.best is None:
                raise
            return f"interrupted: the best of {self.tried} flanks so far"
        return "success"

    def band(
        self, values: np.ndarray, tolerance: np.ndarray, samples: int, progress: Progress
    ) -> tuple[np.ndarray, np.ndarray]:
        """5 and 95 % quantiles (1 + points,) of the weighted mean and of the peak to peak at each operating point (m)."""
        from scipy.stats import qmc

        # Sobol's points are balanced for powers of two: the next one, of which the first ones are taken.
        power = max(1, int(np.ceil(np.log2(samples))))
        varied = qmc.Sobol(len(values), seed=np.random.default_rng(12)).random_base2(power)
        least = np.array([0.0 if variable.low >= 0.0 else -np.inf for variable in self.variables])
        found = []
        for number, shares in enumerate(varied[:samples]):
            changed = np.maximum(values + tolerance * (2.0 * shares - 1.0), least)
            points = self.points(with_values(self.teeth, self.variables, changed))
            found.append([self.mean(points), *points.ste_peak_to_peak.ravel()])
            progress((number + 1) / samples, f"tolerances {number + 1} of {samples}")
        low, high = np.quantile(np.array(found), _BAND, axis=0)
        return low, high


@recorded
def optimise_flanks(
    model: Model,
    mesh: str | None = None,
    *,
    variables: Sequence[str],
    over: Mapping[str, object],
    bounds: Mapping[str, Sequence[object]] | None = None,
    weights: Sequence[float] | None = None,
    pressure_limit: float | str | None = None,
    tolerance: Mapping[str, object] | None = None,
    samples: int = 64,
    evaluations: int | None = None,
    torque: float | str | None = None,
    preset: str | None = None,
    body: str | None = None,
    positions: int = POSITIONS,
    progress: Progress = silent,
) -> MeshOptimum:
    """Find flank modifications with the smallest weighted peak to peak of the transmission error.

    Ctrl-C ends the search and gives the best flanks found so far.

    Args:
        model: a checked model.
        mesh: as in `mesh`.
        variables: modifications that may change: tip_relief, tip_relief_length, ... of both gears alike, or wheel.bias of one.
        over: "torque" and "misalignment", as for `mesh_map`.
        bounds: lowest and highest value of a variable in m or with units (default: those of usual modifications).
        weights: one for each torque, in the order of `over` (default: all alike).
        pressure_limit: largest contact pressure at all points in Pa or with its unit, such as "1200 MPa" (default: no limit).
        tolerance: tolerance of a variable, up and down, in m or with its unit (default: a tenth of the width of its bounds).
        samples: number of flanks of the tolerance band; 0 for none.
        evaluations: number of flanks that the search tries at most (default: 60 for each variable).
        torque: as in `mesh`.
        preset: as in `mesh`.
        body: as in `mesh`.
        positions: as in `mesh`.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: a mesh, variable, bound or load that can't be; no flank within the pressure limit.
        ConvergenceError: the contact does not converge.
        MissingExtraError: scikit-fem is not installed.
    """
    require_positions(positions)
    if not variables:
        raise AnalysisError("optimise: name at least one modification, such as tip_relief,tip_relief_length.")
    if not 0 <= samples <= 4096:
        raise AnalysisError(f"samples: got {samples}, expected 0 to 4096")
    try:
        limit = None if pressure_limit is None else parse_quantity(pressure_limit, "modulus")
    except QuantityError:
        raise AnalysisError(f"pressure limit: got {pressure_limit!r}, expected a pressure such as '1200 MPa'") from None
    if limit is not None and limit <= 0.0:
        raise AnalysisError(f"pressure limit: got {pressure_limit!r}, expected a positive pressure")
    clock = Clock()
    request, teeth, load, misalignment = operating_points(model, mesh, over, torque, {"preset": preset, "body": body})
    chosen = flank_variables(request.mesh, variables, bounds or {})
    spread = _tolerances(chosen, tolerance or {})
    if any(variable.field in ALONG_FACE for variable in chosen) and teeth.fe.preset != "preview":
        teeth = replace(teeth, fe=replace(teeth.fe, space=True))
    contact_problem(teeth, part_of(progress, 0.0, _SHARES[0]))
    most = _TRIES * len(chosen) if evaluations is None else evaluations
    if most < 10 * len(chosen):
        raise AnalysisError(f"evaluations: got {most}, expected at least 10 for each of {len(chosen)} variables")

    def points(flanks: ToothPair) -> MeshFigures:
        return figures_at(request, flanks, load, misalignment, positions)

    weight = _weights(weights, operating_values(over, "torque"), load, len(misalignment))
    search = _Search(teeth, chosen, points, weight, limit, most, part_of(progress, *_SHARES))
    before = search.points(teeth)
    search.scale = search.mean(before)
    clock.lap("teeth")
    status = search.run()
    assert search.best is not None
    values = search.values(search.best)
    found = search.points(with_values(teeth, chosen, values))
    if search.excess(found) > 0.0:
        raise AnalysisError(
            f"No flank within the bounds keeps the pressure limit of {1e-6 * (limit or 0.0):.4g} MPa at all points; "
            f"the best reaches {1e-6 * found.largest_pressure.max():.4g} MPa: raise the limit, or leave out the highest torque."
        )
    clock.lap("search")
    band = None
    if samples and status == "success":
        band = search.band(values, spread, samples, part_of(progress, _SHARES[1], 1.0))
        clock.lap("tolerance band")
    notes = [*found.warnings]
    at_bounds = [
        variable.text for variable, share in zip(chosen, search.best, strict=True) if share < 1e-3 or share > 1.0 - 1e-3
    ]
    if at_bounds:
        notes.append(f"the best value lies at the bound of {', '.join(at_bounds)}: wider bounds may give better ones")
    return MeshOptimum(
        title=model.title,
        mesh=request.mesh.name,
        pinion=request.mesh.pinion.name,
        gear=request.mesh.gear.name,
        preset=teeth.fe.preset,
        positions=positions,
        variables=tuple(
            FlankVariable(
                name=variable.text,
                low_m=variable.low,
                high_m=variable.high,
                best_m=float(value),
                tolerance_m=float(within),
            )
            for variable, value, within in zip(chosen, values, spread, strict=True)
        ),
        pinion_torque=load,
        misalignment=misalignment,
        weight=weight,
        pressure_limit=limit,
        mean_before=search.scale,
        mean=search.mean(found),
        mean_band=None if band is None else (float(band[0][0]), float(band[1][0])),
        before=before.ste_peak_to_peak,
        ste=found.ste_peak_to_peak,
        ste_low=None if band is None else band[0][1:].reshape(weight.shape),
        ste_high=None if band is None else band[1][1:].reshape(weight.shape),
        largest_pressure=found.largest_pressure,
        evaluations=search.tried,
        samples=0 if band is None else samples,
        changes=model_values(request.mesh, chosen, values),
        seconds=clock.total(),
        status=status,
        left_out=("the pressure limit in the tolerance band: flanks beyond it count there",) if limit and band else (),
        warnings=tuple(notes),
    )


def _weights(given: Sequence[float] | None, asked: np.ndarray | None, torque: np.ndarray, columns: int) -> np.ndarray:
    """Weights (t, m) that add up to 1, in the order of rising torques."""
    if given is None:
        return np.full((len(torque), columns), 1.0 / (len(torque) * columns))
    values = np.array(given, float)
    count = len(torque) if asked is None else len(asked)
    if len(values) != count or not (values >= 0.0).all() or not 0.0 < values.sum() < np.inf:
        raise AnalysisError(f"weights: got {list(given)}, expected {count} numbers, one for each torque, none negative")
    if asked is not None:
        values = np.array([values[asked == one].sum() for one in torque])
    return np.repeat(values[:, None], columns, axis=1) / (values.sum() * columns)


def _tolerances(variables: Sequence[Variable], given: Mapping[str, object]) -> np.ndarray:
    """Tolerances (v,) in m, up and down."""
    if strange := set(given) - {variable.text for variable in variables}:
        raise AnalysisError(f"tolerance: '{min(strange)}' is not among what is optimised.")
    found = []
    for variable in variables:
        if variable.text not in given:
            found.append(_TOLERANCE * (variable.high - variable.low))
            continue
        value = quantity(given[variable.text], "length", f"tolerance {variable.text}")
        if value < 0.0:
            raise AnalysisError(
                f"tolerance {variable.text}: got {given[variable.text]!r}, expected one that is not negative"
            )
        found.append(value)
    return np.array(found)


# Depths up to these shares of the normal module are looked at where no bounds are given: those of usual modifications.
_RELIEF = 0.02
_SHAPE = 0.005
# Lengths of relief as shares of the path of double contact: a little more than up to the innermost point of single contact.
_LENGTHS = (0.1, 1.2)
# Lengths of end relief as shares of the face.
_ENDS = (0.05, 0.3)
# Keys of the file that lie in the gear itself; the others lie in its `flank`.
_IN_GEAR = ("tip_relief", "tip_relief_diameter")
_AMOUNTS = ("tip_relief", "root_relief", "crowning", "profile_crowning", "end_relief")
_SIGNED = ("profile_slope", "helix_slope", "bias")
# A length, and the amount that it belongs to.
LENGTHS = {
    "tip_relief_length": "tip_relief",
    "root_relief_length": "root_relief",
    "end_relief_length": "end_relief",
}
NAMES = (*_AMOUNTS, *_SIGNED, *LENGTHS)
ALONG_FACE = ("crowning", "end_relief", "end_relief_length", "helix_slope", "bias")


@dataclass(frozen=True)
class Variable:
    """One number that the optimisation varies.

    Attributes:
        text: as it was asked for.
        field: of `FlankModification`.
        gears: which gears have it: 0 the pinion, 1 the gear.
        low, high: bounds (m).
    """

    text: str
    field: str
    gears: tuple[int, ...]
    low: float
    high: float


def flank_variables(
    mesh: MeshLayout, names: Sequence[str], bounds: Mapping[str, Sequence[object]]
) -> tuple[Variable, ...]:
    """Variables from names such as "tip_relief" (both gears alike) or "wheel.crowning" (that gear alone).

    Args:
        mesh: the mesh.
        names: of the variables.
        bounds: lowest and highest value (m, or texts with a unit) by name, where the defaults don't do.

    Raises:
        AnalysisError: no such variable or gear, a length without its amount, bounds that are none.
    """
    found = []
    for text in names:
        gear, _, field = text.rpartition(".")
        own = [layout.name for layout in mesh.gears]
        if gear and gear not in own:
            raise AnalysisError(f"optimise {text}: meshes.{mesh.name} has the gears {own[0]} and {own[1]}.")
        if field not in NAMES:
            hint = did_you_mean(field, NAMES, f"there are {', '.join(NAMES)}")
            raise AnalysisError(f"optimise: there is no '{field}': {hint}")
        gears = (own.index(gear),) if gear else (0, 1)
        low, high = _bounds(mesh.teeth, field, text, bounds)
        found.append(Variable(text, field, gears, low, high))
    taken = [(variable.field, number) for variable in found for number in variable.gears]
    if len(set(taken)) < len(taken):
        raise AnalysisError("optimise: one modification of a gear is named twice.")
    if strange := set(bounds) - {variable.text for variable in found}:
        raise AnalysisError(f"bounds: '{min(strange)}' is not among what is optimised.")
    flanks = (mesh.teeth.first_flank, mesh.teeth.second_flank)
    for field, number in taken:
        # Amount and length come together: one that is not varied must be given in the file.
        partner = LENGTHS.get(field) or next((length for length, amount in LENGTHS.items() if amount == field), None)
        if partner is None or (partner, number) in taken:
            continue
        # Without an amount its length means nothing.
        amount = LENGTHS.get(field, field)
        if not (getattr(flanks[number], amount) and getattr(flanks[number], partner)):
            other = (mesh.pinion, mesh.gear)[number]
            raise AnalysisError(f"optimise {field}: name {partner} too, or give both for '{other.name}' in the model.")
    return tuple(found)


def _bounds(teeth: ToothPair, field: str, text: str, given: Mapping[str, Sequence[object]]) -> tuple[float, float]:
    if text in given:
        try:
            low, high = (parse_quantity(value, "length") for value in given[text])
        except (QuantityError, ValueError) as error:
            raise AnalysisError(
                f"bounds {text}: got {given[text]!r}, expected two lengths such as '0 um:60 um'"
            ) from error
        least = -math.inf if field in _SIGNED else 0.0
        if not least <= low < high:
            raise AnalysisError(
                f"bounds {text}: got {low:g} to {high:g} m, expected the lower one first, and none below zero"
            )
        if field in LENGTHS and low == 0.0:
            raise AnalysisError(f"bounds {text}: a length must be above zero")
        return low, high
    module = teeth.first.normal_module
    if field in ("tip_relief", "root_relief"):
        return 0.0, _RELIEF * module
    if field == "end_relief_length":
        return _ENDS[0] * teeth.width, _ENDS[1] * teeth.width
    if field in LENGTHS:
        double = min(max(teeth.pair.transverse_contact_ratio - 1.0, 0.1), 1.0) * teeth.first.transverse_base_pitch
        outlines = (tooth_outline(teeth.first), tooth_outline(teeth.second))
        shortest = min(outline.tip_roll_length - outline.form_roll_length for outline in outlines)
        return _LENGTHS[0] * double, min(_LENGTHS[1] * double, 0.9 * shortest)
    return (-_SHAPE * module if field in _SIGNED else 0.0), _SHAPE * module


def with_values(teeth: ToothPair, variables: Sequence[Variable], values: np.ndarray) -> ToothPair:
    """The teeth with other flanks; `values` (v,) in m."""
    flanks = [teeth.first_flank, teeth.second_flank]
    for variable, value in zip(variables, values, strict=True):
        for gear in variable.gears:
            flanks[gear] = replace(flanks[gear], **{variable.field: float(value)})  # type: ignore[arg-type]
    return replace(teeth, first_flank=flanks[0], second_flank=flanks[1])


def model_values(mesh: MeshLayout, variables: Sequence[Variable], values: np.ndarray) -> dict[str, str]:
    """Addresses in the model and their texts: lengths of reliefs along the profile become diameters.

    Amounts are rounded to 0.01 um, diameters to 1 um and lengths along the face to 10 um.
    """
    found: dict[str, str] = {}
    for variable, value in zip(variables, values, strict=True):
        for gear in variable.gears:
            layout = (mesh.pinion, mesh.gear)[gear]
            key = variable.field
            text = f"{1e6 * value:.2f} um"
            if key == "end_relief_length":
                text = f"{1e3 * value:.2f} mm"
            elif key in LENGTHS:
                g = (mesh.teeth.first, mesh.teeth.second)[gear]
                outline = tooth_outline(g)
                flank = layout.part.flank
                tip = outline.tip_form_roll_length(flank.tip_rounding, flank.tip_chamfer)
                roll = tip - value if key == "tip_relief_length" else outline.form_roll_length + value
                key = key.replace("_length", "_diameter")
                text = f"{2e3 * math.hypot(g.base_radius, roll):.3f} mm"
            place = f"gears.{layout.name}" if key in _IN_GEAR else f"gears.{layout.name}.flank"
            found[f"{place}.{key}"] = text
    return found
