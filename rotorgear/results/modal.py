"""Result of a modal analysis: frequencies, damping, shapes by node, energies by part and motion, and what it cost."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from rotorgear.errors import AnalysisError
from rotorgear.quantity import RPM_PER_RAD_S
from rotorgear.results.laws import AboutEquilibrium
from rotorgear.results.planets import (
    carrier_columns,
    carrier_frequency_over,
    carrier_share_over,
    class_energy_over,
    classes_over,
)
from rotorgear.results.schema import Record, Written, derived, imaginary_part, of, real_part
from rotorgear.results.table import Block, Column, Line, error_words, exact, table_over

# The senses of whirl; results hold numbers into this tuple, "" for torsional and axial modes, which don't whirl.
WHIRL_WORDS = ("", "forward", "backward", "mixed", "planar")
# The classes of motions of a planetary stage (`analysis/modal/planet_classes.py`).
MODE_CLASSES = ("rotational", "translational", "planet")
WRITTEN_WHIRL = Written("whirl", lambda result, numbers: np.array(WHIRL_WORDS)[numbers])


def body_name(gear: str) -> str:
    """What the points on the surface of a gear's elastic body are called among those of casings."""
    return f"gears.{gear}.body"


class NodeTable(Record):
    """Where the p nodes are.

    The nodes of the model come first, then stations inside elements of higher order, where the shape is known as well, then the
    points on the surfaces of casings and elastic gear bodies, which only displace.
    """

    shaft: tuple[str, ...] = of("shaft", "", "node")
    position: np.ndarray = of("position in the model", "m", "node", "xyz", json="position")
    pedestal: tuple[str, ...] = of("bearing whose pedestal the node is", "", "node", note=', else `""`')
    casing: tuple[str, ...] = of(
        "surface that the node is on", "", "node", note=': a casing, `"gears.NAME.body"`, or `""`', default=()
    )
    on_axis: np.ndarray | None = of(
        "z on its own shaft", "m", "node", note="; `null`: z of the position, where no axis is inclined", default=None
    )

    def require(self) -> None:
        """AnalysisError where the modes were found without shapes, which is as if there were no nodes."""
        if not self.shaft:
            raise AnalysisError(
                "these modes were found without their shapes (shapes=False): find them with shapes for this"
            )

    @property
    def along(self) -> np.ndarray:
        """z of the nodes on their shaft in m, (p,)."""
        return self.position[:, 2] if self.on_axis is None else self.on_axis

    def of_casing(self, casing: str) -> np.ndarray:
        """Numbers of the points of a casing's surface, in its order."""
        return np.array([k for k, name in enumerate(self.casing) if name == casing], dtype=int)

    def on_shaft(self, shaft: str) -> np.ndarray:
        """Numbers of a shaft's nodes from left to right, without pedestals."""
        on_it = np.array([i for i, name in enumerate(self.shaft) if name == shaft and not self.pedestal[i]], dtype=int)
        return on_it[np.argsort(self.along[on_it], kind="stable")] if on_it.size else on_it

    def nearest(self, shaft: str, z: float) -> int:
        """Number of the node of a shaft nearest to z."""
        numbers = self.on_shaft(shaft)
        return int(numbers[np.argmin(np.abs(self.along[numbers] - z))])


class Piece(Record):
    """A stretch of shaft between two neighbouring places, and how it was cut into elements."""

    shaft: str = of("shaft")
    start: float = of("z of the left end", "m", json="start")
    end: float = of("z of the right end", "m", json="end")
    elements: int = of("number of elements")
    order: int = of("polynomial order of the elements")


# How many nodes there are is all of the table of nodes that is written.
NODE_COUNT = Written("nodes", lambda result, nodes: len(nodes.shaft), axes=(), label="number of nodes")


