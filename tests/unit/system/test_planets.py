"""Planets on a carrier that turns: published frequencies, the frame of the carrier, free rotations, shares and weight."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import scipy.linalg as la

import rotorgear as rg
from rotorgear.analysis.static.solve import equilibrate
from rotorgear.system.system import System, flow_system
from tests.planetary import (
    GROUND,
    PIN,
    Springs,
    eigenvalues,
    frequencies,
    helical_stage,
    in_frame_of_the_carrier,
    springs,
)
from tests.turned import turned

# Lin and Parker's example as Cooley and Parker quote it is in the validation cases; here are stages of other numbers.
RATIO = 27 / 126


def of_system(system: System, carrier: float) -> np.ndarray:
    """Eigenvalues with the carrier at a speed in rad/s."""
    speed = carrier / system.train.ratio("carrier")
    K = system.stiffness(speed) + system.circulatory(speed)
    D = system.damping(speed) + speed * system.gyroscopic
    return eigenvalues(system.mass.toarray(), D.toarray(), K.toarray())


@pytest.mark.parametrize(("planets", "teeth"), [(3, (27, 36, 99)), (4, (26, 36, 98)), (5, (24, 26, 76))])
def test_fixed_frame_and_frame_of_the_carrier_differ_by_its_speed(planets: int, teeth: tuple[int, int, int]) -> None:
    system = flow_system(rg.loads(helical_stage(planets, teeth=teeth)))
    W = 310.0
    fixed = frequencies(of_system(system, W))
    turning = in_frame_of_the_carrier(system, W)
    assert len(fixed) == len(turning)
    # A motion of the first class is W faster or slower there, all others are the same.
    shifted = np.concatenate([turning, turning + W, turning - W])
    nearest = np.abs(shifted[None] - fixed[:, None]).min(axis=1)
    assert np.max(nearest / fixed) < 1e-9
    same = np.abs(turning[None] - fixed[:, None]).min(axis=1) < 1e-7 * fixed
    # Motions of the first class: four of x and y and tilts of each central body, and as many of the planets.
    assert 0 < np.count_nonzero(~same) < len(fixed)


def transition(system: System, W: float, angle: float, steps: int) -> np.ndarray:
    """State after the carrier has gone on by an angle, of planets in axes that go round and others in axes that stand still.

    The springs and dampers between them are told in the axes of the carrier, whose directions seen from the others change. Steps
    of fourth order by Magnus, with the commutator at both Gauss points.
    """
    n = system.n
    speed = W / system.train.ratio("carrier")
    own = np.concatenate(
        [6 * system.nodes.at(name, 0.0) + np.arange(6) for name in ("planet#1", "planet#2", "planet#3")]
    )
    central = np.setdiff1d(np.arange(n), own)
    quarter = np.zeros((6, 6))
    quarter[[1, 4], [0, 3]] = 1.0
    quarter[[0, 3], [1, 4]] = -1.0
    S = np.kron(np.eye(n // 6), quarter)
    M = system.mass.toarray()

    going, ground = ({"K": np.zeros((n, n)), "C": np.zeros((n, n))} for _ in "12")
    G = np.zeros((n, n))
    for group in system.groups:
        if group.part.startswith("carriers."):
            continue
        m = group.matrices
        into = going if "#" in group.part else ground
        for dofs in group.dofs[:1]:
            at = np.ix_(dofs, dofs)
            if m.stiffness is not None:
                into["K"][at] += m.stiffness[0]
            if m.damping is not None:
                into["C"][at] += m.damping[0]
            if m.gyroscopic is not None:
                G[at] += group.spin * speed * m.gyroscopic[0]
    planet = system.model.gears["planet#1"]
    r = system.layout.planets[0].radius
    pull = (planet.mass or 0.0) * W**2
    f = pull * r / (1.0 - pull / PIN["radial"])
    node = 6 * system.nodes.at("carrier", 0.0)
    ground["K"][node + 3 : node + 6, node + 3 : node + 6] += 3.0 * f * r * np.diag([0.5, 0.5, 1.0])
    on = np.zeros(n)
    on[own] = 1.0
    P = np.diag(on)
    inertial_K = W**2 * M @ S @ S @ P + W * G @ S @ P
    inertial_C = 2.0 * W * M @ S @ P + G

    def rates(t: float) -> np.ndarray:
        Q = np.eye(n)
        c, s = np.cos(W * t), np.sin(W * t)
        for first in central[::3]:
            Q[first : first + 2, first : first + 2] = [[c, s], [-s, c]]
        moving = -W * S @ (np.eye(n) - P) @ Q
        K = ground["K"] + inertial_K + Q.T @ going["K"] @ Q + Q.T @ going["C"] @ moving
        C = ground["C"] + inertial_C + Q.T @ going["C"] @ Q
        return np.block([[np.zeros((n, n)), np.eye(n)], [-la.solve(M, K), -la.solve(M, C)]])

    h = angle / W / steps
    found = np.eye(2 * n)
    for k in range(steps):
        A, B = (rates((k + 0.5 + side * np.sqrt(3.0) / 6.0) * h) for side in (-1.0, 1.0))
        found = la.expm(0.5 * h * (A + B) + np.sqrt(3.0) / 12.0 * h**2 * (B @ A - A @ B)) @ found
    return found


def test_a_third_of_a_turn_is_that_of_a_gearbox_whose_planets_go_round() -> None:
    """Bearings with preferred directions, and dampers: the state of an own integration, where planets stand elsewhere later."""
    ground: dict[str, Springs] = {name: {**values, "y": 1.6 * values["y"]} for name, values in GROUND.items()}
    system = flow_system(rg.loads(helical_stage(ground=ground, loss=2e-6)))
    W = 1500.0
    third = 2.0 * np.pi / 3.0
    speed = W / system.train.ratio("carrier")
    M = system.mass.toarray()
    K = (system.stiffness(speed) + system.circulatory(speed)).toarray()
    D = (system.damping(speed) + speed * system.gyroscopic).toarray()
    n = system.n
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-la.solve(M, K), -la.solve(M, D)]])
    found = la.expm(A * third / W)

    own = transition(system, W, third, 80)
    nodes = [6 * system.nodes.at(f"planet#{k}", 0.0) + np.arange(6) for k in (1, 2, 3)]
    # After a third of a turn planet 1 stands at the direction that the second coordinate is of.
    moved = np.eye(n)
    moved[np.concatenate(nodes)] = 0.0
    T = np.zeros((n, n))
    for i in range(3):
        moved[nodes[(i + 1) % 3], nodes[i]] = 1.0
        for j in range(3):
            T[np.ix_(nodes[i], nodes[j])] = np.eye(6) * 2.0 / 3.0 * np.sin(third * (i - j))
    # The rate of a planet in its own axes is that of the coordinates at fixed directions without W T p.
    turning = np.eye(2 * n)
    turning[n:, :n] = -W * T
    wanted = np.linalg.solve(turning, np.kron(np.eye(2), moved) @ own @ turning)
    assert np.abs(found - wanted).max() < 1e-5 * np.abs(found).max()


def test_the_train_turns_freely_at_any_speed_of_its_carrier() -> None:
    """Without the loads of the pins its rotation would grow by hundreds a second."""
    system = flow_system(rg.loads(helical_stage(4, teeth=(26, 36, 98), loss=3e-6)))
    for W in (0.0, 150.0, 900.0):
        s = of_system(system, W)
        slow = np.sort(np.abs(s))[:2]
        assert np.all(slow < 1e-2)
        assert np.all(s.real < 1e-2)
        assert np.count_nonzero(np.abs(s) < 1.0) == 2


def test_modes_know_the_free_rotation_and_no_mode_grows() -> None:
    model = rg.loads(helical_stage(loss=3e-6, speed="6000 rpm"))
    found = rg.modal(model, speed="6000 rpm", modes=8)
    assert found.rigid.tolist() == [True] + [False] * 7
    assert np.all(found.damping_ratio[1:] > 0.0)
    assert not [text for text in found.warnings if "unstable" in text]


def shares(
    planets: int, floating: bool, more: str, k: float = 4.2e8, k_ring: float = 6.1e8, pin: float = 1.7e8
) -> np.ndarray:
    """Forces of the sun's meshes of a planar stage on rigid ring and carrier under 500 N m."""
    sun = '["tilt_x", "tilt_y"]' if floating else '["x", "y", "tilt_x", "tilt_y"]'
    parts = [
        'motions = ["bending", "torsion"]\n[operation]\ninput_shaft = "sun"\ntorque = 500\noutput_shaft = "ring"',
        "[shafts.sun]\n[shafts.ring]\n[shafts.carrier]\nspeed_ratio = 0",
        '[shafts.planet]\ncarrier = "st"',
        f'[carriers.st]\nshaft = "carrier"\nat = 0\nplanets = {planets}\nradius = 0.09\n{more}',
    ]
    for name, radius in (("sun", 0.041), ("planet", 0.047), ("ring", 0.135)):
        inside = "internal = true\n" if name == "ring" else ""
        parts.append(
            f'[gears.{name}]\nkind = "spur"\nshaft = "{name}"\nat = 0\nbase_radius = {radius}\n{inside}'
            'transverse_pressure_angle = "22 deg"\nmass = 1\npolar_inertia = 0.001\ndiametral_inertia = 0.001'
        )
    parts.append(f'[meshes.sp]\npinion = "sun"\ngear = "planet"\nstiffness = {k}')
    parts.append(f'[meshes.pr]\npinion = "planet"\ngear = "ring"\nstiffness = {k_ring}')
    parts.append(f'[bearings.pin]\nshaft = "planet"\nat = 0\nstiffness = {springs({"radial": pin, "tilt": 1e3})}')
    parts += [f'[supports.{name}]\nshaft = "{name}"\nat = 0\nfixed = ["all"]' for name in ("carrier", "ring")]
    parts.append(f'[supports.sun]\nshaft = "sun"\nat = 0\nfixed = {sun}')
    found = rg.static(rg.loads("\n".join(parts)))
    assert found.mesh_force[planets:] == pytest.approx(found.mesh_force[:planets], rel=1e-9)  # planets turn freely
    return np.asarray(found.mesh_force[:planets])


