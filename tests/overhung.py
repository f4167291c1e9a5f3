"""A rotor whose gyroscopic moments matter."""

from __future__ import annotations

from typing import Any

import rotorgear as rg


def overhung_disk(**shaft: Any) -> rg.Model:
    """A shaft "s" on two bearings with a wide disk beyond them: its gyroscopic moments move critical speeds strongly."""
    return rg.Model(
        shafts={"s": {"sections": [{"length": 0.6, "outer_diameter": 0.04}], **shaft}},
        disks={"d": {"shaft": "s", "at": 0.6, "outer_diameter": 0.35, "bore": 0.04, "width": 0.03}},
        bearings={
            "a": {"shaft": "s", "at": 0.0, "stiffness": {"radial": 1e8, "axial": 1e8}, "damping": {"radial": 500.0}},
            "b": {"shaft": "s", "at": 0.35, "stiffness": {"radial": 1e8}, "damping": {"radial": 500.0}},
        },
        operation={"input_shaft": "s", "speed": 800.0, "gravity": [0.0, -9.81, 0.0]},
        unbalances={"u": {"shaft": "s", "at": 0.6, "magnitude": 1e-4}},
    )
