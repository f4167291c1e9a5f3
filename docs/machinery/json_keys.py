"""The keys of the JSON output of each command, from the declarations of the results."""

from __future__ import annotations

from collections.abc import Iterator

from rotorgear.results.kinds import keys_of, kinds
from rotorgear.results.result import ModelResult

# Heading, words before the table, and the kinds of results with what stands before their keys.
SECTIONS: tuple[tuple[str, str, tuple[tuple[str, str], ...]], ...] = (
    (
        "modal",
        "`rotorgear modal MODEL --json modal.json`. With `--rig`, the keys of the [comparison](#compare) stand below\n"
        "`comparison`.",
        (("modal", ""),),
    ),
    ("compare", "`rotorgear compare MODEL RIG --json compare.json` writes these keys.", (("compare", ""),)),
    (
        "compare shapes",
        "`rotorgear compare MODEL --shapes FILE --json compare.json`. [The rig](rig.md) says what the numbers mean.",
        (("compare_shapes", ""),),
    ),
    (
        "compare frequency responses",
        "`rotorgear compare MODEL --frf FILE --json compare.json`.",
        (("compare_frf", ""),),
    ),
    (
        "compare order cuts",
        "`rotorgear compare MODEL --orders FILE --json compare.json`.",
        (("compare_orders", ""),),
    ),
    (
        "compare records over time",
        "`rotorgear compare MODEL --time FILE --json compare.json`. `rig_values`, `model_values` and `baseline_values` (of a "
        "model without vibration) go along `channels`, then along `time_s`; `load` along `inputs`.",
        (("compare_time", ""),),
    ),
    ("sensors", "`rotorgear sensors MODEL --json sensors.json`.", (("sensors", ""),)),
    (
        "update",
        "`rotorgear update MODEL --rig FILE --json update.json`. [Updating by a rig](rig.md) says what the numbers mean.",
        (("update", ""),),
    ),
    (
        "mesh",
        "`rotorgear mesh MODEL --mesh NAME --json mesh.json`. Stiffness and transmission error are transverse, of all helices\n"
        "together where `helix[]` doesn't stand before them. What a stiffness model doesn't know is `null`, and `helix[]` is\n"
        "empty without loaded contact.",
        (("mesh", ""),),
    ),
    (
        "mesh map",
        "`rotorgear mesh-map MODEL --over torque=... --json map.json`. Lists of lists are by torque and misalignment.",
        (("mesh_map", ""),),
    ),
    (
        "mesh optimum",
        "`rotorgear optimise-flanks MODEL --variables ... --json best.json`. Lists of lists are by torque and misalignment.",
        (("mesh_optimum", ""),),
    ),
    (
        "root stress",
        "`rotorgear root-stress MODEL --json roots.json`.",
        (("root_stress", ""),),
    ),
    (
        "mesh accuracy",
        "`rotorgear accuracy MODEL --analysis mesh --json study.json`, of one helix.",
        (("mesh_convergence", ""),),
    ),
    (
        "campbell",
        "`rotorgear campbell MODEL --json campbell.json`. Lists of lists are by branch and speed; `null` where a branch\n"
        "does not oscillate or is out of reach.",
        (("campbell", ""),),
    ),
    (
        "critical",
        "`rotorgear critical MODEL --map --json critical.json`. Lists are by critical speed, ascending; `map` is there with\n"
        "`--map` only.",
        (("critical", ""), ("critical_map", "map.")),
    ),
    (
        "standards",
        "`rotorgear standards MODEL --json standards.json`. [Rules of standards](report.md#rules-of-standards) says what is "
        "compared.",
        (("standards", ""),),
    ),
    (
        "static",
        "`rotorgear static MODEL --json static.json`. Lists over the contacts of a mesh have two entries for a herringbone gear\n"
        "with two nodes, first the helix at the smaller z. Vectors are x, y, z.",
        (("static", ""),),
    ),
    (
        "response",
        "`rotorgear response MODEL --json response.json`. All amplitudes are half of peak to peak. Lists of lists are by\n"
        "order and speed; `MESH[]` by contact, order and speed.",
        (("response", ""),),
    ),
    (
        "frf",
        "`rotorgear frf MODEL --inputs A --outputs B --fmax 1000 --json frf.json`. Receptances are lists by response, force and\n"
        "frequency.",
        (("frf", ""),),
    ),
    (
        "check",
        "`rotorgear check MODEL --json check.json`. What a lumped gear doesn't know is `null`, and so is what needs a\n"
        "speed where none is given.",
        (("check", ""),),
    ),
    (
        "transient",
        "`rotorgear transient MODEL --json transient.json`. `spectrum` with `--spectrum`, `rig` with `--rig`. Histories are\n"
        "in the HDF5 file of `--save`.",
        (("transient", ""), ("spectral_lines", "spectrum."), ("rig_spectrum", "rig.")),
    ),
    (
        "sweep",
        "`rotorgear sweep MODEL --over ADDRESS=VALUES --json sweep.json`. What failed or makes no sense is `null`. Sections and\n"
        "trajectories are in the HDF5 file of `--save`.",
        (("sweep", ""),),
    ),
    (
        "orbits",
        "`rotorgear orbits MODEL --over ADDRESS=FROM:TO --json orbits.json`. Lists over points follow branches; coefficients\n"
        "of all harmonics are in the HDF5 file of `--save`.",
        (("orbits", ""),),
    ),
    (
        "scatter",
        "`rotorgear scatter MODEL --free ADDRESS --json scatter.json`. The samples themselves are in the HDF5 file of `--save`.",
        (("scatter", ""),),
    ),
    (
        "optimise",
        "`rotorgear optimise MODEL --free ADDRESS --json optimise.json`. [Layout](report.md#layout) says what is done.",
        (("optimise", ""),),
    ),
    (
        "sweep accuracy",
        "`rotorgear accuracy MODEL --analysis sweep --json accuracy.json`.",
        (("sweep_convergence", ""),),
    ),
    (
        "gear",
        "`rotorgear gear MODEL --json gear.json`. The [page on gears](mesh.md#the-gear-sheet) says what the numbers mean.",
        (("gear", ""),),
    ),
    (
        "bearing",
        "`rotorgear bearing MODEL NAME --json bearing.json`. The [page on bearings](bearings.md) says how the numbers are found.",
        (("bearing", ""),),
    ),
    (
        "casing",
        "`rotorgear casing MODEL --json casing.json`. The [page on casings](casings.md) says how the numbers are found.",
        (("casing", ""),),
    ),
    (
        "export",
        "`rotorgear export MODEL --state-space FILE ... --json system.json`. The matrices are in the file.",
        (("state_space", ""),),
    ),
    (
        "import",
        "`rotorgear import FILE -o gearbox.toml --json import.json`. The [page on REXS](rexs.md) says what is assumed when.",
        (("import", ""),),
    ),
    (
        "accuracy",
        "`rotorgear accuracy MODEL --json accuracy.json`. What is infinite or makes no sense is `null`.",
        (("convergence", ""),),
    ),
    (
        "tooth field",
        "`rotorgear mesh MODEL --vtk FOLDER` writes the stresses of the teeth for ParaView; `to_dict()` holds the largest\n"
        "and the contact pressure.",
        (("tooth_field", ""),),
    ),
)


# The command whose section an output stands in, where that is not the first word of its heading.
_COMMANDS = {
    "mesh map": "mesh-map",
    "mesh optimum": "optimise-flanks",
    "root stress": "root-stress",
    "mesh accuracy": "accuracy",
    "sweep accuracy": "accuracy",
    "tooth field": "mesh",
}


def outputs_of(command: str) -> Iterator[str]:
    """Yield a section of Markdown for each output of a command: its keys with units and meanings."""
    for heading, words, parts in SECTIONS:
        if _COMMANDS.get(heading, heading.split()[0]) == command:
            rows = "".join(row(*key) for kind, prefix in parts for key in keys_of(kinds()[kind], prefix))
            yield f"### JSON of {heading}\n\n{words}\n\n| key | unit | value |\n|---|---|---|\n{rows}"


def common_keys() -> str:
    """A table of the keys of every result."""
    rows = "".join(row(*key) for key in keys_of(ModelResult) if key[0] != "analysis")
    return f"| key | unit | value |\n|---|---|---|\n{rows}"


def row(path: str, unit: str, text: str) -> str:
    """A line of the table; a vertical bar would end the cell."""
    cell = text.replace("|", "\\|")
    return f"| `{path}` | {unit} | {cell} |\n"
