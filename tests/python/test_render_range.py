"""`pbf render --range quantile` against numpy, and what it refuses."""

import re
import shutil
import subprocess

import h5py
import numpy as np
import pytest


@pytest.fixture(scope="module")
def frames(minimal):
    """Speed and density of every frame, (26, 4000) each."""
    with h5py.File(minimal) as file:
        data = file["VTKHDF/PointData"]
        speed = np.linalg.norm(data["velocity"][:].astype(float), axis=1)
        return speed.reshape(26, -1), data["density"][:].astype(float).reshape(26, -1)


def render(pbf, minimal, folder, *options):
    done = subprocess.run([pbf, "render", minimal, "--size", "64x48", "--out", folder, *options],
                          capture_output=True, text=True)
    if "no OpenGL" in done.stderr or done.returncode == 4:
        pytest.skip(done.stderr)
    return done


def range_of(done):
    assert done.returncode == 0, done.stderr
    return [float(x) for x in re.search(r"range (\S+),(\S+): ", done.stderr).groups()]


@pytest.mark.parametrize("chosen", ["all", "3", "2:20:5", "-4:"])
def test_the_range_is_the_quantiles_of_the_frames_chosen(pbf, minimal, frames, tmp_path, chosen):
    index = {"all": slice(None), "3": [3], "2:20:5": slice(2, 20, 5),
             "-4:": slice(-4, None)}[chosen]
    done = render(pbf, minimal, tmp_path, "--frames", chosen, "--range", "quantile")
    assert range_of(done) == pytest.approx(np.percentile(frames[0][index], [1, 99]), rel=1e-6)


def test_frames_of_other_numbers_of_particles_are_drawn_and_coloured_by_their_ids(pbf, samples,
                                                                                tmp_path):
    changing = samples / "changing.h5"
    done = render(pbf, changing, tmp_path, "--frames", "all", "--color", "id", "--range", "quantile")
    with h5py.File(changing) as file:
        n = file["VTKHDF/NumberOfPoints"][:][file["VTKHDF/Steps/PartOffsets"][:]]
        first = file["VTKHDF/Steps/PointDataOffsets/id"][:]
        ids = np.concatenate([file["VTKHDF/PointData/id"][f:f + m] for f, m in zip(first, n)])
    assert 0 in n and range_of(done) == pytest.approx(np.percentile(ids, [1, 99]), rel=1e-6)
    assert len(list(tmp_path.glob("frame_*.png"))) == 8


def test_a_density_range_lies_about_the_rest_density(pbf, minimal, frames, tmp_path):
    low, high = np.percentile(frames[1][-5:], [1, 99])
    off = max(abs(low - 1000), abs(high - 1000))
    done = render(pbf, minimal, tmp_path, "--frames", "-5:", "--color", "density",
                  "--range", "quantile")
    assert range_of(done) == pytest.approx([1000 - off, 1000 + off], rel=1e-6)
    assert sum(range_of(done)) == pytest.approx(2000, rel=1e-12)
    said = re.search(r": density in kg/m\^3, as far below as above the rest density 1000; the 1 % and "
                     r"99 % quantiles of 5 frames are (\S+) and (\S+)\n", done.stderr)
    assert [float(x) for x in said.groups()] == pytest.approx([low, high], rel=1e-5)


@pytest.mark.parametrize("color, said", [
    ("speed", "speed in m/s, the 1 % and 99 % quantiles of 1 frame"),
    ("compression", "compression as a share (0.01 is 1 %), the 1 % and 99 % quantiles of 1 frame"),
    ("id", "ids of particles, the 1 % and 99 % quantiles of 1 frame"),
])
def test_a_range_says_what_it_is_of(pbf, minimal, tmp_path, color, said):
    done = render(pbf, minimal, tmp_path, "--frames", "5", "--color", color, "--range", "quantile")
    assert f": {said}\n" in done.stderr


