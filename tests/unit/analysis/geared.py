"""Model files with one loaded pair 34/80 of module 5 mm, for the tests of meshes."""

from __future__ import annotations

import math


def pair_file(
    helix: float = 0.0,
    kind: str = "spur",
    torque: str = "1000 N m",
    mesh: str = 'stiffness = "tooth_fe"',
    pinion: str = "",
    wheel: str = "",
    hand: tuple[str, str] = ("right", "left"),
) -> str:
    """Text of a model: two shafts in stiff bearings, a torque on the pinion's, the rest on the wheel's."""
    distance = 285.0 / math.cos(math.radians(helix))
    text = 'schema_version = 1\ntitle = "Pair 34/80"\n'
    text += '[operation]\ninput_shaft = "one"\noutput_shaft = "two"\nspeed = "1000 rpm"\n'
    text += f'[loads.drive]\nshaft = "one"\nkind = "input"\ntorque = "{torque}"\n' if torque else ""
    text += '[loads.brake]\nshaft = "two"\nkind = "output"\n' if torque else ""
    for name, x, teeth, own, extra in (("one", 0.0, 34, hand[0], pinion), ("two", distance, 80, hand[1], wheel)):
        text += f'[shafts.{name}]\nposition = ["{x!r} mm", "0 mm"]\n'
        text += 'sections = [{ length = "300 mm", outer_diameter = "80 mm" }]\n'
        text += f'[gears.{"pinion" if name == "one" else "wheel"}]\nshaft = "{name}"\nat = "150 mm"\nkind = "{kind}"\n'
        text += f'teeth = {teeth}\nnormal_module = "5 mm"\nwidth = "54 mm"\n'
        text += f'helix_angle = "{helix} deg"\nhand = "{own}"\n' if helix else ""
        text += 'gap = "20 mm"\n' if kind == "herringbone" else ""
        text += extra + "\n"
        for end in ("start", "end"):
            text += f'[bearings.{name}_{end}]\nshaft = "{name}"\nat = "{end}"\n'
            text += 'stiffness = { radial = "1e9 N/m", axial = "1e9 N/m" }\n'
    return text + f'[meshes.pair]\npinion = "pinion"\ngear = "wheel"\n{mesh}\n'
