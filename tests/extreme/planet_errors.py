"""Errors of planetary stages against the planar equations of Lin and Parker, class by class in 40 digits.

A spur stage of points: sun s, ring r, carrier c, N planets, with radial and tangential displacements zeta and eta of planets in
axes that turn with the carrier (J. Lin, R. G. Parker, J. Vib. Acoust. 121 (1999) 316). Meshes and pins are stretched by

    d_s = y_s cos(psi - a) - x_s sin(psi - a) + u_s - zeta sin a - eta cos a + u,
    d_r = y_r cos(psi + a) - x_r sin(psi + a) + u_r + zeta sin a - eta cos a - u,
    x_c cos psi + y_c sin psi - zeta,    y_c cos psi - x_c sin psi + u_c - eta,

u = r_b theta, u_c = r_c theta_c. With planets in a wave e^{i k psi} and y = i x of central bodies, k = 1, all stretches are in
that wave: few equations for any N. Tilts of planets are a motion of their own.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import mpmath as mp
import numpy as np

import rotorgear as rg
from tests.extreme.models import root_error
from tests.paths import ROOT
from tests.planetary import helical_stage


@dataclass(frozen=True)
class Stage:
    """A spur stage whose ring is held by a torsional spring.

    Attributes:
        planets: N. sun, planet: teeth; the ring has what is left. module: in m.
        pin, mesh: springs in N/m; ground: of each central body, per direction.
        tilt: springs of a pin in N m/rad.
        masses: of sun, ring, carrier and planet in kg. inertias: about z in kg m^2; a planet has half of it about x and y.
    """

    planets: int = 3
    sun: int = 24
    planet: int = 27
    module: float = 0.003
    pin: float = 4e8
    mesh: float = 6e8
    ground: float = 2e8
    torsion: float = 3e6
    tilt: float = 1e5
    masses: tuple[float, float, float, float] = (2.6, 9.0, 14.0, 2.2)
    inertias: tuple[float, float, float, float] = (0.0029, 0.26, 0.11, 0.0046)

    @property
    def ring(self) -> int:
        return self.sun + 2 * self.planet

    @property
    def radius(self) -> float:
        """Of the pins' circle in m."""
        return 0.5 * self.module * (self.sun + self.planet)

    def model(self) -> rg.Model:
        """The same for the program."""
        parts = ['motions = ["bending", "torsion"]\n[operation]\ninput_shaft = "sun"\nspeed = "1000 rpm"']
        parts.append('[shafts.sun]\n[shafts.carrier]\n[shafts.ring]\nspeed_ratio = 0\n[shafts.planet]\ncarrier = "st"')
        parts.append(f'[carriers.st]\nshaft = "carrier"\nat = 0\nplanets = {self.planets}')
        sun, ring, carrier, planet = zip(self.masses, self.inertias, strict=True)
        for name, z, (m, J) in (("sun", self.sun, sun), ("planet", self.planet, planet), ("ring", self.ring, ring)):
            inside = "\ninternal = true" if name == "ring" else ""
            parts.append(
                f'[gears.{name}]\nkind = "spur"\nshaft = "{name}"\nat = 0\nteeth = {z}\nnormal_module = {self.module!r}\n'
                f"width = 0.03\nmass = {m!r}\npolar_inertia = {J!r}\ndiametral_inertia = {0.5 * J!r}{inside}"
            )
        parts.append(
            f'[disks.carrier]\nshaft = "carrier"\nat = 0\nmass = {carrier[0]!r}\npolar_inertia = {carrier[1]!r}\n'
            f"diametral_inertia = {0.5 * carrier[1]!r}"
        )
        for pinion, gear in (("sun", "planet"), ("planet", "ring")):
            parts.append(f'[meshes.{pinion}_{gear}]\npinion = "{pinion}"\ngear = "{gear}"\nstiffness = {self.mesh!r}')
        springs = f"radial = {self.pin!r}, tilt = {self.tilt!r}"
        parts.append(f'[bearings.pin]\nshaft = "planet"\nat = 0\nstiffness = {{ {springs} }}')
        for name in ("sun", "ring", "carrier"):
            held = f", torsion = {self.torsion!r}" if name == "ring" else ""
            parts.append(
                f'[supports.{name}]\nshaft = "{name}"\nat = 0\nfixed = ["tilt_x", "tilt_y"]\n'
                f"stiffness = {{ x = {self.ground!r}, y = {self.ground!r}{held} }}"
            )
        return rg.loads("\n".join(parts))

    def roots(self, W: float) -> list[mp.mpc]:
        """All s in rad/s in the fixed frame, one of each conjugate pair, at a speed W of the carrier, but the free rotation."""
        N = self.planets
        found = self._half(0, W)
        for k in range(2, N - 1):
            found += self._half(k, W)
        # A wave of k = 1 in axes that turn goes round by W less in those that stand still; k = -1 is its conjugate.
        found += [s - 1j * W for s in self._roots(1, W)]
        for w in self._tilts(W):
            found += [1j * (w - W), 1j * (w + W), *[1j * w] * (N - 2)]
        return [mp.mpc(mp.re(s), abs(mp.im(s))) for s in found]

    def _half(self, k: int, W: float) -> list[mp.mpc]:
        """One of each conjugate pair of a wave whose equations are real, without the double zero of the train."""
        every = self._roots(k, W)
        nothing = mp.mpf(10) ** -15 * max(map(abs, every))
        half = [s for s in every if mp.im(s) > nothing]
        assert 2 * len(half) == len(every) - (2 if k == 0 else 0)
        return half

    def _roots(self, k: int, W: float) -> list[mp.mpc]:
        """All s of a wave: (s^2 M + s W G + K - W^2 P) p = 0, with accelerations p'' + 2 W S p' - W^2 p in the turning plane."""
        N = self.planets
        a = mp.radians(20)
        W = mp.mpf(W)
        e = mp.expj
        r = mp.mpf(self.radius)
        base = [mp.mpf(self.module) * z * mp.cos(a) / 2 for z in (self.sun, self.ring, self.planet)]
        # Motions of the sun, the ring, the carrier, and zeta, eta, u of the planets.
        reach = [base[0], base[1], r]
        if k == 0:
            inertia = [mp.mpf(J) / b**2 for J, b in zip(self.inertias, reach, strict=False)]
            held = [mp.mpf(0), mp.mpf(self.torsion) / base[1] ** 2, mp.mpf(0)]
            strains = [
                [1, 0, 0, -mp.sin(a), -mp.cos(a), 1],
                [0, 1, 0, mp.sin(a), -mp.cos(a), -1],
                [0, 0, 0, -1, 0, 0],
                [0, 0, 1, 0, -1, 0],
            ]
        else:
            # x = 1, y = i: y cos(psi - a) - x sin(psi - a) = i e^{i (psi - a)}.
            inertia = [2 * mp.mpf(m) for m in self.masses[:3]]
            held = [2 * mp.mpf(self.ground)] * 3
            strains = [
                [1j * e(-a), 0, 0, -mp.sin(a), -mp.cos(a), 1],
                [0, 1j * e(a), 0, mp.sin(a), -mp.cos(a), -1],
                [0, 0, 1, -1, 0, 0],
                [0, 0, 1j, 0, -1, 0],
            ]
        B = mp.matrix(strains)
        stiff = mp.diag([mp.mpf(self.mesh)] * 2 + [mp.mpf(self.pin)] * 2)
        K = N * (B.H * stiff * B)
        m, J = mp.mpf(self.masses[3]), mp.mpf(self.inertias[3])
        M = mp.diag([*inertia, N * m, N * m, N * J / base[2] ** 2])
        for j, spring in enumerate(held):
            K[j, j] += spring
        G = mp.zeros(6)  # 2 S, on e^{i w t}: i w G
        G[3, 4], G[4, 3] = -2 * N * m, 2 * N * m
        P = mp.diag([0, 0, 0, N * m, N * m, 0])
        if k == 0:
            d = m * W**2 * r / (mp.mpf(self.pin) - m * W**2)
            K[2, 2] += N * m * W**2 * (r + d) / r
        else:
            for j in range(3):
                # x' = -2 W S: the wave goes round, y = i x.
                G[j, j] = -2j * inertia[j]
                P[j, j] = inertia[j]
        keep = list(range(6)) if k in (0, 1) else [3, 4, 5]
        n = len(keep)
        cut = [mp.matrix([[A[i, j] for j in keep] for i in keep]) for A in (M, W * G, K - W**2 * P)]
        inverse = mp.inverse(cut[0])
        companion = mp.zeros(2 * n)
        lower = -inverse * cut[2], -inverse * cut[1]
        for i in range(n):
            companion[i, n + i] = 1
            for j in range(n):
                companion[n + i, j] = lower[0][i, j]
                companion[n + i, n + j] = lower[1][i, j]
        return list(mp.eig(companion, left=False, right=False))

    def _tilts(self, W: float) -> Iterator[mp.mpf]:
        """Both omega of phi = phi_x + i phi_y of a planet on its pin, in its own axes.

        I_d (phi'' + 2 i W phi' - W^2 phi) - i I_p w_p (phi' + i W phi) + k phi = 0 with its spin w_p in space.
        """
        polar = mp.mpf(self.inertias[3])
        diametral = polar / 2
        W = mp.mpf(W)
        spin = W * (1 - mp.mpf(self.ring) / self.planet)
        # On e^{i w t}: -I_d (w + W)^2 + I_p w_p (w + W) + k = 0.
        h = polar * spin / (2 * diametral)
        root = mp.sqrt(h**2 + mp.mpf(self.tilt) / diametral)
        yield from (h + root - W, h - root - W)


