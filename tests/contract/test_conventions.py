"""Every line of docs/conventions.md; those of the mesh, C13 to C19, stand in test_conventions_of_the_mesh.py."""

from __future__ import annotations

import re
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
import scipy.integrate as integrate
import scipy.linalg as la

import rotorgear as rg
from rotorgear.elements.bodies import rigid_body
from rotorgear.elements.matrices import ElementMatrices
from rotorgear.elements.shaft import shaft_elements
from rotorgear.elements.shaft_section import cowper
from rotorgear.elements.spring import rigid_transfer
from rotorgear.quantity import RPM_PER_RAD_S, parse_quantity
from rotorgear.system.system import System
from tests.models import (
    NU,
    RHO,
    STEEL,
    E,
    G,
    bearing,
    cantilever,
    clamp,
    disk,
    elements,
    lumped_gear,
    lumped_pair,
    rigid_motions,
    static,
)
from tests.paths import ROOT, SHIPPED

SPLIT_TORQUE = ROOT / "models" / "split_torque.toml"


def stiffness(matrices: ElementMatrices) -> np.ndarray:
    """The stiffness of the first element of a batch."""
    K = matrices.stiffness
    assert K is not None
    return K[0]


def test_every_line_of_the_conventions_has_a_test() -> None:
    lines = re.findall(r"^\* C(\d+)\.", (ROOT / "docs" / "conventions.md").read_text(encoding="utf-8"), re.MULTILINE)
    files = Path(__file__).parent.glob("test_conventions*.py")
    tested = set(
        re.findall(r"^def test_c(\d+)_", "\n".join(f.read_text(encoding="utf-8") for f in files), re.MULTILINE)
    )
    assert len(lines) >= 27
    assert {int(number) for number in lines} == {int(number) for number in tested}


# --- axes and degrees of freedom --------------------------------------------------------------------------------


def test_c01_axes_are_right_handed_and_z_runs_along_every_shaft() -> None:
    turn = np.eye(6)[3:]
    x, y, z = np.eye(3)
    for about, arm, moves in ((z, x, y), (x, y, z), (y, z, x)):
        motion = rigid_transfer(arm) @ (about @ turn)
        np.testing.assert_array_equal(motion[:3], moves)
    system = System(rg.load(SPLIT_TORQUE))
    for shaft in system.model.shafts:
        places = system.positions()[system.nodes.on_shaft(shaft)]
        assert np.ptp(places[:, :2], axis=0).max() == 0.0
        assert np.all(np.diff(places[:, 2]) > 0.0)


def test_c02_a_node_has_the_dofs_x_y_z_tx_ty_tz() -> None:
    mass = rigid_body(7.0, 0.5, 0.3).mass
    assert mass is not None
    np.testing.assert_array_equal(np.diag(mass[0]), [7.0, 7.0, 7.0, 0.3, 0.3, 0.5])
    for number, name in enumerate(("x", "y", "z", "tilt_x", "tilt_y", "torsion")):
        model = rg.Model(shafts={"rotor": {}}, disks={"disk": disk(mass=1.0)}, supports={"hold": clamp(name)})
        held = np.flatnonzero(np.abs(System(model).dofs.transform).sum(axis=1) == 0.0)
        assert held.tolist() == [number]


def test_c03_rotations_are_absolute_so_a_driven_gear_spins_negatively_and_rolls_without_strain() -> None:
    model = lumped_pair(lumped_gear("one", 0.06), lumped_gear("two", 0.15), {})
    system = System(model)
    assert system.train.ratio("two") == pytest.approx(-0.06 / 0.15)
    rolling = np.zeros(12)
    rolling[[5, 11]] = 1.0, system.train.ratio("two")
    strain = next(group.matrices.strain for group in system.groups if group.part == "meshes.pair")
    assert strain is not None
    assert abs(strain[0, 0] @ rolling) < 1e-15


