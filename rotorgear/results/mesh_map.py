"""Result of a mesh over torque and misalignment: transmission error, pressure and load along the face."""

from __future__ import annotations

import numpy as np

from rotorgear.results.result import Result
from rotorgear.results.schema import of


class MeshMap(Result, kind="mesh_map"):
    """One mesh at t torques and m misalignments; arrays are (t, m)."""

    title: str = of("title of the model")
    mesh: str = of("mesh", note=": its name")
    pinion: str = of("gear that the file calls the pinion")
    gear: str = of("gear that meshes with the pinion")
    preset: str = of("preset of the finite elements")
    body: str = of("what the teeth stand on", note=", in words")
    helices: int = of("number of helices")
    positions: int = of("positions in the mesh period")
    pinion_torque: np.ndarray = of("torque on the pinion about +z", "N m", "torque", json="pinion_torque_n_m")
    misalignment: np.ndarray = of(
        "misalignment over the face",
        "m",
        "misalignment",
        json="misalignment_m",
        note=", positive where the flanks stand apart at larger z",
    )
    ste_peak_to_peak: np.ndarray = of(
        "peak to peak of the transmission error", "m", "torque", "misalignment", json="ste_peak_to_peak_m"
    )
    ste_harmonics: np.ndarray = of(
        "amplitudes of mesh orders 1 to 3 of the transmission error",
        "m",
        "torque",
        "misalignment",
        "order",
        json="ste_harmonics_m",
    )
    largest_pressure: np.ndarray = of(
        "largest contact pressure", "Pa", "torque", "misalignment", json="largest_pressure_pa"
    )
    face_load_factor: np.ndarray = of(
        "face load factor",
        "",
        "torque",
        "misalignment",
        note=" K_Hbeta: largest load per width over the mean one, mean of the mesh cycle",
    )
    mean_stiffness: np.ndarray = of(
        "mean stiffness", "N/m", "torque", "misalignment", json="mean_stiffness_n_per_m", note=", transverse"
    )
    dofs: int = of("degrees of freedom", note=" of both gears' elements")