@pytest.mark.parametrize("planets", [3, 4, 5])
@pytest.mark.parametrize("floating", [True, False])
@pytest.mark.parametrize("number", [1, 3])
def test_shares_of_planets_by_closed_form(planets: int, floating: bool, number: int) -> None:
    """F = T/(N r_s) + P e/c, c = 1/k_sp + 1/k_pr + 4 cos^2 a/k_pin; P takes out what a sun that turns and floats gives way to."""
    tangential = 15e-6
    off = [[tangential, 7e-6] if i == number - 1 else [0.0, -4e-6] for i in range(planets)]
    found = shares(planets, floating, f"pin_errors = {off}")
    cosine = np.cos(np.deg2rad(22.0))
    c = 1 / 4.2e8 + 1 / 6.1e8 + 4 * cosine**2 / 1.7e8
    error = np.zeros(planets)
    error[number - 1] = -2.0 * cosine * tangential
    psi = 2.0 * np.pi / planets * np.arange(planets)
    taken = np.column_stack([np.ones(planets), np.cos(psi), np.sin(psi)][: 3 if floating else 1])
    rest = error - taken @ np.linalg.lstsq(taken, error)[0]
    assert found == pytest.approx(500 / (planets * 0.041) + rest / c, rel=1e-8)
    if planets == 3 and floating:
        assert found == pytest.approx(np.full(3, found.mean()), rel=1e-9)


