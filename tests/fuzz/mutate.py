"""Mutations of model files, lists of rig lines and options that know the grammar: what a hand that slips may write."""

from __future__ import annotations

import copy
import random
import re
from collections.abc import Callable, Iterator
from typing import Any

_QUANTITY = re.compile(r"\s*([+-]?[0-9.]+(?:[eE][+-]?[0-9]+)?)\s*(.*)\Z", re.DOTALL)
_UNITS = [
    "mm",
    "m",
    "um",
    "km",
    "kg",
    "g",
    "N/m",
    "N m",
    "N m/rad",
    "rpm",
    "Hz",
    "rad/s",
    "deg",
    "GPa",
    "%",
    "furlong",
    "1/s",
    "",
]
_SCALES = [1e-300, 1e-30, 1e-12, 1e-6, 1e-3, 0.1, 0.5, 0.9, 1.1, 2.0, 10.0, 1e3, 1e6, 1e12, 1e30, 1e300]
_NAMES = [
    "",
    " ",
    "a.b",
    "ä",
    "歯車",
    "🦷",
    "\u202e",
    "x" * 5000,
    "start",
    "end",
    "default",
    "0",
    "__proto__",
    "a\nb",
    "-",
]
_ODD: list[Any] = [
    float("nan"),
    float("inf"),
    -float("inf"),
    0,
    -1,
    1,
    10**30,
    0.0,
    1e-320,
    True,
    False,
    "",
    "nan",
    [],
    {},
    [[]],
]
Path = tuple[Any, ...]


# Seeds below keep what they meant before parts were added.
_ADDED_FROM = 20_000


def model_mutations(model: dict[str, Any], seed: int) -> dict[str, Any]:
    """A copy with one to four mutations; of every second late seed they may meet a part that its model had not."""
    draw = random.Random(seed)
    mutant = copy.deepcopy(model)
    if seed >= _ADDED_FROM and seed % 2:
        _added(mutant, draw)
    for _ in range(draw.choice([1, 1, 2, 2, 3, 4])):
        draw.choice(_MUTATIONS)(mutant, draw)
    return mutant


_BEARING_LAWS: list[dict[str, Any]] = [
    {"journal": {"diameter": "60 mm", "length": "40 mm", "clearance": "60 um", "viscosity": "20 mPa s"}},
    {
        "journal": {
            "diameter": "60 mm",
            "length": "40 mm",
            "clearance": "60 um",
            "viscosity": "20 mPa s",
            "lobes": 3,
            "preload": 0.4,
        }
    },
    {
        "rolling": {
            "kind": "ball",
            "elements": 9,
            "element_diameter": "12 mm",
            "pitch_diameter": "60 mm",
            "clearance": "10 um",
        }
    },
]
_LOADS: list[dict[str, Any]] = [
    {"force": ["0 N", "-500 N", "0 N"]},
    {"force": ["100 N", "0 N", "0 N"], "order": 2},
    {"force": ["0 N", "0 N", "50 N"], "frequency": "120 Hz", "phase": "30 deg"},
    {"moment": ["5 N m", "0 N m", "0 N m"], "order": 1},
]


def _added(model: dict[str, Any], draw: random.Random) -> None:
    """A bearing with a law in place of its stiffness, or a force at a shaft."""
    shafts = model.get("shafts")
    if not isinstance(shafts, dict) or not shafts:
        return
    shaft = draw.choice(sorted(shafts))
    bearings = [name for name, part in model.get("bearings", {}).items() if isinstance(part, dict)]
    if bearings and draw.random() < 0.5:
        bearing = model["bearings"][draw.choice(bearings)]
        for key in ("stiffness", "damping", "table"):
            bearing.pop(key, None)
        bearing |= copy.deepcopy(draw.choice(_BEARING_LAWS))
    else:
        model.setdefault("loads", {})["added"] = {"shaft": shaft, "at": "start", **copy.deepcopy(draw.choice(_LOADS))}


