"""`python -m clutchwork` is the command line."""

import sys

from clutchwork.command.main import main

sys.exit(main())
