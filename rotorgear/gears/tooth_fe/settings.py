"""Settings of the finite-element tooth model: presets, body, and the mesh sizes that they stand for.

Bodies. "rim": an arc of seven pitches, held at its end cuts and on a circle three normal modules below the root, so the approach
is measured against that circle. "ring": all pitches on a full disc of the face's width, held at the bore or inside of the rim.
"wheel": all pitches on their blank of rim, web and hub, held at the bore. Where nothing is said, a gear with rim and web is a
wheel, and any other one a rim. A ring with its teeth inside is held at its outer surface, as a "ring", where that is known, else
as a "rim" at a circle around its teeth.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass, replace
from typing import Literal

from rotorgear.errors import AnalysisError
from rotorgear.gears.geometry.blank import BlankShape
from rotorgear.gears.tooth_fe.points import MeshSize

Preset = Literal["preview", "default", "fine"]
Body = Literal["rim", "ring", "wheel"]
BODIES: tuple[Body, ...] = ("rim", "ring", "wheel")
PRESETS: tuple[Preset, ...] = ("preview", "default", "fine")
ARC = 7  # pitches of a rim
RIM = 3.0  # depth of a rim below the root circle, in normal modules


@dataclass(frozen=True)
class ToothFe:
    """How teeth are modelled.

    Attributes:
        preset: preview, default or fine.
        body: "rim", "ring" or "wheel"; None: a wheel where the blank has rim and web, else a rim.
        rim_thickness: of the "rim" body in normal modules.
        arc: pitches of the "rim" body, an odd number.
        exclude_torsion: leave the wind-up between bore and teeth out of a "ring" or "wheel", where the rotor model has it;
            None: out of a wheel, whose torsion stands between its teeth and its shaft, but not out of a ring.
        space: whether the model is three-dimensional; None: where the teeth are helical or change along the face.
        size: mesh size in place of the preset's.
        patch: largest half-width of a load patch in normal modules, in place of the preset's.
        slices: slices of a contact line over the whole face, in place of two a layer.
        blank_coarseness: sides of the elements below the teeth of a wheel over the usual ones.
    """

    preset: Preset = "default"
    body: Body | None = None
    rim_thickness: float = RIM
    arc: int = ARC
    exclude_torsion: bool | None = None
    space: bool | None = None
    size: MeshSize | None = None
    patch: float | None = None
    slices: int | None = None
    blank_coarseness: float = 1.0

    def __post_init__(self) -> None:
        if self.preset not in PRESETS:
            raise AnalysisError(f"preset: got '{self.preset}', expected one of {', '.join(PRESETS)}")
        if self.body is not None and self.body not in BODIES:
            raise AnalysisError(f"body: got '{self.body}', expected one of {', '.join(BODIES)}")
        if self.arc < 3 or self.arc % 2 == 0:
            raise AnalysisError(f"An arc needs an odd number of at least 3 pitches, not {self.arc}.")
        if not self.rim_thickness > 0.0:
            raise AnalysisError(f"The rim thickness must be positive, not {self.rim_thickness:g} normal modules.")

    @property
    def patch_width(self) -> float:
        """c_0 in normal modules."""
        return self.patch or (0.2 if self.preset == "fine" else 0.3)

    def body_of(self, blank: BlankShape | None, outer_radius: float | None = None) -> Body:
        """What the teeth of one gear stand on; `outer_radius` (m) is that of a ring with its teeth inside, 0 if not known.

        Raises:
            AnalysisError: such a ring needs its outer surface.
        """
        if outer_radius is not None:
            if self.body is not None and self.body != "rim" and not outer_radius:
                raise AnalysisError(
                    f"body = '{self.body}' holds a ring at its outer surface, which is not known: give body.rim_thickness or "
                    "body.outer_diameter of the ring, or body = 'rim'."
                )
            return "ring" if outer_radius and self.body != "rim" else "rim"
        if self.body is not None:
            return self.body
        return "rim" if blank is None or blank.is_solid else "wheel"

    def excludes_torsion(self, body: Body) -> bool:
        """Whether the wind-up between bore and teeth is left out."""
        if body == "rim":
            return False  # held just below the teeth, it has none
        return body == "wheel" if self.exclude_torsion is None else self.exclude_torsion

    def body_text(self, bodies: tuple[Body, Body], held: tuple[float, float], *, internal: bool = False) -> str:
        """What the teeth of pinion and gear stand on and where that is held, in a line.

        Args:
            bodies: of both. held: radii of these circles (m). internal: whether the gear is a ring with its teeth inside.
        """
        if internal and bodies[1] == "ring":
            pinion = self._one_body(bodies[0], f"{1e3 * held[0]:.5g}")
            return f"pinion {pinion}; ring held at radius {1e3 * held[1]:.5g} mm, its outer surface"
        if bodies[0] == bodies[1]:
            return self._one_body(bodies[0], " and ".join(f"{1e3 * radius:.5g}" for radius in held))
        first, second = (self._one_body(body, f"{1e3 * radius:.5g}") for body, radius in zip(bodies, held, strict=True))
        return f"pinion {first}; gear {second}"

    def _one_body(self, body: Body, radius: str) -> str:
        if body == "rim":
            return f"rim: arc of {self.arc} pitches, held at its end cuts and at radius {radius} mm"
        if body == "wheel":
            wound = "without the" if self.excludes_torsion(body) else "with the"
            return f"wheel: rim, web and hub held at radius {radius} mm, {wound} wind-up between bore and teeth"
        torsion = ", without the wind-up of the disc" if self.excludes_torsion(body) else ""
        return f"ring: full disc held at radius {radius} mm{torsion}"

    @property
    def even_size(self) -> MeshSize:
        """Elements of a wheel that is loaded evenly along its face: polynomials up to `face` stand for layers."""
        size = self.size or _EVEN[self.preset]
        if size.face:
            return size
        return replace(size, face=next(order for rows, order in _ORDERS if size.involute <= rows))

    def mesh_size(self, width: float, *, space: bool) -> MeshSize:
        """Elements for a face of `width` normal modules."""
        if self.size is not None:
            return self.size
        if not space:
            return _PLANE[self.preset]
        size, thickness = _SPACE[self.preset]
        return replace(size, face=max(_LEAST_LAYERS, round(width / thickness)))


# The same of a wheel loaded evenly along its face, with the highest polynomial along it in place of layers.
_EVEN = {
    "preview": MeshSize(7, 2, 4, 2, 3, 6),
    "default": MeshSize(8, 3, 6, 3, 4, 8),
    "fine": MeshSize(16, 4, 12, 4, 8, 10),
}
# Rows and columns as measured against finer meshes; see docs/mesh.md for error against run time.
_PLANE = {
    "preview": MeshSize(6, 2, 4, 2, 4),
    "default": MeshSize(10, 3, 8, 3, 6),
    "fine": MeshSize(16, 4, 12, 4, 8),
}
# The same with the thickness of a layer in normal modules; the preview takes slices of the plane model instead.
_SPACE = {
    "preview": (MeshSize(7, 2, 4, 2, 3), 2.7),
    "default": (MeshSize(8, 3, 6, 3, 4), 1.08),
    "fine": (MeshSize(10, 3, 6, 3, 4), 0.77),
}
# Highest polynomial along the face for a mesh size that gives none: (most rows on the involute, polynomial).
_ORDERS = ((4, 4), (6, 6), (10, 8), (10_000, 10))
# Least number of layers of a narrow face.
_LEAST_LAYERS = 4

# The mesh that the error of a preset is estimated by, in its plane and in space.
_COARSER: dict[Preset, tuple[MeshSize, tuple[MeshSize, float]]] = {
    "preview": (MeshSize(4, 2, 4, 2, 3), (MeshSize(5, 2, 4, 2, 3), 3.6)),
    "default": (_PLANE["preview"], _SPACE["preview"]),
    "fine": (_PLANE["default"], _SPACE["default"]),
}


def coarser_size(fe: ToothFe, width: float, *, space: bool) -> MeshSize:
    """A coarser mesh of the same kind, for a face of `width` normal modules."""
    if fe.size is not None:
        return MeshSize(*(max(2, round(0.7 * n)) if n else 0 for n in astuple(fe.size)))
    coarser = sized(fe, _COARSER[fe.preset][1 if space else 0], width).size
    assert coarser is not None
    return coarser


def sized(fe: ToothFe, size: MeshSize | tuple[MeshSize, float], width: float) -> ToothFe:
    """Settings with a given mesh: for a plane model, or with the thickness of a layer, for a face of `width` modules."""
    if isinstance(size, MeshSize):
        return replace(fe, size=size)
    return replace(fe, size=replace(size[0], face=max(_LEAST_LAYERS - 1, round(width / size[1]))))
