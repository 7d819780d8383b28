"""Reading run.vtkhdf: frames, fields, tracks, the log; nothing is loaded before it is asked for."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, TypeVar

import h5py
import numpy as np

from . import index
from .bodies import Bodies, read_bodies
from .errors import BadInput, UnknownName, unknown
from .fields import Field, Frames
from .gauges import Gauges, read_gauges
from .loads import Load, load_of
from .run_path import run_path
from .scene_text import name_in
from .table import Table

T = TypeVar("T")


class Run:
    """A run file, finished, still being written or cut off by a crash; see `open`."""

    def __init__(self, path: str | os.PathLike[str]):
        self.path = run_path(path)
        self.refresh()

    def __fspath__(self) -> str:
        """The path of its file: what takes the path of a run takes an open one too."""
        return os.fspath(self.path)

    def refresh(self) -> Run:
        """Looks at the file again: frames that were written meanwhile appear."""
        self._index = self._read(index.scan, "cannot read the run file")
        return self

    @property
    def times(self) -> np.ndarray:
        """Simulated time of every frame, shape (frames,), s."""
        return self._index.times

    @property
    def updates(self) -> np.ndarray:
        """Updates done at every frame, shape (frames,)."""
        return self._index.updates

    @property
    def counts(self) -> np.ndarray:
        """Particles in every frame, shape (frames,)."""
        return self._index.counts

    @property
    def ids(self) -> Field:
        """Ids of the particles, ascending: `run.ids[k]` names the particle of each row of frame k.

        0, 1, 2 ... in every frame, unless particles appear and disappear during the run: then ids
        have gaps, and an id is never given twice.
        """
        return self["id"]

    @property
    def frames(self) -> Frames:
        return Frames(self)

    @property
    def fields(self) -> list[str]:
        """Names of the fields, position first; empty before the first frame."""
        return list(self._index.fields)

    @property
    def units(self) -> dict[str, str]:
        """Unit of every field and of every quantity in `info` that has one."""
        return self._index.units

    @property
    def info(self) -> dict[str, Any]:
        """The run's attributes: backend, device, precision, threads, commit, spacing, domain..."""
        return self._index.info

    @property
    def scene(self) -> str:
        """The scene with every default filled in, as YAML text."""
        return str(self.info["resolved_scene"])

    @property
    def plan(self) -> str:
        """What `pbf plan --arrays` said of the scene when the run began, but for the run time;
        empty for a file without it."""
        return self._read(lambda file: index._text(file["pbf"].attrs.get("plan", "")),
                          "cannot read the plan")

    @property
    def name(self) -> str:
        """Name of the scene, as it says itself, else that of its file without the ending."""
        return name_in(str(self.info.get("resolved_scene", ""))) or \
            Path(str(self.info["scene_path"])).stem

    @property
    def status(self) -> str:
        """running, finished, stopped or diverged, at the last look at the file."""
        return str(self.info["status"])

    @property
    def warnings(self) -> list[str]:
        """What the run warned of, each kind once; of a run under way, what its scene gave."""
        return str(self.info.get("warnings", "")).splitlines()

    @property
    def title(self) -> str:
        """Scene, particles, backend, precision and device, for the title of a plot."""
        i = self.info
        return f"{self.name}, {i['particles']} particles, {i['backend']} {i['precision']} " \
               f"({i['device']})"

    def load(self, name: str) -> Load:
        """The load of a wall or obstacle: `force`, `impulse`, `mean(window)`, `peak(window)`."""
        return load_of(self.log, name, self.path)

    @property
    def compare(self) -> dict[str, dict[str, Any]]:
        """What the run has compared with measurements, by name: rms, correlation, lag_s, peak ...;
        nan where there is none, and then a `note` says why."""
        from .comparison import stored
        return self._read(stored, "cannot read the comparisons")

    def __getitem__(self, name: str) -> Field:
        if name not in self._index.fields:
            raise UnknownName(f"{self.path}: {unknown('field', name, self.fields)}")
        return Field(self, name, self._index.fields[name])

    def track(self, particle: int, *fields: str) -> Table:
        """One particle by its id: time (s), position and the fields asked for (all by default).

        One row for each frame that the particle is in. BadInput for an id that no frame has.

        >>> track = open("run.vtkhdf").track(17, "velocity")
        >>> list(track), track["velocity"].shape, track.units["position"]
        (['time', 'position', 'velocity'], (26, 3), 'm')
        """
        names = ["position", *(fields or (f for f in self.fields if f not in ("position", "id")))]
        places = {name: self[name]._place for name in dict.fromkeys(names)}

        def follow(file: h5py.File) -> dict[str, np.ndarray]:
            rows = {k: row for k in range(len(self.times))
                    if (row := self._row(file, k, particle)) is not None}
            columns = {name: np.array([file[p.path][p.offsets[k] + row] for k, row in rows.items()])
                       for name, p in places.items()}
            return {"time": self.times[list(rows)], **columns}

        columns = self._read(follow, "cannot read a track")
        if not len(columns["time"]):
            raise BadInput(f"{self.path}: no particle with id {particle} in any frame")
        return Table(columns, {"time": "s", **self.units})

    def _row(self, file: h5py.File, k: int, particle: int) -> int | None:
        """Row of a particle in frame k; rows are in ascending order of ids."""
        place, n = self._index.fields["id"], int(self.counts[k])
        ids, first = file[place.path], int(place.offsets[k])
        if first < 0 or first + n > len(ids):
            raise ValueError(f"id ends before frame {k} does")
        if 0 <= particle < n and ids[first + particle] == particle:
            return particle
        values = ids[first:first + n]
        row = int(np.searchsorted(values, particle))
        return row if row < n and values[row] == particle else None

    @property
    def log(self) -> Table:
        """Measures, seconds per stage ("stage/lambda"), loads on walls ("load/z_min/force_z") and
        poses ("pose/blade/x", "pose/blade/turn_xy"), one row per measure; with units.

        >>> log = open("run.vtkhdf").log
        >>> log["time"][:2], log.units["kinetic_energy"], "stage/lambda" in log
        (array([0.  , 0.02]), 'J', True)
        """
        return self._read(_log, "cannot read the log")

    @property
    def gauges(self) -> Gauges:
        """The gauges of the run by name; empty where its scene has none.

        `time, value = run.gauges["H2"]`.

        >>> open("run.vtkhdf").gauges
        {}
        """
        return self._read(read_gauges, "cannot read the gauges")

    @property
    def bodies(self) -> Bodies:
        """The obstacles that the fluid moves (`free`) in every frame, by name; empty where the
        scene has none. Between frames, `obstacle_pose` and the columns `pose/NAME/...` of the log
        have more.

        >>> open("run.vtkhdf").bodies
        {}
        """
        return self._read(lambda file: read_bodies(file, self.times), "cannot read the bodies")

    def obstacle_pose(self, name: str, time: float | np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Where a moving obstacle is at a time, s: its turn (3, 3) and the place of its middle (3,),
        m. A point at p from the middle that the scene gives it is at middle + turn @ p. From the
        rows of the log (`measure_every`), between them straight. Of several times (T,), which read
        the log once: (T, 3, 3) and (T, 3).

            turn, middle = run.obstacle_pose("blade", 0.5)
        """
        log = self.log
        if f"pose/{name}/x" not in log:
            moving = sorted({key.split("/")[1] for key in log if key.startswith("pose/")})
            raise UnknownName(f"{self.path}: {unknown('moving obstacle', name, moving)}")
        times = log["time"]
        for t in np.atleast_1d(time):
            if not times[0] <= t <= times[-1] * (1 + 1e-9):
                raise BadInput(f"{self.path}: {t} s is not in the log, which has {times[0]} to "
                               f"{times[-1]} s")

        def at(columns: list[str]) -> np.ndarray:
            return np.stack([np.interp(time, times, log[f"pose/{name}/{c}"]) for c in columns], -1)

        middle = at(["x", "y", "z"])
        turn = np.stack([at([f"turn_{k}{j}" for j in "xyz"]) for k in "xyz"], -2)
        u, _, vt = np.linalg.svd(turn)  # the nearest rotation: between rows it is not quite one
        return u @ vt, middle

    def _read(self, action: Callable[[h5py.File], T], what: str) -> T:
        return index.read(self.path, action, what)

    def __repr__(self) -> str:
        return f"<run {self.title}: {len(self.times)} frames, {self.status}; {self.path}>"

    def __iter__(self) -> Iterator[str]:
        return iter(self.fields)


def _log(file: h5py.File) -> Table:
    group = file["pbf/log"]
    data: dict[str, h5py.Dataset] = {}
    group.visititems(lambda name, d: data.update({name: d} if isinstance(d, h5py.Dataset) else {}))
    # A process killed while it wrote the log may leave columns of different lengths.
    rows = min((len(d) for d in data.values()), default=0)
    order = ["time"] + [name for name in data if name != "time"]
    return Table({name: data[name][:rows] for name in order if name in data},
                 {name: index._text(d.attrs.get("units", "1")) for name, d in data.items()})


def open(path: str | os.PathLike[str]) -> Run:  # noqa: A001, as in h5py and gzip
    """Opens a run, by its file or by its folder. Works on one still being written (`refresh` shows
    new frames) and on one that a crash cut off: every frame that was reported is there.

    FileError with the reason when it is not a run file that this version reads.

    >>> run = open("run.vtkhdf")
    >>> run.status, len(run.frames), run.fields
    ('finished', 26, ['position', 'density', 'id', 'velocity'])
    >>> run.times[:3], run.units["velocity"]
    (array([0.  , 0.02, 0.04]), 'm/s')
    >>> run["position"][-1].shape
    (4000, 3)
    """
    return Run(path)
