"""The finite-element model of a casing, ready to be solved: checked mesh, matrices, seats, mounts and what is held."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from scipy.sparse.csgraph import connected_components

from rotorgear.casings.assembly import Assembled, assemble
from rotorgear.casings.box import box_mesh
from rotorgear.casings.file_mesh import NamedSet
from rotorgear.casings.joins import Joined, join
from rotorgear.casings.mechanisms import no_hinges, no_mechanism
from rotorgear.casings.mesh_file import read_mesh
from rotorgear.casings.patches import Patch, by_cylinder, by_set, cylinder_faces
from rotorgear.casings.reduced_body import mass_properties, node_dofs, rigid_motions
from rotorgear.casings.settings import CasingSettings
from rotorgear.casings.solid_mesh import SolidMesh, merged, solid_mesh
from rotorgear.casings.split import split
from rotorgear.errors import AnalysisError
from rotorgear.progress import Progress, silent
from rotorgear.quantity import millimetres

# Plausible sizes of a casing in m; outside this range the unit is probably wrong.
_LEAST_SIZE = 5e-3
_LARGEST_SIZE = 50.0


@dataclass(frozen=True)
class FreeSpace:
    """Displacements of all nodes from f free dofs, and from the motions of seats that are rigid.

    Attributes:
        dofs: (f,) numbers of the free dofs among those of all nodes.
        shapes: (3p, f).
        seats: (3p, 6 s); no columns where no seat is rigid.
    """

    dofs: np.ndarray
    shapes: sp.csr_array
    seats: sp.csr_array

    def forces(self, columns: np.ndarray) -> np.ndarray:
        """Forces (f, k) on the free dofs of forces (3p, k) on all nodes."""
        return np.asarray(self.shapes.T @ columns)


@dataclass(frozen=True)
class FiniteElementBody:
    """A casing's mesh with its matrices, its seats and what holds it.

    Attributes:
        settings: of the model file.
        mesh: in m.
        matrices: of all nodes, tied ones as if they were free.
        joined: what joins add.
        seats: patches in the order of the settings.
        mounts: patches in the order of the settings.
        held: nodes that are fixed.
        held_sets: the same by sets, in the order of the settings; a node of two is in the first.
    """

    settings: CasingSettings
    mesh: SolidMesh
    matrices: Assembled
    joined: Joined
    seats: tuple[Patch, ...]
    mounts: tuple[Patch, ...]
    held: np.ndarray
    held_sets: tuple[np.ndarray, ...] = ()

    @property
    def dofs(self) -> int:
        """Number of displacements, three of each node."""
        return 3 * len(self.mesh.points)

    @cached_property
    def mass_properties(self) -> tuple[float, np.ndarray, np.ndarray]:
        """Mass in kg, centre (3,) in m, and inertia tensor (3, 3) about it in kg m^2, of the mesh."""
        return mass_properties(self.rigid_mass(rigid_motions(self.mesh.points)))

    def rigid_mass(self, motions: np.ndarray) -> np.ndarray:
        """Mass matrix (6, 6) of rigid motions (3p, 6)."""
        return np.asarray(motions.T @ self.matrices.times_mass(motions))

    def mass_times(self, columns: np.ndarray, space: FreeSpace) -> np.ndarray:
        """M U for U (f, k) of the free dofs of a space."""
        return space.forces(self.matrices.times_mass(space.shapes @ columns))

    def stiffness_times(self, columns: np.ndarray) -> np.ndarray:
        """K U with the joints, without mounts, for U (3p, k)."""
        product = np.asarray(self.matrices.stiffness @ columns)
        if self.joined.stiffness is not None:
            nodes = len(self.mesh.points)
            product += (self.joined.stiffness @ columns.reshape(nodes, -1)).reshape(columns.shape)
        return product

    def free_space(self, *, held: bool, rigid_seats: bool) -> FreeSpace:
        """The displacements that a body has, by its free nodes and the motions of rigid seats.

        Args:
            held: whether the held nodes are fixed; else they are free.
            rigid_seats: whether the nodes of seats follow their seat.
        """
        nodes = len(self.mesh.points)
        free = np.ones(nodes, dtype=bool)
        free[self.joined.tied] = False
        if held:
            free[self.held] = False
        seat_columns = sp.csr_array((3 * nodes, 0))
        if rigid_seats:
            blocks = []
            for patch in self.seats:
                free[patch.nodes] = False
                motions = rigid_motions(self.mesh.points[patch.nodes], patch.point)
                dofs = node_dofs(patch.nodes)
                rows = np.repeat(dofs, 6)
                columns = np.tile(np.arange(6), len(dofs))
                blocks.append(sp.coo_array((motions.ravel(), (rows, columns)), shape=(3 * nodes, 6)))
            seat_columns = sp.csr_array(sp.hstack(blocks))
        chosen = np.flatnonzero(free)
        select = sp.csr_array((np.ones(len(chosen)), (chosen, np.arange(len(chosen)))), shape=(nodes, len(chosen)))
        space = sp.csr_array(sp.kron(select, sp.eye_array(3)))
        if self.joined.interpolation is not None:
            follow = sp.csr_array(sp.kron(self.joined.interpolation, sp.eye_array(3)))
            space = sp.csr_array(follow @ space)
            seat_columns = sp.csr_array(follow @ seat_columns)
        return FreeSpace(node_dofs(chosen), space, seat_columns)

    def stiffness_in(self, space: sp.csr_array) -> sp.csr_array:
        """Pᵀ K P of a space P of displacements, with the joints."""
        K = sp.csr_array(self.matrices.stiffness)
        if self.joined.stiffness is not None:
            K = sp.csr_array(K + sp.kron(self.joined.stiffness, sp.eye_array(3), format="csr"))
        if space.nnz == space.shape[1]:  # a plain choice of dofs
            chosen = np.flatnonzero(np.diff(space.indptr))
            return K if len(chosen) == K.shape[0] else sp.csr_array(K[chosen][:, chosen])
        return sp.csr_array(space.T @ K @ space)

    def mean_weights(self, patches: tuple[Patch, ...]) -> np.ndarray:
        """W (3p, 6 n): mean motions of patches from displacements of all nodes."""
        W = np.zeros((self.dofs, 6 * len(patches)))
        for number, patch in enumerate(patches):
            dofs = node_dofs(patch.nodes)
            W[dofs, 6 * number : 6 * number + 6] = patch.weights(self.mesh.points)
        return W

    def springs(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Directions (3p, m) of the springs of all mounts, W V, their flexibilities (m,), and the number (m,) of their mount.

        The mounts' stiffness is D = V diag(1/C) Vᵀ.
        """
        W = self.mean_weights(self.mounts)
        columns = [W[:, :0]]
        flexibility: list[float] = []
        mounts: list[int] = []
        for number, mount in enumerate(self.settings.mounts):
            values, directions = np.linalg.eigh(np.array(mount.stiffness))
            strong = values > 1e-12 * max(values.max(), 1e-300)  # along these it resists at all
            columns.append(W[:, 6 * number : 6 * number + 6] @ directions[:, strong])
            flexibility += (1.0 / values[strong]).tolist()
            mounts += [number] * int(strong.sum())
        return np.hstack(columns), np.array(flexibility), np.array(mounts, dtype=int)


