"""The tables of configs/SETTINGS.md, between its two marks."""

import math

import rows
import table

PAGE = rows.ROOT / "configs/SETTINGS.md"
BEGIN, END = "<!-- tables: begin, tests/regression/settings/run -->", "<!-- tables: end -->"


def rounded(x, digits):
    """A number with `digits` places after the point, or before it where negative."""
    text = f"{round(x, digits):.{max(digits, 0)}f}"
    return text.lstrip("-") if float(text) == 0 else text.replace("-", "−")


def shown(line):
    """The value to three digits, or as far as its scatter lets it be known, and the scatter; or why
    there is none."""
    x = table.value_of(line)
    if not math.isfinite(x):
        return line["value"].replace("|", "\\|")
    scatter = float(line["scatter"])
    places = 2 - math.floor(math.log10(abs(x))) if x else 2
    if scatter > 0:
        places = min(places, 1 - math.floor(math.log10(scatter)))
    places = max(min(places, 4), 0)
    both = rounded(x, places)
    if scatter > 0 and float(rounded(scatter, places)) > 0:
        both += f" ± {rounded(scatter, places)}"
    return both


def of(lines, case, setting=None):
    return [line for line in lines if (line["row"], line["case"]) == (case.row, case.name)
            and setting in (None, line["setting"])]


def anchor(title):
    return title.lower().replace(" ", "-").replace(",", "")


def summary(every, lines):
    """A line for each problem: the advised settings and what they gave in its first case."""
    out = ["| problem | settings | measured |", "|---|---|---|"]
    for row in every:
        case = row.cases[0]
        mine = of(lines, case, case.settings[0]["name"])
        text = "; ".join(f"{x['figure']} {shown(x)}{' ' + x['unit'] if x['unit'] else ''}"
                         for x in mine if x["figure"] != "iterations per second")
        out.append(f"| [{row.title}](#{anchor(row.title)}) | {case.settings[0]['name']} | {text} |")
    return out


def block(case, lines):
    """The table of a case: a row for each setting, the advice in bold, a column for each figure."""
    head = [f"{f.name}{', ' + f.unit if f.unit else ''}" for f in case.figures]
    out = [f"**{case.name}**: {case.text}.", "", "| settings | " + " | ".join(head) + " | starts |",
           "|---" * (len(head) + 2) + "|"]
    for k, setting in enumerate(case.settings):
        mine = of(lines, case, setting["name"])
        values = {x["figure"]: shown(x) for x in mine}
        name = setting["name"] if k else f"**{setting['name']}**"
        cells = [values.get(f.name, "–") for f in case.figures]
        starts = mine[0]["starts"] if mine else "–"
        out.append(f"| {name} | " + " | ".join(cells) + f" | {starts} |")
    return out + [""]


def tables(every, lines, name):
    """All that stands between the marks."""
    device = ", ".join(dict.fromkeys(line["device"] for line in lines if line["device"]))
    out = [f"Measured on: {device}, float ([table](../tests/regression/settings/{name})).", "",
           *summary(every, lines), ""]
    for row in every:
        out += [f"## {row.title}", row.advice, ""]
        for case in row.cases:
            out += block(case, lines)
    return "\n".join(out).rstrip() + "\n"


def between(text):
    """The part of a page between the marks; rows.Wrong where it has none."""
    if text.count(BEGIN) != 1 or text.count(END) != 1:
        raise rows.Wrong(f"{PAGE.name} needs one line '{BEGIN}' and one '{END}'")
    return text.split(BEGIN + "\n")[1].split(END)[0]


def write(every, lines, name):
    text = PAGE.read_text()
    old = between(text)
    PAGE.write_text(text.replace(BEGIN + "\n" + old + END,
                                 BEGIN + "\n" + tables(every, lines, name) + END))
