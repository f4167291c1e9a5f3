"""Records over time beside a model: an own integration as the rig, closed forms as the baseline, clocks, orders, ring-downs."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import scipy.linalg
from typer.testing import CliRunner

import rotorgear as rg
from rotorgear.analysis.rig.ring_down import ring_down
from rotorgear.cli.main import app
from rotorgear.errors import RotorgearError
from rotorgear.uff.datasets import Function, Units
from rotorgear.uff.write import function_set, units_set

# Three inertias in kg m^2, springs and dampers between them, a damper to ground on the first one.
J = np.array([0.02, 0.005, 0.08])
K = np.array([900.0, 2500.0])
C = np.array([0.05, 0.02])
GROUND = 0.3
STEP = 1e-3
TIME = 0.25 + STEP * np.arange(900)


def chain(**more: Any) -> rg.Model:
    names = ("a", "b", "c")
    return rg.Model(
        **{
            "motions": ("torsion",),
            "operation": {"input_shaft": "a", "speed": 120.0},
            "shafts": {name: {} for name in names},
            "disks": {f"j{n}": {"shaft": n, "at": "start", "polar_inertia": x} for n, x in zip(names, J, strict=True)},
            "couplings": {
                f"k{n}": {
                    "from_shaft": names[n],
                    "to_shaft": names[n + 1],
                    "stiffness": {"torsion": k},
                    "damping": {"torsion": c},
                }
                for n, (k, c) in enumerate(zip(K, C, strict=True))
            },
            "supports": {"ground": {"shaft": "a", "at": "start", "damping": {"torsion": GROUND}}},
            "points": {
                "drive": {"on": "disks.ja", "direction": "torsion"},
                "brake": {"on": "disks.jc", "direction": "torsion"},
                "first": {"on": "couplings.k0", "quantity": "torque"},
                "second": {"on": "couplings.k1", "quantity": "torque"},
            },
            **more,
        }
    )


def exact(loads: np.ndarray, step: float, k: np.ndarray = K) -> tuple[np.ndarray, np.ndarray]:
    """Places (n, 3) and rates from rest under torques (n, 3) that are linear between instants, exactly."""
    D = np.diff(np.eye(3), axis=0)
    M = np.diag(J)
    S = D.T @ np.diag(k) @ D
    R = D.T @ np.diag(C) @ D
    R[0, 0] += GROUND
    whole = np.zeros((12, 12))
    whole[:3, 3:6] = np.eye(3)
    whole[3:6, :9] = np.hstack([-np.linalg.solve(M, S), -np.linalg.solve(M, R), np.linalg.inv(M)])
    whole[6:9, 9:] = np.eye(3) / step
    over = scipy.linalg.expm(step * whole)[:6]
    x = np.zeros((len(loads), 6))
    for n in range(len(loads) - 1):
        x[n + 1] = over @ np.concatenate([x[n], loads[n], loads[n + 1] - loads[n]])
    return x[:, :3], x[:, 3:]


@pytest.fixture(scope="module")
def pulse() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Torques on the first and last inertia, and those in both springs, as the model counts them."""
    t = TIME - TIME[0]
    loads = np.zeros((len(t), 3))
    loads[:, 0] = np.interp(t, [0.05, 0.06, 0.5, 0.52], [0.0, 4.0, 4.0, 1.0])
    loads[:, 2] = -np.interp(t, [0.1, 0.104], [0.0, 3.0])
    q, v = exact(loads, STEP)
    return loads[:, 0], loads[:, 2], (np.diff(q, axis=1) * K + np.diff(v, axis=1) * C).T


def written(path: Path, columns: dict[str, np.ndarray], mark: str = ",") -> Path:
    rows = [mark.join(["time (s)", *columns])]
    for row in np.column_stack([TIME, *columns.values()]):
        cells = [f"{x:.9g}" for x in row]
        rows.append(mark.join(cells if mark == "," else [cell.replace(".", ",") for cell in cells]))
    path.write_text("\n".join(rows), encoding="utf-8")
    return path