def test_bearings_to_the_ground_carry_the_weight_of_planets_that_go_round() -> None:
    W = 600.0
    text = helical_stage(loss=2e-6, speed=f"{W / RATIO} rad/s")
    torque = text.replace("[operation]", '[operation]\ntorque = 9000\noutput_shaft = "carrier"')
    heavy = rg.loads(torque.replace("[operation]", "[operation]\ngravity = [2.0, -9.0, 1.0]"))
    light = rg.loads(torque)
    both: list[Any] = [equilibrate(flow_system(model), W / RATIO) for model in (heavy, light)]
    q = both[0].q - both[1].q
    system = both[0].system
    mass = 2.6 + 9.0 + 14.0 + 3 * 2.2
    carried = np.zeros(3)
    for name, springs_of in GROUND.items():
        node = 6 * system.nodes.at(name, 0.0)
        carried += [springs_of[key] * q[node + k] for k, key in enumerate(("x", "y", "axial"))]
    assert carried == pytest.approx(mass * np.array([2.0, -9.0, 1.0]), rel=1e-9)


def test_two_planets_and_unequal_ones_are_refused_where_their_carrier_turns() -> None:
    two = rg.loads(helical_stage(2))
    assert rg.modal(two, modes=4).natural_frequency_hz[1] > 0.0
    with pytest.raises(rg.AnalysisError, match=r"carriers\.stage: coefficients of two planets on a carrier that turns"):
        flow_system(two).stiffness(100.0)
    unequal = rg.loads(helical_stage(more='[bearings."pin#2"]\nstiffness = {radial = 3e8, axial = 1e8, tilt = 2e5}'))
    with pytest.raises(rg.AnalysisError, match=r"bearings\.pin#2: its stiffness differs from that of bearings\.pin#1"):
        flow_system(unequal).stiffness(100.0)
    with pytest.raises(rg.AnalysisError, match=r"stiffness of bearings\.pin#2 is not that of bearings\.pin#1"):
        rg.modal(unequal, speed="1000 rpm")


