"""Forces and moments from outside: closed forms of beams and oscillators, reactions, and how the analyses agree."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import rotorgear as rg
from rotorgear.errors import ModelError
from rotorgear.model.checks.plausibility import implausible

TURN = 2.0 * np.pi
CANTILEVER = """
[operation]
input_shaft = "rotor"
speed = "3000 rpm"
[shafts.rotor]
sections = [{ length = "500 mm", outer_diameter = "40 mm" }]
shear_deformation = false
[supports.wall]
shaft = "rotor"
at = "start"
fixed = ["all"]
[points.tip]
shaft = "rotor"
at = "end"
direction = "y"
"""
# One mass on springs that turns: k = 1e6 N/m across, 1e5 N m/rad about z against the ground.
OSCILLATOR = """
[operation]
input_shaft = "rotor"
speed = "100 rad/s"
[shafts.rotor]
[disks.wheel]
shaft = "rotor"
at = "start"
mass = 10.0
polar_inertia = 2.0
diametral_inertia = 1.0
[bearings.b]
shaft = "rotor"
at = "start"
stiffness = { radial = 1e6, axial = 1e6, tilt = 1e4 }
damping = { radial = 200.0, axial = 200.0, tilt = 5.0 }
[points.p]
shaft = "rotor"
at = "start"
direction = "x"
"""


def _with(text: str, load: str, folder: Path | str = ".") -> rg.Model:
    return rg.loads(f"{text}\n[loads.pull]\n{load}\n", folder=folder)


def test_a_cantilever_bends_stretches_and_twists_as_a_beam_does():
    model = _with(
        CANTILEVER, 'point = "tip"\nforce = ["30 N", "100 N", "20 N"]\nmoment = ["3 N m", "0.4 kN mm", "5 N m"]'
    )
    moved = rg.static(model).displacement[-1]
    E = 206e9
    G = E / 2.6
    inertia = np.pi * 0.04**4 / 64.0
    length = 0.5
    bend = length**3 / 3.0 / (E * inertia)
    across = length**2 / 2.0 / (E * inertia)
    turn = length / (E * inertia)
    expected = [
        30.0 * bend + 0.4 * across,
        100.0 * bend - 3.0 * across,
        20.0 * length / (E * np.pi * 0.02**2),
        -100.0 * across + 3.0 * turn,
        30.0 * across + 0.4 * turn,
        5.0 * length / (G * 2.0 * inertia),
    ]
    np.testing.assert_allclose(moved, expected, rtol=1e-9)


def test_the_tip_of_an_overhung_shaft_goes_down_by_the_closed_form():
    # Simply supported over a, the load at the end of an overhang b: w = F b^2 (a + b) / (3 E I).
    text = """