def test_c04_bending_slopes_are_ty_equal_dx_dz_and_tx_equal_minus_dy_dz() -> None:
    L = 0.8
    second_moment = np.pi * 0.04**4 / 64
    model = cantilever({"length": L, "outer_diameter": 0.04}, shear_deformation=False)
    slope = L**2 / (2 * E * second_moment)
    to_x = static(model, "rotor", L, {0: 1.0})
    to_y = static(model, "rotor", L, {1: 1.0})
    assert to_x[[0, 4]] == pytest.approx([L**3 / (3 * E * second_moment), slope], rel=1e-10, abs=0)
    assert to_y[[1, 3]] == pytest.approx([L**3 / (3 * E * second_moment), -slope], rel=1e-10, abs=0)
    assert np.abs(to_x[[1, 3]]).max() == 0.0
    assert np.abs(to_y[[0, 4]]).max() == 0.0


def test_c05_plain_numbers_are_si_and_texts_carry_their_unit() -> None:
    for text, dimension, si in (
        ("20 mm", "length", 0.02),
        ("1500 rpm", "speed", 50 * np.pi),
        ("2 deg", "angle", np.pi / 90),
    ):
        assert parse_quantity(text, dimension) == pytest.approx(si, rel=1e-15)
        assert parse_quantity(si, dimension) == si
    plain = cantilever({"length": 0.5, "outer_diameter": 0.03})
    written = cantilever({"length": "500 mm", "outer_diameter": "3 cm"})
    assert plain.shafts == written.shafts


# --- equation of motion --------------------------------------------------------------------------------


def overhung(**support: float) -> rg.Model:
    """A disk on a rigid point that can only tilt, on springs."""
    return rg.Model(
        shafts={"rotor": {}},
        disks={"disk": disk(mass=1.0, polar=0.08, tilt=0.05)},
        supports={"hold": clamp("x", "y", "z", "torsion")},
        bearings={"springs": bearing(**support)},
    )


def test_c06_reported_modes_solve_the_equation_of_motion_with_the_spin_of_the_input_shaft() -> None:
    model = rg.load(ROOT / "models" / "geared_pair.toml")
    speed = 157.0
    system = System(model, 2)
    result = rg.modal(system, speed=speed, modes=12, error_estimate=False)
    M = system.mass
    C = system.damping(speed)
    Gy = system.gyroscopic
    K = system.stiffness(speed)
    for s, shape in zip(result.eigenvalues[1:], np.moveaxis(result.shapes, 2, 0)[1:], strict=True):
        q = system.dofs.transform.T @ shape.ravel()
        parts = [s**2 * (M @ q), s * (C @ q), s * speed * (Gy @ q), K @ q]
        assert la.norm(sum(parts)) < 1e-9 * max(la.norm(part) for part in parts)


def test_c07_a_spinning_disk_splits_its_tilt_frequency_by_the_closed_form() -> None:
    matrices = rigid_body(1.0, 0.08, 0.05)
    assert matrices.gyroscopic is not None
    assert matrices.gyroscopic[0][3, 4] == 0.08
    assert matrices.gyroscopic[0][4, 3] == -0.08
    k = 1e5
    speed = 700.0
    result = rg.modal(overhung(tilt=k), speed=speed, modes=2)
    root = np.sqrt((speed * 0.08) ** 2 + 4 * 0.05 * k)
    expected = (root + np.array([-1.0, 1.0]) * speed * 0.08) / (2 * 0.05)
    np.testing.assert_allclose(2 * np.pi * result.frequency_hz, expected, rtol=1e-12)
    assert result.whirl == ("backward", "forward")


@pytest.mark.parametrize("file", SHIPPED)
def test_c07_the_gyroscopic_matrix_is_skew_and_mass_and_stiffness_are_symmetric_and_positive(file: Path) -> None:
    system = System(rg.load(file))
    Gy = system.gyroscopic.toarray()
    assert np.array_equal(Gy, -Gy.T)
    for A in (system.mass.toarray(), system.stiffness().toarray()):
        np.testing.assert_allclose(A, A.T, rtol=0, atol=1e-14 * np.abs(A).max())
        scale = np.sqrt(np.where(np.diag(A) > 0.0, np.diag(A), 1.0))
        assert la.eigvalsh(A / np.outer(scale, scale)).min() > -1e-10


