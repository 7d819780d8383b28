"""Scenes of configs/validation, and the scripts of tests/regression/validation for their runs."""

import importlib.machinery
import importlib.util
import json
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT, drawn

import pbf_tools

COMPARE = ROOT / "tests/regression/validation/compare"
SCENES = ROOT / "configs/validation"


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
    assert done.returncode == 2
    assert f"compare: {table} has the gauges a, time; a run of a scene" in done.stderr


@pytest.mark.parametrize("name", ["compare", "rows"])
def test_a_run_or_table_that_is_not_there_is_told_in_one_line(tmp_path, name):
    for path in (tmp_path / "nope", tmp_path / "nope.csv"):
        done = subprocess.run([sys.executable, COMPARE.parent / name, path], capture_output=True,
                              text=True)
        assert done.returncode == 2 and not done.stdout
        assert done.stderr.startswith(f"{name}: ") and done.stderr.count("\n") == 1
        assert str(path) in done.stderr


@pytest.mark.parametrize("text", ["", "time,x090\n", "time,x090\n0,none\n", "time,x090\n0\n1,2\n"])
def test_a_table_without_numbers_is_told_in_one_line(tmp_path, text):
    path = tmp_path / "a.csv"
    path.write_text(text)
    done = compare(path)
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and str(path) in done.stderr


def test_the_wave_of_a_flume_is_read_back_from_a_table(tmp_path):
    t = np.arange(0, 9, 0.01)
    k, omega = 3.549, 2 * np.pi / 1.2
    places = (0.9, 1.3, 1.7, 2.1, 2.5)
    eta = [0.3 + 0.02 * np.exp(-0.1 * x) * np.cos(omega * t - 0.99 * k * x) for x in places]
    path = tmp_path / "a.csv"
    np.savetxt(path, np.column_stack([t, *eta]), "%.7g", ",", comments="",
               header="time," + ",".join(f"x{round(100 * x):03}" for x in places))
    done = compare(path)
    assert "wave number 3.514 1/m, theory 3.549 (-1 %)" in done.stdout
    at = np.exp(-0.1 * 2 * np.pi / k)
    assert f"after a wave length {at:.3f}, theory 1.040" in done.stdout


def script(name):
    """A script of tests/regression/validation, whose name has no .py, as a module."""
    sys.path.insert(0, str(COMPARE.parent))
    try:
        loader = importlib.machinery.SourceFileLoader(f"validation_{name}",
                                                      str(COMPARE.parent / name))
        spec = importlib.util.spec_from_loader(loader.name, loader)
        module = importlib.util.module_from_spec(spec)
        loader.exec_module(module)
        return module
    finally:
        sys.path.pop(0)


@pytest.mark.parametrize("scene", sorted(SCENES.glob("*.yaml")), ids=lambda path: path.stem)
def test_a_plan_of_these_scenes_warns_of_nothing_but_what_they_say_themselves(pbf, scene):
    done = subprocess.run([pbf, "plan", scene, "--json"], capture_output=True, text=True, check=True)
    said = [warning["kind"] for warning in json.loads(done.stdout)["warnings"]]
    said = [kind for kind in said if kind != "wave_settings"]  # advice: tests/unit
    assert said == {"regular_waves_order_1": ["wave_theory"],
                    "waves_over_bar": ["wave_resolution"]}.get(scene.stem, [])


def test_the_theory_beside_waves_is_that_of_its_script(tmp_path):
    script("theory").main([str(tmp_path)])
    written = sorted(path.name for path in tmp_path.iterdir())
    assert written == ["regular_waves_theory.csv", "solitary_run_up_theory.csv"]
    for name in written:
        assert (tmp_path / name).read_text() == (SCENES / name).read_text()


@pytest.mark.parametrize("scene, words", [
    ("regular_waves", ("fluid.spacing=0.03", "time.motion_begin=9", "time.end=0.3")),
    ("solitary_run_up", ("fluid.spacing=0.015", "time.motion_begin=2.6", "time.end=0.6"))])