[shafts.rotor]
sections = [{ length = "400 mm", outer_diameter = "40 mm" }, { length = "150 mm", outer_diameter = "40 mm" }]
shear_deformation = false
[supports.left]
shaft = "rotor"
at = "0 mm"
fixed = ["x", "y", "z", "torsion"]
[supports.right]
shaft = "rotor"
at = "400 mm"
fixed = ["x", "y"]
"""
    result = rg.static(_with(text, 'shaft = "rotor"\nat = "end"\nforce = [0.0, -250.0, 0.0]'))
    inertia = np.pi * 0.04**4 / 64.0
    assert result.displacement[-1, 1] == pytest.approx(-250.0 * 0.15**2 * 0.55 / (3.0 * 206e9 * inertia), rel=1e-9)
    assert result.support_force["right"][1] == pytest.approx(250.0 * 0.55 / 0.4, rel=1e-9)
    assert result.support_force["left"][1] == pytest.approx(-250.0 * 0.15 / 0.4, rel=1e-9)


@pytest.mark.parametrize(("name", "gear"), [("helical_pair", "wheel"), ("split_torque", "wheel_a")])
def test_reactions_of_a_gearbox_balance_its_loads(name, gear):
    text = Path(f"models/{name}.toml").read_text()
    model = _with(text, f'gear = "{gear}"\nforce = ["500 N", "-900 N", "130 N"]\nmoment = ["20 N m", "7 N m", "0 N m"]')
    plain = rg.static(rg.loads(text))
    loaded = rg.static(model)
    shaft = model.shafts[model.gears[gear].shaft]
    total = np.zeros(6)
    for name, force in loaded.bearing_force.items():
        x, y = model.shafts[model.bearings[name].shaft].position
        z = model.layout.place(f"bearings.{name}").z
        change = force - plain.bearing_force[name]
        total += np.concatenate([change[:3], change[3:] + np.cross([x, y, z], change[:3])])
    load = loaded.load_force["loads.pull"]
    place = [*shaft.position, np.mean([place.z for place in model.layout.places(f"gears.{gear}")])]
    total += np.concatenate([load[:3], load[3:] + np.cross(place, load[:3])])
    size = max(float(np.abs(force[:3]).max()) for force in loaded.bearing_force.values())
    np.testing.assert_allclose(total[:5], 0.0, atol=1e-12 * size)


@pytest.mark.parametrize("vary", ['order = 2.0\nphase = "40 deg"', 'frequency = "31.8 Hz"\nphase = "40 deg"'])
def test_a_harmonic_load_answers_as_its_frequency_response_says(vary):
    load = f"shaft = 'rotor'\nat = 'end'\nforce = ['70 N', '0 N', '0 N']\nmoment = ['0 N m', '11 N m', '0 N m']\n{vary}"
    model = _with(CANTILEVER.replace("[points", "[damping]\nrayleigh_beta = 1e-5\n[points"), load)
    speed = 2.0 * np.pi * 15.9
    result = rg.response(model, speeds=[speed], elements=2, method="direct")
    hz = float(result.frequency_hz[-1, 0])
    assert hz == pytest.approx(31.8, rel=1e-12)
    across = rg.frf(
        model.with_("points.tip.direction", "x"), [hz], inputs=["tip"], outputs=["tip"], speed=speed, elements=2
    )
    tilted = rg.frf(
        rg.loads(
            CANTILEVER.replace("[points", "[damping]\nrayleigh_beta = 1e-5\n[points").replace(
                'direction = "y"', 'direction = "x"\n[points.turn]\nshaft = "rotor"\nat = "end"\ndirection = "tilt_y"'
            )
        ),
        [hz],
        inputs=["turn"],
        outputs=["tip"],
        speed=speed,
        elements=2,
    )
    expected = (70.0 * across.receptance[0, 0, 0] + 11.0 * tilted.receptance[0, 0, 0]) * np.exp(1j * np.radians(40.0))
    index = np.argmax(np.abs(result.nodes.position[:, 2]))
    found = result.shapes[index, 0, -1]
    assert found == pytest.approx(expected, rel=1e-9)


def test_a_ripple_shakes_a_torsional_oscillator_as_the_closed_form_says():
    # Two inertias on a torsional spring: theta_1 = T (k - w^2 J_2) / det, det = w^2 (w^2 J_1 J_2 - k (J_1 + J_2)).
    text = """
motions = ["torsion"]
[operation]
input_shaft = "motor"
speed = "50 rad/s"
[shafts.motor]
[shafts.fan]
[disks.motor]
shaft = "motor"
at = "start"
mass = 1.0
polar_inertia = 0.2
diametral_inertia = 0.1
[disks.fan]
shaft = "fan"
at = "start"
mass = 1.0
polar_inertia = 1.5
diametral_inertia = 0.1
[couplings.k]
from_shaft = "motor"
to_shaft = "fan"
stiffness = { torsion = 2000.0 }
[loads.drive]
shaft = "motor"
kind = "input"
torque = "80 N m"
ripple = 0.15
ripple_order = 3.0
[loads.brake]
shaft = "fan"
kind = "output"
speed_power = 2.0
"""
    result = rg.response(rg.loads(text), speeds=[30.0, 41.0], method="direct")
    assert result.orders == ("shaft motor 3x",)
    for s, speed in enumerate((30.0, 41.0)):
        w = 3.0 * speed
        k, first, second = 2000.0, 0.2, 1.5
        expected = 12.0 * (k - w**2 * second) / (w**2 * (w**2 * first * second - k * (first + second)))
        found = result.displacement[0, s, result.places.index("disks.motor"), 5]
        assert found == pytest.approx(expected, rel=1e-9)
    assert any(note.part == "loads.brake.speed_power" and "over time" in note for note in result.left_out)


def test_a_transient_settles_on_the_response_to_order_frequency_and_table(tmp_path):
    angles = np.arange(0, 360, 5)
    rows = [f"{a},{40.0 + 30.0 * np.cos(np.radians(2 * a))},{10.0 * np.sin(np.radians(a))}" for a in angles]
    (tmp_path / "pull.csv").write_text("\n".join(["angle_deg,force_x_N,force_z (N)", *rows]))
    text = (
        OSCILLATOR
        + """
