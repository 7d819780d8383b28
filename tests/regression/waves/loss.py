"""How much of their height waves lose on their way: flumes with the settings recommended for waves, in
two dimensions, in three and at several depths.

A piston makes regular waves (H, T) in a flume of 4.75 wavelengths L; the last of them is a sponge. Gauges
stand from 1 L to 3.5 L. They are read over three periods, which begin two periods after the full wave has
come to the last one: by linear theory what is left of the front changes the loss by less than 0.3 points.
In three dimensions the flume is 10 d wide between walls, since levels do not go with periodic faces.
"""
import concurrent.futures
import csv
import dataclasses
import math
import pathlib
import subprocess

import numpy as np

import pbf_tools
from pbf_tools import style, waves

FIRST, LAST, ZONE, FLUME = 1.0, 3.5, 3.75, 4.75  # wavelengths from the paddle
WAIT, WINDOW = 2, 3                              # periods
GRAVITY = 9.81
# Of WaveMaker::loss (lib/scene/waves.cpp), by dimensions: c with h = 2 d, a and b with a longer h.
PRESENT = {2: (133, 10.6, 5.6), 3: (81, 7.8, 0)}
LONG = {2: 3.5, 3: 3.0}  # h/d


@dataclasses.dataclass(frozen=True)
class Case:
    """Lengths in m, the period in s; `pace` is the step over d, s/m, `width` of a flume in
    three dimensions in d. `note` says what a case is for."""

    depth: float
    period: float
    spacing: float
    height: float
    dimensions: int = 2
    pace: float = 0.4
    width: int = 10
    note: str = ""
    ratio: float = 2.0  # h/d

    @property
    def k(self):
        return float(waves.wavenumber(self.period, self.depth))

    @property
    def length(self):
        return 2 * math.pi / self.k

    @property
    def numbers(self):
        """kD, H/d, L/d."""
        return self.k * self.depth, self.height / self.spacing, self.length / self.spacing

    @property
    def end(self):
        kd = self.k * self.depth
        group = math.pi / self.period / self.k * (1 + 2 * kd / math.sinh(2 * kd))
        return LAST * self.length / group + (1 + WAIT + WINDOW) * self.period

    @property
    def particles(self):
        layer = FLUME * self.length * self.depth / self.spacing ** 2
        return layer * (self.width if self.dimensions == 3 else 1)

    @property
    def work(self):
        """Particles times updates."""
        return self.particles * self.end / (self.pace * self.spacing)


R2 = math.sqrt(2)
TWIN = 0.4 / R2  # the step over d at twice the depth that makes a twin of a flume at half of it
CASES = (
    Case(0.3, 2.0, 0.010, 0.06), Case(0.3, 2.0, 0.010, 0.03), Case(0.3, 2.0, 0.005, 0.06),
    Case(0.3, 1.2, 0.010, 0.02), Case(0.3, 1.2, 0.010, 0.04), Case(0.3, 1.2, 0.010, 0.08),
    Case(0.3, 1.2, 0.005, 0.02), Case(0.3, 1.2, 0.005, 0.04),
    Case(0.3, 0.8, 0.010, 0.02), Case(0.3, 0.8, 0.010, 0.04), Case(0.3, 0.8, 0.005, 0.04),
    Case(0.3, 1.2, 0.010, 0.04, pace=0.2, note="half the step"),
    Case(0.6, 2.0 * R2, 0.020, 0.12), Case(0.6, 2.0 * R2, 0.010, 0.12),
    Case(0.6, 1.2 * R2, 0.020, 0.08), Case(0.6, 1.2 * R2, 0.010, 0.08),
    Case(0.6, 1.2 * R2, 0.010, 0.08, pace=TWIN, note="step 2.83 ms"),
    Case(0.6, 0.8 * R2, 0.010, 0.08), Case(0.15, 1.2 / R2, 0.005, 0.02),
    Case(0.3, 2.0, 0.012, 0.06, 3), Case(0.3, 1.2, 0.010, 0.04, 3), Case(0.3, 1.2, 0.010, 0.08, 3),
    Case(0.3, 1.2, 0.0075, 0.06, 3), Case(0.3, 0.8, 0.010, 0.04, 3), Case(0.3, 0.8, 0.006, 0.04, 3),
    Case(0.3, 0.8, 0.010, 0.04, 3, width=20, note="20 d wide"),
    Case(0.6, 1.2 * R2, 0.020, 0.08, 3))
CASES += tuple(dataclasses.replace(case, ratio=LONG[case.dimensions]) for case in CASES)
COARSE = (Case(0.3, 0.8, 0.015, 0.06), Case(0.3, 0.8, 0.015, 0.045))


