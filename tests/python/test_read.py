"""The read API, on files written by the C++ program, whole, growing, cut off and foreign."""

import os
import shutil
import signal
import subprocess
import time

import h5py
import numpy as np
import pytest
from conftest import ROOT

import pbf_tools


def block(k, n):
    """Position and velocity of the sample's particles in frame k: a block of n^3 that falls and
    spreads, as its C++ source says it."""
    t, i = 0.02 * k, np.arange(n**3)
    cell = np.column_stack([i % n, i // n % n, i // n**2]).astype(float)
    spread = cell * [0.01, 0.01, 0]
    fall = np.array([0, 0, -9.81])
    return cell * 0.02 + spread * t + fall * t * t / 2, spread + fall * t


@pytest.mark.parametrize("name, size", [("constant", np.float32), ("gzip_double", np.float64)])
def test_fields_hold_what_the_program_wrote(samples, name, size):
    run = pbf_tools.open(samples / f"{name}.h5")
    assert run.status == "finished" and len(run.frames) == 8
    assert np.allclose(run.times, 0.02 * np.arange(8), rtol=0, atol=1e-15)
    assert run.updates.tolist() == [10 * k for k in range(8)]
    assert run["position"].shape == (8, 1000, 3) and run["position"].dtype == size
    for frame in run.frames:
        x, v = block(frame.k, 10)
        assert np.allclose(frame["position"], x, atol=1e-7) and frame.count == 1000
        assert np.allclose(frame["velocity"], v, atol=1e-6)
        assert np.allclose(frame["density"], 1000 - 20 * frame.time)
        assert np.array_equal(frame["id"], np.arange(1000))


@pytest.mark.parametrize("key", [
    0, -1, (3, 5), (3, -1), (3, slice(10, 20)), (3, slice(None, None, 7)), (2, [5, 900, 5]),
    (2, slice(50, 40, -2)), slice(None), slice(1, 7, 2), (slice(None), 5), ([0, 3], slice(4)),
    (slice(2), slice(None), 2), (4, 5, 1), (slice(0), 3), (1, slice(20, 10))], ids=str)
def test_a_lazy_slice_equals_the_slice_of_the_whole_array(samples, key):
    run = pbf_tools.open(samples / "constant.h5")
    for name in ("position", "density"):
        if name == "density" and isinstance(key, tuple) and len(key) > 2:
            continue
        whole = np.stack([frame[name] for frame in run.frames])
        part = run[name][key]
        assert np.array_equal(part, whole[key]) and part.dtype == whole.dtype


def test_only_the_rows_asked_for_are_read(samples, monkeypatch):
    rows, read = [], h5py.Dataset.__getitem__
    run = pbf_tools.open(samples / "constant.h5")

    def spy(self, key, **more):
        out = read(self, key, **more)
        if self.name.endswith("/Points"):
            rows.append(out.size // 3)
        return out

    monkeypatch.setattr(h5py.Dataset, "__getitem__", spy)
    run["position"]
    assert rows == []
    run["position"][2:4, 100:150]
    assert rows == [50, 50]


def test_a_track_follows_the_id_while_the_number_of_particles_varies(samples):
    run = pbf_tools.open(samples / "varying.h5")
    sides = [10 + k % 3 - k // 4 for k in range(8)]
    assert run.counts.tolist() == [n**3 for n in sides] and run["position"].shape[1] is None
    for particle in (0, 731, 1200):
        track = run.track(particle, "velocity")
        for k, n in enumerate(sides):
            row = np.flatnonzero(track["time"] == run.times[k])
            assert len(row) == (particle < n**3)
            if len(row):
                assert np.allclose(track["position"][row], block(k, n)[0][particle], atol=1e-7)
                assert np.allclose(track["velocity"][row], block(k, n)[1][particle], atol=1e-6)
    with pytest.raises(pbf_tools.BadInput, match="one by one"):
        run["position"][:]
    for nobody in (-1, 5000):
        with pytest.raises(pbf_tools.BadInput, match=f"id {nobody}"):
            run.track(nobody)


def test_particles_that_appear_and_disappear_are_found_by_their_ids(samples):
    run = pbf_tools.open(samples / "changing.h5")
    assert run.ids.dtype == np.int64 and len(run.ids) == 8 and run.ids.shape == (8, None)
    for k in range(8):
        j = np.arange(3 * k, 3 * k + 20)
        ids = 200_000_000 * j[j % 4 != 1] if k != 5 else j[:0]
        assert run.ids[k].tolist() == ids.tolist()
        assert run.counts[k] == run.frames[k].count == len(ids)
        assert run["position"][k].shape == (len(ids), 3) and run["density"][k].shape == (len(ids),)
    particle = 200_000_000 * 16  # above 2^31; row 16 - 3k - as many as are left out before it
    track = run.track(particle, "velocity", "density")
    alive = [0, 1, 2, 3, 4]
    rows = [run.ids[k].tolist().index(particle) for k in range(5) if particle in run.ids[k]]
    assert track["time"].tolist() == run.times[alive].tolist() and len(track) == 5
    assert track["position"][:, 0].tolist() == [k + 0.25 * row for k, row in zip(alive, rows)]
    assert track["density"].shape == (5,) and track["velocity"].shape == (5, 3)
    with pytest.raises(pbf_tools.BadInput, match="one by one, or one particle with run.track"):
        run["position"][:]
    with pytest.raises(pbf_tools.BadInput, match="no particle with id 200000000 in any frame"):
        run.track(200_000_000)


def test_a_track_finds_ids_that_are_not_row_numbers(samples, tmp_path):
    path = shutil.copy(samples / "constant.h5", tmp_path / "gaps.h5")
    with h5py.File(path, "r+") as file:
        ids = file["VTKHDF/PointData/id"]
        ids[:] = 3 * ids[:] + 1
    run = pbf_tools.open(path)
    assert np.array_equal(run.track(3 * 17 + 1)["position"], run["position"][:, 17])
    with pytest.raises(pbf_tools.BadInput):
        run.track(17)


def test_log_info_and_units_are_those_of_the_run(samples):
    run = pbf_tools.open(samples / "constant.h5")
    log = run.log
    assert len(log) == 8 and np.allclose(log["compression_mean"], 1e-3 * np.arange(8))
    assert np.allclose(log["momentum_z"], -2.0 * np.arange(8)) and log.units["momentum_z"] == \
        "kg m/s"
    assert np.allclose(log["stage/predict"], 0.5 * np.arange(8)) and log.units["stage/predict"] == \
        "s"
    assert log["neighbors_max"].dtype.kind == "i" and log["neighbors_max"][-1] == 37
    assert run.info["overrides"] == ["time.step=0.001", "threads=2"]
    assert run.info["domain_min"].tolist() == [-1, 0, 0.5] and run.units["domain_min"] == "m"
    assert run.info["rest_density"] == 998 and run.info["threads"] == 2
    assert run.scene == "name: drop\n" and run.name == "drop"  # its file is drop ä.yaml
    assert run.units["velocity"] == "m/s" and "1000 particles, cpu float" in run.title
    with pytest.raises(pbf_tools.UnknownName, match="no column speed"):
        log["speed"]


def test_a_file_that_the_script_has_open_in_h5py_can_be_read_too(samples):
    with h5py.File(samples / "constant.h5") as file:
        run = pbf_tools.open(samples / "constant.h5")
        assert run["position"].shape == (8, 1000, 3) and len(file["VTKHDF/Points"]) == 8000


def test_what_is_not_there_is_named(samples):
    run = pbf_tools.open(samples / "constant.h5")
    with pytest.raises(pbf_tools.UnknownName, match="no field pressure; there are position"):
        run["pressure"]
    for key in (8, -9, (0, 1000), (0, 0, 3)):
        with pytest.raises(IndexError):
            run["position"][key]
    with pytest.raises(IndexError):
        run["density"][0, 0, 0]
    with pytest.raises(IndexError, match="no frame 8; the file has 8"):
        run.frames[8]


def reason(path):
    with pytest.raises(pbf_tools.FileError) as error:
        pbf_tools.open(path)
    assert str(path) in str(error.value)
    return str(error.value)


def test_files_that_are_no_run_files_are_refused_with_the_reason(samples, tmp_path):
    assert "no such file" in reason(tmp_path / "missing.h5")
    assert "no run.vtkhdf in this folder" in reason(tmp_path)
    (tmp_path / "empty.h5").touch()
    assert "empty" in reason(tmp_path / "empty.h5")
    (tmp_path / "text.h5").write_text("time,front\n" * 1000)
    assert "not an HDF5 file" in reason(tmp_path / "text.h5")
    with h5py.File(tmp_path / "foreign.h5", "w") as file:
        file["position"] = np.zeros((4, 3))
    assert "not one that pbf wrote" in reason(tmp_path / "foreign.h5")
    with h5py.File(tmp_path / "half.h5", "w") as file:
        file.create_group("pbf"), file.create_group("VTKHDF/Steps")
    assert "format_version" in reason(tmp_path / "half.h5")
    newer = shutil.copy(samples / "constant.h5", tmp_path / "newer.h5")
    with h5py.File(newer, "r+") as file:
        file["pbf"].attrs["format_version"] = 2
    assert "format version 2; this package reads version 1" in reason(newer)
    if os.geteuid() != 0:  # root may read everything
        os.chmod(newer, 0)
        assert "permission denied" in reason(newer)


def test_a_run_file_without_its_parts_is_refused(samples, tmp_path):
    for part in ("VTKHDF/Points", "VTKHDF/PointData", "VTKHDF/Steps/PointDataOffsets/velocity",
                 "VTKHDF/NumberOfPoints", "pbf/frames"):
        path = shutil.copy(samples / "constant.h5", tmp_path / "cut.h5")
        with h5py.File(path, "r+") as file:
            del file[part]
        reason(path)


def _virtual(parent, key, other):
    layout = h5py.VirtualLayout((8000, 3), "f4")
    layout[:] = h5py.VirtualSource(other, "VTKHDF/Points", (8000, 3))
    parent.create_virtual_dataset(key, layout)


@pytest.mark.parametrize("words, replace", [
    ("external link", lambda g, k, o: g.__setitem__(k, h5py.ExternalLink(o, "VTKHDF/Points"))),
    ("external storage", lambda g, k, o: g.create_dataset(k, (8000, 3), "f4",
                                                          external=[(o, 0, 96000)])),
    ("virtual dataset", _virtual)])
def test_a_run_file_that_takes_in_another_file_is_refused(samples, tmp_path, words, replace):
    other, path = str(samples / "constant.h5"), tmp_path / "run.vtkhdf"
    for place in ("VTKHDF/Points", "VTKHDF/PointData/velocity", "pbf/log/time"):
        shutil.copy(other, path)
        with h5py.File(path, "r+") as file:
            parent, key = file[place].parent, place.rsplit("/", 1)[1]
            del parent[key]
            replace(parent, key, other)
        with pytest.raises(pbf_tools.FileError, match=f"{place}.*{words}"):
            pbf_tools.open(path)


def test_offsets_beyond_the_data_are_refused_not_followed(samples, tmp_path):
    path = shutil.copy(samples / "constant.h5", tmp_path / "offsets.h5")
    with h5py.File(path, "r+") as file:
        file["VTKHDF/Steps/PointOffsets"][3] = 7500
        file["VTKHDF/Steps/PointDataOffsets/id"][3] = -5
    run = pbf_tools.open(path)
    assert run["position"][2].shape == (1000, 3)
    for read in (lambda: run["position"][3], lambda: run["id"][3], lambda: run.track(5)):
        with pytest.raises(pbf_tools.FileError, match="ends before frame 3 does"):
            read()


def test_a_truncated_file_is_refused_or_read_right(samples, tmp_path):
    data, refused = (samples / "constant.h5").read_bytes(), 0
    whole = pbf_tools.open(samples / "constant.h5")["position"][:]
    for cut in (1, 7, 100, 2048, len(data) // 3, len(data) // 2, len(data) - 4096, len(data) - 1):
        path = tmp_path / f"cut_{cut}.h5"
        path.write_bytes(data[:cut])
        try:
            run = pbf_tools.open(path)
            assert np.array_equal(run["position"][:], whole[:len(run.frames)])
        except pbf_tools.FileError as error:
            refused += 1
            assert str(path) in str(error)
    assert refused >= 6


def test_frames_beyond_the_committed_ones_are_not_looked_at(samples, tmp_path):
    path = shutil.copy(samples / "constant.h5", tmp_path / "committing.h5")
    with h5py.File(path, "r+") as file:  # as between the data of a frame and its commit
        file["VTKHDF/Steps"].attrs["NSteps"] = np.int64(5)
        log = file["pbf/log"]
        del log["front_x"]
        log["front_x"] = np.zeros(6)  # a process killed while it wrote the log
    run = pbf_tools.open(path)
    assert len(run.frames) == 5 and run["density"].shape == (5, 1000) and len(run.log) == 6


def test_a_file_without_frames_has_none(samples, tmp_path):
    path = shutil.copy(samples / "constant.h5", tmp_path / "young.h5")
    with h5py.File(path, "r+") as file:
        file["VTKHDF/Steps"].attrs["NSteps"] = np.int64(0)
    run = pbf_tools.open(path)
    assert len(run.frames) == 0 and run.fields == [] and list(run.frames) == []
    with pytest.raises(KeyError, match="no field position; there is none"):
        run["position"]


def test_poses_of_obstacles_that_move_come_from_the_log(pbf, tmp_path):
    (tmp_path / "s.yaml").write_text(
        "name: s\ndomain: {min: [0, 0, 0], max: [1, 0.5, 1]}\nfluid: {spacing: 0.05}\n"
        "bodies: [{shape: block, min: [0, 0, 0], max: [0.2, 0.5, 0.2]}]\n"
        "obstacles:\n"
        "  - {name: blade, shape: box, min: [0.5, 0.2, 0.4], max: [0.9, 0.3, 0.5],\n"
        "     motion: {kind: velocity, velocity: [0, 0, 0.5], angular: [0, 0, 90]}}\n"
        "  - {name: ball, shape: sphere, center: [0.8, 0.2, 0.8], radius: 0.1}\n"
        "time: {step: 0.01, end: 0.4}\noutput: {every: 0.1}\n")
    subprocess.run([pbf, "run", tmp_path / "s.yaml", "--quiet", "--out", tmp_path / "run"],
                   check=True, capture_output=True)
    run = pbf_tools.open(tmp_path / "run/run.vtkhdf")
    for t, exact in [(0.1, 1e-12), (0.25, 1e-3), (0.4, 1e-12)]:
        turn, middle = run.obstacle_pose("blade", t)
        c, s = np.cos(t * np.pi / 2), np.sin(t * np.pi / 2)
        assert np.allclose(turn, [[c, -s, 0], [s, c, 0], [0, 0, 1]], rtol=0, atol=exact)
        assert np.allclose(turn @ turn.T, np.eye(3), rtol=0, atol=1e-12)
        assert np.allclose(middle, [0.7, 0.25, 0.45 + 0.5 * t], rtol=0, atol=1e-12)
    turns, middles = run.obstacle_pose("blade", np.array([0.1, 0.25, 0.4]))
    for k, t in enumerate([0.1, 0.25, 0.4]):
        turn, middle = run.obstacle_pose("blade", t)
        assert np.array_equal(turns[k], turn) and np.array_equal(middles[k], middle)
    with pytest.raises(pbf_tools.UnknownName, match="no moving obstacle ball; there are blade"):
        run.obstacle_pose("ball", 0)
    with pytest.raises(pbf_tools.BadInput, match="is not in the log"):
        run.obstacle_pose("blade", 0.5)


def test_free_bodies_are_read_by_name_over_the_frames(samples, tmp_path):
    run = pbf_tools.open(samples / "bodies.h5")
    assert list(run.bodies) == ["float", "raft"]
    body = run.bodies["float"]
    assert np.array_equal(body.time, run.times) and len(run.times) == 4
    places = [[0.5, 0.25, 1 + 0.1 * k] for k in range(4)]
    assert np.allclose(body.middle, places, rtol=0, atol=1e-15)
    for k, turn in enumerate(body.turn):
        c, s = np.cos(np.radians(10 * k)), np.sin(np.radians(10 * k))
        assert np.allclose(turn, [[c, -s, 0], [s, c, 0], [0, 0, 1]], rtol=0, atol=1e-15)
    assert np.array_equal(body.velocity, np.tile([0, 0, 0.1], (4, 1)))
    assert np.array_equal(body.spin, np.tile([0, 0, 2], (4, 1)))
    assert np.array_equal(run.bodies["raft"].middle[:, 2], np.arange(4))
    turn, middle = run.obstacle_pose("float", run.times)
    assert np.allclose(turn, body.turn) and np.allclose(middle, body.middle)
    assert run.log.units["pose/float/spin_z"] == "rad/s"
    with pytest.raises(pbf_tools.UnknownName, match="no free body flaot, did you mean float"):
        run.bodies["flaot"]
    path = shutil.copy(samples / "bodies.h5", tmp_path / "short.h5")
    with h5py.File(path, "r+") as file:
        file["pbf/frames/bodies"].resize(2, axis=0)
    assert len(pbf_tools.open(path).times) == 2


def test_a_run_without_free_bodies_has_none(samples):
    assert pbf_tools.open(samples / "constant.h5").bodies == {}


def test_a_run_is_read_while_it_is_written_and_after_it_was_killed(pbf, tmp_path):
    process = subprocess.Popen(
        [pbf, "run", ROOT / "configs/minimal.yaml", "--set", "output={every: 0.002}", "--set",
         "time.end=1000", "--quiet", "--threads", "1", "--out", tmp_path / "run"],
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    path, seen, run = tmp_path / "run/run.vtkhdf", [], None
    try:
        end = time.monotonic() + 60
        while time.monotonic() < end and (not seen or seen[-1] < 40):
            assert process.poll() is None
            if not path.exists() or path.stat().st_size == 0:
                time.sleep(0.01)
                continue
            try:
                run = run.refresh() if run else pbf_tools.open(path)
            except pbf_tools.FileError:  # its very first commit
                assert run is None
                time.sleep(0.01)
                continue
            assert run.status == "running"
            if len(run.frames):
                last = run.frames[-1]
                assert np.array_equal(last["id"], np.arange(4000))
                assert np.all(last["position"][:, 2] > -1e-6) and last["position"].max() > 0.3
            seen.append(len(run.frames))
    finally:
        process.send_signal(signal.SIGKILL)
        process.wait()
    assert seen[-1] >= 40 and seen == sorted(seen) and len(set(seen)) > 1
    dead = pbf_tools.open(path)
    assert dead.status == "running" and len(dead.frames) >= seen[-1]
    assert np.allclose(np.diff(dead.times), 0.002)
    for frame in dead.frames[::10]:
        assert np.all(np.isfinite(frame["position"])) and frame["density"].min() > 0
