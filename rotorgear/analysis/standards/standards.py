"""Rules of rotor standards, applied to a model at its operating speed: the verb behind `rotorgear standards`.

A verdict speaks of one rule as it is written in `rules.py`, with its value and limit; whether a machine meets a standard is no
matter of six numbers, and is never said.

The unbalance response of a rotor is factored and solved anew at each speed, so that a peak can be followed to any accuracy. The
orbit of a node is the ellipse of Re((X, Y) e^{iwt}); its major semi-axis is (|X + iY| + |X - iY|)/2.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from rotorgear.analysis.campbell.critical import critical
from rotorgear.analysis.common.describe_model import check
from rotorgear.analysis.common.excitation import excitation_orders
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import check_grade, speed_in_si
from rotorgear.analysis.modal.modal import modal
from rotorgear.analysis.response.mesh import damped_plant, meshed
from rotorgear.analysis.response.plant import Plant
from rotorgear.analysis.standards import rules
from rotorgear.analysis.static.lowest_speed import needs_rotation
from rotorgear.analysis.static.mean_state import about_mean
from rotorgear.errors import AnalysisError
from rotorgear.model.model import Model
from rotorgear.progress import Progress, silent
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.campbell import ExcitationOrder
from rotorgear.results.critical import CriticalResult
from rotorgear.results.modal import ModalResult, NodeTable
from rotorgear.results.standards import (
    NOT_APPLICABLE,
    NOT_WITHIN,
    WITHIN,
    ResponseCritical,
    RuleCheck,
    RuleTable,
    StandardsResult,
)
from rotorgear.system.damped_range import damped_up_to
from rotorgear.system.loads import weight_loads

# Critical speeds are looked for up to this multiple of the operating speed: beyond every margin that a rule asks for.
HIGHEST = 1.5
_CURVE = 81
# Speeds of the curves about each damped peak, relative to it.
_NEAR_PEAKS = (-0.03, -0.015, -0.008, -0.004, 0.0, 0.004, 0.008, 0.015, 0.03)
# A mode is one of torsion where so much of its kinetic energy is; damping ratios below that are none.
_MOSTLY = 0.5
_UNDAMPED = 1e-9
# Whirl of a shaft, -1 to 1, up to which a mode is a backward one; a rotor without gyroscopic moments whirls in no sense.
_BACKWARD = -0.5
_MODES = 24


@recorded
def standards(
    model: Model,
    *,
    start: float | str | None = None,
    stop: float | str | None = None,
    grade: float = 2.5,
    progress: Progress = silent,
) -> StandardsResult:
    """Return amplification factors, separation margins, vibration, stability, torsional interference and balance against rules.

    The unbalance response of each shaft is computed with twice 6350 W/N g mm at the antinodes of each mode that its speed meets;
    its peaks and half-power speeds are found by roots. Each rule is named with its standard and year, and says within, not within
    or not applicable.

    Args:
        model: a model with an operating speed.
        start: as in `campbell`.
        stop: highest speed of the input shaft at which peaks are looked for (default: 1.5 times the operating speed).
        grade: balance quality grade G of ISO 21940-11 in mm/s.
        progress: callable that is told fraction and step.

    Returns:
        The rules with values, limits and verdicts.

    Raises:
        AnalysisError: no operating speed, or a grade that is not positive.
    """
    speed = operating_speed_of(model)
    top = abs(speed_in_si(stop) or HIGHEST * speed)
    check_grade(grade)
    progress(0.05, "critical speeds")
    return judged(critical(model, start=start, stop=math.copysign(top, speed)), model, grade, progress)


def operating_speed_of(model: Model) -> float:
    """The operating speed of the input shaft in rad/s.

    Raises:
        AnalysisError: the model has none.
    """
    speed = model.operating_speed
    if not speed:
        raise AnalysisError("rules of standards need the speed of [operation]")
    return speed


def judged(found: CriticalResult, model: Model, grade: float, progress: Progress = silent) -> StandardsResult:
    """The rules from critical speeds that are known already.

    Args:
        found: damped critical speeds of the model, up to the speed at which peaks are looked for.
        model, grade, progress: as in `standards`.
    """
    speed = operating_speed_of(model)
    check_grade(grade)
    direction = 1 if speed > 0.0 else -1
    operating = abs(speed)
    top = abs(found.top_speed)
    low = abs(found.low_speed)
    fastest = max(abs(model.layout.train.ratio(name)) for name in model.shafts) * top
    plant, notes = plant_up_to(model, direction, (low, top), fastest)
    progress(0.4, "unbalance response")
    lateral = _Lateral(model, plant, found, direction, operating)
    progress(0.7, "stability and torsion")
    running = modal(model, speed=speed, modes=_MODES)
    lines = excitation_orders(model, (1.0, 2.0), (1,))
    highest = max((line.frequency_hz(operating) for line in lines), default=0.0)
    # Films carry nothing at standstill: their gearbox is asked while it runs.
    at = speed if needs_rotation(model) else None
    torsional = modal(model, speed=at, fmax=(1.0 + 2.0 * rules.LEAST_TORSIONAL_MARGIN) * highest)
    progress(1.0, "done")
    return StandardsResult(
        model=model,
        dofs=plant.system.n,
        operating_rpm=operating * RPM_PER_RAD_S,
        balance_grade=grade,
        rules=rules.RULES,
        criticals=tuple(lateral.criticals),
        checks=(
            *lateral.checks,
            *_stability(model, running),
            *_interference(lines, operating, torsional),
            *_balance(model, grade, operating),
        ),
        curve_speeds=lateral.curve_speeds,
        curves=lateral.curves,
        left_out=(
            *dict.fromkeys([*found.left_out, *notes]),
            "coupled rotors as one: each shaft has its own unbalance, mass and antinodes",
            "a range of operating speeds: margins are those from the one operating speed",
        ),
        warnings=found.warnings,
        method="direct sparse LU at every speed; peaks by Brent's method, half-power speeds by roots",
    )


def _check(
    rule: RuleTable,
    part: str,
    note: str,
    what: str = "-",
    unit: str = "",
    value: float | None = None,
    limit: float | None = None,
    *,
    at_most: bool = False,
) -> RuleCheck:
    """One rule on one part: within where the value is at least the limit, or `at_most` that; without both not applicable."""
    if value is None or limit is None:
        verdict = NOT_APPLICABLE
    else:
        verdict = WITHIN if (value <= limit if at_most else value >= limit) else NOT_WITHIN
    return RuleCheck(rule.name, part, what, unit, value, limit, verdict, note)


class _Lateral:
    """The unbalance response of each shaft: its peaks, and what the rules say about them."""

    def __init__(self, model: Model, plant: Plant, found: CriticalResult, direction: int, operating: float) -> None:
        top = abs(found.top_speed)
        self.plant = plant
        self.model = model
        self.operating = operating
        self.low = abs(found.low_speed)
        self.criticals: list[ResponseCritical] = []
        self.checks: list[RuleCheck] = []
        # Of each shaft: the response to each unbalance, the speed of its peak, and the node that is looked at.
        self._responses: dict[str, list[tuple[UnbalanceResponse, float, int]]] = {shaft: [] for shaft in model.shafts}
        parts = {line.name: line.parts for line in found.lines}
        for shaft in model.shafts:
            ratio = abs(model.layout.train.ratio(shaft))
            if ratio == 0.0:
                continue
            mine = [
                k for k, item in enumerate(found.speeds) if shaft in parts[item.line] and item.whirl and item.excited
            ]
            for k in mine:
                self._peak(shaft, found, k, direction)
            self._vibration(shaft)
            if not self._responses[shaft]:
                why = (
                    "no peak of its unbalance response"
                    if mine
                    else "no critical speed of bending that its unbalance drives"
                )
                note = f"{why} up to {ratio * top * RPM_PER_RAD_S:.6g} rpm of the shaft"
                self.checks += [_check(rule, f"shafts.{shaft}", note) for rule in (rules.SEPARATION, rules.VIBRATION)]

        damped = [one.speed for one in self.criticals if math.isfinite(one.amplification_factor)]
        near = np.multiply.outer(damped, 1.0 + np.array(_NEAR_PEAKS)).ravel()
        even = np.linspace(max(0.02 * top, self.low), top, _CURVE)
        self.curve_speeds = np.unique(np.concatenate([even, near[(near > self.low) & (near < top)]]))
        self.curves = {
            shaft: np.array([response.orbits(speed, [probe])[0] for speed in self.curve_speeds])
            for shaft, [(response, _, probe), *_] in ((shaft, some) for shaft, some in self._responses.items() if some)
        }

    def _peak(self, shaft: str, found: CriticalResult, k: int, direction: int) -> None:
        """The peak of the response to unbalance in the shape of one critical speed; none where it makes no peak of its own."""
        item = found.speeds[k]
        rpm = abs(self.plant.system.train.ratio(shaft)) * self.operating * RPM_PER_RAD_S
        response = UnbalanceResponse(self.plant, shaft, direction, (found.nodes, found.shapes[:, :, k]), rpm)
        if response.unbalance.sum() <= 0.0:
            return
        near = abs(item.speed)
        undamped = item.damping_ratio < _UNDAMPED
        # Of an undamped resonance the place of the largest response is told beside it.
        sizes = response.orbits(near * (1.0 + 1e-3 if undamped else 1.0), response.nodes)
        probe = int(response.nodes[int(np.argmax(sizes))])
        peak: rules.ResponsePeak | None = rules.ResponsePeak(near, math.nan, math.nan, math.nan)
        if not undamped:
            peak = rules.response_peak(
                lambda s: float(response.orbits(s, [probe])[0]), near, item.damping_ratio, self.low
            )
        known = [one.speed for one in self.criticals if one.shaft == shaft and not undamped]
        if peak is None or any(abs(peak.speed / speed - 1.0) < 1e-3 for speed in known):
            return
        speed = peak.speed
        factor = math.inf if undamped else peak.amplification_factor
        margin = 100.0 * abs(speed - self.operating) / self.operating
        required = None if math.isnan(factor) else rules.separation_margin(factor, speed < self.operating)
        self.criticals.append(
            ResponseCritical(
                shaft=shaft,
                description=item.description,
                whirl=item.whirl,
                place_z=self.plant.system.nodes.z[probe],
                unbalance_kg_m=float(response.unbalance.sum()),
                antinodes_z=tuple(float(z) for z in response.z),
                speed=speed,
                shaft_rpm=response.rpm(speed),
                below_rpm=response.rpm(peak.below),
                above_rpm=response.rpm(peak.above),
                amplification_factor=factor,
                required_percent=required,
                margin_percent=margin,
                error_estimate=item.error_estimate,
            )
        )
        if math.isnan(factor):
            note = "the response does not fall to 0.707 of this peak on either side"
        elif required is None:
            note = f"AF {factor:.4g} is below {rules.LEAST_AMPLIFICATION}: no margin is asked for"
        else:
            note = "undamped: AF without bound" if math.isinf(factor) else f"AF {factor:.5g}"
        part = f"shafts.{shaft}, {response.rpm(speed):.5g} rpm"
        self.checks.append(_check(rules.SEPARATION, part, note, "separation", "%", margin, required))
        self._responses[shaft].append((response, speed, probe))

    def _vibration(self, shaft: str) -> None:
        """The largest orbit of each bearing at the operating speed over the unbalances of all peaks, against both limits."""
        system = self.plant.system
        responses = self._responses[shaft]
        bearings = {name: part for name, part in self.model.bearings.items() if part.shaft == shaft}
        if not bearings or not responses:
            return
        nodes = [system.nodes.at(*system.layout.place(f"bearings.{name}")) for name in bearings]
        moved = np.array([response.orbits(self.operating, nodes) for response, _, _ in responses])
        rpm = responses[0][0].rpm(self.operating)
        for k, (name, bearing) in enumerate(bearings.items()):
            response, peak, _ = responses[int(np.argmax(moved[:, k]))]
            size = 1e6 * float(moved[:, k].max())
            note = (
                f"at {rpm:.6g} rpm, {1e6 * response.unbalance.sum():.4g} g mm in the shape of the peak at "
                f"{response.rpm(peak):.5g} rpm"
            )
            limits = [(rules.VIBRATION, "peak to peak", 1e6 * rules.vibration_limit(rpm))]
            if (play := bearing.geometry.play if bearing.geometry else None) is not None:
                limits.append((rules.CLEARANCE, "major axis", 1e6 * rules.CLEARANCE_SHARE * play))
            self.checks += [
                _check(rule, f"bearings.{name}", note, what, "um", size, limit, at_most=True)
                for rule, what, limit in limits
            ]


def _stability(model: Model, running: ModalResult) -> Iterator[RuleCheck]:
    """The logarithmic decrement of each shaft's first bending mode that does not whirl backward, and of all that grow."""
    zeta = running.damping_ratio
    decrement = 2.0 * np.pi * zeta / np.sqrt(np.maximum(1.0 - zeta**2, 1e-300))
    moving = ~running.rigid & (np.abs(running.eigenvalues.imag) > 0.0)
    what = "logarithmic decrement"
    least = rules.LEAST_DECREMENT
    if not np.any(np.abs(zeta[moving]) > _UNDAMPED):
        yield _check(rules.STABILITY, "all modes", "nothing damps the model", what, limit=least)
        return

    def decrement_of(part: str, mode: int) -> RuleCheck:
        note = f"mode {mode + 1} at {running.frequency_hz[mode]:.4f} Hz: {running.description[mode]}"
        return _check(rules.STABILITY, part, note, what, value=float(decrement[mode]), limit=least)

    lateral = {
        shaft: np.linalg.norm(np.abs(running.shapes[running.nodes.on_shaft(shaft), :2]), axis=1).max(axis=0)
        for shaft in model.shafts
    }
    shown = set()
    for shaft in model.shafts:
        largest = np.all([lateral[shaft] >= other for other in lateral.values()], axis=0)
        whirl = running.whirl_by_shaft.get(shaft, np.zeros(len(running)))
        forward = np.flatnonzero(moving & largest & (whirl > _BACKWARD))
        if not forward.size:
            note = f"no forward or planar bending of this shaft among the lowest {len(running)} modes"
            yield _check(rules.STABILITY, f"shafts.{shaft}", note)
            continue
        shown.add(int(forward[0]))
        yield decrement_of(f"shafts.{shaft}", int(forward[0]))
    for mode in np.flatnonzero(moving & (zeta < -_UNDAMPED)):
        if int(mode) not in shown:
            yield decrement_of(f"mode {mode + 1}", int(mode))


