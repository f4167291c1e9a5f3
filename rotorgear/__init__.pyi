"""The public names of rotorgear, one a line: type checkers and editors read them here, and so does `rotorgear.lazy`."""

__version__: str

# A model from a file or from parts.
from rotorgear.model.load import load as load
from rotorgear.model.load import loads as loads
from rotorgear.model.load import schema as schema
from rotorgear.rexs.import_rexs import import_rexs as import_rexs
from rotorgear.model.shipped import models as models
from rotorgear.export.model_files import new as new
from rotorgear.model.text import changed_text as changed_text
from rotorgear.model.model import Model as Model
from rotorgear.model.parts.operation import Operation as Operation
from rotorgear.model.parts.load import Load as Load
from rotorgear.model.parts.operation import ModelDamping as ModelDamping
from rotorgear.model.parts.operation import Point as Point
from rotorgear.model.parts.shaft import Material as Material
from rotorgear.model.parts.shaft import Shaft as Shaft
from rotorgear.model.parts.shaft import PositionByMesh as PositionByMesh
from rotorgear.model.parts.shaft import Section as Section
from rotorgear.model.parts.shaft import Disk as Disk
from rotorgear.model.parts.shaft import PointMass as PointMass
from rotorgear.model.parts.gear import Gear as Gear
from rotorgear.model.parts.gear import Flank as Flank
from rotorgear.model.parts.gear import GearBody as GearBody
from rotorgear.model.parts.mesh import Mesh as Mesh
from rotorgear.model.parts.supports import Bearing as Bearing
from rotorgear.model.parts.bearings.rolling import RollingElements as RollingElements
from rotorgear.model.parts.bearings.journal import JournalGeometry as JournalGeometry
from rotorgear.model.parts.bearings.thrust import ThrustGeometry as ThrustGeometry
from rotorgear.model.parts.supports import TableRow as TableRow
from rotorgear.model.parts.supports import Pedestal as Pedestal
from rotorgear.model.parts.supports import Support as Support
from rotorgear.model.parts.supports import Coupling as Coupling
from rotorgear.model.parts.supports import StiffnessMatrix as StiffnessMatrix
from rotorgear.model.parts.supports import DampingMatrix as DampingMatrix
from rotorgear.model.parts.mesh import ErrorHarmonic as ErrorHarmonic
from rotorgear.model.parts.mesh import StiffnessHarmonic as StiffnessHarmonic
from rotorgear.model.parts.load import Unbalance as Unbalance
from rotorgear.model.parts.operation import Scatter as Scatter
from rotorgear.system.system import System as System

# The verbs: a model in, a result out.
from rotorgear.analysis.common.describe_model import check as check
from rotorgear.analysis.modal.modal import modal as modal
from rotorgear.analysis.campbell.campbell import campbell as campbell
from rotorgear.analysis.campbell.critical import critical as critical
from rotorgear.analysis.campbell.critical_map import critical_map as critical_map
from rotorgear.analysis.static.static import static as static
from rotorgear.analysis.response.response import response as response
from rotorgear.analysis.response.frequency_response import frf as frf
from rotorgear.analysis.standards.standards import standards as standards
from rotorgear.analysis.response.state_space import state_space as state_space
from rotorgear.analysis.transient.transient import transient as transient
from rotorgear.analysis.sweep.sweep import sweep as sweep
from rotorgear.analysis.sweep.cluster import cluster as cluster
from rotorgear.analysis.orbits.orbits import orbits as orbits
from rotorgear.analysis.scatter.scatter import scatter as scatter
from rotorgear.analysis.layout.optimise import optimise as optimise
from rotorgear.analysis.teeth.gear_sheet import gear as gear
from rotorgear.analysis.bearing.bearing import bearing as bearing
from rotorgear.analysis.casing.casing import casing as casing
from rotorgear.analysis.teeth.mesh import mesh as mesh
from rotorgear.analysis.teeth.mesh_map import mesh_map as mesh_map
from rotorgear.analysis.teeth.inside_teeth import root_stress as root_stress
from rotorgear.analysis.teeth.optimise import optimise_flanks as optimise_flanks
from rotorgear.plots.view import view as view
from rotorgear import plot as plot
from rotorgear.page.report import report as report
from rotorgear.analysis.accuracy import accuracy as accuracy
from rotorgear.analysis.studies.meshes import convergence_study as convergence_study
from rotorgear.analysis.studies.casing import casing_convergence_study as casing_convergence_study
from rotorgear.analysis.studies.motions import transient_convergence_study as transient_convergence_study
from rotorgear.analysis.studies.motions import sweep_convergence_study as sweep_convergence_study
from rotorgear.analysis.studies.motions import orbits_convergence_study as orbits_convergence_study
from rotorgear.analysis.studies.parts import mesh_convergence_study as mesh_convergence_study
from rotorgear.solvers.batch.flow_exponents import flow_exponents as flow_exponents

# A force law of your own.
from rotorgear.forces.law import ForceLaw as ForceLaw
from rotorgear.forces.law import parameter as parameter
from rotorgear.forces.registry import register_law as register_law
from rotorgear.solvers.time.compiled import force_function as force_function
from rotorgear.solvers.time.compiled import schedule_function as schedule_function
from rotorgear.solvers.time.kernel_contact import no_schedule as no_schedule

