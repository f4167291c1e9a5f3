"""Results kept by the content of the arrays they were computed of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pytest

from rotorgear.elements.matrices import kept_by_content


@dataclass(frozen=True)
class Sizes:
    length: np.ndarray
    width: np.ndarray


@dataclass(frozen=True)
class Areas:
    area: np.ndarray
    unit: str


@pytest.fixture
def calls() -> list[int]:
    return []


@pytest.fixture
def areas(calls):
    @kept_by_content(rows=3, results=2)
    def computed(sizes: Sizes, *, factor: float = 1.0) -> Areas:
        calls.append(len(sizes.length))
        return Areas(factor * sizes.length * sizes.width, "m^2")

    return computed


def test_equal_arrays_are_computed_once(areas, calls):
    one = areas(Sizes(np.array([1.0, 2.0]), np.array([3.0, 4.0])))
    same = areas(Sizes(np.array([1.0, 2.0]), np.array([3.0, 4.0])))
    assert same is one
    assert len(calls) == 1
    with pytest.raises(ValueError, match="read-only"):
        one.area[0] = 0.0


@pytest.mark.parametrize(
    ("other", "options"),
    [
        (Sizes(np.array([1.0, 2.0]), np.array([3.0, 5.0])), {}),
        (Sizes(np.array([1.0, 2.0]), np.array([[3.0, 4.0]])), {}),
        (Sizes(np.array([1.0, 2.0]), np.array([3.0, 4.0]).view(np.int64)), {}),
        (Sizes(np.array([1.0, 2.0]), np.array([3.0, 4.0])), {"factor": 2.0}),
    ],
    ids=["value", "shape", "type", "option"],
)
def test_what_differs_is_computed(areas, calls, other, options):
    areas(Sizes(np.array([1.0, 2.0]), np.array([3.0, 4.0])))
    found = areas(other, **options)
    assert len(calls) == 2
    np.testing.assert_array_equal(found.area, options.get("factor", 1.0) * other.length * other.width)


def test_many_rows_are_not_kept(areas, calls):
    many = Sizes(np.ones(4), np.ones(4))
    assert areas(many) is not areas(many)
    assert len(calls) == 2
    areas(many).area[0] = 0.0
