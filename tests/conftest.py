"""What tests compute for later runs, compliances of teeth and reduced bodies, is kept for this run only, shared by its workers.

Compiled loops are kept between runs, where a user's are: to compile them takes a minute or more, and their folder is named by a
hash of all sources that they come from (tests/contract/test_fresh_code.py holds it to that).
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest

# numba reads it when it is imported, which no test module does before this file.
os.environ.setdefault("NUMBA_CACHE_DIR", str(Path.home() / ".cache" / "rotorgear"))
# Commands that tests start, and the workers, take the bytecode that the first of them has written, as users' do.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)


@pytest.fixture(scope="session", autouse=True)
def cache_of_this_run(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    before = os.environ.get("ROTORGEAR_CACHE")
    own = tmp_path_factory.getbasetemp()
    # The folder of a worker lies in that of the run.
    folder = (own.parent if "PYTEST_XDIST_WORKER" in os.environ else own) / "cache"
    folder.mkdir(exist_ok=True)
    os.environ["ROTORGEAR_CACHE"] = str(folder)
    yield
    if before is None:
        del os.environ["ROTORGEAR_CACHE"]
    else:
        os.environ["ROTORGEAR_CACHE"] = before
