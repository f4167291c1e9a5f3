"""Compare a record over time with the transient of a model under the measured loads.

The share of a channel's variance that a model explains says little by itself: what follows the loads without vibration explains
most of a step. So each share stands beside that of the same model without vibration (`quasi_static.py`), over the whole record
and in bands of frequencies. Bands are cut by Butterworth filters of order 4, run forwards and backwards, so nothing is shifted.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from rotorgear.analysis.common.discretise import plan_in_time
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import needed_speed, quantity
from rotorgear.analysis.modal.modal import modal
from rotorgear.analysis.rig.quasi_static import quasi_static
from rotorgear.analysis.rig.ring_down import ring_down as fit_ring_down  # the verb's own argument is called ring_down
from rotorgear.analysis.rig.time_record import LOAD, OUTPUT, TURNING, Placed, RecordOnModel, record_on_model
from rotorgear.analysis.transient.request import RECORDS, Task, base_frequencies, prepare
from rotorgear.analysis.transient.transient import transient
from rotorgear.errors import AnalysisError
from rotorgear.extras import require
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.progress import Progress, silent
from rotorgear.quantity import QuantityError, parse_quantity
from rotorgear.records.record import TimeRecord
from rotorgear.results.time_comparison import RingDown, TimeComparison, TimeInput, TimeMatch, TimeShare
from rotorgear.results.transient import TransientResult
from rotorgear.solvers.time.local_system import state_at_rest
from rotorgear.system.system import flow_system

_FILTER_ORDER = 4
# A band has so many periods of its lowest frequency in the record, or is left out.
_LEAST_PERIODS = 2.0
# Offsets are looked for up to this share of the record.
_REACH = 0.25
_MODES = 10
# Share of the model's variance above half the sampling rate that is told.
_FOLDED = 0.01


@recorded
def compare_time(
    model: Model,
    time: str | Path | TimeRecord,
    *,
    channels: Mapping[str, str] | None = None,
    points: str | Path | None = None,
    speed: float | str | None = None,
    offset: float | str | None = None,
    window: str | None = None,
    bands: Sequence[str] | None = None,
    remove: str | None = None,
    quiet: str | None = None,
    ring_down: str | None = None,
    vibrations: int = 1,
    steps: int | None = None,
    accuracy: float | None = None,
    method: str = "auto",
    modal_damping: float | None = None,
    elements: int | None = None,
    start: str = "equilibrium",
    error_estimate: bool = True,
    progress: Progress = silent,
) -> TimeComparison:
    """Put a record over time beside the transient of a model under the loads in it.

    Args:
        model: the model; torques and forces without a channel stay as they are in it.
        time: record over time of torques, forces, displacements, velocities or accelerations: a table (CSV), a universal file
            (UFF, dataset 58), MDF4, TDMS or WAV.
        channels: channels with their places on the model, where these are not called alike: 'torque 1=points.shaft',
            '-points.shaft' for the opposite sign, 'M=loads.motor', 'a=bearings.left:x', 'n=shafts.output' for the speed that
            orders are counted by; what 1 means in a channel without a unit: 'ch1=points.case, 98.1 m/s^2'.
        points: table of the sensors of a universal file (CSV: point,node,direction; default: each node is at the nearest place of
            the model).
        speed: speed of the input shaft (default: the operating speed, else standstill).
        offset: time that is added to the clock of the channels to have that of the loads, or "find" for that which explains most
            (default: 0; the best one is printed).
        window: begin and end of the time that is judged, as the file counts it: "FROM:TO" such as "0 s:0.5 s" (default: all of
            it).
        bands: bands of frequencies, each "FROM:TO" such as "15 Hz:60 Hz" (default: below, about and above the lowest elastic
            mode).
        remove: orders of a shaft that are taken out of rig and model alike: "SHAFT:1,2,4".
        quiet: time by which these orders are fitted: "FROM:TO" (default: all of it).
        ring_down: time in which vibrations die away, of which frequency and damping are fitted: "FROM:TO".
        vibrations: number of them.
        steps: as in `transient`.
        accuracy: as in `transient`.
        method: as in `transient`.
        modal_damping: as in `transient`.
        elements: as in `transient`.
        start: as in `transient`.
        error_estimate: as in `transient`.
        progress: callable that is told fraction and step.

    Returns:
        Shares of variance, overall and in bands, beside those of a model without vibration; ring-downs; the best clock offset.

    Raises:
        ModelError: a file that can't be read. AnalysisError: channels that are not on the model, times outside of the record.
    """
    require("numba", "A comparison over time")
    seen = record_on_model(model, time, channels, points)
    t = seen.time
    step = float(t[1] - t[0])
    nyquist = 0.5 / step
    judged = _between("window", window, t)
    limits = [_band(text, nyquist) for text in bands] if bands is not None else None
    dying = None if ring_down is None else _between("ring_down", ring_down, t)
    if vibrations < 1:
        raise AnalysisError(f"vibrations: expected 1 or more of them, got {vibrations}")
    found_offset = offset == "find"
    shift = 0.0 if offset is None or found_offset else quantity(offset, "time", "offset")
    rate = speed if speed is not None else 0.0 if model.operating_speed is None else None
    orders = None if remove is None else _orders(remove, seen, rate)
    fitted = _between("quiet", quiet, t) if quiet is not None else slice(0, len(t))
    if quiet is not None and orders is None:
        raise AnalysisError("quiet (--quiet) is the time by which orders are fitted: give them by remove (--remove)")

    progress(0.0, "model")
    system = flow_system(seen.model, plan_in_time(elements))
    task = prepare(system, rate, elements, start)
    fastest = max(base_frequencies(task), default=0.0)
    each = max(1, int(np.ceil(step * fastest * RECORDS)))
    answer = transient(
        system,
        speed=rate,
        time=float(t[-1] - t[0]),
        discard=0.0,
        interval=step / each,
        steps=steps,
        accuracy=accuracy,
        method=method,
        modal_damping=modal_damping,
        start=start,
        error_estimate=error_estimate,
        progress=progress,
    )
    outputs = seen.of(OUTPUT)
    loads = seen.of(LOAD)
    first = _at_start(task, answer.step)
    computed = np.array([_history(answer, one, t, first) for one in outputs])
    baseline, unknown = _without_vibration(task, outputs, loads, computed[:, 0], step)
    rig = np.array([one.values for one in outputs])
    removed: tuple[str, ...] = ()
    if orders is not None:
        waves, removed = orders
        rig, computed, baseline = (_without(waves, values, fitted) for values in (rig, computed, baseline))
    best, explained = _best_offset(rig, computed, step)
    shift = best if found_offset else shift
    # The channels on the clock of the loads; what the record does not reach is not judged.
    rig = np.array([np.interp(t - shift, t, values) for values in rig])
    inside = (t - shift >= t[0] - 1e-9 * step) & (t - shift <= t[-1] + 1e-9 * step)
    kept = np.flatnonzero(inside[judged])
    if len(kept) < 3:
        raise AnalysisError(f"offset: {shift:g} s leaves nothing of the {t[-1] - t[0]:g} s of the record")
    counted = slice(judged.start + int(kept[0]), judged.start + int(kept[-1]) + 1)
    if limits is None:
        limits = _default_bands(model, nyquist, float(t[-1] - t[0]))
    errors = _errors(answer)
    warnings = [Note("", text) for text in seen.notes] + [Note("", unknown)] * bool(unknown)
    if abs(best) >= 0.99 * _REACH * (t[-1] - t[0]):
        warnings.append(Note("", "the best clock offset lies at the end of what was looked at", "it may be none"))
    warnings += _folded(answer, outputs, nyquist)
    rows = []
    for one, a, b in zip(outputs, rig[:, counted], computed[:, counted], strict=True):
        size = float(np.std(b))
        rows.append(
            TimeMatch(
                name=one.name,
                place=one.place,
                quantity=one.quantity,
                unit=one.unit,
                rig_mean=float(a.mean()),
                model_mean=float(b.mean()),
                rig_largest=float(np.abs(a).max()),
                model_largest=float(np.abs(b).max()),
                error=errors.get(f"rms {one.history}", float("nan")) / size if size > 0.0 else float("nan"),
            )
        )
    fits: tuple[RingDown, ...] = ()
    if dying is not None:
        modes = _damped_modes(model, rate, elements)
        fits = _ring_downs(step, outputs, rig[:, dying], computed[:, dying], vibrations, modes)
    return TimeComparison(
        model=model,
        time=t,
        rig_values=rig,
        model_values=computed,
        baseline_values=baseline,
        load=np.array([one.values for one in loads]).reshape(-1, len(t)),
        inputs=tuple(
            TimeInput(
                one.name, one.place, one.quantity, one.unit, float(one.values.mean()), float(np.abs(one.values).max())
            )
            for one in loads
        ),
        channels=tuple(rows),
        shares=tuple(_shares(outputs, (rig, computed, baseline), counted, limits, step)),
        ring_downs=tuple(fits),
        window_s=(float(t[counted][0]), float(t[counted][-1])),
        offset=shift,
        offset_found=best,
        offset_explained=explained,
        removed=removed,
        error_estimate=answer.error_estimate,
        dofs=answer.dofs,
        left_out=answer.left_out,
        warnings=(*warnings, *answer.warnings),
        status=answer.status,
        method=f"{answer.method}, {answer.steps} steps of {answer.step:.3g} s",
    )


def explained_share(measured: NDArray[np.float64], computed: NDArray[np.float64]) -> float:
    """1 - mean((m - c)^2) / mean(m^2); NaN where there is nothing to explain."""
    size = float(np.mean(measured**2))
    return 1.0 - float(np.mean((measured - computed) ** 2)) / size if size > 0.0 else float("nan")


def _shares(
    outputs: list[Placed],
    three: tuple[NDArray[np.float64], ...],
    counted: slice,
    limits: list[tuple[float, float]],
    step: float,
) -> Iterator[TimeShare]:
    """What of each channel is explained: of its size, of its variance, and of that in bands of Hz.

    `three`: record, answer and baseline (c, n); `counted`: the instants that are judged.
    """
    nyquist = 0.5 / step
    banded = [[_in_band(values, step, *limit)[:, counted] for values in three] for limit in limits]
    for k, one in enumerate(outputs):
        as_it_is = [values[k, counted] for values in three]
        whole = float(np.var(as_it_is[0])) or float("nan")
        parts = [("size", 0.0, nyquist, as_it_is), ("variance", 0.0, nyquist, _about_mean(*as_it_is))]
        for (low, high), within in zip(limits, banded, strict=True):
            parts.append((f"{low:.4g} - {high:.4g} Hz", low, high, _about_mean(*(values[k] for values in within))))
        for part, low, high, (own, found, still) in parts:
            square = float(np.mean(own**2))
            yield TimeShare(
                name=one.name,
                part=part,
                low_hz=low,
                high_hz=high,
                of_record=square / whole if part != "size" else float("nan"),
                ratio=float(np.sqrt(np.mean(found**2) / square)) if square > 0.0 else float("nan"),
                explained=explained_share(own, found),
                quasi_static=explained_share(own, still),
            )


def _about_mean(*values: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    return [one - one.mean() for one in values]


def _between(name: str, text: str | None, t: NDArray[np.float64]) -> slice:
    """The instants of a time "FROM:TO".

    Raises:
        AnalysisError: no such time, or fewer than three instants of the record in it.
    """
    if text is None:
        return slice(0, len(t))
    try:
        low, high = (parse_quantity(_number_or_text(part), "time") for part in text.split(":"))
    except (QuantityError, ValueError):
        raise AnalysisError(f"{name}: got '{text}', expected FROM:TO such as '0 s:0.5 s'") from None
    half = 0.5 * (t[1] - t[0])
    inside = np.flatnonzero((t >= low - 1e-6 * half) & (t <= high + 1e-6 * half))
    if len(inside) < 3:
        raise AnalysisError(
            f"{name}: '{text}' holds {len(inside)} instants of the record, which goes from {t[0]:g} to {t[-1]:g} s"
        )
    return slice(int(inside[0]), int(inside[-1]) + 1)


def _number_or_text(part: str) -> str | float:
    """A part of a range: a text with its unit, or a plain number in SI."""
    from rotorgear.files.numbers import number_of

    try:
        return number_of(part)
    except ValueError:
        return part.strip()


def _band(text: str, nyquist: float) -> tuple[float, float]:
    try:
        low, high = (parse_quantity(_number_or_text(part), "frequency") for part in text.split(":"))
    except (QuantityError, ValueError):
        raise AnalysisError(f"bands: got '{text}', expected FROM:TO such as '15 Hz:60 Hz'") from None
    if not 0.0 <= low < high or low >= nyquist:
        raise AnalysisError(
            f"bands: '{text}' must rise, and begin below {nyquist:.4g} Hz, half of what the record was sampled with"
        )
    return low, min(high, nyquist)


def _default_bands(model: Model, nyquist: float, duration: float) -> list[tuple[float, float]]:
    """Below, about and above the lowest elastic mode, as far as the record tells it."""
    modes = modal(model, modes=_MODES, elements=1, error_estimate=False)
    elastic = modes.frequency_hz[~modes.rigid]
    if not elastic.size:
        return []
    edges = [0.0, *(f for f in (0.5 * elastic[0], 2.0 * elastic[0]) if f < nyquist), nyquist]
    return [(a, b) for a, b in pairwise(edges) if b * duration >= _LEAST_PERIODS]


def _damped_modes(model: Model, speed: float | str | None, elements: int | None) -> NDArray[np.float64]:
    """Natural frequencies in Hz and damping ratios (m, 2) of the lowest modes that swing, with the model's dampers."""
    modes = modal(model, speed=needed_speed(speed, model), modes=_MODES, elements=elements or 1, error_estimate=False)
    swings = ~modes.rigid & (modes.frequency_hz > 0.0)
    return np.column_stack([modes.natural_frequency_hz, modes.damping_ratio])[swings]


