"""The sound models of tests/sound as data that a test can change, and the addresses of the problems that follow."""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Callable
from typing import Any

import pytest

from rotorgear.errors import ModelError
from rotorgear.model.model import Model
from tests.paths import SOUND

_DATA = {path.stem: tomllib.loads(path.read_text(encoding="utf-8")) for path in SOUND.glob("*.toml")}


@pytest.fixture
def pair() -> dict[str, Any]:
    """Two shafts, one helical mesh."""
    return copy.deepcopy(_DATA["helical_pair"])


@pytest.fixture
def split() -> dict[str, Any]:
    """Two branches share the torque and join again; herringbone first stage."""
    return copy.deepcopy(_DATA["split_torque"])


@pytest.fixture
def everything() -> dict[str, Any]:
    """Every table and nearly every key once."""
    return copy.deepcopy(_DATA["everything"])


@pytest.fixture(params=sorted(_DATA))
def sound(request: pytest.FixtureRequest) -> dict[str, Any]:
    """Each of the sound models."""
    return copy.deepcopy(_DATA[request.param])


@pytest.fixture
def addresses() -> Callable[[dict[str, Any]], list[str]]:
    """A function from the data of a broken model to the addresses of its problems."""

    def find(data: dict[str, Any]) -> list[str]:
        with pytest.raises(ModelError) as caught:
            Model(**data)
        return [problem.address for problem in caught.value.problems]

    return find
