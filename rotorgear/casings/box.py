"""The mesh of a box from a few numbers: plates around an inner space, bored blocks for bearings, inner walls, ribs and feet.

Bricks stand on a plane grid of quadrilaterals, repeated at each z and kept where the box is solid. The grid's lines run through
all edges of walls, blocks, ribs and feet, so that the mesh has the volume of the drawing. Around each axis of bores a square
block is left out of the lines, and rings of quadrilaterals lead from its border to the bores; where the corners of two blocks
overlap, both end at the diagonal between them. A bore is a polygon of the area of its circle.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from rotorgear.casings.elements import element
from rotorgear.casings.file_mesh import FileMesh, NamedSet
from rotorgear.errors import AnalysisError
from rotorgear.quantity import millimetres

_SAME = 1e-7  # m: lines and axes nearer than this are one
# Sides of a block are cut in this many parts at least, so that a bore is a polygon of 16 sides.
_OF_A_SIDE = 4
# Least distance of a bore from the diagonal at which its block ends, over the radius.
_CLEAR = 1.05
# A block reaches from its wall to its bearing, at most this many times its own width.
_LONGEST = 1.0
_SIDES = ("-x", "+x", "-y", "+y", "-z", "+z")
Point = tuple[float, float, float]


@dataclass(frozen=True)
class BoxSeat:
    """Where a bearing sits: its middle (m), radius and width of its outer ring."""

    name: str
    at: Point
    radius: float
    width: float


@dataclass(frozen=True)
class BoxShape:
    """A box with its edges along x, y and z; all in m.

    Attributes:
        low: corner of the inner space with the smallest coordinates.
        high: the opposite corner.
        wall: thickness of all walls.
        walls: z of the middles of inner walls.
        boss: least thickness of the block around a bore.
        seats: of bearings, on axes along z.
        shafts: x, y, first and last z of shafts, which pass through walls where they reach beyond them.
        ribs: places of the middles of ribs in planes across x, y and z.
        rib: thickness and height of all ribs.
        feet: extents along x, y and z of each of four feet; none where empty.
        feet_side: face of the box that they stand on, such as "-y".
        element: largest size of an element along x, y and z.
    """

    low: Point
    high: Point
    wall: float
    walls: tuple[float, ...]
    boss: float
    seats: tuple[BoxSeat, ...]
    shafts: tuple[tuple[float, float, float, float], ...]
    ribs: tuple[tuple[float, ...], ...]
    rib: tuple[float, float]
    feet: tuple[float, ...]
    feet_side: str
    element: float

    @property
    def outside(self) -> tuple[np.ndarray, np.ndarray]:
        """Corners (3,) of the box outside, without ribs and feet."""
        return np.array(self.low) - self.wall, np.array(self.high) + self.wall

    @property
    def feet_axis(self) -> int:
        """Number of the axis along which the feet stand out."""
        return "xyz".index(self.feet_side[1])

    @property
    def feet_sense(self) -> float:
        """1 where they stand out along that axis, -1 against it."""
        return 1.0 if self.feet_side[0] == "+" else -1.0

    @property
    def footed(self) -> float:
        """Coordinate along that axis of the face that they stand on."""
        return float(self.outside[self.feet_sense > 0.0][self.feet_axis])

    @property
    def sole(self) -> float:
        """Coordinate along that axis of their soles."""
        return self.footed + self.feet_sense * self.feet[self.feet_axis]

    @property
    def plates(self) -> list[tuple[float, float]]:
        """First and last z of each wall across z."""
        half = 0.5 * self.wall
        inner = [(z - half, z + half) for z in self.walls]
        return sorted([(self.low[2] - self.wall, self.low[2]), (self.high[2], self.high[2] + self.wall), *inner])


@dataclass
class _Block:
    """What is bored along one axis.

    Attributes:
        x, y: of the axis.
        seats: on it.
        radii: of its bores, rising.
        half: half of the side of the block.
        loop: nodes (n,) of its border, counter-clockwise.
    """

    x: float
    y: float
    seats: list[BoxSeat]
    radii: list[float] = field(default_factory=list)
    half: float = 0.0
    loop: np.ndarray = field(default_factory=lambda: np.zeros(0, dtype=int))

    @property
    def centre(self) -> np.ndarray:
        """Of the axis, (2,)."""
        return np.array([self.x, self.y])

    def tube(self, seat: BoxSeat, plates: list[tuple[float, float]]) -> tuple[float, float]:
        """First and last z of the block that holds a seat: from its wall, the nearest, to its far end."""
        z = seat.at[2]
        half = 0.5 * seat.width
        wall = min(plates, key=lambda plate: abs(0.5 * (plate[0] + plate[1]) - z))
        return min(wall[0], z - half), max(wall[1], z + half)


@dataclass
class _Plane:
    """Quadrilaterals of the plane grid.

    Attributes:
        points: (p, 2).
        cells: (c, 4), counter-clockwise.
        middle: (c, 2).
        block: (c,) number of the block, -1 outside of all.
        inner: (c,) radius of the largest bore that it is outside of; 0 inside of all, and outside of all blocks.
        circles: by block and number of the bore, its nodes in their order.
    """

    points: np.ndarray
    cells: np.ndarray
    middle: np.ndarray
    block: np.ndarray
    inner: np.ndarray
    circles: dict[tuple[int, int], np.ndarray]


def box_mesh(shape: BoxShape, address: str) -> FileMesh:
    """Bricks of a box, in m, with the sets -x, +x, ..., +z of its outer faces, `feet`, and one for each seat.

    The set of a seat is called as its address, such as "casings.box.seats.left".

    Raises:
        AnalysisError: a seat outside of its wall or in the block of another, ribs beyond the box.
    """
    blocks = _blocks(shape, address)
    plane = _plane(shape, blocks, address)
    zs = _lines(_z_edges(shape, blocks), shape.element, [])
    solid = np.array([_solid(shape, blocks, plane, z) for z in 0.5 * (zs[1:] + zs[:-1])])
    count = len(plane.points)
    layer, cell = np.nonzero(solid)
    flat = plane.cells[cell] + (layer * count)[:, None]
    bricks = np.hstack([flat, flat + count])
    points = np.hstack([np.tile(plane.points, (len(zs), 1)), np.repeat(zs, count)[:, None]])
    sets = _outer_sets(shape, bricks[plane.block[cell] < 0], points)
    for number, block in enumerate(blocks):
        for seat in block.seats:
            sets[f"{address}.seats.{seat.name}"] = _seat_set(shape, plane, number, block, seat, zs, solid, address)
    used, bricks = np.unique(bricks, return_inverse=True)
    place = np.full(len(points), -1)
    place[used] = np.arange(len(used))
    named = {name: one.renumbered(place) for name, one in sets.items()}
    return FileMesh(points[used], {"hexahedron": bricks.reshape(-1, 8)}, named)


def _blocks(shape: BoxShape, address: str) -> list[_Block]:
    """Axes of bores with their blocks, each in its wall."""
    blocks: list[_Block] = []
    for seat in shape.seats:
        for block in blocks:
            if math.hypot(seat.at[0] - block.x, seat.at[1] - block.y) < _SAME:
                block.seats.append(seat)
                break
        else:
            blocks.append(_Block(seat.at[0], seat.at[1], [seat]))
    for block in blocks:
        block.radii = sorted({seat.radius for seat in block.seats})
        block.half = block.radii[-1] + shape.boss
        widest = max(block.seats, key=lambda seat: seat.radius)
        for axis, at in enumerate((block.x, block.y)):
            if at - block.half < shape.low[axis] - _SAME or at + block.half > shape.high[axis] + _SAME:
                reach = f"{millimetres(at - block.half)} to {millimetres(at + block.half)}"
                room = f"{millimetres(shape.low[axis])} to {millimetres(shape.high[axis])}"
                raise AnalysisError(
                    f"{address}.box.bores.{widest.name}: the block of its seat reaches over {'xy'[axis]} from {reach}, "
                    f"outside of the wall, whose inside is {room}. Move the corners of the box, or make boss thinner."
                )
        for seat in block.seats:
            first, last = block.tube(seat, shape.plates)
            if last - first - shape.wall > _LONGEST * 2.0 * block.half:
                raise AnalysisError(
                    f"{address}.box.bores.{seat.name}: the bearing at z = {millimetres(seat.at[2])} is "
                    f"{millimetres(last - first - shape.wall)} away from the nearest wall. Move the corners of the box, give it "
                    "an inner wall (walls), or leave the casing of this bearing out."
                )
    return blocks


def _lines(edges: list[float], element: float, blocks: list[tuple[float, float]]) -> np.ndarray:
    """Coordinates of grid lines: through all edges, and between them as near as elements and borders of blocks ask for."""
    edges = sorted(edges)
    edges = [edge for number, edge in enumerate(edges) if number == 0 or edge - edges[number - 1] > _SAME]
    found = [edges[:1]]
    for first, last in pairwise(edges):
        inside = [(high - low) / _OF_A_SIDE for low, high in blocks if low < 0.5 * (first + last) < high]
        parts = math.ceil((last - first) / min([element, *inside]) - 1e-6)
        found.append(np.linspace(first, last, parts + 1)[1:].tolist())
    return np.concatenate(found)


def _edges(shape: BoxShape, axis: int) -> list[float]:
    """Edges of walls, ribs and feet along an axis."""
    low, high = (corner[axis] for corner in shape.outside)
    thickness, height = shape.rib
    edges = [low, shape.low[axis], shape.high[axis], high]
    for across, places in enumerate(shape.ribs):
        if places and across == axis:
            edges += [place + side * 0.5 * thickness for place in places for side in (-1.0, 1.0)]
        elif places:
            edges += [low - height, high + height]
    if shape.feet:
        extent = shape.feet[axis]
        edges += [shape.sole] if axis == shape.feet_axis else [low + extent, high - extent]
    return edges


def _z_edges(shape: BoxShape, blocks: list[_Block]) -> list[float]:
    """Edges along z: those of the box, its inner walls, the seats and their blocks."""
    edges = [*_edges(shape, 2), *(z for plate in shape.plates for z in plate)]
    for block in blocks:
        for seat in block.seats:
            edges += [seat.at[2] - 0.5 * seat.width, seat.at[2] + 0.5 * seat.width, *block.tube(seat, shape.plates)]
    return edges


def _plane(shape: BoxShape, blocks: list[_Block], address: str) -> _Plane:
    """The plane grid: cells between the lines, and rings and a core in each block."""
    spans = [[(at[axis] - b.half, at[axis] + b.half) for b, at in ((b, b.centre) for b in blocks)] for axis in (0, 1)]
    xs, ys = (
        _lines([*_edges(shape, axis), *(edge for span in spans[axis] for edge in span)], shape.element, spans[axis])
        for axis in (0, 1)
    )
    across = len(ys)
    points = np.array([(x, y) for x in xs for y in ys])
    ranges = []
    for span_x, span_y in zip(*spans, strict=True):
        i0, i1 = (int(np.argmin(np.abs(xs - edge))) for edge in span_x)
        j0, j1 = (int(np.argmin(np.abs(ys - edge))) for edge in span_y)
        ranges.append((i0, i1, j0, j1))
    cut: dict[int, int] = {}  # a node of a corner that is cut off -> the node of the other block at its place
    for first in range(len(blocks)):
        for second in range(first):
            _cut(points, across, (ranges[second], ranges[first]), (blocks[second], blocks[first]), cut, address)
    inside = np.zeros((len(xs) - 1, len(ys) - 1), dtype=bool)
    for i0, i1, j0, j1 in ranges:
        inside[i0:i1, j0:j1] = True
    i, j = np.nonzero(~inside)
    corner = i * across + j
    made = _Cells([points], [], [], [], len(points))
    made.add(np.column_stack([corner, corner + across, corner + across + 1, corner + 1]), -1, 0.0)
    circles: dict[tuple[int, int], np.ndarray] = {}
    for number, (block, (i0, i1, j0, j1)) in enumerate(zip(blocks, ranges, strict=True)):
        own = np.arange(i0, i1 + 1)[:, None] * across + np.arange(j0, j1 + 1)
        grid = np.array([(xs[a], ys[b]) for a in range(i0, i1 + 1) for b in range(j0, j1 + 1)])
        loop = own.ravel()[_around(own.shape)]
        block.loop = np.array([cut.get(node, node) for node in loop.tolist()])
        rings = _bored(made, number, block, grid, own.shape, points[block.loop], shape)
        circles |= {(number, at): nodes for at, nodes in enumerate(rings)}
    positions = np.vstack(made.points)
    whole = np.vstack(made.cells)
    middle = positions[whole].mean(axis=1)
    return _Plane(positions, whole, middle, np.concatenate(made.block), np.concatenate(made.inner), circles)


@dataclass
class _Cells:
    """Points and quadrilaterals of a plane grid while it is made; attributes as of `_Plane`, `count` points so far."""

    points: list[np.ndarray]
    cells: list[np.ndarray]
    block: list[np.ndarray]
    inner: list[np.ndarray]
    count: int

    def nodes_at(self, points: np.ndarray) -> np.ndarray:
        """Numbers (n,) of new nodes at some points (n, 2)."""
        self.points.append(points)
        self.count += len(points)
        return np.arange(self.count - len(points), self.count)

    def add(self, cells: np.ndarray, block: int, inner: float) -> None:
        """Add quadrilaterals (c, 4) of a block, outside of the bore with that radius."""
        self.cells.append(cells)
        self.block.append(np.full(len(cells), block))
        self.inner.append(np.full(len(cells), inner))


def _around(shape: tuple[int, ...]) -> np.ndarray:
    """Numbers of the nodes on the border of a grid of so many by so many, row by row, counter-clockwise."""
    local = np.arange(math.prod(shape)).reshape(shape)
    return np.concatenate([local[:-1, 0], local[-1, :-1], local[:0:-1, -1], local[0, :0:-1]])


def _bored(
    made: _Cells,
    number: int,
    block: _Block,
    grid: np.ndarray,
    size: tuple[int, ...],
    outer: np.ndarray,
    shape: BoxShape,
) -> list[np.ndarray]:
    """Fill a block: a core, the rings of its bores, and rings out to its border.

    Args:
        made: gets its cells. number: of the block. grid: places (n, 2) of the grid that it takes up, of a size; outer: those of
            its border (b, 2), as far as it reaches.

    Returns:
        The nodes (b,) of each bore.
    """
    border = _around(size)
    # The core: the grid of the block, shrunk into the smallest bore; it is kept where a wall is closed.
    core = made.nodes_at(block.centre + (grid - block.centre) * (0.5 * block.radii[0] / block.half)).reshape(size)
    parts = (core[:-1, :-1], core[1:, :-1], core[1:, 1:], core[:-1, 1:])
    made.add(np.column_stack([part.ravel() for part in parts]), number, 0.0)
    angle = np.arctan2(*(grid[border] - block.centre).T[::-1])
    step = np.mod(np.roll(angle, -1) - angle, 2.0 * math.pi)
    scale = math.sqrt(2.0 * math.pi / np.sin(step).sum())  # the polygon has the area of the circle
    direction = scale * np.column_stack([np.cos(angle), np.sin(angle)])
    last = core.ravel()[border]
    radius = 0.0
    circles = []
    for bore in block.radii:
        circles.append(made.nodes_at(block.centre + bore * direction))
        made.add(_ring(last, circles[-1]), number, radius)
        last = circles[-1]
        radius = bore
    layers = max(1, math.ceil(shape.boss / shape.element - 1e-6))
    start = block.centre + radius * direction
    for layer in range(1, layers + 1):
        beyond = block.loop if layer == layers else made.nodes_at(start + (outer - start) * layer / layers)
        made.add(_ring(last, beyond), number, radius)
        last = beyond
    return circles


def _ring(inner: np.ndarray, outer: np.ndarray) -> np.ndarray:
    """Quadrilaterals (n, 4) between two closed lines of nodes."""
    return np.column_stack([inner, outer, np.roll(outer, -1), np.roll(inner, -1)])


def _cut(
    points: np.ndarray,
    across: int,
    ranges: tuple[tuple[int, int, int, int], tuple[int, int, int, int]],
    blocks: tuple[_Block, _Block],
    cut: dict[int, int],
    address: str,
) -> None:
    """Where the corners of two blocks overlap: move the lines of both onto the diagonal between them, and join their nodes."""
    (a0, a1, b0, b1), (c0, c1, d0, d1) = ranges
    i0, i1, j0, j1 = max(a0, c0), min(a1, c1), max(b0, d0), min(b1, d1)
    if i0 >= i1 or j0 >= j1:
        return
    names = [f"{address}.box.bores.{block.seats[0].name}" for block in blocks]
    # The corner of each block that lies in the other.
    corners = [[(i, j) for i in (i0, i1) for j in (j0, j1) if i in (r[0], r[1]) and j in (r[2], r[3])] for r in ranges]
    if [len(one) for one in corners] != [1, 1] or {corners[0][0][0], corners[1][0][0]} != {i0, i1}:
        raise AnalysisError(
            f"{names[1]}: the block of its seat overlaps that of {names[0].rpartition('.')[2]}: their axes are too close for "
            f"bores of {' and '.join(millimetres(2.0 * b.radii[-1]) for b in blocks)} in blocks. Make boss thinner."
        )
    (p, q), (u, v) = corners[0][0], corners[1][0]
    begin = points[p * across + v]
    end = points[u * across + q]
    normal = np.array([-(end - begin)[1], (end - begin)[0]]) / np.linalg.norm(end - begin)
    for name, block in zip(names, blocks, strict=True):
        distance = abs(normal @ (block.centre - begin))
        if distance < _CLEAR * block.radii[-1]:
            raise AnalysisError(
                f"{name}: its bore of {millimetres(2.0 * block.radii[-1])} leaves too little wall to the next one: "
                f"{millimetres(distance - block.radii[-1])}. Place the shafts further apart, or use a mesh of your own."
            )

    def steps(first: int, last: int) -> list[int]:
        return list(range(first, last, 1 if last > first else -1))

    # From the end (p, v) of the diagonal to the other, (u, q): around the corner of each block.
    one = [(p, j) for j in steps(v, q)] + [(i, q) for i in steps(p, u)]
    other = [(i, v) for i in steps(p, u)] + [(u, j) for j in steps(v, q)]
    for number, ((i, j), (k, m)) in enumerate(zip(one, other, strict=True)):
        node = i * across + j
        twin = k * across + m
        if number and ({node, twin} & {*cut, *cut.values()}):
            raise AnalysisError(f"{names[1]}: the blocks of three bores overlap at one place. Make boss thinner.")
        points[node] = begin + (end - begin) * number / len(one)
        if number:
            cut[twin] = node


def _bore(shape: BoxShape, block: _Block, z: float) -> float | None:
    """Radius of what is bored out of a block at z, 0 where it is closed; None where no wall and no seat is there."""
    of_seats = [seat for seat in block.seats if abs(z - seat.at[2]) < 0.5 * seat.width]
    of_blocks = [seat for seat in block.seats if (t := block.tube(seat, shape.plates))[0] < z < t[1]]
    for seats in (of_seats, of_blocks):
        if seats:
            return max(seat.radius for seat in seats)
    wall = next((plate for plate in shape.plates if plate[0] < z < plate[1]), None)
    if wall is None:
        return None
    reaching = (
        begin < wall[1] - _SAME and end > wall[0] + _SAME
        for x, y, begin, end in shape.shafts
        if math.hypot(x - block.x, y - block.y) < block.radii[-1]
    )
    return block.radii[-1] if any(reaching) else 0.0


def _solid(shape: BoxShape, blocks: list[_Block], plane: _Plane, z: float) -> np.ndarray:
    """Which cells (c,) of the plane are solid at z."""
    low, high = shape.outside
    x, y = plane.middle.T
    in_walls = (x > low[0]) & (x < high[0]) & (y > low[1]) & (y < high[1])
    hollow = (x > shape.low[0]) & (x < shape.high[0]) & (y > shape.low[1]) & (y < shape.high[1])
    solid = np.zeros(len(x), dtype=bool)
    if low[2] < z < high[2]:
        solid = in_walls & ~hollow
    if any(first < z < last for first, last in shape.plates):
        solid |= in_walls & (plane.block < 0)
    for number, block in enumerate(blocks):
        radius = _bore(shape, block, z)
        if radius is not None:
            solid |= (plane.block == number) & (plane.inner > radius - _SAME)
    free = plane.block < 0
    thickness, height = shape.rib
    at = (x, y, np.full(len(x), z))
    for across, places in enumerate(shape.ribs):
        others = [axis for axis in range(3) if axis != across]
        near = [(at[axis] > low[axis] - height) & (at[axis] < high[axis] + height) for axis in others]
        outer = [(at[axis] < low[axis]) | (at[axis] > high[axis]) for axis in others]
        for place in places:
            solid |= free & (np.abs(at[across] - place) < 0.5 * thickness) & near[0] & near[1] & (outer[0] | outer[1])
    if shape.feet:
        beyond = shape.feet_sense * (at[shape.feet_axis] - shape.footed)
        solid |= free & (beyond > 0.0) & (beyond < shape.feet[shape.feet_axis]) & _over_feet(shape, np.column_stack(at))
    return solid


def _over_feet(shape: BoxShape, points: np.ndarray) -> np.ndarray:
    """Which of some points (n, 3) are above or below one of the feet, (n,)."""
    low, high = shape.outside
    across = [axis for axis in range(3) if axis != shape.feet_axis]
    at = points[:, across]
    extent = np.array(shape.feet)[across]
    near = (at < low[across] + extent) | (at > high[across] - extent)
    return np.asarray((near & (at > low[across]) & (at < high[across])).all(axis=1))


def _outer_sets(shape: BoxShape, bricks: np.ndarray, points: np.ndarray) -> dict[str, NamedSet]:
    """Faces of bricks outside of blocks on the outside of the walls, by their side, and the soles of the feet."""
    faces = bricks[:, np.array(element("hexahedron").faces)].reshape(-1, 4)
    _, first, counts = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    faces = faces[first[counts == 1]]
    planes = {side: ("xyz".index(side[1]), shape.outside[side[0] == "+"]["xyz".index(side[1])]) for side in _SIDES}
    if shape.feet:
        planes["feet"] = shape.feet_axis, shape.sole
    sets = {}  # without the blocks, so that a face can be held whose seats are free to move
    for name, (axis, place) in planes.items():
        there = (np.abs(points[faces][:, :, axis] - place) < _SAME).all(axis=1)
        middle = points[faces].mean(axis=1)
        if name == "feet":  # ribs may reach down as far
            there &= _over_feet(shape, middle)
        else:  # the sides of feet are flush with those of the box
            there &= ((middle > shape.outside[0] - _SAME) & (middle < shape.outside[1] + _SAME)).all(axis=1)
        chosen = faces[there]
        sets[name] = NamedSet(np.unique(chosen), [chosen])
    return sets


def _seat_set(
    shape: BoxShape,
    plane: _Plane,
    number: int,
    block: _Block,
    seat: BoxSeat,
    zs: np.ndarray,
    solid: np.ndarray,
    address: str,
) -> NamedSet:
    """The faces of a seat: its bore over its width."""
    circle = plane.circles[number, block.radii.index(seat.radius)]
    layers = np.flatnonzero(np.abs(0.5 * (zs[1:] + zs[:-1]) - seat.at[2]) < 0.5 * seat.width)
    rings = (plane.block == number) & (plane.inner > seat.radius - _SAME)
    inside = (plane.block == number) & (plane.inner < seat.radius - _SAME)
    if not solid[np.ix_(layers, np.flatnonzero(rings))].all() or solid[np.ix_(layers, np.flatnonzero(inside))].any():
        others = ", ".join(one.name for one in block.seats if one is not seat)
        raise AnalysisError(
            f"{address}.box.bores.{seat.name}: its seat stands in the bore of another on its axis ({others}). Give bearings side "
            "by side one diameter, or places that do not overlap."
        )
    count = len(plane.points)
    after = np.roll(circle, -1)
    faces = np.vstack(
        [
            np.column_stack([circle + k * count, after + k * count, after + (k + 1) * count, circle + (k + 1) * count])
            for k in layers
        ]
    )
    return NamedSet(np.unique(faces), [faces])