def test_c08_each_shaft_spins_at_its_own_ratio_whose_sign_alternates_at_each_mesh() -> None:
    gears = {name: lumped_gear(name, radius) for name, radius in (("a", 0.05), ("b", 0.1), ("c", 0.02))}
    mesh = {"stiffness": 1e8, "centre_line_angle": 0.0, "pressure_angle": 0.35}
    model = rg.Model(
        shafts={name: {} for name in gears},
        gears=gears,
        meshes={"ab": {"pinion": "a", "gear": "b", **mesh}, "bc": {"pinion": "b", "gear": "c", **mesh}},
    )
    system = System(model)
    ratios = np.array([system.train.ratio(name) for name in gears])
    np.testing.assert_allclose(ratios, [1.0, -0.5, 2.5])
    blocks = [system.gyroscopic.toarray()[6 * k + 3, 6 * k + 4] for k in range(3)]
    np.testing.assert_allclose(blocks, 0.02 * ratios)


def test_c09_whirl_is_forward_in_the_sense_of_the_shafts_own_spin() -> None:
    model = overhung(tilt=1e5)
    for speed in (700.0, -700.0):
        result = rg.modal(model, speed=speed, modes=2)
        assert result.whirl == ("backward", "forward")
        assert result.whirl_by_shaft["rotor"] == pytest.approx([-1.0, 1.0])
        # e^{+iwt}: positive precession has ty = -i tx
        tx = result.shapes[0, 3]
        ty = result.shapes[0, 4]
        np.testing.assert_allclose(ty / tx, np.sign(speed) * np.array([1j, -1j]), atol=1e-9)
    parts = {"disk": disk("two", mass=1.0, polar=0.08, tilt=0.05)}
    held = {"one": clamp(shaft="one"), "two": clamp("x", "y", "z", "torsion", shaft="two")}
    driven = lumped_pair(
        lumped_gear("one", 0.06),
        lumped_gear("two", 0.06, mass=0.0, polar_inertia=0.0, diametral_inertia=0.0),
        {},
        disks=parts,
        supports=held,
        bearings={"springs": bearing("two", tilt=1e5)},
    )
    result = rg.modal(driven, speed=700.0, modes=2)
    assert result.whirl == ("backward", "forward")
    two = result.nodes.on_shaft("two")[0]
    np.testing.assert_allclose(result.shapes[two, 4] / result.shapes[two, 3], [-1j, 1j], atol=1e-9)


# --- shaft element --------------------------------------------------------------------------------


def test_c10_rigid_motions_of_a_shaft_are_free_of_strain() -> None:
    for diameters in ((0.05, 0.0), (0.05, 0.02), (0.08, 0.01, 0.04, 0.03)):
        K = stiffness(shaft_elements(elements(0.3, *diameters)))
        R = rigid_motions(np.array([[0.0, 0.0, -0.1], [0.0, 0.0, 0.2]]))
        assert np.abs(K @ R).max() < 1e-12 * np.abs(K).max() * np.abs(R).max()


def test_c10_one_uniform_element_deflects_exactly_under_end_loads() -> None:
    L = 0.3
    d = 0.06
    b = 0.02
    A = np.pi / 4 * (d**2 - b**2)
    EI = E * np.pi / 64 * (d**4 - b**4)
    kappa = float(cowper(NU, b / d))
    model = cantilever({"length": L, "outer_diameter": d, "bore": b})
    force = static(model, "rotor", L, {0: 1.0})
    moment = static(model, "rotor", L, {4: 1.0})
    assert force[[0, 4]] == pytest.approx([L**3 / (3 * EI) + L / (kappa * G * A), L**2 / (2 * EI)], rel=1e-11, abs=0)
    assert moment[[0, 4]] == pytest.approx([L**2 / (2 * EI), L / EI], rel=1e-11, abs=0)
    assert static(model, "rotor", L, {2: 1.0})[2] == pytest.approx(L / (E * A), rel=1e-12, abs=0)
    assert static(model, "rotor", L, {5: 1.0})[5] == pytest.approx(L * E / (2 * G * EI), rel=1e-12, abs=0)


def cone() -> dict[str, float]:
    return {"length": 0.3, "outer_diameter": 0.08, "outer_diameter_end": 0.03, "bore": 0.02, "bore_end": 0.01}


