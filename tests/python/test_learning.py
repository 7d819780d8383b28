"""to-lagrangebench: data sets of runs, against h5py, NumPy and motions known beforehand."""

import importlib.util
import os
import re
import subprocess
import sys

import h5py
import numpy as np
import pytest
from conftest import ROOT
from learning import FILES, data_of, frames_of, ramps, simulate  # noqa: F401

from pbf_tools import to_lagrangebench, trajectory
from pbf_tools.moments import Moments

yaml = pytest.importorskip("yaml")


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
        whole = [(out / name).read_bytes() for name in FILES[:3]]
        assert whole == [(tmp_path / "1" / name).read_bytes() for name in FILES[:3]]


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


def test_the_page_leads_from_scenes_to_data_in_its_order(pbf, tmp_path):
    """With fewer and shorter runs."""
    (tmp_path / "build").mkdir()
    (tmp_path / "build/pbf").symlink_to(pbf)
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "tools"), "PYTHONDONTWRITEBYTECODE": "1",
                   "PATH": f"{os.path.dirname(sys.executable)}:{os.environ['PATH']}"}
    page, said = (ROOT / "tools/LEARNING.md").read_text().partition("## Training")[0], []
    for block in re.findall(r"```\n(.*?)```", page, re.DOTALL):
        block = block.replace("--number 12 --particles 600", "--number 4 --particles 200 --frames 9")
        words = [sys.executable, "-c", block] if block.startswith("import") else ["sh", "-ec", block]
        done = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        said.append(done.stdout)
    assert "2 train, 1 valid, 1 test; 9 frames" in said[0] and "wrote 4 runs" in said[1]
    assert re.match(r"\(9, \d+, 2\) fastest \d", said[2])
    data, meta = data_of(tmp_path / "ramps_data")
    with h5py.File(tmp_path / "ramps_data/train.h5") as f:
        groups = set(f["00000"])
    for name in ("particle_type", "particle_id", "position", *groups, *meta):
        if name not in ("solver", "t_end", "description"):
            assert name in page or name.startswith(("num_", "sequence", "split")), name


def test_the_training_script_says_what_it_lacks(tmp_path):
    (tmp_path / "jax_sph").mkdir()
    (tmp_path / "jax_sph/__init__.py").write_text("raise ImportError('it is not there')")
    (tmp_path / "data").mkdir()
    (tmp_path / "data/metadata.json").write_text("{}")

    def train(*words):
        done = subprocess.run([sys.executable, "-B", ROOT / "tools/train_gns.py", *words], cwd=tmp_path,
                              env={**os.environ, "PYTHONPATH": str(tmp_path)}, capture_output=True,
                              text=True)
        return done.returncode, done.stdout + done.stderr
    assert train("--help")[0] == 0 and "python tools/train_gns.py ramps_data" in train("--help")[1]
    for code, words, text in ((4, ["data"], "error: it is not there; tools/LEARNING.md"),
                              (5, ["none"], "error: none: no metadata.json in it"),
                              (2, ["data", "--steps", "1"], "--steps must be at least 20")):
        found, said = train(*words)
        assert found == code and text in said and "Traceback" not in said


def test_the_training_script_keeps_the_losses_that_the_trainer_prints(capsys):
    place = importlib.util.spec_from_file_location("train_gns", ROOT / "tools/train_gns.py")
    script = importlib.util.module_from_spec(place)
    place.loader.exec_module(script)
    losses = script.Losses(40)
    for part in ("Start training...", "\n", "00, train/loss: 2.50000.", "\n", "01, train/loss: 1.5.\n"):
        losses.write(part)
    assert losses.values == [2.5, 1.5]
    shown = capsys.readouterr()
    assert shown.out == "" and shown.err.startswith("Start training...\n2 steps, 0 s: mean loss 2.0000")