def _in_band(values: NDArray[np.float64], step: float, low: float, high: float) -> NDArray[np.float64]:
    """Channels (c, n) in a band of Hz, nothing shifted."""
    from scipy.signal import butter, sosfiltfilt

    about = values - values.mean(axis=1, keepdims=True)
    nyquist = 0.5 / step
    upper = high < nyquist * (1.0 - 1e-9)
    if low <= 0.0 and not upper:
        return about
    kind = "band" if low > 0.0 and upper else "high" if low > 0.0 else "low"
    edges = [low, high] if kind == "band" else low if kind == "high" else high
    sections = butter(_FILTER_ORDER, edges, kind, fs=1.0 / step, output="sos")
    padding = min(values.shape[1] - 1, max(3 * 2 * (len(sections) + 1), int(1.0 / (max(low, 0.1 * high) * step))))
    return np.asarray(sosfiltfilt(sections, about, axis=1, padlen=padding))


def _at_start(task: Task, step: float) -> dict[str, float]:
    """Values of the channels where the transient starts; its records begin one later."""
    local = task.local.local
    state = state_at_rest(local, step, task.begin)
    values = local.observed_rows.values(state.q, state.v, state.a, state.F) + task.channels.constant
    return dict(zip(task.channels.names, values.tolist(), strict=True))