def _leaves(node: Any, path: Path = ()) -> Iterator[tuple[Path, Any]]:
    if isinstance(node, dict) and node:
        for key, value in node.items():
            yield from _leaves(value, (*path, key))
    elif isinstance(node, list) and node:
        for number, value in enumerate(node):
            yield from _leaves(value, (*path, number))
    else:
        yield path, node


def _at(node: Any, path: Path) -> Any:
    for key in path:
        node = node[key]
    return node


def _set(model: dict[str, Any], path: Path, value: Any) -> None:
    if path:
        _at(model, path[:-1])[path[-1]] = value


def _leaf(model: dict[str, Any], draw: random.Random, wanted: Callable[[Any], bool]) -> tuple[Path, Any] | None:
    found = [(path, value) for path, value in _leaves(model) if path and wanted(value)]
    return draw.choice(found) if found else None


def _parts(model: dict[str, Any]) -> list[tuple[str, str]]:
    return [
        (table, name)
        for table, parts in model.items()
        if isinstance(parts, dict)
        for name, part in parts.items()
        if isinstance(part, dict)
    ]


def _is_quantity(value: Any) -> bool:
    if isinstance(value, str):
        return _QUANTITY.match(value) is not None
    return isinstance(value, int | float) and not isinstance(value, bool)


def _scaled(model: dict[str, Any], draw: random.Random) -> None:
    if found := _leaf(model, draw, _is_quantity):
        path, value = found
        factor = draw.choice(_SCALES) if draw.random() < 0.7 else 10.0 ** draw.uniform(-3.0, 3.0)
        factor *= draw.choice([1.0, 1.0, 1.0, -1.0])
        if isinstance(value, str):
            number, unit = _QUANTITY.match(value).groups()  # type: ignore[union-attr]
            _set(model, path, f"{float(number) * factor!r} {unit}" if number.strip(".") else value)
        else:
            _set(
                model,
                path,
                type(value)(min(max(value * factor, -1e18), 1e18)) if isinstance(value, int) else value * factor,
            )


def _odd_value(model: dict[str, Any], draw: random.Random) -> None:
    if found := _leaf(model, draw, lambda value: True):
        _set(model, found[0], copy.deepcopy(draw.choice(_ODD)))


def _other_unit(model: dict[str, Any], draw: random.Random) -> None:
    if found := _leaf(model, draw, lambda value: isinstance(value, str) and _is_quantity(value)):
        number = _QUANTITY.match(found[1]).group(1)  # type: ignore[union-attr]
        _set(model, found[0], f"{number} {draw.choice(_UNITS)}")


def _other_count(model: dict[str, Any], draw: random.Random) -> None:
    if found := _leaf(model, draw, lambda value: isinstance(value, int) and not isinstance(value, bool)):
        _set(model, found[0], draw.choice([0, 1, 2, 3, 5, -found[1], found[1] + 1, found[1] - 1, 1000, 10**6, 10**12]))


def _swapped(model: dict[str, Any], draw: random.Random) -> None:
    one, other = _leaf(model, draw, lambda value: True), _leaf(model, draw, lambda value: True)
    if one and other:
        _set(model, one[0], other[1])
        _set(model, other[0], one[1])


def _dropped_key(model: dict[str, Any], draw: random.Random) -> None:
    if found := _leaf(model, draw, lambda value: True):
        del _at(model, found[0][:-1])[found[0][-1]]


def _dropped_part(model: dict[str, Any], draw: random.Random) -> None:
    if parts := _parts(model):
        table, name = draw.choice(parts)
        del model[table][name]


def _copied_part(model: dict[str, Any], draw: random.Random) -> None:
    if parts := _parts(model):
        table, name = draw.choice(parts)
        for number in range(draw.choice([1, 1, 1, 2, 30, 200])):
            model[table][f"{name}_{number}"] = copy.deepcopy(model[table][name])


def _renamed_part(model: dict[str, Any], draw: random.Random) -> None:
    """With all that refer to it, or without."""
    if parts := _parts(model):
        table, name = draw.choice(parts)
        new = draw.choice(_NAMES)
        model[table][new] = model[table].pop(name)
        if draw.random() < 0.7:
            for path, value in list(_leaves(model)):
                if value == name:
                    _set(model, path, new)


