"""Errors of undamped cases against their references."""

from __future__ import annotations

import mpmath as mp
import numpy as np

import rotorgear as rg
from rotorgear.solvers.eigen.eigen import lowest_modes
from rotorgear.system.system import System
from tests.extreme.gearbox import gearbox, helical_box
from tests.extreme.models import elastic, frequency_error, points, rotor_model
from tests.extreme.references import Body, Rotor, Segment, Spring, timoshenko_pinned, undamped
from tests.extreme.rotors import ALL, even, on


def strain_error(rotor: Rotor) -> float:
    """Error of all modes of the program."""
    return frequency_error(rg.modal(rotor_model(rotor), elements=1, modes=ALL), rotor.frequencies())


def assembled_error(rotor: Rotor) -> float:
    """Error of the elastic modes in bending from the assembled matrices, without the strains of the elements."""
    M, _, _, K = rotor.bending()
    plane = undamped(M, K)
    system = System(rotor_model(rotor, motions=("bending",)))
    modes = lowest_modes(system.mass, system.stiffness(), strain=None)
    omega = np.sqrt(modes.eigenvalues)
    true = sorted([*plane, *plane])
    return max(abs(float(mp.mpf(float(w)) / t - 1)) for w, t in zip(omega, true, strict=True))


def chain(count: int, modes: int) -> float:
    """Free chain of equal disks and springs: w_k = 2 sqrt(k/J) sin(k pi / 2 N)."""
    result = rg.modal(points([0.01] * count, [1e5] * (count - 1)), modes=modes)
    number = min(count, modes)
    short = any("only" in sentence for sentence in result.warnings)
    if len(result) != number or np.count_nonzero(result.rigid) != 1 or short != (modes > count):
        return np.inf
    exact = [2 * mp.sqrt(mp.mpf(1e5) / mp.mpf(0.01)) * mp.sin(k * mp.pi / (2 * count)) for k in range(1, number)]
    return frequency_error(result, exact, rigid=1)


def two_disks(stiffness: float) -> float:
    exact = mp.sqrt(mp.mpf(stiffness) * (1 / mp.mpf(0.3) + 1 / mp.mpf(2e-5)))
    return frequency_error(rg.modal(points([0.3, 2e-5], [stiffness])), [exact], rigid=1)


def shafts(count: int, stiffness: float | None, spread: float = 0.0) -> float:
    """Several shafts that do not touch each other: the frequencies of each, all together."""
    tables: dict[str, dict] = {"shafts": {}, "bearings": {}}
    exact: list[mp.mpf] = []
    for n in range(count):
        k = None if stiffness is None else stiffness * (1.0 + n * spread)
        rotor = Rotor(even(), {} if k is None else {0: Spring(k, k, k), 5: Spring(k)})
        own = rotor_model(rotor)
        tables["shafts"][f"s{n}"] = own.shafts["s"].model_copy(update={"material": "steel"})
        for name, bearing in own.bearings.items():
            tables["bearings"][f"{name}_{n}"] = bearing.model_copy(update={"shaft": f"s{n}"})
        tables["materials"] = own.materials
        exact += rotor.frequencies()
    return frequency_error(rg.modal(rg.Model(**tables), elements=1, modes=ALL, pruning=False), exact)


def massless() -> float:
    """A massless point between two springs: the two in series."""
    k = 1 / (1 / mp.mpf(1e5) + 1 / mp.mpf(1e3))
    exact = mp.sqrt(k * (1 / mp.mpf(0.3) + 1 / mp.mpf(0.2)))
    return frequency_error(rg.modal(points([0.3, 0.0, 0.2], [1e5, 1e3])), [exact], rigid=1)


def rigid_mesh(stiffness: float) -> float:
    """Two gears, each held in torsion: two dofs; at 1e12 N/m the lower one is that of a rigid mesh to 1e-6."""
    J1, J2, k1, k2 = (mp.mpf(v) for v in (1e-3, 2e-2, 1e3, 5e4))
    model = gearbox(stiffness, torsion=(1e3, 5e4))
    r1, r2 = (mp.mpf(model.gears[g].base_radius) for g in ("pinion", "wheel"))
    k = mp.mpf(stiffness)
    exact = undamped(mp.diag([J1, J2]), mp.matrix([[k1 + k * r1**2, k * r1 * r2], [k * r1 * r2, k2 + k * r2**2]]))
    limit = mp.sqrt((k1 * r2**2 + k2 * r1**2) / (J1 * r2**2 + J2 * r1**2))
    result = rg.modal(model)
    if stiffness >= 1e12 and abs(elastic(result)[0] / float(limit) - 1.0) > 1e-6:
        return np.inf
    return frequency_error(result, exact, rigid=0)