class ModalResult(AboutEquilibrium, kind="modal"):
    """m modes of a model, lowest natural frequency first.

    Of each conjugate pair of eigenvalues s one is kept; s is real for overdamped and 0 for rigid-body modes. Shapes are those
    of all p nodes, with modal mass 1 (q^H M q) and the largest displacement real and positive.
    """

    speed: float | None = of("speed of the input shaft", "rad/s", note="; `null`: undamped, at standstill")

    @derived("frequency", "Hz", "mode", note=", the damped one; 0 for rigid-body modes", form=exact(".4f"), column="Hz")
    def frequency_hz(self) -> np.ndarray:
        """Damped frequency |Im s| / 2 pi, (m,)."""
        return np.where(self.rigid, 0.0, np.abs(self.eigenvalues.imag) / (2.0 * np.pi))

    @derived(
        "natural frequency", "Hz", "mode", note=", |s| / 2π; equal to the former without damping", form=exact(".4f")
    )
    def natural_frequency_hz(self) -> np.ndarray:
        """|s| / 2 pi, (m,)."""
        return np.where(self.rigid, 0.0, np.abs(self.eigenvalues) / (2.0 * np.pi))

    @derived("damping ratio", "", "mode", note=", −Re s / |s|; negative: unstable", form=".3f", column="zeta %")
    def damping_ratio(self) -> np.ndarray:
        """-Re s / |s|, (m,); 0 for rigid modes, 1 for overdamped and -1 for divergent ones."""
        size = np.abs(self.eigenvalues)
        safe = np.where(size > 0.0, size, 1.0)
        return np.where(self.rigid | (size == 0.0), 0.0, -self.eigenvalues.real / safe) + 0.0

    rigid: np.ndarray = of("whether the mode is a rigid-body motion", "", "mode")
    description: tuple[str, ...] = of("what moves", "", "mode", note=", in a line", column="what moves")
    whirl: tuple[str, ...] = of(
        "sense of whirl", "", "mode", note=': forward, backward, mixed, planar, or `""`', column="whirl"
    )
    error_estimate: np.ndarray = of(
        "estimated relative discretisation error",
        "",
        "mode",
        note=" of the frequency; `null`: the mesh can't follow that mode, or the estimate was left out",
        form=error_words,
        column="error",
    )
    eigenvalues: np.ndarray = of(
        "eigenvalue s",
        "rad/s",
        "mode",
        json=(
            Written("eigenvalue_real_1_per_s", real_part, label="real part of s in rad/s"),
            Written("eigenvalue_imag_1_per_s", imaginary_part, label="imaginary part of s in rad/s"),
        ),
    )
    kinetic_energy: dict[str, np.ndarray] = of(
        "share in the kinetic energy", "", "PART", "mode", note=" of a part such as `gears.pinion`; all sum to 1"
    )
    strain_energy: dict[str, np.ndarray] = of(
        "share in the strain energy", "", "PART", "mode", note=", the same; 0 for rigid-body modes"
    )
    kinetic_by_motion: dict[str, np.ndarray] = of(
        "share of a motion in the kinetic energy",
        "",
        "MOTION",
        "mode",
        note=": bending, axial motion, torsion, casings as `casing`, gear bodies (two and more nodal diameters) as `gear body`",
    )
    strain_by_motion: dict[str, np.ndarray] = of(
        "share of a motion in the strain energy",
        "",
        "MOTION",
        "mode",
        note=": bending, axial and torsional strain of the shafts; meshes, elastic gears, casings, supports and couplings",
    )
    whirl_by_shaft: dict[str, np.ndarray] = of(
        "sense of whirl of each shaft", "", "SHAFT", "mode", json=None, note=", from -1 (backward) to +1 (forward)"
    )
    shapes: np.ndarray = of("displacements x y z tx ty tz", "m, rad", "node", "component", "mode", json=None)
    nodes: NodeTable = of("nodes", record=NodeTable, json=NODE_COUNT)
    backward_error: np.ndarray = of("residual relative to the matrices", "", "mode")
    discretisation: tuple[Piece, ...] = of("how each shaft segment was divided", "", "piece", record=Piece)
    point_amplitudes: dict[str, np.ndarray] = of(
        "amplitude at a named point",
        "m, rad",
        "POINT",
        "mode",
        note=", along its direction, of the shape with modal mass 1 kg",
        json="point_amplitude",
        default_factory=dict,
    )
    mode_class: tuple[str, ...] = classes_over(
        "mode",
        note=", in a few words, with shares of the energy of the stage where there are several; empty without planets",
    )
    class_energy: dict[str, np.ndarray] = class_energy_over("mode")
    carrier_frequency_hz: dict[str, np.ndarray] = carrier_frequency_over("mode")
    carrier_frequency_share: dict[str, np.ndarray] = carrier_share_over("mode")

    def __len__(self) -> int:
        return len(self.eigenvalues)

    @property
    def mesh_text(self) -> str:
        """The discretisation in a few words."""
        if not self.discretisation:
            return "no shaft elements"
        elements = sum(piece.elements for piece in self.discretisation)
        orders = sorted({piece.order for piece in self.discretisation})
        text = f"order {orders[0]}" if len(orders) == 1 else f"orders {orders[0]} to {orders[-1]}"
        return f"{elements} shaft element{'s'[: elements != 1]} of {text} in {len(self.discretisation)} pieces"

    def tables(self, *, energies: bool = False) -> Iterator[Block]:
        """Modes, notes and, where asked for, energy shares."""
        how = "undamped, at standstill"
        damped: tuple[str, ...] = ()
        if self.speed is not None:
            how = f"damped, {self.model.reference_shaft} at {self.speed * RPM_PER_RAD_S:.6g} rpm"
            damped = ("damping_ratio", "whirl")
        yield Line(f"{self.model.title or 'Modes'}: {how}")
        number = Column("mode", lambda k: k + 1)
        # A rigid body has no frequency whose error could be relative to it.
        error = Column("", "error_estimate", where=lambda k: not self.rigid[k])
        words = ("description",) if self.nodes.shaft else ()
        yield table_over(self, "mode", number, "frequency_hz", error, *damped, *words, caption="Modes")
        if self.mode_class:
            seen = carrier_columns(self.carrier_frequency_hz, self.carrier_frequency_share)
            caption = "Classes of planetary motions"
            yield table_over(self, "mode", number, "frequency_hz", *seen, "mode_class", caption=caption, titled=True)
        if energies:
            kinetic = Column("kinetic, by part", lambda k: _largest(self.kinetic_energy, k))
            strain = Column("strain, by part", lambda k: _largest(self.strain_energy, k))
            yield table_over(self, "mode", number, kinetic, strain, caption="Energy shares", titled=True)
        yield from ("", f"{self.dofs} dofs, {self.mesh_text}, {self.cost}; {self.method}")
        estimates = self.error_estimate[np.isfinite(self.error_estimate)]
        if estimates.size:
            yield f"error: estimated relative error of each frequency; largest {error_words(estimates.max(), 1)}"
        yield from (*self.remarks(), "")


def _largest(shares: dict[str, np.ndarray], k: int) -> str:
    """The parts that hold most of a mode's energy."""
    ranked = sorted(((float(share[k]), part) for part, share in shares.items()), reverse=True)[:4]
    return ", ".join(f"{part} {100.0 * share:.0f}%" for share, part in ranked if share >= 0.01)
