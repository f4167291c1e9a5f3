"""Receptances at contacts: in all candidates they are those of the whole system, and static ones are exact in any basis."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse as sp

from rotorgear.forces.mesh_contact import MeshContact
from rotorgear.solvers.frequency.contact_basis import (
    Candidates,
    Probes,
    Scale,
    around,
    basis_of,
    candidates,
    choose,
    difference,
    differences,
    full_receptances,
    reduced,
    reduced_receptances,
)
from rotorgear.solvers.time.local_system import LocalSystem
from validation.oscillators import local_system

N = 14
STIFFNESS = np.array([4e4, 9e4])


def turning_chain(seed: int = 1, spin: float = 2.0) -> LocalSystem:
    """Unequal masses on unequal springs with dampers of no pattern, gyroscopic couplings and two contacts."""
    draw = np.random.default_rng(seed)
    k = draw.uniform(1e4, 4e4, N)
    K = np.diag(k + np.append(k[1:], 0.0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)
    root = draw.standard_normal((N, N))
    first, second = np.eye(N)[[3]].T, (np.eye(N)[[9]] - np.eye(N)[[13]]).T
    laws = [
        (MeshContact(STIFFNESS[0], 8.0, gap="bilateral"), first),
        (MeshContact(STIFFNESS[1], 5.0, gap="bilateral"), second),
    ]
    system = local_system(np.diag(draw.uniform(0.5, 2.0, N)), 0.4 * root @ root.T, K, [0.0] * N, laws)
    skew = draw.standard_normal((N, N))
    return replace(system, G=sp.csc_array(spin * (skew - skew.T)))


def scale_of(system: LocalSystem) -> Scale:
    return Scale(system.forces.reference_stiffness, system.forces.reference_damping, np.sqrt(STIFFNESS))


PROBES = Probes(np.array([0.0, 1.0, 2.0, 3.0]), np.array([0.0, 90j, -20.0 + 150j, -5.0 + 260j]))


def among_of(system: LocalSystem, loads: np.ndarray | None = None) -> Candidates:
    return candidates(system, np.zeros((N, 0)) if loads is None else loads, np.arange(2), N)


def test_receptances_in_all_candidates_are_those_of_the_whole_system_at_any_speed_and_frequency() -> None:
    system = turning_chain()
    full = full_receptances(system, PROBES)
    dense = [
        system.K.toarray()
        + system.B @ np.diag(STIFFNESS) @ system.B.T
        + s * (system.velocity_terms(speed).toarray() + system.B @ np.diag([8.0, 5.0]) @ system.B.T)
        + s**2 * system.M.toarray()
        for speed, s in zip(PROBES.speed, PROBES.s, strict=True)
    ]
    B = system.B.toarray()
    exact = np.array([B.T @ np.linalg.solve(Z, B) for Z in dense])
    np.testing.assert_allclose(full, exact, rtol=1e-10, atol=1e-16)
    found = reduced_receptances(among_of(system), np.eye(N), PROBES)
    np.testing.assert_allclose(found[0], exact, rtol=1e-8, atol=1e-10 * np.abs(exact).max())
    # The dual motions are those of the transpose.
    np.testing.assert_allclose(found[2].transpose(0, 2, 1) @ among_of(system).B, exact, rtol=1e-8, atol=1e-15)


def test_receptances_with_contacts_apart_are_those_of_the_system_without_them() -> None:
    system = turning_chain()
    full = full_receptances(system, PROBES)
    alone = [
        system.K.toarray() + s * system.velocity_terms(W).toarray() + s**2 * system.M.toarray()
        for W, s in zip(PROBES.speed, PROBES.s, strict=True)
    ]
    B = system.B.toarray()
    exact = np.array([B.T @ np.linalg.solve(Z, B) for Z in alone])
    before, after = around(full, PROBES.s, scale_of(system))
    np.testing.assert_allclose(full @ after, exact, rtol=1e-9, atol=1e-14)
    np.testing.assert_allclose(before @ full, exact, rtol=1e-9, atol=1e-14)


def test_whatever_modes_are_kept_contacts_and_loads_move_the_structure_statically_as_they_do_in_full() -> None:
    system = replace(turning_chain(), G=None)
    loads = np.random.default_rng(3).standard_normal((N, 2))
    among = among_of(system, loads)
    Q = basis_of(among, np.array([1]))
    assert Q.shape[1] == 5
    forces = np.hstack([system.B.toarray(), loads])
    exact = np.linalg.solve(system.stiffness_about.toarray(), forces)
    V = among.vectors @ Q
    found = V @ np.linalg.solve(Q.T @ among.K @ Q, V.T @ forces)
    np.testing.assert_allclose(found, exact, atol=1e-9 * np.abs(exact).max())
    # The reduced system has them too, with a stiffness that leaves the contacts out.
    own, shapes = reduced(system, among, Q)
    again = shapes @ np.linalg.solve(own.stiffness_about.toarray(), shapes.T @ forces)
    np.testing.assert_allclose(again, exact, atol=1e-9 * np.abs(exact).max())


def test_a_reduced_system_has_the_matrices_of_the_whole_one_in_its_shapes() -> None:
    system = turning_chain(4)
    among = among_of(system)
    own, V = reduced(system, among, basis_of(among, np.array([0, 1, 3])))
    np.testing.assert_allclose(V.T @ (system.M @ V), np.eye(own.n), atol=1e-10)
    for name in ("stiffness_about", "damping_about", "D", "K", "G"):
        whole = V.T @ (getattr(system, name) @ V)
        np.testing.assert_allclose(getattr(own, name).toarray(), whole, atol=1e-9 * np.abs(whole).max())
    np.testing.assert_allclose(own.B.toarray(), V.T @ system.B.toarray(), atol=1e-12)


def beside_two_contacts(seed: int) -> LocalSystem:
    """Oscillators to ground, two of them with contacts; the others hear of these by weak dampers and gyroscopic terms alone."""
    draw = np.random.default_rng(seed)
    w = np.append([100.0, 130.0], draw.uniform(60.0, 330.0, N - 2))
    D, G = (np.zeros((N, N)) for _ in range(2))
    D[:2, 2:] = draw.uniform(-1.0, 1.0, (2, N - 2))
    G[:2, 2:] = draw.uniform(-0.5, 0.5, (2, N - 2))
    laws = [(MeshContact(k, 1.0, gap="bilateral"), np.eye(N)[:, [i]]) for i, k in enumerate(STIFFNESS)]
    system = local_system(np.eye(N), D + D.T + 10.0 * np.eye(N), np.diag(w**2), [0.0] * N, laws)
    return replace(system, G=sp.csc_array(G - G.T))


@pytest.mark.parametrize("seed", range(6))
def test_the_mode_that_is_taken_next_is_the_one_that_changes_receptances_most(seed: int) -> None:
    """Of those that dampers and gyroscopic terms couple to contacts, closed or apart."""
    system = beside_two_contacts(seed)
    scale = scale_of(system)
    probes = Probes(np.full(30, 2.0), 1j * np.linspace(50.0, 340.0, 30))
    among = among_of(system)
    begin = np.flatnonzero(np.abs(among.B[: among.modes]).max(axis=1) > 1e-6)
    H = reduced_receptances(among, basis_of(among, begin), probes)[0]

    def change(mode: int) -> float:
        more = basis_of(among, np.sort(np.append(begin, mode)))
        return max(differences(H, reduced_receptances(among, more, probes)[0], probes.s, scale))

    left = np.setdiff1d(np.arange(among.modes), begin)
    chosen = choose(among, full_receptances(system, probes), probes, scale, 0.0, N, begin, len(begin) + 1)
    assert set(chosen.modes) - set(begin) == {max(left, key=change)}
    found = reduced_receptances(among, chosen.basis, probes)[0]
    assert chosen.closed == pytest.approx(difference(full_receptances(system, probes), found, scale), rel=1e-9)


def test_modes_are_taken_until_the_receptances_agree_and_no_longer() -> None:
    system = beside_two_contacts(1)
    scale = scale_of(system)
    probes = Probes(np.full(30, 2.0), 1j * np.linspace(50.0, 340.0, 30))
    among = among_of(system)
    full = full_receptances(system, probes)
    counts = []
    for tolerance in (1.2e-3, 8e-4, 5e-4):
        heard: list[tuple[int, float]] = []
        chosen = choose(among, full, probes, scale, tolerance, N, report=lambda n, e, told=heard: told.append((n, e)))
        assert chosen.error <= tolerance < min(error for _, error in heard[:-1])
        counts.append(len(chosen.modes))
    assert 0 < counts[0] <= counts[1] <= counts[2] <= among.modes
    # No more shapes than are allowed.
    assert choose(among, full, probes, scale, 0.0, 7).basis.shape[1] == 7
