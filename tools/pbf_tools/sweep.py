"""Many runs: `batch`, over `pbf batch`."""

from __future__ import annotations

import os
import re
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from . import program as pbf
from .errors import BadInput, NotThere, PbfWarning
from .run_file import Run
from .run_path import RECORD, RUN_FILE
from .scene_text import Scene, base_words, set_words, text, write_scene
from .simulate import forecast_of, in_python, opened, scene_path, writes_a_run_file
from .table import Table, read_csv, write_text

OUTPUT = ("--set", "output={}")
SUMMARY = "summary.csv"
# Also where they look like numbers.
TEXTS = ("name", "scene", "settings", "reason", "message")


class Batch(Table):
    """The summary of a batch: a row per run with its settings, why it ended and its last measures.

    `runs` are the runs of the rows, None for one without a run file.
    """

    def __init__(self, columns: Mapping[str, Any] | None = None,
                 units: Mapping[str, str] | None = None, out: str | os.PathLike[str] = ""):
        super().__init__(columns, units)
        self.out = Path(out)

    def __reduce__(self) -> tuple:
        return type(self), (self.columns, self.units, self.out)

    @property
    def runs(self) -> list[Run | None]:
        return [opened(self.out / name) for name in self["name"].tolist()]


def read_batch(out: str | os.PathLike[str]) -> Batch:
    """The summary of a batch that `pbf batch` has run, by its folder or by its summary.csv.

        table = read_batch("out/sweep")
        table["seconds"], table.runs[0].log
    """
    path = Path(out)
    if not path.exists():
        raise NotThere(f"{path}: no such batch; name the folder that `pbf batch --out` wrote")
    if path.is_dir():
        path = path / SUMMARY
        if not path.is_file():
            raise NotThere(f"{out}: no {SUMMARY} in this folder; name the folder that `pbf batch "
                            "--out` wrote (with --collect it writes the summary of what is there)")
    summary = read_csv(path, TEXTS)
    return Batch(summary.columns, summary.units, path.parent)


def batch(scenes: Scene | Sequence[Scene], grid: Mapping[str, Sequence[Any]] | None = None,
          out: str | os.PathLike[str] | None = None, *, jobs: int = 1, threads: int | None = None,
          strict: bool = False, max_walltime: float | None = None, progress: bool | None = None,
          base_folder: str | os.PathLike[str] | None = None,
          program: str | os.PathLike[str] | None = None, **overrides: Any) -> Batch:
    """Runs scenes (a file or a dict, several of them, a folder, or a list as `pbf batch` takes it)
    with every combination of the values of `grid`, `jobs` at a time, each in a folder of `out`.

        batch("dam.yaml", {"solver.iterations": [2, 4, 8]}, "out/sweep", output={"every": 0.1})

    Overrides and base_folder as in `run`, for all of them; scenes without `output` get
    `output: {}`, those of a folder or of a list file excepted. Given again, it leaves alone what is
    finished and goes on with what was stopped. Dicts are written to OUT.scenes/, or to OUT.yaml
    when there is one.

    Runs that failed are rows of the summary too, with `exit_code`, `reason` and `message`, and
    give a PbfWarning. PbfError where there is no summary, as for a scene or a grid that cannot be.
    An interrupt saves every run before KeyboardInterrupt is raised.
    """
    found = pbf.find(program)
    folder = Path(out) if out is not None else Path("out") / f"batch_{_stem(scenes)}"
    words = ["batch", *_input(scenes, folder, found, base_folder, overrides), "--out", str(folder),
             "--jobs", str(jobs), *base_words(scenes, base_folder), *set_words(overrides)]
    for key, values in (grid or {}).items():
        name = key.replace("__", ".")
        if isinstance(values, str | bytes | Mapping) or not hasattr(values, "__iter__"):
            raise BadInput(f"grid: {name}: expected a list of values, got {values!r}")
        listed = [text(value, name) for value in values]
        if not listed:
            raise BadInput(f"grid: {name}: the list of values is empty")
        words += ["--grid", f"{name}=" + ",".join(listed)]
    if threads is not None:
        words += ["--threads", str(threads)]
    if strict:
        words.append("--strict")
    if max_walltime is not None:
        words += ["--max-walltime", str(max_walltime)]
    code, message = pbf.call(found, words, progress)
    if message or code not in (0, 6, pbf.RESUMABLE):
        raise pbf.error(code, in_python(message, overrides, batch))
    table = read_batch(folder)
    bad = table.where(table["reason"] != "finished")
    if len(bad):
        first = ": ".join(str(bad[c][0]) for c in ("name", "reason", "message") if bad[c][0])
        warnings.warn(f"{len(bad)} of {len(table)} runs are not finished; the first: {first}",
                      PbfWarning, stacklevel=2)
    return table


def _stem(scenes: Any) -> str:
    """Of the default name of the folder, as `pbf batch` gives it."""
    if isinstance(scenes, Mapping):
        return str(scenes.get("name") or "scene")
    if not isinstance(scenes, str | os.PathLike):
        return "scenes"
    path = Path(scenes).resolve()
    if path.name in (RUN_FILE, RECORD):  # every run has these
        path = path.parent
    return path.name if path.is_dir() else path.stem


def _input(scenes: Any, folder: Path, program: str, base_folder: Any,
           overrides: Mapping[str, Any]) -> list[str]:
    """What `pbf batch` reads: the path as given, the file of a dict, or a list of several; and
    output for scenes without."""
    def lacks_output(scene: Scene) -> bool:
        return not writes_a_run_file(forecast_of(scene, batch, base_folder, program, overrides))

    if isinstance(scenes, str | os.PathLike):
        one = Path(scenes).suffix in (".yaml", ".yml") and not Path(scenes).is_dir()
        return [os.fspath(scenes), *(OUTPUT if one and lacks_output(scenes) else ())]
    if isinstance(scenes, Mapping):
        words = OUTPUT if lacks_output(scenes) else ()
        return [str(write_scene(scenes, folder.with_name(folder.name + ".yaml"))), *words]
    if not isinstance(scenes, Sequence) or not scenes:
        raise BadInput("batch: expected a scene (a path or a dict), or a list of some")
    beside = folder.with_name(folder.name + ".scenes")
    paths, names = [], set()
    for k, scene in enumerate(scenes):
        if isinstance(scene, Mapping):
            name = re.sub(r"[^\w.-]", "_", str(scene.get("name") or f"scene_{k}"))
            name = name if name not in names else f"{name}_{k}"
            names.add(name)
            path = write_scene(scene, beside / f"{name}.yaml").absolute()
        else:
            path = scene_path(scene).absolute()
        if re.search(r"[\s#]", str(path)):
            raise BadInput(f"{path}: a list of scenes cannot hold a path with blanks or #; rename "
                           "it, or give another out")
        paths.append(path)
    lacking = [lacks_output(scene) for scene in scenes]
    lines = [f"{path}{' output={}' if lacks and not all(lacking) else ''}\n"
             for path, lacks in zip(paths, lacking)]
    write_text(beside / "list.txt", "".join(lines), parents=True)
    return [str(beside / "list.txt"), *(OUTPUT if all(lacking) else ())]
