"""Share of every stage in the time of an update, stacked, a bar per number of particles.

A row of panels per scene, a column per backend. Above each bar stands the time of one update.
Takes tables of pbf bench, or runs: then each has a bar, with the shares of its whole log.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterable

import numpy as np

from . import bench, style
from .errors import BadInput, note
from .logs import RUN_HELP, labels, read_run
from .run_path import is_run
from .table import Table

EXAMPLE = """examples:
  python -m pbf_tools plot-stages tests/regression/bench/reference_speedup_nvidia_h200.csv -o stages.png
  python -m pbf_tools plot-stages out/demo --grouped
  python -m pbf_tools plot-stages out/float out/double -o stages.png"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    bench.add_arguments(parser, "RUN|CSV", f", or runs: each a {RUN_HELP}")
    parser.add_argument("--setup", action="append", metavar="SETUP",
                        help="panels: backend[:threads][:precision] (repeatable; default: all)")
    parser.add_argument("--grouped", action="store_true",
                        help="fold the stages into the seven groups of the summary of pbf run")
    style.add_output(parser, "stages.png")


def stage_columns(rows: Table) -> dict[str, np.ndarray]:
    """The columns of stages by their names, without stages that the scenes do not have."""
    return {name[3:]: column for name, column in rows.columns.items()
            if name.startswith("ms_") and name not in bench.COLUMNS
            and column.dtype.kind == "f" and not np.all(np.isnan(column))}


def stage_times(rows: Table, n: float) -> tuple[dict[str, float], float]:
    """Milliseconds per update of each stage at n particles, and of the update; `other` is what no
    stage of style.STAGES booked."""
    here = rows.where(rows["n_particles"] == n)
    total = float(np.median(here[bench.TIME]))
    stages = {name: float(np.nanmedian(column)) for name, column in stage_columns(here).items()}
    if not stages:
        raise BadInput(f"no times of stages at {n:g} particles")
    rest = total - sum(stages.values())
    if rest > 1e-3 * total:
        stages["other"] = stages.get("other", 0) + rest
    return with_other(stages), total


def tell_unknown(path: str, names: Iterable[str]) -> None:
    """A note of the stages of another version, which `with_other` folds."""
    unknown = sorted(name for name in names if name not in style.STAGES)
    if unknown:
        note(f"{path}: this pbf_tools does not know the stages {', '.join(unknown)}; they are "
             "drawn as other")


def with_other(stages: dict[str, float]) -> dict[str, float]:
    out: dict[str, float] = {}
    for name, time in stages.items():
        name = name if name in style.STAGES else "other"
        out[name] = out.get(name, 0) + time
    return out


def grouped(stages: dict[str, float]) -> dict[str, float]:
    """The stages folded into groups.

    >>> grouped({"grid": 1.0, "neighbors": 2.0, "lambda": 3.0, "other": 0.5})
    {'grid/neighbors': 3.0, 'lambdas': 3.0, 'other': 0.5}
    """
    out = {}
    for name, members in style.GROUPS.items():
        there = [stages[m] for m in members if m in stages]
        if there:
            out[name] = sum(there)
    if "other" in stages:
        out["other"] = stages["other"]
    return out


def draw(axes, labels: list[str], columns: list[tuple[dict[str, float], float]], unit: str,
         fold: bool) -> dict[str, object]:
    """Stacked bars of percent; gives back one handle per name for the legend."""
    parts = [(grouped(s) if fold else s, total) for s, total in columns]
    colors = {**style.GROUP_COLORS, "other": style.STAGES["other"]} if fold else style.STAGES
    at, bottom, handles = np.arange(len(parts)), np.zeros(len(parts)), {}
    for name, color in colors.items():
        if not any(name in p for p, _ in parts):
            continue
        share = np.array([100 * p.get(name, 0) / sum(p.values()) for p, _ in parts])
        handles[name] = axes.bar(at, share, bottom=bottom, width=0.86, color=color,
                                 edgecolor="white", linewidth=0.5)
        bottom += share
    for x, (_, total) in zip(at, parts):
        axes.text(x, 101, f"{total:.3g}", ha="center", va="bottom", fontsize=7)
    axes.text(-0.5, 108, f"time per update ({unit}):" if unit == "ms" else f"total ({unit}):",
              fontsize=7, va="bottom")
    axes.set(xticks=at, ylim=(0, 100), xlim=(-0.6, len(parts) - 0.4))
    axes.set_xticklabels(labels)
    axes.grid(False)
    return handles


