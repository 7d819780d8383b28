"""What to-lagrangebench refuses: runs that do not fit are named, and what is there stays."""

import json
import os
import re
import resource
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT
from learning import broken, data_of, ramps  # noqa: F401

pytest.importorskip("yaml")


def set_scene(file, old, new):
    text = file["pbf"].attrs["resolved_scene"]
    text = text.decode() if isinstance(text, bytes) else text
    assert old in text
    file["pbf"].attrs["resolved_scene"] = text.replace(old, new)


def last(file, value):
    points = file["VTKHDF/Points"]
    points[len(points) - 3] = value


BAD = [
    (lambda f, p: f["pbf"].attrs.__setitem__("status", "stopped"), "was stopped early"),
    (lambda f, p: f["pbf"].attrs.__setitem__("status", "diverged"), "was stopped by the guard"),
    (lambda f, p: (p / "DONE").unlink(), "there is no DONE beside it"),
    (lambda f, p: last(f, np.nan), "frame 11: the position of particle .* is not finite"),
    (lambda f, p: last(f, [0.5, 0, -2]), r"frame 11: .*\(0.5, -2\), is outside the domain"),
    (lambda f, p: f["VTKHDF/Steps/Values"].__setitem__(5, 0.101), "frame 5 is 0.021 s after"),
    (lambda f, p: f["pbf/spacing"].__setitem__((), 0.04), "the spacing, m, is 0.04, but in .*ramp_00000"),
    (lambda f, p: f["pbf/domain_max"].__setitem__(0, 2.0), "the domain, m, is .*2.0"),
    (lambda f, p: f["VTKHDF/Steps"].attrs.__setitem__("NSteps", 9), "the number of frames is 9, but .* 12"),
    (lambda f, p: set_scene(f, "periodic: []", "periodic: [x]"), "the periodic axes"),
    (lambda f, p: set_scene(f, "dimensions: 2", "dimensions: 3"), "the number of dimensions is 3"),
    (lambda f, p: set_scene(f, "shape: box", "shape: mesh"), "obstacle plate1 is a mesh.*--no-solids")]


@pytest.mark.parametrize("change, text", BAD, ids=[text[:30] for _, text in BAD])
def test_a_run_that_does_not_fit_is_named_and_nothing_is_left_behind(tools, broken, tmp_path, change, text):
    batch = broken(change)
    code, _, err = tools("to-lagrangebench", batch, "-o", tmp_path / "data")
    assert code == 2 and "ramp_00003" in err and re.search(text, err), err
    assert err.count("\n") == 1 and "Traceback" not in err
    assert not list((tmp_path / "data").glob("*"))


def test_what_a_failed_conversion_would_replace_stays(tools, ramps, broken, tmp_path):
    assert tools("to-lagrangebench", ramps[2], "-o", tmp_path / "data")[0] == 0
    before = {p.name: p.read_bytes() for p in (tmp_path / "data").iterdir()}
    batch = broken(lambda f, p: last(f, np.inf))
    for words in ((batch, "--overwrite"), (ramps[2],)):
        code, _, err = tools("to-lagrangebench", *words, "-o", tmp_path / "data")
        assert code == 2 and ("not finite" in err or "has a train.h5 already" in err)
        assert {p.name: p.read_bytes() for p in (tmp_path / "data").iterdir()} == before
    assert tools("to-lagrangebench", ramps[3], "-o", tmp_path / "data", "--overwrite")[0] == 0
    assert json.loads((tmp_path / "data/metadata.json").read_text())["dim"] == 3


def test_a_batch_that_is_not_done_is_named_and_its_finished_runs_may_be_taken(tools, ramps, broken, tmp_path):
    def stop(file, folder):
        summary = folder.parent / "summary.csv"
        lines = summary.read_text().splitlines()
        at = next(k for k, line in enumerate(lines) if line.startswith("ramp_00003,"))
        lines[at] = lines[at].replace(",finished,", ",diverged,")
        summary.write_text("\n".join(lines) + "\n")
        file["pbf"].attrs["status"] = "diverged"
    batch = broken(stop)
    code, _, err = tools("to-lagrangebench", batch, "-o", tmp_path / "data")
    assert code == 2 and "1 of 5 runs are not finished, the first is ramp_00003 (diverged)" in err
    assert tools("to-lagrangebench", batch, "-o", tmp_path / "data", "--finished")[0] == 0
    assert {name for name, _, _ in data_of(tmp_path / "data")[0].values()} == {
        "ramp_00000", "ramp_00001", "ramp_00002", "ramp_00004"}
    text = (batch / "summary.csv").read_text().replace(",finished,", ",diverged,")
    (batch / "summary.csv").write_text(text)
    code, _, err = tools("to-lagrangebench", batch, "-o", tmp_path / "x", "--finished")
    assert code == 2 and "no run of this batch is finished" in err


@pytest.mark.parametrize("words, text", [
    (("--split", "1,1"), "three numbers"), (("--split", "1,0,1"), "three numbers"),
    (("--split", "a,b,c"), "three numbers"), (("--seed", -1), "--seed must be"),
    (("--radius", 0), "--radius must be"), (("--radius", "nan"), "--radius must be"),
    (("--frames", "3"), "needs at least 2 frames"), (("--frames", "99:"), "no such frame")], ids=str)
def test_options_that_cannot_be_say_why(tools, ramps, tmp_path, words, text):
    code, _, err = tools("to-lagrangebench", ramps[2], "-o", tmp_path / "data", *words)
    assert code == 2 and text in err and not (tmp_path / "data").exists()


def test_too_few_runs_and_runs_given_twice_are_refused(tools, ramps, tmp_path):
    runs = [ramps[2] / f"ramp_0000{k}" for k in range(3)]
    code, _, err = tools("to-lagrangebench", *runs[:2], "-o", tmp_path / "data")
    assert code == 2 and "at least 3 runs" in err and "given: 2" in err
    code, _, err = tools("to-lagrangebench", ramps[2], runs[1] / "run.vtkhdf", "-o", tmp_path / "data")
    assert code == 2 and "this run is given twice" in err
    code, _, err = tools("to-lagrangebench", ramps[2], tmp_path / "none", "-o", tmp_path / "data")
    assert code == 5 and "none" in err
    code, _, err = tools("to-lagrangebench", *runs, ramps[3] / "ramp_00000", "-o", tmp_path / "data")
    assert code == 2 and "the number of dimensions is 3" in err


@pytest.mark.parametrize("size", [0, 1000, 3000, 20000, 40000])
@pytest.mark.parametrize("command", ["to-npz", "to-lagrangebench", "to-lagrangebench --gzip"])
def test_a_full_disk_is_one_line_and_leaves_nothing_half_written(ramps, tmp_path, command, size):
    """Here a limit on the size of a file: every write behind it fails."""
    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    done = subprocess.run([sys.executable, "-B", "-m", "pbf_tools", *command.split(), ramps[3], "-o",
                           tmp_path / "out"], env={**os.environ, "PYTHONPATH": str(ROOT / "tools")},
                          cwd=tmp_path, preexec_fn=limit, capture_output=True, text=True)
    assert done.returncode == 5 and done.stderr.count("\n") == 1, (done.returncode, done.stderr)
    assert re.fullmatch(r"pbf_tools: error: .*out.*: cannot write it: File too large\n", done.stderr)
    assert list((tmp_path / "out").iterdir()) == []