def test_an_own_integration_is_explained_and_the_baseline_is_that_of_inertia(tmp_path: Path, pulse: Any) -> None:
    drive, brake, (first, second) = pulse
    columns = {"drive (N m)": drive, "Bremse [Nm]": -brake, "first N m": first, "s_kNm": -1e-3 * second}
    columns["s (N mm)"] = columns.pop("s_kNm") * 1e6
    columns["spin (rad/s^2)"] = np.cos(30.0 * TIME)
    file = written(tmp_path / "record.csv", columns, ";")
    channels = {"Bremse": "-points.brake", "s": "-points.second", "spin": "disks.jb:torsion"}
    result = rg.compare_time(chain(), file, channels=channels, bands=["5:20", "20 Hz:0.1 kHz"], accuracy=1e-4)
    assert [row.place for row in result.inputs] == ["drive", "brake"]
    for measured, computed, torque in zip(result.rig_values, result.model_values, (first, second), strict=False):
        np.testing.assert_allclose(measured, torque, atol=1e-6)
        np.testing.assert_allclose(computed, torque, atol=1e-3 * np.abs(torque).max())
    # Rigid: all of it turns as one body, and each spring passes on what is behind it. Exact but for 50 parts of a step.
    rate = np.zeros(len(TIME))
    falls = np.exp(-GROUND / J.sum() * STEP / 50)
    fine = np.interp(TIME[0] + STEP * (np.arange(50 * (len(TIME) - 1)) + 0.5) / 50, TIME, drive + brake)
    now = 0.0
    for n, torque in enumerate(fine):
        now = now * falls + torque / GROUND * (1.0 - falls)
        if n % 50 == 49:
            rate[n // 50 + 1] = now
    pace = (drive + brake - GROUND * rate) / J.sum()
    rigid = np.array([brake - J[1:].sum() * pace, brake - J[2] * pace])
    np.testing.assert_allclose(result.baseline_values, [*rigid, pace], atol=1e-4 * np.abs(pace).max())
    np.testing.assert_allclose(result.baseline_values[:2], rigid, atol=1e-4)
    for name, own, still in (("first", first, rigid[0]), ("s", second, rigid[1])):
        row = next(row for row in result.shares if row.name == name and row.part == "variance")
        assert row.explained > 1.0 - 1e-5
        assert row.of_record == pytest.approx(1.0)
        assert row.quasi_static == pytest.approx(1.0 - np.var(own - still) / np.var(own), abs=1e-4)
    assert {row.part for row in result.shares} == {"size", "variance", "5 - 20 Hz", "20 - 100 Hz"}
    assert "spin" in result.verdict
    assert "first" not in result.verdict


def test_the_clock_offset_is_found_told_and_taken_on_request(tmp_path: Path, pulse: Any) -> None:
    drive, brake, (first, second) = pulse
    late = [np.interp(TIME - 0.0137, TIME, x) for x in (first, second)]
    file = written(
        tmp_path / "late.csv", {"drive_Nm": drive, "brake_Nm": brake, "first_Nm": late[0], "second_Nm": late[1]}
    )
    options: dict[str, Any] = {"steps": 40, "bands": [], "error_estimate": False}
    told = rg.compare_time(chain(), file, **options)
    assert told.offset == 0.0
    assert told.offset_found == pytest.approx(-0.0137, abs=1e-4)
    assert told.offset_explained > 0.999 > told.shares[1].explained + 0.1
    taken = rg.compare_time(chain(), file, offset="find", **options)
    assert taken.offset == taken.offset_found
    assert taken.shares[1].explained > 0.999
    assert rg.compare_time(chain(), file, offset="-13.7 ms", **options).shares[1].explained > 0.999


def test_orders_of_a_shaft_are_taken_out_by_its_measured_turns(tmp_path: Path, pulse: Any) -> None:
    drive, brake, (first, _) = pulse
    speed = 120.0 + 8.0 * (TIME - TIME[0])
    angle = 120.0 * (TIME - TIME[0]) + 4.0 * (TIME - TIME[0]) ** 2
    stained = first + 0.8 * np.cos(2.0 * angle + 0.3)
    columns = {"drive_Nm": drive, "brake_Nm": brake, "n (rpm)": speed * 30.0 / np.pi, "first_Nm": stained}
    file = written(tmp_path / "orders.csv", columns)
    options: dict[str, Any] = {"channels": {"n": "shafts.a"}, "steps": 40, "bands": [], "error_estimate": False}
    before = rg.compare_time(chain(), file, **options)
    after = rg.compare_time(chain(), file, remove="a:1,2", quiet="0.8 s:1.1 s", **options)
    assert before.shares[1].explained < 0.9
    assert after.shares[1].explained > 0.99
    assert after.removed == ("order 1 of a", "order 2 of a")


def test_a_torque_of_the_model_is_replaced_by_the_measured_one(tmp_path: Path, pulse: Any) -> None:
    drive = pulse[0]
    loads = {
        "motor": {"kind": "input", "shaft": "a", "torque": 7.0, "ripple": 0.2},
        "pump": {"kind": "output", "shaft": "c", "torque": 7.0},
    }
    alone = np.zeros((len(TIME), 3))
    alone[:, 0] = drive
    q, v = exact(alone, STEP)
    torque = K[0] * (q[:, 1] - q[:, 0]) + C[0] * (v[:, 1] - v[:, 0])
    file = written(tmp_path / "motor.csv", {"motor_Nm": 7.0 + drive, "first_Nm": torque - 7.0})
    result = rg.compare_time(chain(loads=loads), file, steps=400, bands=[], error_estimate=False)
    np.testing.assert_allclose(result.model_values[0], torque - 7.0, atol=2e-3)
    np.testing.assert_allclose(result.baseline_values[0][0], -7.0, atol=1e-9)
    assert result.inputs[0].quantity == "torque"


def test_a_ring_down_has_the_damping_of_its_mode() -> None:
    start = np.zeros((3000, 3))
    start[:30, 0] = 2.0
    q, _ = exact(start, 1e-3)
    torque = np.diff(q, axis=1).T * K[:, None]
    D = np.diff(np.eye(3), axis=0)
    R = D.T @ np.diag(C) @ D
    R[0, 0] += GROUND
    M = np.linalg.inv(np.diag(J))
    A = np.block([[np.zeros((3, 3)), np.eye(3)], [-M @ D.T @ np.diag(K) @ D, -M @ R]])
    s = np.linalg.eigvals(A)
    s = s[s.imag > 1.0][np.argsort(np.abs(s[s.imag > 1.0]))]
    rng = np.random.default_rng(5)
    noisy = torque[:, 40:1600] + 0.002 * np.abs(torque).max() * rng.normal(size=(2, 1560))
    (fit,) = ring_down(1e-3, noisy)
    assert abs(fit.natural_hz - abs(s[0]) / (2.0 * np.pi)) < 5.0 * fit.natural_hz_sigma
    for fit, root in zip(ring_down(1e-3, noisy[:, :400], 2), s, strict=True):
        assert abs(fit.natural_hz - abs(root) / (2.0 * np.pi)) < 4.0 * fit.natural_hz_sigma
        assert abs(fit.damping_ratio + root.real / abs(root)) < 4.0 * fit.damping_ratio_sigma
    with pytest.raises(rg.AnalysisError, match="needs 12 samples or more"):
        ring_down(1e-3, noisy[:, :5])


def test_what_a_long_record_holds_above_the_rate_that_is_kept_does_not_fold_into_a_ring_down() -> None:
    step = 1e-5
    t = step * np.arange(90_000)
    hz = 41.3
    ratio = 0.02
    rings = np.exp(-2.0 * np.pi * hz * ratio * t) * np.cos(2.0 * np.pi * hz * np.sqrt(1.0 - ratio**2) * t + 0.4)
    # Of each fourth sample alone it would be a vibration of 47 Hz, and the larger one.
    hum = 3.0 * np.cos(2.0 * np.pi * (0.25 / step - 47.0) * t)
    (fit,) = ring_down(step, (rings + hum)[None])
    assert fit.natural_hz == pytest.approx(hz, rel=1e-4)
    assert fit.damping_ratio == pytest.approx(ratio, rel=2e-3)


def test_a_standing_rotor_is_compared_by_the_force_and_acceleration_of_a_sensor(tmp_path: Path) -> None:
    """One mass on a spring, its force a half sine, told in g and in a channel without a unit."""
    m, k, c = 12.0, 4.0e5, 130.0
    model = rg.Model(
        motions=("bending",),
        shafts={"s": {}},
        disks={"d": {"shaft": "s", "at": "start", "mass": m, "polar_inertia": 0.01, "diametral_inertia": 0.01}},
        supports={
            "b": {
                "shaft": "s",
                "at": "start",
                "stiffness": {"x": k, "y": 2.0 * k, "tilt_x": 1e6, "tilt_y": 1e6},
                "damping": {"x": c},
            }
        },
    )
    t = TIME - TIME[0]
    force = np.where(t < 0.004, 500.0 * np.sin(np.pi * t / 0.004), 0.0)
    A = np.array(
        [[0.0, 1.0, 0.0, 0.0], [-k / m, -c / m, 1.0 / m, 0.0], [0.0, 0.0, 0.0, 1.0 / STEP], [0.0, 0.0, 0.0, 0.0]]
    )
    over = scipy.linalg.expm(STEP * A)[:2]
    x = np.zeros((len(t), 2))
    for n in range(len(t) - 1):
        x[n + 1] = over @ np.array([*x[n], force[n], force[n + 1] - force[n]])
    a = (force - k * x[:, 0] - c * x[:, 1]) / m
    file = written(tmp_path / "hammer.csv", {"hammer (N)": force, "acc (g)": a / 9.80665, "raw": -a / 50.0})
    channels = {"hammer": "disks.d:x", "acc": "disks.d:x", "raw": "-disks.d:x, 50 m/s^2"}
    result = rg.compare_time(model, file, channels=channels, ring_down="0.27 s:0.6 s")
    for row in result.shares:
        if row.part == "variance":
            assert row.explained > 0.9999, row.name
    (row,) = (row for row in result.ring_downs if row.name == "all")
    for found in (row.rig_hz, row.answer_hz, row.mode_hz):
        assert found == pytest.approx(np.sqrt(k / m) / (2.0 * np.pi), rel=1e-3)
    for found in (row.rig_damping_ratio, row.answer_damping_ratio, row.mode_damping_ratio):
        assert found == pytest.approx(c / (2.0 * np.sqrt(k * m)), rel=5e-3)
    (line,) = result.ring_down_lines()
    file = rg.write_rig_lines([line], tmp_path / "lines.csv")
    (again,) = rg.read_rig_lines(file)
    assert (again.frequency_hz, again.damping_ratio) == pytest.approx((line.frequency_hz, line.damping_ratio))
    assert len(result.plot()) == 3


@pytest.mark.parametrize(
    ("channels", "more", "words"),
    [
        ({"first": "points.nowhere"}, {}, "'points.nowhere' is no place"),
        ({"fist": "points.first"}, {}, "no channel 'fist'.*did you mean 'first'"),
        ({"first": "points.first, 3 N m"}, {}, "the record has it in Nm already"),
        ({"first": "disks.jb:torsion, 3"}, {}, "a scale is a number and a unit"),
        ({"drive": "loads.motor"}, {}, "the model has no such load"),
        ({}, {"window": "5 s:6 s"}, "holds 0 instants of the record, which goes from 0.25 to 1.149 s"),
        ({}, {"window": "5"}, "expected FROM:TO"),
        ({}, {"bands": ["60:15"]}, "must rise"),
        ({}, {"bands": ["600 Hz:700 Hz"]}, "begin below 500 Hz"),
        ({}, {"quiet": "0.3:0.4"}, "give them by remove"),
        ({}, {"remove": "x:1"}, "no shaft 'x'"),
        ({}, {"remove": "a:0"}, "expected SHAFT:ORDERS"),
        ({}, {"offset": "2 s"}, "leaves nothing"),
        ({}, {"ring_down": "0.3:0.6", "vibrations": 0}, "expected 1 or more of them, got 0"),
        ({}, {"points": "sensors.csv"}, "the table of sensors of a universal file"),
    ],
)
def test_requests_without_sense_are_refused(
    tmp_path: Path, pulse: Any, channels: dict[str, str], more: dict[str, Any], words: str
) -> None:
    drive, _, (first, _) = pulse
    file = written(tmp_path / "r.csv", {"drive_Nm": drive, "first_Nm": first})
    options = {"steps": 8, "error_estimate": False, "bands": []} | more
    with pytest.raises(rg.AnalysisError, match=words):
        rg.compare_time(chain(), file, channels=channels, **options)


def test_a_channel_that_stands_twice_in_a_record_is_not_taken_twice(tmp_path: Path) -> None:
    file = tmp_path / "r.csv"
    file.write_text("time (s),first (N m),first (N m)\n" + "".join(f"{0.1 * k},{k},{k}\n" for k in range(9)))
    with pytest.raises(rg.AnalysisError, match="2 channels 'first': leave all but one out"):
        rg.compare_time(chain(), file)


def test_what_the_record_is_too_coarse_for_is_told(tmp_path: Path, pulse: Any) -> None:
    """With 40 ms between samples nothing above 12.5 Hz is told, and all modes of the chain lie there."""
    drive, brake, (first, second) = pulse
    file = tmp_path / "coarse.csv"
    rows = np.column_stack([TIME, drive, brake, first, second])[::40]
    head = "time_s,drive_Nm,brake_Nm,first_Nm,second_Nm"
    file.write_text("\n".join([head, *(",".join(f"{x:.9g}" for x in row) for row in rows)]), encoding="utf-8")
    told = rg.compare_time(chain(), file, steps=400, bands=[], error_estimate=False).warnings
    assert any("lies above 12.5 Hz, half of what was sampled with" in note for note in told)
    fine = written(tmp_path / "fine.csv", {"drive_Nm": drive, "brake_Nm": brake, "first_Nm": first})
    assert not any("was sampled with" in note for note in rg.compare_time(chain(), fine, steps=400, bands=[]).warnings)


def rotor() -> rg.Model:
    return rg.Model(
        motions=("bending",),
        shafts={"s": {}},
        disks={"d": {"shaft": "s", "at": "start", "mass": 12.0, "polar_inertia": 0.01, "diametral_inertia": 0.01}},
        supports={"b": {"shaft": "s", "at": "start", "stiffness": {"x": 4e5, "y": 8e5, "tilt_x": 1e6, "tilt_y": 1e6}}},
    )


def test_functions_over_time_of_a_universal_file_lie_at_its_sensors(tmp_path: Path) -> None:
    """A force on one sensor, and its answer by a sensor that looks the other way, in mm/s^2."""
    force = np.where(TIME - TIME[0] < 0.03, 40.0, 0.0)
    options: dict[str, Any] = {"steps": 400, "error_estimate": False, "bands": []}
    time_axis = {"kind": 1, "x_type": 17, "x": TIME}
    hammer = Function(response=(7, 1), reference=(0, 0), values=force, numerator=13, **time_axis)
    still = Function(
        response=(7, -1), reference=(0, 0), values=0.0 * TIME + 1e-3 * np.sin(TIME), numerator=12, **time_axis
    )
    file = tmp_path / "hammer.uff"
    table = tmp_path / "sensors.csv"
    table.write_text("point,node,direction\ndisks.d,7,x\n", encoding="utf-8")
    file.write_bytes(units_set(Units(1e3, 1e3, "mm (N)", 9)) + function_set(hammer) + function_set(still))
    first = rg.compare_time(rotor(), file, points=table, **options)
    assert [(row.place, row.unit) for row in first.inputs] == [("disks.d:x", "N")]
    assert first.load[0].max() == pytest.approx(40.0 / 1e3, rel=1e-6)  # of the file's units
    answer = Function(
        response=(7, -1), reference=(0, 0), values=-1e3 * first.model_values[0], numerator=12, **time_axis
    )
    file.write_bytes(units_set(Units(1e3, 1e3, "mm (N)", 9)) + function_set(hammer) + function_set(answer))
    again = rg.compare_time(rotor(), file, points=table, **options)
    assert again.shares[1].explained > 1.0 - 1e-9
    file.write_bytes(units_set(Units()))
    with pytest.raises(rg.ModelError, match="functions over time"):
        rg.compare_time(rotor(), file, points=table, **options)


def run(*arguments: str) -> tuple[int, str]:
    done = CliRunner().invoke(app, ["compare", *arguments])
    if isinstance(done.exception, RotorgearError):
        return 2, str(done.exception)
    assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
    return done.exit_code, done.output


def test_the_command_prints_80_columns_and_writes_lines_of_a_rig(tmp_path: Path, pulse: Any) -> None:
    drive, brake, (first, second) = pulse
    file = written(
        tmp_path / "r.csv",
        {"drive_Nm": drive, "brake_Nm": brake, "A very long name of a channel_Nm": first, "b_Nm": second},
    )
    model = tmp_path / "chain.toml"
    chain().to_toml(model)
    options = [
        "--time",
        str(file),
        "--channels",
        "b=points.second",
        "--channels",
        "A very long name of a channel=points.first",
    ]
    options += [
        "--ring-down",
        "0.85:1.1",
        "--steps",
        "100",
        "-o",
        str(tmp_path / "lines.csv"),
        "--json",
        str(tmp_path / "r.json"),
    ]
    code, text = run(str(model), *options)
    assert code == 0, text
    # A line that names a file is as long as its path.
    assert max(len(line) for line in text.splitlines() if str(tmp_path) not in line) <= 80
    assert len(rg.read_rig_lines(tmp_path / "lines.csv")) == 1
    assert json.loads((tmp_path / "r.json").read_text())["channels"][1]["place"] == "second"
    for more, words in (
        (["--output", "a.csv"], "--output takes the frequencies and damping of --ring-down"),
        (["--samples", "3"], "No such option"),
        (["--tolerance", "0.1"], "--tolerance does not go with --time"),
    ):
        code, text = run(str(model), "--time", str(file), *more)
        assert code == 2
        assert words in text


def test_the_command_takes_measured_responses(tmp_path: Path) -> None:
    """The file of --frf had been dropped on its way to the verb."""
    model = tmp_path / "rotor.toml"
    rotor().to_toml(model)
    found = rg.frf(rotor(), inputs=["disks.d:x"], outputs=["disks.d:x"], fmax=60.0, points=9, elements=1)
    rg.write_uff(found, tmp_path / "hit.uff")
    code, text = run(str(model), "--frf", str(tmp_path / "hit.uff"))
    assert code == 0, text
    assert "Mean FRAC 1.000" in text
