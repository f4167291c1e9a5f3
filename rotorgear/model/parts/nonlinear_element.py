"""A general nonlinear element: a force law by its name, between two points of shafts or one point and the ground."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any, Literal

from pydantic import Field

from rotorgear.model.parts.fields import Part, Station
from rotorgear.model.parts.supports import DampingMatrix, StiffnessMatrix, TableRow
from rotorgear.quantity import QuantityError, parse_in_unit

if TYPE_CHECKING:
    from rotorgear.forces.law import ForceLaw, Parameter

ElementDof = Literal["x", "y", "z", "tilt_x", "tilt_y", "torsion"]


class NonlinearElement(Part):
    """A general nonlinear element: a force law on a shaft, against the ground or against another shaft."""

    law: str = Field(description="name of the force law, of the package or registered from Python")
    shaft: str = Field(description="name of the shaft")
    at: Station = Field(description="z of the element, or 'start' or 'end'")
    to_shaft: str | None = Field(None, description="name of a second shaft; default: the ground")
    to_at: Station | None = Field(None, description="z on the second shaft; default: that on the first")
    casing: str | None = Field(None, description="name of a casing that it stands in, in place of the ground")
    directions: tuple[ElementDof, ...] = Field(
        ("x", "y"), min_length=1, description="displacements of the shaft that the law acts on, in its order"
    )
    parameters: dict[str, Any] = Field(
        default_factory=dict,
        description="parameters of the law: numbers in SI or texts with units, as it declares them",
    )
    stiffness: StiffnessMatrix | None = Field(
        None, description="stiffness that linear analyses take; default: the tangent of the law at the equilibrium"
    )
    damping: DampingMatrix | None = Field(None, description="damping that goes with a given stiffness")
    table: tuple[TableRow, ...] = Field((), description="rows over speed, linear in between, in place of stiffness")

    @property
    def is_given(self) -> bool:
        """Whether linear analyses have a stiffness for it."""
        return self.stiffness is not None or bool(self.table)


def law_parameters(law: type[ForceLaw], given: dict[str, Any]) -> tuple[dict[str, Any], dict[str, str]]:
    """Parameters of a law in SI, and what was expected of those that make no sense, by name."""
    kinds = {item.name: str(item.type) for item in fields(law)}
    found: dict[str, Any] = {}
    wrong: dict[str, str] = {}
    for name, about in law.declared().items():
        if name not in given:
            continue
        try:
            value = _in_si(given[name], about, kinds[name])
        except QuantityError as error:
            wrong[name] = str(error)
            continue
        if about.allows(value):
            found[name] = value
        else:
            wrong[name] = about.expected + (f" ({about.unit})" if about.unit else "")
    return found, wrong


def _in_si(value: Any, about: Parameter, kind: str) -> Any:
    """A value of the file as the law's dataclass takes it."""
    if isinstance(value, list | tuple):
        return tuple(_in_si(each, about, "float") for each in value)
    if about.choices:
        return value
    if kind == "bool":
        if not isinstance(value, bool):
            raise QuantityError("true or false")
        return value
    number = parse_in_unit(value, about.unit)
    if kind != "int":
        return number
    if number != int(number):
        raise QuantityError("a whole number")
    return int(number)


def element_law(element: NonlinearElement, ratio: float) -> ForceLaw:
    """The law of an element on a shaft that turns at so many times the speed of the reference.

    A law that needs the rotation of its shaft names the parameter that holds this ratio (`shaft_ratio`); what the file gives
    for it counts more.
    """
    from rotorgear.forces.registry import law_of

    law = law_of(element.law)
    given, _ = law_parameters(law, element.parameters)
    if law.shaft_ratio and law.shaft_ratio not in given:
        given[law.shaft_ratio] = ratio
    return law(**given)
