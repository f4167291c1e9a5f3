"""CPU seconds of loaded teeth beside another checkout: python -m validation.benchmarks.teeth_times CHECKOUT [mesh] [motion]

mesh: `rotorgear mesh` of the seed pairs a to d (one helix of them, `seed_pairs.py`), all teeth computed from nothing, without a
blank and with one of rim and web; the other checkout without one.
motion: `rotorgear response` and `transient` of the split-torque gearbox with loaded teeth in its first stage: teeth and maps from
nothing, and once more with those that the first run kept. Compiled functions are kept in all cases: a run before makes them.
"""

from __future__ import annotations

import math
import re
import sys
import tempfile
from pathlib import Path

from validation.benchmarks.commands import ROOT, timed

# Teeth, module (mm), pressure angle, helix angle (deg), face (mm), torque (N m) of the pinion.
PAIRS = {
    "a": (29, 113, 2.75, 25.0, 30.0, 65.0, 527.0),
    "b": (26, 125, 4.25, 25.0, 30.0, 85.0, 955.0),
    "c": (34, 80, 5.0, 20.0, 20.86, 54.0, 1000.0),
    "d": (30, 72, 5.0, 20.0, 33.27, 54.0, 1000.0),
}
_PAIR = """schema_version = 1
[shafts.one]
position = ["0 mm", "0 mm"]
sections = [{{ length = "200 mm", outer_diameter = "30 mm" }}]
[shafts.two]
position = ["{distance!r} mm", "0 mm"]
sections = [{{ length = "200 mm", outer_diameter = "60 mm" }}]
[gears.pinion]
shaft = "one"
teeth = {first}
hand = "right"
{common}
[gears.wheel]
shaft = "two"
teeth = {second}
hand = "left"
{common}
{blank}
[meshes.pair]
pinion = "pinion"
gear = "wheel"
stiffness = "tooth_fe"
"""
_COMMON = """at = "100 mm"
kind = "helical"
normal_module = "{module} mm"
normal_pressure_angle = "{alpha} deg"
helix_angle = "{beta} deg"
width = "{width} mm"
"""
_MOTIONS = {
    "response": ["response", "split.toml", "--fmax", "10000"],
    "transient": ["transient", "split.toml", "--time", "20 ms"],
}


def pair_file(name: str, *, blank: bool) -> str:
    """Model file of a seed pair; its wheel with a rim of three modules on a web of 0.3 of the face."""
    first, second, module, alpha, beta, width, _ = PAIRS[name]
    common = _COMMON.format(module=module, alpha=alpha, beta=beta, width=width)
    body = (
        f'body = {{ bore = "60 mm", rim_thickness = "{3 * module} mm", web_thickness = "{0.3 * width} mm", '
        f'hub_diameter = "90 mm" }}'
    )
    distance = 0.5 * module * (first + second) / math.cos(math.radians(beta))
    return _PAIR.format(distance=distance, first=first, second=second, common=common, blank=body if blank else "")


def split_torque() -> str:
    """The split-torque gearbox with loaded teeth in its first stage, and no error of its own there."""
    text = (ROOT / "models" / "split_torque.toml").read_text(encoding="utf-8")
    for mesh in ("stage_1a", "stage_1b"):
        head, mark, tail = text.partition(f"[meshes.{mesh}]")
        tail = re.sub(r'stiffness = "5.63e8 N/m"', 'stiffness = "tooth_fe"', tail, count=1)
        text = head + mark + re.sub(r"transmission_error = .*", "", tail, count=1)
    return text + "\n[damping]\nmodal_ratio = 0.02\n"


def main(words: list[str]) -> None:
    """Print both tables."""
    other = Path(words[0]).resolve()
    kinds = words[1:] or ["mesh", "motion"]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if "mesh" in kinds:
            of_pairs(other, folder)
        if "motion" in kinds:
            of_motions(other, folder)


def seconds(arguments: list[str], checkout: Path, cache: Path, folder: Path) -> float:
    """CPU seconds of one command with a folder of its own for what is kept of teeth."""
    one_thread = dict.fromkeys(("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "OMP_NUM_THREADS"), "1")
    return timed(arguments, checkout, {**one_thread, "ROTORGEAR_CACHE": str(cache)}, folder)[0]


def of_pairs(other: Path, folder: Path) -> None:
    """Seed pairs from nothing."""
    print("pair   there, s   here, s   ratio   with a blank, s   ratio", flush=True)
    for name, (*_, torque) in PAIRS.items():
        took = []
        for number, (checkout, blank) in enumerate(((other, False), (ROOT, False), (ROOT, True))):
            (folder / "pair.toml").write_text(pair_file(name, blank=blank), encoding="utf-8")
            arguments = ["mesh", "pair.toml", "--torque", f"{torque} N m"]
            took.append(seconds(arguments, checkout, folder / f"cache_{name}_{number}", folder))
        there, here, blanked = took
        print(
            f"{name:4} {there:10.1f} {here:9.1f} {here / there:7.2f} {blanked:17.1f} {blanked / there:7.2f}",
            flush=True,
        )


def of_motions(other: Path, folder: Path) -> None:
    """Response and transient of the split-torque gearbox."""
    (folder / "split.toml").write_text(split_torque(), encoding="utf-8")
    print("command     teeth          there, s   here, s   ratio", flush=True)
    for name, arguments in _MOTIONS.items():
        took = []
        for checkout in (other, ROOT):
            own = [folder / f"{name}_{checkout.name}_{number}" for number in range(2)]
            seconds(arguments, checkout, own[0], folder)  # compiles
            took.append([seconds(arguments, checkout, own[1], folder) for _ in range(2)])
        for teeth, there, here in zip(("from nothing", "kept"), *took, strict=True):
            print(f"{name:11} {teeth:13} {there:9.1f} {here:9.1f} {here / there:7.2f}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
