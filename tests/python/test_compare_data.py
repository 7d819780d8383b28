"""Comparisons with measurements from Python, and the units of columns, which the program has too."""

import math
import re
import subprocess

import pytest
from conftest import ROOT

import pbf_tools
from pbf_tools import units

SCENE = """dimensions: 2
domain: {min: [0, 0], max: [1, 0.8]}
fluid: {spacing: 0.04}
bodies: [{shape: block, min: [0, 0], max: [0.4, 0.48]}]
gauges: [{name: H, kind: level, at: [0.1]}]
time: {step: 0.0025, end: 0.3}
measure_every: 4
output: {every: 0.1, gauges_every: 0.01}
"""


@pytest.fixture(scope="module")
def compared(pbf, tmp_path_factory):
    """A run, and one that compares itself with its readings."""
    place = tmp_path_factory.mktemp("compared")
    (place / "a.yaml").write_text(SCENE)
    (place / "b.yaml").write_text(SCENE + "compare: [{gauge: H, data: h.csv, column: level_mm}]\n")
    subprocess.run([pbf, "run", "a.yaml", "--quiet", "--out", "a"], check=True, cwd=place,
                   capture_output=True)
    time, level = pbf_tools.open(place / "a").gauges["H"]
    (place / "h.csv").write_text("t_ms,level_mm\n" + "".join(
        f"{float(1e3 * t)!r},{float(1e3 * h + 10)!r}\n" for t, h in zip(time, level)))
    subprocess.run([pbf, "run", "b.yaml", "--quiet", "--out", "b"], check=True, cwd=place,
                   capture_output=True)
    return place


def test_a_run_says_what_it_has_compared(compared):
    assert pbf_tools.open(compared / "a").compare == {}
    found = pbf_tools.open(compared / "b").compare
    assert found["H"]["rms"] == pytest.approx(0.01) and found["H"]["unit"] == "m"
    assert found["H"]["bias"] == pytest.approx(-0.01) and math.isnan(found["H"]["rms_as_read"])
    with pytest.raises(pbf_tools.UnknownName, match="did you mean H"):
        found["h"]


def test_a_finished_run_is_compared_as_the_run_itself_does(compared, pbf):
    stored = pbf_tools.open(compared / "b").compare["H"]
    for found in (pbf_tools.compare_data(compared / "b", program=pbf),
                  pbf_tools.compare_data(pbf_tools.open(compared / "a"), compared / "h.csv",
                                         gauge={"H": "level_mm"}, program=pbf)):
        assert found["H"]["rms"] == pytest.approx(stored["rms"], rel=1e-12)
        assert found["H"]["points"] == stored["points"] == 31
    other = pbf_tools.compare_data(compared / "a", compared / "b", log=["energy", "front_x"],
                                   between=(0, 0.2), program=pbf)
    assert other["energy"]["rms"] == 0 and other["front_x"]["points"] < 31
    with pytest.raises(pbf_tools.PbfError, match="no gauge is named G"):
        pbf_tools.compare_data(compared / "a", compared / "h.csv", gauge="G", program=pbf)


def test_tools_and_program_know_the_same_units():
    text = (ROOT / "lib/data/units.cpp").read_text()
    program = {ending: (unit, float(factor)) for ending, unit, factor in
               re.findall(r'\{"(_\w+)", "([^"]+)", ([\de.-]+)\}', text)}
    assert program == {units.ending(unit): base for unit, base in units.UNITS.items()}
