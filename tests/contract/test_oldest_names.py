"""Names of numpy that came after its oldest version that pyproject.toml allows are not used: they fail there when they are met.

`check.py --oldest` runs the tests with those versions; this reads the sources.
"""

from __future__ import annotations

import re
import tomllib

import pytest

from tests.paths import ROOT

# Of NumPy's release notes: main namespace and numpy.linalg.
NEWER = {
    "2.0": "acos acosh asin asinh atan atan2 atanh astype bitwise_count bitwise_invert bitwise_left_shift bitwise_right_shift "
    "concat isdtype linalg.cross linalg.diagonal linalg.matmul linalg.matrix_norm linalg.matrix_transpose linalg.outer "
    "linalg.svdvals linalg.tensordot linalg.trace linalg.vecdot linalg.vector_norm matrix_transpose permute_dims pow trapezoid "
    "unique_all unique_counts unique_inverse unique_values vecdot",
    "2.1": "cumulative_prod cumulative_sum unstack",
    "2.2": "matvec vecmat",
}


def oldest_numpy() -> str:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    text = next(item for item in project["dependencies"] if item.startswith("numpy"))
    return re.match(r"numpy>=([0-9.]+)", text)[1]


def number(version: str) -> tuple[int, ...]:
    return tuple(map(int, version.split(".")))


NAMES = {name for version, names in NEWER.items() if number(version) > number(oldest_numpy()) for name in names.split()}
USED = re.compile(r"\bnp\.((?:linalg\.)?[a-z_0-9]+)")


@pytest.mark.parametrize("folder", ["rotorgear", "tests", "docs", "validation"])
def test_no_name_of_numpy_is_newer_than_its_oldest_version(folder: str) -> None:
    found = []
    for path in sorted((ROOT / folder).rglob("*.py")):
        used = set(USED.findall(path.read_text(encoding="utf-8")))
        found += [f"{path.relative_to(ROOT)}: np.{name}" for name in sorted(used & NAMES)]
    assert not found
