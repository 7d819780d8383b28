"""Where the file of a run is: whatever reads a run takes its file or its folder."""

from __future__ import annotations

import os
from pathlib import Path

from .errors import FileError, NotThere, nearest

RUN_FILE = "run.vtkhdf"
RECORD = "scene.resolved.yaml"  # beside the run file: the scene with every default
ENDINGS = (".vtkhdf", ".h5", ".hdf5")


def is_run(path: str | os.PathLike[str]) -> bool:
    """Whether a word of a command line names a run, there or not: a folder, or the ending of one.

    >>> is_run("out/demo/run.vtkhdf"), is_run("study.csv"), is_run(".")
    (True, False, True)
    """
    return os.fspath(path).endswith(ENDINGS) or Path(path).is_dir()


def run_path(path: str | os.PathLike[str]) -> Path:
    """The run file that a path names, itself or as the folder that it is in. FileError for a folder
    without one, which says where there are some; a file need not be there.

    >>> run_path("out/demo/run.vtkhdf").as_posix()
    'out/demo/run.vtkhdf'
    """
    given = Path(path)
    if not given.is_dir():
        return given
    if os.path.lexists(given / RUN_FILE):  # a link to nothing too: opening it says what is wrong
        return given / RUN_FILE
    raise NotThere(f"{path}: {_why_not(given)}")


def beside(path: Path) -> str:
    """For a run or a scene that is not there, the end of a message: what is in its folder, and the
    nearest."""
    scene = path.suffix in (".yaml", ".yml")
    path = path.parent if path.name == RUN_FILE and not path.parent.is_dir() else path
    names = sorted({found.name for found in path.parent.glob("*.y*ml")} if scene else
                   {found.parent.name for found in path.parent.glob(f"*/{RUN_FILE}")} |
                   {found.name for found in path.parent.glob("*.vtkhdf")})
    what = "scenes" if scene else "runs"
    near = nearest(path.stem, [Path(name).stem for name in names])
    if near:
        meant = next(name for name in names if Path(name).stem == near[0])
        return f", did you mean {path.parent / meant}?"
    some = ", ".join(names[:5]) + (", ..." if len(names) > 5 else "")
    return f"; {what} in {path.parent}: {some}" if names else f"; there are no {what} in {path.parent}"


def folder_of_run(file: Path) -> Path | None:
    """The folder of a run that this is the file of; None for a file by itself, a copy say."""
    return file.parent if file.name == RUN_FILE and (file.parent / RECORD).is_file() else None


def _why_not(folder: Path) -> str:
    missing = f"no {RUN_FILE} in this folder"
    below = sorted(found.parent for found in folder.glob(f"*/{RUN_FILE}"))
    beside = sorted(folder.glob("*.vtkhdf"))
    if len(below) == 1:
        return f"{missing}, but in {below[0]}; name that"
    if below:
        batch = f"; or draw its summary.csv with plot-batch {folder}" \
            if (folder / "summary.csv").is_file() else ""
        return f"{missing}, but in {len(below)} below it ({_some(below)}); name one, or with a " \
               f"command that takes several, {folder / '*' / RUN_FILE}{batch}"
    if beside:
        return f"{missing}, but {_some(beside)}; name the file"
    if (folder / RECORD).is_file():
        return f"{missing}: this run writes no frames; give its scene `output: {{}}` and run it " \
               "again"
    return f"{missing}; name a run file, or the folder that `pbf run --out` wrote"


def _some(paths: list[Path]) -> str:
    return ", ".join(map(str, paths[:3])) + (", ..." if len(paths) > 3 else "")
