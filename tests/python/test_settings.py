"""configs/SETTINGS.md: its tables are those of the CSV, which was measured with today's scenes and
defaults, and every scene of the gallery says which row it follows."""

import argparse
import csv
import json
import re
import subprocess
import sys

import pytest
from conftest import ROOT

yaml = pytest.importorskip("yaml")
FOLDER = ROOT / "tests/regression/settings"
sys.path.insert(0, str(FOLDER))
import figures  # noqa: E402
import measure  # noqa: E402
import page  # noqa: E402
import rows  # noqa: E402
import table  # noqa: E402

MEASURED = FOLDER / "settings_nvidia_h200.csv"
SMALL = """rows:
  - name: pool
    title: Pool
    advice: Still.
    cases:
      - name: small
        scene: pool.yaml
        text: a pool
        starts: [2, 1]
        settings: [{name: default, set: {}}, {name: "2", set: {solver.iterations: 2}}]
        reduced: {time.end: 0.02}
        figures:
          - {name: rise, unit: "%", log: energy_rise, as: max, factor: 100, bounds: [0, 9], reduced_bounds: [0, 9]}
          - {name: steps, call: iterations_per_second, bounds: [1, 2], reduced_bounds: [1600, 1600]}
"""


@pytest.fixture(scope="module")
def every():
    return rows.read(FOLDER / "settings.yaml")


@pytest.fixture
def small(pbf, tmp_path):
    """small(*options) -> a finished `run` of one row, whose scene and rows are copies."""
    text = (ROOT / "configs/minimal.yaml").read_text().replace("spacing: 0.02", "spacing: 0.05")
    (tmp_path / "pool.yaml").write_text(text.replace("end: 0.5", "end: 0.04") + "output: {}\n")
    (tmp_path / "rows.yaml").write_text(SMALL)

    def call(*options):
        return subprocess.run([sys.executable, "-B", FOLDER / "run", pbf, tmp_path / "out.csv", "--rows",
                               tmp_path / "rows.yaml", *options], capture_output=True, text=True)

    return call


def test_the_tables_of_the_page_are_those_of_the_csv(every):
    text = page.between(page.PAGE.read_text())
    lines = table.read(MEASURED)
    assert text == page.tables(every, lines, MEASURED.name)
    assert text != page.tables(every, [{**lines[0], "value": "123"}, *lines[1:]], MEASURED.name)


def test_every_scene_and_default_is_the_one_that_was_measured(every, pbf):
    assert table.changed(table.read(MEASURED), every, pbf) == []


def test_every_advised_figure_is_within_its_bounds(every):
    lines = table.read(MEASURED)
    assert table.out_of_bounds(lines, every) == []
    bounded = [f for r in every for c in r.cases for f in c.figures if f.bounds]
    assert len(bounded) >= 2 * len(every)
    for row in every:
        assert any(f.bounds for c in row.cases for f in c.figures), row.name


def test_a_changed_scene_or_default_names_the_row_and_the_command(small, pbf, tmp_path):
    assert small().returncode == 1  # the second bounds are wrong on purpose
    every, lines = rows.read(tmp_path / "rows.yaml"), table.read(tmp_path / "out.csv")
    assert table.changed(lines, every, pbf) == []
    scene = tmp_path / "pool.yaml"
    text = scene.read_text()
    scene.write_text("# a comment\n" + text)
    assert table.changed(lines, every, pbf) == []
    scene.write_text(text.replace("spacing: 0.05", "spacing: 0.04"))
    told = table.changed(lines, every, pbf)
    assert len(told) == 2 and "row pool, case small, setting 'default'" in told[0]
    assert "tests/regression/settings/run PBF OUT.csv" in told[0] and "--only pool" in told[0]
    scene.write_text(text)
    told = table.changed([{**line, "defaults_sha256": "0"} for line in lines], every, pbf)
    assert len(told) == 1 and "defaults of configs/keys.md have changed since pool was" in told[0]
    told = table.changed([x for x in lines if x["setting"] == "default"], every, pbf)
    assert len(told) == 1 and "setting '2': not all of its figures" in told[0]
    done = small("--stamp")
    assert done.returncode == 0 and table.changed(table.read(tmp_path / "out.csv"), every, pbf) == []