def _interference(lines: tuple[ExcitationOrder, ...], operating: float, torsional: ModalResult) -> Iterator[RuleCheck]:
    """The torsional mode next to each line at the operating speed; undamped modes at standstill, as the rule asks."""
    # A model without this motion has no such mode.
    share = torsional.kinetic_by_motion.get("torsion", np.zeros(len(torsional)))
    torsion = np.flatnonzero((share >= _MOSTLY) & ~torsional.rigid)
    limit = 100.0 * rules.LEAST_TORSIONAL_MARGIN
    for line in lines:
        hz = line.frequency_hz(operating)
        if not torsion.size:
            note = f"no torsional mode up to {1.2 * hz:.5g} Hz"
            yield _check(rules.INTERFERENCE, line.name, note, unit="%", limit=limit)
            continue
        away = np.abs(torsional.frequency_hz[torsion] / hz - 1.0)
        nearest = int(torsion[int(np.argmin(away))])
        at = f"mode {nearest + 1} at {torsional.frequency_hz[nearest]:.5g} Hz"
        note = f"line at {hz:.5g} Hz, {at}: {torsional.description[nearest]}"
        margin = 100.0 * float(away.min())
        yield _check(rules.INTERFERENCE, line.name, note, "separation", "%", margin, limit)


def _balance(model: Model, grade: float, operating: float) -> Iterator[RuleCheck]:
    """The sum of the unbalances of each shaft against what the grade permits for its mass and speed."""
    for row in check(model).shafts:
        rpm = abs(row.speed_ratio) * operating * RPM_PER_RAD_S
        if rpm == 0.0:
            continue
        limit = 1e6 * rules.residual_unbalance(grade, row.shaft_mass_kg + row.body_mass_kg, rpm)
        mine = [item.magnitude for item in model.unbalances.values() if item.shaft == row.name]
        value = 1e6 * sum(mine) if mine else None
        note = f"G {grade:g}, {row.shaft_mass_kg + row.body_mass_kg:.4g} kg at {rpm:.6g} rpm"
        note += "" if mine else "; the model gives this shaft no unbalance"
        yield _check(rules.RESIDUAL, f"shafts.{row.name}", note, "unbalance", "g mm", value, limit, at_most=True)