def scene(case):
    """The flume of a case; the paddle is at x = 1 L, where nothing depends on it."""
    start, d, top = 0.5, case.spacing, 2.2 * case.depth
    right, deep = start + FLUME * case.length, case.dimensions == 3
    width, step = case.width * d, case.pace * case.spacing
    count = math.ceil(12 * (LAST - FIRST)) + 1
    places = np.linspace(FIRST, LAST, count) * case.length

    def at(x, y, z):
        return f"[{x:.6g}, {y:.6g}, {z:.6g}]" if deep else f"[{x:.6g}, {z:.6g}]"

    gauges = ", ".join(
        f"{{name: g{k:02d}, kind: level, at: [{start + x:.6f}{f', {width / 2:.6g}' if deep else ''}]}}"
        for k, x in enumerate(places))
    every = max(1, round(case.period / 40 / step)) * step
    return places, f"""dimensions: {case.dimensions}
domain: {{min: {at(0, 0, 0)}, max: {at(right, width, top)}}}
fluid: {{spacing: {d}, smoothing_ratio: {case.ratio:g}}}
bodies: [{{shape: block, min: {at(start, 0, 0)}, max: {at(right, width, case.depth)}}}]
obstacles:
  - {{name: piston, shape: box, min: {at(start - 1, -0.1, -0.1)}, max: {at(start, width + 0.1, top + 0.1)},
     motion: {{kind: regular_waves, direction: [1, 0, 0], height: {case.height}, period: {case.period:.9g}}}}}
damping:
  - {{name: end, min: {at(start + ZONE * case.length, 0, 0)}, max: {at(right, width, top)},
     toward: x_max, rate: {15 / case.period:.6g}}}
gauges: [{gauges}]
solver: {{levels: on, iterations: 1, substeps: 7}}
time: {{step: {step:.9g}, end: {case.end:.6g}}}
measure_every: 100
output: {{every: {case.end:.6g}, gauges_every: {every:.9g}}}
"""


def measure(case, folder, program, backend):
    """The row of a case: what waves.along says of its gauges."""
    path = folder / "flume.yaml"
    places, text = scene(case)
    path.write_text(text)
    command = [program, "run", path, "--backend", backend, "--quiet", "--overwrite", "--out", folder / "out"]
    if backend == "cpu":
        command += ["--threads", "1"]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    run = pbf_tools.open(folder / "out")
    gauges = [run.gauges[f"g{k:02d}"] for k in range(len(places))]
    end = float(gauges[0].time[-1])
    found = waves.along(gauges, places, case.depth, case.period,
                        between=(end - WINDOW * case.period, end))
    kd, height, length = case.numbers
    slope, first = np.polyfit(places, np.log(found.table["height"]), 1)
    return {"dimensions": case.dimensions, "depth_m": case.depth, "period_s": round(case.period, 6),
            "spacing_m": case.spacing, "smoothing_ratio": case.ratio, "height_m": case.height,
            "step_s": float(f"{case.pace * case.spacing:.6g}"),
            "kd": round(kd, 4), "height_over_d": round(height, 3), "length_over_d": round(length, 2),
            "depth_over_d": round(case.depth / case.spacing, 2),
            "width_over_d": case.width if case.dimensions == 3 else "",
            "wavenumber_error": round(found.wavenumber / found.theory - 1, 5),
            "loss": round(found.loss, 5),
            "height_at_paddle": round(math.exp(first) / case.height, 4),
            "second_harmonic": round(float(np.mean(found.table["second"])), 4),
            "unexplained": round(float(np.mean(found.table["unexplained"])), 4), "note": case.note}


def measure_all(cases, folder, program, backend, jobs, out):
    """Runs the cases, the longest first, and writes the table after each, so that a job that is cut
    short keeps what it has."""
    rows = {}

    def one(number):
        place = pathlib.Path(folder) / str(number)
        place.mkdir()
        return number, measure(cases[number], place, program, backend)

    order = sorted(range(len(cases)), key=lambda k: -cases[k].work)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for done in concurrent.futures.as_completed([pool.submit(one, k) for k in order]):
            number, row = done.result()
            rows[number] = row
            write(out, [rows[k] for k in sorted(rows)])
            print("{dimensions}-D, D {depth_m:g} m, kD {kd:.2f}, H {height_over_d:.3g} d, L "
                  "{length_over_d:.0f} d: loss {loss:.1%}, k {wavenumber_error:+.1%}".format(**row),
                  flush=True)
    return [rows[k] for k in sorted(rows)]


def write(path, rows):
    with open(path, "w", newline="") as file:
        table = csv.DictWriter(file, list(rows[0]))
        table.writeheader()
        table.writerows(rows)


def read(path):
    """The columns of a table that `write` wrote, as numbers where they are."""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([row[name] for row in rows]) if name == "note" else
            np.array([float(row[name] or "nan") for row in rows]) for name in rows[0]}


def shape(table, numbers):
    """What stands in the exponent of the formula, by the numbers of each row; b does with h = 2 d
    nothing."""
    short = table["smoothing_ratio"] < 2.5
    over_l, over_h = 1 / table["length_over_d"], 1 / table["height_over_d"]
    c, a, b = (np.where(table["dimensions"] == 2, numbers[2][k], numbers[3][k]) for k in range(3))
    return np.where(short, c * over_l * over_h ** 1.5, a * over_l * (1 + b * over_h))