def test_the_sha256_of_defaults_changes_with_a_default_and_not_with_its_explanation():
    text = (ROOT / "configs/keys.md").read_text()
    old = rows.defaults_sha256(text)
    line = next(x for x in text.splitlines() if x.startswith("| `smoothing_ratio`"))
    assert rows.defaults_sha256(text.replace(line, line.replace("| `2` |", "| `2.5` |"))) != old
    assert rows.defaults_sha256(text.replace(line, line.rstrip("| ") + " More. |")) == old


def test_a_run_writes_means_and_half_ranges_and_tells_what_is_out_of_bounds(small, tmp_path):
    done = small()
    assert done.returncode == 1
    assert "run: pool/small: steps is 2000" in done.stderr and "bounds [1, 2]" in done.stderr
    with open(tmp_path / "out.csv", newline="") as file:
        lines = list(csv.DictReader(file))
    assert [(x["setting"], x["advice"], x["figure"], x["starts"]) for x in lines] == [
        ("default", "yes", "rise", "2"), ("default", "yes", "steps", "2"),
        ("2", "no", "rise", "1"), ("2", "no", "steps", "1")]
    assert [x["value"] for x in lines[1::2]] == ["2000", "1000"] and lines[1]["scatter"] == "0"
    done = small("--reduced", "--only", "pool")
    assert done.returncode == 1 and "steps is 2000" in done.stderr
    assert len(table.read(tmp_path / "out.csv")) == 2
    done = small("--only", "pond")
    assert done.returncode == 2 and done.stderr == "run: --only pond: the rows are pool\n"


def test_runs_that_are_left_out_are_told_and_end_with_1(small, tmp_path):
    done = small("--reduced", "--seconds", "0")
    assert done.returncode == 1 and table.read(tmp_path / "out.csv") == []
    assert done.stdout == "left out: pool/small/0, start 0\n"
    assert done.stderr == "run: 1 run left out after --seconds 0; --missing goes on\n"


def test_scenes_are_hashed_as_they_are_before_the_first_run(every, monkeypatch, tmp_path):
    told = []
    monkeypatch.setattr(rows, "scene_sha256", lambda *_: told.append("hash") or "0")
    monkeypatch.setattr(rows, "defaults_sha256", lambda *_: told.append("hash") or "0")
    monkeypatch.setattr(measure, "run_of", lambda case, *_: told.append("run") or
                        ([1.0] * len(case.figures), "a", 1.0))
    given = argparse.Namespace(reduced=True, seconds=1e9, jobs=1, pbf="pbf")
    lines, left_out = measure.all_of(every[:1], given, tmp_path)
    assert told == ["hash", "hash", "run"] and lines and left_out == 0


@pytest.mark.parametrize("words, told", [
    (["nope", "out.csv"], "nope: no such program"),
    (["PBF", "nope/out.csv"], "nope/out.csv: there is no folder nope"),
    (["PBF", "out.csv", "--rows", "nope.yaml"], "nope.yaml: No such file or directory"),
    (["PBF", "out.csv", "--rows", "list.yaml"], "list.yaml: has no keys; it needs rows"),
    (["PBF", "out.csv", "--rows", "broken.yaml"], "broken.yaml: while parsing"),
    (["PBF", "other.csv"], "other.csv: is no table of `run`, whose first line is row,case,"),
    (["PBF", "out.csv", "--rows", "scene.yaml"], "pool/small: pbf: error: ")])
def test_what_is_wrong_before_the_runs_is_told_in_one_line(pbf, tmp_path, words, told):
    for name, text in {"list.yaml": "[1]", "broken.yaml": "rows: [", "other.csv": "a,b\n1,2\n",
                       "scene.yaml": SMALL}.items():
        (tmp_path / name).write_text(text)
    done = subprocess.run([sys.executable, "-B", FOLDER / "run",
                           *(str(pbf) if w == "PBF" else w for w in words)], cwd=tmp_path,
                          capture_output=True, text=True)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.startswith(f"run: {told}") and done.stderr.count("\n") == 1


