"""Reads, plots and compares the run files of pbf. Start with `pbf_tools.open("run.vtkhdf")`."""

from .errors import BadInput, FileError, MissingPackage, ToolError
from .fields import Field, Frame
from .run_file import Gauge, Run, open
from .table import Table, read_csv

__all__ = ["BadInput", "Field", "FileError", "Frame", "Gauge", "MissingPackage", "Run", "Table",
           "ToolError", "open", "read_csv"]
__version__ = "0.1.0"
