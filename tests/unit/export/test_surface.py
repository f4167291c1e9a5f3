import numpy as np
import pytest

from rotorgear.export.surface import Surface, ball, beam, hollow_cylinder, join, revolve, twisted_prism, wedge

HEXAGON = np.linspace(0.0, 2.0 * np.pi, 6, endpoint=False).reshape(3, 2)


def polygon_share(n: int) -> float:
    """Area of a regular polygon over that of its circle."""
    return n / (2.0 * np.pi) * np.sin(2.0 * np.pi / n)


def prism(inner: float, twist: float = 0.4) -> Surface:
    z = np.linspace(-0.1, 0.3, 5)
    return twisted_prism(HEXAGON, np.full((3, 2), 2.0), z, twist * np.linspace(0.0, 1.0, 5), inner)


def closed_shapes() -> dict[str, Surface]:
    cone = np.array([[0.0, 0.0], [2.0, 0.0], [1.0, 3.0], [0.0, 3.0]])
    return {
        "cone": revolve(cone, 12),
        "solid cylinder": hollow_cylinder(2.0, 0.0, 0.0, 3.0, 12),
        "hollow cylinder": hollow_cylinder(2.0, 1.0, -1.0, 3.0, 12),
        "prism": prism(0.0),
        "prism with a hole": prism(0.7),
        "prism in a cylinder": prism(5.0),
        "ball": ball(0.5, 12),
        "wedge": wedge(-1.0, -2.0, 0.5, 0.0, 1.0),
        "upright bar": beam(np.zeros(3), np.array([0.0, 0.0, 2.0]), 0.1),
        "bar": beam(np.zeros(3), np.array([1.0, 2.0, 0.5]), 0.1),
    }


@pytest.mark.parametrize("name", closed_shapes())
def test_every_edge_of_a_closed_surface_is_shared_by_two_cells_that_run_along_it_in_opposite_ways(name):
    surface = closed_shapes()[name]
    edges = np.concatenate(
        [
            np.stack([cells, np.roll(cells, -1, axis=1)], -1).reshape(-1, 2)
            for cells in (surface.quads, surface.triangles)
        ]
    )
    forwards = {tuple(edge) for edge in edges}
    backwards = {tuple(edge[::-1]) for edge in edges}
    assert len(forwards) == len(edges)
    assert forwards == backwards
    assert surface.volume() > 0.0


def test_volumes_are_those_of_the_polygons():
    shapes = closed_shapes()
    share = polygon_share(12)
    assert shapes["solid cylinder"].volume() == pytest.approx(share * np.pi * 4.0 * 3.0)
    assert shapes["hollow cylinder"].volume() == pytest.approx(share * np.pi * 3.0 * 4.0)
    assert shapes["cone"].volume() == pytest.approx(share * np.pi * 3.0 / 3.0 * (4.0 + 2.0 + 1.0))
    assert shapes["wedge"].volume() == pytest.approx(0.5)
    assert shapes["bar"].volume() == pytest.approx(0.04 * np.sqrt(5.25))
    assert shapes["ball"].volume() == pytest.approx(4.0 / 3.0 * np.pi * 0.125, rel=0.15)


def test_an_untwisted_prism_has_the_volume_of_its_contour():
    hexagon = 1.5 * np.sqrt(3.0) * 4.0 * 0.4
    triangle = 0.75 * np.sqrt(3.0) * 0.7**2 * 0.4  # the hole has one point a tooth
    assert prism(0.0, twist=0.0).volume() == pytest.approx(hexagon)
    assert prism(0.7, twist=0.0).volume() == pytest.approx(hexagon - triangle)


def test_joined_surfaces_keep_their_points_and_cells_in_order():
    one = prism(0.7)
    two = ball(0.5, 12)
    both = join([one, two])
    assert np.array_equal(both.points[len(one.points) :][two.quads], both.points[both.quads[len(one.quads) :]])
    assert both.volume() == pytest.approx(one.volume() + two.volume())