# A rig beside them.
from rotorgear.analysis.rig.compare import compare as compare
from rotorgear.analysis.rig.compare_shapes import compare_shapes as compare_shapes
from rotorgear.analysis.rig.compare_responses import compare_frf as compare_frf
from rotorgear.analysis.rig.measured import read_rig_frf as read_rig_frf
from rotorgear.analysis.rig.compare_responses import compare_orders as compare_orders
from rotorgear.analysis.rig.compare_time import compare_time as compare_time
from rotorgear.records.read import read_record as read_record
from rotorgear.records.record import TimeRecord as TimeRecord
from rotorgear.records.record import Channel as Channel
from rotorgear.analysis.rig.compare_responses import read_order_cuts as read_order_cuts
from rotorgear.analysis.rig.rig_file import read_rig_lines as read_rig_lines
from rotorgear.analysis.rig.rig_file import write_rig_lines as write_rig_lines
from rotorgear.analysis.rig.compare_responses import compare_spectrum as compare_spectrum
from rotorgear.analysis.rig.update import update as update
from rotorgear.analysis.rig.sensors import sensors as sensors
from rotorgear.analysis.rig.measured import Campaign as Campaign
from rotorgear.analysis.rig.measured import read_campaigns as read_campaigns
from rotorgear.analysis.rig.measured import Measured as Measured
from rotorgear.analysis.rig.measured import read_rig_shapes as read_rig_shapes
from rotorgear.analysis.rig.likeness import mac as mac
from rotorgear.analysis.transient.spectra import spectrum as spectrum
from rotorgear.analysis.transient.spectra import spectral_lines as spectral_lines

# Files of results.
from rotorgear.export.hdf5 import save as save
from rotorgear.export.hdf5 import read as read
from rotorgear.export.stream import stream as stream
from rotorgear.export.uff import write_uff as write_uff
from rotorgear.export.spreadsheet import write_xlsx as write_xlsx
from rotorgear.export.matrices import write_state_space as write_state_space
from rotorgear.export.matrices import write_matrices as write_matrices
from rotorgear.export.matrices import read_matrices as read_matrices
from rotorgear.export.model_files import write_model_file as write_model_file
from rotorgear.export.tables import write_sensors as write_sensors
from rotorgear.export.model_files import write_updated_model as write_updated_model
from rotorgear.export.model_files import write_optimised_model as write_optimised_model
from rotorgear.export.vtk_parts import write_casing_vtk as write_casing_vtk
from rotorgear.export.vtk import write_vtk as write_vtk
from rotorgear.export.vtk_results import write_motion as write_motion
from rotorgear.export.vtk_results import write_deflections as write_deflections

# The results.
from rotorgear.results.modal import ModalResult as ModalResult
from rotorgear.results.campbell import CampbellResult as CampbellResult
from rotorgear.results.critical import CriticalResult as CriticalResult
from rotorgear.results.critical import CriticalMap as CriticalMap
from rotorgear.results.static import StaticResult as StaticResult
from rotorgear.results.response import ResponseResult as ResponseResult
from rotorgear.results.frequency_response import FrequencyResponse as FrequencyResponse
from rotorgear.results.standards import StandardsResult as StandardsResult
from rotorgear.results.transient import TransientResult as TransientResult
from rotorgear.results.sweep import SweepResult as SweepResult
from rotorgear.results.convergence import SweepConvergenceStudy as SweepConvergenceStudy
from rotorgear.results.orbits import OrbitsResult as OrbitsResult
from rotorgear.results.scatter import ScatterResult as ScatterResult
from rotorgear.results.optimise import OptimiseResult as OptimiseResult
from rotorgear.results.portrait import Portraits as Portraits
from rotorgear.results.gear_sheet import GearSheet as GearSheet
from rotorgear.results.bearing import BearingSheet as BearingSheet
from rotorgear.results.casing import CasingSurvey as CasingSurvey
from rotorgear.results.mesh import MeshResult as MeshResult
from rotorgear.results.mesh_map import MeshMap as MeshMap
from rotorgear.results.root_stress import RootStress as RootStress
from rotorgear.results.mesh_optimum import MeshOptimum as MeshOptimum
from rotorgear.results.convergence import ConvergenceStudy as ConvergenceStudy
from rotorgear.results.comparison import Comparison as Comparison
from rotorgear.results.comparison import RigLine as RigLine
from rotorgear.results.sensors import SensorPlan as SensorPlan
from rotorgear.results.correlation import ShapeComparison as ShapeComparison
from rotorgear.results.time_comparison import TimeComparison as TimeComparison
from rotorgear.results.frf_comparison import FrfComparison as FrfComparison
from rotorgear.results.frf_comparison import OrderComparison as OrderComparison
from rotorgear.results.update import UpdateResult as UpdateResult
from rotorgear.results.rexs_import import RexsImport as RexsImport
from rotorgear.results.state_space import StateSpace as StateSpace

# The errors.
from rotorgear.errors import RotorgearError as RotorgearError
from rotorgear.errors import ModelError as ModelError
from rotorgear.errors import AnalysisError as AnalysisError
from rotorgear.errors import ConvergenceError as ConvergenceError
