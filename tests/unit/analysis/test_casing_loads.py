"""Forces of vibration on seats and held places of casings, against the whole mesh with the same forces on its seat."""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg as la

import rotorgear as rg
from rotorgear.analysis.response.plant import GroundLoads
from rotorgear.casings.casing import forget
from rotorgear.casings.fe_body import FiniteElementBody, finite_element_body
from rotorgear.casings.file_mesh import NamedSet
from rotorgear.casings.reduced_body import rigid_motions
from rotorgear.model.layout.casings import casing_settings
from rotorgear.system.plan import Plan
from rotorgear.system.system import System
from tests.unit.casings.blocks import block, write_inp

pytest.importorskip("meshio")
# A tenth, a half and nearly all of the lowest frequency of the block on its mount.
SPEEDS = ["200 rad/s", "1500 rad/s", "2600 rad/s"]
MODEL = """
[operation]
input_shaft = "rotor"

[casings.box]
mesh = "box.inp"
unit = "m"
material = "steel"
held = ["foot"]
seats = { left = "high" }
damping_ratio = 0.02

[casings.box.mounts.other]
radial = "2e6 N/m"
axial = "3e6 N/m"
tilt = "1e4 N m/rad"
torsion = "2e4 N m/rad"
damping = { radial = "300 N s/m", axial = "200 N s/m", tilt = "2 N m s/rad" }

[shafts.rotor]
position = ["50 mm", "30 mm"]
start = "200 mm"
sections = [{ length = "100 mm", outer_diameter = "20 mm" }]

[disks]
disk = { shaft = "rotor", at = "end", mass = "2 kg", polar_inertia = "3e-3 kg m^2", diametral_inertia = "2e-3 kg m^2" }

[unbalances]
one = { shaft = "rotor", at = "end", magnitude = "100 g mm" }

[bearings.left]
shaft = "rotor"
at = "start"
stiffness = { radial = "1e8 N/m", axial = "1e8 N/m", tilt = "1e5 N m/rad" }
damping = { radial = "500 N s/m" }
casing = "box"
"""


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> rg.Model:
    folder = tmp_path_factory.mktemp("box")
    patch = pytest.MonkeyPatch()
    patch.setenv("ROTORGEAR_CACHE", str(folder / "cache"))
    forget()
    mesh = block((0.1, 0.06, 0.2), (2, 1, 2))
    low = mesh.sets["low"].nodes
    mesh.sets["foot"] = NamedSet(low[mesh.points[low, 0] < 0.051])
    mesh.sets["other"] = mesh.sets["right"]
    write_inp(folder / "box.inp", mesh)
    found = rg.loads(MODEL, folder=folder)
    found.layout.casing("box")
    patch.undo()
    return found


def whole_mesh(fe: FiniteElementBody, w: float, on_seat: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Wrenches (2, 6) about the origin at the held nodes and at the mount for a force on the seat, by the mesh itself."""
    mount = fe.settings.mounts[0]
    W = fe.mean_weights(fe.mounts)
    stiffness, damper = np.array(mount.stiffness), np.array(mount.damping)
    K = fe.matrices.stiffness.toarray() + W @ stiffness @ W.T
    M = fe.matrices.times_mass(np.eye(fe.dofs))
    free = np.setdiff1d(np.arange(fe.dofs), (3 * fe.held[:, None] + np.arange(3)).ravel())
    squares, modes = la.eigh(K[np.ix_(free, free)], M[np.ix_(free, free)])
    momentum = M[:, free] @ modes
    C = momentum @ np.diag(2.0 * 0.02 * np.sqrt(squares)) @ momentum.T + W @ damper @ W.T
    Z = K + 1j * w * C - w**2 * M
    u = np.zeros(fe.dofs, complex)
    load = fe.mean_weights(fe.seats) @ on_seat
    u[free] = np.linalg.solve(Z[np.ix_(free, free)], load[free])
    R = rigid_motions(fe.mesh.points)
    held = np.zeros_like(R)
    held_dofs = np.setdiff1d(np.arange(fe.dofs), free)
    held[held_dofs] = R[held_dofs]
    of_mount = -(stiffness + 1j * w * damper) @ (W.T @ u)
    return held.T @ (Z @ u - load), (W.T @ R).T @ of_mount


def test_what_holds_a_casing_shakes_as_the_whole_mesh_says(model: rg.Model) -> None:
    fe = finite_element_body(casing_settings(model, "box"))
    found = rg.response(model, speeds=SPEEDS, elements=2)
    assert found.casing_seats == ("box.left",)
    assert found.casing_grounds == ("box.foot", "box.other")
    for s, w in enumerate(found.speeds):
        on_seat = found.casing_seat_force[0, s, 0]
        np.testing.assert_allclose(on_seat[:3], -found.bearing_force[0, s, 0], rtol=1e-9)
        for k, wrench in enumerate(whole_mesh(fe, w, on_seat)):
            here = found.casing_ground_force[0, s, k]
            for part in (slice(0, 3), slice(3, 6)):
                size = np.linalg.norm(wrench[part])
                assert np.linalg.norm(here[part] - wrench[part]) < 1e-4 * size


def test_equal_damping_of_all_modes_brakes_as_damping_by_mass(model: rg.Model) -> None:
    # V diag(alpha) Vᵀ over all modes is alpha M⁻¹: Rayleigh's damping by mass.
    alpha = 80.0
    system = System(model, plan=Plan(1))
    _, modes = la.eigh(system.stiffness(0.0).toarray(), system.mass.toarray())
    by_mass = System(model.with_("damping.rayleigh_alpha", alpha), plan=Plan(1))
    w = np.array([300.0, 2000.0])
    q = np.random.default_rng(1).standard_normal((system.n, 2)) * (1.0 + 0.3j)
    brake = modes @ (alpha * (modes.T @ (system.mass @ q))) * (1j * w)
    without = GroundLoads(system).read(w, q, None)
    of_modes = GroundLoads(system).read(w, q, brake) - without
    expected = GroundLoads(by_mass).read(w, q, None) - without
    assert np.linalg.norm(of_modes - expected) < 1e-6 * np.linalg.norm(expected)
    assert np.linalg.norm(expected) > 0.0
