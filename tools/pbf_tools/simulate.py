"""Running scenes: `run` and `plan`, over the program."""

from __future__ import annotations

import inspect
import os
import re
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from . import program as pbf
from .errors import BadInput, FileError, NotThere, PbfError, nearest
from .run_file import Run
from .run_path import ENDINGS, RUN_FILE, beside, folder_of_run, is_run, run_path
from .scene_text import Scene, base_words, set_words, settings, text, write_scene


def plan(scene: Scene, *, base_folder: str | os.PathLike[str] | None = None,
         program: str | os.PathLike[str] | None = None, **overrides: Any) -> dict[str, Any]:
    """What `pbf plan --json` says of a scene: particles, updates, run_time_s (a rule of thumb before
    `pbf bench --calibrate`; None where nothing is known), host_bytes, device_bytes and disk_bytes,
    which are sums, then passes, memory by backend, files, warnings. Runs nothing.

        plan("configs/dam_break.yaml", fluid__spacing=0.008)["host_bytes"]

    base_folder as in `run`. PbfError with the program's message for a scene that cannot be.
    """
    return forecast_of(scene, plan, base_folder, program, overrides)


def forecast_of(scene: Scene, call: Callable, base_folder: str | os.PathLike[str] | None,
                program: str | os.PathLike[str] | None,
                overrides: Mapping[str, Any]) -> dict[str, Any]:
    """`plan` for the function `call`, which errors in arguments name."""
    found = pbf.find(program)
    with tempfile.TemporaryDirectory() as folder:
        path = os.fspath(write_scene(scene, Path(folder) / "scene.yaml")
                         if isinstance(scene, Mapping) else scene_path(scene))
        try:
            return pbf.answer(found, ["plan", path, "--json", *base_words(scene, base_folder),
                                      *set_words(overrides)])
        except PbfError as problem:
            said = of_dict(str(problem), path) if isinstance(scene, Mapping) else str(problem)
            problem.args = (in_python(said, overrides, call),)
            raise


def of_dict(message: str, path: str) -> str:
    """An error of the file that a dict was written to: the path of the key says where it is.

    >>> of_dict("/tmp/s.yaml:16:3: fluid.spacingg: unknown key", "/tmp/s.yaml")
    'scene (a dict): fluid.spacingg: unknown key'
    """
    message = re.sub(rf"{re.escape(path)}(:\d+)*: ", "scene (a dict): ", message)
    for folder in (f"the folder of {path}", "the folder of the scene file"):
        message = message.replace(folder, "the working folder")
    return message.replace(path, "the dict")


def in_python(message: str, overrides: Mapping[str, Any], call: Callable) -> str:
    """An error in an override: the program has it by --set, the caller as an argument of `call`.

    >>> in_python("--set overwrit=true: overwrit: unknown key", {"overwrit": True}, run)
    'argument overwrit: neither an argument of run nor a key of a scene, did you mean overwrite?'
    """
    for given, value in overrides.items():
        for key, part in settings({given: value}).items():
            message = message.replace(f"--set {key}={text(part, key)}: ", f"argument {given}: ")
        names = [name for name, parameter in inspect.signature(call).parameters.items()
                 if parameter.kind is not parameter.VAR_KEYWORD]
        near = nearest(given, names)
        hint = f", did you mean {near[0]}?" if near else f"; there are {', '.join(names)}"
        # Where the program knows a key with nearly this name, that is meant.
        message = re.sub(rf"^(argument {re.escape(given)}: ){re.escape(given)}: unknown key$",
                         rf"\1neither an argument of {call.__name__} nor a key of a scene{hint}",
                         message, flags=re.MULTILINE)
    return message


