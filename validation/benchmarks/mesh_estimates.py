"""Errors of `rotorgear mesh` beside its estimates: python -m validation.benchmarks.mesh_estimates [TABLES] [PAIRS]

positions: ten pairs, spur and helical, asked for 8 to 1024 positions in a mesh period. Errors are those against 2048 positions on
the same elements; estimates are those of the sampling alone, in space with those of the slices: wherever a contact line gets
another number of slices the curves make a small step, which lies between positions too.
presets: helical pairs and an overload by the presets default and fine, with 64 positions. Errors are those against layers of 0.3
modules, with what a profile of twice as many elements changes on thick layers; estimates are what
`rotorgear mesh` prints: elements, slices and positions together. It takes half an hour of CPU time and 3.1 GB.
separable: what a finer profile changes on layers of several thicknesses, and what layers change, for one helical pair.
wheels: pairs with the web wheel of `models/web_wheel.toml` and lighter ones, likewise, against a finer mesh of teeth and blank.
Without a word: all four. Names of pairs after it take these alone.
"""

from __future__ import annotations

import math
import sys
import time
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import rotorgear as rg
from rotorgear.analysis.teeth.errors import ORDERS, error_parts
from rotorgear.analysis.teeth.request import MeshRequest, SolvedHelices, curves_at, mesh_request, solve_helices
from rotorgear.gears.loaded.tooth_contact import in_space
from rotorgear.gears.stiffness.cycle_curve import CycleCurve
from rotorgear.gears.stiffness.mesh_stiffness import ToothPair
from rotorgear.gears.tooth_fe.points import MeshSize
from rotorgear.gears.tooth_fe.settings import ToothFe, sized
from rotorgear.results.mesh import MeshErrors
from tests.paths import ROOT

ASKED = (8, 12, 16, 24, 32, 48, 64, 128, 256, 512, 1024)
REFERENCE_POSITIONS = 2048
# A coarse mesh in space does for what lies between positions.
COARSE = (MeshSize(5, 2, 4, 2, 3), 3.6)
# The reference of the presets: layers as thin as this in normal modules on the profile of the default preset, and what a finer
# profile changes on thick ones. Its error falls like (1/rows)^p, so that 1/((16/8)^p - 1) of that change is still left.
DEFAULT_PROFILE = MeshSize(8, 3, 6, 3, 4)
FINE_PROFILE = MeshSize(16, 4, 8, 3, 7)
PROFILE_ORDER = 1.75
THIN = 0.3
THICK = 1.8
# Layers that show how far both directions are apart, and the finer profile on them.
LAYERS = (1.8, 1.08, 0.77)
BETTER_PROFILE = MeshSize(12, 4, 7, 3, 4)
# Elements of the section that are doubled twice: rows on the involute, rows below the teeth.
DOUBLED = {
    "rows on the involute": [MeshSize(rows, 3, 6, 3, 4) for rows in (6, 12, 24)],
    "rows of the rim": [MeshSize(8, 3, 6, 3, rows) for rows in (3, 6, 12)],
}
POSITIONS = 64
# The reference of wheels: rows, columns and polynomials.
FINEST_WHEEL = MeshSize(20, 5, 14, 5, 10, 12)


