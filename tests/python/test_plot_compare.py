"""plot-compare: all that a report of `pbf compare` holds is in the picture."""

import json
import subprocess

import numpy as np
import pytest
from conftest import ROOT, drawn

from pbf_tools import style

ROW = {"what": "lambda 1: lambda", "unit": "h^2", "error": 2.0, "rms": 1.0, "relative": 0.5,
       "ulps": None, "tolerance": 1.0, "verdict": "DIFFERS"}
REPORT = {"a": "cpu:double <1>", "b": "cpu:float", "same": False, "stage": "lambda",
          "notes": ["a & b cost $1 and $2"],
          "parts": [{"part": "frozen step", "verdict": "DIFFERS", "finding": "found",
                     "tolerance_source": "why", "rows": [ROW, {**ROW, "verdict": "same"}]},
                    {"part": "short horizon", "verdict": "not judged", "finding": "none",
                     "tolerance_source": "no", "rows": []}],
          "curves": [{"diagram": "title", "curve": "one", "x_label": "update", "y_label": "h",
                      "x": [1, 2, 3, 4], "y": [1e-7, 0, None, 1e-3]}]}


@pytest.fixture
def figures(monkeypatch):
    """The figures that a command saves."""
    saved, save = [], style.save
    monkeypatch.setattr(style, "save", lambda fig, args: (saved.append(fig), save(fig, args)))
    return saved


def texts(fig):
    return [t for axes in fig.axes for t in axes.texts]


def test_every_part_row_and_curve_of_a_comparison_is_drawn(pbf, tools, figures, tmp_path):
    path = tmp_path / "r.json"
    done = subprocess.run([pbf, "compare", ROOT / "configs/minimal.yaml", "--between",
                           "cpu:double,cpu:float", "--set", "fluid.spacing=0.05", "--updates", "8",
                           "--warmup", "5", "--members", "3", "--set-b", "gravity=[0,0,-9.82]",
                           "--report", path, "--quiet"], capture_output=True, check=False, text=True)
    assert done.returncode == 6, done.stderr
    report = json.loads(path.read_text())
    code, out, _ = tools("plot-compare", path, "-o", tmp_path / "a.png")
    assert code == 0 and drawn(tmp_path / "a.png")
    assert out.splitlines()[0] == "DIFFERENT, first in stage predict"
    lines = [t.get_text() for t in texts(figures[0])]
    shown = "\n".join(lines)
    for part in report["parts"]:
        assert f"{part['part']}: {part['verdict']}" in lines
        for row in part["rows"]:
            assert any(line.startswith(row["what"] + " ") and row["verdict"] in line and
                       f"{row['error']:.3g}" in line for line in lines), row
    assert "on B alone: gravity=[0,0,-9.82]" in shown
    curves = {line.get_label(): line for axes in figures[0].axes for line in axes.lines}
    assert set(curves) == {c["curve"] for c in report["curves"]} and len(curves) > 1
    for curve in report["curves"]:
        y = np.array(curve["y"], float)
        assert np.array_equal(curves[curve["curve"]].get_xdata(), curve["x"])
        assert np.array_equal(curves[curve["curve"]].get_ydata()[y > 0], y[y > 0])


def test_rows_that_differ_are_red_and_what_is_no_number_is_left_out(tools, figures, tmp_path):
    (tmp_path / "r.json").write_text(json.dumps(REPORT))
    code, out, _ = tools("plot-compare", tmp_path / "r.json", "-o", tmp_path / "a.png")
    assert code == 0 and out.startswith("DIFFERENT, first in stage lambda")
    rows = [t for t in texts(figures[0]) if t.get_text().startswith("lambda 1")]
    assert [r.get_text().split()[-1] for r in rows] == ["DIFFERS", "same"]
    assert [r.get_bbox_patch() is not None for r in rows] == [True, False]
    assert rows[0].get_text().split()[3:8] == ["2", "1", "0.5", "-", "1"]
    assert "a & b cost $1 and $2" in [t.get_text() for t in texts(figures[0])]
    (line,) = [line for axes in figures[0].axes for line in axes.lines]
    assert np.isnan(line.get_ydata()).tolist() == [False, True, True, False]
    same = {**REPORT, "same": True, "stage": "", "curves": []}
    (tmp_path / "r.json").write_text(json.dumps(same))
    code, out, _ = tools("plot-compare", tmp_path / "r.json", "-o", tmp_path / "b.svg")
    assert code == 0 and out.startswith("same: every difference is within its tolerance")
    assert len(figures[1].axes) == len(figures[0].axes) - 1


@pytest.mark.parametrize("text", ["", "{", "[]", "3", "{\"a\": 1}", "\xff\xfe"])
def test_a_file_that_is_no_report_is_refused(tools, tmp_path, text):
    (tmp_path / "r.json").write_text(text, encoding="latin-1")
    code, _, err = tools("plot-compare", tmp_path / "r.json", "-o", tmp_path / "a.png")
    assert code == 2 and "r.json: is no report of pbf compare" in err and "--report" in err
    assert not (tmp_path / "a.png").exists()


def test_a_report_that_is_not_there_is_said_and_none_is_overwritten(tools, tmp_path):
    code, _, err = tools("plot-compare", tmp_path / "none.json")
    assert code == 5 and "none.json: cannot be read: No such file" in err
    (tmp_path / "r.json").write_text(json.dumps(REPORT))
    code, _, err = tools("plot-compare", tmp_path / "r.json", "-o", tmp_path / "r.json")
    assert code == 2 and "would overwrite" in err