def run(scene: Scene, out: str | os.PathLike[str] | None = None, *, resume: bool = False,
        overwrite: bool = False, strict: bool = False, max_walltime: float | None = None,
        progress: bool | None = None, base_folder: str | os.PathLike[str] | None = None,
        program: str | os.PathLike[str] | None = None, **overrides: Any) -> Run:
    """Simulates a scene, a file, a dict of the same keys or a run to repeat (its file or folder),
    into the folder `out` and opens its run file. Without `out` that is out/NAME, with the name of
    the scene: of a file that says none its own, of a dict "scene"; of a run to go on with
    (resume=True) it is the run's own folder. A dict is written to OUT.yaml, which `pbf run` takes
    too.

    Overrides are keys of the scene, as those of --set: `solver__iterations=8`,
    `time={"end": 1}`, `**{"bodies[0].velocity": [1, 0, 0]}`; None is off. A scene without
    `output` gets `output: {}`, for a Run is read from its file.

    resume, overwrite, strict, max_walltime (s): the options of `pbf run`. progress: a line that is
    overwritten; by default in a terminal and in a notebook. base_folder: bases of the scene
    (`base: other.yaml`) may lie in the tree of this folder too, not only in that of the scene's
    own; of a dict, in the working folder's. program: see `program.find`.

    PbfError with the program's message and exit code when it fails; Diverged when the guard stopped
    it, Stopped at max_walltime, both with the Run up to there in `.run`. An interrupt (Ctrl-C)
    saves the run before KeyboardInterrupt is raised, and `resume=True` goes on. Warnings of the
    program are PbfWarning.
    """
    found = pbf.find(program)
    scene = scene if isinstance(scene, Mapping) else scene_path(scene)
    if isinstance(scene, Path) and scene.suffix in ENDINGS:
        out = folder_of_run(scene) if out is None and resume else out
        if out is None:
            raise BadInput(f"{scene}: give out=, the folder in which this run is repeated")
        forecast = None  # a run file holds a scene that has been planned, with output
    else:
        forecast = forecast_of(scene, run, base_folder, found, overrides)
    folder = Path(out) if out is not None else Path("out") / forecast["scene"]
    bases = base_words(scene, base_folder)
    if folder.exists() and not (resume or overwrite):  # before the scene of a dict is replaced
        raise BadInput(f"{folder}: the output folder exists; overwrite=True replaces the run in "
                       "it, resume=True goes on with it, or give another out")
    if isinstance(scene, Mapping):
        scene = write_scene(scene, folder.with_name(folder.name + ".yaml"))
    words = ["run", os.fspath(scene), "--out", str(folder), *bases, *set_words(overrides)]
    if forecast and not writes_a_run_file(forecast):
        words += ["--set", "output={}"]
    words += [word for word, given in (("--resume", resume), ("--overwrite", overwrite),
                                       ("--strict", strict)) if given]
    if max_walltime is not None:
        words += ["--max-walltime", str(max_walltime)]
    before = _stamp(folder / RUN_FILE)
    code, message = pbf.call(found, words, progress)
    if code == 0:
        return Run(folder / RUN_FILE)
    # A file that has not changed is another run's: this one did not begin.
    begun = _stamp(folder / RUN_FILE) != before
    raise pbf.error(code, in_python(message, overrides, run), opened(folder) if begun else None)


def writes_a_run_file(forecast: dict[str, Any]) -> bool:
    """Whether the scene of a plan asks for output."""
    return any(file["name"] == RUN_FILE for file in forecast["files"])


def opened(folder: Path) -> Run | None:
    """The run of a folder; None where it has no run file that can be read."""
    try:
        return Run(folder / RUN_FILE)
    except FileError:
        return None


def scene_path(scene: Any) -> Path:
    """Of a scene that is no dict."""
    if isinstance(scene, str | os.PathLike):
        path = run_path(scene)
        if not path.exists():
            raise NotThere(f"{path}: no such {'run' if is_run(path) else 'scene'}{beside(path)}")
        return path
    several = "; batch takes several" if isinstance(scene, list | tuple) else ""
    raise BadInput(f"expected a scene: a path or a dict, got {scene!r}{several}")


def _stamp(path: Path) -> tuple[int, int] | None:
    return (path.stat().st_ino, path.stat().st_mtime_ns) if path.exists() else None
