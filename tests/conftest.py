"""Compliances of teeth that tests compute are kept for the run only, in a folder of their own."""

from __future__ import annotations

import os
from collections.abc import Iterator

import pytest


@pytest.fixture(scope="session", autouse=True)
def tooth_cache(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    before = os.environ.get("ROTORGEAR_CACHE")
    os.environ["ROTORGEAR_CACHE"] = str(tmp_path_factory.mktemp("teeth"))
    yield
    if before is None:
        del os.environ["ROTORGEAR_CACHE"]
    else:
        os.environ["ROTORGEAR_CACHE"] = before
