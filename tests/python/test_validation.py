"""tests/regression/validation/compare reads run folders and the CSVs that it writes."""

import subprocess
import sys

from conftest import ROOT

import pbf_tools

COMPARE = ROOT / "tests/regression/validation/compare"


def compare(*arguments):
    return subprocess.run([sys.executable, COMPARE, *arguments], capture_output=True, text=True)


def test_a_run_folder_and_the_csv_written_from_it_give_the_same_figures(pbf, tmp_path):
    coarse = [f"gauges.{k}.radius=0.1" for k in range(4, 12)]
    keys = ["fluid.spacing=0.05", "time.step=0.005", "time.end=0.5", "compare=[]", *coarse]
    run, table, picture = tmp_path / "run", tmp_path / "run.csv", tmp_path / "run.png"
    subprocess.run([pbf, "run", ROOT / "configs/validation/dam_break_over_box.yaml", "--quiet",
                    "--out", run, *(x for k in keys for x in ("--set", k))],
                   check=True, capture_output=True)
    done = compare(run, "--csv", table, "--png", picture)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert lines == [f"{run}:"] and picture.stat().st_size > 10000
    again = compare(table, "--png", tmp_path / "again.png")
    assert again.returncode == 0, again.stderr
    assert (tmp_path / "again.png").stat().st_size > 10000
    data = ROOT / "configs/validation/kleefsman_2005_heights.csv"
    found = pbf_tools.compare_data(run, data, gauge=["H1", "H2", "H3", "H4"], between=(0, 0.45),
                                   program=pbf)
    assert found["H4"]["rms"] < 0.06, "H4 stands in the fluid of the start"


def test_scenes_with_measurements_say_how_to_leave_them_out_of_a_short_run(pbf, tmp_path):
    done = subprocess.run([pbf, "run", ROOT / "configs/validation/sloshing.yaml", "--set",
                           "time.end=0.5", "--out", tmp_path / "run"], capture_output=True, text=True)
    assert done.returncode == 2 and "or leave it out (compare: [])" in done.stderr


def test_a_run_without_gauges_of_an_experiment_is_refused_by_the_names_of_those(tmp_path):
    table = tmp_path / "other.csv"
    table.write_text("time,a\n0,1\n1,2\n")
    done = compare(table)
    assert done.returncode == 1
    assert f"{table} has the gauges a, time; a run of a scene" in done.stderr
