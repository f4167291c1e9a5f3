"""One home for the version."""

import tomllib

import rotorgear
from rotorgear.version import VERSION
from tests.paths import ROOT


def test_the_package_and_its_build_take_the_version_from_one_file() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert "version" in project["project"]["dynamic"]
    assert "version" not in project["project"]
    place = ROOT / project["tool"]["hatch"]["version"]["path"]
    assert f'VERSION = "{rotorgear.__version__}"' in place.read_text(encoding="utf-8")
    assert rotorgear.__version__ == VERSION