def test_c10_one_conical_element_deflects_as_the_integral_over_its_length() -> None:
    L = 0.3

    def section(s: float) -> tuple[float, float, float]:
        outer = 0.08 - 0.05 * s / L
        inner = 0.02 - 0.01 * s / L
        return np.pi / 4 * (outer**2 - inner**2), np.pi / 64 * (outer**4 - inner**4), float(cowper(NU, inner / outer))

    def give(s: float) -> float:
        area, second_moment, kappa = section(s)
        return (L - s) ** 2 / (E * second_moment) + 1.0 / (kappa * G * area)

    model = cantilever(cone())
    bending = integrate.quad(give, 0.0, L, epsrel=1e-12)[0]
    twist = integrate.quad(lambda s: 1.0 / (2 * G * section(s)[1]), 0.0, L, epsrel=1e-12)[0]
    assert static(model, "rotor", L, {1: 1.0})[1] == pytest.approx(bending, rel=1e-9, abs=0)
    assert static(model, "rotor", L, {5: 1.0})[5] == pytest.approx(twist, rel=1e-9, abs=0)


def test_c10_a_cone_is_the_limit_of_many_cylinders() -> None:
    exact = static(cantilever(cone()), "rotor", 0.3, {0: 1.0})[0]
    errors = []
    for count in (40, 80):
        middle = (np.arange(count) + 0.5) / count
        steps = [{"length": 0.3 / count, "outer_diameter": 0.08 - 0.05 * s, "bore": 0.02 - 0.01 * s} for s in middle]
        errors.append(abs(static(cantilever(*steps), "rotor", 0.3, {0: 1.0})[0] / exact - 1.0))
    assert errors[1] < 1e-3
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2.0, abs=0.05)


def test_c11_the_shear_coefficient_is_cowpers_unless_given() -> None:
    assert cowper(0.3, 0.0) == pytest.approx(6 * 1.3 / (7 + 6 * 0.3), rel=1e-15)
    assert cowper(0.3, 1.0) == pytest.approx(2 * 1.3 / (4 + 3 * 0.3), rel=1e-15)  # a thin tube
    assert cowper(0.3, 0.5) == pytest.approx(6 * 1.3 * 1.25**2 / (8.8 * 1.25**2 + 23.6 * 0.25), rel=1e-15)
    default = elements(0.1, 0.05, 0.025)
    given = elements(0.1, 0.05, 0.025, kappa=float(cowper(NU, 0.5)))
    np.testing.assert_allclose(stiffness(shaft_elements(default)), stiffness(shaft_elements(given)), rtol=1e-13)
    other = stiffness(shaft_elements(elements(0.1, 0.05, 0.025, kappa=0.5)))
    assert other[0, 0] < 0.95 * stiffness(shaft_elements(default))[0, 0]


