"""What has no value to draw is told: columns and gauges that are nan, in part or all over."""

import subprocess

import numpy as np
import pytest
from conftest import drawn

import pbf_tools
from pbf_tools import style

SCENE = """
domain: {min: [0, 0, 0], max: [1, 0.3, 0.6]}
fluid: {spacing: 0.05}
bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.3, 0.5]}]
obstacles: [{name: post, shape: box, min: [0.9, 0, 0], max: [1, 0.3, 0.1]}]
gauges:
  - {name: far, kind: velocity, at: [0.6, 0.15, 0.58]}
  - {name: front, kind: velocity, at: [0.7, 0.15, 0.05]}
  - {name: H, kind: level, at: [0.2, 0.15]}
time: {step: 0.002, end: 0.4}
output: {every: 0.1, gauges_every: 0.02}
"""


@pytest.fixture(scope="module")
def gapped(pbf, tmp_path_factory):
    """A run of a scene with an obstacle, and with gauges that fluid reaches late or never."""
    folder = tmp_path_factory.mktemp("gaps")
    (folder / "wave.yaml").write_text(SCENE)
    subprocess.run([pbf, "run", "wave.yaml", "--quiet", "--out", "run"], check=True, cwd=folder,
                   capture_output=True)
    return folder / "run"


@pytest.fixture
def figures(monkeypatch):
    kept, save = [], style.save
    monkeypatch.setattr(style, "save", lambda fig, args: (kept.append(fig), save(fig, args)))
    return kept


def test_a_column_of_the_log_without_a_value_is_told_with_the_reason(gapped, tools, tmp_path):
    rows = len(pbf_tools.open(gapped).log)
    code, out, err = tools("plot-log", gapped, "front_x", "height_kept", "-o", tmp_path / "a.png")
    assert code == 0 and out.startswith("front_x, wave: ")
    assert err == (f"pbf_tools: note: height_kept, wave: nothing to draw, nan in all {rows} rows; "
                   "only a pool has it: gravity along an axis, walls on all sides, no obstacles, "
                   "no tank_motion\n")
    (tmp_path / "log.csv").write_text("time,a,b\n0,1,2\n1,,3\n2,3,4\n")
    code, _, err = tools("plot-log", tmp_path / "log.csv", "a", "b", "-o", tmp_path / "a.png")
    assert code == 0 and err == "pbf_tools: note: a, log: nan in 1 of 3 rows\n"


def test_a_gauge_without_fluid_is_told_with_the_number_of_readings(gapped, tools, tmp_path):
    code, _, err = tools("plot-gauges", gapped, "-o", tmp_path / "a.png")
    front = int(np.isnan(pbf_tools.open(gapped).gauges["front"].value[:, 0]).sum())
    assert code == 0 and 2 < front < 19
    notes = err.splitlines()
    assert len(notes) == 2 and all("no particle was within reach of this gauge (its key within, by" in n for n in notes)
    assert "note: far, wave: nothing to draw, nan in all 21 readings" in notes[0]
    assert f"note: front, wave: nan in {front} of 21 readings" in notes[1]


def test_measured_values_without_a_number_are_told_those_with_gaps_not(gapped, tools, tmp_path):
    rows = "".join(f"{0.02 * k},{'' if k == 3 else 0.5},,\n" for k in range(12))
    (tmp_path / "e.csv").write_text("t,H,none,H_mm\n" + rows)
    words = ("plot-gauges", gapped, "--gauge", "H", "--experiment", tmp_path / "e.csv", "-o",
             tmp_path / "a.png")
    code, out, err = tools(*words)
    assert code == 0 and "H: H: " in out and "over 11 points" in out and out.count("RMS") == 1
    assert err == ("pbf_tools: note: H, measured (H_mm): nothing to draw, nan in all 12 rows\n")
    code, out, err = tools(*words, "--column", "H=none")
    assert code == 2 and "column none holds no number" in err and not out