def scaled_units(scale: float, speed: float | None) -> float:
    """All lengths times a factor, stiffness times it, mass times its cube: frequencies divided by it, exactly."""
    plain = rg.modal(helical_box(1.0), speed=speed, modes=30)
    other = rg.modal(helical_box(scale), speed=None if speed is None else speed / scale, modes=30)
    if list(plain.rigid) != list(other.rigid):
        return np.inf
    moving = ~plain.rigid
    return float(np.max(np.abs(scale * other.eigenvalues[moving] / plain.eigenvalues[moving] - 1.0)))


def only_axial() -> float:
    rotor = Rotor(even(), {0: Spring(axial=1e7)})
    result = rg.modal(rotor_model(rotor), elements=1, modes=ALL)
    return frequency_error(result, rotor.frequencies(), rigid=5)


def zero_gap() -> float:
    """Two shafts end to end, coupled in torsion through a gap of no length: bars joined by a spring."""
    left = Rotor(even(count=3))
    k = mp.mpf(1e13)
    M1, K1 = left.torsion()
    n = M1.rows
    M = mp.zeros(2 * n)
    K = mp.zeros(2 * n)
    for first in (0, n):
        for i in range(n):
            for j in range(n):
                M[first + i, first + j] = M1[i, j]
                K[first + i, first + j] = K1[i, j]
    for a in (n - 1, n):
        for b in (n - 1, n):
            K[a, b] += k if a == b else -k
    own = rotor_model(left)
    second = own.shafts["s"].model_copy(update={"start": own.shafts["s"].end})
    coupling = rg.Coupling(from_shaft="s", to_shaft="t", stiffness=rg.StiffnessMatrix(torsion=1e13))
    model = rg.Model(
        shafts={"s": own.shafts["s"], "t": second},
        materials=own.materials,
        couplings={"c": coupling},
        motions=("torsion",),
    )
    return frequency_error(rg.modal(model, elements=1, modes=ALL), undamped(M, K), rigid=1)


def pinned(length: float, outer: float, accuracy: float, number: int) -> float:
    """Bending of a pinned shaft: exact Timoshenko frequencies, each in two planes."""
    fixed = {end: rg.Support(shaft="s", at=end, fixed=("x", "y")) for end in ("start", "end")}
    section = rg.Section(length=length, outer_diameter=outer)
    model = rg.Model(shafts={"s": rg.Shaft(sections=(section,))}, supports=fixed, motions=("bending",))
    result = rg.modal(model, modes=2 * number, accuracy=accuracy)
    exact = timoshenko_pinned(Segment(length, outer), number)[:number]
    return frequency_error(result, [*exact, *exact], rigid=0)


def bar(accuracy: float) -> float:
    """Free bar in torsion: w_k = k pi c / L with c^2 = G / rho."""
    section = rg.Section(length=0.4, outer_diameter=0.03)
    model = rg.Model(shafts={"s": rg.Shaft(sections=(section,))}, motions=("torsion",))
    c = mp.sqrt(mp.mpf(206e9) / (2 * (1 + mp.mpf(0.3))) / 7850)
    exact = [k * mp.pi * c / mp.mpf(0.4) for k in range(1, 8)]
    return frequency_error(rg.modal(model, modes=8, accuracy=accuracy), exact, rigid=1)


def no_elements() -> float:
    model = points([0.3, 2e-5], [1e4])
    exact = mp.sqrt(mp.mpf(1e4) * (1 / mp.mpf(0.3) + 1 / mp.mpf(2e-5)))
    result = rg.modal(model, accuracy=1e-11)
    return frequency_error(result, [exact], rigid=1) if np.all(result.error_estimate == 0.0) else np.inf