def test_the_wave_that_a_paddle_is_to_make_is_that_of_the_theory(pbf, tmp_path, scene, words):
    sets = [x for w in (*words, "time.step=0.01", "compare=[]") for x in ("--set", w)]
    subprocess.run([pbf, "run", SCENES / f"{scene}.yaml", "--quiet", "--out", tmp_path / "run",
                    *sets], check=True, capture_output=True)
    told = pbf_tools.read_csv(tmp_path / "run/waves_paddle.csv")
    theory = script("theory")
    eta = theory.regular(0.06, 2, 0.3) if scene == "regular_waves" else theory.solitary(0.045, 0.15)
    names = [name for name in told if name.startswith("eta_")]
    assert len(names) >= 4 and max(np.ptp(told[name]) for name in names) > 0.005
    for name in names:
        x = 3.311 if name == "eta_crest_m" else int(name[5:7]) / 10
        expected = np.array([eta(x, t) for t in told["t"]])
        assert np.allclose(told[name], expected, atol=1e-7), name


def test_the_tables_of_the_page_are_those_of_the_csv():
    rows = script("rows")
    text, found = rows.PAGE.read_text(), rows.read(rows.TABLE)
    assert rows.page(text, found) == text
    changed = [row | {"run": "0.123"} for row in found]
    assert rows.page(text, changed) != text


def test_rows_of_a_new_run_take_the_place_of_those_of_its_scene_and_spacing(tmp_path):
    rows = script("rows")
    old, table = rows.of_run(rows.TABLE), tmp_path / "new.csv"
    new = [["waves_over_bar", "0.005", "G4", "harmonic_1", "m", "0.0123", "0.0126"]]
    rows.write(table, new)
    found = rows.replaced(old, rows.of_run(table))
    assert found[-1] == new[0]
    assert found[:-1] == [row for row in old if row[:2] != new[0][:2]] != old


def test_the_picture_of_waves_is_drawn_from_the_committed_readings(tmp_path):
    done = subprocess.run([sys.executable, COMPARE.parent / "wave_figure.py", tmp_path / "a.png"],
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert drawn(tmp_path / "a.png")


def test_rows_of_a_run_are_what_it_has_compared_and_its_surface(pbf, tmp_path):
    run = tmp_path / "run"
    subprocess.run([pbf, "run", SCENES / "solitary_run_up.yaml", "--quiet", "--out", run, "--set",
                    "fluid.spacing=0.0225", "--set", "time.step=0.009"], check=True,
                   capture_output=True)
    done = subprocess.run([sys.executable, COMPARE.parent / "rows", run, "--csv", tmp_path / "a.csv",
                           "--readings", tmp_path], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    rows = script("rows")
    found = {(r["reading"], r["quantity"]): r for r in rows.read(tmp_path / "a.csv")}
    for name, of in pbf_tools.open(run).compare.items():
        assert float(found[name, "rms"]["run"]) == pytest.approx(of["rms"], rel=1e-3)
        crest = found[name, "crest"]
        assert float(crest["run"]) == pytest.approx(of["peak"] - 0.15, abs=1e-5)
        assert float(crest["data"]) == pytest.approx(0.045, abs=1e-4)
    assert 0.1 < float(found["beach", "run_up_over_depth"]["run"]) < 0.7
    assert float(found["beach", "run_up_over_depth"]["data"]) == pytest.approx(0.550, abs=1e-3)
    assert {name for name, _ in found} >= {"T15", "T20", "T25", "T30"}
    assert (tmp_path / "run_profiles.csv").read_text().startswith("T,x_over_d,run_eta_over_d")
    position = pbf_tools.open(run)["position"][0]
    levels = [rows.waves.surface(position, x, 0.0225) for x in (1.0, 2.5, 3.5)]
    assert np.allclose(levels, 6 * 0.0225, atol=0.00225)  # six whole layers are in 0.15 m
    assert np.isnan(rows.waves.surface(position, 9.0, 0.0225))


def test_rows_refuse_a_run_of_another_scene(minimal):
    done = subprocess.run([sys.executable, COMPARE.parent / "rows", minimal], capture_output=True,
                          text=True)
    assert done.returncode == 2 and f"{minimal} is no finished run of a scene of waves" in done.stderr
