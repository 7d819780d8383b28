"""Runs scenes of pbf, and reads, plots and compares its run files. Start with
`pbf_tools.open("run.vtkhdf")` or `pbf_tools.run("scene.yaml")`."""

from .errors import (BadInput, Diverged, FileError, MissingPackage, PbfError, PbfWarning, Stopped,
                     ToolError)
from .fields import Field, Frame
from .run_file import Gauge, Run, open
from .simulate import plan, run
from .sweep import Batch, batch, read_batch
from .table import Table, read_csv

__all__ = ["BadInput", "Batch", "Diverged", "Field", "FileError", "Frame", "Gauge",
           "MissingPackage", "PbfError", "PbfWarning", "Run", "Stopped", "Table", "ToolError",
           "batch", "open", "plan", "read_batch", "read_csv", "run"]
__version__ = "0.1.0"