[loads.turning]
shaft = "rotor"
at = "start"
force = [0.0, 25.0, 0.0]
order = 1.0
phase = "30 deg"
[loads.buzz]
shaft = "rotor"
at = "start"
force = [0.0, 25.0, 0.0]
frequency = 45.0
[loads.table]
shaft = "rotor"
at = "start"
history = "pull.csv"
"""
    )
    model = rg.loads(text, folder=tmp_path)
    rest = rg.static(model)
    mean = float(np.mean(40.0 + 30.0 * np.cos(np.radians(2 * angles))))
    assert rest.place_displacement["disks.wheel"][0] == pytest.approx(mean / 1e6, rel=1e-9)
    assert any(note.part == "loads.turning" and "harmonic" in note for note in rest.left_out)
    linear = rg.response(model, speeds=[100.0], method="direct")
    history = rg.transient(model, time=0.1 * np.pi, discard=1.5, steps=800, records=50, error_estimate=False)
    w = TURN * linear.frequency_hz[:, 0]
    for axis, weight in enumerate([mean, 0.0, 0.0]):
        waves = np.exp(1j * np.outer(history.time, w)) @ linear.bearing_force[:, 0, 0, axis]
        expected = weight - np.real(waves)  # of the shaft on the bearing
        found = history.history(f"bearings.b force {'xyz'[axis]}")
        late = history.time >= 1.5
        assert np.abs(found - expected)[late].max() < 2e-3 * np.abs(expected).max()


def test_sweeps_take_orders_and_refuse_loads_in_time():
    teeth = Path("models/backlash_pair.toml").read_text()
    model = rg.loads(teeth)
    load = f"shaft = '{model.reference_shaft}'\nat = 'start'\nmoment = [0.0, 0.0, 20.0]\n"
    over = {"operation.speed": [float(model.operation.speed)]}
    swept = rg.sweep(_with(teeth, load + "order = 1.0"), over, discard=20, sample=20)
    plain = rg.sweep(model, over, discard=20, sample=20)
    assert swept.failure == ("",)
    assert not np.allclose(swept.rms_force, plain.rms_force, rtol=1e-6)
    with pytest.raises(rg.RotorgearError, match=r"loads\.pull: sweeps don't take a load of a frequency in Hz"):
        rg.sweep(_with(teeth, load + "frequency = 20.0"), over, discard=20, sample=20)


def test_an_unbalance_in_a_run_up_has_the_force_of_its_acceleration():
    """A heavy disk on hardly any spring moves as the double integral of m e (w^2 cos p + alpha sin p)."""
    text = OSCILLATOR.replace("radial = 1e6", "radial = 1e-3").replace("radial = 200.0", "radial = 0.0")
    model = rg.loads(text + '[unbalances.u]\nshaft = "rotor"\nat = "start"\nmagnitude = "1 kg mm"\n')
    times = np.array([0.0, 0.25])
    speed = [(0.0, "2 rad/s"), (0.25, "402 rad/s")]
    result = rg.transient(model, speed=speed, time=0.25, discard=0.0, steps=400, error_estimate=False)
    t = result.time
    p = 2.0 * t + 800.0 * t**2
    w = 2.0 + 1600.0 * t
    expected = 1e-3 * (w**2 * np.cos(p) + 1600.0 * np.sin(p)) / 10.0
    found = result.history("points.p acceleration")
    inner = t < times[1] * 0.999
    assert np.abs(found - expected)[inner].max() < 1e-3 * np.abs(expected).max()


@pytest.mark.parametrize(
    ("load", "said"),
    [
        ('shaft = "rotor"\nat = "end"\nforce = ["1 N", "2 N"]', "its x, y and z"),
        ('shaft = "rotor"\nat = "end"\nforce = ["1 N", "2 mm", "0 N"]', "a force such as"),
        ('shaft = "rotor"\nat = "600 mm"\nforce = [0, 1, 0]', "loads.pull.at"),
        ('shaft = "rotor"\nforce = [0, 1, 0]', "loads.pull.at"),
        ("force = [0, 1, 0]", "no place"),
        ('point = "tipp"\nforce = [0, 1, 0]', "did you mean 'tip'"),
        ('point = "tip"\nforce = [0, 1, 0]\ntorque = "3 N m"', "not both"),
        ('point = "tip"\nforce = [0, 1, 0]\norder = 1\nfrequency = "3 Hz"', "one of them"),
        ('point = "tip"\nforce = [0, 1, 0]\nphase = "3 deg"', "beside an order"),
        ('shaft = "rotor"', "loads.pull.kind"),
        ('point = "tip"\nhistory = "nowhere.csv"', "there is no"),
    ],
)
def test_a_mistake_in_a_load_is_told_with_address_and_remedy(load, said):
    with pytest.raises(ModelError, match=said):
        _with(CANTILEVER, load)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("time_s,force_x_N\n0,1\n0,2", "h.csv:3 is the same as the row before"),
        ("time_s,force_x_N\n0,1\n\n2,1\n1,2", "h.csv:5 is below that of the row before"),
        ("time_s,force_x_N\n0,1", "at least two rows; h.csv has one"),
        ("time_s,force_x_N\n", "a header and at least one row"),
        ("", "a header and at least one row"),
        ("time_s,force_x_N\n0,1\n1,\n2,3", "leave rows without a value out.*h.csv:3"),
        ("time_s,force_x_N\n0,1\n1,nan\n2,3", "a finite number.*h.csv:3"),
        ("time_s,force_x_N\n0,1\n1,1e400", "a finite number.*h.csv:3"),
        ("time_s,force_x_N\n0,1\n1", "2 cells in each row; h.csv:3 has 1"),
        ("time_s;force_x_N\n0;1\n0,5;2", "a decimal point.*h.csv:3"),
        ("time_s,force_x_m\n0,1\n1,2", "the unit of 'force_x' in its header"),
        ("time_s,angle_deg,force_x_N\n0,0,1\n1,1,2", "one column of time or angle"),
        ("time_s,force_x\n0,1\n1,2", "unit"),
        ("angle_deg,force_x_N\n0,1\n400,2", "beyond"),
        ("angle_deg,force_x_N\n0,1\n360,2", "same values"),
        ("time_s,push_N\n0,1\n1,2", "columns that are known"),
    ],
)
def test_a_mistake_in_a_history_names_the_file(tmp_path, text, said):
    (tmp_path / "h.csv").write_text(text)
    with pytest.raises(ModelError, match=said):
        _with(CANTILEVER, 'point = "tip"\nhistory = "h.csv"', tmp_path)


def _inline(**changed: object) -> dict[str, object]:
    table = {"over": "time", "places": [0.0, 1.0], "components": ["force_y"], "values": [[0.0, 10.0]]}
    return table | changed


@pytest.mark.parametrize(
    ("table", "said"),
    [
        (_inline(components=["force_y", "moment_z"]), "2 lists; it has 1"),
        (_inline(values=[[0.0, 1.0], [2.0, 3.0]]), "1 lists; it has 2"),
        (_inline(values=[[0.0, 1.0, 2.0]]), "2 values of force_y, one at each place; it has 3"),
        (_inline(places=[1.0, 0.0]), "rising places; the one of number 2, 0, is not above 1"),
        (_inline(places=[1.0, 1.0]), "rising places"),
        (_inline(places=[0.0, float("nan")]), "rising places"),
        (_inline(values=[[0.0, float("inf")]]), "finite"),
        (_inline(places=[], values=[[]]), "at least two places; it has 0"),
        (_inline(components=[], values=[]), "components, each once; it has none"),
        (_inline(components=["force_y"] * 2, values=[[0.0, 1.0]] * 2), "each once"),
        (_inline(components=["force_q"]), "components.0.*did you mean"),
        (_inline(over="angle", places=[0.0, 7.0]), "from 0 to below 2 pi"),
        (_inline(over="angle", places=[-0.1, 3.0]), "from 0 to below 2 pi"),
    ],
)
def test_a_mistake_in_a_table_of_a_load_is_told_by_python_and_the_file(table, said):
    with pytest.raises(ModelError, match=said):
        rg.Load(point="tip", history=table)
    with pytest.raises(ModelError, match=said):
        _with(CANTILEVER, 'point = "tip"\nforce = [0, 1, 0]').with_("loads.pull.history", table)


def test_missing_rows_and_impossible_forces_of_a_history_are_asked_about(tmp_path):
    rows = [(0.001 * k, float(k % 7)) for k in (*range(30), *range(300, 330))]
    (tmp_path / "h.csv").write_text("time_s,force_x_MN\n" + "\n".join(f"{t:.3f},{1e3 * x}" for t, x in rows))
    model = _with(CANTILEVER, 'shaft = "rotor"\nat = "end"\nhistory = "h.csv"', tmp_path)
    found = list(implausible(model.layout))
    assert any("history (no row from 0.029 to 0.3 s): usual is one every 0.001 s" in one for one in found)
    assert any("history (6e+09 N" in one for one in found)
