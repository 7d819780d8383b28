"""to-npz and to-lagrangebench: data sets of runs, against h5py, NumPy and motions known beforehand."""

import json
import re
import shutil
import subprocess

import h5py
import numpy as np
import pytest

from pbf_tools import to_lagrangebench, trajectory
from pbf_tools.moments import Moments

yaml = pytest.importorskip("yaml")
FILES = ("train.h5", "valid.h5", "test.h5", "metadata.json")


def simulate(pbf, scene, folder):
    """A run of a scene (a dict)."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    folder.with_suffix(".yaml").write_text(json.dumps(scene))
    subprocess.run([pbf, "run", folder.with_suffix(".yaml"), "--out", folder, "--quiet",
                    "--threads", "1"], check=True, capture_output=True)
    return folder


@pytest.fixture(scope="module")
def ramps(pbf, tmp_path_factory):
    """ramps[D]: the folder of a batch of five ramps of 12 frames."""
    from pbf_tools.__main__ import main
    place, batches = tmp_path_factory.mktemp("ramps"), {}
    for d, particles in ((2, 200), (3, 1000)):
        scenes, out = place / f"scenes{d}", place / f"batch{d}"
        assert main(["make-scene", "ramps", "--number", "5", "--dimensions", str(d), "--seed", "2",
                     "--particles", str(particles), "--frames", "12", "--every", "0.02", "-o",
                     str(scenes)]) == 0
        subprocess.run([pbf, "batch", scenes, "--out", out, "--quiet", "--threads", "1"], check=True,
                       capture_output=True)
        batches[d] = out
    return batches


@pytest.fixture
def broken(ramps, tmp_path):
    """broken(change) -> folder of a copy of the batch in two dimensions, after change(file of run
    3, open in h5py, its folder)."""
    def call(change):
        shutil.copytree(ramps[2], tmp_path / "batch")
        folder = tmp_path / "batch/ramp_00003"
        with h5py.File(folder / "run.vtkhdf", "r+") as file:
            change(file, folder)
        return tmp_path / "batch"
    return call


def frames_of(folder, axes):
    """Positions of all frames as the file has them, by h5py alone: (frames, particles, D)."""
    with h5py.File(folder / "run.vtkhdf") as f:
        count = f["VTKHDF/NumberOfPoints"][0]
        starts = f["VTKHDF/Steps/PointOffsets"][:]
        return np.stack([f["VTKHDF/Points"][s:s + count][:, axes] for s in starts])


def data_of(folder):
    """{(part, group): (name of the run, position, type)} and the metadata."""
    out = {}
    for part in ("train", "valid", "test"):
        with h5py.File(folder / f"{part}.h5") as f:
            assert list(f) == [f"{k:05d}" for k in range(len(f))]
            for key, g in f.items():
                out[part, key] = g.attrs["run"], g["position"][:], g["particle_type"][:]
    return out, json.loads((folder / "metadata.json").read_text())


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
    assert code == 5 and "cannot write" in err


@pytest.mark.parametrize("d", [2, 3])
def test_a_data_set_has_each_run_once_and_what_lagrangebench_reads(tools, ramps, tmp_path, d):
    code, out, err = tools("to-lagrangebench", ramps[d], "-o", tmp_path / "data")
    assert code == 0 and "3 train, 1 valid, 1 test; 12 frames" in out, err
    assert sorted(p.name for p in (tmp_path / "data").iterdir()) == sorted(FILES)
    data, meta = data_of(tmp_path / "data")
    assert sorted(name for name, _, _ in data.values()) == [f"ramp_{k:05d}" for k in range(5)]
    for name, x, kind in data.values():
        raw = frames_of(ramps[d] / name, [0, 2] if d == 2 else [0, 1, 2])
        assert x.dtype == np.float32 and kind.shape == (x.shape[1],) and kind.dtype == np.int64
        assert np.array_equal(x[:, kind == 0], raw) and set(kind) == {0, 1}
    assert meta["dim"] == d and meta["dx"] == yaml.safe_load(
        (ramps[d] / "ramp_00000/scene.resolved.yaml").read_text())["fluid"]["spacing"]
    assert meta["default_connectivity_radius"] == pytest.approx(1.5 * meta["dx"])
    assert meta["dt"] * meta["write_every"] == pytest.approx(0.02) and meta["write_every"] > 1
    assert meta["num_particles_max"] == max(x.shape[1] for _, x, _ in data.values())
    assert (meta["num_trajs_train"], meta["num_trajs_valid"], meta["num_trajs_test"]) == (3, 1, 1)
    assert meta["sequence_length_train"] == meta["sequence_length_test"] == 11
    assert meta["periodic_boundary_conditions"] == [False] * d
    assert np.array(meta["bounds"]).shape == (d, 2)


def test_statistics_are_of_the_fluid_in_the_runs_for_training(tools, ramps, tmp_path, monkeypatch):
    """Two passes over all values, as the definition says, against sums over blocks."""
    for size in (1, 20000, 1 << 24):
        monkeypatch.setattr(trajectory, "BLOCK_BYTES", size)
        out = tmp_path / str(size)
        assert tools("to-lagrangebench", ramps[3], "-o", out, "--seed", 4)[0] == 0
        data, meta = data_of(out)
        train = [x[:, kind == 0].astype(float) for (part, _), (_, x, kind) in data.items()
                 if part == "train"]
        for key, order in (("vel", 1), ("acc", 2)):
            values = [np.diff(x, order, axis=0) for x in train]
            mean = np.mean([v.mean(axis=(0, 1)) for v in values], axis=0)
            std = np.sqrt(np.mean([((v - mean)**2).mean(axis=(0, 1)) for v in values], axis=0))
            assert meta[f"{key}_mean"] == pytest.approx(mean, rel=1e-9, abs=1e-15)
            assert meta[f"{key}_std"] == pytest.approx(std, rel=1e-9)
        whole = [(out / name).read_bytes() for name in FILES]
        assert whole == [(tmp_path / "1" / name).read_bytes() for name in FILES]


def test_no_more_of_a_run_is_in_memory_than_a_block(ramps, monkeypatch):
    t = trajectory.Trajectory.of(ramps[3] / "ramp_00000")
    frame = 8 * 3 * len(t.types)
    for frames in (1, 5):
        monkeypatch.setattr(trajectory, "BLOCK_BYTES", frames * frame + 1)
        assert [len(b) for b in t.blocks()] == [frames] * (12 // frames) + [12 % frames] * (frames == 5)


def test_the_split_follows_from_the_seed_alone(tools, ramps, tmp_path):
    runs = sorted(str(p) for p in ramps[2].iterdir() if p.is_dir())

    def made(name, *words):
        assert tools("to-lagrangebench", *words, "-o", tmp_path / name)[0] == 0
        data, _ = data_of(tmp_path / name)
        return {part: [name for (p, _), (name, _, _) in data.items() if p == part]
                for part in ("train", "valid", "test")}
    first = made("a", ramps[2])
    assert first == made("b", *reversed(runs))  # in whatever order they are named
    assert any(first != made(f"s{seed}", ramps[2], "--seed", seed) for seed in range(1, 4))
    even = made("c", ramps[2], "--split", "1,1,1")
    assert [len(even[part]) for part in ("train", "valid", "test")] == [1, 2, 2]


@pytest.mark.parametrize("number", [3, 4, 5, 10, 33, 1000])
@pytest.mark.parametrize("parts", [[0.8, 0.1, 0.1], [1e-6, 1, 1], [1, 1e-6, 1e-6], [1e-6, 1, 1e-6]])
def test_every_run_is_in_one_part_and_no_part_is_empty(number, parts):
    parts = [p / sum(parts) for p in parts]
    made = to_lagrangebench.split(number, parts, 7)
    assert sorted(sum(made, [])) == list(range(number)) and min(map(len, made)) >= 1
    if number == 1000 and parts[0] == 0.8:
        assert [len(m) for m in made] == [800, 100, 100]


def test_a_compressed_data_set_has_the_same_values(tools, ramps, tmp_path):
    for name, words in (("a", ()), ("b", ("--gzip", "--radius", 0.1))):
        assert tools("to-lagrangebench", ramps[2], "-o", tmp_path / name, *words)[0] == 0
    (a, _), (b, meta) = data_of(tmp_path / "a"), data_of(tmp_path / "b")
    assert a.keys() == b.keys() and all(np.array_equal(a[k][1], b[k][1]) for k in a)
    assert meta["default_connectivity_radius"] == 0.1
    with h5py.File(tmp_path / "b/train.h5") as f:
        assert f["00000/position"].compression == "gzip"


FLOW = {"dimensions": 2, "fluid": {"spacing": 0.05}, "gravity": [0, 0, 0],
        "time": {"step": 0.005, "end": 0.5}, "output": {"every": 0.05, "fields": []}}


def test_motion_through_a_periodic_face_is_no_jump(tools, pbf, tmp_path):
    """Fluid that fills a box without walls along any axis moves as a whole, by 0.06 m per frame."""
    runs = [simulate(pbf, {**FLOW, "domain": {"min": [2, -1], "max": [3, -0.5], "periodic": ["x", "z"]},
                           "bodies": [{"shape": "block", "min": [2, -1], "max": [3, -0.5],
                                       "velocity": [1.2, 0.4]}]}, tmp_path / f"r{k}")
            for k in range(3)]
    assert np.ptp(np.diff(frames_of(runs[0], [0]), axis=0)) > 0.9  # in the run file there are jumps
    code, _, err = tools("to-lagrangebench", *runs, "-o", tmp_path / "data")
    assert code == 0 and err == "", err
    data, meta = data_of(tmp_path / "data")
    assert meta["vel_mean"] == pytest.approx([0.06, 0.02], abs=1e-6)
    assert meta["acc_mean"] == pytest.approx([0, 0], abs=1e-6)
    assert meta["vel_std"] == meta["acc_std"] == [1, 1]  # none: not to be divided by
    assert meta["periodic_boundary_conditions"] == [True, True]
    # LagrangeBench wraps positions into a box that begins at 0.
    assert np.array(meta["bounds"]) == pytest.approx(np.array([[0, 1], [0, 0.5]]))
    for _, x, kind in data.values():
        assert x.min() > -1e-6 and np.all(x.max(axis=(0, 1)) < [1 + 1e-6, 0.5 + 1e-6])
        assert set(kind) == {0}


def test_walls_are_particles_where_only_some_axes_are_periodic(tools, pbf, tmp_path):
    runs = [simulate(pbf, {**FLOW, "domain": {"min": [0, 1], "max": [1, 1.4], "periodic": ["x"]},
                           "bodies": [{"shape": "block", "min": [0, 1], "max": [1, 1.4],
                                       "velocity": [1.2, 0]}]}, tmp_path / f"r{k}")
            for k in range(3)]
    code, _, err = tools("to-lagrangebench", *runs, "-o", tmp_path / "data")
    assert code == 0 and "some axes are periodic" in err
    data, meta = data_of(tmp_path / "data")
    radius, (_, (low, high)) = meta["default_connectivity_radius"], meta["bounds"]
    for _, x, kind in data.values():
        wall = x[0, kind == 1]
        assert len(wall) == 2 * 20 and set(kind) == {0, 1}
        bottom, top = sorted(set(np.round(wall[:, 1], 6)))
        assert top - bottom == pytest.approx(0.4 + 0.05)
        # No neighbors across the faces that LagrangeBench joins.
        assert (bottom - low) + (high - top) > radius and low == 0
        fluid = x[:, kind == 0, 1]
        assert fluid.min() > bottom and fluid.max() < top
    assert meta["vel_mean"] == pytest.approx([0.06, 0], abs=2e-3)


def test_walls_may_be_particles_in_any_set(tools, ramps, tmp_path):
    assert tools("to-lagrangebench", ramps[2], "-o", tmp_path / "data", "--walls", "--no-solids")[0] == 0
    data, meta = data_of(tmp_path / "data")
    d = 1 / round(1 / meta["dx"])  # whole cells along an edge
    for _, x, kind in data.values():
        wall = x[0, kind == 1]
        assert np.allclose(np.maximum(-wall, wall - 1).max(axis=1), d / 2, atol=1e-6)
        assert len(wall) == round(4 / d) + 4
        low, high = np.array(meta["bounds"]).T
        assert np.all(wall > low) and np.all(wall < high)


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


def test_moments_of_any_blocks_are_those_of_the_whole():
    x = np.random.default_rng(0).normal(size=(23, 7, 2))
    results = []
    for cuts in ([23], [1] * 23, [2, 1, 20], [5, 18], [22, 1]):
        moments = Moments(np.array([np.inf, np.inf]))
        for _ in range(2):  # a second trajectory does not go on with the first
            for part in np.split(x, np.cumsum(cuts)[:-1]):
                moments.add(part)
            moments.end()
        results.append(moments.values(1.0))
    for r in results:
        assert r["vel_mean"] == pytest.approx(np.diff(x, axis=0).mean(axis=(0, 1)))
        assert r["acc_std"] == pytest.approx(np.diff(x, 2, axis=0).std(axis=(0, 1)))
    short = Moments(np.array([np.inf]))
    short.add(np.zeros((2, 1, 1)))
    short.end()
    assert short.values(1.0) == {"vel_mean": [0], "vel_std": [1], "acc_mean": [0], "acc_std": [1]}


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


def test_particles_that_appear_and_disappear_are_refused_by_frame(tools, samples, tmp_path):
    code, _, err = tools("to-npz", samples / "changing.h5", "-o", tmp_path / "a.npz")
    assert code == 2 and re.search(r"frame \d+ has other particles than frame 0", err)
    assert not (tmp_path / "a.npz").exists()


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