def finite_element_body(settings: CasingSettings, progress: Progress = silent) -> FiniteElementBody:
    """Read, check and assemble the mesh of a casing.

    Raises:
        AnalysisError: whatever is wrong with the mesh or with what the model file says of it: one sentence with the remedy.
        MissingExtraError: meshio or scikit-fem is not installed.
    """
    address = settings.address
    progress(0.0, f"{address}: reading the mesh")
    meshes = {}
    for part, path in settings.files:
        where = f"{address}.mesh" if len(settings.files) == 1 else f"{address}.mesh.{part}"
        meshes[part] = solid_mesh(read_mesh(path, where), settings.unit, where)
    if settings.box is not None:
        drawn = solid_mesh(box_mesh(settings.box, address), settings.unit, f"{address}.box")
        meshes["box"] = replace(drawn, notes=())  # bricks of the first order are our own, and so are polygons as bores
    whole = merged(meshes, f"{address}.mesh")
    joined = join(_split(whole, settings) if settings.splits else whole, settings.joins, address)
    mesh = joined.mesh
    size = np.ptp(mesh.points, axis=0)
    if not _LEAST_SIZE <= size.max() <= _LARGEST_SIZE:
        box = " x ".join(millimetres(side) for side in size)
        raise AnalysisError(
            f"{address}.unit: the mesh measures {box} in this unit. Files of meshes carry no unit: say the one it was "
            f"drawn in, such as unit = '{'mm' if size.max() > _LARGEST_SIZE else 'm'}'."
        )
    _one_body(joined, settings)
    seats = tuple(
        by_set(mesh, place, f"{address}.seats.{name}")
        if isinstance(place, str)
        else by_cylinder(mesh, place, f"{address}.seats.{name}")
        for name, place in settings.seats
    )
    mounts = tuple(by_set(mesh, mount.set, f"{address}.mounts.{mount.set}") for mount in settings.mounts)
    held_patches = [by_set(mesh, name, f"{address}.held[{number}]") for number, name in enumerate(settings.held)]
    held = np.zeros(0, dtype=int)
    held_sets = []
    for patch in held_patches:
        held_sets.append(np.setdiff1d(patch.nodes, held))
        held = np.union1d(held, patch.nodes)
    progress(0.3, f"{address}: assembling {3 * len(mesh.points)} unknowns")
    matrices = assemble(mesh, settings.material)
    body = FiniteElementBody(settings, mesh, matrices, joined, seats, mounts, held, tuple(held_sets))
    _apart(body)
    for patch in (*seats, *mounts):
        patch.weights(mesh.points)
    mass = body.mass_properties[0]
    if settings.mass is not None and abs(mass / settings.mass - 1.0) > settings.mass_tolerance:
        ratio = mass / settings.mass
        units = {1e9: "the mesh is in mm", 1e-9: "the mesh is in m", 1e6: "the mesh is in cm", 1e3: "the mesh is in dm"}
        units[0.0254**-3] = "the mesh is in inches"
        hint = next((f": {text}?" for factor, text in units.items() if 0.7 < ratio / factor < 1.4), "")
        raise AnalysisError(
            f"{address}.mass: the mesh has {mass:.6g} kg, and {settings.mass:.6g} kg are stated{hint or '.'} Check unit and "
            "density, or give mass_tolerance."
        )
    springs = body.springs()[0]
    no_mechanism(settings, mesh, held, springs)
    no_hinges(settings, joined, held, springs)
    progress(1.0, f"{address}: assembled")
    return body