def test_a_run_that_fails_has_its_reason_in_place_of_its_figures(small, tmp_path):
    text = (tmp_path / "rows.yaml").read_text()
    (tmp_path / "rows.yaml").write_text(text.replace(
        "{solver.iterations: 2}", "{time.step: 0.02, time.end: 1, measure_every: 1, "
        "solver.iterations: 1, solver.sor: 2}"))
    small()
    lines = table.read(tmp_path / "out.csv")[2:]
    assert [x["value"] for x in lines] == ["stopped by the guard"] * 2
    assert lines[0]["device"] and lines[0]["scatter"] == ""
    assert page.shown(lines[0]) == "stopped by the guard"


def test_reasons_name_the_exit_code_and_how_many_starts_have_failed(every):
    said = measure.reason(5, "a\npbf: error: disk is full; make room\n")
    assert said == "failed with 5: disk is full"
    assert measure.reason(-9, "") == "failed with -9: no message"
    case = every[0].cases[0]
    runs = [([1.0] * len(case.figures), "GPU", 1.0), (said, "", 2.0)]
    lines = list(table.lines_of(case, 0, case.settings[0], runs, "0", "0"))
    assert {x["value"] for x in lines} == {"failed with 5: disk is full in 1 of 2 starts"}
    assert lines[0]["device"] == "GPU" and "disk is full in 1 of 2" in page.block(case, lines)[4]
    assert any("is failed with 5" in text for text in table.out_of_bounds(lines, every[:1]))


def test_a_run_of_what_is_missing_leaves_the_other_lines_as_they_are(small, tmp_path):
    small()
    out = tmp_path / "out.csv"
    lines = table.read(out)
    marked = [{**line, "device": "other"} for line in lines]
    table.write(out, marked)
    assert small("--missing").stdout == "" and table.read(out) == marked
    table.write(out, marked[:2])
    assert re.fullmatch(r"pool/small/1, start 0: .*\n", small("--missing").stdout)
    assert [x["device"] == "other" for x in table.read(out)] == [True, True, False, False]
    table.write(out, [{**line, "starts": "1"} for line in marked])
    assert small("--missing").stdout.count("pool/small/0, start") == 2
    assert [x["device"] == "other" for x in table.read(out)] == [False, False, True, True]


@pytest.mark.parametrize("old, new, told", [
    ("title: Pool", "titel: Pool", "titel: unknown key; there are advice, cases, name, title"),
    ("text: a pool\n", "\n", "pool/small: text is missing"),
    ("log: energy_rise", "lag: energy_rise", "rise: a figure has a name and one of log, gauge"),
    ("as: max, factor", "as: max, form: 1, factor", "small: rise: form: unknown key; there are add, as"),
    ("as: max, factor", "factor", "pool/small: rise: as is missing"),
    ("call: iterations_per_second", "call: iterations", "steps: call: iterations: there are iterat"),
    ("call: iterations_per_second", "call: iterations_per_second, at: 1", "steps: at: unknown key"),
    ("bounds: [0, 9], reduced", "bounds: [9, 0], reduced", "rise: bounds is [LOW, HIGH]"),
    ("settings: [{name: default, set: {}}", "settings: [{name: default, sets: {}}", "sets: unknown key"),
    ("reduced: {time.end: 0.02}", "", "no case has a reduced form")])
def test_mistakes_in_the_rows_are_named(tmp_path, old, new, told):
    assert old in SMALL
    (tmp_path / "rows.yaml").write_text(SMALL.replace(old, new))
    with pytest.raises(rows.Wrong, match=re.escape(told)):
        rows.read(tmp_path / "rows.yaml")


def test_values_are_shown_as_far_as_their_scatter_lets_them_be_known():
    def shown(value, scatter):
        return page.shown({"value": value, "scatter": scatter})
    assert shown("0.04412", "0.0021") == "0.0441 ± 0.0021"
    assert shown("12.345", "1.2") == "12.3 ± 1.2" and shown("-0.0001", "0.4") == "0.00 ± 0.40"
    assert shown("-3.456", "0") == "−3.46" and shown("1600", "0") == "1600"
    assert shown("stopped by the guard", "") == "stopped by the guard"
    assert shown("57.3", "12") == "57 ± 12"


