"""The command waves over tables and runs, and run-up: records and frames made here."""

import subprocess

import h5py
import numpy as np
import pytest
from conftest import drawn
from test_waves import DEPTH, HEIGHT, PERIOD, K, Sea, regular

import pbf_tools
from pbf_tools import waves
from pbf_tools.errors import BadInput


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    """A CSV table of regular waves, R = 0.25, at three gauges; of one in mm, and of texts."""
    path = tmp_path_factory.mktemp("waves") / "flume.csv"
    t = 4 + 0.02 * np.arange(700)
    rows = zip(t, *(regular(t, x, 0.25) for x in (2.0, 2.2)), 1000 * regular(t, 2.5, 0.25))
    path.write_text("# measured\nt_s,a_m,b_m,c_mm,word\n"
                    + "".join(",".join(map(repr, map(float, row))) + ",x\n" for row in rows))
    return path


def test_a_table_of_an_experiment_goes_through_the_same_code(table, tools, tmp_path):
    code, out, err = tools("waves", table, "--gauges", "c_mm=2.5,a_m=2.0,b_m=2.2", "--depth", DEPTH,
                           "--period", PERIOD, "--between", "6,17.9", "-o", tmp_path / "a.png",
                           "--csv", tmp_path / "a.csv")
    assert code == 0 and err == "" and drawn(tmp_path / "a.png")
    assert "incident 0.04 m, reflected 0.01 m, reflection 0.250" in out
    written = pbf_tools.read_csv(tmp_path / "a.csv")
    assert list(written["gauge"]) == ["a_m", "b_m", "c_mm"] and list(written["x"]) == [2.0, 2.2, 2.5]
    assert np.allclose(written["reflection"], 0.25, atol=1e-6) and written.units["hmax"] == "m"
    beat = HEIGHT * abs(1 + 0.25 * np.exp(1j * (2 * K * written["x"] + 0.8)))
    assert np.allclose(written["height"], beat, rtol=1e-6)
    assert np.allclose(written["h13"], beat, rtol=0.01)
    assert np.allclose(written["tz"], PERIOD, rtol=1e-3)


@pytest.mark.parametrize("words, text", [
    (("--gauges", "a_m,b_m=2.2"), "a table does not say where a_m is"),
    (("--gauges", "a_m=2.0,b_m=2.2", "--period", "1.2"), "give the depth of the still water"),
    (("--gauges", "a_m=2.0,d_m=2.2"), "no column d_m"),
    (("--gauges", "a_m=2.0,word=2.2", "--depth", "0.3"), "column word is not one of numbers"),
    (("--gauges", "a_m=2.0"), "need two gauges or more"),
    (("--gauges", "a_m=2.0,a_m=2.1"), "a_m is there twice"),
    (("--gauges", "a_m=2.0,b_m=z"), "z is not a number"),
    (("--gauges", "a_m=2,b_m=2", "--depth", "0.3", "--period", "1.2"), "at the same place, 2 m"),
    (("--gauges", "a_m=2,b_m=2.2", "--depth", "0.3"), "too short for irregular waves; give the "),
    (("--gauges", "a_m=2,b_m=2.2", "--depth", "0.3", "--between", "9"), "two numbers that ascend"),
    (("--gauges", "a_m=2,b_m=2.2", "--depth", "0.3", "--smallest", "-1", "--period", "1.2"),
     "a number from 0 on")], ids=str)
def test_what_a_command_line_lacks_is_said_in_one_sentence(table, tools, tmp_path, words, text):
    code, out, err = tools("waves", table, *words, "-o", tmp_path / "a.png")
    assert code == 2 and text in err and err.count("\n") == 1 and out == ""


SCENE = """name: flume
dimensions: 2
domain: {min: [0, 0], max: [3, 0.6]}
fluid: {spacing: 0.02}
bodies: [{shape: block, min: [1.4, 0], max: [2, 0.2]}]
obstacles:
  - {name: post, shape: box, min: [0, 0], max: [0.02, 0.1]}
  - {name: floor, shape: plane, point: [2, 0], normal: [0, 1]}
  - {name: "the beach", shape: plane, point: [2, 0], normal: [-0.25, 1]}
gauges:
  - {name: a, kind: level, at: [1]}
  - {name: b, kind: level, at: [1.2]}
  - {name: c, kind: level, at: [1.5]}
  - {name: v, kind: velocity, at: [1.5, 0.1]}
time: {step: 0.002, end: 0.04}
output: {every: 0.002, gauges_every: 0.01}
"""


@pytest.fixture
def flume(pbf, tmp_path):
    """The folder of a run whose gauges read an irregular sea (R = 0.5) for 60 s."""
    (tmp_path / "flume.yaml").write_text(SCENE)
    subprocess.run([pbf, "run", "flume.yaml", "--quiet", "--threads", "1", "--out", "run"],
                   check=True, cwd=tmp_path, capture_output=True)
    sea, t = Sea(0.05, 1.5, 60, 11), 0.05 * np.arange(1200)
    with h5py.File(tmp_path / "run/run.vtkhdf", "r+") as file:
        group = file["pbf/gauges"]
        for name, data in group.items():
            data.resize(len(t), axis=0)
        group["time"][:] = t
        for name, x in zip("abc", (1.0, 1.2, 1.5)):
            group[name][:] = DEPTH + sea(t, x, 0.5)
    return tmp_path / "run"


