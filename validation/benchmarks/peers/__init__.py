"""The same rotors in other programs: frequencies side by side, and run times from one run on one thread."""

import os

# Here, so that it comes before numpy is loaded: the linear algebra of all programs runs on one thread.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_variable] = "1"
