"""plot-gauges: readings of one and of several runs, over an experiment."""

import subprocess

import numpy as np
import pytest
from conftest import drawn

import pbf_tools
from pbf_tools import style


def test_gauges_are_read_with_their_units_and_drawn_over_an_experiment(gauged, tools, tmp_path):
    run = pbf_tools.open(gauged)
    assert sorted(run.gauges) == ["H", "P", "Q", "U"]
    time, level = run.gauges["H"]
    assert len(time) == 31 and np.allclose(time, 0.01 * np.arange(31))
    assert abs(level[0] - 0.5) < 0.005 and level[-1] < 0.45
    flow, pressure, velocity = (run.gauges[name] for name in "QPU")
    assert flow.unit == "kg/s" and pressure.unit == "Pa" and velocity.value.shape == (31, 3)
    assert np.allclose(np.cumsum(flow.value[1:]) * 0.01, flow.total[1:], atol=1e-9)
    assert np.all(pressure.peak >= pressure.value * (1 - 1e-12)) and pressure.total is None
    assert "x = 0.2 m" in run.gauges["H"].place

    table = tmp_path / "e.csv"
    table.write_text("# measured\nt_s,H_m,wave,word\n"
                     + "".join(f"{t},{y},{2 * y},a\n" for t, y in zip(time, level)))
    code, out, _ = tools("plot-gauges", gauged, "--experiment", table, "--peaks", "-o",
                         tmp_path / "a.png")
    assert code == 0 and drawn(tmp_path / "a.png")
    assert "H: H_m: RMS deviation 0 m, correlation 1.000 over 31 points" in out
    code, out, _ = tools("plot-gauges", gauged, "--gauge", "H", "--experiment", table, "--column",
                         "wave", "--scale", 0.5, "-o", tmp_path / "b.svg")
    assert code == 0 and "H: wave: RMS deviation 0 m" in out
    code, out, _ = tools("plot-gauges", gauged, "--experiment", table, "--column", "H=wave",
                         "--shift", 0.095, "-o", tmp_path / "c.png")
    assert code == 0 and "over 21 points" in out
    for words, wanted in ((("--gauge", "V"), "no gauge V; there are H, P, Q, U"),
                          (("--experiment", table, "--column", "wave"), "say to which"),
                          (("--experiment", table, "--column", "H=x"), "no column x"),
                          (("--experiment", table, "--column", "H=word"), "no numbers"),
                          (("--experiment", table, "--gauge", "U"), "no column is named as a gauge"),
                          (("--column", "H=x"), "give --experiment FILE")):
        code, _, err = tools("plot-gauges", gauged, *words, "-o", tmp_path / "d.png")
        assert code == 2 and wanted in err, (words, err)


def test_plot_gauges_of_a_run_without_gauges_says_so(minimal, tools, tmp_path):
    code, _, err = tools("plot-gauges", minimal, "-o", tmp_path / "a.png")
    assert code == 2 and "no gauges; give the scene some" in err
    assert pbf_tools.open(minimal).gauges == {}


def test_a_gauge_shows_itself_in_one_line_and_a_wrong_name_gets_a_suggestion(gauged):
    gauges = pbf_tools.open(gauged).gauges
    assert repr(gauges["H"]) == "<gauge H: level (m) at x = 0.2 m, y = 0.15 m, 31 readings>"
    with pytest.raises(pbf_tools.UnknownName, match="no gauge h, did you mean H"):
        gauges["h"]


@pytest.fixture
def two(gauged, pbf, tmp_path):
    """The run folders of that dam break and of a finer one without its gauge of the flow."""
    scene = (gauged.parent.parent / "s.yaml").read_text()
    kept = [line for line in scene.splitlines(keepends=True) if "name: Q" not in line]
    (tmp_path / "s.yaml").write_text("".join(kept))
    subprocess.run([pbf, "run", "s.yaml", "--set", "fluid.spacing=0.04", "--quiet", "--out",
                    "fine"], check=True, cwd=tmp_path, capture_output=True)
    return gauged.parent, tmp_path / "fine"


def test_gauges_of_several_runs_share_panels_and_one_legend(two, tools, tmp_path, monkeypatch):
    drawings, save = [], style.save
    monkeypatch.setattr(style, "save", lambda fig, args: (drawings.append(fig), save(fig, args)))
    code, _, err = tools("plot-gauges", *two, "--peaks", "-o", tmp_path / "a.png")
    assert code == 0 and drawn(tmp_path / "a.png")
    assert "not drawn, as not every run has it: Q" in err
    panels = {a.get_title(loc="left"): a for a in drawings[0].axes if a.get_visible()}
    assert list(panels) == ["H", "P", "U"]
    assert [len(panel.lines) for panel in panels.values()] == [2, 4, 6]
    legends = [a.get_legend() for a in drawings[0].axes if a.get_legend()]
    assert len(legends) == 1
    assert [t.get_text() for t in legends[0].get_texts()] == ["run", "fine", "x", "y", "z",
                                                             "peak of an update"]
    for label, run, line in zip(("run", "fine"), two, panels["H"].lines):
        time, level = pbf_tools.open(run).gauges["H"]
        assert np.array_equal(line.get_ydata(), level), label
        assert line.get_color() == style.COLORS[two.index(run)]


def test_every_run_is_compared_with_the_experiment(two, tools, tmp_path):
    time, level = pbf_tools.open(two[0]).gauges["H"]
    (tmp_path / "e.csv").write_text("t,H\n" + "".join(f"{t},{y}\n" for t, y in zip(time, level)))
    code, out, _ = tools("plot-gauges", *two, "--gauge", "H", "--experiment", tmp_path / "e.csv",
                         "-o", tmp_path / "a.png")
    assert code == 0 and "H, run: H: RMS deviation 0 m, correlation 1.000 over 31 points" in out
    assert "H, fine: H: RMS deviation 0.0" in out


def test_gauges_that_runs_do_not_share_are_refused(two, minimal, tools, tmp_path, pbf):
    for runs, words, text in (
            (two, ("--gauge", "Q"), f"{two[1]}: no gauge Q; there are H, P, U"),
            (two, ("--gauge", "h"), f"{two[0]}: no gauge h, did you mean H?"),
            ((two[0], minimal), (), "no gauges; give the scene some")):
        code, _, err = tools("plot-gauges", *runs, *words, "-o", tmp_path / "a.png")
        assert code == 2 and text in err, err
    scene = (tmp_path / "s.yaml").read_text()
    for old, new, text in (("name: H, kind: level, at: [0.2, 0.15]",
                            "name: H, kind: velocity, at: [0.2, 0.15, 0.1]",
                            "gauge H is one of velocity"),
                           ("name: ", "name: other_", "no gauge that all runs have")):
        (tmp_path / "s.yaml").write_text(scene.replace(old, new))
        subprocess.run([pbf, "run", "s.yaml", "--set", "time.end=0.02", "--quiet", "--overwrite",
                        "--out", "other"], check=True, cwd=tmp_path, capture_output=True)
        code, _, err = tools("plot-gauges", two[0], tmp_path / "other", "-o", tmp_path / "a.png")
        assert code == 2 and text in err, err
