"""A quantity of a result is declared in one place: help, docstring, the page of JSON keys, tables and pictures follow from it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

from tests.paths import MODELS, ROOT

ASKED = """
import rotorgear as rg
from rotorgear.cli.verb import told_by
from rotorgear.results.kinds import keys_of

found = rg.modal(rg.load("jeffcott.toml"), modes=4, speed=100.0, elements=1)
print(told_by("modal"), rg.ModalResult.__doc__, list(keys_of(rg.ModalResult)), found._repr_html_(), sep="\\nPLACE\\n")
"""


def test_a_label_that_is_changed_in_its_declaration_is_another_in_help_docstring_keys_and_tables(
    tmp_path: Path,
) -> None:
    shutil.copytree(ROOT / "rotorgear", tmp_path / "rotorgear", ignore=shutil.ignore_patterns("__pycache__"))
    shutil.copy(MODELS / "jeffcott.toml", tmp_path)
    declaration = tmp_path / "rotorgear" / "results" / "modal.py"
    text = declaration.read_text(encoding="utf-8")
    assert text.count('"damping ratio"') == 1
    declaration.write_text(text.replace('"damping ratio"', '"share of critical damping"'), encoding="utf-8")
    run = [sys.executable, "-c", ASKED]
    environment = {**os.environ, "PYTHONPATH": str(tmp_path)}
    said = subprocess.run(
        run, cwd=tmp_path, env=environment, capture_output=True, text=True, encoding="utf-8", check=True
    )
    places = said.stdout.split("\nPLACE\n")
    assert len(places) == 4
    for place in places:
        assert "share of critical damping" in place
        assert "damping ratio" not in place
