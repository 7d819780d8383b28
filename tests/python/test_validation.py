"""tests/regression/validation/compare reads run folders and the CSVs that it writes."""

import subprocess
import sys

from conftest import ROOT

COMPARE = ROOT / "tests/regression/validation/compare"


def compare(*arguments):
    return subprocess.run([sys.executable, COMPARE, *arguments], capture_output=True, text=True)


def test_a_run_folder_and_the_csv_written_from_it_give_the_same_figures(pbf, tmp_path):
    coarse = [f"gauges.{k}.radius=0.1" for k in range(4, 12)]
    keys = ["fluid.spacing=0.05", "time.step=0.005", "time.end=0.5", *coarse]
    run, table, picture = tmp_path / "run", tmp_path / "run.csv", tmp_path / "run.png"
    subprocess.run([pbf, "run", ROOT / "configs/validation/dam_break_over_box.yaml", "--quiet",
                    "--out", run, *(x for k in keys for x in ("--set", k))],
                   check=True, capture_output=True)
    done = compare(run, "--csv", table, "--png", picture)
    assert done.returncode == 0, done.stderr
    lines = done.stdout.splitlines()
    assert [line.split()[0] for line in lines[2:6]] == ["H1", "H2", "H3", "H4"]
    assert float(lines[5].split()[1]) < 60, "H4 stands in the fluid of the start; mm"
    assert lines[6] == "left out: the readings end before 6 s"
    assert picture.stat().st_size > 10000
    again = compare(table)
    assert again.returncode == 0, again.stderr
    assert again.stdout.splitlines()[1:6] == lines[1:6]


def test_a_run_without_gauges_of_an_experiment_is_refused_by_the_names_of_those(tmp_path):
    table = tmp_path / "other.csv"
    table.write_text("time,a\n0,1\n1,2\n")
    done = compare(table)
    assert done.returncode == 1
    assert f"{table} has the gauges a, time; a run of a scene" in done.stderr