def expected(table, numbers=PRESENT):
    """Share of the height per wavelength, of the formula of WaveMaker::loss."""
    return 1 - np.exp(-shape(table, numbers))


def parts(table):
    """The rows that a formula of their own was fitted to, with a name: by dimensions and h."""
    for n in (2, 3):
        for long in (False, True):
            here = (table["dimensions"] == n) & ((table["smoothing_ratio"] > 2.5) == long)
            yield n, long, f"{n}-D, h = {LONG[n] if long else 2:g} d", here


def factor(per_unit, loss):
    """a for the least squares of loss - 1 + exp(-a per_unit), by Newton's method."""
    a = 10.0
    for _ in range(60):
        left = np.exp(-a * per_unit)
        slope = left * per_unit
        a += np.sum(slope * (loss - 1 + left)) / np.sum(slope ** 2)
    return a


def fit(table):
    """The numbers of least squares, like PRESENT. b is not below 0 and in three dimensions 0, as these
    flumes do not tell it from 0; it is sought on finer and finer grids."""
    found = {2: [0, 0, 0], 3: [0, 0, 0]}
    for n, long, _, here in parts(table):
        loss = table["loss"][here]
        over_l, over_h = 1 / table["length_over_d"][here], 1 / table["height_over_d"][here]
        if not long:
            found[n][0] = factor(over_l * over_h ** 1.5, loss)
            continue

        def tried(b):
            a = factor(over_l * (1 + b * over_h), loss)
            return np.sum((loss - 1 + np.exp(-a * over_l * (1 + b * over_h))) ** 2), a, b

        best, reach = tried(0.0), 20.0
        while n == 2 and reach > 1e-9:
            best = min((tried(max(best[2] + part * reach, 0)) for part in np.linspace(-1, 1, 9)),
                       key=lambda result: result[0])
            reach /= 2
        found[n][1:] = best[1:]
    return found


def report(table):
    """Residuals of the present formula and of one fitted to the table, in points (hundredths of the
    height)."""
    lines = []
    for what, numbers in (("present", PRESENT), ("fitted", fit(table))):
        for n, long, name, here in parts(table):
            if not here.any():
                continue
            rest = 100 * (table["loss"] - expected(table, numbers))[here]
            said = "a {:.4g}, b {:.4g}".format(*numbers[n][1:]) if long else f"c {numbers[n][0]:.4g}"
            lines.append("{}, {}: {}; residuals {:+.1f} to {:+.1f} points, RMS {:.2f}".format(
                name, what, said, rest.min(), rest.max(), math.sqrt(np.mean(rest ** 2))))
    return lines


def rows(table):
    """The rows of the page's table: each flume with h = 2 d, then what it loses with the longer h."""
    said, half = 100 * expected(table), len(table["note"]) // 2
    out = []
    for k, note in enumerate(table["note"][:half]):
        what = f"{table['dimensions'][k]:.0f}-D, {table['depth_m'][k]:g} m{', ' * bool(note)}{note}"
        out.append("| {} | {:.2f} | {:.3g} | {:.0f} | {:.1f} | {:.1f} | {:+.1f} | {:.2f} | {:.1f} | {:.1f} |"
                   .format(what, table["kd"][k], table["height_over_d"][k], table["length_over_d"][k],
                           100 * table["loss"][k], said[k], 100 * table["wavenumber_error"][k],
                           table["height_at_paddle"][k], 100 * table["loss"][k + half],
                           said[k + half]).replace("| -", "| \u2212"))
    return out


@style.look()
def figure(table):
    """Measured loss against that of the formula, and what h = 2 d loses beside the longer h."""
    fig, axes = style.figure(1, 2, (9.0, 4.2))
    said, lost = 100 * expected(table), 100 * table["loss"]
    half = len(lost) // 2
    for k, (n, long, name, here) in enumerate(parts(table)):
        axes[0, 0].plot(said[here], lost[here], style.MARKERS[k], color=style.COLORS[k], label=name)
    most = lost.max() * 1.08
    axes[0, 0].plot([0, most], [0, most], color=style.GREY, linewidth=1)
    axes[0, 0].set(xlabel="formula (% per wavelength)", ylabel="measured (% per wavelength)",
                   xlim=(0, most), ylim=(0, most))
    for n in (2, 3):
        here = table["dimensions"][:half] == n
        axes[0, 1].plot(lost[half:][here], lost[:half][here], style.MARKERS[n], color=style.COLORS[n],
                        label=f"{n}-D")
    axes[0, 1].plot([1, most], [1, most], color=style.GREY, linewidth=1)
    axes[0, 1].set(xlabel="h = 3.5 d, in 3-D 3 d (% per wavelength)", ylabel="h = 2 d (% per wavelength)",
                   xscale="log", yscale="log")
    style.title(axes[0, 0], "Height lost per wavelength")
    for panel in axes[0]:
        panel.legend()
    return fig
