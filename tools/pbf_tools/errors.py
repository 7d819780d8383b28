"""The errors of this package; each carries the exit code that `pbf` gives the same kind."""


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
