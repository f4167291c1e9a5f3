"""Planetary stages for tests, as the text of a file: numbers in SI unless a unit stands there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import scipy.linalg as la

import rotorgear as rg
from rotorgear.system.system import System

Springs = Mapping[str, float]


def springs(values: Springs) -> str:
    """A table of springs or dampers."""
    return "{" + ", ".join(f"{name} = {value!r}" for name, value in values.items()) + "}"


def torsional_train(
    driven: str,
    shafts: str,
    gears: str,
    meshes: str,
    carriers: str,
    planets: str,
    *,
    couplings: str = "",
    given: str = "",
    loads: str = "",
) -> rg.Model:
    """A train in torsion alone, from short lists.

    Args:
        driven: name of the input shaft. shafts: their names.
        gears: "name shaft teeth", with negative teeth of a ring, with commas between.
        meshes: "pinion gear". carriers: "name shaft planets". planets: "shaft carrier".
        couplings: "from to". given: "shaft ratio", speeds over that of the input.
        loads: shafts that take what is left; 1 N m goes in at the driven one.
    """

    def rows(text: str) -> list[list[str]]:
        return [item.split() for item in text.split(",") if item.strip()]

    parts = [
        f'motions = ["torsion"]\n[operation]\ninput_shaft = "{driven}"\nspeed = "1000 rpm"',
        f'[loads.in]\nshaft = "{driven}"\nkind = "input"\ntorque = 1',
        *(f'[loads.of_{name}]\nshaft = "{name}"\nkind = "output"' for name in loads.split()),
    ]
    speeds = {name: f"\nspeed_ratio = {ratio}" for name, ratio in rows(given)}
    parts += [f"[shafts.{name}]{speeds.get(name, '')}" for name in shafts.split()]
    parts += [f'[shafts.{name}]\ncarrier = "{carrier}"' for name, carrier in rows(planets)]
    parts += [
        f'[carriers.{name}]\nshaft = "{shaft}"\nat = 0\nplanets = {count}' for name, shaft, count in rows(carriers)
    ]
    for name, shaft, teeth in rows(gears):
        inside = "internal = true\n" if int(teeth) < 0 else ""
        parts.append(
            f'[gears.{name}]\nkind = "spur"\nshaft = "{shaft}"\nat = 0\nteeth = {abs(int(teeth))}\nnormal_module = 0.003\n'
            f"{inside}width = 0.03\nmass = 1\npolar_inertia = 0.01\ndiametral_inertia = 0.005"
        )
    parts += [
        f'[meshes.{one}_{other}]\npinion = "{one}"\ngear = "{other}"\nstiffness = 4e8' for one, other in rows(meshes)
    ]
    parts += [
        f'[couplings.{one}_{other}]\nfrom_shaft = "{one}"\nfrom_at = 0\nto_shaft = "{other}"\nto_at = 0\n'
        "stiffness = {torsion = 1e6}"
        for one, other in rows(couplings)
    ]
    return rg.loads("\n".join(parts))


# Mass, polar and diametral inertia of the bodies of the helical set, and springs to the ground.
BODIES = {
    "sun": (2.6, 0.0029, 0.0024),
    "ring": (9.0, 0.26, 0.14),
    "carrier": (14.0, 0.11, 0.075),
    "planet": (2.2, 0.0046, 0.0031),
}
GROUND: dict[str, Springs] = {
    "sun": {"x": 4e7, "y": 4e7, "axial": 3e7, "tilt_x": 2e4, "tilt_y": 2e4},
    "ring": {"x": 9e8, "y": 9e8, "axial": 7e8, "tilt_x": 4e6, "tilt_y": 4e6, "torsion": 2e7},
    "carrier": {"x": 5e8, "y": 5e8, "axial": 3e8, "tilt_x": 2e6, "tilt_y": 2e6},
}
PIN: Springs = {"radial": 4e8, "axial": 1.5e8, "tilt": 3e5}


def helical_stage(
    planets: int = 3,
    *,
    teeth: Sequence[int] = (27, 36, 99),
    ground: Mapping[str, Springs] = GROUND,
    pin: Springs = PIN,
    loss: float = 0.0,
    speed: str = "1000 rpm",
    more: str = "",
) -> str:
    """A helical stage of rigid points in one plane, the ring held: 27/36/99 teeth of 3 mm and 20 deg.

    Args:
        planets: how many. teeth: of sun, planet and ring. ground, pin: springs.
        loss: damping over stiffness of pins and meshes in s.
        more: further tables.
    """
    parts = [f'[operation]\ninput_shaft = "sun"\nspeed = "{speed}"', "[shafts.sun]\n[shafts.carrier]"]
    parts.append('[shafts.ring]\nspeed_ratio = 0\n[shafts.planet]\ncarrier = "stage"')
    parts.append(f'[carriers.stage]\nshaft = "carrier"\nat = 0\nplanets = {planets}')
    for name, z, hand in zip(("sun", "planet", "ring"), teeth, ("right", "left", "left"), strict=True):
        mass, polar, diametral = BODIES[name]
        inside = "internal = true\n" if name == "ring" else ""
        parts.append(
            f'[gears.{name}]\nkind = "helical"\nhand = "{hand}"\nhelix_angle = "20 deg"\nteeth = {z}\nnormal_module = 0.003\n'
            f'{inside}shaft = "{name}"\nat = 0\nwidth = 0.03\nmass = {mass}\npolar_inertia = {polar}\n'
            f"diametral_inertia = {diametral}"
        )
    mass, polar, diametral = BODIES["carrier"]
    parts.append(
        f'[disks.carrier]\nshaft = "carrier"\nat = 0\nmass = {mass}\npolar_inertia = {polar}\ndiametral_inertia = {diametral}'
    )
    for name, pair, k in (("sun_planet", ("sun", "planet"), 6e8), ("planet_ring", ("planet", "ring"), 7.5e8)):
        parts.append(
            f'[meshes.{name}]\npinion = "{pair[0]}"\ngear = "{pair[1]}"\nstiffness = {k}\ndamping = {loss * k}'
        )
    losses = {name: loss * value for name, value in pin.items()}
    parts.append(f'[bearings.pin]\nshaft = "planet"\nat = 0\nstiffness = {springs(pin)}\ndamping = {springs(losses)}')
    parts += [
        f'[supports.{name}]\nshaft = "{name}"\nat = 0\nstiffness = {springs(values)}' for name, values in ground.items()
    ]
    return "\n".join([*parts, more])


def eigenvalues(M: np.ndarray, D: np.ndarray, K: np.ndarray) -> np.ndarray:
    """All s of s^2 M + s D + K."""
    n = len(M)
    return np.asarray(la.eigvals(np.block([[np.zeros((n, n)), np.eye(n)], [-la.solve(M, K), -la.solve(M, D)]])))


def frequencies(s: np.ndarray, *, above: float = 10.0) -> np.ndarray:
    """Oscillating ones in rad/s, ascending, without the free rotation."""
    return np.sort(s.imag[s.imag > above])


def in_frame_of_the_carrier(system: System, carrier: float) -> np.ndarray:
    """Frequencies where everything is told in axes that turn with the carrier: the same rule for all bodies, no classes.

    M y'' + (2 W M S + W_s G) y' + (K + W^2 M S S + W W_s G S + K_g) y = 0, exact for springs to the ground without preferred
    directions.
    """
    speed = carrier / system.train.ratio("carrier")
    M = system.mass.toarray()
    quarter = np.zeros((6, 6))
    quarter[[1, 4], [0, 3]] = 1.0
    quarter[[0, 3], [1, 4]] = -1.0
    S = np.kron(np.eye(system.n // 6), quarter)
    G = np.zeros_like(M)
    for group in system.groups:
        if group.matrices.gyroscopic is not None and not group.part.startswith("carriers."):
            for dofs, own in zip(group.dofs, group.matrices.gyroscopic, strict=True):
                G[np.ix_(dofs, dofs)] += group.spin * speed * own
    K = system.stiffness(0.0).toarray()
    planet = system.model.gears["planet#1"]
    assert planet.mass is not None
    pull = planet.mass * carrier**2
    r = system.layout.planets[0].radius
    f = pull * r / (1.0 - pull / PIN["radial"])
    node = 6 * system.nodes.at("carrier", 0.0)
    count = len(system.layout.planets[0].planets)
    K[node + 3 : node + 6, node + 3 : node + 6] += f * r * count * np.diag([0.5, 0.5, 1.0])
    return frequencies(
        eigenvalues(M, 2.0 * carrier * M @ S + G, K + carrier**2 * M @ S @ S + carrier * G @ S), above=10.0
    )
