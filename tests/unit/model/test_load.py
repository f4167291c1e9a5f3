"""Reading a model file: what is read, what is refused, and that nothing but a ModelError ever comes out."""

from __future__ import annotations

import copy
import math
from pathlib import Path
from typing import Any

import jsonschema
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from rotorgear.errors import ModelError
from rotorgear.model.load import load, loads
from rotorgear.model.load import schema as json_schema
from rotorgear.model.model import Model
from tests import paths

SOUND = sorted(paths.SOUND.glob("*.toml"))
TEXTS = [path.read_text(encoding="utf-8") for path in SOUND]


@pytest.mark.parametrize("path", SOUND, ids=lambda path: path.stem)
def test_the_sound_models_are_read(path: Path) -> None:
    assert load(path) == loads(path.read_text(encoding="utf-8")) == load(str(path))


def test_quantities_arrive_in_si_and_radians() -> None:
    model = loads(TEXTS[[path.stem for path in SOUND].index("helical_pair")])
    assert model.operation is not None
    assert model.operation.speed == pytest.approx(50 * math.pi)
    assert model.gears["pinion"].normal_module == pytest.approx(0.002)
    assert model.gears["pinion"].helix_angle == pytest.approx(math.radians(20))
    assert model.gears["pinion"].normal_pressure_angle == math.radians(20)
    assert model.shafts["output"].position == pytest.approx((0.102162, 0.0))


def test_a_byte_order_mark_and_windows_line_ends_are_no_mistake(tmp_path: Path) -> None:
    file = tmp_path / "windows.toml"
    file.write_bytes(b"\xef\xbb\xbf" + TEXTS[0].replace("\n", "\r\n").encode())
    assert load(file) == loads(TEXTS[0])


def test_a_model_written_out_is_read_back_the_same(sound: dict[str, Any]) -> None:
    model = Model(**sound)
    assert Model(**model.model_dump()) == model
    assert Model(**model.model_dump(exclude_defaults=True)) == model


def test_the_source_stands_at_the_head_of_the_report() -> None:
    with pytest.raises(ModelError, match=r"^gearbox\.toml: 1 problem\n  shafts: missing"):
        loads("", "gearbox.toml")


@pytest.mark.parametrize(
    "text",
    [
        "a" + ".a" * 4000 + " = 1",
        "a = " + "[" * 5000,
        "x = " + "{a=" * 3000,
        "shafts" + ".a" * 3000 + " = 1",
        "title = " + "[" * 90 + "]" * 90,
        "gears.p.teeth = 0x" + "f" * 100_000,
        "gears.p.teeth = " + "9" * 5000,
        "shafts.a.sections = [{length = 0x" + "f" * 10_000 + "}]",
        "\0",
        '"\\u0000\\n" = 1',
        '[shafts."\\n"]',
        'title = "\\u0007"\n[shafts.a]\nmaterial = "x\\ny"',
        "[[shafts]]",
        "shafts = []",
        "shafts = 2020-01-01",
        "[self]\n[data]\n[__class__]",
    ],
    ids=lambda text: text[:20].encode("unicode_escape").decode(),
)
def test_hostile_texts_give_a_model_error_of_short_lines(text: str) -> None:
    with pytest.raises(ModelError) as caught:
        loads(text)
    lines = str(caught.value).splitlines()
    assert len(lines) == 1 + len(caught.value.problems)
    assert max(map(len, lines)) < 600


def refusal(data: dict[str, Any] | str) -> ModelError | None:
    """What the loader says of a text or of the tables of one; anything but a ModelError fails the test."""
    try:
        loads(data) if isinstance(data, str) else Model(**data)
    except ModelError as error:
        return error
    return None


@given(st.sampled_from(TEXTS), st.data())
@settings(max_examples=150, deadline=None, suppress_health_check=list(HealthCheck))
def test_no_damage_to_the_text_gives_anything_but_a_model_error(text: str, data: st.DataObject) -> None:
    for _ in range(data.draw(st.integers(1, 3))):
        start = data.draw(st.integers(0, len(text)))
        end = data.draw(st.integers(start, min(start + 20, len(text))))
        new = st.one_of(
            st.text(max_size=3),
            st.sampled_from(['"', "[", "]", "{", "}", "=", ".", "nan", "-inf", "1e999", "[shafts]\n"]),
        )
        text = text[:start] + data.draw(new) + text[end:]
    error = refusal(text)
    assert error is None or len(str(error).splitlines()) == 1 + len(error.problems) > 1


STRANGE: list[Any] = [
    True,
    0,
    -1,
    3,
    10**400,
    1e308,
    1e-320,
    1e30,
    math.nan,
    math.inf,
    "",
    "x",
    "20 mm",
    "-20 mm",
    "20 deg",
    "90 deg",
    "1e29 mm",
    "start",
    "input",
    "a.b",
    "\0\n",
    [],
    {},
    [1, 2],
    [[1]],
    {"a": 1},
    {"x": {"y": 3}},
    ["x", "x"],
    7,
    50.0,
]


def places(data: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Paths to all that the data holds."""
    below = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    return [found for key, value in below for found in ((*path, key), *places(value, (*path, key)))]


def test_no_value_in_any_place_gives_anything_but_a_model_error(sound: dict[str, Any]) -> None:
    """Every place of every sound model is emptied, and gets one of the strange values in turn."""
    for number, path in enumerate(places(sound)):
        for strange in (None, *STRANGE[number % 12 :: 12]):
            data = copy.deepcopy(sound)
            owner = data
            for key in path[:-1]:
                owner = owner[key]
            if strange is None:
                del owner[path[-1]]
            else:
                owner[path[-1]] = copy.deepcopy(strange)
            error = refusal(data)
            assert error is None or error.problems, path


@pytest.fixture(scope="module")
def validator() -> jsonschema.Draft202012Validator:
    """By the schema of the model file, which is checked against its own once: that takes a second."""
    schema = json_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def test_the_json_schema_accepts_the_sound_models(
    sound: dict[str, Any], validator: jsonschema.Draft202012Validator
) -> None:
    validator.validate(sound)


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("colour",), "red"),
        (("gears", "pinion", "helix_angel"), "20 deg"),
        (("shafts", "input", "sections", 0, "lenght"), "20 mm"),
        (("bearings", "input_left", "stiffness", "radail"), 1e8),
        (("gears", "pinion", "teeth"), 24.5),
        (("gears", "pinion", "kind"), "hypoid"),
        (("gears", "pinion", "width"), -0.02),
        (("shafts", "input", "sections", 0, "length"), 0),
        (("shafts", "input", "position"), ["0 mm"]),
        (("meshes", "stage", "stiffness"), "stiff"),
        (("operation", "speed"), True),
        (("schema_version",), 2),
        (("shafts",), {}),
    ],
)
def test_the_json_schema_refuses_unknown_keys_and_wrong_values(
    pair: dict[str, Any], path: tuple[Any, ...], value: Any, validator: jsonschema.Draft202012Validator
) -> None:
    owner: Any = pair
    for key in path[:-1]:
        owner = owner[key]
    owner[path[-1]] = value
    with pytest.raises(jsonschema.ValidationError):
        validator.validate(pair)
    with pytest.raises(ModelError):
        Model(**pair)


def test_the_json_schema_asks_for_shafts_and_says_what_every_key_means() -> None:
    schema = json_schema()
    assert "shafts" in schema["required"]
    tables = [schema, *schema["$defs"].values()]
    unexplained = [
        key for table in tables for key, value in table.get("properties", {}).items() if not value.get("description")
    ]
    assert unexplained == []
