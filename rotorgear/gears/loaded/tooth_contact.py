"""The contact problem of one helix: line of action, compliance of both gears, gaps; from a tooth pair and its FE settings."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.flank import FlankModification
from rotorgear.gears.geometry.geometry import THIN_TIP
from rotorgear.gears.geometry.line_of_action import LineOfAction, generated_line
from rotorgear.gears.loaded.contact_points import Slices
from rotorgear.gears.stiffness.blank_note import web_left_out
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.gears.tooth_fe.compliance_model import ComplianceKey, compliance_key, gear_compliance, wind_up
from rotorgear.gears.tooth_fe.gear_compliance import GearCompliance
from rotorgear.progress import Progress, silent

# Stations of the preview along the face.
_STATIONS = 48


@dataclass(frozen=True)
class ContactProblem:
    """One helix, ready for any load and position; index 0 is the pinion, 1 the gear.

    Attributes:
        line: line of action.
        width: common face width (m).
        module: normal module (m).
        compliance: of both gears in normal modules, for a Young's modulus of 1.
        scale: (2,) factors that bring it to m/N (space) or m^2/N (plane).
        local: (2,) K = 2 (1 - nu^2)/(pi E) of both gears (m^2/N).
        modulus: E* (Pa).
        plane: whether the compliance is that of a unit width.
        uncoupled: whether slices along the face don't feel each other.
        slices: of a contact line over the whole face.
        patch: largest half-width of a patch in normal modules.
        flanks: deviations of both flanks.
        teeth: numbers of teeth.
        misalignment: over the whole face (m).
        body: what the teeth stand on, in words.
        unknowns: of both finite-element models together.
        warnings: sentences.
    """

    line: LineOfAction
    width: float
    module: float
    compliance: tuple[GearCompliance, GearCompliance]
    scale: tuple[float, float]
    local: np.ndarray
    modulus: float
    plane: bool
    uncoupled: bool
    slices: int
    patch: float
    flanks: tuple[FlankModification, FlankModification]
    teeth: tuple[int, int]
    misalignment: float
    body: str
    unknowns: int
    warnings: tuple[str, ...] = ()

    @property
    def cosine(self) -> float:
        """cos b_b: F_bt = F_n cos b_b."""
        return float(np.cos(self.line.base_helix_angle))

    @property
    def one_slice(self) -> bool:
        """Whether a tooth pair has one slice, in the plane: then solutions are cheap, and patches follow no load."""
        return self.plane and not self.uncoupled

    @property
    def oblique(self) -> bool:
        """Whether contact lines are oblique, on elements in space."""
        return not self.plane and self.line.base_helix_angle > 0.0

    @property
    def largest_gap(self) -> float:
        """Upper bound of all gaps from deviations (m)."""
        return sum(flank.largest for flank in self.flanks) + abs(self.misalignment)

    def gap(self, slices: Slices, period: int = 0) -> np.ndarray:
        """Mean gap (n,) of each slice along the flank normal before loading (m), `period` base pitches after position 0."""
        return np.asarray(np.sum(self.gap_along(slices, period) * slices.weight, axis=1))

    def gap_along(self, slices: Slices, period: int = 0) -> np.ndarray:
        """The same at the places (n, q) along each slice."""
        gap = slices.gap + self.misalignment * slices.z / self.width
        for i, flank in enumerate(self.flanks):
            gap = gap + flank.depth(slices.roll[i], slices.z, self.line.form[i], self.line.tip[i], self.width)
            # Pair -n comes into mesh n periods after pair 0.
            tooth = period - slices.pair
            gap = gap + flank.measured_depth(slices.roll[i], slices.z, tooth, self.teeth[i])
            gap = gap + flank.pitch_depth(tooth, self.teeth[i])[:, None]
        return np.asarray(gap)


def line_of_action(teeth: ToothPair) -> LineOfAction:
    """Line of action of a pair, with the form circles of its generated teeth."""
    line = generated_line(
        teeth.first, teeth.second, teeth.pair, (teeth.first_flank.tip_break, teeth.second_flank.tip_break)
    )
    if line.contact_ratio < 1.0 and line.base_helix_angle == 0.0:
        raise AnalysisError(
            f"The transverse contact ratio is {line.contact_ratio:.3f}: below 1 there are positions where no teeth touch. "
            "Raise the addendum or reduce the centre distance."
        )
    return line


def in_space(teeth: ToothPair) -> tuple[bool, bool]:
    """Whether the teeth need a three-dimensional model, and whether slices that don't feel each other stand in for it."""
    fe = teeth.fe
    flanks = (teeth.first_flank, teeth.second_flank)
    blanks = (teeth.first_body.blank, teeth.second_body.blank)
    # A web off the middle of the face tilts its rim.
    kinds = teeth.bodies
    on_one_side = any(
        b is not None and b.web_position and kind == "wheel" for b, kind in zip(blanks, kinds, strict=True)
    )
    varies = (
        teeth.first.helix_angle > 0.0
        or teeth.tilts
        or on_one_side
        or any(flank.along_face for flank in flanks)
        or bool(teeth.misalignment)
    )
    space = fe.space if fe.space is not None else varies and fe.preset != "preview"
    return space, varies and not space


