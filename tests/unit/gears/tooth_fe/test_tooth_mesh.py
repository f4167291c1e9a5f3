"""The mesh of a pitch: nodes on the outline, areas, sound elements over the whole range of gears, lazy packages."""

from __future__ import annotations

import math
import sys
from itertools import product

import numpy as np
import pytest

from rotorgear.errors import AnalysisError, MissingExtraError, RotorgearError
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.geometry.outline import tooth_outline
from rotorgear.gears.tooth_fe.mesh import LEAST_INNER, PitchMesh, pitch_mesh, scikit_fem
from rotorgear.gears.tooth_fe.settings import ToothFe
from tests.unit.gears.tooth_pairs import pair, spur

REFUSALS = ("pointed at the tip", "cuts through the root", "undercut so deeply", "cuts the flank up to")


def mesh_of(geometry: GearGeometry, preset: str = "default") -> PitchMesh:
    outline = tooth_outline(geometry)
    inner = max(outline.root_radius - 3.0, LEAST_INNER * outline.root_radius)
    return pitch_mesh(outline, ToothFe(preset).mesh_size(10.0, space=False), inner)  # type: ignore[arg-type]


def gear(z: int, x: float = 0.0, alpha: float = 20.0, beta: float = 0.0) -> GearGeometry:
    return GearGeometry(z, 1.0, math.radians(alpha), math.radians(beta), profile_shift=x)


def test_flank_nodes_lie_on_the_involute_and_normals_on_its_normals() -> None:
    mesh = mesh_of(gear(34, 0.2))
    r_b = mesh.outline.geometry.base_radius
    radius = np.linalg.norm(mesh.points[mesh.flank], axis=1)
    assert radius == pytest.approx(np.hypot(r_b, mesh.roll), rel=1e-12)
    # The normal of an involute touches the base circle.
    (x, y), (n_x, n_y) = mesh.points[mesh.flank].T, mesh.normal.T
    lever = np.abs(x * n_y - y * n_x)
    assert lever == pytest.approx(np.full(len(lever), r_b), rel=1e-9)


def test_the_area_is_that_of_the_outline() -> None:
    mesh = mesh_of(gear(20), "fine")
    skfem = scikit_fem()
    area = float(skfem.Basis(mesh.mesh, skfem.ElementQuad2(), intorder=4).dx.sum())
    radii, angles = mesh.outline.tooth(400)
    outer = 0.5 * np.abs(np.sum(radii[1:] * radii[:-1] * np.sin(np.diff(angles))))
    inner = 0.5 * np.min(np.linalg.norm(mesh.points, axis=1)) ** 2 * mesh.pitch_angle
    assert area == pytest.approx(outer - inner, rel=2e-4)


def test_both_cuts_are_the_same_but_for_a_pitch() -> None:
    mesh = mesh_of(gear(17, 0.3))
    c = math.cos(mesh.pitch_angle)
    s = math.sin(mesh.pitch_angle)
    turned = mesh.points[mesh.left] @ np.array([[c, -s], [s, c]])
    assert mesh.points[mesh.right] == pytest.approx(turned, abs=1e-12)


def _sound(z: int, x: float, alpha: float, beta: float) -> bool:
    try:
        mesh = mesh_of(gear(z, x, alpha, beta))
    except RotorgearError as error:
        if not any(word in str(error) for word in REFUSALS):
            raise
        return False
    skfem = scikit_fem()
    return bool(skfem.Basis(mesh.mesh, skfem.ElementQuad2(), intorder=4).dx.min() > 0.0)


@pytest.mark.parametrize("alpha", [14.5, 20.0, 25.0])
def test_gears_at_the_ends_of_the_range_are_meshed_or_refused(alpha: float) -> None:
    found = {(z, x): _sound(z, x, alpha, 20.0) for z, x in product((6, 12, 150), (-0.6, 0.0, 0.9))}
    assert found[12, 0.0]
    assert all(found[150, x] for x in (-0.6, 0.0, 0.9))


@pytest.mark.long
@pytest.mark.parametrize("alpha", [14.5, 20.0, 25.0])
@pytest.mark.parametrize("beta", [0.0, 20.0, 35.0])
def test_the_whole_range_of_gears_is_meshed_or_refused_with_a_reason(alpha: float, beta: float) -> None:
    shifts = [round(-0.6 + 0.15 * i, 2) for i in range(11)]
    found = [_sound(z, x, alpha, beta) for z in (6, 8, 10, 12, 17, 25, 40, 60, 100, 150) for x in shifts]
    assert sum(found) > 0.85 * len(found)


def test_an_inner_circle_outside_of_the_root_is_refused() -> None:
    outline = tooth_outline(gear(20))
    with pytest.raises(AnalysisError, match="must lie between 0 and the root radius"):
        pitch_mesh(outline, ToothFe().mesh_size(10.0, space=False), outline.root_radius)


def test_without_scikit_fem_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "skfem", None)
    with pytest.raises(MissingExtraError, match=r"scikit-fem.*rotorgear\[tooth\]"):
        mesh_of(gear(20))


def test_presets_get_finer_and_helical_teeth_get_layers() -> None:
    sizes = [ToothFe(name).mesh_size(10.8, space=False).elements for name in ("preview", "default", "fine")]  # type: ignore[arg-type]
    assert sizes == sorted(sizes)
    assert ToothFe("fine").mesh_size(10.8, space=True).face > ToothFe().mesh_size(10.8, space=True).face > 0
    assert spur().fe == pair().fe
