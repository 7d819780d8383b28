"""plot-batch: its points are the rows of the summary; what cannot be drawn is said."""

import re
import subprocess

import numpy as np
import pytest
from conftest import ROOT, drawn

import pbf_tools
from pbf_tools import plot_batch


def summary(folder, **changed):
    """A summary as `pbf batch` writes it: two keys, one run that the guard stopped."""
    lines = ["# units: time=s, seconds=s, energy=J, time.step=s",
             "name,scene,settings,time.step,solver.iterations,exit_code,reason,message,time,"
             "compression_mean,energy,energy_drift,seconds"]
    for dt in (0.004, 0.002):
        for it in (2, 4, 8):
            bad = (dt, it) == (0.004, 2)
            row = {"mean": 0.02 * dt / 0.004 / it, "drift": -0.1 / it, **changed}
            lines.append(f"dam_{dt}_{it},scenes/dam.yaml,time.step={dt} solver.iterations={it},"
                         f"{dt},{it},{3 if bad else 0},{'diverged' if bad else 'finished'},,1,"
                         f"{row['mean']},{60 + it},{row['drift']},{0.002 / dt * it}")
    folder.mkdir(exist_ok=True)
    (folder / "summary.csv").write_text("\n".join(lines) + "\n")
    return folder / "summary.csv"


def points(out):
    """Of the printed lines: (x, y)."""
    return [tuple(map(float, p)) for p in
            re.findall(r"^\S+ ([\d.e-]+)[ \w]*?  \S+ ([\d.e-]+)", out, re.MULTILINE)]


def test_without_options_the_error_is_drawn_against_the_run_time(tools, tmp_path):
    path = summary(tmp_path / "sweep")
    table = pbf_tools.read_csv(path)
    good = table.where(table["reason"] == "finished")
    said = []
    for given in (path, tmp_path / "sweep"):
        code, out, err = tools("plot-batch", given, "-o", tmp_path / "a.png")
        assert code == 0 and drawn(tmp_path / "a.png")
        assert "left out 1 of 6 runs, which did not finish: 1 diverged" in err
        said.append(out)
    assert said[0] == said[1]
    expected = zip(good["seconds"], 100 * good["compression_mean"])
    assert np.allclose(sorted(points(out)), sorted(expected), rtol=1e-5)
    assert "seconds 4 s  compression_mean 0.25 %  time.step 0.002 s, solver.iterations 4" in out


def test_a_column_is_drawn_over_a_swept_key_with_units_and_a_curve_per_other_key(tools, tmp_path):
    path = summary(tmp_path / "sweep")
    code, out, _ = tools("plot-batch", path, "--x", "time.step", "--y", "energy", "-o",
                         tmp_path / "a.svg")
    assert code == 0 and "time.step 0.002 s  energy 64 J  solver.iterations 4" in out
    assert sorted(points(out)) == [(0.002, 62), (0.002, 64), (0.002, 68), (0.004, 64), (0.004, 68)]


@pytest.fixture
def axes(tools, tmp_path, monkeypatch):
    """axes(options...) -> the axes that plot-batch draws."""
    kept = []
    monkeypatch.setattr(plot_batch.style, "save", lambda fig, args: kept.append(fig.axes[0]))

    def call(*words):
        code, _, err = tools("plot-batch", *words)
        assert code == 0, err
        return kept.pop()

    return call


def test_axes_have_labels_units_scales_and_curves(axes, tmp_path):
    path = summary(tmp_path / "sweep")
    a = axes(path)
    assert (a.get_xlabel(), a.get_ylabel()) == ("run time (s)", "mean compression at the end (%)")
    assert a.get_xscale() == a.get_yscale() == "log"
    assert a.get_title(loc="left") == "Error against run time"
    names = [line.get_label() for line in a.lines]
    assert names == ["time.step 0.002 s", "time.step 0.004 s"]
    assert [t.get_text() for t in a.texts if t.get_text() in "248"] == list("24848")
    a = axes(path, "--x", "solver.iterations", "--y", "energy_drift")
    assert (a.get_xlabel(), a.get_ylabel()) == ("solver.iterations", "energy drift")
    assert a.get_xscale() == a.get_yscale() == "linear"
    assert [t.get_text() for t in a.get_xticklabels()] == ["2", "4", "8"]
    a = axes(path, "--x", "time.step", "--log", "--no-percent")
    assert a.get_xlabel() == "time.step (s)" and a.get_xscale() == a.get_yscale() == "log"
    assert max(line.get_ydata().max() for line in a.lines) < 0.01
    a = axes(path, "--log-y", "--series", "solver.iterations")
    assert (a.get_xscale(), a.get_yscale()) == ("linear", "log") and len(a.lines) == 3
    assert axes(path, "--no-log").get_yscale() == "linear"


