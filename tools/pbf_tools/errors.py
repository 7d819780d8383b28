"""The errors of this package; each carries the exit code that `pbf` gives the same kind."""

from __future__ import annotations

import difflib
import re
import sys
from collections.abc import Iterable
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


class UnknownName(BadInput, KeyError):
    """A column, field, gauge, obstacle, command or scene of a table that is not there; the message
    has the nearest names and all there are."""

    __str__ = Exception.__str__  # that of KeyError adds quotes


class NotThere(FileError):
    """A run, a batch or a scene whose file is not there; the message has what is beside it."""


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


def note(text: str) -> None:
    """What a command tells beside its result."""
    print(f"pbf_tools: note: {text}", file=sys.stderr)


def unknown(what: str, name: str, names: Iterable[str]) -> str:
    """What to say of a name that is not among those there are: the nearest ones, and all.

    >>> unknown("column", "force_x", ["time", "load/post/force_x"])
    'no column force_x, did you mean load/post/force_x? There are time, load/post/force_x'
    >>> unknown("gauge", "V", ["H", "P"]), unknown("field", "x", [])
    ('no gauge V; there are H, P', 'no field x; there is none')
    """
    names = list(names)
    near = nearest(name, names)
    everything = ", ".join(names)
    if near:
        return f"no {what} {name}, did you mean {' or '.join(near)}? There are {everything}"
    return f"no {what} {name}; there {'are ' + everything if names else 'is none'}"


def nearest(name: str, names: list[str]) -> list[str]:
    """At most three names that may be meant: with the last part of this name, else with nearly the
    same letters, else with this name in them.

    >>> names = ["time.step", "solver.iterations", "kinetic_energy"]
    >>> nearest("iterations", names), nearest("timestep", names), nearest("energy", names)
    (['solver.iterations'], ['time.step'], ['kinetic_energy'])
    """
    def last(text: str) -> str:
        return re.split(r"[./]", text.lower())[-1]

    same = [n for n in names if last(n) == last(name)]
    lower = {n.lower(): n for n in names}
    close = difflib.get_close_matches(name.lower(), lower, n=1, cutoff=0.7)
    within = [n for n in names if len(name) > 2 and name.lower() in n.lower()]
    return (same or [lower[n] for n in close] or within)[:3]
