"""Teeth on rim, web and hub: a full disc as a wheel is the ring, both models along the face agree, thinner parts give more."""

from __future__ import annotations

import math

import numpy as np
import pytest

from rotorgear.gears.geometry.blank import BlankShape, solid_blank
from rotorgear.gears.geometry.geometry import GearGeometry
from rotorgear.gears.tooth_fe.blank_section import BlankSection
from rotorgear.gears.tooth_fe.compliance_model import compliance_key, gear_compliance, pitch_of, sector_of, wind_up
from rotorgear.gears.tooth_fe.gear_compliance import GearCompliance
from rotorgear.gears.tooth_fe.points import MeshSize
from rotorgear.gears.tooth_fe.settings import ToothFe
from rotorgear.gears.tooth_fe.wheel_compliance import wheel_flexibility, wheel_motions
from rotorgear.gears.tooth_fe.wheel_sector import WheelSector
from validation.benchmarks.cyclic_wheel import WHEELS, cyclic_deflection, program_deflection
from validation.benchmarks.wheel_compliance import TABLE, Expected, found

SIZE = MeshSize(5, 2, 4, 2, 4, 4)
EVEN = MeshSize(5, 2, 4, 2, 4, 8)  # polynomials up to the eighth along the face
TEETH = 30
ROOT = 0.5 * TEETH - 1.25
WIDTH = 6.0


def compliance(
    blank: BlankShape,
    *,
    space: bool,
    nu: float = 0.3,
    helix: float = 0.0,
    body: str = "wheel",
    size: MeshSize = SIZE,
) -> GearCompliance:
    gear = GearGeometry(TEETH, 1.0, math.radians(20.0), math.radians(helix))
    fe = ToothFe(body=body, size=size)  # type: ignore[arg-type]
    return gear_compliance(compliance_key(gear, fe, nu, WIDTH, blank.bore_radius, space=space, blank=blank))


def webbed(rim: float = 2.0, web: float = 1.5, position: float = 0.0) -> BlankShape:
    return BlankShape(4.0, ROOT - rim, web, position, 6.0, WIDTH)


def mean(found: GearCompliance) -> float:
    """Mean deflection of the loaded tooth's flank under a load spread evenly over its nodes."""
    return float(found.response(0).mean())


def difference(one: GearCompliance, other: GearCompliance, tooth: int) -> float:
    apart = np.abs(one.response(tooth) - other.response(tooth)).max()
    return float(apart / np.abs(other.response(0)).max())


@pytest.mark.parametrize(("space", "helix", "nu"), [(False, 0.0, 0.0), (True, 25.0, 0.3)])
def test_a_full_disc_as_a_wheel_is_the_ring(space: bool, helix: float, nu: float) -> None:
    """In the plane without Poisson's ratio, where free ends of the face change nothing; helical teeth in any case."""
    blank = solid_blank(8.0)
    wheel = compliance(blank, space=space, nu=nu, helix=helix)
    ring = compliance(blank, space=space, nu=nu, helix=helix, body="ring")
    for tooth in (0, 1, -1, 3):
        assert difference(wheel, ring, tooth) <= 4e-3


@pytest.mark.long
def test_polynomials_along_the_face_give_what_layers_give() -> None:
    blank = webbed()
    layers = compliance(blank, space=True)
    even = compliance(blank, space=False, size=EVEN)
    planes = len(layers.height)
    along = np.zeros(planes)
    for plane in range(0, planes - 1, 2):
        along[plane : plane + 3] += np.array([1.0, 4.0, 1.0]) / 3.0 / (planes - 1)
    for tooth in (0, 1):
        G = layers.response(tooth).reshape(planes, len(even.roll), planes, len(even.roll))
        flat = WIDTH * np.einsum("h,hrks,k->rs", along, G, along)
        assert np.abs(flat - even.response(tooth)).max() <= 0.015 * np.abs(even.response(0)).max()


def test_seats_of_pitches_far_apart_feel_each_other_through_the_blank_only() -> None:
    """More teeth than angles at which cuts are eliminated; beside motions that are solved harmonic by harmonic."""
    teeth = 90
    blank = BlankShape(20.0, 0.5 * teeth - 1.25 - 3.0, 1.5, 0.0, 25.0, WIDTH)
    gear = GearGeometry(teeth, 1.0, math.radians(20.0), 0.0)
    key = compliance_key(gear, ToothFe(body="wheel", size=EVEN), 0.3, WIDTH, 20.0, space=False, blank=blank)
    assert key.blank is not None
    sector = sector_of(key, pitch_of(key)[1])
    assert isinstance(sector, WheelSector)
    section = BlankSection(key.blank, key.face, key.inner_radius, key.poisson_ratio, 1.0)
    G, _ = wheel_flexibility(sector, section, teeth, 2)
    force = np.linspace(1.0, 2.0, sector.flank)
    pitches = np.arange(-2, 3)
    moved = wheel_motions(sector, section, teeth, force, pitches)
    h = 2 * sector.cut + sector.middle
    S = sector.stiffness
    loads = np.where(pitches[:, None] == 0, force, 0.0)
    expected = np.linalg.solve(S[h:, h:], (loads - moved @ S[:h, h:]).T).T
    assert G @ force == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())