def contact_problem(teeth: ToothPair, progress: Progress = silent, *, fresh: bool = False) -> ContactProblem:
    """Prepare the contact of one helix: the compliance of both gears is read from disk or computed (`fresh`: always computed).

    Raises:
        AnalysisError: teeth that can't be made, meshed or brought into contact.
        MissingExtraError: scikit-fem is needed and not installed.
    """
    fe = teeth.fe
    line = line_of_action(teeth)
    space, uncoupled = in_space(teeth)
    module = teeth.first.normal_module
    bodies = (teeth.first_body, teeth.second_body)
    keys = (gear_key(teeth, 0, space=space), gear_key(teeth, 1, space=space))
    kinds = teeth.bodies
    compliances = []
    for i, name in enumerate(("pinion", "gear")):

        def told(fraction: float, text: str, i: int = i, name: str = name) -> None:
            progress(0.5 * (i + fraction), f"{name}: {text}")

        told(0.0, "teeth")
        compliance = gear_compliance(keys[i], told, fresh=fresh)
        if fe.excludes_torsion(
            kinds[i]
        ):  # the rotation of the teeth about the axis against the held circle is left out
            compliance = replace(compliance, flexibility=compliance.flexibility - wind_up(keys[i]))
        compliances.append(compliance)
    # A plane model is that of a unit width in the transverse section: cos b_b of the force, and again of the displacement, lie
    # in that section. In space the compliance of a body grows as 1 / (E m_n).
    unit = math.cos(line.base_helix_angle) ** 2 if not space else 1.0 / module
    size = fe.mesh_size(teeth.width / module, space=space)
    slices = _STATIONS if uncoupled else (fe.slices or 2 * size.face if space else 1)
    plane_strain = [(1.0 - body.poisson_ratio**2) / body.youngs_modulus for body in bodies]
    return ContactProblem(
        line=line,
        width=teeth.width,
        module=module,
        compliance=(compliances[0], compliances[1]),
        scale=(unit / bodies[0].youngs_modulus, unit / bodies[1].youngs_modulus),
        local=np.array([2.0 * value / math.pi for value in plane_strain]),
        modulus=1.0 / sum(plane_strain),
        plane=not space,
        uncoupled=uncoupled,
        slices=slices,
        patch=fe.patch_width,
        flanks=(teeth.first_flank, teeth.second_flank),
        teeth=(abs(teeth.first.teeth), abs(teeth.second.teeth)),
        misalignment=teeth.misalignment,
        body=fe.body_text(
            kinds, (module * keys[0].held_radius, module * keys[1].held_radius), internal=teeth.second.is_internal
        ),
        unknowns=sum(compliance.unknowns for compliance in compliances),
        warnings=_warnings(teeth, line),
    )


def gear_key(teeth: ToothPair, gear: int, *, space: bool) -> ComplianceKey:
    """What the compliance of the pinion (0) or the gear (1) depends on."""
    geometry = (teeth.first, teeth.second)[gear]
    body = (teeth.first_body, teeth.second_body)[gear]
    # The gear's own face runs the other way.
    blank = body.blank.mirrored() if body.blank is not None and gear == 1 else body.blank
    return compliance_key(
        geometry, teeth.fe, body.poisson_ratio, teeth.width, body.inner_radius, space=space, blank=blank
    )


def _warnings(teeth: ToothPair, line: LineOfAction) -> tuple[str, ...]:
    """What is unfavourable about the teeth, or cut off their model."""
    notes = []
    if line.interference:
        notes.append(
            "a tip reaches below the involute of its mate: contact is taken to end at the form circle, which leaves a transverse "
            f"contact ratio of {line.contact_ratio:.3f} of the {teeth.pair.transverse_contact_ratio:.3f} of the tip circles"
        )
    gears = (("pinion", teeth.first, teeth.first_body), ("gear", teeth.second, teeth.second_body))
    for (name, g, body), chosen in zip(gears, teeth.bodies, strict=True):
        if chosen != "wheel":
            notes += web_left_out(name, g, body, teeth.width, f"body = '{chosen}'")
        if g.normal_tip_thickness < THIN_TIP * g.normal_module:
            notes.append(f"the teeth of the {name} are thinner than {THIN_TIP:g} normal modules at the tip")
        if not g.is_internal and g.tool_tip_radius_factor >= g.full_radius_factor * (1.0 - 1e-12):
            notes.append(f"{name}: the rack's tip is fully rounded, rho = {g.tool_tip_radius_factor:.3f} m_n")
    return tuple(notes)
