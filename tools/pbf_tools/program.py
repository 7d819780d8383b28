"""The program `pbf` as a process: where it is, how it is called, what its end means."""

from __future__ import annotations

import importlib.metadata
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import Any

from .errors import BadInput, Diverged, MissingPackage, PbfError, PbfWarning, Stopped

GUARD, RESUMABLE = 3, 75  # exit codes
_ERROR, _WARNING = "pbf: error: ", "pbf: warning: "
_PROGRESS = re.compile(r" *\d+ %  update |\[\d+/\d+\] ")  # of a run, of a batch


def find(program: str | os.PathLike[str] | None = None) -> str:
    """The program: the argument, the environment variable PBF, the one of the wheel that this
    package came in, `pbf` on the PATH, or build/pbf of the tree that this package lies in or of the
    working folder, as the pages call it: `pip install ./tools` has taken the package out of its
    tree. BadInput for one named that cannot be run, MissingPackage when there is none."""
    for source, named in (("program", program), ("the environment variable PBF",
                                                 os.environ.get("PBF"))):
        if named:
            path = shutil.which(os.path.expanduser(named))
            if path is None:
                raise BadInput(f"{os.fspath(named)} ({source}): is no program that can be run")
            return os.path.abspath(path)
    built = [tree / "build/pbf" for tree in (Path(__file__).resolve().parents[2], Path.cwd())]
    path = _of_wheel() or shutil.which("pbf") or next(
        (str(file) for file in built if file.is_file() and os.access(file, os.X_OK)), None)
    if path is None:
        raise MissingPackage("pbf is not on the PATH, and there is no build/pbf in the working "
                             "folder; build it with tools/demo, or name it with program= or the "
                             "environment variable PBF")
    return path


def _of_wheel() -> str | None:
    """The program that pip installed together with this package, also where its folder is not on
    the PATH, as in a notebook of an environment that is not activated."""
    package = Path(__file__).resolve().parent
    try:
        wheel = importlib.metadata.distribution("pbf")
    except importlib.metadata.PackageNotFoundError:
        return None
    if Path(os.fspath(wheel.locate_file(package.name))).resolve() != package:
        return None  # of another installation
    installed = [wheel.locate_file(file) for file in wheel.files or [] if file.name == "pbf"]
    # `pip install --target` moves the scripts and leaves its list of files as it was.
    for path in (*installed, package.parent / "bin/pbf"):
        if os.access(path, os.X_OK) and not os.path.isdir(path):
            return os.path.abspath(path)
    return None


class Line:
    """Progress: one line that is overwritten, in a terminal and in a notebook."""

    def __init__(self, shown: bool | None):
        stream = sys.stderr
        self._overwrites = stream.isatty() or type(stream).__module__.startswith("ipykernel")
        self._stream = stream if (self._overwrites if shown is None else shown) else None
        self._width = 0

    def show(self, text: str) -> None:
        if self._stream:
            end = "" if self._overwrites else "\n"
            start = "\r" if self._overwrites else ""
            print(start + text.ljust(self._width), end=end, file=self._stream, flush=True)
            self._width = len(text) if self._overwrites else 0

    def close(self) -> None:
        if self._stream and self._width:
            print(file=self._stream, flush=True)
        self._width = 0


def call(program: str, words: list[str], progress: bool | None) -> tuple[int, str]:
    """Runs the program to its end: its exit code and its error message. Its warnings become
    PbfWarning. KeyboardInterrupt is passed on (it saves and ends; a second one ends it at once)
    and raised when it has ended."""
    line, errors = Line(progress), []
    # A process group of its own: Ctrl-C in a terminal reaches this process alone.
    with subprocess.Popen([program, *words], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                          stderr=subprocess.PIPE, text=True, encoding="utf-8", errors="replace",
                          start_new_session=True) as process:
        def follow() -> None:
            assert process.stderr
            for text in process.stderr:
                if _PROGRESS.match(text):
                    line.show(text.strip())
                elif text.startswith(_WARNING):
                    warnings.warn(text[len(_WARNING):].strip(), PbfWarning, stacklevel=5)
                elif text.startswith(_ERROR):
                    errors[:] = [text[len(_ERROR):]]
                elif errors:  # an error of several lines
                    errors.append(text)
            process.wait()

        try:
            _interruptible(process, follow)
        finally:
            line.close()
    return process.returncode, "".join(errors).strip()


def _interruptible(process: subprocess.Popen, follow: Callable[[], None]) -> None:
    try:
        follow()
    except BaseException as problem:  # also a warning that filters make an error
        process.send_signal(signal.SIGINT)
        try:
            follow()
            if process.returncode == RESUMABLE:
                problem.add_note("pbf stopped early, after saving; the same call goes on "
                                 "(of run: with resume=True)")
        except BaseException:
            process.send_signal(signal.SIGINT)  # the second one ends at once
            process.wait()
        raise


def error(code: int, message: str, run: Any = None) -> PbfError:
    """The exception of an exit code that is not 0."""
    kind = {GUARD: Diverged, RESUMABLE: Stopped}.get(code, PbfError)
    if not message:
        message = f"pbf was ended by signal {-code}" if code < 0 else \
            "stopped early, after saving; resume=True goes on" if code == RESUMABLE else \
            f"pbf ended with exit code {code}"
    return kind(message, 128 - code if code < 0 else code, run)


def answer(program: str, words: list[str]) -> Any:
    """The JSON that a command prints. PbfError with its message when it fails."""
    done = subprocess.run([program, *words], stdin=subprocess.DEVNULL, capture_output=True,
                          text=True, encoding="utf-8", errors="replace")
    if done.returncode != 0:
        raise error(done.returncode, done.stderr.rpartition(_ERROR)[2].strip())
    return json.loads(done.stdout)
