"""Runs scenes of pbf, and reads, plots and compares its run files. Start with
`pbf_tools.open("run.vtkhdf")` or `pbf_tools.run("scene.yaml")`."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .errors import (BadInput, Diverged, FileError, MissingPackage, NotThere, PbfError, PbfWarning,
                     Stopped, ToolError, UnknownName)

if TYPE_CHECKING:
    from . import plot
    from .bodies import Body
    from .comparison import compare_data
    from .fields import Field, Frame
    from .gauges import Gauge
    from .probes import probe
    from .run_file import Run, open
    from .simulate import plan, run
    from .sweep import Batch, batch, read_batch
    from .table import Table, read_csv

__all__ = ["BadInput", "Batch", "Body", "Diverged", "Field", "FileError", "Frame", "Gauge",
           "MissingPackage", "NotThere", "PbfError", "PbfWarning", "Run", "Stopped", "Table",
           "ToolError", "UnknownName", "batch", "compare_data", "open", "plan", "plot",
           "probe", "read_batch", "read_csv", "run"]
__version__ = "0.1.0"

# Where the rest is; "" for a module. It needs numpy and h5py, and is read when it is asked for: the
# command line must come as far as a message when they are not installed.
_PLACES = {"Body": "bodies", "Field": "fields", "Frame": "fields", "Gauge": "gauges",
           "Run": "run_file", "open": "run_file", "plan": "simulate", "run": "simulate",
           "Batch": "sweep", "batch": "sweep", "read_batch": "sweep", "Table": "table",
           "read_csv": "table", "plot": "", "compare_data": "comparison",
           "probe": "probes"}


def __getattr__(name: str) -> Any:
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    place = import_module("." + (_PLACES[name] or name), __name__)
    value = getattr(place, name) if _PLACES[name] else place
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
