"""Runs as trajectories, and to-npz: against h5py and motions known beforehand."""

import re
import shutil

import numpy as np
import pytest
from learning import frames_of, ramps, simulate  # noqa: F401

from pbf_tools import trajectory

pytest.importorskip("yaml")


@pytest.mark.parametrize("d, axes", [(2, [0, 2]), (3, [0, 1, 2])])
def test_npz_files_hold_what_the_run_files_hold(tools, ramps, tmp_path, d, axes):
    code, out, err = tools("to-npz", ramps[d], "-o", tmp_path / "npz")
    assert code == 0 and "wrote 5 runs" in out, err
    assert len(list((tmp_path / "npz").iterdir())) == 5
    for folder in sorted(p for p in ramps[d].iterdir() if p.is_dir()):
        with np.load(tmp_path / "npz" / f"{folder.name}.npz") as file:
            a = dict(file)
        x = frames_of(folder, axes)
        n = x.shape[1]
        assert a["position"].dtype == np.float32 and np.array_equal(a["position"][:, :n], x)
        assert a["id"][:n].tolist() == list(range(n)) and set(a["id"][n:]) == {-1}
        assert set(a["type"][:n]) == {0} and set(a["type"][n:]) == {1}
        assert a["time"] == pytest.approx(np.arange(12) * 0.02) and a["dt"] == pytest.approx(0.02)
        assert a["bounds"].tolist() == [[0, high] for high in ([1, 1] if d == 2 else [1, 0.6, 1])]
        assert a["periodic"].tolist() == [False] * d
        # Plates do not move, and water stays out of them.
        plates = a["position"][:, n:]
        assert plates.shape[1] > 5 and np.all(plates == plates[0])
        apart = min(np.linalg.norm(plates[0] - p, axis=1).min() for frame in x[::3] for p in frame)
        assert apart > 0.3 * a["spacing"]


def test_one_run_becomes_one_file_without_solids_and_of_some_frames(tools, ramps, tmp_path):
    folder = ramps[2] / "ramp_00001"
    code, _, err = tools("to-npz", folder, "-o", tmp_path / "a.npz", "--no-solids", "--frames", "2:9:3")
    assert code == 0, err
    with np.load(tmp_path / "a.npz") as a:
        assert np.array_equal(a["position"], frames_of(folder, [0, 2])[2:9:3])
        assert a["dt"] == pytest.approx(0.06) and a["time"][0] == pytest.approx(0.04)
    code, _, err = tools("to-npz", ramps[2], "-o", tmp_path / "b.npz")
    assert code == 2 and "there are 5 runs; name a folder" in err
    again = shutil.copytree(folder, tmp_path / "other/ramp_00001")
    code, _, err = tools("to-npz", folder, again, "-o", tmp_path / "c")
    assert code == 2 and "two of the runs would be ramp_00001.npz" in err
    (tmp_path / "file").touch()
    code, _, err = tools("to-npz", folder, "-o", tmp_path / "file/a.npz")
    assert code == 5 and "file/a.npz: cannot write it: " in err


def test_no_more_of_a_run_is_in_memory_than_a_block(ramps, monkeypatch):
    t = trajectory.Trajectory.of(ramps[3] / "ramp_00000")
    frame = 8 * 3 * len(t.types)
    for frames in (1, 5):
        monkeypatch.setattr(trajectory, "BLOCK_BYTES", frames * frame + 1)
        assert [len(b) for b in t.blocks()] == [frames] * (12 // frames) + [12 % frames] * (frames == 5)


def test_obstacles_in_motion_have_a_type_and_a_path_of_their_own(tools, pbf, tmp_path):
    keys = {"kind": "velocity", "velocity": [0.2, 0, 0], "angular": [0, 90, 0]}
    scene = {"domain": {"min": [0, 0, 0], "max": [1, 0.4, 0.6]}, "fluid": {"spacing": 0.05},
             "bodies": [{"shape": "block", "min": [0, 0, 0], "max": [0.3, 0.4, 0.1]}],
             "obstacles": [{"name": "blade", "shape": "box", "min": [0.4, 0.1, 0.25],
                            "max": [0.7, 0.3, 0.35], "motion": keys}],
             "time": {"step": 0.005, "end": 0.5}, "output": {"every": 0.025}}
    run = simulate(pbf, scene, tmp_path / "r")
    assert tools("to-npz", run, "-o", tmp_path / "a.npz")[0] == 0
    with np.load(tmp_path / "a.npz") as a:
        x, t = a["position"][:, a["type"] == 2], a["time"]
    assert x.shape == (21, 6 * 4 * 2, 3)
    # About y by the right-hand rule: x to -z, 90 degrees in a second.
    middle = np.array([0.55, 0.2, 0.3]) + t[:, None] * [0.2, 0, 0]
    angle = t * np.pi / 2
    p = x[0] - middle[0]
    right = np.cos(angle)[:, None] * p[:, 0] + np.sin(angle)[:, None] * p[:, 2]
    up = -np.sin(angle)[:, None] * p[:, 0] + np.cos(angle)[:, None] * p[:, 2]
    path = np.stack([right, np.broadcast_to(p[:, 1], right.shape), up], axis=2) + middle[:, None]
    assert np.abs(x - path).max() < 1e-3


def test_particles_that_appear_and_disappear_are_refused_by_frame(tools, samples, tmp_path):
    code, _, err = tools("to-npz", samples / "changing.h5", "-o", tmp_path / "a.npz")
    assert code == 2 and re.search(r"frame \d+ has other particles than frame 0", err)
    assert not (tmp_path / "a.npz").exists()
