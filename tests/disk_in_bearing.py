"""The smallest rotor that shows a bearing: a rigid disk in it, pulled, which other supports hold in all but what is looked at."""

from __future__ import annotations

import rotorgear as rg


def disk_in_bearing(
    bearing: str,
    force: str,
    *,
    name: str = "front",
    speed: str = "3000 rpm",
    mass: float = 10.0,
    motions: str = "",
    fixed: str = '"z", "tilt_x", "tilt_y"',
) -> rg.Model:
    """The model.

    Args:
        bearing: its keys, such as 'journal = { ... }'. force: of the pull, three components as the file has them.
        name, speed, mass: of the bearing, of the shaft, of the disk in kg. motions, fixed: lists as the file has them.
    """
    return rg.loads(f"""
{f"motions = [{motions}]" if motions else ""}
[operation]
input_shaft = "rotor"
speed = "{speed}"
[shafts.rotor]
[bearings.{name}]
shaft = "rotor"
at = "start"
{bearing}
[supports.guide]
shaft = "rotor"
at = "start"
fixed = [{fixed}]
[disks.d]
shaft = "rotor"
at = "start"
mass = {mass}
polar_inertia = 0.1
diametral_inertia = 0.1
[loads.pull]
shaft = "rotor"
at = "start"
force = {force}
""")
