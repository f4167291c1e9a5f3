import numpy as np
import pytest

from rotorgear.elements.gear_mesh import ContactGeometry, flank_normal
from rotorgear.export.attachment import Skeleton
from rotorgear.export.layout import display_frames
from rotorgear.export.parts import FINE, LIGHT, Detail
from rotorgear.export.solids import KINDS, LARGEST_TURN, Solids, build_solids
from rotorgear.export.surface import make_surface
from rotorgear.export.teeth import contour_of, tooth_phases, twist_rates
from rotorgear.model.load import loads
from rotorgear.results.modal import NodeTable
from tests.unit.export.small_models import CHAIN, HERRINGBONE, PAIR, model_of, modes_of


def solids_of(text: str, detail: Detail = LIGHT) -> Solids:
    result = modes_of(text)
    return build_solids(result.model, result.nodes, detail)


def only(solids: Solids, part: str, kind: str) -> tuple[np.ndarray, float]:
    """Numbers of the points of a part, and the volume its cells enclose."""
    chosen = (solids.part == solids.part_names.index(part)) & (solids.kind == KINDS.index(kind))
    quads, triangles = np.split(chosen, [len(solids.quads)])
    surface = make_surface(solids.points, [solids.quads[quads]], [solids.triangles[triangles]])
    return np.unique(np.concatenate([surface.quads.ravel(), surface.triangles.ravel()])), surface.volume()


def test_a_stepped_hollow_conical_shaft_has_its_volume():
    _, volume = only(solids_of(PAIR, FINE), "shafts.fast", "shaft")
    bored = 0.25 * np.pi * (0.04**2 - 0.01**2) * 0.08
    cone = np.pi / 12.0 * 0.06 * (0.05**2 + 0.05 * 0.04 + 0.04**2)
    plain = 0.25 * np.pi * 0.04**2 * 0.06
    share = FINE.segments / (2.0 * np.pi) * np.sin(2.0 * np.pi / FINE.segments)
    assert volume == pytest.approx(share * (bored + cone + plain), rel=1e-9)


def test_a_gear_has_its_root_and_tip_circles_its_width_and_its_number_of_teeth():
    solids = solids_of(HERRINGBONE, FINE)
    model = model_of(HERRINGBONE)
    geometry = model.gears["wheel"].geometry
    points = solids.points[only(solids, "gears.wheel", "gear")[0]]
    x, y, z = (points - np.array([0.0, 0.12, 0.0])).T
    radius = np.hypot(x, y)
    assert 2.0 * radius.max() == pytest.approx(geometry.effective_tip_diameter)
    assert 2.0 * radius[radius > 0.01].min() == pytest.approx(geometry.root_diameter)
    assert (z.min(), z.max()) == pytest.approx((0.045, 0.115))
    assert not np.any((z > 0.0751) & (z < 0.0849)), "there is a gap between the helices"
    tips = (radius > 0.4999999 * geometry.effective_tip_diameter) & (np.abs(z - 0.045) < 1e-9)
    assert np.count_nonzero(tips) == 2 * 40


@pytest.mark.parametrize("hand", [1, -1])
def test_flanks_lean_to_the_hand_that_the_mesh_element_works_with(hand):
    """The normal of a drawn pinion flank that drives counter-clockwise leans along z as the force on the gear does."""
    text = (
        PAIR if hand == 1 else PAIR.replace('"right"', '"other"').replace('"left"', '"right"').replace("other", "left")
    )
    model = loads(text)
    contact = model.layout.mesh("pair").contacts[0]
    assert contact.hand == hand
    rate = twist_rates(model.layout.gear("pinion"))[0]
    radius = 0.5 * model.gears["pinion"].geometry.reference_diameter
    along = np.array([0.0, rate * radius, 1.0])  # a flank line at angle 0: (radial, tangential, axial)
    drawn = np.cross(along, [1.0, 0.0, 0.0])  # at right angles to it and to the radius
    drawn *= np.sign(drawn[1])
    geometry = ContactGeometry(0.0, contact.pressure_angle, contact.base_helix_angle, hand, 1, 0.05, 0.1)
    assert np.sign(drawn[2]) == np.sign(flank_normal(geometry)[2]) == -hand


def test_the_right_hand_helix_of_the_solids_turns_counter_clockwise_towards_positive_z():
    solids = solids_of(PAIR, FINE)
    model = model_of(PAIR)
    geometry = model.gears["pinion"].geometry
    points = solids.points[only(solids, "gears.pinion", "gear")[0]]
    x, y, z = points[np.hypot(points[:, 0], points[:, 1]) > 0.4999999 * geometry.effective_tip_diameter].T
    angle = np.unwrap(np.sort(np.arctan2(y, x)[z == z.min()]))
    pitch = 2.0 * np.pi / 24
    turn = np.tan(geometry.helix_angle) / (0.5 * geometry.reference_diameter)
    for place in np.unique(z):
        shift = np.arctan2(y, x)[z == place] - angle[0] - turn * (place - z.min())
        # the two edges of a tip
        first = 0.0
        second = angle[1] - angle[0]
        miss = np.minimum(*(np.abs((shift - edge + 0.5 * pitch) % pitch - 0.5 * pitch) for edge in (first, second)))
        assert np.max(miss) < 1e-9


