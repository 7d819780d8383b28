"""Figures of a run, as settings.yaml names them:

{log: COLUMN, as: mean, from: 2}    mean, max, min, last of a column of the log, from a time on (s)
{gauge: NAME, as: max}              the same of a gauge
{compare: NAME, of: rms, over: peak_data}   a result of `compare`, divided by another one
{call: FUNCTION, ...}               a function of this file, with the other keys as arguments

`factor` and then `add` are applied to all of them.
"""

import re

import numpy as np
from pbf_tools import waves

TAKE = {"mean": np.mean, "max": np.max, "min": np.min, "last": lambda x: x[-1]}


def value(run, source, seconds):
    """The number of a run; `seconds` is what its process took."""
    rest = {k: v for k, v in source.items() if k not in ("factor", "add")}
    if "call" in rest:
        number = FUNCTIONS[rest.pop("call")](run, seconds=seconds, **rest)
    elif "compare" in rest:
        found = run.compare[rest["compare"]]
        number = found[rest["of"]] / (found[rest["over"]] if "over" in rest else 1)
    else:
        time, read = (run.log["time"], run.log[rest["log"]]) if "log" in rest else \
            run.gauges[rest["gauge"]]
        kept = np.asarray(time) >= rest.get("from", -np.inf)
        number = TAKE[rest["as"]](np.asarray(read)[kept])
    return float(number) * source.get("factor", 1) + source.get("add", 0)


def key(run, name):
    """A number of the solver or the time from the resolved scene."""
    return float(re.search(rf"^  {name}: (\S+)", run.info["resolved_scene"], re.MULTILINE)[1])


def iterations_per_second(run, seconds):
    """Passes over pairs per simulated second, what a run costs on any machine."""
    return key(run, "iterations") * key(run, "substeps") / key(run, "step")


def energy_kept(run, seconds, at):
    """Share of the energy that the start could lose which is left at a time, work included."""
    log, rest = run.log, run.info["energy_at_rest"]
    energy = np.interp(at, log["time"], log["energy"])
    work = np.interp(at, log["time"], log["work"]) if "work" in log else 0
    return (energy - rest) / (log["energy"][0] - rest + work)


def particles_per_second(run, seconds):
    """Particles in frames that a second of the run's process gives, its start included."""
    return len(run.times) * run.info["particles"] / seconds


def along(run, seconds, of, depth, period, between):
    """Regular waves along the gauges: `loss` per wavelength, `k` over theory, `height` at the paddle
    (m), `second` harmonic over first, mean over the gauges. `between`: window, as far as the run
    goes (s)."""
    gauges = sorted((g for g in run.gauges if g[0] == "x"), key=lambda name: float(name[1:]))
    places = [float(g[1:]) / 100 for g in gauges]
    readings = [run.gauges[g] for g in gauges]
    window = between[0], min(between[1], readings[0].time[-1])
    found = waves.along(readings, places, depth, period, between=window)
    if of == "height":
        fit = np.polyfit(places, np.log(found.table["height"]), 1)
        return np.exp(fit[1])
    return {"loss": found.loss, "k": found.wavenumber / found.theory,
            "second": np.mean(found.table["second"])}[of]


def crest(run, seconds, gauge, depth):
    """Height of the highest crest at a gauge above the still level, m."""
    return np.max(run.gauges[gauge].value) - depth


def standing(run, seconds, of, length, depth):
    """A standing wave of the first mode that is released at rest, from the centre of mass: `first`,
    the share of its height that is left after one period, `later`, that of each later one, and
    `period` over linear theory."""
    t, x = run.log["time"], run.log["center_of_mass_x"] - length / 2
    theory = float(2 * np.pi / np.sqrt(9.81 * np.pi / length * np.tanh(np.pi * depth / length)))
    tops = [(0.0, abs(x[0]))]
    sign = np.sign(x[0])
    for k in range(1, int(t[-1] / theory + 0.25) + 1):  # the top nearest to every whole period
        near = np.flatnonzero(abs(t - k * theory) < 0.25 * theory)
        best = near[np.argmax(sign * x[near])]
        around = slice(max(best - 3, 0), best + 4)
        a, b, c = np.polyfit(t[around] - t[best], sign * x[around], 2)
        tops.append((t[best] - b / (2 * a), c - b * b / (4 * a)))
    times, heights = np.array(tops).T
    if of == "period":
        return np.polyfit(np.arange(len(times)), times, 1)[0] / theory
    return heights[1] / heights[0] if of == "first" else \
        (heights[-1] / heights[1]) ** (1 / (len(heights) - 2))


FUNCTIONS = {f.__name__: f for f in (iterations_per_second, energy_kept, particles_per_second, along,
                                     crest, standing)}
