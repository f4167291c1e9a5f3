"""A load inside a shaft or a coupling, as results tell it."""

from __future__ import annotations

from collections.abc import Sequence

from rotorgear.errors import AnalysisError
from rotorgear.results.schema import Record, of


class InternalLoad(Record):
    """The load that a point reads inside its shaft or coupling.

    It is the one with which the part at larger z (of a coupling, the second shaft) acts on the other one, in the frame of the
    (first) shaft: tension and a torque about +z of that part are positive.
    """

    point: str = of("point", note=" that reads the load", column="load at")
    quantity: str = of("quantity", note=": axial, torque, shear or bending", column="quantity")
    axis: str = of("axis", note=" along or about which the load acts", column="axis")
    load: float = of("load", note=" in that unit", form=".6g", column="load")
    unit: str = of("unit", note=" of the load: N or N m", column="unit")
    error: float = of(
        "error of the load",
        note=", estimated and absolute, in that unit: change with twice the elements, and rounding",
        form=".0e",
        column="error",
    )


def load_named(loads: Sequence[InternalLoad], point: str) -> InternalLoad:
    """The load of a point among some.

    Raises:
        AnalysisError: there is none.
    """
    for row in loads:
        if row.point == point:
            return row
    known = ", ".join(row.point for row in loads) or "none"
    raise AnalysisError(
        f"'{point}' is no point that reads a load: give a point of the model a quantity (there is: {known})"
    )