# Where the shape is smaller than this share of its largest deflection there is no antinode.
_SEEN = 0.1
_TANGENTS = 9


def plant_up_to(
    model: Model, direction: int, ends: tuple[float, float], frequency: float
) -> tuple[Plant, tuple[str, ...]]:
    """The model about its mean state as a plant, meshed for a frequency, and sentences on what was left out.

    Args:
        model: the model. direction: sense of the input shaft.
        ends: lowest and highest speed of the input shaft in rad/s, positive; frequency: highest in rad/s.
    """
    low, top = ends
    speed = direction * top
    tangents = direction * np.linspace(low or 0.1 * top, top, _TANGENTS)
    about = about_mean(model, [float(x) for x in tangents], speed)
    system = meshed(model, about, speed, frequency / (2.0 * np.pi))
    limit = damped_up_to(system, frequency)
    return damped_plant(system, speed, limit, model.damping.modal_ratio), about[1].notes


class UnbalanceResponse:
    """Response of a plant to unbalance at the antinodes of a shape's deflection on one shaft.

    Each antinode takes the mass of the rotor that is nearer to it than to the others.

    Args:
        plant: of the model; shaft: name of the rotor; direction: sense of the input shaft.
        shape: its nodes, and the displacements of all of them, (p, 6) complex.
        rpm: speed of the shaft that the unbalance is for.

    Attributes:
        z: (a,) places of the antinodes in m.
        unbalance: (a,) in kg m; empty where there is no antinode.
        nodes: numbers of the shaft's nodes.
    """

    def __init__(
        self, plant: Plant, shaft: str, direction: int, shape: tuple[NodeTable, np.ndarray], rpm: float
    ) -> None:
        system = plant.system
        self.plant = plant
        self.ratio = abs(system.train.ratio(shaft))
        self.nodes = system.nodes.on_shaft(shaft)
        there = shape[0].on_shaft(shaft)
        moved = shape[1][there, :2]
        size = np.linalg.norm(np.abs(moved), axis=1)
        padded = np.concatenate([[-1.0], size, [-1.0]])
        inner = np.flatnonzero((size >= padded[:-2]) & (size > padded[2:]) & (size >= _SEEN * size.max(initial=0.0)))
        z = shape[0].along[there[inner]]
        # Deflections lie on one side or the other of the axis: the sign of the projection on the largest one.
        side = np.where(np.real(moved[inner] @ moved[int(np.argmax(size))].conj()) >= 0.0, 1.0, -1.0)
        at = np.array([system.nodes.at(shaft, place) for place in z], dtype=int)
        kept = np.unique(at, return_index=True)[1]
        self.z = z[kept]
        weights = weight_loads(system, tuple(system.model.shafts[shaft].frame.axes[:, 0]))
        places = np.array([system.nodes.z[node] for node in self.nodes])
        nearest = np.argmin(np.abs(places[:, None] - self.z), axis=1) if kept.size else np.zeros(0, int)
        mass = [weights[6 * self.nodes[nearest == k]].sum() for k in range(len(kept))]
        self.unbalance = np.array([rules.trial_unbalance(one, rpm) for one in mass])
        sense = direction * system.train.sense(shaft)
        load = np.zeros(system.dofs.transform.shape[0], complex)
        load[6 * at[kept]] = self.unbalance * side[kept]
        load[6 * at[kept] + 1] = -1j * sense * self.unbalance * side[kept]
        self._load = system.dofs.transform.T @ load
        self._direction = direction
        self._rows = system.dofs.transform.tocsr()

    def orbits(self, speed: float, nodes: Sequence[int] | np.ndarray) -> np.ndarray:
        """Major axis of the orbit of nodes in m, peak to peak, at a speed of the input shaft in rad/s, positive."""
        w = self.ratio * speed
        q = self.plant.dynamics(self._direction * speed).solve(w, (w**2 * self._load)[:, None])
        numbers = np.asarray(nodes)
        x = (self._rows[6 * numbers, :] @ q)[:, 0]
        y = (self._rows[6 * numbers + 1, :] @ q)[:, 0]
        return np.asarray(np.abs(x + 1j * y) + np.abs(x - 1j * y))

    def rpm(self, speed: float) -> float:
        """Speed of the shaft in rpm at one of the input shaft in rad/s."""
        return self.ratio * speed * RPM_PER_RAD_S
