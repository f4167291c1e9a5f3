"""Error estimates of a mesh analysis, in parts: finite elements, slices of the contact lines, positions in the cycle.

Elements: the same on a coarser mesh of the same kind, at some of the positions. The two differ by the error of the coarser one
less that of the finer one; the share of it that remains on the finer mesh was measured (docs/mesh.md has both, side by side).
In space errors of layers and of the section are apart. Of layers, an error falls with their thickness like h^p, p = 3/2, so that
1/((h_1/h)^p - 1) of the difference remains: narrow faces, whose layers can't be much thinner, keep more of it. The presets are
nearly alike in the section, whose error is as large as that of layers: it follows from two coarse sections in the same thick
layers. Both parts add up by their squares, for one knows nothing of the other. Default and fine are compared with the same coarse
meshes, so that the finer one never estimates worse. The blank of a wheel has elements of its own: in the comparison they are
twice as large.
Slices: the same elements with half as many slices again. Positions: contact solutions between those that are kept
(`gears/loaded/cycle_positions`). What is printed is the sum.

Peaks to peaks of two curves may agree by chance. Two curves that lie apart by d(u) are taken to differ in peak to peak by no less
than the standard deviation of d over the cycle.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace

import numpy as np

from rotorgear.analysis.teeth.request import MeshRequest, SolvedHelices, curves_at
from rotorgear.gears.loaded.tooth_contact import in_space
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.gears.tooth_fe.points import MeshSize
from rotorgear.gears.tooth_fe.settings import ToothFe, coarser_size
from rotorgear.progress import Progress, part_of, silent
from rotorgear.results.mesh import MeshErrors

# Share of the difference between two meshes that remains on the finer one, in the plane; and p in space, as measured there.
_REMAINING = {"preview": 1.5, "default": 0.35, "fine": 0.6}
_ORDER = 1.5
# The same of wheels: corners of rim, web and hub let the error of the blank's mesh fall with its side, not faster.
_OF_WHEELS = {"preview": 1.5, "default": 0.7, "fine": 0.6}
_COARSER_BLANK = 2.0
# A section in space that is coarser than the coarser mesh, and the shares of what the two differ by that remain on a preset's:
# of means and of ripples, which keep more. By 34/80 (20.86 degrees, two loads), 30/72 (33.27) and 32/64 (28).
_ROUGH_SECTION = MeshSize(5, 2, 3, 2, 2)
_OF_SECTION = {"default": (0.6, 1.0), "fine": (0.55, 0.8)}
# The same of the largest pressure in space: it occurs where contact lines end at the edge of a face, and converges slowly.
_OF_PRESSURE = {"preview": 3.0, "default": 1.5, "fine": 0.7}
# Slices beside the usual ones.
_MORE_SLICES = 1.5
# Positions in a period at which other meshes are compared, beside the extremes of the curves.
_COMPARED = 24
# No estimate is better than what elements and contact are solved to.
_LEAST = 1e-4
# Orders of the transmission error whose amplitudes the estimate covers.
ORDERS = 5


@dataclass(frozen=True)
class ErrorParts:
    """Estimated relative errors by their cause; what is not known is None."""

    elements: MeshErrors | None
    slices: MeshErrors | None
    sampling: MeshErrors
    total: MeshErrors


def error_parts(
    request: MeshRequest, teeth: ToothPair, found: SolvedHelices, progress: Progress = silent
) -> ErrorParts | None:
    """Estimate the errors of solved helices; None for uncoupled slices, whose error no mesh of theirs can show."""
    space, uncoupled = in_space(teeth)
    if uncoupled:
        return None
    sampling = sampling_errors(found)
    # Other meshes are looked at at positions that are spread evenly, and at the extremes of all curves.
    even = np.arange(0.0, found.curve.period, 1.0 / _COMPARED)
    nearest = np.abs(found.curve.position[:, None] - even).argmin(axis=0)
    values = found.curve.values[:, [0, 1, 3]]
    compared = np.unique([*nearest, *values.argmax(axis=0), *values[:, :2].argmin(axis=0)])
    u = found.curve.position[compared]
    here = values[compared]
    periods = round(found.curve.period)

    def curves(other: ToothPair, told: Progress) -> np.ndarray:
        return curves_at(request, other, u, periods, told)

    fe = teeth.fe
    width = teeth.width / teeth.first.normal_module
    compared_with = replace(fe, preset="default") if space and fe.preset == "fine" else fe
    size = coarser_size(compared_with, width, space=space)
    coarser = replace(teeth, fe=replace(fe, size=size, blank_coarseness=_COARSER_BLANK * fe.blank_coarseness))
    share = 1.0 if fe.size is not None else _remaining(teeth, size, space)
    of_pressure = _OF_PRESSURE[fe.preset] if space and fe.size is None else share
    elements = _apart(here, curves(coarser, part_of(progress, 0.0, 0.4)), share, of_pressure)
    if space and fe.size is None and fe.preset in _OF_SECTION and not teeth.on_wheel:
        elements = _combined(elements, _section_errors(coarser, curves), how=math.hypot)
    slices = None
    if space:
        more = replace(teeth, fe=replace(fe, slices=round(_MORE_SLICES * found.problem.slices)))
        slices = _apart(here, curves(more, part_of(progress, 0.6, 1.0)))
    known = [part for part in (elements, slices, sampling) if part is not None]
    total = _combined(*known, how=lambda *values: max(_LEAST, sum(values)))
    return ErrorParts(elements, slices, sampling, total)


def _section_errors(coarser: ToothPair, curves: Callable[[ToothPair, Progress], np.ndarray]) -> MeshErrors:
    """Errors of a preset's section in space, from the coarser mesh and a rougher section in the same layers."""
    fe = coarser.fe
    assert fe.size is not None
    # Wider patches hide a part of the section's error, so both presets are judged with those of the finer one.
    narrow = replace(fe, patch=fe.patch or ToothFe(preset="fine").patch_width)
    rough = replace(narrow, size=replace(_ROUGH_SECTION, face=fe.size.face))
    here, there = (curves(replace(coarser, fe=one), silent) for one in (narrow, rough))
    difference = there - here
    mean, of_ripple = _OF_SECTION[fe.preset]
    stiffness = mean * float(abs(difference[:, 1].mean()) / here[:, 1].mean())
    # Twice the standard deviation, as for harmonics: peaks of so thick layers are not those of the preset's.
    ripple = 2.0 * of_ripple * difference.std(axis=0) / np.maximum(np.ptp(here, axis=0), 1e-300)
    return MeshErrors(
        mean_stiffness=stiffness,
        peak_to_peak_stiffness=max(float(ripple[1]), stiffness),
        ste_peak_to_peak=max(float(ripple[0]), stiffness),
        ste_harmonics=max(float(ripple[0]), stiffness),
        largest_pressure=mean * float(abs(there[:, 2].max() / here[:, 2].max() - 1.0)),
    )


