"""What the tests share: the program, the run files that it and the C++ tests wrote."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from matplotlib.image import imread

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))

collect_ignore = ["check_run_file.py", "check_vtk.py", "run_pytest.py"]


def drawn(path):
    """Whether the file is a picture that is neither empty nor of one colour."""
    pixels = imread(path)[..., :3]
    return pixels.shape[0] > 200 and pixels.shape[1] > 300 and pixels.std() > 0.02


# Falls out of an open floor until the square of its speed overflows a float.
DIVERGES = {"domain": {"min": [0, 0, 0], "max": [1.6, 0.4, 0.8], "open": ["z_min"]},
            "gravity": [0, 0, -1e12], "time": {"step": 1e6, "end": 1e9}, "measure_every": 5,
            "output": {"every": 1e8}}


@pytest.fixture(scope="session")
def pbf():
    """Path of the program."""
    return Path(os.environ["PBF_BINARY"]).resolve()


@pytest.fixture(scope="session")
def samples():
    """Folder of constant.h5, varying.h5, gzip_double.h5, changing.h5 and bodies.h5
    (tests/unit/io/run_file_sample_for_python)."""
    return Path(os.environ["PBF_SAMPLE_FOLDER"]).resolve()


@pytest.fixture(scope="session")
def minimal(pbf, tmp_path_factory):
    """run.vtkhdf of configs/minimal.yaml with frames: 4000 particles, 26 frames; pictures not drawn."""
    folder = tmp_path_factory.mktemp("minimal")
    subprocess.run([pbf, "run", ROOT / "configs/minimal.yaml", "--set", "output={}", "--quiet",
                    "--threads", "2", "--out", folder / "run"], check=True, capture_output=True)
    return folder / "run/run.vtkhdf"


@pytest.fixture(scope="session")
def gauged(pbf, tmp_path_factory):
    """run.vtkhdf of a small dam break with a gauge of every kind, read every 0.01 s,
    and loads on its walls, every 0.02 s."""
    folder = tmp_path_factory.mktemp("gauges")
    (folder / "s.yaml").write_text(
        "domain: {min: [0, 0, 0], max: [1, 0.3, 0.6], loads: true}\n"
        "fluid: {spacing: 0.05}\n"
        "bodies: [{shape: block, min: [0, 0, 0], max: [0.4, 0.3, 0.5]}]\n"
        "gauges:\n"
        "  - {name: H, kind: level, at: [0.2, 0.15]}\n"
        "  - {name: U, kind: velocity, at: [0.2, 0.15, 0.1]}\n"
        "  - {name: Q, kind: flow, center: [0.5, 0.15, 0.3], normal: [1, 0, 0], size: [0.3, 0.6]}\n"
        "  - {name: P, kind: pressure, on: z_min, at: [0.2, 0.15, 0], radius: 0.1}\n"
        "time: {step: 0.002, end: 0.3}\n"
        "output: {every: 0.1, gauges_every: 0.01}\n")
    subprocess.run([pbf, "run", "s.yaml", "--quiet", "--out", "run"], check=True, cwd=folder,
                   capture_output=True)
    return folder / "run/run.vtkhdf"


@pytest.fixture
def tools(capsys, pbf, monkeypatch):
    """tools("to-csv", ...) -> (exit code, stdout, stderr), as from a shell that knows the program."""
    from pbf_tools.__main__ import main

    monkeypatch.setenv("PBF", str(pbf))

    def call(*arguments):
        capsys.readouterr()
        try:
            code = main([str(a) for a in arguments])
        except SystemExit as end:
            code = end.code
        out = capsys.readouterr()
        return code, out.out, out.err

    return call


@pytest.fixture
def pictures(tmp_path):
    """A run folder with 12 pictures of 64 x 48 that turn from black to red."""
    import numpy as np
    from matplotlib.image import imsave
    folder = tmp_path / "dam" / "frames"
    folder.mkdir(parents=True)
    for k in range(12):
        pixels = np.zeros((48, 64, 3))
        pixels[..., 0] = k / 11
        imsave(folder / f"frame_{k}.png", pixels)  # 10 sorts before 2 as text
    return folder.parent


@pytest.fixture
def here(pbf, tmp_path, monkeypatch):
    """An empty working folder, from which pbf_tools finds the program."""
    monkeypatch.setenv("PBF", str(pbf))
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def scene():
    """500 particles, 50 updates; no output."""
    import numpy as np
    return {"name": "small", "domain": {"min": [0, 0, 0], "max": np.array([1.6, 0.4, 0.8])},
            "fluid": {"spacing": 0.04}, "time": {"step": 0.004, "end": np.float64(0.2)},
            "bodies": [{"shape": "block", "min": (0, 0, 0), "max": (0.4, 0.2, 0.4)}]}
