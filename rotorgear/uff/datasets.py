"""What a universal file holds, in SI: units, nodes, trace lines, shapes and functions.

Source of all layouts: Structural Dynamics Research Laboratory, University of Cincinnati, "Universal File Formats".
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

# Directions of a degree of freedom by their number; a minus sign turns them.
AXES = ("x", "y", "z", "rx", "ry", "rz")
# Specific data types of datasets 55 and 58.
DISPLACEMENT = 8
REACTION = 9
VELOCITY = 11
ACCELERATION = 12
FORCE = 13
FREQUENCY = 18
RPM = 19
ORDER = 20
# "Unknown" and "general".
SAYS_NOTHING = (0, 1)
MOTIONS = {"displacement": DISPLACEMENT, "velocity": VELOCITY, "acceleration": ACCELERATION}
# Powers of i w between a displacement and them.
DERIVATIVES = {DISPLACEMENT: 0, VELOCITY: 1, ACCELERATION: 2}
# Function types of dataset 58.
FREQUENCY_RESPONSE = 4
ORDER_FUNCTION = 27


@dataclass(frozen=True)
class Units:
    """Dataset 164: a value in SI is the value of the file divided by these."""

    length: float = 1.0
    force: float = 1.0
    description: str = "SI: Meter (newton)"
    code: int = 1


@dataclass(frozen=True)
class Nodes:
    """Datasets 15 and 2411: numbers (n,), positions in m (n, 3), coordinate systems of displacements (n,), 0 is global."""

    numbers: NDArray[np.intp]
    positions: NDArray[np.float64]
    systems: NDArray[np.intp]
    colours: NDArray[np.intp]


@dataclass(frozen=True)
class TraceLine:
    """Dataset 82: a line drawn from node to node; 0 lifts the pen."""

    number: int
    name: str
    nodes: NDArray[np.intp]


@dataclass(frozen=True)
class Shape:
    """Dataset 55: a mode shape.

    Attributes:
        frequency_hz: natural frequency |s| / 2 pi.
        damping_ratio: of critical.
        eigenvalue: s of a complex mode in rad/s; None of a normal mode.
        nodes: numbers (n,).
        values: displacements x y z, and rx ry rz where there are six, (n, 3) or (n, 6), complex for complex modes.
        names: the five lines of text.
        mode: number of the mode.
        data_type: displacement, velocity or acceleration.
    """

    frequency_hz: float
    damping_ratio: float
    eigenvalue: complex | None
    nodes: NDArray[np.intp]
    values: NDArray[np.complex128] | NDArray[np.float64]
    names: tuple[str, ...] = ()
    mode: int = 1
    data_type: int = DISPLACEMENT


@dataclass(frozen=True)
class Function:
    """Dataset 58 or 58b: a function of frequency, speed or time between two degrees of freedom.

    Attributes:
        kind: function type, such as 4 for a frequency response and 27 for an order function.
        response, reference: node and signed direction, 1 to 6; 0 for none.
        x: abscissa (n,) in Hz, rpm, s or as it is.
        values: ordinates (n,), real or complex.
        x_type, numerator, denominator: specific data types.
        z: value on the third axis, such as the number of an order.
        names: the five lines of text.
        z_type: specific data type of the third axis.
    """

    kind: int
    response: tuple[int, int]
    reference: tuple[int, int]
    x: NDArray[np.float64]
    values: NDArray[np.complex128] | NDArray[np.float64]
    x_type: int = FREQUENCY
    numerator: int = DISPLACEMENT
    denominator: int = 0
    z: float = 0.0
    names: tuple[str, ...] = ()
    z_type: int = 0


@dataclass(frozen=True)
class UniversalFile:
    """All that was read, in SI; `others` counts datasets that are none of these, `notes` says what had to be guessed."""

    units: Units
    nodes: Nodes | None
    lines: tuple[TraceLine, ...]
    shapes: tuple[Shape, ...]
    functions: tuple[Function, ...]
    others: dict[int, int]
    notes: tuple[str, ...] = ()

    @property
    def kinds(self) -> str:
        """The datasets in it, in words."""
        counted = {15: int(self.nodes is not None), 82: len(self.lines), 55: len(self.shapes), 58: len(self.functions)}
        found = [str(number) for number, count in sorted((counted | self.others).items()) if count]
        return ", ".join(found) or "none"