@dataclass(frozen=True)
class Pair:
    """Teeth, helix angle (deg), module and face (mm), torque (N m) on the pinion, and what the file says besides."""

    teeth: tuple[int, int]
    helix: float
    module: float
    width: float
    torque: float
    alpha: float = 20.0
    shift: tuple[float, float] = (0.0, 0.0)
    addendum: float = 1.0
    flank: tuple[dict[str, Any], dict[str, Any]] = ({}, {})
    misalignment: str = "0 um"

    def request(self) -> MeshRequest:
        """The mesh of a model of this pair on two points."""
        beta = math.radians(self.helix)
        transverse = math.atan(math.tan(math.radians(self.alpha)) / math.cos(beta))
        total = sum(self.teeth)
        # Without backlash: inv a_w = inv a + 2 (x1 + x2) tan a_n / (z1 + z2), by Newton's method.
        wanted = math.tan(transverse) - transverse + 2.0 * sum(self.shift) * math.tan(math.radians(self.alpha)) / total
        working = transverse
        for _ in range(50):
            working -= (math.tan(working) - working - wanted) / math.tan(working) ** 2
        distance = 0.5e-3 * self.module * total / math.cos(beta) * math.cos(transverse) / math.cos(working)
        gear = {
            "at": 0.0,
            "kind": "helical" if self.helix else "spur",
            "normal_module": 1e-3 * self.module,
            "normal_pressure_angle": math.radians(self.alpha),
            "width": 1e-3 * self.width,
            "addendum_factor": self.addendum,
        }
        hands: list[dict[str, Any]] = [
            {"helix_angle": beta, "hand": hand} if self.helix else {} for hand in ("right", "left")
        ]
        section = [{"length": 0.2, "outer_diameter": 0.02}]
        model = rg.Model(
            shafts={
                name: {"position": (x, 0.0), "start": -0.1, "sections": section}
                for name, x in (("one", 0.0), ("two", distance))
            },
            gears={
                name: {**gear, **hand, "shaft": shaft, "teeth": z, "profile_shift": x, **flank}
                for name, shaft, z, x, hand, flank in zip(
                    ("pinion", "wheel"), ("one", "two"), self.teeth, self.shift, hands, self.flank, strict=True
                )
            },
            meshes={
                "pair": {
                    "pinion": "pinion",
                    "gear": "wheel",
                    "stiffness": "tooth_fe",
                    "misalignment": self.misalignment,
                }
            },
        )
        return mesh_request(model, None, None, self.torque, {})


