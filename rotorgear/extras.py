"""The optional packages: by which extra each is installed, and whether it is there, without importing it.

Commands ask before they compute: an hour of work must not end with the sentence that a picture can't be drawn.
"""

from __future__ import annotations

from importlib.util import find_spec

from rotorgear.errors import MissingExtraError

# Package -> the module that it brings, and the extra of rotorgear that installs it.
EXTRAS = {
    "matplotlib": ("matplotlib", "plots"),
    "pyvista": ("pyvista", "vtk"),
    "numba": ("numba", "transient"),
    "scikit-fem": ("skfem", "tooth"),
    "meshio": ("meshio", "casing"),
    "tomlkit": ("tomlkit", "rig"),
    "jinja2": ("jinja2", "report"),
    "nicegui": ("nicegui", "app"),
    "pandas": ("pandas", "xarray"),
    "openpyxl": ("openpyxl", "xlsx"),
    "asammdf": ("asammdf", "records"),
    "nptdms": ("nptdms", "records"),
    "soundfile": ("soundfile", "records"),
}


def require(package: str, purpose: str) -> None:
    """Refuse to go on without an optional package; `purpose` begins the sentence, such as "A plot".

    Raises:
        MissingExtraError: it is not installed.
    """
    module, extra = EXTRAS[package]
    if find_spec(module) is None:
        raise MissingExtraError(purpose, package, extra)