def test_thinner_rims_and_webs_give_more() -> None:
    rims = [mean(compliance(webbed(rim=rim), space=False)) for rim in (4.0, 2.0, 1.2)]
    webs = [mean(compliance(webbed(web=web), space=False)) for web in (6.0, 1.5, 0.8)]
    assert rims == sorted(rims)
    assert webs == sorted(webs)
    assert webs[0] == pytest.approx(mean(compliance(solid_blank(4.0), space=False)), rel=5e-3)


def test_where_the_rim_is_cut_from_the_blank_does_not_matter() -> None:
    """A rim of 3 modules is meshed with the teeth, one of 3.001 modules is cut in its own middle."""
    whole, cut = (mean(compliance(webbed(rim=rim), space=False, size=EVEN)) for rim in (3.0, 3.001))
    assert cut == pytest.approx(whole, rel=5e-3)


def test_a_coarser_mesh_of_the_blank_is_stiffer_by_a_little() -> None:
    """Quadratic elements are compatible: the fewer, the stiffer. The teeth above have the same mesh."""
    gear = GearGeometry(TEETH, 1.0, math.radians(20.0), 0.0)
    found = [
        mean(gear_compliance(compliance_key(gear, fe, 0.3, WIDTH, 4.0, space=False, blank=webbed())))
        for fe in (ToothFe(body="wheel", size=EVEN, blank_coarseness=side) for side in (1.0, 2.0, 3.0))
    ]
    assert found == sorted(found, reverse=True)
    assert found[0] == pytest.approx(found[1], rel=0.01)
    assert found[0] != found[1]


def test_a_web_off_the_middle_tilts_the_rim() -> None:
    low, high = (compliance(webbed(position=position), space=True) for position in (-2.0, 2.0))
    planes = len(low.height)

    def ends(found: GearCompliance) -> tuple[float, float]:
        G = found.response(0).reshape(planes, -1, planes, len(found.roll))
        deflection = G.mean(axis=(1, 2, 3))
        return float(deflection[0]), float(deflection[-1])

    # The end over the web gives less; the mirror image is the same turned round.
    first, last = ends(low)
    assert last > 1.3 * first
    assert ends(high) == pytest.approx((last, first), rel=1e-9)


def test_the_compliance_without_wind_up_stays_positive_and_loses_the_rotation_only() -> None:
    gear = GearGeometry(TEETH, 1.0, math.radians(20.0), 0.0)
    key = compliance_key(gear, ToothFe(body="wheel", size=SIZE), 0.3, WIDTH, 4.0, space=False, blank=webbed())
    own = gear_compliance(key).response(0)
    lost = wind_up(key)
    assert 0.0 < lost < float(own.min())
    assert np.linalg.eigvalsh(own - lost)[0] > 0.0


@pytest.mark.long
@pytest.mark.parametrize("row", TABLE, ids=lambda row: f"{row.rim} {row.web}")
def test_the_wheel_in_3d_within_a_percent(row: Expected) -> None:
    ours = found(row)
    assert ours.mean == pytest.approx(row.mean, rel=0.01)
    assert ours.middle == pytest.approx(row.middle, rel=0.01)
    assert ours.ends == pytest.approx(row.ends, rel=0.01)
    assert ours.wind_up == pytest.approx(row.wind_up, rel=0.01)
    assert ours.mean - ours.wind_up == pytest.approx(row.mean - row.wind_up, rel=0.015)
    assert ours.even == pytest.approx(row.mean, rel=0.015)


@pytest.mark.long
@pytest.mark.parametrize("name", WHEELS)
def test_blanks_of_all_kinds_within_two_percent_of_a_plain_sector(name: str) -> None:
    """Webs off the middle and flush, thick rims: mean, middle, both ends and wind-up."""
    truth = cyclic_deflection(WHEELS[name])
    ours = program_deflection(WHEELS[name])
    assert (ours.mean, ours.middle, *ours.ends) == pytest.approx((truth.mean, truth.middle, *truth.ends), rel=0.02)
    assert ours.wind_up == pytest.approx(truth.wind_up, rel=0.01)
    assert ours.mean - ours.wind_up == pytest.approx(truth.mean - truth.wind_up, rel=0.02)
