"""app/OUTPUTS.md: the columns and keys that it names are those that the commands write."""

import csv
import json
import re
import subprocess

import pytest
from conftest import ROOT

SCENE = """
domain: {min: [0, 0, 0], max: [0.8, 0.4, 0.4]}
fluid: {spacing: 0.04}
bodies: [{shape: block, min: [0, 0, 0], max: [0.2, 0.2, 0.2]}]
obstacles: [{name: post, shape: box, min: [0.5, 0, 0], max: [0.6, 0.4, 0.4], loads: true}]
time: {step: 0.004, end: 0.1}
output: {every: 0.02}
measure_every: 1
threads: 1
"""
STUDY = """
scene: s.yaml
set: {output: off}
grid: [{solver.iterations: [1, 2]}]
repeats: 1
error: [compression_mean, {log: energy}]
front: {axis: x, length: 0.2, factor: 2, data: [published.csv]}
"""


@pytest.fixture(scope="module")
def written(pbf, tmp_path_factory):
    """A folder with what every command writes: written(words...) runs one more and returns stdout."""
    folder = tmp_path_factory.mktemp("outputs")
    (folder / "configs").symlink_to(ROOT / "configs")
    (folder / "s.yaml").write_text(SCENE)
    (folder / "study.yaml").write_text(STUDY)
    (folder / "published.csv").write_text("T,Z\n0,1\n0.5,1.2\n")

    def call(*words, **environment):
        return subprocess.run([pbf, *words], cwd=folder, check=True, text=True, capture_output=True,
                              env=environment or None).stdout
    call("run", "s.yaml", "--quiet", "--out", "run", "--log-json", "log.jsonl")
    call.folder = folder
    return call


def section(name):
    """The names in code of a section of the page."""
    page = (ROOT / "app/OUTPUTS.md").read_text()
    return page.partition(f"\n## {name}\n")[2].partition("\n## ")[0]


def names(text):
    return re.findall(r"`(\w+)`", text)


def first_cells(text):
    """The names in the first cells of the rows of its tables."""
    return names(" ".join(re.findall(r"^\| ([^|]*) \|", text, re.MULTILINE)))


def header(path):
    with path.open() as file:
        return next(csv.reader(line for line in file if not line.startswith("#")))


def test_the_lines_of_the_log_have_the_keys_of_the_page(written):
    lines = [json.loads(line) for line in (written.folder / "log.jsonl").read_text().splitlines()]
    assert [line["update"] for line in lines] == list(range(26))
    keys, said = list(lines[-1]), names(section("Log JSON"))
    assert keys[:4] == said[:4] == ["update", "time", "wall", "frames"]
    diagnostics = (ROOT / "lib/solver/DIAGNOSTICS.md").read_text()
    for key in keys[4:]:
        assert key in said or f"`{key}`" in diagnostics or f"`{key}_x`" in diagnostics, key
    assert keys[-1] == "stages" and len(lines[0]["momentum"]) == 3
    # Of a line by itself, not since the start: their sum is no more than the whole time.
    assert sum(sum(line["stages"].values()) for line in lines) < 1.5 * lines[-1]["wall"]


def test_the_plan_has_the_keys_of_the_page(written):
    said = first_cells(section("Plan JSON"))
    plan = json.loads(written("plan", "s.yaml", "--json", "--ranks", "2"))
    assert sorted([*plan, "time_measured_on"]) == sorted(said)
    plan = json.loads(written("plan", "s.yaml", "--json", "--set", "gravity=900"))
    assert {*plan["warnings"][0]} == {"kind", "text"}


def test_the_summary_of_a_batch_has_the_columns_of_the_page(written):
    written("batch", "s.yaml", "--grid", "solver.iterations=1,2", "--out", "batch", "--quiet")
    columns = header(written.folder / "batch/summary.csv")
    assert columns.pop(3) == "solver.iterations"
    assert [c for c in columns if "/" not in c] == first_cells(section("Summary of a batch"))
    said = re.findall(r"`(load/\S+)`", section("Summary of a batch").partition("\nThe units")[0])
    assert [c for c in columns if "/" in c][:3] == [c.replace("NAME", "post") for c in said]


def test_a_probe_has_the_columns_of_the_page(written):
    (written.folder / "more.yaml").write_text(
        "gauges: [{name: H, kind: level, at: [0.1, 0.1]}, {name: U, kind: velocity, at: [0.1, 0.1, "
        "0.1]},\n  {name: Q, kind: flow, center: [0.3, 0.2, 0.2], normal: [1, 0, 0], size: [0.4, "
        "0.4]}]\n")
    written("probe", "run", "--gauges", "more.yaml", "-o", "probe.csv")
    assert header(written.folder / "probe.csv") == names(section("Probe"))


def test_a_study_has_the_columns_and_keys_of_the_page(written):
    written("study", "study.yaml", "--out", "study", "--quiet")
    said = names(section("Study"))
    columns = header(written.folder / "study/study.csv")
    study = json.loads((written.folder / "study/study.json").read_text())
    assert columns == list(study["rows"][0])
    assert columns[1:8] == said[said.index("backend"):][:7]
    assert columns[-5:] == said[said.index("device"):][:5]
    assert {*study} == {"rows", *said[said.index("rows") + 1:][:6]}
    assert header(written.folder / "study/front.csv")[-2:] == said[-2:] == ["T", "Z"]


