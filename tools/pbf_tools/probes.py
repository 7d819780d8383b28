"""Gauges on the frames of a finished run, read by the program (`pbf probe`)."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from . import program as pbf
from .run_file import Run
from .scene_text import write_scene
from .table import Table, read_csv


def probe(run: Run | str | os.PathLike[str],
          gauges: str | os.PathLike[str] | Sequence[Mapping[str, Any]], *,
          program: str | os.PathLike[str] | None = None) -> Table:
    """Levels, velocities and flows of a run at gauges that it did not have, a row per frame. Kinds:
    level, line, velocity, flow.

        probe("out/a", [{"name": "H2", "kind": "level", "at": [2.2, 0.5]}])["H2_m"]

    gauges: a file with the key `gauges`, or a list of dicts with the keys of gauges. Columns have
    their units at the end of their names: time_s, H2_m (level, line), U_x_m_s, Q_kg_s, Q_total_kg.
    PbfError with the program's message for what no frame holds (pressures, loads) and for mistakes.
    """
    with tempfile.TemporaryDirectory() as folder:
        table, path = Path(folder) / "probe.csv", gauges
        if not isinstance(gauges, str | os.PathLike):
            path = write_scene({"gauges": gauges}, Path(folder) / "gauges.yaml")
        code, message = pbf.call(pbf.find(program), ["probe", os.fspath(run), "--gauges",
                                                     os.fspath(path), "-o", str(table)], False)
        if code:
            raise pbf.error(code, message if path is gauges else
                            re.sub(rf"{re.escape(str(path))}(:\d+)*: ", "", message))
        return read_csv(table)
