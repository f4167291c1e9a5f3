"""Former names of options and values: still read for one version, with a warning that says the new one.

The tables stand beside what they name: `model/parts/old_names.py` for values in the model file, `cli/old_options.py` for options.
"""

from __future__ import annotations

import warnings


class OldNameWarning(FutureWarning):
    """A name was used that the next version no longer reads; the text says the new one."""


def warn_old(what: str, old: str, new: str, stacklevel: int = 3) -> None:
    """Warn that `old` is now called `new`; `what` says what it names, such as "argument of sweep"."""
    warnings.warn(
        f"{what} '{old}' is now '{new}'; the old name is read for the last time in this version",
        OldNameWarning,
        stacklevel=stacklevel,
    )