def _history(
    answer: TransientResult, one: Placed, t: NDArray[np.float64], first: dict[str, float]
) -> NDArray[np.float64]:
    """What the model answers in a channel at the instants of the record."""
    if one.history not in answer.channel:
        raise AnalysisError(
            f"channel '{one.name}': the model has no '{one.history}', since what it is of can't move; its histories are "
            f"{', '.join(answer.channel)[:200]}"
        )
    own = np.concatenate([[0.0], answer.time])
    return np.interp(t - t[0], own, np.concatenate([[first[one.history]], answer.history(one.history)]))


def _folded(answer: TransientResult, outputs: list[Placed], nyquist: float) -> Iterator[Note]:
    """Channels of which the model moves faster than the record was sampled for: at its instants that looks like slow motion."""
    for one in outputs:
        history = answer.history(one.history)
        power = np.abs(np.fft.rfft(history - history.mean())) ** 2
        hz = np.fft.rfftfreq(len(history), answer.spacing)
        share = float(power[hz > nyquist].sum() / (power.sum() or np.nan))
        if share > _FOLDED:
            what = f"{100.0 * share:.2g} % of the model's variance lies above {nyquist:.4g} Hz, half of what was sampled with"
            yield Note(f"channel '{one.name}'", what, "it is folded into the frequencies below: sample faster")


