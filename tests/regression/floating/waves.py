"""A floating box in the waves of a paddle: heave over wave amplitude, against linear theory."""

import numpy as np

from lab import G, harmonic
from theory import Box, group_speed, wave_number

D, DEPTH, PLACE = 0.02, 0.4, 4.0
BEAM, HEIGHT, DENSITY = 0.4, 0.2, 500
DRAFT = HEIGHT * DENSITY / 1000
AMPLITUDE = 0.03                      # of the waves that the paddle is to make
PERIODS = (0.9, 1.2, 1.6)
KINDS = {"none": None, "heave and surge": "lock: [ry], ", "all free": ""}
CASES = [(period, levels, kind) for period in PERIODS for levels in ("off", "on") for kind in KINDS
         if levels == "off" or kind != "all free"]


def scene(period, kind):
    k = wave_number(2 * np.pi / period, DEPTH)
    stroke = AMPLITUDE * (np.sinh(2 * k * DEPTH) + 2 * k * DEPTH) / (
        2 * (np.cosh(2 * k * DEPTH) - 1))  # of a piston, linear theory
    box = ""
    if kind != "none":
        box = f"""
  - {{name: box, shape: box, center: [{PLACE}, {0.993 * DEPTH - DRAFT + HEIGHT / 2}],
     size: [{BEAM}, {HEIGHT}], free: {{{KINDS[kind]}density: {DENSITY}}}}}"""
    begin, end = window(period)
    return f"""
dimensions: 2
domain: {{min: [-0.2, 0], max: [10, 0.8]}}
fluid: {{spacing: {D}}}
bodies: [{{shape: block, min: [0, 0], max: [10, {DEPTH}]}}]
obstacles:
  - {{name: paddle, shape: box, min: [-0.5, 0], max: [0, 0.8],
     motion: {{kind: sine, direction: [1, 0, 0], amplitude: {stroke:.5f}, period: {period},
     ramp: {period}}}}}
  - {{name: beach, shape: plane, point: [8, 0], normal: [-0.25, 0, 1]}}{box}
gauges: [{{name: level, kind: level, at: [{PLACE}]}}]
settle: {{duration: 2}}
time: {{step: 0.002, end: {end:.3f}}}
measure_every: 10
"""


def window(period):
    """From when the third wave is at the box until the first one is back from the paddle."""
    speed = group_speed(2 * np.pi / period, DEPTH)
    begin = PLACE / speed + 1.5 * period
    return begin, min(begin + 3 * period, 3 * PLACE / speed)


def measure(lab):
    rows, series = [], {}
    box = Box(BEAM, DRAFT, DEPTH)
    for period, levels, kind in CASES:
        omega = 2 * np.pi / period
        begin, end = window(period)
        run = lab.run(scene(period, kind), f"solver.levels={levels}")
        t, z = run.gauges["level"] if kind == "none" else (run.log["time"], run.log["pose/box/z"])
        chosen = (t >= begin) & (t <= end)
        mean, amplitude, rest = harmonic(t[chosen], z[chosen], omega)
        if kind == "none":
            wave = abs(amplitude)
        row = {"period": period, "wave_length": 2 * np.pi / wave_number(omega, DEPTH),
               "levels": levels, "body": kind, "amplitude": abs(amplitude), "rest": rest,
               "over_wave": abs(amplitude) / wave,
               "theory": 1.0 if kind == "none" else box.response(omega),
               "surge": "", "drift": "", "roll": ""}
        if kind != "none":
            x = run.log["pose/box/x"]
            row["surge"] = abs(harmonic(t[chosen], x[chosen], omega)[1])
            row["drift"] = x[-1] - x[0]
        if kind == "all free":
            roll = np.degrees(np.arctan2(run.log["pose/box/turn_xz"], run.log["pose/box/turn_zz"]))
            row["roll"] = abs(harmonic(t[chosen], roll[chosen], omega)[1])
        rows.append(row)
        series[period, levels, kind] = t, z - mean
    lab.table("waves", rows)
    draw(lab, rows, series)


def draw(lab, rows, series):
    axes, save = lab.figure("waves", 2)
    period = PERIODS[1]
    for kind, color in zip(KINDS, ("0.6", "C0", "C3")):
        t, z = series[period, "off", kind]
        axes[0].plot(t, 1000 * z, color=color,
                     label="water, without the box" if kind == "none" else f"box, {kind}")
    axes[0].set(xlabel="time, s", ylabel="height, mm", title=f"period {period} s")
    axes[0].set_ylim(-70, 95)
    axes[0].axvspan(*window(period), color="0.93", zorder=0)
    axes[0].legend(fontsize=8, loc="upper left")
    periods = np.linspace(0.7, 2.5, 60)
    lengths = [2 * np.pi / wave_number(2 * np.pi / p, DEPTH) for p in periods]
    box = Box(BEAM, DRAFT, DEPTH)
    axes[1].plot(lengths, [box.response(2 * np.pi / p) for p in periods], "k",
                 label="linear theory")
    for kind, levels, mark in (("heave and surge", "off", "o"), ("all free", "off", "x"),
                               ("heave and surge", "on", "+")):
        shown = [r for r in rows if r["body"] == kind and r["levels"] == levels]
        axes[1].plot([r["wave_length"] for r in shown], [r["over_wave"] for r in shown], mark,
                     label=kind + (", levels on" if levels == "on" else ""))
    axes[1].set(xlabel="wave length, m", ylabel="heave / wave amplitude", ylim=(0, None))
    axes[1].legend(fontsize=8)
    save()
