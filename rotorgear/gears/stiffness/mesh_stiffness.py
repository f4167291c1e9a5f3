"""Mesh stiffness over one mesh period: what every stiffness model takes and what it answers.

A stiffness model is a function of a `ToothPair` and a load. It answers with a `MeshStiffness`: k = F_bt / delta in the
transverse plane, along the line of action, where F_bt is the force at the base circle and delta the approach of the teeth.
Along the flank normal, as the rotor model has it, k_n = k / cos^2 b_b, because F_n = F_bt / cos b_b and
delta_n = delta cos b_b.

A position u counts mesh periods from where a tooth pair touches at the pitch point in the middle of the face, positive in
the sense of approach of the pinion to recess: pair j stands at xi = (u + j) p_bt + z tan b_b from the pitch point.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from rotorgear.gears.geometry.blank import BlankShape
from rotorgear.gears.geometry.flank import FlankModification
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.pair import PairGeometry
from rotorgear.gears.stiffness.cycle_curve import CycleCurve
from rotorgear.gears.tooth_fe.settings import Body, ToothFe

Definition = Literal["secant", "tangent"]
# Positions nearer to each other than this, in mesh periods, are one.
_SAME = 1e-9
_EXACT = FlankModification()
_DEFAULT_FE = ToothFe()


@dataclass(frozen=True)
class ToothBody:
    """Material and blank that carry a gear's teeth.

    Attributes:
        youngs_modulus (Pa), poisson_ratio: of the teeth.
        inner_radius: radius (m) of the bore, or inside of the rim; of a ring with its teeth inside that of its outer surface,
            0 where that is not known.
        web_share: thickness of the web over the face width of a helix; 1 for a solid disk.
        rim_thickness: of the rim below the root circle (m); None for a solid disk.
        blank: its sizes (m), for the body "wheel"; None where they are not known.
    """

    youngs_modulus: float = 206e9
    poisson_ratio: float = 0.3
    inner_radius: float = 0.0
    web_share: float = 1.0
    rim_thickness: float | None = None
    blank: BlankShape | None = None


@dataclass(frozen=True)
class ToothPair:
    """One helix of a mesh: all that a stiffness model needs to know.

    Attributes:
        first: the pinion, as the file calls it.
        second: the gear, as the file calls it.
        pair: their geometry at the centre distance.
        width: common face width (m) of one helix.
        first_body: what the pinion's teeth stand on.
        second_body: what the gear's teeth stand on.
        first_flank: deviations of the pinion's flank; only the loaded contact takes them in.
        second_flank: deviations of the gear's flank; only the loaded contact takes them in.
        misalignment: of the flanks over the whole face (m), positive where they stand apart at larger z; only for the loaded
            contact.
        fe: settings of the finite-element model; only for the loaded contact.
        tilts: whether the flanks may tilt, so that the loaded contact looks along the face even where nothing varies there yet.
    """

    first: GearGeometry
    second: GearGeometry
    pair: PairGeometry
    width: float
    first_body: ToothBody = ToothBody()
    second_body: ToothBody = ToothBody()
    first_flank: FlankModification = _EXACT
    second_flank: FlankModification = _EXACT
    misalignment: float = 0.0
    fe: ToothFe = _DEFAULT_FE
    tilts: bool = False

    @property
    def bodies(self) -> tuple[Body, Body]:
        """What the teeth of both stand on.

        Raises:
            AnalysisError: a ring that is to be held at its outer surface, which is not known.
        """
        outer = self.second_body.inner_radius if self.second.is_internal else None
        return self.fe.body_of(self.first_body.blank), self.fe.body_of(self.second_body.blank, outer)

    @property
    def on_wheel(self) -> bool:
        """Whether a gear of the pair stands on a blank of rim, web and hub."""
        return "wheel" in self.bodies


@dataclass(frozen=True)
class MeshStiffness:
    """Stiffness over one mesh period, in the transverse plane along the line of action.

    Attributes:
        model: name of the stiffness model, as in the model file.
        position: shares u of the mesh period, rising from 0, shape (n,); evenly spaced where there is no `event`.
        transverse: F_bt / delta in N/m, shape (n,).
        definition: "secant" (force over approach) or "tangent" (its derivative at the load).
        helices: how many helices it stands for, 1 or 2.
        load: F_bt in N of all these helices; None where the model does not depend on it and none was given.
        body: what the teeth stand on, and against what the approach is measured.
        base_helix_angle: b_b (rad), for the stiffness along the flank normal.
        warnings: sentences.
        tangent: dF_bt / d delta in N/m at the load, shape (n,), of a model whose stiffness depends on it; else None.
        event: (n,) whether the curves have a kink there, of positions that are not even; else None.
    """

    model: str
    position: np.ndarray
    transverse: np.ndarray
    definition: Definition
    load: float | None
    body: str
    base_helix_angle: float
    helices: int = 1
    warnings: tuple[str, ...] = ()
    tangent: np.ndarray | None = None
    event: np.ndarray | None = None

    def over_period(self, values: np.ndarray) -> float:
        """Mean of values (n,) at the positions over the mesh period."""
        if self.event is None:
            return float(np.mean(values))
        curve = self._curve(values)
        return float((curve.mean_of_steps() if self.definition == "tangent" else curve.mean())[0])

    def evenly(self, count: int) -> np.ndarray:
        """Transverse stiffness (count,) in N/m at even positions from 0."""
        return self._at(np.arange(count) / count, self.transverse)

    def _at(self, u: np.ndarray, values: np.ndarray) -> np.ndarray:
        """Values (n,) at the positions, read at any others (m,)."""
        if self.event is None:
            return np.interp(u, self.position, values, period=1.0)
        return np.asarray(self._curve(values).at(u)[:, 0])

    def _curve(self, values: np.ndarray) -> CycleCurve:
        assert self.event is not None
        return CycleCurve(self.position, values[:, None], 1.0, self.event)

    @property
    def mean(self) -> float:
        """Mean of the transverse stiffness in N/m."""
        return self.over_period(self.transverse)

    @property
    def mean_normal(self) -> float:
        """Mean of the stiffness along the flank normal in N/m: what the rotor model takes."""
        return self.mean / math.cos(self.base_helix_angle) ** 2

    @property
    def static_normal(self) -> float:
        """Stiffness along the flank normal in N/m that gives the mean deflection of the period under the mean load."""
        if self.tangent is None:
            return self.mean_normal
        # At a constant load the deflections F / k are averaged, not the stiffnesses.
        return 1.0 / (self.over_period(1.0 / self.transverse) * math.cos(self.base_helix_angle) ** 2)

    @property
    def about_load(self) -> MeshStiffness:
        """The curve that small motions about the load meet: the tangent one where there is one."""
        return self if self.tangent is None else replace(self, transverse=self.tangent, definition="tangent")

    @property
    def peak_to_peak(self) -> float:
        """Largest less smallest transverse stiffness in N/m."""
        return float(np.ptp(self.transverse))

    def of_both_helices(self, stagger: float = 0.0, second: MeshStiffness | None = None) -> MeshStiffness:
        """Two such helices in parallel, the second one ahead by `stagger` of a mesh period (0 or 0.5 as a rule).

        Values between the positions are interpolated where the stagger is no multiple of their spacing. Helices whose
        stiffness depends on the load share it evenly (the pinion floats), so their approaches are averaged.
        """
        other = self if second is None else second
        load = None if self.load is None else 2.0 * self.load
        position = self.position
        event = self.event
        if self.event is not None and other.event is not None:
            # Both have kinks of their own.
            added = np.mod(other.position - stagger, 1.0)
            position = np.concatenate([self.position, np.where(added > 1.0 - _SAME, 0.0, added)])
            order = np.argsort(position, kind="stable")
            order = order[np.diff(position[order], prepend=-1.0) > _SAME]
            position = position[order]
            event = np.concatenate([self.event, other.event])[order]

        theirs = position + stagger

        # Stiffness that does not depend on the load: two springs in parallel.
        if self.tangent is None or other.tangent is None:
            both = self._at(position, self.transverse) + other._at(theirs, other.transverse)
            return replace(self, transverse=both, helices=2 * self.helices, load=load)
        # Curves at a load: the floating pinion gives each helix half of it, so the approaches are averaged,
        # (F_1 + F_2) / mean(delta) = 4 / (1/k_1 + 1/k_2).
        secant = 4.0 / (self._at(position, 1.0 / self.transverse) + other._at(theirs, 1.0 / other.transverse))
        tangent = 4.0 / (self._at(position, 1.0 / self.tangent) + other._at(theirs, 1.0 / other.tangent))
        return replace(
            self,
            position=position,
            event=event,
            transverse=secant,
            tangent=tangent,
            helices=2 * self.helices,
            load=load,
            warnings=tuple(dict.fromkeys(self.warnings + other.warnings)),
        )


def given_stiffness(
    values: Sequence[float], base_helix_angle: float, helices: int, load: float | None, positions: int
) -> MeshStiffness:
    """A given stiffness as a curve of the whole mesh.

    Args:
        values: N/m along the flank normal, of all helices together, evenly spaced over the period; one is constant over it.
        base_helix_angle: b_b (rad).
        helices: 1 or 2.
        load: F_bt (N) of all helices, where one is known; the values don't depend on it.
        positions: how many positions to give a single value at; several values keep their own.
    """
    normal = np.full(positions, values[0]) if len(values) == 1 else np.asarray(values, float)
    return MeshStiffness(
        model="given",
        position=np.arange(len(normal)) / len(normal),
        transverse=normal * math.cos(base_helix_angle) ** 2,
        definition="tangent",
        helices=helices,
        load=load,
        body="not known, since the stiffness is given",
        base_helix_angle=base_helix_angle,
    )
