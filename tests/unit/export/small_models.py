"""Small models for the writers: a helical pair with one of every part, a herringbone pair, and a torsion-only chain."""

from __future__ import annotations

from functools import lru_cache

from rotorgear.analysis.modal.modal import modal
from rotorgear.model.load import loads
from rotorgear.model.model import Model
from rotorgear.results.modal import ModalResult

PAIR = """
schema_version = 1
title = "A helical pair with one of every part"

[operation]
input_shaft = "fast"
speed = "6000 rpm"

[shafts.fast]
position = [0, 0]
sections = [
    { length = "80 mm", outer_diameter = "40 mm", bore = "10 mm" },
    { length = "60 mm", outer_diameter = "50 mm", outer_diameter_end = "40 mm" },
    { length = "60 mm", outer_diameter = "40 mm" },
]

[shafts.slow]
position = ["150 mm", 0]
sections = [{ length = "200 mm", outer_diameter = "60 mm" }]

[shafts.tail]
position = ["150 mm", 0]
start = "220 mm"
sections = [{ length = "100 mm", outer_diameter = "50 mm" }]

[gears.pinion]
shaft = "fast"
at = "100 mm"
kind = "helical"
teeth = 24
normal_module = "4 mm"
helix_angle = "16.260204708311957 deg"
hand = "right"
width = "40 mm"

[gears.wheel]
shaft = "slow"
at = "100 mm"
kind = "helical"
teeth = 48
normal_module = "4 mm"
helix_angle = "16.260204708311957 deg"
hand = "left"
width = "40 mm"
body = { rim_thickness = "12 mm", web_thickness = "14 mm", hub_diameter = "90 mm", hub_width = "40 mm" }

[meshes.pair]
pinion = "pinion"
gear = "wheel"
stiffness = "4e8 N/m"
damping_ratio = 0.05

[bearings.fast_left]
shaft = "fast"
at = "start"
stiffness = { radial = "2e8 N/m", axial = "1e8 N/m" }
pedestal = { mass = "3 kg", stiffness = { x = "5e8 N/m", y = "4e8 N/m" } }

[bearings.fast_right]
shaft = "fast"
at = "end"
stiffness = { radial = "2e8 N/m" }

[bearings.slow_left]
shaft = "slow"
at = "start"
stiffness = { radial = "3e8 N/m", axial = "1e8 N/m" }
damping = { radial = "2000 N s/m" }

[bearings.slow_right]
shaft = "slow"
at = "end"
stiffness = { radial = "3e8 N/m" }

[couplings.flange]
from_shaft = "slow"
to_shaft = "tail"
stiffness = { radial = "1e7 N/m", axial = "1e6 N/m", tilt = "1e4 N m/rad", torsion = "1e5 N m/rad" }

[supports.end]
shaft = "tail"
at = "end"
stiffness = { radial = "1e8 N/m" }
damping = { radial = "500 N s/m" }

[disks.flywheel]
shaft = "tail"
at = "270 mm"
outer_diameter = "160 mm"
width = "20 mm"

[point_masses.sensor]
shaft = "fast"
at = "180 mm"
mass = "0.4 kg"

[points.bearing_y]
on = "bearings.slow_right"
direction = "y"
"""

HERRINGBONE = """
schema_version = 1
title = "A herringbone pair"

[shafts.one]
position = [0, 0]
sections = [{ length = "160 mm", outer_diameter = "40 mm" }]

[shafts.two]
position = [0, "120 mm"]
sections = [{ length = "160 mm", outer_diameter = "50 mm" }]

[gears.pinion]
shaft = "one"
at = "80 mm"
kind = "herringbone"
teeth = 20
normal_module = "3.4641016151377544 mm"
helix_angle = "30 deg"
hand = "right"
width = "30 mm"
gap = "10 mm"

[gears.wheel]
shaft = "two"
at = "80 mm"
kind = "herringbone"
teeth = 40
normal_module = "3.4641016151377544 mm"
helix_angle = "30 deg"
hand = "left"
width = "30 mm"
gap = "10 mm"

[meshes.pair]
pinion = "pinion"
gear = "wheel"
stiffness = "4e8 N/m"

[bearings.a]
shaft = "one"
at = "start"
stiffness = { radial = "2e8 N/m", axial = "1e8 N/m" }

[bearings.b]
shaft = "one"
at = "end"
stiffness = { radial = "2e8 N/m" }

[bearings.c]
shaft = "two"
at = "start"
stiffness = { radial = "2e8 N/m", axial = "1e8 N/m" }

[bearings.d]
shaft = "two"
at = "end"
stiffness = { radial = "2e8 N/m" }
"""

CHAIN = """
schema_version = 1
title = "Rotors without size or place: motor, gear stage, load"
motions = ["torsion"]

[shafts.motor]
[shafts.first]
[shafts.second]
[shafts.load]

[disks.motor]
shaft = "motor"
at = "start"
mass = "0 kg"
polar_inertia = "0.4 kg m^2"
diametral_inertia = "0.2 kg m^2"

[disks.load]
shaft = "load"
at = "start"
mass = "40 kg"
polar_inertia = "2 kg m^2"
diametral_inertia = "1 kg m^2"

[gears.pinion]
shaft = "first"
at = "start"
kind = "spur"
base_radius = "50 mm"
transverse_pressure_angle = "20 deg"
mass = "2 kg"
polar_inertia = "0.01 kg m^2"
diametral_inertia = "0.005 kg m^2"

[gears.wheel]
shaft = "second"
at = "start"
kind = "spur"
base_radius = "100 mm"
transverse_pressure_angle = "20 deg"
mass = "10 kg"
polar_inertia = "0.1 kg m^2"
diametral_inertia = "0.05 kg m^2"

[meshes.stage]
pinion = "pinion"
gear = "wheel"
stiffness = "2e8 N/m"

[couplings.input]
from_shaft = "motor"
to_shaft = "first"
stiffness = { torsion = "2e4 N m/rad" }

[couplings.output]
from_shaft = "second"
to_shaft = "load"
stiffness = { torsion = "5e4 N m/rad" }
"""


@lru_cache
def model_of(text: str) -> Model:
    """The model of a text."""
    return loads(text)


@lru_cache
def modes_of(text: str, speed: float | None = None, modes: int = 4) -> ModalResult:
    """The lowest modes of a model, with two elements in each piece."""
    return modal(model_of(text), speed=speed, modes=modes, elements=2, error_estimate=False)
