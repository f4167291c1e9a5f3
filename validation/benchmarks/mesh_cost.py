"""Forecast of memory and time of teeth in space, and what they took: python -m validation.benchmarks.mesh_cost [pairs]

Each gear is computed in a process of its own, from nothing: the pinion of a pair, or the wheel on its blank ("web"). Seconds are
those of the clock, on the machine as it is.
"""

from __future__ import annotations

import subprocess
import sys
import time
from dataclasses import replace

from rotorgear.gears.loaded.tooth_contact import gear_key, in_space
from rotorgear.gears.tooth_fe.compliance_model import ComplianceKey, forecast, gear_compliance, pitch_of
from rotorgear.gears.tooth_fe.settings import ToothFe
from rotorgear.memory import largest_memory
from validation.benchmarks.mesh_estimates import HELICAL

PRESETS = ("default", "fine")
WEB = {"bore": 0.08, "rim_thickness": 0.015, "web_thickness": 0.016, "hub_diameter": 0.12}
PAIRS = {**HELICAL, "34/80 20.86 web": replace(HELICAL["34/80 20.86"], flank=({}, {"body": WEB}))}


def key_of(name: str, preset: str) -> ComplianceKey:
    """Pinion of a helical pair, or its wheel on a web."""
    teeth = PAIRS[name].request().teeth
    assert teeth is not None
    teeth = replace(teeth, fe=ToothFe(preset=preset))  # type: ignore[arg-type]
    return gear_key(teeth, 1 if name.endswith("web") else 0, space=in_space(teeth)[0])


def measure(name: str, preset: str) -> None:
    """Print forecast and measurement of one gear."""
    key = key_of(name, preset)
    forecast_memory, forecast_seconds = forecast(key, pitch_of(key)[1])
    begun = time.perf_counter()
    gear_compliance(key, fresh=True)
    seconds = time.perf_counter() - begun
    memory = largest_memory() or float("nan")
    print(
        f"{name:18} {preset:8} {key.size.face:6} {1e-9 * forecast_memory:9.2f} {1e-9 * memory:9.2f} "
        f"{forecast_seconds:11.1f} {seconds:9.1f}",
        flush=True,
    )


def main(words: list[str]) -> None:
    """Print the table."""
    if words and words[0] == "--one":
        measure(words[1], words[2])
        return
    print("pair               preset   layers  GB said  GB taken      s said   s taken", flush=True)
    for name in words or PAIRS:
        for preset in PRESETS:
            subprocess.run([sys.executable, "-m", "validation.benchmarks.mesh_cost", "--one", name, preset], check=True)


if __name__ == "__main__":
    main(sys.argv[1:])
