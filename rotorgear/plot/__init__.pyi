"""The pictures, one a line: type checkers and editors read them here, and so does `rotorgear.lazy`."""

# Named as the kind of the result that they draw: `result.plot()` calls these.
from rotorgear.plots.campbell import campbell as campbell
from rotorgear.plots.critical_map import critical_map as critical_map
from rotorgear.plots.static import static as static
from rotorgear.plots.response import response as response
from rotorgear.plots.frf import frf as frf
from rotorgear.plots.transient import transient as transient
from rotorgear.plots.sweep import sweep as sweep
from rotorgear.plots.orbits import orbits as orbits
from rotorgear.plots.bearing import bearing as bearing
from rotorgear.plots.design import scatter as scatter
from rotorgear.plots.design import optimise as optimise
from rotorgear.plots.gear_mesh import gear as gear
from rotorgear.plots.mesh import mesh as mesh
from rotorgear.plots.mesh import mesh_map as mesh_map
from rotorgear.plots.mesh import root_stress as root_stress
from rotorgear.plots.convergence import convergence as convergence
from rotorgear.plots.convergence import mesh_convergence as mesh_convergence
from rotorgear.plots.mode_pictures import modal as modal
from rotorgear.plots.correlation import compare_shapes as compare_shapes
from rotorgear.plots.time_comparison import compare_time as compare_time

# More of one result.
from rotorgear.plots.response import waterfall as waterfall
from rotorgear.plots.response import order_map as order_map
from rotorgear.plots.transient import mesh_forces as mesh_forces
from rotorgear.plots.transient import transmission_error as transmission_error
from rotorgear.plots.transient import spectra as spectra
from rotorgear.plots.transient import shaft_orbits as shaft_orbits
from rotorgear.plots.transient import energy as energy
from rotorgear.plots.transient import spectrogram as spectrogram
from rotorgear.plots.sweep import bifurcation as bifurcation
from rotorgear.plots.sweep import sections as sections
from rotorgear.plots.sweep import sweep_map as sweep_map
from rotorgear.plots.sweep import portraits as portraits
from rotorgear.plots.sweep import portrait_spectra as portrait_spectra

from rotorgear.plots.mesh import mesh_pressure as mesh_pressure
from rotorgear.plots.mesh import mesh_loads as mesh_loads
from rotorgear.plots.mesh import mesh_quantity as mesh_quantity

# Files of them.
from rotorgear.plots.figure import save as save