def _other_reference(model: dict[str, Any], draw: random.Random) -> None:
    """Loops, parts on themselves, and names of nothing."""
    names = [name for _, name in _parts(model)]
    if names and (found := _leaf(model, draw, lambda value: value in names)):
        _set(model, found[0], draw.choice([*names, "nobody"]))


def _other_place(model: dict[str, Any], draw: random.Random) -> None:
    places = [path for path, _ in _leaves(model) if path and path[-1] in ("at", "from_at", "to_at", "start")]
    if places:
        _set(model, draw.choice(places), draw.choice(["start", "end", 0.0, 1e-12, -1e-12, "1e6 m", "1 um", "middle"]))


def _nested(model: dict[str, Any], draw: random.Random) -> None:
    if found := _leaf(model, draw, lambda value: True):
        value = found[1]
        for _ in range(draw.choice([1, 2, 60])):
            value = draw.choice([[value], {"a": value}])
        _set(model, found[0], value)


def _unknown_key(model: dict[str, Any], draw: random.Random) -> None:
    if parts := _parts(model):
        table, name = draw.choice(parts)
        model[table][name][draw.choice([*_NAMES, "stifness", "lenght"])] = draw.choice(_ODD)


def _massless(model: dict[str, Any], draw: random.Random) -> None:
    for path, _ in list(_leaves(model)):
        if path and path[-1] in ("mass", "polar_inertia", "diametral_inertia", "density") and draw.random() < 0.7:
            _set(model, path, 0.0)


def _other_motions(model: dict[str, Any], draw: random.Random) -> None:
    model["motions"] = draw.sample(["bending", "axial", "torsion"], draw.randint(0, 3))


def _loose(model: dict[str, Any], draw: random.Random) -> None:
    for table in ("bearings", "supports", "couplings", "loads"):
        if draw.random() < 0.5:
            model.pop(table, None)


_MUTATIONS = [
    _scaled,
    _scaled,
    _scaled,
    _scaled,
    _odd_value,
    _other_unit,
    _other_count,
    _swapped,
    _dropped_key,
    _dropped_part,
    _copied_part,
    _renamed_part,
    _other_reference,
    _other_place,
    _nested,
    _unknown_key,
    _massless,
    _other_motions,
    _loose,
]


def rig_mutations(text: str, seed: int) -> bytes:
    """A list of rig lines with one to four mutations, as bytes."""
    draw = random.Random(seed)
    for _ in range(draw.randint(1, 4)):
        lines = text.split("\n")
        k = draw.randrange(len(lines))
        kind = draw.randrange(9)
        if kind == 0:
            lines[k] = lines[k].replace(",", draw.choice([";", "\t", ",,", " ", '"', ",\x00", "|"]))
        elif kind == 1:
            text = text.replace(",", ";").replace(".", ",")
            continue
        elif kind == 2:
            lines[k] = draw.choice(['"', "'", "#"]) + lines[k]
        elif kind == 3:
            lines.insert(k, lines[k])
        elif kind == 4:
            lines[k] = re.sub(
                r"[0-9.]+",
                lambda _: draw.choice(["nan", "-5", "0", "1e300", "1e-300", "inf", "٣", ""]),
                lines[k],
                count=1,
            )
        elif kind == 5:
            lines[k] = draw.choice(["frequency", "frequency (furlong)", "label;frequency_hz", "\ufefffrequency_hz", ""])
        elif kind == 6:
            del lines[k]
        elif kind == 7:
            lines[k] *= draw.choice([2, 300])
        else:
            place = draw.randrange(max(1, len(text)))
            text = text[:place] + draw.choice(["\r", "\x00", "\u2028", "é", '"', ",", "\n"]) + text[place:]
            continue
        text = "\n".join(lines)
    encoding = draw.choice(["utf-8", "utf-8", "utf-8-sig", "utf-16", "latin-1"])
    return text.encode(encoding, errors="replace")


