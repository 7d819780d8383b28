"""Sweeps from Python: batch and read_batch."""

import json
import pickle
import subprocess

import numpy as np
import pytest
from conftest import DIVERGES

import pbf_tools
from pbf_tools import scene_text

pytestmark = pytest.mark.usefixtures("here")


def test_a_batch_of_a_grid_gives_a_table_of_runs(scene):
    table = pbf_tools.batch(scene, {"solver.iterations": [2, 4], "time__step": np.array([.004, .002])},
                            "out/sweep", jobs=2, time={"end": 0.1})
    assert isinstance(table, pbf_tools.Table) and len(table) == 4
    assert set(table["reason"]) == {"finished"} and np.all(table["exit_code"] == 0)
    assert [run.status for run in table.runs] == ["finished"] * 4
    assert list(table["particles"]) == [run.info["particles"] for run in table.runs]
    for row, run in zip(table["compression_mean"], table.runs):
        assert row == pytest.approx(run.log["compression_mean"][-1])
    assert pickle.loads(pickle.dumps(table)).out == table.out
    stamp = table.runs[0].path.stat().st_mtime_ns
    again = pbf_tools.batch(scene, {"solver.iterations": [2, 4], "time.step": [.004, .002]},
                            "out/sweep", time={"end": 0.1})
    assert again.runs[0].path.stat().st_mtime_ns == stamp
    for path in ("out/sweep", "out/sweep/summary.csv"):
        read = pbf_tools.read_batch(path)
        assert read.csv() == again.csv() and read.units == again.units
        assert [run.status for run in read.runs] == ["finished"] * 4
    with pytest.raises(pbf_tools.FileError, match="no summary.csv in this folder"):
        pbf_tools.read_batch("out")


def test_a_batch_of_several_scenes_names_those_that_fail(scene, tmp_path):
    (tmp_path / "file.yaml").write_text(json.dumps(scene_text.plain(scene, "")))
    with pytest.warns(pbf_tools.PbfWarning, match="1 of 3 runs are not finished.*bad.*diverged"):
        table = pbf_tools.batch([scene, {**scene, **DIVERGES, "name": "bad"}, "file.yaml"], out="o")
    assert table["reason"].tolist() == ["finished", "diverged", "finished"]
    assert table["name"].tolist() == ["small_output=", "bad", "file_output="] and "guard" in table["message"][1]
    assert [run.status for run in table.runs] == ["finished", "diverged", "finished"]
    both = pbf_tools.batch([scene, "file.yaml"], out="p")
    assert both["name"].tolist() == ["small", "file"] and None not in both.runs


@pytest.mark.parametrize("scenes, grid, text", [
    ([], None, "a list of some"), (["a b.yaml"], None, "blanks"), (7, None, "expected a scene"),
    ("s.yaml", {"solver.iterations": 3}, "expected a list of values, got 3"),
    ("s.yaml", {"solver.iterations": "2,4"}, "expected a list of values"),
    ("s.yaml", {"solver.iterations": []}, "is empty"),
    ("s.yaml", {"solver.iteratons": [1]}, "iteratons: unknown key")])
def test_a_batch_that_cannot_be_says_why(scene, tmp_path, scenes, grid, text):
    (tmp_path / "s.yaml").write_text(json.dumps(scene_text.plain(scene, "")))
    (tmp_path / "a b.yaml").touch()
    with pytest.raises(pbf_tools.ToolError) as error:
        pbf_tools.batch(scenes, grid, "out")
    assert error.value.exit_code == 2 and text in str(error.value)


def test_names_of_runs_and_scenes_stay_texts_where_they_are_numbers(scene, pbf, tools, tmp_path):
    for k in ("007", "12"):
        pbf_tools.run({**scene, "name": k}, k, time={"end": 0.02})
    (tmp_path / "list.txt").write_text("007\n12\n")
    subprocess.run([pbf, "batch", "list.txt", "--out", "sweep", "--quiet"], check=True)
    table = pbf_tools.read_batch("sweep")
    assert table["name"].tolist() == table["scene"].tolist() == ["007", "12"]
    assert table["message"].tolist() == ["", ""]
    assert [run.name for run in table.runs] == ["007", "12"]
    code, out, _ = tools("plot-batch", "sweep", "-o", "a.png")
    assert code == 0 and out.splitlines()[0].endswith("  007")


@pytest.mark.parametrize("wrong", [None, 7, ["a.yaml"]])
def test_what_is_no_scene_among_several_is_refused(scene, wrong):
    with pytest.raises(pbf_tools.BadInput, match="expected a scene: a path or a dict, got"):
        pbf_tools.batch([scene, wrong], out="o")


def test_the_folder_of_a_batch_is_called_as_the_program_calls_it(scene):
    pbf_tools.run(scene, "wave.1", output={})
    for given in ("wave.1/run.vtkhdf", "wave.1/scene.resolved.yaml"):
        table = pbf_tools.batch(given, time__end=0.01)
        assert table.out.as_posix() == "out/batch_wave.1" and table["name"].tolist() == ["wave.1"]
