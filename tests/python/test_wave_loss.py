"""tests/regression/waves: the flumes that measure how much height waves lose, and the fit of them."""

import re
import subprocess

import numpy as np
import pytest
from conftest import ROOT, drawn

FOLDER = ROOT / "tests/regression/waves"


@pytest.fixture
def loss(monkeypatch):
    monkeypatch.syspath_prepend(str(FOLDER))
    import loss
    return loss


def test_the_formula_of_the_plan_is_that_of_the_measurement(loss, pbf, tmp_path):
    for number, case in enumerate(loss.CASES[::5]):
        (tmp_path / f"{number}.yaml").write_text(loss.scene(case)[1])
        done = subprocess.run([pbf, "plan", f"{number}.yaml"], cwd=tmp_path, capture_output=True,
                              text=True)
        assert done.returncode == 0, done.stderr
        _, height, length = case.numbers
        table = {"dimensions": np.array([case.dimensions]),
                 "smoothing_ratio": np.array([case.ratio]), "height_over_d": np.array([height]),
                 "length_over_d": np.array([length])}
        said = float(re.search(r"expected loss of height: about (\S+) %", done.stdout)[1])
        assert said == pytest.approx(100 * loss.expected(table)[0], rel=0.05)


def test_a_fit_finds_the_numbers_that_made_a_table(loss, tmp_path):
    rows = []
    for case in loss.CASES:
        kd, height, length = case.numbers
        rows.append({"dimensions": case.dimensions, "depth_m": case.depth, "kd": kd,
                     "smoothing_ratio": case.ratio, "height_over_d": height,
                     "length_over_d": length, "loss": 0, "note": case.note})
    loss.write(tmp_path / "t.csv", rows)
    table = loss.read(tmp_path / "t.csv")
    made = {2: (100.0, 12.0, 3.0), 3: (60.0, 5.0, 0.0)}
    table["loss"] = loss.expected(table, made)
    for dimensions, numbers in made.items():
        assert loss.fit(table)[dimensions] == pytest.approx(numbers, rel=1e-6)
    last = loss.report(table)[-1]
    assert last.startswith("3-D, h = 3 d, fitted: a 5, b 0; residuals ") and last.endswith("RMS 0.00")
    loss.figure(table).savefig(tmp_path / "a.png")
    assert drawn(tmp_path / "a.png")


def test_the_page_has_the_rows_of_the_table_and_the_residuals_of_the_formula(loss):
    page = (FOLDER / "README.md").read_text()
    table = loss.read(FOLDER / "loss_nvidia_h200.csv")
    assert len(table["loss"]) == len(loss.CASES) and "\n".join(loss.rows(table)) in page
    for (dimensions, long, _, here), most in zip(loss.parts(table), (2.8, 4.1, 2.9, 2.1)):
        assert abs(100 * (table["loss"] - loss.expected(table)))[here].max() < most
        assert loss.fit(table)[dimensions] == pytest.approx(loss.PRESENT[dimensions], rel=0.02)


def test_twins_at_two_depths_are_the_same_flume_in_other_units(loss):
    twin = next(case for case in loss.CASES if "2.83 ms" in case.note)
    other = next(case for case in loss.CASES if case.numbers == pytest.approx(twin.numbers) and
                 case.dimensions == 2 and case.depth == 0.3)
    for case in (twin, other):  # steps over the time in which a wave runs one depth
        steps = case.pace * case.spacing * (9.81 / case.depth) ** 0.5
        assert steps == pytest.approx(0.4 * 0.005 * (9.81 / 0.3) ** 0.5)
