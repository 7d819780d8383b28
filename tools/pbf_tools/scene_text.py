"""Scenes and settings of Python as the program takes them: a file of JSON, which is YAML, and the
words of --set."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from .errors import BadInput, UnknownName, unknown
from .table import write_text

Scene = Mapping[str, Any] | str | os.PathLike[str]
MARK = "# Written by pbf_tools from a dict; JSON is YAML.\n"


def plain(value: Any, where: str) -> Any:
    """The same of dict, list, str, bool, int, float and None alone; BadInput for anything else."""
    if isinstance(value, Mapping):
        return {str(key): plain(item, f"{where}.{key}") for key, item in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        return plain(value.tolist(), where)
    if isinstance(value, os.PathLike):
        return os.fspath(value)
    if value is None or isinstance(value, str | bool | int | float):
        return value
    if isinstance(value, Sequence):
        return [plain(item, f"{where}[{k}]") for k, item in enumerate(value)]
    raise BadInput(f"{where}: a {type(value).__name__} is no value of a scene; there are numbers, "
                   "texts, True and False, lists, dicts and None (off)")


def text(value: Any, where: str) -> str:
    """A value on one line, as --set and --grid take it.

    >>> text(0.5, "a"), text(True, "a"), text(None, "a"), text("jet", "a"), text([0, 0, -9.81], "a")
    ('0.5', 'true', 'off', 'jet', '[0, 0, -9.81]')
    """
    value = plain(value, where)
    if value is None:
        return "off"
    if isinstance(value, str) and re.fullmatch(r"[\w./+-]+", value):
        return value  # words, as off, that quotes would make a text
    return json.dumps(value, ensure_ascii=False)


def name_in(resolved: str) -> str:
    """The name that a scene with every default written out says; empty where it says none.

    >>> name_in("name: drop\\ntime: 1\\n"), name_in('name: "a \\\\"b\\\\": c"'), name_in("time: 1")
    ('drop', 'a "b": c', '')
    """
    said = re.search(r"^name: (.+)$", resolved, re.MULTILINE)
    if not said:
        return ""
    name = said[1].strip()
    return str(json.loads(name)) if name.startswith('"') else name


def gravity_in(resolved: str, path: str) -> np.ndarray:
    """Gravity (3,), m/s^2, of a scene with every default written out; `path` for the error.

    >>> gravity_in("gravity: [0, 0, -9.81]\\n", "run").tolist()
    [0.0, 0.0, -9.81]
    """
    match = re.search(r"^gravity: *\[([^]]*)\]", resolved, re.MULTILINE)
    if not match:
        raise BadInput(f"{path}: the scene in it says no gravity")
    return np.array([float(v) for v in match[1].split(",")])


def plane_in(resolved: str, name: str, path: str) -> tuple[np.ndarray, np.ndarray]:
    """Point (m) and normal, (3,) each, of an obstacle that is a plane and stands still, of a scene
    with every default written out. BadInput, naming `path`, for one that is not there or is another.

    >>> plane_in("obstacles:\\n  - {name: a, shape: plane, point: [4, 0, 0], normal: [-1, 0, 2]}",
    ...          "a", "run")
    (array([4., 0., 0.]), array([-1.,  0.,  2.]))
    """
    block = re.search(r"^obstacles:\n((?:[ -].*\n?)*)", resolved, re.MULTILINE)
    entry = r'^ +- \{name: ("(?:[^"\\]|\\.)*"|[^,"]*), shape: (\w+)(.*)$'
    found = {str(json.loads(said)) if said.startswith('"') else said: (shape, rest)
             for said, shape, rest in re.findall(entry, block[1] if block else "", re.MULTILINE)}
    if name not in found:
        raise UnknownName(f"{path}: {unknown('obstacle', name, found)}")
    shape, rest = found[name]
    vectors = dict(re.findall(r"\b(point|normal): \[([^]]*)\]", rest))
    if shape != "plane" or "motion:" in rest or len(vectors) < 2:
        raise BadInput(f"{path}: obstacle {name} is a {shape}{' that moves' * ('motion:' in rest)}; "
                       "this is for planes that stand still")
    point, normal = (np.array([float(v) for v in vectors[key].split(",")])
                     for key in ("point", "normal"))
    return point, normal


def settings(overrides: Mapping[str, Any], path: str = "") -> dict[str, Any]:
    """Keys of the scene and their values: `solver__iterations`, "solver.iterations" and a dict say
    the same, and a dict changes only the keys in it.

    >>> settings({"solver__iterations": 8, "time": {"end": 1}, "bodies[0].velocity": [1, 0, 0]})
    {'solver.iterations': 8, 'time.end': 1, 'bodies[0].velocity': [1, 0, 0]}
    """
    flat: dict[str, Any] = {}
    for key, value in overrides.items():
        name = path + key.replace("__", ".")
        flat.update(settings(value, name + ".") if isinstance(value, Mapping) and value
                    else {name: value})
    return flat


def set_words(overrides: Mapping[str, Any]) -> list[str]:
    """--set KEY=VALUE for every override."""
    return [word for key, value in settings(overrides).items()
            for word in ("--set", f"{key}={text(value, key)}")]


def _whole_paths(value: Any, folder: str) -> Any:
    """With every `path` (particles, motions) made absolute: the file is not where the script is."""
    if isinstance(value, list):
        return [_whole_paths(item, folder) for item in value]
    if not isinstance(value, dict):
        return value
    return {key: os.path.join(folder, item) if key == "path" and isinstance(item, str)
            else _whole_paths(item, folder) for key, item in value.items()}


def base_words(scene: Any, folder: str | os.PathLike[str] | None) -> list[str]:
    """--base-folder of a call: the folder that was given; of dicts the working folder, from which
    their bases are meant, for the files written of them lie elsewhere."""
    scenes = scene if isinstance(scene, list | tuple) else [scene]
    dicts = any(isinstance(one, Mapping) and "base" in one for one in scenes)
    folder = os.getcwd() if folder is None and dicts else folder
    return [] if folder is None else ["--base-folder", os.fspath(folder)]


def write_scene(scene: Mapping[str, Any], path: Path) -> Path:
    """Writes a dict as a scene file; relative `path`s in it, and its `base`, are meant from the
    working folder.

    BadInput when a file is there that this function has not written.
    """
    content = _whole_paths(plain(scene, "scene"), os.getcwd())
    if isinstance(content.get("base"), str) and content["base"]:
        content["base"] = os.path.join(os.getcwd(), content["base"])
    if path.is_dir() or path.exists() and not path.read_bytes().startswith(MARK.encode()):
        raise BadInput(f"{path}: the scene would be written here, but another file is there; give "
                       "another out, or move it")
    write_text(path, MARK + json.dumps(content, indent=1, ensure_ascii=False) + "\n", parents=True)
    return path