def _remaining(teeth: ToothPair, coarser: MeshSize, space: bool) -> float:
    """Share of the difference to a coarser mesh that remains on a preset's own."""
    fe = teeth.fe
    if not space or fe.preset == "preview":
        return (_OF_WHEELS if teeth.on_wheel else _REMAINING)[fe.preset]
    layers = fe.mesh_size(teeth.width / teeth.first.normal_module, space=True).face
    share = 1.0 / ((layers / coarser.face) ** _ORDER - 1.0)
    return max(share, _OF_WHEELS[fe.preset]) if teeth.on_wheel else share


def _apart(here: np.ndarray, there: np.ndarray, share: float = 1.0, of_pressure: float = 1.0) -> MeshErrors:
    """Relative differences of transmission error, stiffness and largest pressure (m, 3) at the same positions."""
    difference = there - here
    spread = np.maximum(np.abs(np.ptp(there, axis=0) - np.ptp(here, axis=0)), difference.std(axis=0))
    size = np.maximum(np.ptp(here, axis=0), 1e-300)
    mean = float(abs(difference[:, 1].mean()) / here[:, 1].mean())
    # A ripple is not known better than the mean: its two errors may cancel between two meshes.
    ripple = np.maximum(spread / size, mean)
    highest = here[:, 2].max()
    return MeshErrors(
        mean_stiffness=share * mean,
        peak_to_peak_stiffness=share * float(ripple[1]),
        ste_peak_to_peak=share * float(ripple[0]),
        # Amplitudes change by sqrt(2) standard deviations of d if one order has it all; the strongest is near half the ripple.
        ste_harmonics=share * float(max(difference[:, 0].std() / (0.5 * size[0]), mean)),
        largest_pressure=of_pressure * float(abs(there[:, 2].max() - highest) / highest),
    )


def sampling_errors(found: SolvedHelices) -> MeshErrors:
    """What may lie between the positions that are kept, relative to each number."""
    sampling = found.sampling
    kept = sampling.curve
    ripple = sampling.peak_to_peak_error() / np.maximum(np.ptp(kept.values, axis=0), 1e-300)
    strongest = max(float(np.abs(kept.harmonics(ORDERS)[:, 0]).max()), 1e-300)
    return MeshErrors(
        mean_stiffness=float(sampling.mean_error()[1] / kept.mean()[1]),
        peak_to_peak_stiffness=float(ripple[1]),
        ste_peak_to_peak=float(ripple[0]),
        ste_harmonics=float(sampling.harmonics_error(ORDERS)[:, 0].max()) / strongest,
        largest_pressure=float(sampling.largest_error()[2] / kept.values[:, 2].max()),
    )


def _combined(*parts: MeshErrors, how: Callable[..., float]) -> MeshErrors:
    """Estimates from those of parts, number by number."""
    return MeshErrors(*(how(*(getattr(part, field.name) for part in parts)) for field in fields(MeshErrors)))