def test_a_report_of_a_comparison_has_the_keys_of_the_page(written):
    written("compare", "run", "run", "--report", "c.json")
    report, text = json.loads((written.folder / "c.json").read_text()), section("Compare report")
    said = first_cells(text)
    assert sorted(report) == sorted(said)
    rows = dict(re.findall(r"^\| `(parts|curves)` \| (.*) \|$", text, re.MULTILINE))
    part = next(p for p in report["parts"] if p["rows"])
    assert [*part, *part["rows"][0]] == names(rows["parts"])
    written("compare", "s.yaml", "--between", "cpu:float,cpu:float", "--updates", "20", "--warmup",
            "2", "--members", "2", "--report", "d.json")
    report = json.loads((written.folder / "d.json").read_text())
    assert sorted(report) == sorted(said) and list(report["curves"][0]) == names(rows["curves"])


def test_the_tables_of_stability_have_the_columns_of_the_page(written):
    written("stability", "--reduced", "points_two_coincident", "--csv", "a.csv", "--quiet")
    written("stability", "s.yaml", "--map", "time.step,gravity", "--x", "0.002", "--y", "10",
            "--iterations", "2", "--csv", "b.csv", "--quiet")
    suite, _, map_text = section("Stability").partition("Of a map")
    assert sorted(header(written.folder / "a.csv")) == sorted(first_cells(suite))
    said = [n for n in names(map_text) if n not in ("stable", "degraded", "stopped")]
    assert header(written.folder / "b.csv") == said


def test_the_tables_of_bench_have_the_columns_of_the_page(written):
    few = ["--n", "500", "--threads", "1", "--updates", "5", "--warmup", "2"]
    written("bench", *few, "--repeats", "1", "--csv", "b.csv", "--json", "b.json")
    columns = header(written.folder / "b.csv")
    rows = json.loads((written.folder / "b.json").read_text())
    assert [list(row) for row in rows] == [columns] * 2
    assert [row["state"] for row in rows] == ["start", "late"]
    table, _, calibration = section("Bench").partition("`calibration.csv`")
    said = first_cells(table)
    assert columns[:len(said)] == said
    stages = [s["name"] for s in json.loads(written("config", "--stages"))["stages"]]
    assert {c.removeprefix("ms_") for c in columns[len(said):]} < {*stages}
    path = written.folder / "calibration.csv"
    written("bench", "--calibrate", *few, PBF_CALIBRATION=str(path))
    assert header(path) == names(calibration)


def test_every_option_that_writes_a_table_or_report_is_on_the_page(pbf):
    page = (ROOT / "app/OUTPUTS.md").read_text().partition("\nNo command writes a trace")[0]
    out = subprocess.run([pbf, "--help"], capture_output=True, text=True).stdout
    commands = re.findall(r"^  (\w+)", re.search(r"Subcommands:\n(.*?)\n\n", out, re.S)[1], re.M)
    found = 0
    for command in commands:
        text = subprocess.run([pbf, command, "--help"], capture_output=True, text=True).stdout
        for option in re.findall(r"^ +(--(?:log-json|json|csv|report|junit|schema|stages))\b", text, re.M):
            row = [line for line in page.splitlines() if line.startswith("|") and option in line
                   and f"pbf {command}" in line]
            assert row, f"pbf {command} {option}"
            found += 1
    assert found >= 10


def test_info_stability_and_batches_have_json(written):
    page = (ROOT / "app/OUTPUTS.md").read_text()
    info = json.loads(written("info", "--json"))
    row = next(line for line in page.splitlines() if "| `pbf info` |" in line)
    assert list(info) == names(row.partition("JSON: ")[2])
    lines = {line.split()[0]: line for line in written("info").splitlines()}
    assert info["commit"] in lines["commit"] and f" {info['threads']}" in lines["threads"]
    written("stability", "step_0.01_iterations_1", "--reduced", "--quiet", "--csv", "case.csv", "--json", "case.json")
    case = json.loads((written.folder / "case.json").read_text())
    with open(written.folder / "case.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert case["complete"] and len(case["rows"]) == len(rows) >= 1
    assert list(case["rows"][0]) == list(rows[0])
    written("batch", "s.yaml", "--grid", "solver.iterations=1,2", "--out", "sweep", "--quiet")
    batch = json.loads((written.folder / "sweep/summary.json").read_text())
    with open(written.folder / "sweep/summary.csv", newline="") as file:
        head = file.readline()
        rows = list(csv.DictReader(file))
    assert list(batch["rows"][0]) == list(rows[0]) and len(batch["rows"]) == 2
    assert batch["rows"][1]["solver.iterations"] == 2
    assert head == "# units: " + ", ".join(f"{c}={u}" for c, u in batch["units"].items()) + "\n"
