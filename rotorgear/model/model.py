"""The model: everything a file describes, as named, frozen parts that are checked as a whole."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel, Field, ValidationError

from rotorgear.errors import ModelError
from rotorgear.model.checks.check import find_problems
from rotorgear.model.checks.repair import repaired
from rotorgear.model.parts.fields import MOTIONS, Name
from rotorgear.model.parts.shaft import Shaft
from rotorgear.model.parts.tables import Tables

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
            raise ModelError([*problems, *find_problems(rest, broken)]) from None
        problems = find_problems(self)
        if problems:
            raise ModelError(problems)


__all__ = ["MOTIONS", "SCHEMA_VERSION", "Model"]