_SPEEDS = [
    "0",
    "-1 rpm",
    "1500 rpm",
    "1e6 rpm",
    "1e300 rpm",
    "nan rpm",
    "",
    "50 Hz",
    "1e-300 rpm",
    "rpm",
    "1,5 rpm",
    "16350",
]
_NUMBERS = [
    "0",
    "-1",
    "1",
    "2",
    "2.5",
    "1e-3",
    "1e-11",
    "1e-12",
    "0.999",
    "1",
    "1e300",
    "nan",
    "inf",
    "-inf",
    "abc",
    "",
    "1000000000",
]
_COUNTS = ["0", "-1", "1", "2", "3", "2.5", "abc", "5", "40"]
_PLACES = [
    "probe_x",
    "disks.disk",
    "disks.disk:y",
    "nobody",
    "",
    "bearings.left",
    "rotor:100mm:x",
    ":",
    "disks.disk:q",
    ",",
]
# Values of options by their name, where the kind does not tell what a hand may write.
_WORDS = {
    "only": ["bending", "torsion,axial", "", ",", "all"],
    "free": ["bearings.*.stiffness", "meshes.*.stiffness", "*", "", "shafts.*.nothing", "operation.speed"],
    "sigma": ["10 %", "0", "-1", "nan", "5", "1 mm", ""],
    "samples": ["0", "1", "3", "2.5", "abc"],
    "speeds": ["1000 rpm:2000 rpm:3", "0:0:0", "", "nan", "1 rpm:2 rpm", "1,2"],
    "directions": ["xyz", "q", "", "y"],
    "method": ["newmark", "exponential", "hht", "explicit", "modal", "direct", "", "euler"],
    "time": ["0.01 s", "1e-9 s", "1e9 s", "0 s", "-1 s", "nan s", "1 m", ""],
    "discard": ["0", "1", "1 ms", "-1", "abc", "3"],
    "over": [
        "operation.speed=1000 rpm:1500 rpm:2",
        "operation.speed=1 rpm",
        "nobody=1:2:3",
        "torque=1 N m:2 N m:2",
        "=",
        "",
    ],
    "bounds": ["bearings.*.stiffness=0.5:2", "tip_relief=0 um:20 um", "a=b", "", "x=1:2:3"],
    "variables": ["tip_relief", "crowning", "", "nobody"],
    "preset": ["preview", "fine", "", "huge"],
    "objective": ["change", "scatter", ""],
    "shapes": ["1", "1,2", "2-1", "0", "²", "999999999999", ""],
    "source": ["jeffcott", "nobody", ""],
    "name": ["left", "nobody", "", "box"],
    "analysis": ["modal", "campbell", "nobody", ""],
}
_OUTPUTS = [
    "out.json",
    "no/x.json",
    "model.toml",
    ".",
    "out.h5",
    "out.png",
    "folder",
    "old.json",
    "out.npz",
    "out.uff",
    "out.xlsx",
]
_INPUTS = ["rig.csv", "missing.csv", "model.toml", ".", "/dev/zero", "pipe", "shapes.uff"]
_WRITTEN = (
    *(
        "json",
        "save",
        "plot",
        "waterfall",
        "order_map",
        "vtk",
        "uff",
        "xlsx",
        "csv",
        "output",
        "state_space",
        "matrices",
    ),
)
# What keeps a long command short where nothing else is drawn.
_CHEAP = {
    "sweep": {"over": "operation.speed=1000 rpm:1200 rpm:2", "discard": "2", "sample": "9"},
    "orbits": {"over": "operation.speed=1000 rpm:1010 rpm", "harmonics": "4", "points": "4", "elements": "1"},
    "transient": {"time": "0.01 s", "steps": "20", "elements": "1"},
    "scatter": {"free": "bearings.*.stiffness", "sigma": "10 %", "samples": "3", "elements": "1", "modes": "4"},
    "optimise": {"free": "bearings.*.stiffness", "searches": "1", "elements": "1"},
    "campbell": {"points": "3", "modes": "4"},
    "response": {"points": "5"},
    "frf": {"inputs": "disks.disk:y", "outputs": "disks.disk:y", "fmax": "300", "points": "5"},
    "mesh": {"positions": "8", "preset": "preview"},
    "mesh-map": {"over": "torque=10 N m:20 N m:2", "positions": "8", "preset": "preview"},
    "optimise-flanks": {
        "variables": "tip_relief",
        "over": "torque=10 N m",
        "positions": "8",
        "evaluations": "3",
        "samples": "2",
        "preset": "preview",
    },
    "root-stress": {"positions": "4", "preset": "preview"},
    "accuracy": {"finest": "1", "modes": "3"},
    "update": {"rig": "rig.csv", "elements": "1"},
    "compare": {"rig": "rig.csv", "elements": "1"},
    "export": {"matrices": "out.npz", "elements": "1"},
    "import": {"output": "new.toml"},
    "report": {},
}
# A window, and hours of validation.
_LEFT_OUT = ("view", "validate")


