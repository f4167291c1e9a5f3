"""What an optimisation may change of flanks: amounts and lengths, their bounds, and how a model file writes them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.model.layout.mesh_layout import MeshLayout
from rotorgear.quantity import QuantityError, did_you_mean, parse_quantity

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
            raise AnalysisError(f"optimise: there is no '{field}': {did_you_mean(field, NAMES)}")
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
        double = min(max(teeth.pair.transverse_contact_ratio - 1.0, 0.1), 1.0) * teeth.base_pitch
        shortest = min(
            outline.tip_roll_length - outline.form_roll_length
            for outline in (tooth_outline(teeth.first), tooth_outline(teeth.second))
        )
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