def test_the_gauges_of_a_run_say_where_they_are_and_how_deep_the_water_is(flume, tools, tmp_path):
    code, out, err = tools("waves", flume, "--gauges", "a,b,c", "--taper", 0, "-o",
                           tmp_path / "a.png", "--csv", tmp_path / "a.csv")
    assert code == 0 and err == "" and drawn(tmp_path / "a.png")
    assert "depth 0.3 m" in out and "reflection 0.500" in out and "waves of 0.02 m or more" in out
    written = pbf_tools.read_csv(tmp_path / "a.csv")
    assert list(written["x"]) == [1.0, 1.2, 1.5] and np.allclose(written["mean"], DEPTH, atol=1e-9)
    run = pbf_tools.open(flume)
    for row, name in enumerate("abc"):
        assert written["hm0"][row] == pytest.approx(4 * np.std(run.gauges[name].value), rel=1e-12)
    code, out, _ = tools("waves", flume, "--gauges", "a=1.5,c=1.0", "--taper", 0, "-o",
                         tmp_path / "b.svg")
    assert code == 0 and "reflection 2.00" in out  # the other way round


def test_gauges_of_a_run_that_do_not_do_are_refused(flume, tools, tmp_path):
    with h5py.File(flume / "run.vtkhdf", "r+") as file:
        file["pbf/gauges/b"][500] = 0
    for words, text in ((("a,B",), "no gauge B, did you mean b?"), (("a,v",), "of kind velocity"),
                        (("a,b",), "b: 1 of 1200 readings are no numbers, or 0 where a level gauge "
                                   "is dry, the first at 25 s"),
                        (("a,c", "--axis", "y"), "gauge a (x = 1 m) has no y"),
                        (("a,c=1",), "a and c are at the same place")):
        code, _, err = tools("waves", flume, "--gauges", *words, "-o", tmp_path / "a.png")
        assert code == 2 and text in err and err.count("\n") == 1, err
    with h5py.File(flume / "run.vtkhdf", "r+") as file:
        file["pbf/gauges/c"][:] += 0.1
    code, _, err = tools("waves", flume, "--gauges", "a,c", "-o", tmp_path / "a.png")
    assert code == 2 and "stand in different depths, 0.3 to 0.4 m" in err


def test_run_up_is_where_the_connected_fluid_ends(flume):
    """A sheet of particles on the slope, up to 1, 2, ... of its places, with drops beyond a gap."""
    d, place = 0.02, pbf_tools.open(flume)["position"]._place
    run = pbf_tools.open(flume)
    way, out = np.array([4, 0, 1]) / 17**0.5, np.array([-1, 0, 4]) / 17**0.5
    ends = 3 * d * np.array([2, 5, 8, 4, 3, 6, 9, 9, 2, 1, 4, 7, 8, 3, 3, 3, 2, 1, 1, 5, 9])
    assert len(run.times) == len(ends)
    with h5py.File(flume / "run.vtkhdf", "r+") as file:
        for k, end in enumerate(ends):
            n = int(run.counts[k])
            along = np.full(n, 0.0)
            sheet = np.arange(0, end + 1e-9, 2.9 * d)
            along[:len(sheet)] = np.minimum(sheet, end)
            along[len(sheet)] = end                       # no more than 2.9 d from the one before
            along[len(sheet) + 1] = end + 3.1 * d         # a drop
            x = np.array([2, 0.01, 0]) + along[:, None] * way - 1e-6 * out  # they touch it
            x[-1] += 4 * d * out + (end + 2 * d) * way    # spray above the slope
            first = int(place.offsets[k])
            file[place.path][first:first + n] = x
    found = waves.run_up(run, "the beach", level=0.1)
    assert np.allclose(found.height, ends / 17**0.5 - 0.1, atol=1e-6)
    assert found.highest == pytest.approx(27 * d / 17**0.5 - 0.1, abs=1e-6)
    tops = [2, 6, 12]  # the last one rises to the end of the run
    assert np.allclose(found.maxima["time"], run.times[tops]) and ends[20] > np.mean(ends)
    assert np.allclose(found.maxima["height"], found.height[tops]) and np.isnan(found.r2)
    close = waves.run_up(run, "the beach", level=0.1, apart=0.009)  # four frames, 0.008 s
    assert np.allclose(close.maxima["time"], run.times[[6, 12]])
    for name, text in (("post", "obstacle post is a box; this is for planes"),
                       ("floor", "obstacle floor is level"),
                       ("beach", "no obstacle beach, did you mean the beach?")):
        with pytest.raises(BadInput, match=text):
            waves.run_up(run, name)