def test_a_compression_range_and_one_of_ids(pbf, minimal, frames, tmp_path):
    compression = np.maximum(frames[1][5] / 1000 - 1, 0)
    done = render(pbf, minimal, tmp_path, "--frames", "5", "--color", "compression",
                  "--range", "quantile")
    assert range_of(done) == pytest.approx(np.percentile(compression, [1, 99]), rel=1e-5, abs=1e-9)
    done = render(pbf, minimal, tmp_path, "--frames", "5", "--color", "id", "--range", "quantile")
    assert range_of(done) == pytest.approx(np.percentile(np.arange(4000), [1, 99]))


@pytest.mark.parametrize("color", ["speed", "density", "compression"])
def test_the_picture_is_that_of_the_range_as_printed(pbf, minimal, tmp_path, color):
    options = ["--frames", "9", "--color", color]
    done = render(pbf, minimal, tmp_path / "a", *options, "--range", "quantile")
    range_of(done)
    printed = re.search(r"range (\S+): ", done.stderr).group(1)
    render(pbf, minimal, tmp_path / "b", *options, "--range", printed)
    render(pbf, minimal, tmp_path / "c", *options)
    a, b, c = [(tmp_path / x / "frame_000009.png").read_bytes() for x in "abc"]
    assert a == b
    assert a != c


def test_where_all_values_are_equal_the_range_is_that_of_the_scene(pbf, minimal, tmp_path):
    done = render(pbf, minimal, tmp_path / "a", "--frames", "0", "--range", "quantile")
    assert done.returncode == 0
    assert "the scene's own: all values of the frames chosen are 0" in done.stderr
    render(pbf, minimal, tmp_path / "b", "--frames", "0")
    assert ((tmp_path / "a/frame_000000.png").read_bytes() ==
            (tmp_path / "b/frame_000000.png").read_bytes())


@pytest.mark.parametrize("options, message", [
    (["--range", "2,1"], "--range 2,1: give LOW,HIGH"),
    (["--range", "nan,1"], "--range nan,1: give LOW,HIGH"),
    (["--range", "0,inf"], "--range 0,inf: give LOW,HIGH"),
    (["--range", "1"], "or quantile"),
    (["--range", "quantiles"], "or quantile"),
    (["--range", "quantile", "--frames", "20:3"], "--frames 20:3: give a range that selects"),
    (["--range", "quantile", "--frames", "99"], "--frames 99: give a frame from 0 to 25"),
])
def test_a_range_that_is_none_is_refused(pbf, minimal, tmp_path, options, message):
    done = render(pbf, minimal, tmp_path / "p", *options)
    assert done.returncode == 2
    assert message in done.stderr
    assert not (tmp_path / "p").exists()


def test_a_file_without_the_field_is_refused_before_a_picture_is_there(pbf, minimal, tmp_path):
    path = tmp_path / "run.vtkhdf"
    shutil.copy(minimal, path)
    with h5py.File(path, "a") as file:
        del file["VTKHDF/PointData/velocity"]
        del file["VTKHDF/Steps/PointDataOffsets/velocity"]
    done = render(pbf, path, tmp_path / "p", "--range", "quantile")
    assert done.returncode == 2
    assert "velocity" in done.stderr
    assert not list(tmp_path.glob("p/*.png"))


def test_a_run_with_a_wave_maker_is_drawn_without_files_of_the_scene(pbf, tmp_path):
    (tmp_path / "s.yaml").write_text(
        "dimensions: 2\ndomain: {min: [0, 0], max: [4, 0.6]}\nfluid: {spacing: 0.02}\n"
        "bodies: [{shape: block, min: [0.2, 0], max: [4, 0.3]}]\n"
        "obstacles: [{name: paddle, shape: box, min: [-0.3, 0], max: [0.2, 0.6], motion: {\n"
        "  kind: regular_waves, direction: [1, 0, 0], height: 0.06, period: 1.2}}]\n"
        "time: {step: 0.002, end: 0.02}\noutput: {every: 0.01}\n")
    subprocess.run([pbf, "run", "s.yaml", "--quiet", "--out", "run"], check=True, cwd=tmp_path,
                   capture_output=True)
    (tmp_path / "s.yaml").unlink()
    done = render(pbf, tmp_path / "run/run.vtkhdf", tmp_path / "drawn")
    assert done.returncode == 0, done.stderr
    assert list((tmp_path / "drawn").glob("*.png"))
