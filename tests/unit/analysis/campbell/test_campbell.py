"""Campbell diagrams and critical speeds against closed forms, true solutions at each speed, and each other."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rotorgear as rg
from tests.paths import MODELS

RPM = np.pi / 30.0


def rigid_rotor(**bearing: Any) -> rg.Model:
    """A rigid disk on two equal bearings at 0.2 m to each side of it: closed forms for whirl in translation and in tilt."""
    return rg.Model(
        shafts={"rotor": {"sections": [{"length": 0.4, "outer_diameter": 0.1, "rigid": True, "material": "massless"}]}},
        materials={"massless": {"youngs_modulus": 2.1e11, "shear_modulus": 8e10, "density": 1e-9}},
        disks={"disk": {"shaft": "rotor", "at": 0.2, "mass": 10.0, "polar_inertia": 0.3, "diametral_inertia": 0.2}},
        bearings={
            end: {"shaft": "rotor", "at": end, **(bearing or {"stiffness": {"radial": 1e6, "axial": 1e6}})}
            for end in ("start", "end")
        },
        operation={"input_shaft": "rotor", "speed": 1000.0},
    )


def tilting(speed: float) -> np.ndarray:
    """Backward and forward frequency in rad/s of the tilting disk: w^2 I_d -+ w W I_p = 2 k l^2."""
    k = 2.0 * 1e6 * 0.2**2
    polar = 0.3
    diametral = 0.2
    middle = polar * speed / (2.0 * diametral)
    root = np.hypot(middle, np.sqrt(k / diametral))
    return np.array([root - middle, root + middle])


def test_whirl_of_a_tilting_disk_splits_as_its_gyroscopic_moment_says() -> None:
    result = rg.campbell(rigid_rotor(), speeds=np.linspace(0.0, 2000.0, 11).tolist())
    for k, speed in enumerate(result.speeds):
        found = 2.0 * np.pi * result.frequency_hz[k]
        for exact in tilting(speed):
            assert np.nanmin(np.abs(found / exact - 1.0)) < 1e-10
    words = {result.whirl_word(-1, b) for b in range(len(result))}
    assert {"forward", "backward"} <= words


def test_what_moves_is_that_of_the_speed_of_the_whirl() -> None:
    """The description of each branch is that of the modes at the last speed, as its whirl is; at standstill others stand."""
    model = rg.load(MODELS / "split_torque.toml")
    result = rg.campbell(model, speeds=["0 rpm", "20000 rpm"], modes=6, mesh_orders=(), error_estimate=False)
    at_last = rg.modal(model, speed="20000 rpm", modes=14)
    told = dict(zip(np.round(at_last.frequency_hz, 3), at_last.description, strict=True))
    assert [told[hz] for hz in np.round(result.frequency_hz[-1], 3)] == list(result.description)
    still = set(rg.modal(model, speed="0 rpm", modes=14).description)
    assert not set(result.description) <= still


def test_critical_speeds_of_a_tilting_disk_are_those_of_the_closed_form() -> None:
    """w = W: W^2 (I_d -+ I_p) = 2 k l^2 has a backward root only, since I_p > I_d; translation has sqrt(2 k / m) twice."""
    result = rg.critical(rigid_rotor(), stop=2000.0, damped=False)
    speeds = np.array(
        [item.speed for item in result.speeds if item.whirl in ("forward", "backward", "planar", "mixed")]
    )
    assert np.min(np.abs(speeds - np.sqrt(2e6 / 10.0))) < 1e-7
    assert np.min(np.abs(speeds - np.sqrt(8e4 / 0.5))) < 1e-7
    assert result.worst_residual < 1e-10


@pytest.mark.parametrize("name", ["split_torque", "jeffcott", "helical_pair"])
def test_the_basis_gives_what_a_true_solution_gives_at_every_speed(name: str) -> None:
    model = rg.load(MODELS / f"{name}.toml")
    system = rg.System(model, 2)
    result = rg.campbell(system, speeds=np.linspace(0.0, 2000.0, 9).tolist(), modes=12, error_estimate=False)
    assert result.basis_error < 1e-9
    for k in (2, 5, 8):
        true = rg.modal(system, speed=float(result.speeds[k]), modes=40, error_estimate=False).eigenvalues
        for s in result.eigenvalues[k][np.isfinite(result.eigenvalues[k])]:
            assert np.min(np.abs(true - s)) / abs(s) < 1e-9


def test_the_speed_table_of_a_bearing_is_followed_exactly() -> None:
    rows = [
        {"speed": speed, "stiffness": {"radial": k, "axial": 1e6}}
        for speed, k in ((0.0, 1e6), (900.0, 3e6), (2000.0, 4e6))
    ]
    model = rigid_rotor(table=rows)
    result = rg.campbell(model, speeds=[0.0, 450.0, 900.0, 1450.0, 2000.0])
    for speed, k in ((450.0, 2e6), (900.0, 3e6), (1450.0, 3.5e6)):
        row = result.frequency_hz[int(np.argmin(np.abs(result.speeds - speed)))]
        assert np.nanmin(np.abs(2.0 * np.pi * row - np.sqrt(2.0 * k / 10.0))) < 1e-7


def test_more_branches_than_modes_that_were_asked_for_are_lowest_ones_somewhere_and_said_to_be() -> None:
    rotor = rg.load(MODELS / "jeffcott.toml")
    found = rg.campbell(rotor, modes=4, points=21)
    assert len(found) == 5
    rank = np.argsort(np.argsort(found.natural_frequency_hz, axis=1), axis=1)
    assert np.all((rank < 4).any(axis=0))
    assert not np.all(rank < 4)
    assert "each is among the 4 lowest at some speed" in found.method
    assert "lowest at some speed" not in rg.campbell(rotor, modes=2, points=5).method


def test_a_speed_outside_of_a_bearings_table_is_refused() -> None:
    rows = [{"speed": speed, "stiffness": {"radial": 1e6, "axial": 1e6}} for speed in (100.0, 900.0)]
    with pytest.raises(rg.AnalysisError, match="table"):
        rg.campbell(rigid_rotor(table=rows), speeds=[0.0, 500.0])


def test_internal_damping_makes_forward_whirl_unstable_where_it_should() -> None:
    """With C = a M outside and b K inside, s^2 + a s + w^2 (1 + b (s - i W)) = 0: unstable above W = w + a / (b w)."""
    outside = 4.0
    inside = 1e-5
    model = rg.Model(
        shafts={"rotor": {"sections": [{"length": 1.0, "outer_diameter": 0.02}], "internal_damping": inside}},
        supports={end: {"shaft": "rotor", "at": end, "fixed": ["x", "y", "z"]} for end in ("start", "end")},
        operation={"input_shaft": "rotor", "speed": 1000.0},
        damping={"rayleigh_alpha": outside},
        motions=["bending"],
    )
    own = float(rg.modal(model, modes=1, accuracy=1e-8).natural_frequency_hz[0]) * 2.0 * np.pi
    exact = own + outside / (inside * own)
    result = rg.campbell(model, speeds=np.linspace(0.0, 1.5 * exact, 21).tolist(), modes=2)
    assert result.onsets
    assert result.onsets[0].speed == pytest.approx(exact, rel=2e-3)
    b = result.onsets[0].branch - 1
    assert result.whirl_word(-1, b) == "forward"
    assert result.log_decrement[0, b] > 0.0 > result.log_decrement[-1, b]


def test_critical_speeds_are_where_branches_cross_the_line() -> None:
    model = rg.load(MODELS / "jeffcott.toml")
    direct = rg.critical(model, stop=1500.0)
    diagram = rg.campbell(model, speeds=np.linspace(0.0, 1500.0, 31).tolist(), shaft_orders=[1.0])
    crossed = np.array([item.speed for item in diagram.crossings])
    assert len(direct) >= 2
    assert direct.worst_residual < 1e-10
    for item in direct.speeds:
        assert np.min(np.abs(crossed - item.speed)) / item.speed < 1e-3


def test_branches_of_a_coarse_grid_end_where_those_of_a_fine_one_do() -> None:
    system = rg.System(rg.load(MODELS / "split_torque.toml"), 1)

    def ends(points: int) -> np.ndarray:
        speeds = np.linspace(0.0, 20000.0 * RPM, points).tolist()
        result = rg.campbell(system, speeds=speeds, modes=24, error_estimate=False)
        order = np.argsort(result.frequency_hz[0])
        return result.eigenvalues[-1, order][:20]

    assert ends(14) == pytest.approx(ends(61), rel=1e-8)


def test_a_result_comes_back_from_hdf5(tmp_path: Path) -> None:
    model = rg.load(MODELS / "jeffcott.toml")
    for result in (rg.campbell(model, speeds=[0.0, 100.0, 200.0], modes=4), rg.critical(model, stop=800.0)):
        back = rg.read(rg.save(result, tmp_path / "result.h5"))
        assert back.to_dict() == result.to_dict()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"speeds": [100.0, -100.0]}, "sense"),
        ({"modes": 0}, "at least 1"),
        ({"sidebands": -1}, "negative"),
        ({"fmax": -5.0}, "positive"),
    ],
)
def test_what_makes_no_sense_is_refused(changes: dict[str, Any], words: str) -> None:
    with pytest.raises(rg.AnalysisError, match=words):
        rg.campbell(rigid_rotor(), **{"speeds": [0.0, 100.0], **changes})


def test_modes_are_followed_up_to_the_first_order_of_every_mesh_where_they_are_not_too_many() -> None:
    from rotorgear.analysis.campbell.speeds import mesh_reach

    split = rg.load(MODELS / "split_torque.toml")
    assert mesh_reach(split)[0] == pytest.approx(1.05 * 29 * 16350.0 / 60.0)
    reach, note = mesh_reach(rg.load(MODELS / "geared_pair.toml"))
    assert reach is None
    assert "--fmax 8610" in note
    assert mesh_reach(rg.load(MODELS / "jeffcott.toml")) == (None, "")


@pytest.mark.long
def test_every_first_order_of_a_mesh_has_its_margin_without_an_option() -> None:
    result = rg.campbell(rg.load(MODELS / "split_torque.toml"), points=5)
    first = [item for item in result.margins if item.line.startswith("mesh") and item.line.endswith(" 1x")]
    assert len(first) == 2
    assert all(item.branch for item in first)
    assert np.nanmax(result.frequency_hz) > max(item.frequency_hz for item in first)


def test_a_rotor_on_springs_next_to_nothing_has_its_frequencies_within_the_error_of_the_basis() -> None:
    """Rigid on springs 14 decades below its shaft, where rounding shows: frequencies go with the root of the stiffness."""
    text = """
    operation = {{ input_shaft = "r", speed = "3000 rpm" }}
    motions = ["torsion", "bending"]
    [shafts.r]
    sections = [{{ length = "400 mm", outer_diameter = "50 mm" }}, {{ length = "300 mm", outer_diameter = "40 mm" }}]
    [disks]
    a = {{ shaft = "r", at = "start", mass = 5.0, polar_inertia = 0.05, diametral_inertia = 0.03 }}
    b = {{ shaft = "r", at = "end", mass = 3.0, polar_inertia = 0.02, diametral_inertia = 0.01 }}
    [bearings]
    l = {{ shaft = "r", at = "100 mm", stiffness = {{ radial = {k}, torsion = 100.0 }} }}
    m = {{ shaft = "r", at = "600 mm", stiffness = {{ radial = {twice} }} }}
    """
    soft, firm = (rg.campbell(rg.loads(text.format(k=k, twice=2.0 * k)), points=5, modes=2) for k in (1e-6, 1e-3))
    assert firm.basis_error < 1e-9
    assert soft.basis_error < 1e-5
    still = [float(np.nanmin(found.frequency_hz[0])) for found in (soft, firm)]
    assert still[0] / still[1] == pytest.approx(np.sqrt(1e-3), rel=3.0 * max(soft.basis_error, 1e-9))
