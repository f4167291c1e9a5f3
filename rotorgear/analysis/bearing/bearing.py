"""The verb `bearing`: one bearing at the loads of its gearbox, inside and from outside, and over speed.

Stability over speed is that of the whole gearbox on its bearings: the least logarithmic decrement, and where it falls through
zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.optimize import brentq

from rotorgear.analysis.bearing.state import (
    address_of,
    by_its_law,
    carried,
    change_of_tangents,
    law_at,
    laws_of,
    on_grid,
    relative,
)
from rotorgear.analysis.campbell.speeds import system_for_speeds
from rotorgear.analysis.common.recorded import recorded
from rotorgear.analysis.common.request import speed_in_si, speed_or_operating
from rotorgear.analysis.modal.modal import ModalRequest, modal
from rotorgear.analysis.static.solve import LawState
from rotorgear.analysis.static.state_at import state_at
from rotorgear.cpu import compiling_seconds, cpu_seconds
from rotorgear.errors import AnalysisError
from rotorgear.forces.inside import OilField, RollingLoads
from rotorgear.forces.law import CYCLE_POINTS, ForceLaw
from rotorgear.model.model import Model
from rotorgear.note import Note
from rotorgear.progress import Progress, silent
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.bearing import BearingSheet, BearingSpeed
from rotorgear.system.system import System

_MODES = 24
# Smaller damping ratios are rounding of a mode that nothing damps.
_UNDAMPED = 1e-9
# The threshold is found to this share of its speed.
_THRESHOLD = 1e-5


def _least_decrement(
    model: Model, system: System, speed: float, near: Sequence[LawState] = ()
) -> tuple[float | None, float]:
    """Smallest logarithmic decrement of what oscillates and is damped, None where nothing is, and its frequency in Hz.

    Args:
        model: a checked model; system: its mesh. speed: of the reference shaft in rad/s.
        near: the laws in a known equilibrium at that speed or near by.
    """
    state_at(model, [speed], near=near)  # which the modes find there
    modes = modal(system, speed=speed, modes=_MODES, error_estimate=False)
    s = modes.eigenvalues
    s = s[(s.imag > 0.0) & ~modes.rigid & (np.abs(s.real) > _UNDAMPED * np.abs(s))]
    if not s.size:
        return None, 0.0
    least = s[np.argmax(s.real / s.imag)]
    return float(-2.0 * np.pi * least.real / least.imag), float(least.imag / (2.0 * np.pi))


# Of the operating speed, where no speeds are given.
_SHARES = (0.25, 0.5, 0.75, 1.0, 1.25, 1.5)


@recorded
def bearing(
    model: Model,
    name: str | None = None,
    *,
    speed: float | str | None = None,
    speeds: Sequence[float | str] | None = None,
    stability: bool = True,
    progress: Progress = silent,
) -> BearingSheet:
    """Return the sheet of one bearing: its state at the loads of the gearbox, and stiffness, damping and stability over speed.

    Args:
        model: a model with torques, forces, weight or other loads.
        name: name of a bearing with `rolling`, `journal` or `thrust`, or of a nonlinear element; it may be left out where
            there is only one.
        speed: speed of the input shaft in rad/s or with its unit (default: the operating speed).
        speeds: speeds of the input shaft over which stiffness and damping are listed (default: 0.25 to 1.5 times `speed`).
        stability: also solve the damped modes of the gearbox at these speeds: least logarithmic decrement, and the threshold of
            whirl.
        progress: callable that is told fraction and step.

    Raises:
        AnalysisError: no such bearing, or no equilibrium.
    """
    address = address_of(model, name)
    given = speed_or_operating(speed, model) or 0.0
    own = by_its_law(model, address)
    part = getattr(model, address.partition(".")[0])[address.partition(".")[2]]
    ratio = float(model.layout.train.ratio(part.shaft))
    across = tuple(getattr(part, "directions", ("x", "y")))[:2] == ("x", "y")
    films = [f"bearings.{one}" for one, bearing in own.bearings.items() if bearing.has_film]
    if not given and address in films:
        raise AnalysisError(f"{address}: a film carries where its journal turns; give a speed")
    progress(0.0, "equilibrium of the gearbox")
    state = law_at(laws_of(own, given), address)
    law = state.part.law
    started = cpu_seconds() - compiling_seconds()
    here = carried(state, law, given)
    seconds = cpu_seconds() - compiling_seconds() - started
    consistency = relative(here.force - state.force, state.force)
    progress(0.2, "error estimate")
    other = carried(state, on_grid(law, 2.0), given, 2 * CYCLE_POINTS)
    error = change_of_tangents(here, other)
    law = here.part.law
    inside = law.settled(here.d).inside(here.d, speed=given)
    asked = (
        [speed_in_si(one) for one in speeds] if speeds is not None else [share * given for share in _SHARES if given]
    )
    # Each equilibrium is looked for from the one before; a speed without one is a warning.
    found: dict[float, Sequence[LawState]] = {}
    notes = []
    near: Sequence[LawState] = ()
    rows = []
    for number, at in enumerate(dict.fromkeys(sorted(asked, key=abs))):
        rpm = f"{at * RPM_PER_RAD_S:.6g} rpm"
        progress(0.3 + 0.2 * number / len(asked), rpm)
        try:
            near = found[at] = laws_of(own, at, near)
        except AnalysisError as missing:
            notes.append(Note("", f"{rpm} is left out", str(missing)))
            continue
        there = law_at(near, address)
        plane = there.stiffness[:2, :2], there.damping[:2, :2]
        mass, whirl = rigid_threshold(*plane, ratio * at) if across else (None, None)
        rows.append(
            BearingSpeed(
                speed=at,
                load=there.force,
                displacement=there.d,
                stiffness=there.stiffness,
                damping=there.damping,
                critical_mass=mass,
                whirl_ratio=whirl,
                film_temperature=getattr(there.part.law, "temperature", None),
                log_decrement=None,
            )
        )
    threshold = None
    if stability and found:
        progress(0.5, "stability")
        # One mesh serves the modes at both ends of the range.
        ends = (min(found, key=abs), max(found, key=abs))
        system = system_for_speeds(own, ends, ModalRequest(modes=_MODES))
        least = [_least_decrement(own, system, at, near)[0] for at, near in found.items()]
        rows = [replace(row, log_decrement=one) for row, one in zip(rows, least, strict=True)]
        progress(0.85, "threshold")
        # Speeds rise in size: the first pair between which the least decrement falls through zero, at its own equilibria.
        for (low, begin), (high, end) in pairwise(zip(found, least, strict=True)):
            if begin is not None and end is not None and begin > 0.0 >= end:

                def decrement(speed: float, near: Sequence[LawState] = found[high]) -> float:
                    return _least_decrement(own, system, speed, near)[0] or 0.0

                whirling = float(brentq(decrement, low, high, xtol=_THRESHOLD * abs(high)))
                threshold = whirling, _least_decrement(own, system, whirling, found[high])[1]
                break
    # What the sheet says of the inside, under its name there.
    told: dict[str, Any] = {}
    if inside is not None:
        declared = BearingSheet.declarations[inside.told_as]
        assert isinstance(declared.record, type)
        records = tuple(declared.record(**row) for row in inside.told(law, here.force, here.d, ratio * given))
        told = {inside.told_as: records if declared.axes else records[0]}
    progress(1.0, "done")
    return BearingSheet(
        model=model,
        bearing=address,
        law=law.title,
        speed=given,
        shaft_speed=ratio * given,
        geometry={name: value for name in law.declared() if not isinstance(value := getattr(law, name), tuple)},
        bearing_load=state.force,
        bearing_displacement=here.d,
        bearing_stiffness=here.stiffness,
        bearing_damping=here.damping,
        averaged=bool(law.cycle()) and bool(given),
        **told,
        over_speed=tuple(rows),
        threshold_speed=threshold[0] if threshold else None,
        threshold_frequency_hz=threshold[1] if threshold else None,
        consistency=consistency,
        error_estimate=error,
        cpu_seconds=seconds,
        left_out=(*_left_out(model, address, law, inside), *here.doubts(given)),
        warnings=tuple(notes),
        method="equilibrium of the whole gearbox, Newton's method; tangents of the bearing's law",
    )


def rigid_threshold(K: np.ndarray, C: np.ndarray, speed: float) -> tuple[float | None, float | None]:
    """Mass of a rigid rotor that is at its threshold on a bearing, and the ratio of its whirl to the speed; None without.

    With m s^2 + C s + K singular at s = i w:  k = m w^2 = (Kxx Cyy + Kyy Cxx - Kxy Cyx - Kyx Cxy)/(Cxx + Cyy) and
    w^2 = ((Kxx - k)(Kyy - k) - Kxy Kyx)/(Cxx Cyy - Cxy Cyx)  (Lund, J. Tribology 109 (1987) 37).

    Args:
        K, C: stiffness and damping across the shaft, (2, 2). speed: of the shaft in rad/s.
    """
    trace = C[0, 0] + C[1, 1]
    determinant = float(np.linalg.det(C))
    if trace <= 0.0 or determinant <= 0.0 or not speed:
        return None, None
    k = (K[0, 0] * C[1, 1] + K[1, 1] * C[0, 0] - K[0, 1] * C[1, 0] - K[1, 0] * C[0, 1]) / trace
    square = ((K[0, 0] - k) * (K[1, 1] - k) - K[0, 1] * K[1, 0]) / determinant
    if square <= 0.0 or k <= 0.0:
        return None, None
    return float(k / square), float(np.sqrt(square) / abs(speed))


def _left_out(model: Model, address: str, law: ForceLaw, inside: object) -> list[Note]:
    table, _, name = address.partition(".")
    notes = [Note(address, text) for text in law.left_out()]
    if table == "bearings" and model.bearings[name].stiffness is not None:
        notes.append(Note(address, "the stiffness given beside its rolling elements, which carry here"))
    if isinstance(inside, OilField):
        why = "friction is that of a film that is whole, the most it can be"
        notes.append(Note("", "oil in streamers where the film has broken", why))
    if isinstance(inside, RollingLoads):
        notes.append(Note(address, "centrifugal force of its rolling elements, and friction"))
    return notes
