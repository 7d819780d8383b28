"""The plot commands as functions: `plot.gauges` draws what `plot-gauges` draws.

    figure = pbf_tools.plot.gauges("out/coarse", "out/fine", gauge="H2")
    figure.savefig("levels.png")
    figure.numbers                        # a table of what the command prints

Each takes what its command takes: runs, by their paths or open, or tables; the options are keywords
with _ for -. It returns a matplotlib Figure; a notebook shows it. `help(pbf_tools.plot.gauges)`.
"""

from __future__ import annotations

import argparse
import inspect
import os
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from .__main__ import COMMANDS, Formatter, module_of
from .errors import BadInput

if TYPE_CHECKING:
    from .style import Picture

PREFIX = "plot-"


def __dir__() -> list[str]:
    return [command[len(PREFIX):] for command in COMMANDS if command.startswith(PREFIX)]


def __getattr__(name: str) -> Callable[..., Picture]:
    if name not in __dir__():
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = _function(name)
    return globals()[name]


def _function(name: str) -> Callable[..., Picture]:
    """The function of a figure. Its arguments, their defaults and its help are the command's."""
    module = module_of(PREFIX + name)
    parser = argparse.ArgumentParser(usage=argparse.SUPPRESS, description=module.__doc__,
                                     formatter_class=Formatter, add_help=False)
    module.add_arguments(parser)
    actions = {action.dest: action for action in parser._actions}
    actions.pop("out").help = argparse.SUPPRESS

    def figure(*given: Any, **options: Any) -> Picture:
        bound = signature.bind(*given, **options)
        bound.apply_defaults()
        return module.style.drawn(module.figure, argparse.Namespace(**{
            name: _value(actions[name], value) for name, value in bound.arguments.items()}))

    kinds = inspect.Parameter
    signature = inspect.Signature(sorted((kinds(a.dest, kinds.KEYWORD_ONLY, default=a.default)
                                          if a.option_strings else
                                          kinds(a.dest, kinds.VAR_POSITIONAL if a.nargs == "+" else
                                                kinds.POSITIONAL_ONLY)
                                          for a in actions.values()), key=lambda p: p.kind))
    figure.__name__ = figure.__qualname__ = name
    figure.__signature__, figure.__doc__ = signature, parser.format_help()  # type: ignore
    return figure


def _value(action: argparse.Action, value: Any) -> Any:
    """An argument as the command line would give it: a list where there may be several, paths as
    texts, and texts converted and checked."""
    if value is None:
        return None
    if action.nargs == "+" or isinstance(action, argparse._AppendAction):
        values = value if isinstance(value, list | tuple) else [value]
        if not action.option_strings:  # runs, or lists of them
            values = [v for item in values for v in (item if isinstance(item, list) else [item])]
        if action.required and not values:
            raise BadInput(f"{action.dest}: there is none; {action.help}")
        return [_one(action, v) for v in values]
    return _one(action, value)


def _one(action: argparse.Action, value: Any) -> Any:
    value = os.fspath(value) if isinstance(value, os.PathLike) else value
    try:
        value = action.type(value) if action.type and isinstance(value, str | int | float) else value
    except (argparse.ArgumentTypeError, ValueError) as problem:
        raise BadInput(f"{action.dest}: {problem}") from None
    if action.choices and value not in action.choices:
        raise BadInput(f"{action.dest}: {value!r} is not one of {', '.join(action.choices)}")
    return value
