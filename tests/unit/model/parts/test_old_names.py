"""Former keys and values of a model file are read, with a warning that says the new one."""

import warnings

import pytest

import rotorgear as rg
from rotorgear.analysis.sweep.axes import axis_of
from rotorgear.model.parts.mesh import Mesh
from rotorgear.model.parts.old_names import KEYS, VALUES
from rotorgear.model.parts.supports import NonlinearElement, element_law
from rotorgear.old_names import OldNameWarning, renamed_arguments
from tests.paths import ROOT

PAIR = ROOT / "models" / "backlash_pair.toml"


def test_the_shipped_models_use_no_former_name() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", OldNameWarning)
        for path in sorted((ROOT / "models").glob("*.toml")):
            rg.load(path)


def test_a_file_with_former_names_gives_the_same_model_and_says_the_new_ones() -> None:
    new = PAIR.read_text().replace(
        'contact_damping = "adhesive"', 'contact_damping = "adhesive"\nregularisation_depth = "1 um"'
    )
    old = new.replace('"adhesive"', '"unclamped"').replace("regularisation_depth", "damping_depth")
    assert old != new
    with pytest.warns(OldNameWarning) as caught:
        read = rg.loads(old)
    assert read == rg.loads(new)
    texts = {str(warning.message) for warning in caught}
    assert any("'damping_depth' is now 'regularisation_depth'" in text for text in texts)
    assert any("'unclamped' is now 'adhesive'" in text for text in texts)


def test_an_attribute_and_an_address_by_their_former_names_lead_to_the_new_ones() -> None:
    mesh = Mesh(pinion="a", gear="b", stiffness=1e8, regularisation_depth=2e-6)
    with pytest.warns(OldNameWarning, match="regularisation_depth"):
        assert mesh.damping_depth == 2e-6  # type: ignore[attr-defined]
    with pytest.warns(OldNameWarning, match="regularisation_depth"):
        assert axis_of("meshes.pair.damping_depth", "1 um,2 um").address == "meshes.pair.regularisation_depth"
    assert (
        axis_of("meshes.damping_depth.backlash", "1 um").address == "meshes.damping_depth.backlash"
    )  # a name, not a key


def test_a_key_under_both_names_is_refused() -> None:
    with pytest.raises(rg.ModelError, match="damping_depth"):
        Mesh(pinion="a", gear="b", stiffness=1e8, damping_depth=1e-6, regularisation_depth=2e-6)


def test_every_new_name_is_a_key_of_its_part_and_no_former_one_is() -> None:
    parts = {"Mesh": Mesh}
    for part, keys in KEYS.items():
        assert not set(keys) & set(parts[part].model_fields)
        assert set(keys.values()) | set(VALUES.get(part, {})) <= set(parts[part].model_fields)


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


def test_a_function_by_its_former_name_is_the_same_function() -> None:
    with pytest.warns(OldNameWarning, match="convergence_study"):
        assert rg.accuracy_ladder is rg.convergence_study  # type: ignore[attr-defined]


def test_a_former_argument_is_passed_on_by_its_new_name() -> None:
    @renamed_arguments(old="new")
    def function(new: int = 0) -> int:
        return new

    with pytest.warns(OldNameWarning, match="'old' is now 'new'"):
        assert function(old=3) == 3  # type: ignore[call-arg]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert function(new=4) == 4
    with pytest.raises(TypeError):
        function(old=3, new=4)  # type: ignore[call-arg]
