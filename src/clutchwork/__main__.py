"""`python -m clutchwork` is the command line."""

import sys

from clutchwork.cli import main

sys.exit(main())
