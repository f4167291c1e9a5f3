"""One number for the stiffness or damping of a bearing: the radial one, in a file, in Python and by an address."""

from __future__ import annotations

import pytest

import rotorgear as rg
from rotorgear.model.text import changed_text, text_of
from tests.paths import ROOT

TEXT = (ROOT / "models" / "jeffcott.toml").read_text(encoding="utf-8")
ONE = TEXT.replace('stiffness = { radial = "2e7 N/m" }', 'stiffness = "2e7 N/m" # by the maker')


def test_it_is_the_radial_one_everywhere() -> None:
    assert ONE != TEXT
    model = rg.loads(ONE)
    assert model == rg.loads(TEXT)
    made = rg.Bearing(shaft="rotor", at="start", stiffness=1e8, damping="200 N s/m")
    assert (made.stiffness, made.damping) == (rg.StiffnessMatrix(radial=1e8), rg.DampingMatrix(radial=200.0))
    assert model.with_("bearings.right.stiffness", 3e7).bearings["right"].stiffness == rg.StiffnessMatrix(radial=3e7)
    for wrong in (True, [1e8], "1e8 N"):
        with pytest.raises(rg.ModelError, match="stiffness"):
            rg.Bearing(shaft="rotor", at="start", stiffness=wrong)


def test_it_stays_one_number_where_it_is_changed() -> None:
    line = 'stiffness = "3e7 N/m" # by the maker'
    assert line in changed_text(ONE, {"bearings.right.stiffness.radial": "3e7 N/m"})
    model = rg.loads(ONE)
    stiffer = model.with_("bearings.right.stiffness.radial", 3e7)
    assert line in text_of(stiffer, ".", model.source)
    # With another direction it becomes a table.
    both = model.with_("bearings.right.stiffness.axial", 1e7)
    assert rg.loads(text_of(both, ".", model.source)) == both