def figure(args: argparse.Namespace) -> style.Picture:
    if any(map(is_run, args.csv)):
        return _runs(args)
    table = bench.read_bench(args.csv, args.state)
    tell_unknown(", ".join(args.csv), stage_columns(table))
    scenes = bench.pick_scenes(table, args.scene)
    setups = [bench.Setup.parse(text) for text in args.setup] if args.setup else _setups(table)
    rows = [[s.rows(table).where(s.rows(table)["scene"] == scene) for s in setups]
            for scene in scenes]
    fig, panels = style.figure(len(scenes), len(setups), sharey=True,
                               size=(1.5 + 3.9 * len(setups), 0.9 + 2.6 * len(scenes)))
    handles: dict[str, object] = {}
    for i, scene in enumerate(scenes):
        for j, setup in enumerate(setups):
            axes, here = panels[i, j], rows[i][j]
            if not len(here):
                raise BadInput(f"no rows for {setup} with scene {scene}")
            sizes = np.unique(here["n_particles"])
            handles |= draw(axes, [style.count_text(n) for n in sizes],
                            [stage_times(here, n) for n in sizes], "ms", args.grouped)
            axes.set_title(f"{scene}: {setup}\n{here['device'][0]}", fontsize=9, pad=24)
            if i == len(scenes) - 1:
                axes.set_xlabel("particles")
            if j == 0:
                axes.set_ylabel("share of an update (%)")
    return _finish(fig, panels[0, -1], handles, args, "Time per stage")


def _setups(table: Table) -> list[bench.Setup]:
    keys = dict.fromkeys(zip(table["backend"].tolist(), table["threads"].tolist(),
                             table["precision"].tolist()))
    return [bench.Setup(b, int(t) if b == "cpu" else None, p) for b, t, p in keys]


def _runs(args: argparse.Namespace) -> style.Picture:
    if not all(map(is_run, args.csv)):
        raise BadInput("give runs, or tables of pbf bench, not both")
    runs, parts = [read_run(path) for path in args.csv], []
    for path, run_file in zip(args.csv, runs):
        stages = {name[6:]: float(np.sum(v)) for name, v in run_file.log.items()
                  if name.startswith("stage/")}
        if not stages or not sum(stages.values()):
            raise BadInput(f"{path}: the log has no times of stages yet")
        tell_unknown(path, stages)
        parts.append((with_other(stages), sum(stages.values())))
    names = labels(args.csv, [run_file.name for run_file in runs])
    below = [f"{name}\n{run_file.info['particles']} particles"
             for name, run_file in zip(names, runs)]
    fig, ((axes,),) = style.figure(size=(3.8 + 1.4 * len(runs), 4.2))
    handles = draw(axes, below, parts, "s", args.grouped)
    axes.set_ylabel("share of the time of all stages (%)")
    titles = dict.fromkeys(run_file.title for run_file in runs)
    return _finish(fig, axes, handles, args,
                   "Time per stage" + (f"\n{next(iter(titles))}" if len(titles) == 1 else ""))


def _finish(fig: style.Picture, axes, handles: dict[str, object], args: argparse.Namespace,
            text: str) -> style.Picture:
    names = {"lambda": "lambda (with density)"} if "density" not in handles else {}
    order = list(reversed(handles))  # as they are stacked
    style.side_legend(axes, [handles[n] for n in order], [names.get(n, n) for n in order])
    style.figure_title(fig, args.title or text)
    return fig