def test_a_batch_says_which_column_is_missing_and_why(pbf, tools, tmp_path):
    (tmp_path / "wave.yaml").write_text(SCENE)
    subprocess.run([pbf, "batch", tmp_path / "wave.yaml", "--grid", "solver.iterations=2,4",
                    "--set", "time.end=0.02", "--quiet", "--out", tmp_path / "sweep"], check=True,
                   capture_output=True)
    code, _, err = tools("plot-batch", tmp_path / "sweep", "--x", "solver.iterations", "--y",
                         "height_kept", "-o", tmp_path / "a.png")
    assert code == 2 and "nothing to draw, left out 2 of 2 finished runs: in 2 height_kept is " \
        "missing; only a pool has it" in err
    path = tmp_path / "sweep/summary.csv"
    header = path.read_text().splitlines()[1].split(",")
    lines = path.read_text().splitlines()
    cells = lines[2].split(",")
    cells[header.index("height_kept")] = "1.5"
    path.write_text("\n".join([*lines[:2], ",".join(cells), lines[3]]) + "\n")
    code, out, err = tools("plot-batch", path, "--x", "solver.iterations", "--y", "height_kept",
                           "-o", tmp_path / "a.png")
    assert code == 0 and out.startswith("solver.iterations 2  height_kept 1.5")
    assert "left out 1 of 2 finished runs: in 1 height_kept is missing; only a pool" in err


def test_one_reading_is_drawn_as_a_point_without_a_warning(pbf, tools, figures, tmp_path, recwarn):
    """As of a run that has only begun."""
    (tmp_path / "wave.yaml").write_text(SCENE)
    subprocess.run([pbf, "run", "wave.yaml", "--set", "time.end=0.004", "--set",
                    "output.gauges_every=0.004", "--quiet", "--out", "run"], check=True,
                   cwd=tmp_path, capture_output=True)
    import h5py
    with h5py.File(tmp_path / "run/run.vtkhdf", "r+") as file:
        for group in ("pbf/gauges", "pbf/log"):
            file[group].visititems(
                lambda _, d: d.resize(1, axis=0) if isinstance(d, h5py.Dataset) else None)
    for words in (("plot-gauges", "--gauge", "H"), ("plot-log", "front_x")):
        code, _, _ = tools(words[0], tmp_path / "run", *words[1:], "-o", tmp_path / "a.png")
        assert code == 0 and drawn(tmp_path / "a.png")
        assert figures.pop().axes[0].lines[0].get_marker() == "o"
    assert not [str(w.message) for w in recwarn.list]


def test_the_name_of_a_gauge_among_columns_leads_to_plot_gauges(gapped, tools, tmp_path):
    code, _, err = tools("plot-log", gapped, "H", "-o", tmp_path / "a.png")
    assert code == 2 and "H is a gauge, which is not in the log; draw it with plot-gauges" in err


@pytest.mark.parametrize("command, rows, code, text", [
    (("plot-energy",), "0,1,2,3\n1,,2,3\n2,1,1,3\n", 0,
     "note: {}: left out 1 of 3 rows, which have no kinetic_energy"),
    (("plot-energy",), "0,,2,3\n1,1,,3\n", 2,
     "{}: nothing to draw, left out 2 of 2 rows, which have no kinetic_energy, potential_energy"),
    (("plot-energy",), "0,a,2,3\n1,b,3,3\n", 2, "{}: column kinetic_energy is not one of numbers"),
    (("plot-front", "--width", 1, "--height", 1), "0,1,2,1\n0.1,1,1,\n0.2,1,1,1.2\n0.3,1,1,1.4\n",
     0, "note: {}: left out 1 of 4 rows, which have no front_x"),
    (("plot-front", "--width", 1, "--height", 1), "0,1,2,\n1,2,1,\n", 2, "{}: nothing to draw"),
    (("plot-log", "front_x"), "0,1,2,a\n1,2,1,b\n", 2, "{}: column front_x is not one of numbers")],
    ids=str)
def test_tables_with_gaps_or_texts_in_other_plots(tools, tmp_path, recwarn, command, rows, code,
                                                  text):
    path = tmp_path / "log.csv"
    path.write_text("time,kinetic_energy,potential_energy,front_x\n" + rows)
    done, out, err = tools(command[0], path, *command[1:], "-o", tmp_path / "a.png")
    assert done == code and text.format(path) in err and err.count("\n") == 1
    assert "nan" not in out and (tmp_path / "a.png").exists() == (code == 0)
    assert not [str(w.message) for w in recwarn.list]