def test_a_planet_that_its_pin_does_not_hold_is_refused() -> None:
    soft = {**PIN, "radial": 1e5}
    with pytest.raises(rg.AnalysisError, match=r"shafts\.planet: at .* the centrifugal load grows faster"):
        rg.modal(rg.loads(helical_stage(pin=soft)), speed=f"{300.0 / RATIO} rad/s")


def test_in_torsion_alone_planets_go_round_with_their_carrier() -> None:
    """A stage between two flywheels on rigid teeth: the carrier has I_c + N m r^2, and turns freely at any speed."""
    stiff = (
        helical_stage(ground={"ring": {"torsion": 2e13}})
        .replace("600000000.0", "6e14")
        .replace("750000000.0", "7.5e14")
    )
    shaft = '[shafts.wheel]\n[disks.wheel]\nshaft = "wheel"\nat = 0\nmass = 1\npolar_inertia = 0.4\ndiametral_inertia = 0.2\n'
    coupling = (
        '[couplings.c]\nfrom_shaft = "wheel"\nfrom_at = 0\nto_shaft = "sun"\nto_at = 0\nstiffness = {torsion = 3e5}'
    )
    model = rg.loads('motions = ["torsion"]\n' + stiff + "\n" + shaft + coupling)
    ratios = {name: float(ratio) for name, ratio in model.layout.train.ratios.items()}
    r = model.layout.planets[0].radius
    train = 0.0029 + ratios["carrier"] ** 2 * (0.11 + 3 * 2.2 * r**2) + 3 * 0.0046 * ratios["planet#1"] ** 2
    wanted = np.sqrt(3e5 * (1 / 0.4 + 1 / train))
    for speed in (0.0, 900.0):
        system = flow_system(model)
        s = eigenvalues(system.mass.toarray(), np.zeros((system.n, system.n)), system.stiffness(speed).toarray())
        assert np.sort(s.imag[s.imag > 10.0])[0] == pytest.approx(wanted, rel=1e-6)
        assert np.abs(s).min() < 1.0


def test_a_stage_turned_in_space_has_the_same_modes_and_forces() -> None:
    text = helical_stage(loss=2e-6).replace("[operation]", "[operation]\ngravity = [1.0, -9.0, 3.0]\ntorque = 400")
    model = rg.loads(text.replace("torque = 400", 'torque = 400\noutput_shaft = "carrier"'))
    moved = turned(model)
    here = rg.modal(model, speed="4000 rpm", modes=12)
    there = rg.modal(moved, speed="4000 rpm", modes=12)
    assert there.frequency_hz[1:] == pytest.approx(here.frequency_hz[1:], rel=1e-9)
    assert there.damping_ratio[1:] == pytest.approx(here.damping_ratio[1:], rel=1e-6)
    assert rg.static(moved).mesh_force == pytest.approx(rg.static(model).mesh_force, rel=1e-8)