def test_c12_internal_damping_is_eta_k_and_turns_with_the_shaft() -> None:
    eta = 3e-5
    matrices = shaft_elements(elements(0.2, 0.05, 0.0), internal_damping=eta)
    K = stiffness(matrices)
    assert matrices.damping is not None
    assert matrices.circulatory_per_speed is not None
    np.testing.assert_allclose(matrices.damping[0], eta * K, atol=1e-12 * eta * np.abs(K).max())
    # Lateral displacements and tilts turn by +90 degrees about z, x to y; axial motion and torsion drop out.
    turn = np.kron(np.eye(4), [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    np.testing.assert_allclose(matrices.circulatory_per_speed[0], -eta * K @ turn, atol=1e-9 * eta)
    np.testing.assert_array_equal(turn[:6, :6] @ np.eye(6)[0], np.eye(6)[1])


@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_c12_internal_damping_destabilises_forward_whirl_above_the_threshold_of_the_jeffcott_rotor(
    sense: float,
) -> None:
    eta = 2e-4
    mass = 10.0
    k = 48 * E * (np.pi * 0.02**4 / 64)
    external = 0.5 * eta * k
    model = rg.Model(
        motions=["bending"],
        materials={"light": {**STEEL["steel"], "density": 1e-6}},
        shafts={
            "rotor": {
                "material": "light",
                "sections": [{"length": 1.0, "outer_diameter": 0.02}],
                "internal_damping": eta,
                "shear_deformation": False,
            }
        },
        disks={"disk": disk(at=0.5, mass=mass)},
        supports={
            "left": clamp("x", "y"),
            "right": clamp("x", "y", at="end"),
            "dashpot": {"shaft": "rotor", "at": 0.5, "damping": {"radial": external}},
        },
    )
    critical = np.sqrt(k / mass)
    threshold = critical * (1.0 + external / (eta * k))  # stable up to w (1 + c_external/c_internal)
    for speed, stable in ((0.5 * critical, True), (0.999 * threshold, True), (1.001 * threshold, False)):
        result = rg.modal(model, speed=sense * speed, modes=2, elements=1)
        forward = result.whirl.index("forward")
        assert (result.eigenvalues.real[forward] < 0.0) is np.bool_(stable)
        assert result.eigenvalues.real[1 - forward] < 0.0


# --- gear train --------------------------------------------------------------------------------


def test_c20_speeds_follow_from_teeth_and_a_closed_loop_gives_one_ratio_in_whole_numbers() -> None:
    text = SPLIT_TORQUE.read_text(encoding="utf-8")
    train = System(rg.loads(text)).train
    assert train.ratios["branch_a"] == train.ratios["branch_b"] == Fraction(-29, 113)
    assert train.ratios["output"] == Fraction(29 * 26, 113 * 125)
    with pytest.raises(rg.ModelError, match="closed loop"):
        loop(1e8, 1e8, wheel_a=0.151)


@pytest.mark.parametrize("direction", [1, -1])
def test_c21_input_torque_acts_with_the_rotation_and_output_torque_against_it_and_power_balances(
    direction: int,
) -> None:
    model = rg.load(SPLIT_TORQUE)
    system = System(model, state=model.torque_flow(direction))
    speed = direction * 16350 / RPM_PER_RAD_S
    torques = {item.shaft: item.torque for item in system.state.applied}
    powers = {shaft: torque * speed * system.train.ratio(shaft) for shaft, torque in torques.items()}
    assert powers["input"] == pytest.approx(2.5e6, rel=1e-12)
    assert powers["output"] == pytest.approx(-2.5e6, rel=1e-12)
    assert np.sign(torques["input"]) == direction


def loop(first: float, second: float, wheel_a: float = 0.15) -> rg.Model:
    """A split-torque train of rigid points, spur gears in torsion: stiffness of the two meshes of branch a; 1e8 in branch b."""
    gears = {"sun": lumped_gear("input", 0.05), "bull": lumped_gear("output", 0.2)}
    meshes = {}
    for branch, k1, k2 in (("a", first, second), ("b", 1e8, 1e8)):
        gears |= {
            f"wheel_{branch}": lumped_gear(branch, wheel_a if branch == "a" else 0.15),
            f"pinion_{branch}": lumped_gear(branch, 0.04),
        }
        meshes[f"one_{branch}"] = {"pinion": "sun", "gear": f"wheel_{branch}", "stiffness": k1}
        meshes[f"two_{branch}"] = {"pinion": f"pinion_{branch}", "gear": "bull", "stiffness": k2}
    operation = {"input_shaft": "input", "output_shaft": "output", "torque": 100.0}
    shafts: dict[str, dict[str, float]] = {name: {} for name in ("input", "a", "b", "output")}
    return rg.Model(motions=["torsion"], operation=operation, shafts=shafts, gears=gears, meshes=meshes)


def test_c22_in_a_loop_the_torque_splits_by_stiffness_and_driving_flanks_follow_the_torque() -> None:
    flow = System(loop(4e7, 2.5e7)).state
    force = {item.contact.mesh: item.normal_force for item in flow.forces}
    step = 0.15 / 0.04  # force on the second mesh over that on the first
    give_a = 1 / 4e7 + step**2 / 2.5e7
    give_b = 1 / 1e8 + step**2 / 1e8
    assert force["one_a"] + force["one_b"] == pytest.approx(100.0 / 0.05, rel=1e-12)
    assert force["one_a"] / force["one_b"] == pytest.approx(give_b / give_a, rel=1e-10)
    assert force["two_a"] == pytest.approx(step * force["one_a"], rel=1e-10)
    assert all(item.pinion_drives and not item.assumed for item in flow.forces)
    sense = {item.contact.mesh: item.torque_sense for item in flow.forces}
    assert sense == {"one_a": 1, "one_b": 1, "two_a": -1, "two_b": -1}  # the branches turn negatively and drive


def test_c22_without_torque_the_shaft_nearer_to_the_input_drives() -> None:
    for first, drives in (("pinion", True), ("wheel", False)):
        shaft = {"pinion": "one", "wheel": "two"}[first]
        model = lumped_pair(lumped_gear("one", 0.06), lumped_gear("two", 0.1), {}, operation={"input_shaft": shaft})
        (force,) = System(model).state.forces
        assert force.assumed
        assert force.pinion_drives is drives
        assert force.torque_sense == 1  # input wheel turns positively, its pinion negatively, and resists


# --- supports --------------------------------------------------------------------------------


def test_c23_a_bearing_puts_its_6x6_to_ground_in_the_order_of_the_dofs() -> None:
    rng = np.random.default_rng(1)
    B, D = rng.standard_normal((2, 6, 6))
    K = B @ B.T + np.diag([3.0] * 6) + 0.3 * (B - B.T)  # positive, and with cross-coupling
    C = D @ D.T
    springs = {"shaft": "rotor", "at": "start", "stiffness": {"matrix": K.tolist()}, "damping": {"matrix": C.tolist()}}
    model = rg.Model(shafts={"rotor": {}}, disks={"disk": disk(mass=1.0)}, bearings={"springs": springs})
    system = System(model)
    np.testing.assert_allclose(system.matrices(0.0).stiffness.toarray(), K, atol=1e-12)
    np.testing.assert_allclose(system.damping().toarray(), C, atol=1e-12)
    named = overhung(x=1.0, y=2.0, xy=3.0, yx=4.0, axial=5.0, tilt_x=6.0, tilt_y=7.0, torsion=8.0)
    rows = named.bearings["springs"].stiffness
    assert rows is not None
    expected = np.diag([1.0, 2.0, 5.0, 6.0, 7.0, 8.0])
    expected[0, 1] = 3.0
    expected[1, 0] = 4.0
    np.testing.assert_array_equal(rows.as_rows(), expected)


def test_c23_a_bearing_with_a_table_is_linear_over_the_speed_of_its_own_shaft_and_never_extrapolated() -> None:
    rows = [{"speed": speed, "stiffness": {"radial": k}} for speed, k in ((100.0, 1e6), (300.0, 3e6), (400.0, 8e6))]
    table = {"shaft": "two", "at": "start", "table": rows}
    model = lumped_pair(lumped_gear("one", 0.06), lumped_gear("two", 0.12), {}, bearings={"table": table})
    system = System(model)  # shaft two turns at half the reference speed
    fixed = System(lumped_pair(lumped_gear("one", 0.06), lumped_gear("two", 0.12), {})).stiffness().toarray()
    for speed, k in ((400.0, 2e6), (-400.0, 2e6), (700.0, 5.5e6)):
        added = system.stiffness(speed).toarray() - fixed
        assert added[6, 6] == pytest.approx(k, rel=1e-6)
    with pytest.raises(rg.AnalysisError, match="table covers"):
        rg.modal(model, speed=1000.0)


def test_c24_a_coupling_is_free_of_strain_in_all_rigid_motions_and_acts_in_the_middle_of_its_gap() -> None:
    values = {"radial": 2e6, "axial": 1e6, "tilt": 3e3, "torsion": 5e4}
    model = rg.Model(
        shafts={"one": {"start": 0.0}, "two": {"start": 0.1}},
        disks={name: disk(name, mass=1.0, polar=0.02, tilt=0.01) for name in ("one", "two")},
        couplings={"joint": {"from_shaft": "one", "to_shaft": "two", "stiffness": values}},
    )
    K = System(model).stiffness().toarray()
    R = rigid_motions(np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.1]]))
    assert np.abs(K @ R).max() < 1e-12 * np.abs(K).max()
    np.testing.assert_allclose(
        K[0, :6], [2e6, 0, 0, 0, 2e6 * 0.05, 0]
    )  # tilt of the first end moves the middle by ty 0.05
    np.testing.assert_allclose(np.diag(K)[[2, 5, 3]], [1e6, 5e4, 3e3 + 2e6 * 0.05**2])
    np.testing.assert_allclose(K[5, 11], -5e4)


