"""Errors of damped, gyroscopic and unstable cases against their references."""

from __future__ import annotations

import mpmath as mp
import numpy as np

import rotorgear as rg
from tests.extreme.models import points, root_error, rotor_model
from tests.extreme.references import Body, Rotor, quadratic_roots, undamped
from tests.extreme.rotors import ALL, even, on


def whirl_error(rotor: Rotor, speed: float) -> float:
    """Error of all eigenvalues in bending at a speed."""
    model = rotor_model(rotor, motions=("bending",))
    return root_error(rg.modal(model, elements=1, modes=ALL, speed=speed), rotor.whirls(speed))


def internal_damping(eta: float, stiffness: float, speed: float) -> float:
    """Bending of a shaft with rotating damping: (s^2 M + s (eta K_s - i W G) + K - i eta W K_s) w = 0."""
    rotor = Rotor(even(), on(stiffness))
    free = Rotor(even())
    M, _, G, K = rotor.bending()
    Ks = free.bending()[3]
    i = mp.mpc(0, 1)
    W = mp.mpf(speed)
    h = mp.mpf(eta)
    roots = quadratic_roots(M, h * Ks - i * W * G, K - i * h * W * Ks)
    model = rotor_model(rotor, internal_damping=eta, motions=("bending",))
    both = [mp.mpc(s.real, abs(s.imag)) for s in roots]
    return root_error(rg.modal(model, elements=1, modes=ALL, speed=speed), both)


def proportional(beta: float, stiffness: float) -> float:
    """C = beta K: each mode by itself, s^2 + beta w^2 s + w^2 = 0, overdamped from beta w = 2 on."""
    rotor = Rotor(even(), on(stiffness))
    M, _, _, K = rotor.bending()
    roots = [s for w in undamped(M, K) for s in polynomial_roots([1, mp.mpf(beta) * w**2, w**2])]
    model = rotor_model(rotor, motions=("bending",), damping=rg.ModelDamping(rayleigh_beta=beta))
    return root_error(rg.modal(model, elements=1, modes=ALL, speed=0.0), roots)


def polynomial_roots(coefficients: list) -> list[mp.mpc]:
    """Roots of a polynomial, highest power first; each with its Im turned positive, as the program lists one of a pair."""
    n = len(coefficients) - 1
    A = mp.zeros(n)
    for i in range(n):
        A[0, i] = -mp.mpmathify(coefficients[i + 1]) / coefficients[0]
        if i:
            A[i, i - 1] = 1
    return [mp.mpc(s.real, abs(s.imag)) for s in mp.eig(A, left=False, right=False)]


def one_mass(stiffness: float, damping: float, cross: float = 0.0, mass: float = 2.0) -> rg.ModalResult:
    """A point mass in a bearing, x and y."""
    bearing = rg.Bearing(
        shaft="p",
        at=0.0,
        stiffness=rg.StiffnessMatrix(radial=stiffness, xy=cross, yx=-cross),
        damping=rg.DampingMatrix(radial=damping),
    )
    supports = {"tilt": rg.Support(shaft="p", at=0.0, fixed=("tilt_x", "tilt_y"))}
    model = rg.Model(
        shafts={"p": rg.Shaft()},
        point_masses={"m": rg.PointMass(shaft="p", at=0.0, mass=mass)},
        bearings={"b": bearing},
        supports=supports,
        motions=("bending",),
    )
    return rg.modal(model, speed=0.0)


def cross_coupled(times_onset: float) -> float:
    """m s^2 + c s + k - i q = 0 and its conjugate; the forward whirl is unstable from q = c sqrt(k/m) on."""
    k = 1e6
    c = 50.0
    m = 2.0
    q = times_onset * c * float(np.sqrt(k / m))
    result = one_mass(k, c, q, m)
    roots = polynomial_roots([m, c, mp.mpc(k, -q)])
    unstable = any("unstable" in sentence for sentence in result.warnings)
    if unstable != (times_onset > 1.0) or np.any(result.eigenvalues.real > 0.0) != unstable:
        return np.inf
    return root_error(result, roots)


def overdamped_mass(stiffness: float, damping: float) -> float:
    result = one_mass(stiffness, damping)
    if np.any(result.damping_ratio != 1.0) or len(result) != 4:
        return np.inf
    return root_error(result, polynomial_roots([2, damping, stiffness]))


def damped_massless() -> float:
    """Disk J on a spring to a massless point, which a spring and a damper hold: a cubic, one root real."""
    J = 2.0
    k1 = 1e5
    k2 = 3e4
    c = 40.0
    hold = rg.Support(shaft="p1", at=0.0, stiffness=rg.StiffnessMatrix(torsion=k2), damping=rg.DampingMatrix(torsion=c))
    model = points([J, 0.0], [k1], supports={"hold": hold})
    roots = polynomial_roots([J * c, J * (k1 + k2), k1 * c, k1 * k2])
    return root_error(rg.modal(model, speed=0.0), roots)


def tables(speed: float) -> rg.ModalResult:
    rotor = Rotor(even(), on(1e8), {2: Body(5.0, 0.1, 0.05)})
    model = rotor_model(rotor, motions=("bending",))
    rows = tuple(
        rg.TableRow(speed=w, stiffness=rg.StiffnessMatrix(radial=k)) for w, k in ((0.0, 1e6), (2e5, 2e8 - 1e6))
    )
    bearings = {name: rg.Bearing(shaft="s", at=b.at, table=rows) for name, b in model.bearings.items()}
    return rg.modal(model.model_copy(update={"bearings": bearings}), speed=speed, elements=1, modes=ALL)


def fast_with_table() -> float:
    """Half way up the table each bearing has 1e8 N/m; at 1e5 rad/s the disk holds its plane."""
    rotor = Rotor(even(), on(1e8), {2: Body(5.0, 0.1, 0.05)})
    return root_error(tables(1e5), rotor.whirls(1e5))


def backwards() -> float:
    """A rotor that turns the other way has the same eigenvalues and the same whirl in its own sense."""
    rotor = Rotor(even(), on(1e7), {1: Body(5.0, 0.1, 0.05)})
    model = rotor_model(rotor, motions=("bending",))
    results = [rg.modal(model, elements=1, modes=12, speed=sign * 1e4) for sign in (1.0, -1.0)]
    if results[0].whirl != results[1].whirl or "forward" not in results[0].whirl:
        return np.inf
    return max(root_error(result, rotor.whirls(1e4)[:12]) for result in results)


def tilting_disk() -> float:
    """A disk that only tilts: J_d s^2 - i W J_p s + k = 0."""
    Jd = 0.02
    Jp = 0.04
    k = 1e-2
    W = 1e5
    model = rg.Model(
        shafts={"p": rg.Shaft()},
        motions=("bending",),
        disks={"d": rg.Disk(shaft="p", at=0.0, mass=1.0, polar_inertia=Jp, diametral_inertia=Jd)},
        supports={"x": rg.Support(shaft="p", at=0.0, fixed=("x", "y"), stiffness=rg.StiffnessMatrix(tilt=k))},
    )
    roots = polynomial_roots([Jd, mp.mpc(0, -W * Jp), k])
    return root_error(rg.modal(model, speed=W), roots)
