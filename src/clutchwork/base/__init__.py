"""Errors that name the remedy, values as messages quote them, safe writing of files.

Other rooms import what all use from here.
"""

from clutchwork.base.classes import dataclass as dataclass
from clutchwork.base.errors import ClutchworkError as ClutchworkError
from clutchwork.base.errors import FileError as FileError
from clutchwork.base.errors import FMUError as FMUError
from clutchwork.base.errors import ModelError as ModelError
from clutchwork.base.errors import ModelWarning as ModelWarning
from clutchwork.base.errors import OptionError as OptionError
from clutchwork.base.errors import Problem as Problem
from clutchwork.base.errors import UnknownName as UnknownName
from clutchwork.base.errors import UseError as UseError
from clutchwork.base.errors import advised as advised
from clutchwork.base.errors import caller as caller
from clutchwork.base.errors import near as near
from clutchwork.base.plural import columns as columns
from clutchwork.base.plural import counted as counted
from clutchwork.base.quote import listed as listed
from clutchwork.base.quote import quote as quote
