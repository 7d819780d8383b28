"""What the tests of data sets for learning share: runs of ramps, and other readers of their files."""

import json
import shutil
import subprocess

import h5py
import numpy as np
import pytest

FILES = ("train.h5", "valid.h5", "test.h5", "metadata.json")


def simulate(pbf, scene, folder):
    """A run of a scene (a dict)."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    folder.with_suffix(".yaml").write_text(json.dumps(scene))
    subprocess.run([pbf, "run", folder.with_suffix(".yaml"), "--out", folder, "--quiet",
                    "--threads", "1"], check=True, capture_output=True)
    return folder


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


@pytest.fixture(scope="session")
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
