"""`python -m tests.fuzz --files 5000`: mutants of models, options and rig lists, and what they brought to light."""

import sys

from tests.fuzz.runner import main

if __name__ == "__main__":
    sys.exit(main())