def _errors(answer: TransientResult) -> dict[str, float]:
    return dict(zip(answer.quantity, answer.quantity_error.tolist(), strict=True))


def _without_vibration(
    task: Task, outputs: list[Placed], loads: list[Placed], first: NDArray[np.float64], step: float
) -> tuple[NDArray[np.float64], str]:
    """The outputs (c, n) of the model without vibration, and why there is none."""
    count = len(outputs[0].values)
    local = task.local
    if local.local.sisters.planets.size:
        return np.full((len(outputs), count), np.nan), "there is no baseline: planets go round"
    columns: list[int] = []
    tables: list[NDArray[np.float64]] = []
    for k, part in enumerate(local.parts):
        of_load = next((one for one in loads if one.history == part.part), None)
        if of_load is not None:
            history = local.system.model.loads[part.part.removeprefix("loads.")].history
            assert history is not None, "made so"
            columns.append(int(local.local.forces.first[k]))
            tables.append(np.array(history.values[history.components.index(part.label.split()[-1])]))
    if not columns:
        return np.tile(first[:, None], (1, count)), ""
    whole = quasi_static(task, np.array(columns), np.array(tables), step)
    places = [task.channels.names.index(one.history) for one in outputs]
    return first[:, None] + whole[places], ""


def _orders(text: str, seen: RecordOnModel, speed: float | str | None) -> tuple[NDArray[np.float64], tuple[str, ...]]:
    """Cosines and sines (n, w) of orders of a shaft over the record, and what they are called."""
    shaft, _, rest = text.partition(":")
    shaft = shaft.strip().removeprefix("shafts.")
    if shaft not in seen.model.shafts:
        raise AnalysisError(f"remove: the model has no shaft '{shaft}'; it has {', '.join(seen.model.shafts)}")
    try:
        orders = [float(parse_quantity(part.strip(), "ratio")) for part in rest.split(",")]
    except QuantityError:
        orders = []
    if not orders or min(orders) <= 0.0:
        raise AnalysisError(f"remove: got '{text}', expected SHAFT:ORDERS such as 'output:1,2,4'")
    turning = seen.of(TURNING)
    if turning:
        train = seen.model.layout.train
        own = turning[0].place.removeprefix("shafts.")
        rate = turning[0].values * abs(float(train.ratio(shaft)) / (float(train.ratio(own)) or np.nan))
    else:
        reference = needed_speed(speed, seen.model)
        rate = np.full(len(seen.time), abs(reference * float(seen.model.layout.train.ratio(shaft))))
    if not np.all(np.isfinite(rate)) or not np.any(rate):
        raise AnalysisError(f"remove: shaft '{shaft}' does not turn at the speed of the analysis: give it by --speed")
    step = seen.time[1] - seen.time[0]
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]) * step)])
    waves = [wave(order * angle) for order in orders for wave in (np.cos, np.sin)]
    return np.column_stack(waves), tuple(f"order {order:g} of {shaft}" for order in orders)