def test_a_standing_wave_of_known_decay_is_measured():
    import numpy as np
    t = np.arange(0, 4.2, 0.02)
    period = 2 * np.pi / np.sqrt(9.81 * np.pi * np.tanh(0.3 * np.pi)) * 0.98
    x = 0.5 + 0.02 * 0.9 ** (t / period) * np.cos(2 * np.pi * t / period)
    run = type("Run", (), {"log": {"time": t, "center_of_mass_x": x}})
    found = {of: figures.standing(run, 0, of, 1, 0.3) for of in ("first", "later", "period")}
    assert found["first"] == pytest.approx(0.9, abs=0.005)
    assert found["later"] == pytest.approx(0.9, abs=0.005)
    assert found["period"] == pytest.approx(0.98, abs=0.003)


def test_every_scene_of_the_gallery_has_the_settings_of_its_row_or_says_why_not(every, pbf):
    gallery = (ROOT / "configs/README.md").read_text().partition("## Gallery")[2].partition("\nRun ")[0]
    scenes = re.findall(r"\*\*\[\w+\]\((\w+\.yaml)\)\*\*", gallery)
    assert len(scenes) >= 12
    for name in scenes:
        head = (ROOT / "configs" / name).read_text().partition("\nname:")[0]
        said = re.findall(r"^# settings: (\w+)(.*)$", head, re.MULTILINE)
        assert len(said) == 1, name
        row, why = said[0]
        if row == "none":
            assert len(why) > 15, name
            continue
        assert same_settings(pbf, every, ROOT / "configs" / name, row) == [], name


def same_settings(pbf, every, path, row):
    """What a scene has otherwise than the advised setting of its row: keys, and the row of its plan."""
    case = next(r.cases[0] for r in every if r.name == row)

    def plan(scene, *words):
        return subprocess.run([pbf, "plan", scene, *words], capture_output=True, text=True,
                              check=True).stdout

    told = json.loads(plan(path, "--json"))["settings_row"]
    ours = yaml.safe_load(plan(path, "--resolved"))
    theirs = yaml.safe_load(plan(case.scene, "--resolved", *case.words(0)))
    keys = [("solver", "iterations"), ("solver", "substeps"), ("solver", "levels"),
            ("fluid", "smoothing_ratio")]
    return [f"{block}.{key}" for block, key in keys if ours[block][key] != theirs[block][key]] + \
        [f"settings_row {told}"] * (told != row)


def test_a_scene_that_is_not_as_its_row_advises_is_told_by_its_keys(every, pbf):
    path = ROOT / "configs/dam_break.yaml"
    assert same_settings(pbf, every, path, "dam_break") == ["solver.iterations", "solver.substeps"]
    assert same_settings(pbf, every, path, "waves") == [
        "solver.iterations", "solver.substeps", "solver.levels", "settings_row dam_break"]


def test_every_row_has_a_heading_that_the_front_page_and_the_scenes_lead_to(every):
    assert "(configs/SETTINGS.md)" in (ROOT / "README.md").read_text().partition("## How fast")[0]
    assert "(SETTINGS.md" in (ROOT / "configs/README.md").read_text()
    headings = re.findall(r"^## (.*)$", page.PAGE.read_text(), re.MULTILINE)
    assert [r.title for r in every] == headings[:len(every)]


@pytest.mark.parametrize("scene, row", [("tank_at_rest", "still_tank"), ("wave_maker", "waves"),
                                        ("sloshing_tank", "sloshing"), ("dam_break", "dam_break"),
                                        ("validation/dam_break_over_box", "impact_loads"),
                                        ("stirrer", None)])
def test_the_plan_names_the_row_of_a_scene(every, pbf, scene, row):
    path = ROOT / f"configs/{scene}.yaml"
    plan = [subprocess.run([pbf, "plan", path, *how], capture_output=True, text=True, check=True).stdout
            for how in ([], ["--json"])]
    assert json.loads(plan[1])["settings_row"] == row
    titles = [r.title for r in every if r.name == row]
    said = re.findall(r'settings for such scenes: "(.*)" of configs/SETTINGS.md', plan[0])
    assert said == titles and len(said) == (row is not None)