def _split(mesh: SolidMesh, settings: CasingSettings) -> SolidMesh:
    """The mesh split as often as the settings say; bores are found before that, on the corners of the file."""
    sets = dict(mesh.sets)
    for name, place in settings.seats:
        address = f"{settings.address}.seats.{name}"
        if not isinstance(place, str) and address not in sets:
            faces = cylinder_faces(mesh, place, address)
            sets[address] = NamedSet(np.unique(faces), [faces[:, : len(mesh.element.faces[0])]])
    mesh = replace(mesh, sets=sets)
    for _ in range(settings.splits):
        mesh = split(mesh)
    note = f"Every element was split in eight, {settings.splits} time{'s'[: settings.splits != 1]}."
    return replace(mesh, notes=(*mesh.notes, note))


def _one_body(joined: Joined, settings: CasingSettings) -> None:
    """Refuse a mesh whose elements do not all hang together, through nodes or joins."""
    mesh = joined.mesh
    labels = mesh.parts()
    if labels.max() == 0:
        return
    links = joined.links()
    n = int(labels.max()) + 1
    joint = sp.coo_array((np.ones(links.nnz), (labels[links.row], labels[links.col])), shape=(n, n))
    count, groups = connected_components(joint)
    if count == 1:
        return
    body_of = groups[labels][mesh.cells[:, 0]]
    elements = np.bincount(body_of)
    small = elements.min() < 0.01 * elements.max()
    remedy = "take free floating parts out of the mesh" if small else "join them: joins = [{ faces = ['A', 'B'] }]"
    raise AnalysisError(
        f"{settings.address}.mesh: the mesh has {count} bodies that do not hang together: {mesh.in_words(body_of)}. If they "
        f"touch, merge their nodes in the mesher; else {remedy}."
    )


def _apart(body: FiniteElementBody) -> None:
    """Refuse nodes that are in two seats, or in a seat and held, and mounts on held nodes alone."""
    settings = body.settings
    seats = body.seats
    held = body.held
    held_sets = ", ".join(settings.held)
    for patch in body.mounts:
        if np.isin(patch.nodes, held).all():
            raise AnalysisError(f"{patch.name}: all its nodes are held ({held_sets}): mount it or hold it.")
    for number, (name, _) in enumerate(settings.seats):
        nodes = seats[number].nodes
        address = f"{settings.address}.seats.{name}"
        if np.isin(nodes, held).any():
            raise AnalysisError(f"{address}: nodes of this seat are held ({held_sets}): a seat is free to move.")
        if settings.connection == "rigid" and np.isin(nodes, body.joined.tied).any():
            why = "nodes of this seat are tied by a join, and the seat is rigid: leave a gap between them"
            raise AnalysisError(f"{address}: {why}.")
        for other, (other_name, _) in enumerate(settings.seats[:number]):
            common = int(np.count_nonzero(np.isin(nodes, seats[other].nodes)))
            # Bearings side by side in one bore share the nodes between them, which mean motions may do.
            if common and (settings.connection == "rigid" or common == min(len(nodes), len(seats[other].nodes))):
                raise AnalysisError(f"{address}: the seat shares nodes with {other_name}: give each its own face.")