def _without(waves: NDArray[np.float64], values: NDArray[np.float64], fitted: slice) -> NDArray[np.float64]:
    """Channels (c, n) less what least squares over some instants find of waves (n, w) beside a straight line."""
    line = np.column_stack([np.ones(len(waves)), np.linspace(-1.0, 1.0, len(waves))])
    basis = np.hstack([line, waves])[fitted]
    if len(basis) < 2 * basis.shape[1]:
        raise AnalysisError(f"quiet: {len(basis)} instants are too few to fit {waves.shape[1] // 2} orders by")
    amplitudes = np.linalg.lstsq(basis, values.T[fitted], rcond=None)[0]
    return np.asarray(values - (waves @ amplitudes[2:]).T)


def _best_offset(rig: NDArray[np.float64], computed: NDArray[np.float64], step: float) -> tuple[float, float]:
    """The time that the channels are to be shifted by so that most is explained, and the mean share explained then.

    Shares of all shifts by whole steps at once, from correlations, over what both have in common; between steps by a parabola.
    """
    from scipy.signal import fftconvolve

    n = rig.shape[1]
    reach = max(1, int(_REACH * n))
    shifts = np.arange(-reach, reach + 1)
    begin = np.maximum(0, shifts)
    end = np.minimum(n, n + shifts)
    count = end - begin
    total = np.zeros(len(shifts))
    used = 0
    for m, c in zip(rig, computed, strict=True):
        m = m - m.mean()
        c = c - c.mean()
        if not np.any(m):
            continue

        def sums(x: NDArray[np.float64], first: NDArray[np.intp], last: NDArray[np.intp]) -> NDArray[np.float64]:
            upto = np.concatenate([[0.0], np.cumsum(x)])
            return np.asarray(upto[last] - upto[first])

        # Shifted by k, m[i - k] stands beside c[i].
        cross = fftconvolve(c, m[::-1])[n - 1 + shifts]
        m1, m2 = (sums(x, begin - shifts, end - shifts) / count for x in (m, m**2))
        c1, c2 = (sums(x, begin, end) / count for x in (c, c**2))
        left = m2 + c2 - 2.0 * cross / count - (m1 - c1) ** 2
        total += 1.0 - left / np.maximum(m2 - m1**2, 1e-12 * np.var(m))
        used += 1
    if not used:
        return 0.0, float("nan")
    share = total / used
    k = int(np.argmax(share))
    late = 0.0
    if 0 < k < len(share) - 1:
        a, b, c = share[k - 1 : k + 2]
        bend = a - 2.0 * b + c
        late = float(np.clip(0.5 * (a - c) / bend, -0.5, 0.5)) if bend < 0.0 else 0.0
    return float((shifts[k] + late) * step), float(share[k])


