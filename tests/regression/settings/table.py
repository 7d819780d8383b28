"""settings_DEVICE.csv: a line for each figure of each setting. `value` is a text where runs have
failed."""

import csv
import math

import rows

COLUMNS = ("row case setting advice figure unit value scatter starts seconds device scene_sha256 "
           "defaults_sha256").split()


def number(x):
    return f"{x:.4g}"


def lines_of(case, number_of, setting, runs, scene, defaults):
    """Means over the runs of a setting and half their range; where some have failed, the reason of the
    first of these, and how many they are, in place of the mean."""
    failed = [found for found, _, _ in runs if isinstance(found, str)]
    device = next((d for _, d, _ in runs if d), "")
    for k, figure in enumerate(case.figures):
        if failed:
            share = f" in {len(failed)} of {len(runs)} starts" if len(runs) > 1 else ""
            value, scatter = failed[0] + share, ""
        else:
            values = [found[k] for found, _, _ in runs]
            value = number(sum(values) / len(values))
            scatter = number((max(values) - min(values)) / 2)
        yield dict(zip(COLUMNS, [
            case.row, case.name, setting["name"], "no" if number_of else "yes", figure.name,
            figure.unit, value, scatter, len(runs), number(sum(r[2] for r in runs) / len(runs)),
            device, scene, defaults]))


def value_of(line):
    """The mean; nan where the runs have failed."""
    try:
        return float(line["value"])
    except ValueError:
        return math.nan


def read(path):
    with open(path, newline="") as file:
        found = csv.DictReader(file)
        if found.fieldnames != COLUMNS:
            raise rows.Wrong(f"{path}: is no table of `run`, whose first line is {','.join(COLUMNS)}; "
                             "remove it or give another one")
        return list(found)


def write(path, lines):
    with open(path, "w", newline="") as file:
        out = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        out.writeheader()
        out.writerows(lines)


def key_of(line):
    return line["row"], line["case"], line["setting"]


def ordered(every, old, new=()):
    """The lines of all settings in the order of the rows, new ones in place of old ones. The advice is
    what the rows say today."""
    fresh = {key_of(line) for line in new}
    kept = [line for line in old if key_of(line) not in fresh] + list(new)
    return [{**line, "advice": "no" if k else "yes"} for r in every for c in r.cases
            for k, s in enumerate(c.settings)
            for line in kept if key_of(line) == (c.row, c.name, s["name"])]


def enough(lines, case, number):
    """Whether a setting is there, from as many starts as it should be."""
    key = case.row, case.name, case.settings[number]["name"]
    return any(key_of(line) == key and int(line["starts"]) >= case.starts[min(number, 1)]
               for line in lines)


def stamped(lines, chosen, pbf):
    """The lines with the SHA-256 of today's scenes and defaults."""
    cases = {(c.row, c.name): c for r in chosen for c in r.cases}
    defaults, known, out = rows.defaults_sha256(), {}, []
    for line in lines:
        place = line["row"], line["case"]
        if place in cases:
            names = [s["name"] for s in cases[place].settings]
            at = *place, line["setting"]
            if at not in known:
                known[at] = rows.scene_sha256(pbf, cases[place], names.index(line["setting"]))
            line = {**line, "scene_sha256": known[at], "defaults_sha256": defaults}
        out.append(line)
    return out


def changed(lines, every, pbf):
    """What is not as it was measured: a text for each row and setting, with what to do."""
    again = "; measure again: tests/regression/settings/run PBF OUT.csv --backend cuda --write"
    out, defaults = [], rows.defaults_sha256()
    old = sorted({line["row"] for line in lines if line["defaults_sha256"] != defaults})
    if old:
        out.append(f"defaults of configs/keys.md have changed since {', '.join(old)} "
                   f"{'were' if len(old) > 1 else 'was'} measured{again}")
    for case in (c for r in every for c in r.cases):
        for k, setting in enumerate(case.settings):
            mine = [line for line in lines
                    if key_of(line) == (case.row, case.name, setting["name"])]
            what = f"row {case.row}, case {case.name}, setting '{setting['name']}'"
            if {line["figure"] for line in mine} != {f.name for f in case.figures}:
                out.append(f"{what}: not all of its figures are in the table{again} "
                           f"--only {case.row}")
            elif any(line["scene_sha256"] != rows.scene_sha256(pbf, case, k) for line in mine[:1]):
                out.append(f"{what}: its scene {case.scene.name} is not the one that was "
                           f"measured{again} --only {case.row}")
    return out


def out_of_bounds(lines, chosen, reduced=False):
    """What is out of the bounds of an advised setting."""
    out = []
    for case in (c for r in chosen for c in r.cases):
        for figure in case.figures:
            bounds = figure.reduced_bounds if reduced else figure.bounds
            for line in lines:
                if bounds and (line["row"], line["case"], line["figure"], line["advice"]) == \
                        (case.row, case.name, figure.name, "yes"):
                    x = value_of(line)
                    if not (math.isfinite(x) and bounds[0] <= x <= bounds[1]):
                        said = f"{x:g} {figure.unit}" if math.isfinite(x) else line["value"]
                        out.append(f"{case.row}/{case.name}: {figure.name} is {said}, bounds {bounds}")
    return out