def test_the_two_helices_of_a_herringbone_gear_mirror_each_other():
    solids = solids_of(HERRINGBONE, FINE)
    points = solids.points[only(solids, "gears.pinion", "gear")[0]]
    mirrored = points * np.array([1.0, 1.0, -1.0]) + np.array([0.0, 0.0, 0.16])
    order = np.lexsort(np.round(points, 9).T)
    mirror_order = np.lexsort(np.round(mirrored, 9).T)
    assert np.allclose(points[order], mirrored[mirror_order], rtol=0.0, atol=2e-9)
    low, high = twist_rates(model_of(HERRINGBONE).layout.gear("pinion"))
    assert low > 0.0 > high


@pytest.mark.parametrize("text", [PAIR, HERRINGBONE])
def test_teeth_stand_in_the_gaps_of_their_mates_all_along_the_face(text):
    """Counted from the line of centres, a tooth's share of the pitch on one gear is a gap's on the other, which turns back."""
    model = model_of(text)
    frames = display_frames(model)
    phases = tooth_phases(model, frames)
    one, two = (model.gears[name] for name in ("pinion", "wheel"))
    here = frames[one.shaft].origin
    there = frames[two.shaft].origin
    out = np.arctan2(there[1] - here[1], there[0] - here[0])
    for z in (0.0, 0.011, -0.013):
        share = []
        for name, gear, direction in (("pinion", one, out), ("wheel", two, out + np.pi)):
            place = phases[name] + twist_rates(model.layout.gear(name))[0] * z  # at a distance z from the middle plane
            share.append((direction - place) / (2.0 * np.pi / gear.teeth))
        assert (share[0] + share[1]) % 1.0 == pytest.approx(0.5)
    assert model.layout.gear("pinion").planes == pytest.approx(model.layout.gear("wheel").planes)


def test_teeth_in_mesh_do_not_cut_into_each_other():
    """With profile shifts that leave no backlash, flanks touch along the line of action and never overlap."""
    model = model_of(HERRINGBONE)
    phases = tooth_phases(model, display_frames(model))
    outlines = []
    for name, centre in (("pinion", 0.0), ("wheel", 0.12j)):
        angles, radii = contour_of(model, name, 0.0, 60, 0)
        outlines.append(((angles + phases[name]).ravel(), radii.ravel(), centre))
    (a1, r1, c1), (a2, r2, c2) = outlines
    corners = c2 + r2 * np.exp(1j * a2) - c1
    seen = np.mod(np.angle(corners) - a1[0], 2.0 * np.pi)
    own = np.mod(a1 - a1[0], 2.0 * np.pi)
    surface = np.interp(seen, own, r1, period=2.0 * np.pi)
    assert np.min(np.abs(corners) - surface) > -2e-6


@pytest.mark.parametrize("text", [PAIR, HERRINGBONE, CHAIN])
def test_a_rigid_motion_of_all_nodes_moves_what_is_carried_by_shafts_rigidly(text):
    solids = solids_of(text)
    shift = np.array([1.0, -2.0, 0.5])
    turn = np.array([0.3, -0.2, 0.7])
    arm = solids.node_positions - np.array([0.1, 0.2, 0.3])
    shape = np.hstack([shift + np.cross(turn, arm), np.tile(turn, (len(arm), 1))])
    moved = solids.displacement(shape)
    expected = shift + np.cross(turn, solids.points - np.array([0.1, 0.2, 0.3]))
    carried = solids.attachment.left >= 0
    assert np.allclose(moved[carried], expected[carried], rtol=0.0, atol=1e-12)
    assert not np.any(moved[~carried])
    standing = np.isin(solids.kind, [KINDS.index(kind) for kind in ("bearing", "support")])
    cells = np.split(~standing, [len(solids.quads)])
    moving = np.concatenate([solids.quads[cells[0]].ravel(), solids.triangles[cells[1]].ravel()])
    assert np.all(carried[moving]), "only bearings and supports touch the ground"


