"""Motions in time of planets that go round, against an integration whose planets leave their places on true paths.

Its planets are told in their own axes, which turn with the carrier, and the sun, the ring and the carrier in axes at rest, so
that all its coefficients change with time; contacts and excitations are written out here.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
import pytest
import scipy.linalg as la
from scipy.integrate import solve_ivp

import rotorgear as rg
from rotorgear.analysis.transient.channels import channels
from rotorgear.analysis.transient.request import prepare
from rotorgear.errors import AnalysisError
from rotorgear.system.assembly import assemble
from rotorgear.system.contacts import contact_lines
from rotorgear.system.planets import pin_loads
from rotorgear.system.system import System
from tests.paths import MODELS
from tests.planetary import BODIES, GROUND, PIN, Springs, helical_stage

# Teeth of sun, planet and ring by the number of planets: excitations of translational and of planet modes.
TEETH = {3: (28, 35, 98), 4: (26, 36, 98)}
SPEED = 2500.0 * np.pi / 30.0
# Unequal springs to the ground, so that the planets see other surroundings as they go round.
UNEQUAL = {name: {**values, "y": 1.7 * values["y"]} for name, values in GROUND.items()}
ERROR = 4e-6
BACKLASH = 30e-6
LOADS = """
[loads.drive]
shaft = "sun"
kind = "input"
torque = {torque}
[loads.rest]
shaft = "carrier"
kind = "output"
"""


def stage(
    torque: float,
    planets: int = 4,
    *,
    loss: float = 0.0,
    speed: float = SPEED,
    backlash: bool = True,
    error: float = ERROR,
    ground: Mapping[str, Springs] = UNEQUAL,
    more: str = "",
) -> str:
    """A helical stage with transmission errors, and backlash if wished; its pins are damped by loss, its meshes are not."""
    text = helical_stage(
        planets,
        teeth=TEETH[planets],
        ground=ground,
        loss=loss,
        speed=f"{speed!r} rad/s",
        more=LOADS.format(torque=torque) + more,
    )
    gap = f"backlash = {BACKLASH}\n" if backlash else ""
    mesh = f"damping = 0\n{gap}transmission_error = [{{harmonic = 1, amplitude = {error!r}}}]\n"
    text = re.sub(r"(stiffness = [0-9.]+\n)damping = [0-9.]+(?=\n\[meshes|\n\[bearings)", r"\1" + mesh, text)
    assert text.count("transmission_error") == 2
    return text


@dataclass(frozen=True)
class OnTruePaths:
    """The stage in axes that go round for its planets.

    Attributes:
        text: its file; planets: how many. speed: of the sun in rad/s; torque: on it in N m; loss: of the pins in s.
        error: amplitude of the transmission errors in m; late: what must close at the sun of each planet before it carries, in m.
    """

    text: str
    planets: int
    speed: float
    torque: float
    loss: float
    error: float = ERROR
    late: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)

    def _at(self, offset: float) -> System:
        N = self.planets
        angles = ", ".join(f'"{360.0 * k / N + np.degrees(offset):.15g} deg"' for k in range(N))
        return System(rg.loads(self.text.replace(f"planets = {N}", f"angles = [{angles}]")))

    @cached_property
    def system(self) -> System:
        return self._at(0.0)

    @cached_property
    def planet_dofs(self) -> np.ndarray:
        """Free dofs (N, 6) of the planets."""
        system = self.system
        nodes = [system.nodes.on_shaft(f"planet#{k + 1}")[0] for k in range(self.planets)]
        column = np.full(system.dofs.transform.shape[0], -1)
        T = system.dofs.transform.tocoo()
        column[T.row] = T.col
        return np.array([column[6 * node + np.arange(6)] for node in nodes])

    @cached_property
    def carrier_dofs(self) -> np.ndarray:
        T = self.system.dofs.transform.tocoo()
        column = dict(zip(T.row.tolist(), T.col.tolist(), strict=True))
        node = self.system.nodes.on_shaft("carrier")[0]
        return np.array([column[6 * node + k] for k in range(6)])

    def waves(self, of) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """What does not turn of a matrix that has one wave over the angle of the carrier, and its cosine and sine."""
        first, second, third = (of(self._at(angle)) for angle in (0.0, 0.5 * np.pi, np.pi))
        still = 0.5 * (first + third)
        return still, first - still, second - still

    @cached_property
    def contacts(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        return self.waves(lambda system: contact_lines(system).vectors)

    @cached_property
    def pins(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Strains (n, 5 N) of the pins."""

        def strains(system: System) -> np.ndarray:
            T = system.dofs.transform.toarray()
            of_pins = [group for group in system.groups if group.part.startswith("bearings.pin")]
            return np.hstack([(group.matrices.strain[0] @ T[group.dofs[0]]).T for group in of_pins])

        return self.waves(strains)

    @cached_property
    def ratio(self) -> float:
        """Speed of the carrier over that of the sun."""
        return float(self.system.train.ratio("carrier"))

    @property
    def turns(self) -> float:
        """Speed of the carrier in rad/s at the start."""
        return self.ratio * self.speed

    def turned(self, t: float) -> tuple[float, float, float]:
        """Angle of the carrier in rad, its speed and its acceleration at a time."""
        return self.turns * t, self.turns, 0.0

    def at(self, waves: tuple[np.ndarray, np.ndarray, np.ndarray], t: float) -> np.ndarray:
        angle = self.turned(t)[0]
        return waves[0] + waves[1] * np.cos(angle) + waves[2] * np.sin(angle)

    def rate(self, waves: tuple[np.ndarray, np.ndarray, np.ndarray], t: float) -> np.ndarray:
        angle, W, _ = self.turned(t)
        return W * (waves[2] * np.cos(angle) - waves[1] * np.sin(angle))

    @cached_property
    def pin_springs(self) -> np.ndarray:
        return np.tile([PIN["radial"], PIN["radial"], PIN["axial"], PIN["tilt"], PIN["tilt"]], self.planets)

    @cached_property
    def mesh_stiffness(self) -> np.ndarray:
        meshes = [group for group in self.system.groups if group.part.startswith("meshes.")]
        return np.array([group.matrices.modulus[0, 0, 0] for group in meshes])

    def errors(self, t: float) -> np.ndarray:
        """Errors in m: sun meshes follow each other by -z_s psi, ring meshes by +z_r psi, both reversed with the sense."""
        sun, _, ring = TEETH[self.planets]
        found = []
        for force in self.system.state.forces:
            mesh, number = force.contact.mesh.split("#")
            psi = 2.0 * np.pi * (int(number) - 1) / self.planets
            phase = np.sign(self.speed) * (-sun if mesh == "sun_planet" else ring) * psi
            wave = np.cos(ring * abs(self.turned(t)[0]) + self.system.state.phases[f"{mesh}#1"] + phase)
            found.append(self.error * wave + (self.late[int(number) - 1] if mesh == "sun_planet" else 0.0))
        return np.array(found)

    def contact_forces(self, t: float, q: np.ndarray) -> np.ndarray:
        x = self.at(self.contacts, t).T @ q - self.errors(t)
        return self.mesh_stiffness * (np.maximum(x, 0.0) - np.maximum(-x - BACKLASH, 0.0))

    def pin_forces(self, t: float, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        strain = self.at(self.pins, t).T @ q
        return self.pin_springs * (strain + self.loss * (self.at(self.pins, t).T @ v + self.rate(self.pins, t).T @ q))

    @cached_property
    def parts(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """M, G for unit speed of the sun, M S and M S S + G S / ratio of the planets, and K without contacts and pins."""
        system = self.system
        n = system.n
        own = [group for group in system.groups if not group.part.startswith("carriers.")]
        G = assemble(
            own, system.dofs, lambda g: None if g.matrices.gyroscopic is None else g.spin * g.matrices.gyroscopic
        ).toarray()
        held = [group for group in own if group.part.startswith("supports.")]
        K = assemble(held, system.dofs, lambda g: g.matrices.stiffness).toarray()
        S = np.zeros((n, n))
        for x, y, _, tilt_x, tilt_y, _ in self.planet_dofs:
            S[y, x], S[x, y], S[tilt_y, tilt_x], S[tilt_x, tilt_y] = 1.0, -1.0, 1.0, -1.0
        planets = np.zeros((n, n))
        planets[self.planet_dofs.ravel(), self.planet_dofs.ravel()] = 1.0
        M = system.mass.toarray()
        return M, G, M @ S, M @ S @ S + planets @ G @ S / self.ratio, K

    def structure(self, W: float, faster: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
        """D and K without contacts and pins at a speed of the carrier and its acceleration, in axes that go round."""
        _, G, turned, pulled, held = self.parts
        D = W / self.ratio * G + 2.0 * W * turned
        K = held + W**2 * pulled + faster * turned
        # The planets pull outwards, with the give of their pins, on a carrier that turns under them.
        mass = BODIES["planet"][0]
        radius = self.system.layout.planets[0].radius
        pull = W**2 * mass * radius / (1.0 - W**2 * mass / PIN["radial"])
        rotations = self.carrier_dofs[3:]
        K[rotations, rotations] += self.planets * pull * radius * np.array([0.5, 0.5, 1.0])
        return D, K

    def loads(self, W: float, faster: float = 0.0) -> np.ndarray:
        """Torques, the pull of the planets outwards, and what their pins need to accelerate them."""
        system = self.system
        mass = BODIES["planet"][0]
        radius = system.layout.planets[0].radius
        load = np.zeros(system.n)
        for name, moment in (("sun", self.torque), ("carrier", -self.torque / self.ratio)):
            node = system.nodes.on_shaft(name)[0]
            load += np.sign(self.speed) * moment * system.dofs.transform.toarray()[6 * node + 5]
        load[self.planet_dofs[:, 0]] += W**2 * mass * radius
        load[self.planet_dofs[:, 1]] -= mass * radius * faster
        load[self.carrier_dofs[5]] += self.planets * mass * radius**2 * faster
        # The torques balance on the train, whose free motion the give of the planets has changed in the linear terms.
        M = self.parts[0]
        values, vectors = la.eig(self.structure(W)[1] + self.springs(0.0), M)
        R = vectors[:, np.abs(values).argmin()].real
        return load - M @ R * (R @ load) / (R @ M @ R)

    @cached_property
    def matrices(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """M, D and K without contacts and pins, and the load, at the speed of the start."""
        return self.parts[0], *self.structure(self.turns), self.loads(self.turns)

    def now(self, t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """D, K and the load at a time."""
        return self.matrices[1:]

    def springs(self, t: float) -> np.ndarray:
        """Stiffness of the pins and of contacts that all carry."""
        V = self.at(self.contacts, t)
        P = self.at(self.pins, t)
        return V * self.mesh_stiffness @ V.T + P * self.pin_springs @ P.T

    def motion(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Forces (r, 2 N) of the contacts, and of the pins outwards and onwards (r, N, 2), at times (r,), from rest."""
        n = self.system.n
        inverse = np.linalg.inv(self.parts[0])

        def slope(t: float, y: np.ndarray) -> np.ndarray:
            q, v = y[:n], y[n:]
            D, K, load = self.now(t)
            F = self.at(self.contacts, t) @ self.contact_forces(t, q) + self.at(self.pins, t) @ self.pin_forces(t, q, v)
            return np.concatenate([v, inverse @ (load - K @ q - D @ v - F)])

        found = solve_ivp(slope, (0.0, times[-1]), np.zeros(2 * n), "DOP853", times, rtol=1e-10, atol=1e-15)
        q, v = found.y[:n].T, found.y[n:].T
        return (
            np.array([self.contact_forces(t, x) for t, x in zip(times, q, strict=True)]),
            np.array(
                [self.pin_forces(t, x, y).reshape(self.planets, 5)[:, :2] for t, x, y in zip(times, q, v, strict=True)]
            ),
        )

    def at_a_crawl(self, t: float) -> np.ndarray:
        """Forces (2 N,) of the contacts, all of which carry, without any inertia but that of the free motion."""
        M, _, K, load = self.matrices
        values, vectors = la.eigh(0.5 * (K + K.T) + self.springs(t), M)
        R = vectors[:, :1]
        assert abs(values[0]) < 1e-6 * values[1]
        V = self.at(self.contacts, t)
        pushed = load + V @ (self.mesh_stiffness * self.errors(t))
        A = np.block([[K + self.springs(t), M @ R], [(M @ R).T, np.zeros((1, 1))]])
        q = np.linalg.solve(A, np.append(pushed - M @ R @ (R.T @ pushed), 0.0))[:-1]
        forces = self.mesh_stiffness * (V.T @ q - self.errors(t))
        assert np.all(forces > 0.0)
        return np.asarray(forces)


@dataclass(frozen=True)
class RunUp(OnTruePaths):
    """The stage with a sun whose speed stays until `begin` and goes evenly to another one until `end`, in s."""

    to: float = 0.0
    begin: float = 0.0
    end: float = 0.0

    def turned(self, t: float) -> tuple[float, float, float]:
        first = self.ratio * self.speed
        late = max(t - self.begin, 0.0)
        faster = self.ratio * (self.to - self.speed) / (self.end - self.begin)
        return first * t + 0.5 * faster * late**2, first + faster * late, faster if late else 0.0

    @cached_property
    def _over_speed(self) -> tuple[np.ndarray, np.ndarray]:
        squares = np.linspace(*sorted((self.ratio * w) ** 2 for w in (self.speed, self.to)), 9)
        speeds = np.sign(self.turns) * np.sqrt(squares)
        return squares, np.array([[self.loads(W), self.loads(W, 1.0)] for W in speeds])

    def now(self, t: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        _, W, faster = self.turned(t)
        squares, loads = self._over_speed
        k = min(int((W**2 - squares[0]) / (squares[1] - squares[0])), len(squares) - 2)
        share = (W**2 - squares[k]) / (squares[1] - squares[0])
        steady, grown = loads[k] + share * (loads[k + 1] - loads[k])
        return *self.structure(W, faster), steady + faster * (grown - steady)


def periods(own: OnTruePaths, count: float) -> float:
    """Time in s of some mesh periods."""
    return count * 2.0 * np.pi / (TEETH[own.planets][2] * abs(own.turns))


@cache
def six_periods(planets: int, speed: float, torque: float) -> tuple[str, float, np.ndarray, np.ndarray]:
    """A stage, six of its mesh periods in s, and the forces of its contacts and pins in them, from rest."""
    text = stage(torque, planets, loss=3e-7, speed=speed)
    own = OnTruePaths(text, planets, speed, torque, 3e-7)
    end = periods(own, 6)
    return text, end, *own.motion(end / 60 * np.arange(1, 61))


def pin_histories(found: rg.TransientResult, planets: int) -> np.ndarray:
    """Forces (r, N, 2) of the pins outwards and onwards."""
    return np.stack(
        [[found.history(f"bearings.pin#{k + 1} force {axis}") for axis in "xy"] for k in range(planets)]
    ).transpose(2, 0, 1)


@pytest.mark.parametrize(
    ("planets", "speed", "torque", "method", "steps", "bound"),
    [
        (3, -0.8 * SPEED, 500.0, "exponential", 800, 2e-2),
        pytest.param(4, SPEED, 900.0, "newmark", 1600, 8e-3, marks=pytest.mark.long),
        pytest.param(4, SPEED, 900.0, "generalised-alpha", 1600, 8e-3, marks=pytest.mark.long),
    ],
)
def test_motions_with_teeth_that_part_are_those_of_true_paths(
    planets: int, speed: float, torque: float, method: str, steps: int, bound: float
) -> None:
    """Second order in the step, for either sense, in all methods, for forces of contacts and pins."""
    text, end, F, pins = six_periods(planets, speed, torque)
    assert np.any(F == 0.0), "teeth part"
    off = []
    for now in (steps // 2, steps):
        found = rg.transient(
            rg.loads(text),
            time=end,
            discard=0.0,
            steps=now,
            method=method,
            start="rest",
            error_estimate=False,
            **({"rho_inf": 1.0} if method == "generalised-alpha" else {}),
        )
        assert len(found.time) == 240
        of_contacts = np.abs(found.mesh_force[3::4] - F).max() / np.abs(F).max()
        of_pins = np.abs(pin_histories(found, planets)[3::4] - pins).max() / np.abs(pins).max()
        assert found.energy.share < 1e-4
        off.append((of_contacts, of_pins))
    coarse, fine = np.array(off)
    assert np.all(fine < bound * np.array([1.0, 0.2]))
    assert np.all(np.log2(coarse / fine) == pytest.approx(2.0, abs=0.35))


@pytest.mark.parametrize(
    ("planets", "speed", "to"),
    [
        (4, 0.45 * SPEED, 1.3 * SPEED),
        pytest.param(3, -SPEED, -0.3 * SPEED, marks=pytest.mark.long),
    ],
)
def test_run_ups_are_those_of_true_paths(planets: int, speed: float, to: float) -> None:
    """Planets that leave their places ever faster: pins that take them along, matrices that grow, teeth that part."""
    torque, loss, begin, end = 900.0, 3e-7, 0.0007, 0.006
    text = stage(torque, planets, loss=loss, speed=speed)
    own = RunUp(text, planets, speed, torque, loss, to=to, begin=begin, end=end)
    off = []
    for steps in (500, 1000):
        found = rg.transient(
            rg.loads(text),
            speed=[(begin, speed), (end, to)],
            time=0.003,
            steps=steps,
            start="rest",
            error_estimate=False,
        )
        which = slice(3, None, 8)
        if not off:
            F, pins = own.motion(found.time[which])
        of_pins = np.abs(pin_histories(found, planets)[which] - pins).max() / np.abs(pins).max()
        off.append((np.abs(found.mesh_force[which] - F).max() / np.abs(F).max(), of_pins))
        assert found.energy.share < 1e-4
    coarse, fine = np.array(off)
    assert np.all(fine < (8e-3, 1.5e-3))
    assert np.all(coarse > 2.5 * fine)


def test_channels_of_a_run_up_are_those_at_the_speed_of_the_moment() -> None:
    point = '[points.pin]\nshaft = "planet"\nat = 0\ndirection = "y"\n'
    task = prepare(rg.loads(stage(900.0, 3, more=point)), [(0.0, -40.0), (0.1, -SPEED)], None)
    local = task.local.local
    for t in (0.0, 0.03):
        there = channels(task.local, float(local.rotation.speed(np.array(t)))).observed(local.n, local.m)
        now = local.at_time(t).observed
        for kind in "qvaF":
            rows = getattr(there, kind)
            assert getattr(now, kind) == pytest.approx(rows, rel=1e-9, abs=1e-9 * max(np.abs(rows).max(), 1.0))
    with_speed = task.channels.names.index("points.pin#2 velocity")
    assert np.abs(now.q[with_speed]).max() > 1.0


def test_planets_that_are_accelerated_feel_their_displacements_onwards() -> None:
    """m W' S p of planets that all move outwards alike, and nothing else but the balance of loads."""
    task = prepare(rg.loads(stage(900.0, 3)), [(0.0, -40.0), (0.1, -SPEED)], None)
    changes = task.local.local.changes
    assert changes is not None
    system = task.local.system
    ratio = float(system.train.ratio("carrier"))
    grown = changes.at(-50.0, 300.0)[0] - changes.at(-50.0, 0.0)[0]
    nodes = [system.nodes.on_shaft(f"planet#{k}")[0] for k in (1, 2, 3)]
    T = system.dofs.transform.toarray()
    outwards, onwards = (np.sum([T[6 * node + k] for node in nodes], axis=0) for k in (0, 1))
    assert grown @ outwards == pytest.approx(BODIES["planet"][0] * 300.0 * ratio * onwards, abs=1e-9)


def test_at_a_crawl_forces_are_those_of_statics_at_each_instant() -> None:
    """A tooth that sits late on one planet takes its load round through unequal surroundings."""
    speed, torque, loss = 0.5, 2400.0, 2e-4
    late = (0.0, 9e-6, 0.0, 0.0)
    text = stage(
        torque, loss=loss, speed=speed, error=0.0, more=f'[meshes."sun_planet#2"]\nindex_error = {late[1]!r}\n'
    )
    own = OnTruePaths(text, 4, speed, torque, loss, 0.0, late)
    found = rg.transient(
        rg.loads(text),
        time=2.0 * np.pi / own.turns,
        discard=0.0,
        steps=400,
        records=40,
        method="exponential",
        error_estimate=False,
    )
    F = found.mesh_force[::197]
    still = np.array([own.at_a_crawl(t) for t in found.time[::197]])
    # A force that goes round is that of the middle of a step: half a step late where the structure only follows.
    assert np.abs(F - still).max() < 2e-5 * still.max()
    assert np.ptp(still, axis=0).max() > 5e-4 * still.max()


def test_a_settled_motion_is_the_linear_response_with_its_sideband() -> None:
    """Amplitudes over a turn of the carrier at the orders of the mesh and beside them, at a gear that stands still."""
    point = '[points.ring]\nshaft = "ring"\nat = 0\ndirection = "x"\n'
    text = stage(900.0, 3, loss=2e-5, backlash=False, more=point)
    model = rg.loads(text)
    linear = rg.response(model, speeds=[SPEED])
    W = float(model.layout.train.ratio("carrier")) * SPEED
    found = rg.transient(
        model, time=2.0 * np.pi / W, discard=4.0 * np.pi / W, steps=80, method="exponential", error_estimate=False
    )
    x = found.history("points.ring displacement")[found.counted]
    told = np.abs(np.fft.rfft(x)) / len(x) * 2.0
    place = linear.places.index("gears.ring")
    assert linear.orders == ("mesh sun_planet, planet_ring 1x + stage",)
    turns = float(linear.ratio[0]) * SPEED / W
    assert turns == pytest.approx(TEETH[3][2] + 1, abs=1e-9)
    assert told[1:].argmax() == TEETH[3][2]
    assert told[1:].max() == pytest.approx(abs(linear.displacement[0, 0, place, 0]), rel=3e-4)


def test_statistics_at_steps_are_those_of_records_where_all_are_kept() -> None:
    """Forces, errors and channels of planets are told where the planets are, in statistics as in histories."""
    more = '[points.pin]\nshaft = "planet"\nat = 0\ndirection = "y"\n'
    found = rg.transient(
        rg.loads(stage(900.0, 3, loss=3e-6, more=more)),
        time=0.01,
        discard=0.002,
        steps=100,
        records=100,
        method="exponential",
        error_estimate=False,
    )
    counted = found.values[found.counted]
    assert "points.pin#2 acceleration" in found.channel
    size = np.abs(counted).max(axis=0) + 1e-6
    assert np.all(np.abs(counted.mean(axis=0) - found.value_mean) < 2e-2 * size)
    assert np.all(np.abs(counted.std(axis=0) - found.value_rms) < 2e-2 * size)
    assert np.all(found.value_range[:, 0] < counted.min(axis=0) + 2e-2 * size)
    assert np.all(found.value_range[:, 1] > counted.max(axis=0) - 2e-2 * size)
    te = found.transmission_error[found.counted]
    ends = np.column_stack([te.min(axis=0), te.max(axis=0)])
    assert np.abs(found.transmission_error_range - ends).max() < 1e-2 * np.ptp(te)
    # Rates are those of what planets see.
    of = {what: found.history(f"points.pin#2 {what}") for what in ("displacement", "velocity", "acceleration")}
    for of_this, of_rate in (("displacement", "velocity"), ("velocity", "acceleration")):
        slope = np.gradient(of[of_this], found.time)[5:-5]
        assert np.abs(slope - of[of_rate][5:-5]).max() < 0.03 * np.ptp(of[of_rate])


def test_friction_and_energy() -> None:
    """What friction of planets takes, and what the carrier's turn exchanges, is in the ledger."""
    text = stage(900.0, 3, loss=3e-6).replace("damping = 0\n", "damping = 0\nfriction_coefficient = 0.06\n")
    for method, steps in (("exponential", 200), ("newmark", 400)):
        found = rg.transient(
            rg.loads(text), time=0.006, discard=0.0, steps=steps, method=method, error_estimate=False, start="rest"
        )
        assert found.energy.share < 2e-4
        assert found.energy.dissipated[-1] > 0.0


@pytest.mark.parametrize(
    "motions", [["torsion"], pytest.param(["bending", "axial", "torsion"], marks=pytest.mark.long)]
)
def test_two_stages_carry_what_statics_says(motions: list[str]) -> None:
    """Planets of two carriers that turn at different speeds, in one train; in torsion alone they stay on their pins."""
    model = rg.load(MODELS / "wind_turbine.toml").with_("motions", motions)
    found = rg.transient(model, time="0.05 s", discard="0.3 s", steps=60, error_estimate=False)
    assert not any("by statics" in text for text in found.warnings)
    # Over the planets, the weight of which turns in their axes, the mean forces are those of statics.
    of_stage = {name.partition("#")[0] for name in found.contact if "#" in name}
    assert len(of_stage) == 4
    for mesh in of_stage:
        own = [k for k, name in enumerate(found.contact) if name.startswith(f"{mesh}#")]
        assert found.force_mean[own].mean() == pytest.approx(found.mean_force[own].mean(), rel=1e-3)


UNBALANCE = '[unbalances.one]\nshaft = "planet"\nat = 0\nmagnitude = 3e-4\nphase = "40 deg"\n'
UNEVEN_UNBALANCE = f'{UNBALANCE}[unbalances."one#2"]\nmagnitude = 5e-4\n'
ONE = '[loads.pull]\nshaft = "planet"\nat = 0\nforce = [10.0, 0.0, 0.0]\n[loads."pull#2"]\nforce = [20.0, 0.0, 0.0]\n'
RIPPLE = '[loads.pull]\nshaft = "planet"\nat = 0\nforce = [0.0, 300.0, 0.0]\norder = 2\n'


@pytest.mark.parametrize("more", [pytest.param(UNBALANCE, marks=pytest.mark.long), UNEVEN_UNBALANCE, RIPPLE])
def test_what_turns_on_planets_moves_the_ring_as_in_the_linear_response(more: str) -> None:
    """Amplitudes at all orders of a gear that stands still, by all sisters alike and by one that differs."""
    points = "".join(f'[points.{d}]\nshaft = "ring"\nat = 0\ndirection = "{d}"\n' for d in ("x", "torsion"))
    model = rg.loads(stage(900.0, 3, loss=2e-5, backlash=False, error=1e-12, more=more + points))
    linear = rg.response(model, speeds=[SPEED])
    turn = 2.0 * np.pi / (SPEED * float(model.layout.train.ratio("carrier")))
    found = rg.transient(
        model, time=2.0 * turn, discard=2.0 * turn, steps=60, method="exponential", error_estimate=False
    )
    t = found.time[found.counted]
    waves = [part(ratio * SPEED * t) for ratio in linear.ratio for part in (np.cos, np.sin)]
    place = linear.places.index("gears.ring")
    largest = 0.0
    for name, dof in (("x", 0), ("torsion", 5)):
        x = found.history(f"points.{name} displacement")[found.counted]
        fitted = np.linalg.lstsq(np.column_stack([np.ones(t.size), *waves]), x, rcond=None)[0][1:]
        told = np.hypot(fitted[::2], fitted[1::2])
        wanted = np.abs(linear.displacement[:, 0, place, dof])
        assert told == pytest.approx(wanted, rel=2e-3, abs=2e-3 * wanted.max() + 1e-15)
        largest = max(largest, wanted.max())
    assert largest > 1e-11


@pytest.mark.parametrize(
    ("more", "words"),
    [(ONE, "loads.pull: a load on planets that go round is built in time where what stays of it is the same for all")],
)
def test_what_turns_in_axes_of_planets_is_refused_by_name(more: str, words: str) -> None:
    with pytest.raises(AnalysisError, match=re.escape(words)):
        rg.transient(rg.loads(stage(900.0, more=more)), time=0.001)


def test_methods_are_refused_by_name() -> None:
    model = rg.loads(stage(900.0))
    for words, asked in (
        ("method exponential: it needs a constant speed", {"speed_to": 300.0, "method": "exponential"}),
        ("method explicit: it does not take planets that go round", {"method": "explicit"}),
    ):
        with pytest.raises(AnalysisError, match=re.escape(words)):
            rg.transient(model, time=0.001, **asked)
    uneven = rg.loads(
        helical_stage(3, teeth=TEETH[3]).replace("planets = 3", 'angles = ["0 deg", "120 deg", "240.001 deg"]')
    )
    with pytest.raises(AnalysisError, match="planets at unequal angles"):
        rg.transient(uneven, time=0.001)


def test_own_is_a_planetary() -> None:
    """The pins of the own integration have the give that the package's loads of pins have."""
    system = System(rg.loads(stage(900.0)))
    W = float(system.train.ratio("carrier")) * SPEED
    mass = BODIES["planet"][0]
    radius = system.layout.planets[0].radius
    pull = pin_loads(system.layout, system.nodes, system.dofs, system.groups)[0].force(W)
    assert pull == pytest.approx(W**2 * mass * radius / (1.0 - W**2 * mass / PIN["radial"]), rel=1e-12)