def _values(name: str, kind: str) -> list[str]:
    """What a hand may write for an option of a name and kind."""
    from rotorgear.cli.options import SPEEDS

    if name in _WORDS:
        return _WORDS[name]
    if kind == "path":
        return _OUTPUTS if name in _WRITTEN else _INPUTS
    if kind == "paths":
        return _INPUTS
    if name in SPEEDS:
        return _SPEEDS
    if name in ("inputs", "outputs", "at", "excite", "candidates", "spectrum"):
        return _PLACES
    return {"int": _COUNTS, "float": _NUMBERS, "numbers": _NUMBERS, "wholes": _COUNTS, "flag": [""]}.get(
        kind, [*_NUMBERS, "1 mm", "nobody", "1_0", "\u202e\x1b[2J"]
    )


def option_mutations(seed: int) -> list[str]:
    """A command with options, without its model."""
    from rotorgear.cli.commands import COMMANDS
    from rotorgear.cli.options import spelling

    draw = random.Random(seed)
    command = draw.choice([one for one in COMMANDS if one.name not in _LEFT_OUT])
    positional = (command.source, *command.positional)
    known = {
        name: option
        for name, option in command.choices.items()
        if name not in (*positional, "cluster", "workers", "resume")
    }
    asked = dict(_CHEAP.get(command.name, {}))
    for name in draw.sample(sorted(known), min(len(known), draw.randint(1, 3))):
        asked[name] = draw.choice(_values(name, known[name].kind))
    written = []
    for name, value in asked.items():
        flag = (known[name].flags or (spelling(name),))[-1].partition("/")[0]
        written.append(flag if known[name].kind == "flag" else f"{flag}={value}")
    return [command.name, *written]


def byte_mutations(data: bytes, seed: int) -> bytes:
    """A file of any format with one to four places changed, cut, repeated or filled."""
    draw = random.Random(seed)
    out = bytearray(data)
    for _ in range(draw.randint(1, 4)):
        place = draw.randrange(max(1, len(out)))
        length = draw.choice([1, 1, 2, 8, 64, 512])
        match draw.randrange(8):
            case 0:
                out[place : place + 1] = bytes([draw.randrange(256)])
            case 1:
                del out[place : place + length]
            case 2:
                out[place:place] = out[place : place + length] * draw.choice([1, 2, 200])
            case 3:
                out[place : place + length] = bytes(length)
            case 4:
                del out[place:]
            case 5:
                out[place : place + 1] = draw.choice(
                    [b"-1", b"1e300", b"nan", b"999999999999", b" " * 300, "٣²".encode()]
                )
            case 6:
                digits = [k for k in range(place, min(place + 2000, len(out))) if 48 <= out[k] < 58]
                if digits:
                    k = draw.choice(digits)
                    out[k : k + 1] = draw.choice([b"0", b"9", b"99999", b"-", b"1e9"])
            case _:
                other = draw.randrange(max(1, len(out)))
                out[place : place + length], out[other : other + length] = (
                    out[other : other + length],
                    out[place : place + length],
                )
    return bytes(out)
