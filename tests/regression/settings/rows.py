"""The rows of settings.yaml: problems, their cases, the settings that are measured, the figures."""

import hashlib
import inspect
import os
import pathlib
import re
import subprocess
from dataclasses import dataclass, field

import figures
import yaml

ROOT = pathlib.Path(__file__).resolve().parents[3]
# What a figure is read from -> keys that it needs, and others (figures.py).
SOURCES = {"log": ("as", "from"), "gauge": ("as", "from"), "compare": ("of", "over")}


class Wrong(ValueError):
    """What is wrong in a file of rows."""


@dataclass(frozen=True)
class Figure:
    """One number of a run. `source`: log, gauge, compare or call, and what it takes (figures.py).
    Bounds are those of the advised setting, of the full and of the reduced form; None: not asked."""

    name: str
    unit: str
    source: dict
    bounds: list | None
    reduced_bounds: list | None


@dataclass(frozen=True)
class Case:
    """A scene of a problem. `settings`: name and keys, the first is the advice; `reduced`: keys laid
    over it for the small form, None where there is none."""

    row: str
    name: str
    scene: pathlib.Path
    text: str
    keys: dict
    settings: list
    figures: list
    starts: list
    reduced: dict | None

    def words(self, number: int, start: int = 0, reduced: bool = False) -> list[str]:
        """The options --set of a setting; starts differ by some micrometers per second."""
        keys = {**self.keys, **self.settings[number]["set"], **(self.reduced if reduced else {})}
        if start:
            v = keys.get("bodies[0].velocity", [0, 0, 0])
            keys["bodies[0].velocity"] = [v[0] + 1e-6 * start, *v[1:]]
        return [w for k, v in keys.items() for w in ("--set", f"{k}={as_text(v)}")]


@dataclass(frozen=True)
class Row:
    name: str
    title: str
    advice: str
    cases: list = field(default_factory=list)


def as_text(value) -> str:
    """As on the command line."""
    if isinstance(value, bool):
        return "on" if value else "off"
    return re.sub(r"\bTrue\b", "on", str(value)) if isinstance(value, (list, dict)) else str(value)


def only(given: dict, needed: str, optional: str, what: str) -> dict:
    names = set(needed.split()) | set(optional.split())
    if not isinstance(given, dict):
        raise Wrong(f"{what}: has no keys; it needs {', '.join(needed.split())}")
    for key in given:
        if key not in names:
            raise Wrong(f"{what}: {key}: unknown key; there are {', '.join(sorted(names))}")
    for key in needed.split():
        if key not in given:
            raise Wrong(f"{what}: {key} is missing")
    return given


def name_of(given) -> str:
    return str(given.get("name")) if isinstance(given, dict) else "?"


def keys_of_source(given: dict, what: str) -> tuple[str, str]:
    """Keys that a figure needs besides its name, and others that it may have."""
    if "call" in given:
        function = figures.FUNCTIONS.get(given["call"])
        if function is None:
            raise Wrong(f"{what}: call: {given['call']}: there are {', '.join(figures.FUNCTIONS)}")
        return "call " + " ".join(p for p in inspect.signature(function).parameters
                                  if p not in ("run", "seconds")), ""
    read = [s for s in SOURCES if s in given]
    if len(read) != 1:
        raise Wrong(f"{what}: a figure has a name and one of {', '.join([*SOURCES, 'call'])}")
    needs, may = SOURCES[read[0]]
    return f"{read[0]} {needs}", may


def figure(given: dict, what: str) -> Figure:
    if not isinstance(given, dict):
        raise Wrong(f"{what}: a figure is a map of keys")
    needed, optional = keys_of_source(given, what)
    only(given, f"name {needed}", f"{optional} unit factor add bounds reduced_bounds", what)
    for key in ("bounds", "reduced_bounds"):
        pair = given.get(key, [0, 0])
        if not (isinstance(pair, list) and len(pair) == 2 and pair[0] <= pair[1]):
            raise Wrong(f"{what}: {key} is [LOW, HIGH]")
    source = {k: v for k, v in given.items() if k not in
              ("name", "unit", "bounds", "reduced_bounds")}
    return Figure(given["name"], given.get("unit", ""), source, given.get("bounds"),
                  given.get("reduced_bounds"))


def case(given: dict, row: str, folder: pathlib.Path) -> Case:
    what = f"{row}/{name_of(given)}"
    only(given, "name scene text starts settings figures", "set reduced", what)
    settings = [{"set": {}, **only(s, "name", "set", f"{what}: a setting")} for s in given["settings"]]
    numbers = [figure(f, f"{what}: {name_of(f)}") for f in given["figures"]]
    reduced = given.get("reduced")
    if reduced is not None and not any(f.reduced_bounds for f in numbers):
        raise Wrong(f"{what}: a reduced form needs a figure with reduced_bounds")
    return Case(row, given["name"], folder / given["scene"], given["text"], given.get("set", {}),
                settings, numbers, given["starts"], reduced)


def read(path: pathlib.Path) -> list[Row]:
    """The rows of a file; Wrong says what is wrong with it."""
    try:
        given = yaml.safe_load(path.read_text())
    except yaml.YAMLError as error:
        raise Wrong(f"{path.name}: {' '.join(str(error).split())}") from error
    out = []
    for r in only(given, "rows", "settings", path.name)["rows"]:
        only(r, "name title advice cases", "", f"{path.name}: {name_of(r)}")
        cases = [case(c, r["name"], path.parent) for c in r["cases"]]
        if not any(c.reduced is not None for c in cases):
            raise Wrong(f"{path.name}: {r['name']}: no case has a reduced form")
        out.append(Row(r["name"], r["title"], " ".join(r["advice"].split()), cases))
    return out


def scene_sha256(pbf, case: Case, number: int) -> str:
    """Of the scene with every default filled in, but for where it is computed."""
    done = subprocess.run([os.fspath(pbf), "plan", os.fspath(case.scene), "--resolved",
                           *case.words(number)], capture_output=True, text=True)
    if done.returncode != 0:
        raise Wrong(f"{case.row}/{case.name}: {' '.join(done.stderr.split())}")
    kept = [line for line in done.stdout.splitlines()
            if not re.match(r"(backend|threads):", line)]
    return hashlib.sha256("\n".join(kept).encode()).hexdigest()


def defaults_sha256(text: str | None = None) -> str:
    """Of the keys and defaults of configs/keys.md; what else the page says does not count."""
    text = (ROOT / "configs/keys.md").read_text() if text is None else text
    block, found = "", []
    for line in text.splitlines():
        if line.startswith("## "):
            block = line
        cells = re.split(r"(?<!\\)\|", line)
        if line.startswith("| `") and len(cells) > 5:
            found.append(f"{block} {cells[1].strip()} {cells[4].strip()}")
    return hashlib.sha256("\n".join(found).encode()).hexdigest()