def test_c25_a_pedestal_is_in_series_with_its_bearing_and_rigid_where_it_has_no_stiffness() -> None:
    bearing_k = 4e6
    pedestal_k = 1e6
    mass = 3.0
    model = rg.Model(
        shafts={"rotor": {}},
        disks={"disk": disk(mass=mass)},
        supports={"hold": clamp("z", "tilt_x", "tilt_y", "torsion")},
        bearings={"soft": {**bearing(radial=bearing_k), "pedestal": {"stiffness": {"x": pedestal_k}, "mass": 0.0}}},
    )
    result = rg.modal(model, modes=2)
    series = bearing_k * pedestal_k / (bearing_k + pedestal_k)
    np.testing.assert_allclose((2 * np.pi * result.frequency_hz) ** 2 * mass, [series, bearing_k], rtol=1e-12)


# --- modes --------------------------------------------------------------------------------


def test_c26_rigid_modes_are_listed_with_frequency_0_and_asking_for_12_gives_12() -> None:
    for file in ("geared_pair.toml", "helical_pair.toml", "jeffcott.toml"):
        model = rg.load(ROOT / "models" / file)
        for speed in (None, 100.0):
            result = rg.modal(model, speed=speed, modes=12, elements=1)
            assert len(result) == 12
            assert result.rigid.tolist() == [True] + [False] * 11
            assert result.frequency_hz[0] == 0.0
            assert result.description[0].startswith("rigid")
    free = rg.Model(materials=STEEL, shafts={"rotor": {"sections": [{"length": 1.0, "outer_diameter": 0.05}]}})
    assert rg.modal(free, modes=12, elements=4).rigid.tolist() == [True] * 6 + [False] * 6


