"""The version of the package; pyproject.toml and rotorgear/__init__.py take it from here."""

VERSION = "0.3.0"
