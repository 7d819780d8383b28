"""The errors of this package; each carries the exit code that `pbf` gives the same kind."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .run_file import Run


class ToolError(Exception):
    """Base of the errors a user can mend; the message names the file and the remedy."""

    exit_code = 1


class BadInput(ToolError):
    """A command line, table or request that cannot be met."""

    exit_code = 2


class MissingPackage(ToolError):
    """An optional package or program is not installed."""

    exit_code = 4


class FileError(ToolError):
    """A file that cannot be read or written."""

    exit_code = 5


class PbfError(ToolError):
    """The program `pbf` ended with an error: its message, its exit code (`exit_code`), and `run`,
    the Run as far as it came, or None where it has no run file."""

    def __init__(self, message: str, exit_code: int, run: Run | None = None):
        super().__init__(message)
        self.exit_code = exit_code
        self.run = run


class Diverged(PbfError):
    """The stability guard stopped the run (exit code 3); `run` holds it up to there."""


class Stopped(PbfError):
    """The run saved and stopped early (exit code 75), at `max_walltime` or by a signal;
    `resume=True` goes on."""


class PbfWarning(UserWarning):
    """A warning of the program."""
