"""The command line: python -m pbf_tools COMMAND ..."""

from __future__ import annotations

import argparse
import functools
import importlib
import os
import sys
from types import ModuleType

from .errors import BadInput, MissingPackage, ToolError, UnknownName, unknown
from .run_path import RUN_FILE

# Command -> what it does; the module has the same name with _ for -.
COMMANDS = {
    "plot-log": "any columns of the log over time: loads, compression, front",
    "plot-energy": "energies of runs over time",
    "plot-gauges": "readings of gauges over time against experiments",
    "plot-front": "front of a dam break against experiments",
    "plot-batch": "the summary of a batch: error against run time, or any two columns",
    "plot-study": "error against run time of a study, with the Pareto front",
    "plot-map": "which settings run stably, which degrade, which are stopped",
    "plot-stages": "share of every stage in the time of an update, stacked",
    "plot-speedup": "speed-up of one backend over another against the number of particles",
    "plot-time": "time per particle and update against the number of particles",
    "video": "film from the pictures of a run",
    "plot-compare": "the report of pbf compare: diagrams and tables",
    "waves": "incident and reflected waves at gauges: heights, lengths, spectra",
    "compare": "differences of two runs",
    "to-csv": "frames, the log, gauges, loads or a track as CSV; frames as extended XYZ",
    "to-npz": "runs as NumPy files: positions, ids, types, times",
    "to-usd": "a run as USD points, for Blender and Houdini",
    "to-lagrangebench": "a data set for learning in the layout of LagrangeBench",
    "surface": "surface of the fluid as triangles",
    "make-scene": "scene from a shape, a picture or a mesh; random ones for learning",
}


class Formatter(argparse.RawDescriptionHelpFormatter):
    """Keeps the lines of examples."""


NEEDED = ("numpy", "h5py", "matplotlib")  # tools/pyproject.toml


def module_of(command: str) -> ModuleType:
    """The module of a command; MissingPackage with the remedy where it needs one that is missing."""
    try:
        return importlib.import_module("." + command.replace("-", "_"), __package__)
    except ImportError as problem:
        for name in NEEDED:
            try:
                importlib.import_module(name)
            except ImportError as reason:
                first = (str(reason).strip() or "ImportError").splitlines()[0]
                raise MissingPackage(f"{command} needs {name}, which {sys.executable} cannot "
                                     f"import ({first}): pip install {name}") from problem
        raise


def parser(command: str | None = None) -> argparse.ArgumentParser:
    """The whole command line, with the arguments of the chosen command and its `run`."""
    top = argparse.ArgumentParser(
        prog="pbf_tools", formatter_class=Formatter,
        description="Plots, compares and converts what pbf writes.",
        epilog="Exit codes: 0 done, 1 internal error, 2 bad command line or table, 4 package not\n"
               "installed, 5 file cannot be read or written, 6 difference found (compare).\n\n"
               "Example: python -m pbf_tools plot-energy out/demo -o energy.png")
    commands = top.add_subparsers(metavar="COMMAND", required=True)
    for name, summary in COMMANDS.items():
        if name != command:
            commands.add_parser(name, help=summary)
            continue
        module = module_of(name)
        sub = commands.add_parser(name, help=summary, description=module.__doc__,
                                  epilog=module.EXAMPLE, formatter_class=Formatter)
        module.add_arguments(sub)
        sub.set_defaults(run=module.run if hasattr(module, "run") else
                         functools.partial(module.style.command, module.figure))
    return top


def refuse_inputs(args: argparse.Namespace) -> None:
    """BadInput when a file to write is one that the command reads, by whatever name."""
    given = {name: value for name, value in vars(args).items() if isinstance(value, (str, list))}
    outputs = [given.pop(name) for name in ("out", "csv") if isinstance(given.get(name), str)]
    values = [v for value in given.values() for v in (value if isinstance(value, list) else [value])]
    inputs = [v for v in values if isinstance(v, str) and os.path.isfile(v)]
    inputs += [os.path.join(v, RUN_FILE) for v in values if isinstance(v, str)
               and os.path.isfile(os.path.join(v, RUN_FILE))]
    for out in outputs:
        for path in inputs:
            if os.path.isfile(out) and os.path.samefile(out, path):
                raise BadInput(f"{out}: is the same file as {path}, which this command reads and "
                               "would overwrite; give another name")


def main(arguments: list[str] | None = None) -> int:
    """Runs one command; an error a user can mend is one line on stderr and its exit code."""
    words = sys.argv[1:] if arguments is None else arguments
    try:
        if words and not words[0].startswith("-") and words[0] not in COMMANDS:
            raise UnknownName(unknown("command", words[0], COMMANDS))
        args = parser(words[0] if words else None).parse_args(words)
        refuse_inputs(args)
        code = args.run(args) or 0
        sys.stdout.flush()
        return code
    except ToolError as error:
        print(f"pbf_tools: error: {error}", file=sys.stderr)
        return error.exit_code
    except BrokenPipeError:  # `pbf_tools ... | head`: nobody reads on, which is no error
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


if __name__ == "__main__":
    sys.exit(main())
