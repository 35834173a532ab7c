"""`python -m mpm_taichi`."""

import sys

from .cli import main

sys.exit(main())