def oscillator(damping: dict[str, float], **stiffness: float) -> rg.Model:
    """A mass of 2 kg on springs and dampers along x and y."""
    springs = {"shaft": "rotor", "at": "start", "stiffness": stiffness, "damping": damping}
    held = {"hold": clamp("z", "tilt_x", "tilt_y", "torsion")}
    return rg.Model(shafts={"rotor": {}}, disks={"d": disk(mass=2.0)}, supports=held, bearings={"springs": springs})


def test_c27_damping_ratio_and_frequencies_are_those_of_the_oscillator() -> None:
    k = 8e4
    zeta = 0.3
    w = np.sqrt(k / 2.0)
    result = rg.modal(oscillator({"radial": 2 * zeta * 2.0 * w}, radial=k), speed=0.0, modes=2)
    np.testing.assert_allclose(result.damping_ratio, zeta, rtol=1e-10)
    np.testing.assert_allclose(result.natural_frequency_hz, w / (2 * np.pi), rtol=1e-12)
    np.testing.assert_allclose(result.frequency_hz, w * np.sqrt(1 - zeta**2) / (2 * np.pi), rtol=1e-10)


def test_c27_cross_coupling_beyond_the_damping_is_unstable_with_a_negative_ratio() -> None:
    k = 8e4
    cross = 5e3
    w = np.sqrt(k / 2.0)
    for c, unstable in ((1.01 * cross / w, False), (0.99 * cross / w, True)):  # the threshold is c w = k_xy
        result = rg.modal(oscillator({"radial": c}, radial=k, xy=cross, yx=-cross), speed=0.0, modes=2)
        assert (result.damping_ratio.min() < 0.0) is np.bool_(unstable)
        assert result.damping_ratio.max() > 0.0


def test_masses_of_a_shaft_are_those_of_its_volume() -> None:
    model = rg.Model(
        materials=STEEL, shafts={"rotor": {"sections": [{"length": 0.5, "outer_diameter": 0.06, "bore": 0.02}]}}
    )
    system = System(model, 3)
    R = rigid_motions(system.positions())
    inertia = R.T @ system.mass @ R
    mass = RHO * np.pi / 4 * (0.06**2 - 0.02**2) * 0.5
    assert np.diag(inertia)[:3] == pytest.approx([mass] * 3, rel=1e-12)
    assert inertia[5, 5] == pytest.approx(mass * (0.06**2 + 0.02**2) / 8, rel=1e-12)
    assert inertia[3, 3] == pytest.approx(mass * ((0.06**2 + 0.02**2) / 16 + 0.5**2 / 3), rel=1e-12)