def test_runs_without_a_swept_key_stand_by_name_and_several_scenes_are_curves(axes, tmp_path):
    head = "name,scene,settings,{}exit_code,reason,compression_mean,seconds\n"
    path = tmp_path / "summary.csv"
    path.write_text(head.format("") + "a,x/a.yaml,,0,finished,0.1,1\n"
                    "b,x/b.yaml,,0,finished,0.2,2\n")
    a = axes(path)
    assert {t.get_text() for t in a.texts} >= {"a", "b"}
    path.write_text(head.format("k,") + "".join(
        f"{s}{k},x/{s}.yaml,k={k},{k},0,finished,0.{k},{k}\n" for s in "ab" for k in (1, 2)))
    assert [line.get_label() for line in axes(path, "--x", "k").lines] == ["a", "b"]
    path.write_text(head.format("solver.method,") + "a,x.yaml,,jacobi,0,finished,0.1,1\n"
                    "b,x.yaml,,chebyshev,0,finished,0.2,2\n")
    a = axes(path, "--x", "solver.method")
    assert [t.get_text() for t in a.get_xticklabels()] == ["chebyshev", "jacobi"]


@pytest.mark.parametrize("words, code, text", [
    (("--x", "iterations"), 2, "no column iterations, did you mean solver.iterations? There are"),
    (("--y", "compresion_mean"), 2, "did you mean compression_mean?"),
    (("--series", "timestep"), 2, "did you mean time.step?"),
    (("--y", "scene"), 2, "column scene is not one of numbers"),
    (("--x", "name", "--log"), 2, "column name is not one of numbers, and has no logarithmic axis"),
    (("--y", "energy_drift", "--log"), 2, "left out 5 of 5 finished runs: in 5 energy_drift is not above 0"),
    (("-o", "a.doc"), 2, "a.doc")], ids=str)
def test_what_cannot_be_drawn_is_one_error(tools, tmp_path, monkeypatch, words, code, text):
    monkeypatch.chdir(tmp_path)
    result, _, err = tools("plot-batch", summary(tmp_path / "sweep"), *words)
    assert result == code and text in err and "Traceback" not in err


def test_a_summary_without_finished_runs_or_a_folder_without_one_says_so(tools, tmp_path):
    path = summary(tmp_path / "sweep")
    path.write_text(path.read_text().replace("finished", "stopped"))
    code, _, err = tools("plot-batch", path, "-o", tmp_path / "a.png")
    assert code == 2 and "no run of this batch has finished" in err and "5 stopped" in err
    code, _, err = tools("plot-batch", tmp_path, "-o", tmp_path / "a.png")
    assert code == 5 and "no summary.csv in this folder" in err
    code, _, err = tools("plot-batch", tmp_path / "none.csv", "-o", tmp_path / "a.png")
    assert code == 5 and "no such batch; name the folder" in err


def test_rows_that_an_axis_cannot_show_are_counted(tools, tmp_path):
    path = summary(tmp_path / "sweep")
    path.write_text(path.read_text().replace(",68,-0.0125,", ",,-0.0125,"))
    code, out, err = tools("plot-batch", path, "--y", "energy", "-o", tmp_path / "a.png")
    assert code == 0 and err.endswith("left out 2 of 5 finished runs: in 2 energy is missing\n")
    assert len(points(out)) == 3


def test_the_summary_that_the_program_writes_is_drawn(tools, pbf, tmp_path):
    subprocess.run([pbf, "batch", ROOT / "configs/minimal.yaml", "--grid", "solver.iterations=2,4",
                    "--grid", "time.step=0.002,0.004", "--set", "time.end=0.04", "--set",
                    "output={}", "--set", "fluid.spacing=0.05", "--out", tmp_path / "sweep"],
                   check=True, capture_output=True)
    code, out, err = tools("plot-batch", tmp_path / "sweep", "-o", tmp_path / "a.png")
    assert code == 0 and not err and drawn(tmp_path / "a.png")
    table = pbf_tools.read_csv(tmp_path / "sweep/summary.csv")
    assert [y for _, y in sorted(points(out))] == pytest.approx(
        [y for _, y in sorted(zip(table["seconds"], 100 * table["compression_mean"]))], rel=1e-4)
    assert plot_batch.swept_keys(table) == ["solver.iterations", "time.step"]
    code, out, _ = tools("plot-batch", tmp_path / "sweep", "--x", "time.step", "--y", "energy",
                         "-o", tmp_path / "b.png")
    assert code == 0 and "time.step 0.002 s  energy " in out and np.all(table["energy"] > 0)