def test_points_between_nodes_follow_the_deflection_curve_of_a_timoshenko_cantilever():
    """Two nodes hold the closed form of a cantilever under end force and end moment; the points between have to find it."""
    L = 0.3
    E = 206e9
    nu = 0.3
    kappa = 0.8
    model = loads(
        "schema_version = 1\n[shafts.s]\n"
        "sections = [{ length = 0.3, outer_diameter = 0.1, bore = 0.02, shear_coefficient = 0.8 }]\n"
        '[supports.wall]\nshaft = "s"\nat = "start"\nfixed = ["all"]\n'
    )
    area = 0.25 * np.pi * (0.1**2 - 0.02**2)
    inertia = np.pi / 64.0 * (0.1**4 - 0.02**4)
    bend = E * inertia
    shear = kappa * E / (2.0 * (1.0 + nu)) * area

    def curve(z: np.ndarray) -> np.ndarray:
        """x y z tx ty tz (k, 6) for 3 kN along x, -2 kN along y and 50 N m about y at the end, with stretch and twist."""
        w = (L - z / 3.0) * z**2 / (2.0 * bend) + z / shear
        t = (L - z / 2.0) * z / bend
        x = 3e3 * w + 50.0 * z**2 / (2.0 * bend)
        ty = 3e3 * t + 50.0 * z / bend
        return np.column_stack([x, -2e3 * w, 1e-5 * z, 2e3 * t, ty, 1e-3 * z])

    ends = np.array([0.0, L])
    between = np.linspace(0.0, L, 13)
    nodes = NodeTable(("s", "s"), np.column_stack([np.zeros((2, 2)), ends]), ("", ""))
    skeleton = Skeleton(model, nodes, display_frames(model))
    for offset in (np.zeros(3), np.array([0.05, 0.0, 0.0]), np.array([0.0, 0.05, 0.0])):
        points = np.column_stack([np.zeros((13, 2)), between]) + offset
        expected = curve(between)[:, :3] + np.cross(curve(between)[:, 3:], offset)
        found = skeleton.along("s", points).displacement(curve(ends))
        assert np.allclose(found, expected, rtol=1e-12, atol=1e-12 * np.max(np.abs(expected)))


def test_the_order_of_the_rows_of_a_node_table_does_not_matter():
    result = modes_of(PAIR)
    order = np.random.default_rng(3).permutation(len(result.nodes.shaft))
    nodes = NodeTable(
        tuple(result.nodes.shaft[k] for k in order),
        result.nodes.position[order],
        tuple(result.nodes.pedestal[k] for k in order),
    )
    shape = result.shapes[:, :, 2]
    shuffled = build_solids(result.model, nodes).displacement(shape[order])
    assert np.array_equal(shuffled, solids_of(PAIR).displacement(shape))


def test_shafts_without_a_place_are_shown_where_nothing_overlaps():
    model = model_of(CHAIN)
    axes = {name: tuple(frame.origin) for name, frame in display_frames(model).items()}
    assert set(axes) == set(model.shafts)
    assert len(set(axes.values())) == 4
    distance = np.linalg.norm(np.subtract(axes["first"], axes["second"]))
    assert distance == pytest.approx(0.15 / np.cos(np.deg2rad(20.0)))
    solids = solids_of(CHAIN)
    assert np.all(np.isfinite(solids.points))
    assert {"gears.pinion", "disks.load", "couplings.input"} <= set(solids.part_names)


def test_a_coupled_shaft_without_a_place_continues_the_other_one():
    text = PAIR.replace('[shafts.tail]\nposition = ["150 mm", 0]', "[shafts.tail]")
    tail, slow = display_frames(loads(text))["tail"], display_frames(model_of(PAIR))["slow"]
    assert tail.origin.tolist() == slow.origin.tolist()


def test_torsion_turns_disks_without_shape_by_the_angle_of_their_node():
    solids = solids_of(CHAIN)
    result = modes_of(CHAIN)
    points, _ = only(solids, "disks.load", "disk")
    node = result.nodes.on_shaft("load")[0]
    angle = result.shapes[node, 5, 1].real
    arm = (solids.points[points] - solids.node_positions[node])[:, :2]
    moved = solids.displacement(result.shapes[:, :, 1]).real[points]
    assert angle != 0.0
    assert np.allclose(moved[:, :2], angle * np.column_stack([-arm[:, 1], arm[:, 0]]), rtol=1e-12, atol=1e-15)


def test_shapes_are_scaled_to_a_twentieth_of_the_model_or_less_where_bodies_turn_far():
    for text in (PAIR, CHAIN):
        solids = solids_of(text)
        result = modes_of(text)
        for mode in range(len(result)):
            shape = result.shapes[:, :, mode]
            moved, scale = solids.scaled(shape)
            share = np.max(np.linalg.norm(moved, axis=1)) / solids.size
            turn = scale * np.max(np.linalg.norm(shape[:, 3:], axis=1))
            assert share == pytest.approx(0.05) or turn == pytest.approx(LARGEST_TURN)
            assert share < 0.05 * (1.0 + 1e-12)
            assert turn < LARGEST_TURN * (1.0 + 1e-12)
            assert np.max(np.linalg.norm(solids.scaled(shape, 0.2)[0], axis=1)) == pytest.approx(0.2 * solids.size)


def test_a_shape_in_which_nothing_moves_is_left_alone():
    solids = solids_of(PAIR)
    moved, scale = solids.scaled(np.zeros((len(solids.node_positions), 6)))
    assert (scale, np.max(np.abs(moved))) == (1.0, 0.0)


def test_a_ring_follows_the_shaft_inside_and_the_pedestal_outside():
    solids = solids_of(PAIR)
    result = modes_of(PAIR)
    shape = np.zeros((len(result.nodes.shaft), 6))
    shape[result.nodes.pedestal.index("fast_left"), 0] = 1.0
    points, _ = only(solids, "bearings.fast_left", "bearing")
    moved = solids.displacement(shape)[points, 0]
    radius = np.hypot(*solids.points[points, :2].T)
    assert set(moved) == {0.0, 1.0}
    assert np.all(moved[radius < 0.021] == 0.0), "the inner ring stays with the shaft"
