"""Files that are complete or not there, also on a full disk."""

from __future__ import annotations

import contextlib
import os
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from .errors import FileError


class KeptErrors:
    """A file for h5py that keeps the first error of a write and takes all further ones as done:
    HDF5 cannot close a file of which a write has failed, and ends the program later. Reads, seeks and
    the rest are those of the file."""

    def __init__(self, file: BinaryIO):
        self._file = file
        self.problem: OSError | None = None

    def write(self, data: bytes) -> int:
        rest = memoryview(data).cast("B")
        try:
            while rest and not self.problem:
                rest = rest[self._file.write(rest):]
        except OSError as problem:
            self.problem = problem
        return len(data)

    def truncate(self, size: int | None = None) -> int:
        try:
            return self._file.truncate(size)
        except OSError as problem:
            self.problem = self.problem or problem
            return size or 0

    def readinto(self, buffer: bytearray) -> int:
        number = self._file.readinto(buffer)
        buffer[number:] = bytes(len(buffer) - number)  # what could not be written
        return len(buffer)

    def check(self) -> None:
        """Raises the error."""
        if self.problem:
            raise self.problem

    def __getattr__(self, name: str) -> object:
        return getattr(self._file, name)


@contextlib.contextmanager
def whole_files(paths: list[Path]) -> Iterator[list[Path]]:
    """Other names to write these files under, beside them. They get their own when all is done; when
    it is not, nothing of them is left, and what was there before stays. Makes their folders.

    FileError with the reason where the system refuses.
    """
    parts = [path.with_name(path.name + ".part") for path in paths]
    try:
        for path in paths:
            path.parent.mkdir(parents=True, exist_ok=True)
        yield parts
        for part, path in zip(parts, paths):
            os.replace(part, path)
    except OSError as problem:
        where = paths[0] if len(paths) == 1 else paths[0].parent
        raise FileError(f"{where}: cannot write it: {problem.strerror or problem}") from None
    finally:
        for part in parts:
            with contextlib.suppress(OSError):
                part.unlink()
