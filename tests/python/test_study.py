"""The errors of motion of `pbf study` against numpy on the logs of `pbf run`, and their plot."""

import csv
import json
import subprocess

import numpy as np
import pytest
from conftest import ROOT, drawn

import pbf_tools
from pbf_tools import plot_study

SCENE = {"fluid.spacing": "0.08", "time.end": "0.4", "viscosity": "off", "render": "off",
         "threads": "1", "gauges": "[{name: H, kind: level, at: [0.2, 0.2]}, "
                                   "{name: Q, kind: flow, center: [0.8, 0.2, 0.5], "
                                   "normal: [1, 0, 0], size: [0.4, 1]}]"}
STEPS = {"0.008": 1, "0.004": 2, "0.002": 10}  # the last is measured every 20 ms, the others 8 ms
FROM = 0.04
COLUMNS = {"energy": "J", "center_of_mass_x": "m", "momentum_x": "kg_m_s", "gauge/H": "m",
           "gauge/Q/total": "kg"}


@pytest.fixture(scope="module")
def study(pbf, tmp_path_factory):
    """A folder with study.yaml and its results in o."""
    folder = tmp_path_factory.mktemp("study")
    settings = ", ".join(f"{key}: {value}" for key, value in SCENE.items())
    errors = ", ".join(f"{{gauge: {c[6:]}}}" if c.startswith("gauge/") else f"{{log: {c}}}"
                       for c in COLUMNS)
    (folder / "study.yaml").write_text(
        f"scene: {ROOT / 'configs/dam_break.yaml'}\nset: {{{settings}, output: off}}\n"
        f"grid:\n  - {{time.step: [{', '.join(STEPS)}], "
        f"measure_every: [{', '.join(map(str, STEPS.values()))}]}}\n"
        f"error: [compression_mean, {errors}]\nfrom: {FROM}\nrepeats: 1\n")
    done = subprocess.run([pbf, "study", "study.yaml", "--out", "o"], cwd=folder, text=True,
                          capture_output=True)
    assert done.returncode == 0, done.stderr
    return folder


def series(run, column):
    """Times and values of a run; what its gauges read."""
    if not column.startswith("gauge/"):
        return run.log["time"], run.log[column]
    name, _, further = column[6:].partition("/")
    gauge = run.gauges[name]
    return gauge.time, getattr(gauge, further or "value")


def test_the_errors_are_those_that_numpy_finds_in_the_logs_of_the_runs(pbf, study):
    runs = []
    for step, every in STEPS.items():
        out = study / f"run_{step}"
        words = [f"--set={k}={v}" for k, v in
                 {**SCENE, "time.step": step, "measure_every": every, "output.every": "0.4"}.items()]
        subprocess.run([pbf, "run", ROOT / "configs/dam_break.yaml", "--quiet", "--out", out, *words],
                       check=True, capture_output=True)
        runs.append(pbf_tools.open(out))
    rows = list(csv.DictReader((study / "o/study.csv").open()))
    assert len(rows) == 3
    told = json.loads((study / "o/study.json").read_text())["motion"]
    for column, unit in COLUMNS.items():
        time, exact = series(runs[-1], column)
        exact, time = exact[time > FROM - 1e-9], time[time > FROM - 1e-9]
        assert len(time) == 19
        rms = []
        for run, row in zip(runs, rows):
            own = np.interp(time, *series(run, column))
            rms.append(np.sqrt(np.mean((own - exact) ** 2)))
            assert float(row[f"{column}_rms_{unit}"]) == pytest.approx(rms[-1], rel=1e-9, abs=1e-12)
            assert float(row[f"{column}_rms_relative"]) == \
                pytest.approx(rms[-1] / np.ptp(exact), rel=1e-9, abs=1e-12)
        assert rms[0] > 0 and rms[2] == 0
        assert rows[0][f"{column}_order"] == "" and rows[2][f"{column}_order"] == ""
        shown = rows[1][f"{column}_order"]
        if rms[1] < rms[0]:
            assert float(shown) == pytest.approx(np.log(rms[0] / rms[1]) / np.log(2), rel=1e-9)
        else:
            assert shown == ""
        part = next(p for p in told if p["column"] == column)
        own = np.interp(time, *series(runs[0], column))
        assert part["rows"][0]["bias"] == pytest.approx(np.mean(own - exact), rel=1e-9)
        assert part["rows"][0]["correlation"] == pytest.approx(np.corrcoef(own, exact)[0, 1])
        assert part["rows"][0]["points"] == 19 and part["rows"][0]["interpolated"] > 5
        assert part["unit"].replace(" ", "_").replace("/", "_") == unit
    assert any(row["energy_order"] for row in rows)


def test_error_against_run_time_is_drawn_for_motion_with_its_unit(tools, study, tmp_path):
    code, out, err = tools("plot-study", study / "o", "--y", "energy_rms_J", "-o",
                           tmp_path / "a.png")
    assert code == 0 and drawn(tmp_path / "a.png")
    assert " J  " in out and "left out: 1 rows" in err  # the reference, whose error is 0
    code, out, _ = tools("plot-study", study / "o", "--y", "gauge/H_rms_relative", "-o",
                         tmp_path / "b.svg")
    assert code == 0 and "gauge/H_rms_relative" in out and " %  " in out
    assert "(%)" in (tmp_path / "b.svg").read_text()
    code, _, err = tools("plot-study", study / "o", "--y", "energy_rms", "-o", tmp_path / "c.png")
    assert code == 2 and "no column energy_rms" in err


def test_the_front_of_the_table_is_that_of_its_first_error_only(tools, tmp_path):
    table = tmp_path / "study.csv"
    lines = ["time.step,seconds_median,compression_mean,energy_rms_J,error,pareto",
             "1,1,0.1,4,energy_rms_J,true", "2,2,0.2,2,energy_rms_J,true",
             "3,3,0.3,3,energy_rms_J,false"]
    table.write_text("\n".join(lines) + "\n")
    first = tools("plot-study", table, "-o", tmp_path / "a.png")
    assert first[0] == 0 and first[1].count("energy_rms_J") == 2
    other = tools("plot-study", table, "--y", "compression_mean", "-o", tmp_path / "b.png")
    assert other[1].count("compression_mean") == 1 and "compression_mean 10 %" in other[1]
    assert tools("plot-study", table, "--y", "compression_mean", "--pareto", "pareto", "-o",
                 tmp_path / "c.png")[1].count("compression_mean") == 2


def test_the_units_of_columns_are_those_that_the_program_writes():
    for name, unit in (("energy_rms_J", "J"), ("gauge/U/x_rms_m_s", "m/s"), ("work_rms_J", "J"),
                       ("momentum_x_rms_kg_m_s", "kg m/s"), ("relative_way_max_rms_h", "h"),
                       ("gauge/P_rms_Pa", "Pa"), ("gauge/Q_rms_kg_s", "kg/s"),
                       ("height_kept_rms", "1"), ("front_rms_lobovsky", "1"), ("seconds_m", "1")):
        assert plot_study.unit_of(name) == unit
