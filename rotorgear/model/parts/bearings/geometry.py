"""What every kind of bearing answers that is given by its geometry.

A kind is a class of this base and a field of `Bearing` (model/parts/supports.py), whose name is its key in the file. All else
asks the bearing for its geometry, and that for what it needs, so that nothing else has to know which kinds there are. What the
kinds with an oil film share stands here as well: the oil, its checks, and that a film stands alone in its bearing.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Literal

from pydantic import Field

from rotorgear.errors import Problem
from rotorgear.model.parts.fields import Density, Part, Ratio, SpecificHeat, Temperature, Viscosity
from rotorgear.model.parts.problems import told
from rotorgear.quantity import ZERO_CELSIUS

if TYPE_CHECKING:
    from rotorgear.forces.law import ForceLaw

# Key, value by which it is judged, usual range; value as it is printed, range as it is printed with its limits in the place of
# {0} and {1}; the likely slip of a unit, or those below and above.
Judged = tuple[str, float, tuple[float, float], str, str, str | tuple[str, str]]
# What is asked of a value that may be wrong in more ways.
UNIT = "is its unit right?"


def arc_row(key: str, count: int, arc: float | None, what: str) -> tuple[Any, ...]:
    """A row of `told`: arcs that fit around a bearing."""
    wide = arc is not None and not 0.0 < count * arc <= 2.0 * math.pi * (1.0 + 1e-9)
    return key, wide, f"{count} of {math.degrees(arc or 0.0):.6g} deg", f"{what} that fit on 360 deg"


class BearingGeometry(Part):
    """Base of the kinds.

    Attributes:
        noun: what a sentence calls it.
        ring: key of the diameter that surrounds the shaft. fits: usual ones, over the least and the largest of the shaft.
        fastest: speed of the shaft in it that nothing exceeds, m/s on half that diameter. runs: a clause on that, of its name.
    """

    noun: ClassVar[str]
    ring: ClassVar[str]
    fits: ClassVar[tuple[float, float]]
    fastest: ClassVar[float]
    runs: ClassVar[str]

    @abstractmethod
    def law(self, ratio: float, sense: float, linear: Sequence[float]) -> ForceLaw:
        """Its force law.

        Args:
            ratio: turns of its shaft for each turn of the reference.
            sense: of rotation of the reference for which it is built, 1 or -1: that of pivots and least gaps.
            linear: stiffness given beside it, (6,) in N/m and N m/rad; 0 where none is.
        """

    @abstractmethod
    def problems(self, here: str, beside: Mapping[str, Any]) -> Iterator[Problem]:
        """What of its numbers does not go together.

        Args:
            here: its address. beside: what else the bearing is given by, by its keys.
        """

    @abstractmethod
    def judged(self) -> Iterator[Judged]:
        """Its numbers that physics makes unlikely beyond some range."""

    @property
    def surrounds(self) -> float:
        """Diameter that surrounds the shaft, in m."""
        return float(getattr(self, self.ring))

    @property
    def play(self) -> float | None:
        """Whole play of the shaft along a diameter in m; None where nothing is known of it."""
        return None

    @property
    def takes(self) -> tuple[str, ...]:
        """Pushes of the shaft along its axis that it takes: of "+z" and "-z"; none of a bearing that holds across only."""
        return ()

    @property
    def estimate(self) -> tuple[str, str, str]:
        """What of it is an estimate, why, and the size; texts that are empty where nothing is."""
        return "", "", ""


# Grades of ISO 3448 below and from 100 mm^2/s on.
_THIN = Literal["VG 10", "VG 15", "VG 22", "VG 32", "VG 46", "VG 68"]
_THICK = Literal["VG 100", "VG 150", "VG 220", "VG 320", "VG 460", "VG 680", "VG 1000"]


class Oil(BearingGeometry):
    """The oil of a film: its viscosity, or its grade and the temperature at which it flows in."""

    others: ClassVar[str]  # a clause on what holds the shaft where the film does not
    fastest: ClassVar[float] = 400.0
    runs: ClassVar[str] = "which in bearing '{}' runs"

    viscosity: Viscosity | None = Field(
        None, description="dynamic viscosity of the oil in the film, whatever its temperature; or give the oil"
    )
    oil: Literal[_THIN, _THICK] | None = Field(
        None,
        description="grade of ISO 3448 of a mineral oil, in place of the viscosity: the film has that of its temperature in heat "
        "balance",
    )
    inlet_temperature: Temperature | None = Field(None, description="temperature at which the oil flows in")
    heat_share: Ratio = Field(
        1.0,
        description="share of the film's power loss that the oil carries away; 0: the film stays at the inlet temperature",
    )
    specific_heat: SpecificHeat = Field(1900.0, description="specific heat of the oil")
    density: Density = Field(
        870.0, description="density of the oil, for the limit of laminar flow and the heat balance"
    )

    @property
    def heats(self) -> bool:
        """Whether the viscosity follows from the heat balance of the film."""
        return self.oil is not None and self.heat_share > 0.0

    @property
    def follows(self) -> bool:
        """Whether the oil flows in where the gap is widest."""
        return False

    @property
    def settles(self) -> bool:
        """Whether something of the film follows from the equilibrium that it is in."""
        return self.heats or self.follows

    @property
    def grade(self) -> float:
        """Kinematic viscosity at 40 deg C in m^2/s; 0 where the viscosity is given."""
        return 1e-6 * float(self.oil.removeprefix("VG ")) if self.oil else 0.0

    def oil_parameters(self) -> dict[str, Any]:
        """Parameters of a law of its film, which begins at the temperature of the inlet."""
        from rotorgear.forces.oil_film import oil_viscosity

        given = {key: getattr(self, key) for key in ("density", "specific_heat", "heat_share")}
        if self.viscosity is not None:
            return given | {"viscosity": self.viscosity}
        assert self.inlet_temperature is not None
        viscosity = oil_viscosity(self.grade, self.density, self.inlet_temperature)
        return given | {"viscosity": viscosity, "grade": self.grade, "inlet_temperature": self.inlet_temperature}

    def problems(self, here: str, beside: Mapping[str, Any]) -> Iterator[Problem]:
        """A film alone in its bearing; a viscosity, or a grade with the temperature at which the oil flows in."""
        other = "a table" if next(iter(beside), "") == "table" else next(iter(beside), "")
        neither = self.viscosity is None and self.oil is None
        heat = self.inlet_temperature is not None or self.heat_share != 1.0
        key = "inlet_temperature" if self.inlet_temperature is not None else "heat_share"
        instead = "an oil such as 'VG 46' in place of the viscosity"
        cold = self.oil is not None and self.inlet_temperature is None
        yield from told(
            here,
            ("", beside, f"{self.noun} beside {other}", f"{self.noun} alone; {self.others}"),
            ("viscosity", self.viscosity is not None and self.oil is not None, "viscosity and oil", "one of the two"),
            ("viscosity", self.viscosity == 0.0 and self.oil is None, "0", "a viscosity above 0 such as '0.02 Pa s'"),
            ("", neither, "neither viscosity nor oil", "a viscosity such as '0.02 Pa s', or an oil such as 'VG 46'"),
            ("inlet_temperature", cold, "no temperature beside the oil", "a temperature such as '45 degC'"),
            (key, self.oil is None and heat, "heat of a film of given viscosity", instead),
            ("heat_share", self.heat_share > 1.0, f"{self.heat_share:g}", "a share from 0 to 1"),
        )

    def judged(self) -> Iterator[Judged]:
        """Gap, viscosity, temperature and density."""
        clearance: float = self.clearance  # type: ignore[attr-defined]  # each kind has one, in words of its own
        share = clearance / (0.5 * self.surrounds)
        got = f"{clearance:.4g} m, {share:.2g} of the radius"
        yield "clearance", share, (1e-4, 0.02), got, "{:g} to {:g}", (UNIT, "um meant?")
        if self.viscosity is not None:
            got = f"{self.viscosity:.4g} Pa s"
            yield "viscosity", self.viscosity, (5e-5, 3.0), got, "{:g} to {:g} Pa s", (UNIT, "mPa s (cP) meant?")
        if self.inlet_temperature is not None:
            celsius = self.inlet_temperature - ZERO_CELSIUS
            slips = ("degC meant, not K?", UNIT)
            yield "inlet_temperature", celsius, (-40.0, 150.0), f"{celsius:.4g} degC", "{:g} to {:g} degC", slips
        got = f"{self.density:.4g} kg/m^3"
        yield "density", self.density, (500.0, 2000.0), got, "{:g} to {:g} kg/m^3", ("g/cm^3 meant?", UNIT)
