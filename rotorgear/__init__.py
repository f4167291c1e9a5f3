"""rotorgear: finite-element rotor-gear analysis.

    import rotorgear as rg
    model = rg.load("models/split_torque.toml")
    result = rg.modal(model, fmax=5000.0)

Names are loaded when they are first used, so that importing the package costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from rotorgear.version import VERSION

__version__ = VERSION

_HOMES = {
    "rotorgear.model.load": ("load", "loads", "json_schema"),
    "rotorgear.model.model": ("Model",),
    "rotorgear.model.parts.shaft": ("Shaft", "Section", "Material"),
    "rotorgear.model.parts.bodies": ("Disk", "PointMass"),
    "rotorgear.model.parts.gear": ("Gear", "GearBody"),
    "rotorgear.model.parts.excitation": ("ErrorHarmonic", "StiffnessHarmonic", "Unbalance"),
    "rotorgear.model.parts.mesh": ("Mesh",),
    "rotorgear.model.parts.supports": (
        "Bearing",
        "TableRow",
        "Pedestal",
        "Support",
        "Coupling",
        "StiffnessMatrix",
        "DampingMatrix",
    ),
    "rotorgear.model.parts.operation": ("Operation", "Load", "ModelDamping", "Point"),
    "rotorgear.system.system": ("System",),
    "rotorgear.analysis.modal.modal": ("modal",),
    "rotorgear.analysis.static.static": ("static",),
    "rotorgear.analysis.response.response": ("response",),
    "rotorgear.analysis.response.frequency_response": ("frequency_response",),
    "rotorgear.analysis.modal.accuracy": ("accuracy_ladder",),
    "rotorgear.analysis.transient.transient": ("transient",),
    "rotorgear.analysis.transient.ladder": ("transient_ladder",),
    "rotorgear.analysis.sweep.sweep": ("sweep",),
    "rotorgear.analysis.sweep.ladder": ("sweep_ladder",),
    "rotorgear.analysis.sweep.cluster": ("cluster",),
    "rotorgear.solvers.lanes.flow_exponents": ("flow_exponents",),
    "rotorgear.analysis.transient.spectra": ("spectrum", "spectral_lines"),
    "rotorgear.analysis.rig.rig_spectrum": ("compare_spectrum",),
    "rotorgear.analysis.campbell.campbell": ("campbell",),
    "rotorgear.analysis.campbell.critical": ("critical_speeds",),
    "rotorgear.analysis.campbell.critical_map": ("critical_map",),
    "rotorgear.results.critical": ("CriticalResult", "CriticalMap"),
    "rotorgear.results.campbell": ("CampbellResult",),
    "rotorgear.analysis.teeth.gear_sheet": ("gear_sheet",),
    "rotorgear.analysis.teeth.mesh": ("mesh_analysis",),
    "rotorgear.analysis.teeth.ladder": ("mesh_ladder",),
    "rotorgear.analysis.rig.compare": ("compare", "read_rig_lines"),
    "rotorgear.analysis.common.describe_model": ("describe_model",),
    "rotorgear.results.modal": ("ModalResult",),
    "rotorgear.results.transient": ("TransientResult",),
    "rotorgear.results.sweep": ("SweepResult",),
    "rotorgear.results.sweep_ladder": ("SweepLadder",),
    "rotorgear.results.portrait": ("Portraits",),
    "rotorgear.results.static": ("StaticResult",),
    "rotorgear.results.response": ("ResponseResult",),
    "rotorgear.results.frequency_response": ("FrequencyResponse",),
    "rotorgear.results.accuracy": ("AccuracyLadder",),
    "rotorgear.results.gear_sheet": ("GearSheet",),
    "rotorgear.results.mesh": ("MeshResult",),
    "rotorgear.results.comparison": ("Comparison", "RigLine"),
    "rotorgear.export.vtk": ("write_vtk",),
    "rotorgear.export.stream": ("stream",),
    "rotorgear.export.vtk_motion": ("write_motion",),
    "rotorgear.export.vtk_deflection": ("write_deflections",),
    "rotorgear.export.hdf5": ("save", "read"),
    "rotorgear.errors": ("RotorgearError", "ModelError", "AnalysisError", "ConvergenceError"),
}
_HOME = {name: module for module, names in _HOMES.items() for name in names}
__all__ = ["__version__", *_HOME]

if TYPE_CHECKING:
    from rotorgear.analysis.campbell.campbell import campbell
    from rotorgear.analysis.campbell.critical import critical_speeds
    from rotorgear.analysis.campbell.critical_map import critical_map
    from rotorgear.analysis.common.describe_model import describe_model
    from rotorgear.analysis.modal.accuracy import accuracy_ladder
    from rotorgear.analysis.modal.modal import modal
    from rotorgear.analysis.response.frequency_response import frequency_response
    from rotorgear.analysis.response.response import response
    from rotorgear.analysis.rig.compare import compare, read_rig_lines
    from rotorgear.analysis.rig.rig_spectrum import compare_spectrum
    from rotorgear.analysis.static.static import static
    from rotorgear.analysis.sweep.cluster import cluster
    from rotorgear.analysis.sweep.ladder import sweep_ladder
    from rotorgear.analysis.sweep.sweep import sweep
    from rotorgear.analysis.teeth.gear_sheet import gear_sheet
    from rotorgear.analysis.teeth.ladder import mesh_ladder
    from rotorgear.analysis.teeth.mesh import mesh_analysis
    from rotorgear.analysis.transient.ladder import transient_ladder
    from rotorgear.analysis.transient.spectra import spectral_lines, spectrum
    from rotorgear.analysis.transient.transient import transient
    from rotorgear.errors import AnalysisError, ConvergenceError, ModelError, RotorgearError
    from rotorgear.export.hdf5 import read, save
    from rotorgear.export.stream import stream
    from rotorgear.export.vtk import write_vtk
    from rotorgear.export.vtk_deflection import write_deflections
    from rotorgear.export.vtk_motion import write_motion
    from rotorgear.model.load import json_schema, load, loads
    from rotorgear.model.model import Model
    from rotorgear.model.parts.bodies import Disk, PointMass
    from rotorgear.model.parts.excitation import ErrorHarmonic, StiffnessHarmonic, Unbalance
    from rotorgear.model.parts.gear import Gear, GearBody
    from rotorgear.model.parts.mesh import Mesh
    from rotorgear.model.parts.operation import Load, ModelDamping, Operation, Point
    from rotorgear.model.parts.shaft import Material, Section, Shaft
    from rotorgear.model.parts.supports import (
        Bearing,
        Coupling,
        DampingMatrix,
        Pedestal,
        StiffnessMatrix,
        Support,
        TableRow,
    )
    from rotorgear.results.accuracy import AccuracyLadder
    from rotorgear.results.campbell import CampbellResult
    from rotorgear.results.comparison import Comparison, RigLine
    from rotorgear.results.critical import CriticalMap, CriticalResult
    from rotorgear.results.frequency_response import FrequencyResponse
    from rotorgear.results.gear_sheet import GearSheet
    from rotorgear.results.mesh import MeshResult
    from rotorgear.results.modal import ModalResult
    from rotorgear.results.portrait import Portraits
    from rotorgear.results.response import ResponseResult
    from rotorgear.results.static import StaticResult
    from rotorgear.results.sweep import SweepResult
    from rotorgear.results.sweep_ladder import SweepLadder
    from rotorgear.results.transient import TransientResult
    from rotorgear.solvers.lanes.flow_exponents import flow_exponents
    from rotorgear.system.system import System


def __getattr__(name: str) -> Any:
    if name in _HOME:
        return getattr(import_module(_HOME[name]), name)
    raise AttributeError(f"module 'rotorgear' has no attribute '{name}'")


def __dir__() -> list[str]:
    return sorted(__all__)
