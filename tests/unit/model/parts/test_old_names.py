"""Former values of a model file are read, with a warning that says the new one."""

import warnings

import pytest

import rotorgear as rg
from rotorgear.model.parts.supports import NonlinearElement, element_law
from rotorgear.old_names import OldNameWarning
from tests.paths import ROOT


def test_the_shipped_models_use_no_former_name() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", OldNameWarning)
        for path in sorted((ROOT / "models").glob("*.toml")):
            rg.load(path)


def test_the_law_of_teeth_that_tilt_is_that_of_loaded_teeth() -> None:
    parameters = {
        "load": [0.0, 1e3],
        "tilt": [-1e-4, 1e-4],
        "approach": [[[0.0, 5e-6]], [[0.0, 5e-6]]],
        "moment": [[[0.0, -1.0]], [[0.0, 1.0]]],
        "stiffness": 2e8,
    }
    with pytest.warns(OldNameWarning, match="'loaded_face' is now 'loaded_teeth'"):
        element = NonlinearElement(shaft="a", at=0.0, law="loaded_face", parameters=parameters)
    law = element_law(element, 1.0)
    assert element.law == "loaded_teeth"
    assert law.components == 2