def test_a_carrier_that_turns_faster_than_its_planets_vibrate_makes_a_mode_grow_and_it_is_said() -> None:
    model = rg.loads(helical_stage())
    W = 2.0 * np.pi * 1e5 / 60.0
    s = of_system(flow_system(model), W)
    growing = s[(s.real > 1.0) & (s.imag > 0.0)]
    slowest = growing[np.argmin(growing.imag)]
    found = rg.modal(model, speed=W / RATIO, modes=8)
    worst = int(np.argmin(found.damping_ratio))
    assert found.damping_ratio[worst] == pytest.approx(-slowest.real / abs(slowest), rel=1e-6)
    assert any("unstable" in str(text) for text in found.warnings)


def test_many_planets_on_stiff_pins_turn_freely() -> None:
    stiff = {name: 1e6 * value for name, value in PIN.items()}
    model = rg.loads(helical_stage(12, teeth=(90, 18, 126), pin=stiff))
    found = rg.modal(model, speed="3000 rpm", modes=6)
    assert found.rigid.tolist() == [True] + [False] * 5
    exact = frequencies(of_system(flow_system(model), 3000.0 * 2.0 * np.pi / 60.0 * 90 / 216))
    assert 2.0 * np.pi * found.frequency_hz[1:] == pytest.approx(exact[:5], rel=1e-6)


def test_planets_that_nothing_keeps_upright_tilt_freely_at_rest_and_not_where_they_go_round() -> None:
    model = rg.loads(helical_stage(pin={"radial": 4e8}))
    system = flow_system(model)
    speed = 4000.0 * 2.0 * np.pi / 60.0
    found = rg.modal(model, speed=speed, modes=9)
    s = of_system(system, speed * RATIO)
    exact = np.sort(s.imag[(s.imag > 1.0) & (np.abs(s) < 1500.0)])
    told = 2.0 * np.pi * np.sort(found.frequency_hz[found.frequency_hz > 0.1])[: len(exact)]
    assert len(exact) >= 5
    assert told == pytest.approx(exact, rel=1e-5)
    # Unheld tilts are a motion that grows: it is said, and not taken for a free one.
    assert any("unstable" in str(text) for text in found.warnings)


def test_statics_of_two_planets_at_a_speed_says_what_it_leaves_out() -> None:
    text = helical_stage(2, teeth=(28, 36, 100))
    found = rg.static(rg.loads(text.replace("[operation]", '[operation]\ntorque = 100\noutput_shaft = "carrier"')))
    assert found.mesh_force == pytest.approx(np.full(4, found.mesh_force[0]), rel=1e-6)
    assert any("carriers" in str(note) for note in found.left_out)


def test_planets_have_one_mesh_however_their_modes_are_combined() -> None:
    """Of two modes of one frequency each moves some planets more: meshes that differ would be no sisters at a speed."""
    model = rg.load("models/wind_turbine.toml")
    for speed in (None, "16 rpm"):
        found = rg.modal(model, speed=speed, modes=40, accuracy=1e-5)
        meshes: dict[tuple[str, float, float], set[tuple[int, int]]] = {}
        for piece in found.discretisation:
            name = piece.shaft.partition("#")[0]
            meshes.setdefault((name, round(piece.start, 9), round(piece.end, 9)), set()).add(
                (piece.elements, piece.order)
            )
        assert all(len(cuts) == 1 for cuts in meshes.values())
        assert any(order > 2 for cuts in meshes.values() for _, order in cuts)


def test_modes_up_to_a_frequency_are_those_of_a_number() -> None:
    model = rg.load("models/wind_turbine.toml")
    below = rg.modal(model, speed="16 rpm", fmax=1200.0, elements=1)
    some = rg.modal(model, speed="16 rpm", modes=len(below) + 3, elements=1)
    assert below.frequency_hz[-1] < 1200.0 < some.natural_frequency_hz[len(below)]
    assert some.eigenvalues[1 : len(below)] == pytest.approx(below.eigenvalues[1:], rel=1e-9)
