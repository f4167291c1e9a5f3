"""The model: everything a file describes, as named, frozen parts that are checked as a whole."""

from __future__ import annotations

import warnings
from collections.abc import Hashable, Mapping
from functools import cached_property
from html import escape
from typing import Any

from pydantic import BaseModel, Field, ValidationError

from rotorgear.errors import ModelError
from rotorgear.model.address import with_values
from rotorgear.model.checks.check import find_problems
from rotorgear.model.checks.repair import repaired
from rotorgear.model.layout.layout import Layout
from rotorgear.model.layout.state import State
from rotorgear.model.layout.torque_flow import torque_flow
from rotorgear.model.parts.fields import MOTIONS, Name
from rotorgear.model.parts.shaft import Shaft
from rotorgear.model.parts.tables import Tables, counted

SCHEMA_VERSION = 1


class Model(Tables):
    """A gearbox or rotor: shafts and what is on them.

    Built from Python objects or from the tables of a file (`rotorgear.load`). Construction checks everything at once.

    Raises:
        ModelError: with every problem that was found, each with address, value and what was expected.
    """

    shafts: dict[Name, Shaft] = Field(min_length=1, description="shafts")

    def __init__(self, /, **data: Any) -> None:
        try:
            BaseModel.__init__(self, **data)
        except ValidationError:
            problems, rest, broken = repaired(data)
            raise ModelError([*problems, *find_problems(Layout(rest), broken)]) from None
        problems = find_problems(self.layout)
        if problems:
            raise ModelError(problems)

    def with_(self, address: str | Mapping[str, Any], value: Any = None) -> Model:
        """Return this model with another value at an address, or with several; checked like a new one.

            model.with_("bearings.left.stiffness", "2e8 N/m")
            model.with_({"shafts.rotor.sections[0].length": "80 mm", "operation.speed": "3000 rpm"})

        Args:
            address: of a value or a table, as errors write it; "*" stands for all names or places there. Or several addresses,
                each with its value.
            value: as in a model file: a number in SI, a text with its unit, a table or a part; None takes away what is there.

        Returns:
            A new model. Nothing that was derived from this one goes along.

        Raises:
            ModelError: an address that leads nowhere, or values that don't fit, all at once.
        """
        values = {address: value} if isinstance(address, str) else address
        return Model(**with_values(self, values))

    def __repr__(self) -> str:
        return f"Model({self.title!r}: {self._counts()})"

    def _repr_html_(self) -> str:
        return f"<b>{escape(self.title) or 'Model'}</b><br>{escape(self._counts())}"

    def _counts(self) -> str:
        """How many parts of each kind there are."""
        tables = {name: getattr(self, name) for name in type(self).model_fields}
        return ", ".join(
            counted(len(value), name) for name, value in tables.items() if isinstance(value, dict) and value
        )

    @cached_property
    def layout(self) -> Layout:
        """What follows from the parts before any load."""
        return Layout(self)

    @cached_property
    def known_hash(self) -> list[tuple[tuple[object, ...], str]]:
        """The hash of a model that reads no files, once it has been asked for, behind its parts then (`model_hash.py`)."""
        return []

    @cached_property
    def states(self) -> dict[Hashable, State]:
        """The states that were asked for, by what they are about: several analyses of one state find it once."""
        return {}

    def torque_flow(self, direction: int | None = None) -> State:
        """Forces, working flanks and mesh stiffnesses of the torque flow, made once for each sense of rotation.

        Args:
            direction: +1 or -1, sense about +z in which the reference shaft turns. None: that of the operating speed.

        Raises:
            AnalysisError: a stiffness model that can't do its teeth.
            ConvergenceError: in a loop, mesh stiffness and torque split don't come to agree.
        """
        sense = direction or self.layout.direction
        if sense not in self.states:
            self.states[sense] = torque_flow(self.layout, sense)
        return self.states[sense]

    def mean_load(self, direction: int | None = None) -> State:
        """Old name of `torque_flow`."""
        warnings.warn("Model.mean_load is now Model.torque_flow", FutureWarning, stacklevel=2)
        return self.torque_flow(direction)


__all__ = ["MOTIONS", "SCHEMA_VERSION", "Model"]