def stage_error(stage: Stage, W: float = 0.0) -> float:
    """Largest relative error of all s where the carrier turns with W in rad/s; infinite where the free rotation is not found."""
    model = stage.model()
    exact = stage.roots(W)
    found = rg.modal(model, speed=W / float(model.layout.train.ratios["carrier"]) if W else None, modes=len(exact) + 1)
    if len(found) != len(exact) + 1 or np.count_nonzero(found.rigid) != 1:
        return math.inf
    return root_error(found, exact)


def share_error(count: int) -> float:
    """Largest relative error of the forces of many planets between a sun that floats and their carrier: F = T/(N r_b)."""
    stage = Stage(planets=count, sun=1000, planet=20)
    model = stage.model().with_({"operation.torque": 1e4, "operation.output_shaft": "carrier"})
    exact = 1e4 / (count * 0.5 * stage.module * stage.sun * math.cos(math.radians(20.0)))
    return float(np.max(np.abs(rg.static(model, speed=0.0).mesh_force / exact - 1.0)))


def inclined(angle: float) -> rg.Model:
    """A helical stage with the axis of its carrier inclined by an angle in rad to those of sun and ring."""
    text = helical_stage(4, teeth=(26, 36, 98))
    for name in ("sun", "ring", "carrier"):
        axis = f"\naxis = [{angle!r}, 0.0, 1.0]" if name == "carrier" else ""
        text = text.replace(f"[shafts.{name}]", f"[shafts.{name}]\nposition = [0.0, 0.0, 0.0]{axis}", 1)
    return rg.loads(text)


def inclined_error(angle: float) -> float:
    """How far frequencies are from those of parallel axes."""
    found, plain = (rg.modal(inclined(a), speed=300.0, modes=12).natural_frequency_hz[1:] for a in (angle, 0.0))
    return float(np.max(np.abs(found / plain - 1.0)))


def thin_ring(rim: str) -> rg.Model:
    """The shipped planetary stage with another rim of its ring."""
    text = (ROOT / "models" / "planetary.toml").read_text(encoding="utf-8")
    return rg.loads(text.replace('outer_diameter = "250 mm"', f'rim_thickness = "{rim}"'))


def thin_ring_mass(rim: float) -> float:
    """Mass of a ring with a rim of so many m, from its reference circle on."""
    model = thin_ring(f"{rim!r} m")
    geometry = model.layout.gear("ring").geometry
    assert geometry is not None
    reference, outer = -0.5 * mp.mpf(geometry.reference_diameter), -0.5 * mp.mpf(geometry.root_diameter) + mp.mpf(rim)
    exact = mp.mpf(7850) * mp.mpf("0.032") * mp.pi * (outer**2 - reference**2)
    told = next(body.mass for address, _, body in model.layout.bodies if address == "gears.ring")
    return float(abs(mp.mpf(told) / exact - 1))