def _ring_downs(
    step: float,
    outputs: list[Placed],
    rig: NDArray[np.float64],
    computed: NDArray[np.float64],
    count: int,
    modes: NDArray[np.float64],
) -> tuple[RingDown, ...]:
    """Vibrations of each channel and, where there are several, of all together, of rig and answer, beside the nearest modes.

    `modes` (m, 2): natural frequencies in Hz and damping ratios.
    """
    sets = [(one.name, [k]) for k, one in enumerate(outputs)] if len(outputs) > 1 else []
    rows = []
    for name, which in [*sets, ("all", list(range(len(outputs))))]:
        of_rig = fit_ring_down(step, rig[which], count)
        try:
            of_model = fit_ring_down(step, computed[which], count)
        except AnalysisError:  # a model that stands still has none
            of_model = ()
        for k, one in enumerate(of_rig):
            own = of_model[k] if of_model else None
            far = np.abs(np.log(modes[:, 0] / one.natural_hz))
            mode = modes[np.argmin(far)] if len(modes) else np.full(2, np.nan)
            rows.append(
                RingDown(
                    name=name,
                    rig_hz=one.natural_hz,
                    rig_hz_sigma=one.natural_hz_sigma,
                    rig_damping_ratio=one.damping_ratio,
                    rig_damping_ratio_sigma=one.damping_ratio_sigma,
                    answer_hz=own.natural_hz if own else float("nan"),
                    answer_damping_ratio=own.damping_ratio if own else float("nan"),
                    mode_hz=float(mode[0]),
                    mode_damping_ratio=float(mode[1]),
                    explained=one.explained,
                )
            )
    return tuple(rows)