def rigid_shaft(cuts: tuple[float, ...], stiffness: float) -> float:
    """A rigid cylinder on two bearings: bounce and tilt, two dofs a plane."""
    L = mp.mpf("0.5")
    d = mp.mpf(0.05)
    lengths = np.diff([0.0, *cuts, 0.5])
    sections = tuple(rg.Section(length=float(part), outer_diameter=0.05, rigid=True) for part in lengths)
    soft = {
        end: rg.Bearing(shaft="s", at=end, stiffness=rg.StiffnessMatrix(radial=k))
        for end, k in (("start", stiffness), ("end", 3.0 * stiffness))
    }
    model = rg.Model(shafts={"s": rg.Shaft(sections=sections)}, bearings=soft, motions=("bending",))
    mass = 7850 * mp.pi / 4 * d**2 * L
    tilt = mass * (L**2 / 12 + d**2 / 16)
    k1 = mp.mpf(stiffness)
    k2 = 3 * mp.mpf(stiffness)
    h = L / 2
    plane = undamped(mp.diag([mass, tilt]), mp.matrix([[k1 + k2, (k2 - k1) * h], [(k2 - k1) * h, (k1 + k2) * h**2]]))
    return frequency_error(rg.modal(model), [*plane, *plane], rigid=0)


def merged() -> float:
    """Two disks 1e-11 m apart are on one node, which is listed; 1e-6 m apart they are not."""
    plain = Rotor(even(count=2), on(1e8, last=2), {1: Body(2.0, 0.02, 0.01)})
    model = rotor_model(plain)
    disk = model.disks["d1"]
    half = {"mass": 1.0, "polar_inertia": 0.01, "diametral_inertia": 0.005}
    counts = []
    for gap in (1e-11, 1e-6):
        disks = {
            name: disk.model_copy(update={**half, "at": disk.at + shift})
            for name, shift in (("first", 0.0), ("second", gap))
        }
        result = rg.modal(model.model_copy(update={"disks": disks}), elements=1, modes=ALL)
        merged = [w for w in result.warnings if "disks.second" in w and "one node" in w]
        counts.append((len(result.nodes.shaft), len(merged)))
        if gap < 1e-9:
            error = frequency_error(result, plain.frequencies())
    return error if counts == [(3, 1), (4, 0)] else np.inf


def nothing_below() -> float:
    """No mode lies below fmax: an empty result, which is right."""
    result = rg.modal(rotor_model(Rotor(even(), {0: Spring(1e8, 1e8, 1e6), 5: Spring(1e8)})), fmax=1.0)
    return float(len(result)) if "no mode lies at or below 1 Hz" in result.warnings else np.inf


def zero_inertia_gear() -> float:
    """Gears without inertia of their own on flexible shafts: two bars through a rank-one spring."""
    model = gearbox(1e9, torsion=(1e3, 5e4), on_shafts=True)
    bar = Rotor([Segment(0.1, 0.02)])
    M1, K1 = bar.torsion()
    M = mp.zeros(4)
    K = mp.zeros(4)
    for first in (0, 2):
        for i in range(2):
            for j in range(2):
                M[first + i, first + j] = M1[i, j]
                K[first + i, first + j] = K1[i, j]
    K[0, 0] += mp.mpf(1e3)
    K[2, 2] += mp.mpf(5e4)
    r = [mp.mpf(model.gears[g].base_radius) for g in ("pinion", "wheel")]
    for a, ra in zip((1, 3), r, strict=True):
        for b, rb in zip((1, 3), r, strict=True):
            K[a, b] += mp.mpf(1e9) * ra * rb
    return frequency_error(rg.modal(model, elements=1, modes=ALL), undamped(M, K), rigid=0)


def indefinite() -> object:
    rows = np.diag([1e8, 1e8, 1e6, 0.0, 0.0, 0.0])
    rows[0, 1] = rows[1, 0] = 2e8
    model = rotor_model(Rotor(even(), on(1e8)))
    bearing = model.bearings["b0"].model_copy(update={"stiffness": rg.StiffnessMatrix(matrix=rows.tolist())})
    return rg.modal(model.model_copy(update={"bearings": {"b0": bearing}}))
