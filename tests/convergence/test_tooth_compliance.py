"""A loaded tooth's own compliance against a mesh that carries the Hertz strip itself."""

from __future__ import annotations

import pytest

from validation.benchmarks.tooth_compliance import GEARS, errors


# The first of the gears here, the others with the long tests: each takes seconds for its three presets.
@pytest.mark.parametrize(
    "title", [pytest.param(title, marks=[pytest.mark.long] if number else []) for number, title in enumerate(GEARS)]
)
def test_the_presets_keep_their_errors(title: str) -> None:
    found = {name: error for name, (error, _) in errors(GEARS[title]).items()}
    assert found["preview"] < 2e-2
    assert found["default"] < 3e-3
    assert found["fine"] < 2e-3