def _relief(start: tuple[float, float], depth: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Tip reliefs of both gears from diameters (m)."""
    first, second = ({"tip_relief": depth, "tip_relief_diameter": d} for d in start)
    return first, second


SAMPLED = {
    "spur": Pair((34, 80), 0.0, 5.0, 54.0, 2000.0),
    "light": Pair((34, 80), 0.0, 5.0, 54.0, 200.0),
    "overload": Pair((34, 80), 0.0, 5.0, 54.0, 20000.0),
    "relieved": Pair((34, 80), 0.0, 5.0, 54.0, 2000.0, flank=_relief((0.175, 0.405), "30 um")),
    "undercut": Pair((12, 40), 0.0, 3.0, 30.0, 100.0),
    "high contact ratio": Pair((41, 59), 0.0, 3.0, 36.0, 400.0, addendum=1.25),
    "profile crowned": Pair(
        (23, 37), 0.0, 3.0, 25.0, 150.0, shift=(0.3, -0.1), flank=({"flank": {"profile_crowning": "8 um"}}, {})
    ),
    "crowned, misaligned": Pair(
        (34, 80), 0.0, 5.0, 54.0, 2000.0, flank=({"flank": {"crowning": "10 um"}}, {}), misalignment="20 um"
    ),
    "helical 20.86": Pair((34, 80), 20.86, 5.0, 54.0, 1000.0),
    "helical 33.27": Pair((30, 72), 33.27, 5.0, 54.0, 1000.0),
}
HELICAL = {
    "34/80 20.86": Pair((34, 80), 20.86, 5.0, 54.0, 1000.0),
    "30/72 33.27": Pair((30, 72), 33.27, 5.0, 54.0, 1000.0),
    "29/113 30": Pair((29, 113), 30.0, 2.75, 32.5, 278.0, alpha=25.0),
    "23/61 12": Pair((23, 61), 12.0, 3.0, 24.0, 150.0, shift=(0.2, -0.1)),
    "25/47 25 crowned": Pair(
        (25, 47),
        25.0,
        4.0,
        40.0,
        600.0,
        shift=(0.2, 0.0),
        flank=({"flank": {"crowning": "6 um"}}, {}),
        misalignment="12 um",
    ),
    "26/125 30": Pair((26, 125), 30.0, 4.25, 42.5, 502.0, alpha=25.0),
    "34/80 20.86 x 10": Pair((34, 80), 20.86, 5.0, 54.0, 10000.0),
}
# More pairs. 32/64 was looked at when shares of the section were chosen, the others were not.
MORE = {
    "17/53 15": Pair((17, 53), 15.0, 3.0, 30.0, 120.0, shift=(0.2, 0.0)),
    "32/64 28": Pair((32, 64), 28.0, 3.5, 20.0, 200.0),
    "19/37 35": Pair((19, 37), 35.0, 4.0, 44.0, 300.0, shift=(0.1, 0.0)),
}

WHEELS: dict[str, dict[str, object]] = {
    "web 6.4 mm": {},
    "web 3.2 mm": {"gears.wheel.body.web_thickness": "3.2 mm"},
    "rim 4.5 mm": {"gears.wheel.body.rim_thickness": "4.5 mm"},
}


def _figures(found: SolvedHelices) -> np.ndarray:
    """Mean stiffness, peaks to peaks of stiffness and transmission error, and largest pressure."""
    curve = found.curve
    return np.array([curve.mean()[1], np.ptp(found.stiffness), np.ptp(found.error), curve.values[:, 3].max()])


def _estimates(errors: MeshErrors) -> np.ndarray:
    """In the order of the figures, and of the harmonics."""
    return np.array(
        [
            errors.mean_stiffness,
            errors.peak_to_peak_stiffness,
            errors.ste_peak_to_peak,
            errors.largest_pressure,
            errors.ste_harmonics,
        ],
        float,
    )


def sampled_errors(pair: Pair, asked: tuple[int, ...] = ASKED) -> list[tuple[int, np.ndarray, np.ndarray, float]]:
    """For each number of positions: errors and estimates (5,) of figures and harmonics, and CPU seconds of the contact."""
    request = pair.request()
    assert request.teeth is not None
    teeth = request.teeth
    if in_space(teeth)[0]:
        teeth = replace(teeth, fe=sized(teeth.fe, COARSE, teeth.width / teeth.first.normal_module))
    truth = solve_helices(request, teeth, REFERENCE_POSITIONS)
    exact = _figures(truth)
    waves = truth.curve.harmonics(ORDERS)[:, 0]
    rows = []
    for count in asked:
        start = time.process_time()
        found = solve_helices(request, teeth, count, judged=True)
        seconds = time.process_time() - start
        parts = error_parts(request, teeth, found)
        assert parts is not None
        estimates = sum(_estimates(part) for part in (parts.sampling, parts.slices) if part)
        wave = np.abs(np.abs(found.curve.harmonics(ORDERS)[:, 0]) - np.abs(waves)).max() / np.abs(waves).max()
        rows.append(
            (
                count,
                np.append(np.abs(_figures(found) / exact - 1.0), wave),
                np.asarray(estimates),
                seconds,
            )
        )
    return rows


def preset_errors(pair: Pair) -> list[tuple[str, np.ndarray, np.ndarray, float]]:
    """For default and fine: errors against the reference and estimates (4,), and CPU seconds."""
    request = pair.request()
    return _preset_errors(request, reference(request))


def reference(request: MeshRequest) -> np.ndarray:
    """The figures on thin layers, with what is left of the profile's error."""
    thin = _meshed(request, DEFAULT_PROFILE, THIN)
    found = solve_helices(request, thin, POSITIONS, judged=True)
    rough, fine = (
        curves_at(request, _meshed(request, profile, THICK), found.curve.position, 1)
        for profile in (DEFAULT_PROFILE, FINE_PROFILE)
    )
    left = 1.0 / ((FINE_PROFILE.involute / DEFAULT_PROFILE.involute) ** PROFILE_ORDER - 1.0)
    values = found.curve.values[:, [0, 1, 3]] + (1.0 + left) * (fine - rough)
    curve = CycleCurve(found.curve.position, values, found.curve.period, found.curve.event)
    return np.array([curve.mean()[1], np.ptp(values[:, 1]), np.ptp(values[:, 0]), values[:, 2].max()])


def _meshed(request: MeshRequest, profile: MeshSize, layer: float) -> ToothPair:
    """The teeth with so many elements in the section and layers of that thickness in normal modules."""
    assert request.teeth is not None
    teeth = request.teeth
    width = teeth.width / teeth.first.normal_module
    return replace(teeth, fe=sized(ToothFe(preset="fine"), (profile, layer), width))


def _preset_errors(request: MeshRequest, exact: np.ndarray) -> list[tuple[str, np.ndarray, np.ndarray, float]]:
    rows = []
    for preset in ("default", "fine"):
        start = time.process_time()
        teeth, found = _solved(request, ToothFe(preset=preset))
        parts = error_parts(request, teeth, found)
        seconds = time.process_time() - start
        assert parts is not None
        rows.append((preset, np.abs(_figures(found) / exact - 1.0), _estimates(parts.total)[:4], seconds))
    return rows


def _solved(request: MeshRequest, fe: ToothFe) -> tuple[ToothPair, SolvedHelices]:
    assert request.teeth is not None
    teeth = replace(request.teeth, fe=fe)
    return teeth, solve_helices(request, teeth, POSITIONS, judged=True)


def wheel_errors(changes: dict[str, object]) -> list[tuple[str, np.ndarray, np.ndarray, float]]:
    """As `preset_errors`, for the file's web wheel with changes."""
    file = rg.load(ROOT / "models" / "web_wheel.toml")
    request = mesh_request(file.with_(changes) if changes else file, None, None, None, {})
    finest = ToothFe(preset="fine", size=FINEST_WHEEL, blank_coarseness=0.5)
    return _preset_errors(request, _figures(_solved(request, finest)[1]))


def main(words: list[str]) -> None:
    """Print the tables."""
    tables = ("positions", "presets", "wheels", "separable")
    kinds = [word for word in words if word in tables] or tables
    names = [word for word in words if word not in tables]
    if "positions" in kinds:
        print(
            "errors in % / estimates of what lies between positions in %; ! where an error is more than 1.5 times its estimate"
        )
        print(
            f"{'':22}positions               k            k pp          STE pp           p_max       harmonics      CPU"
        )
        for name, pair in SAMPLED.items():
            if names and name not in names:
                continue
            for count, errors, estimates, seconds in sampled_errors(pair):
                _line(f"{name:20} {count:10}", errors, estimates, seconds, 1e-5)
    for table, pairs in (("presets", {**HELICAL, **MORE}), ("wheels", WHEELS)):
        if table not in kinds:
            continue
        print(
            "errors against the finest mesh in % / estimates in %; ! where an error is more than 1.5 times its estimate"
        )
        print(
            f"{'':20}preset                  k            k pp          STE pp           p_max      CPU   worst estimate/error"
        )
        for name, pair in pairs.items():
            if names and name not in names:
                continue
            for preset, errors, estimates, seconds in (
                preset_errors(pair) if isinstance(pair, Pair) else wheel_errors(pair)
            ):
                _line(
                    f"{name:20}{preset:11}",
                    errors,
                    estimates,
                    seconds,
                    0.0,
                    f"{max(estimates[:3]) / max(errors[:3]):8.1f}",
                )

    if "separable" in kinds:
        print(
            "34/80 20.86, 48 even positions: change by 12 rows on the involute in place of 8, and by the thinnest layers, in %"
        )
        print("layer, modules         k    k pp  STE pp           k    k pp  STE pp")
        pair = HELICAL["34/80 20.86"]
        for layer, by_profile, by_layers in separable(pair):
            cells = "".join(f"{100 * value:8.2f}" for value in by_profile)
            print(f"{layer:14.2f}{cells}    " + "".join(f"{100 * value:8.2f}" for value in by_layers), flush=True)
        print(
            f"mean stiffness on layers of {THICK:g} modules: changes in % as a number of elements is doubled, twice; order"
        )
        for what, sections in DOUBLED.items():
            k = np.array([_even(pair, section, THICK)[0] for section in sections])
            first, second = 100.0 * np.diff(k) / k[-1]
            print(f"{what:20}{first:8.2f}{second:8.2f}{math.log2(first / second):8.2f}", flush=True)


def separable(pair: Pair) -> list[tuple[float, np.ndarray, np.ndarray]]:
    """Of each thickness of layers: relative changes (3,) of k, k pp and STE pp by a finer profile, and by the thinnest layers."""
    rough = [_even(pair, DEFAULT_PROFILE, layer) for layer in LAYERS]
    better = [_even(pair, BETTER_PROFILE, layer) for layer in LAYERS]
    return [
        (layer, fine / coarse - 1.0, rough[-1] / coarse - 1.0)
        for layer, coarse, fine in zip(LAYERS, rough, better, strict=True)
    ]


def _even(pair: Pair, profile: MeshSize, layer: float) -> np.ndarray:
    """k, k pp and STE pp (3,) at 48 even positions."""
    request = pair.request()
    values = curves_at(request, _meshed(request, profile, layer), np.arange(48) / 48, 1)
    return np.array([values[:, 1].mean(), np.ptp(values[:, 1]), np.ptp(values[:, 0])])


def _line(start: str, errors: np.ndarray, estimates: np.ndarray, seconds: float, floor: float, end: str = "") -> None:
    cells = [
        f"{f'{100 * e:.2g}/{100 * s:.2g}':>15}{'!' if e > max(1.5 * s, floor) else ' '}"
        for e, s in zip(errors, estimates, strict=True)
    ]
    print(start + "".join(cells) + f" {seconds:6.2f} s{end}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
