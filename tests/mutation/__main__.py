"""`python -m tests.mutation`: does a test fail on each fault of the list in mutations.toml?"""

import sys

from tests.mutation.runner import main

sys.exit(main())
