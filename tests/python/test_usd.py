"""to-usd: what OpenUSD's own library reads back, against h5py and motions known beforehand."""

import resource
import subprocess
import sys

import h5py
import numpy as np
import pytest
from conftest import ROOT

pytest.importorskip("pxr", reason="usd-core is not installed")
pytest.importorskip("yaml", reason="PyYAML is not installed")
from pxr import Gf, Usd, UsdGeom  # noqa: E402

from pbf_tools import to_usd  # noqa: E402

FIELDS = {"velocity": "velocities", "density": "primvars:density", "id": "ids"}


@pytest.fixture
def convert(tools, tmp_path):
    """convert(run, options...) -> (stage, what was said on stderr)."""
    names = (str(tmp_path / f"{k}.usdc") for k in range(9))  # OpenUSD keeps files by their names

    def call(run, *options):
        name = next(names)
        code, out, err = tools("to-usd", run, "-o", name, *options)
        assert code == 0 and f"wrote {name}: " in out, err
        return Usd.Stage.Open(name), err
    return call


def fluid(stage):
    return UsdGeom.Points(stage.GetPrimAtPath("/run/fluid"))


def frame(file, k, name):
    """A field of frame k by h5py alone."""
    count = file["VTKHDF/NumberOfPoints"][file["VTKHDF/Steps/PartOffsets"][k]]
    first = file["VTKHDF/Steps/PointOffsets" if name == "Points" else
                 f"VTKHDF/Steps/PointDataOffsets/{name}"][k]
    return file["VTKHDF/Points" if name == "Points" else f"VTKHDF/PointData/{name}"][first:first + count]


@pytest.mark.parametrize("name", ["constant", "varying", "changing", "gzip_double"])
def test_a_file_holds_what_the_frames_hold_also_where_their_number_varies(convert, samples, name):
    stage, _ = convert(samples / f"{name}.h5")
    points, counts = fluid(stage), []
    with h5py.File(samples / f"{name}.h5") as file:
        for k in range(8):
            x = frame(file, k, "Points").astype(np.float32)
            assert np.array_equal(np.reshape(points.GetPointsAttr().Get(k), (-1, 3)), x)
            for field, attribute in FIELDS.items():
                there = np.asarray(points.GetPrim().GetAttribute(attribute).Get(k))
                kept = frame(file, k, field)
                kept = kept.astype(np.int64 if field == "id" else np.float32)
                assert there.dtype == kept.dtype
                assert np.array_equal(there.reshape(kept.shape), kept), (k, field)
            widths = np.asarray(points.GetWidthsAttr().Get(k))
            assert len(widths) == len(x) and np.all(widths == np.float32(file["pbf/spacing"][()]))
            low, high = np.asarray(points.GetExtentAttr().Get(k))
            assert not len(x) or np.allclose(np.stack([x.min(0), x.max(0)]),
                                             [low + widths[0] / 2, high - widths[0] / 2], atol=1e-6)
            counts.append(len(x))
    assert (len(set(counts)) > 1) == (name in ("varying", "changing"))
    assert (0 in counts) == (name == "changing")
    assert points.GetWidthsInterpolation() == "vertex"


def test_a_second_is_a_second_a_metre_a_metre_and_z_is_up(convert, samples):
    stage, _ = convert(samples / "constant.h5")  # frame k at time 0.02 k
    assert stage.GetTimeCodesPerSecond() == stage.GetFramesPerSecond() == 50
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (0, 7)
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1 and UsdGeom.GetStageUpAxis(stage) == "Z"
    assert stage.GetDefaultPrim().GetPath() == "/run"
    assert fluid(stage).GetPointsAttr().GetTimeSamples() == list(range(8))
    # Corner particle: at 0.5 a t^2, so its speed is what its positions say.
    z = [fluid(stage).GetPointsAttr().Get(k)[0][2] for k in (1, 3)]
    middle = fluid(stage).GetVelocitiesAttr().Get(2)[0][2]
    assert (z[1] - z[0]) / (2 / stage.GetTimeCodesPerSecond()) == pytest.approx(middle, rel=1e-4)


def test_ids_that_stay_and_widths_are_written_once(convert, samples):
    stage, _ = convert(samples / "constant.h5")
    assert fluid(stage).GetIdsAttr().GetNumTimeSamples() == 1
    assert fluid(stage).GetWidthsAttr().GetNumTimeSamples() == 1
    stage, _ = convert(samples / "changing.h5")
    assert fluid(stage).GetIdsAttr().GetNumTimeSamples() == 8


def test_some_frames_are_at_their_times_whatever_the_codes_per_second(convert, samples):
    stage, _ = convert(samples / "constant.h5", "--frames", "1:8", "--every", "2")
    assert stage.GetTimeCodesPerSecond() == 25
    times = np.array(fluid(stage).GetPointsAttr().GetTimeSamples()) / 25
    assert times == pytest.approx([0.02, 0.06, 0.10, 0.14])
    stage, _ = convert(samples / "constant.h5", "--fps", "24")
    assert fluid(stage).GetPointsAttr().GetTimeSamples()[5] == pytest.approx(24 * 0.1)
    stage, _ = convert(samples / "constant.h5", "--frames", "3", "--no-obstacles")
    assert stage.GetTimeCodesPerSecond() == 24 and stage.GetStartTimeCode() == pytest.approx(1.44)


SCENE = """
domain: {min: [0, 0, 0], max: [1, 1, 1]}
fluid: {spacing: 0.05}
bodies: [{shape: block, min: [0, 0, 0], max: [1, 1, 0.2]}]
obstacles:
  - {name: blade, shape: box, min: [0.3, 0.4, 0.5], max: [0.7, 0.6, 0.6],
     motion: {kind: velocity, velocity: [0, 0, 0], angular: [0, 0, 180]}}
  - {name: turned, shape: box, min: [0.1, 0.4, 0.7], max: [0.3, 0.6, 0.8], turn_axis: [0, 1, 0], turn_angle: 90}
  - {name: pipe-1, shape: cylinder, from: [0.2, 0.85, 0.2], to: [0.8, 0.85, 1], radius: 0.1}
  - {name: pipe_1, shape: capsule, from: [0.8, 0.2, 0.5], to: [0.8, 0.2, 0.7], radius: 0.1}
  - {name: cork, shape: sphere, center: [0.5, 0.5, 0.3], radius: 0.1, free: {density: 300}}
  - {name: lid, shape: plane, point: [0, 0, 0.95], normal: [0, 0, -1]}
time: {step: 0.005, end: 0.1}
measure_every: 1
output: {every: 0.05}
"""


@pytest.fixture(scope="module")
def solids(pbf, tmp_path_factory):
    folder = tmp_path_factory.mktemp("solids")
    (folder / "solids.yaml").write_text(SCENE)
    subprocess.run([pbf, "run", "solids.yaml", "--quiet", "--threads", "1", "--out", "run"], check=True,
                   cwd=folder, capture_output=True)
    return folder / "run"


def at(stage, name, point, code):
    """Where a point of a shape is at a time code."""
    prim = stage.GetPrimAtPath(f"/run/obstacles/{name}")
    assert prim, name
    return np.array(UsdGeom.XformCache(code).GetLocalToWorldTransform(prim).Transform(Gf.Vec3d(*point)))


def test_obstacles_are_where_the_scene_and_the_fluid_move_them(convert, solids):
    stage, err = convert(solids)
    assert stage.GetTimeCodesPerSecond() == 20
    for code in range(3):
        turn = np.deg2rad(180 * code / 20)
        x, y = 0.2, 0.1
        expected = [0.5 + x * np.cos(turn) - y * np.sin(turn), 0.5 + x * np.sin(turn) + y * np.cos(turn), 0.6]
        assert at(stage, "blade", [0.5, 0.5, 0.5], code) == pytest.approx(expected, abs=1e-5)
    # A quarter of a turn about y takes x to -z, and z to x.
    assert at(stage, "turned", [0.5, 0.5, 0.5], 0) == pytest.approx([0.25, 0.6, 0.65])
    pipe = UsdGeom.Cylinder(stage.GetPrimAtPath("/run/obstacles/pipe_1"))
    assert (pipe.GetRadiusAttr().Get(), pipe.GetHeightAttr().Get()) == pytest.approx((0.1, 1))
    ends = sorted(at(stage, "pipe_1", [0, 0, z], 0).round(9).tolist() for z in (-0.5, 0.5))
    assert ends == [[0.2, 0.85, 0.2], [0.8, 0.85, 1]]
    assert stage.GetPrimAtPath("/run/obstacles/pipe_1_").GetTypeName() == "Capsule"
    with h5py.File(solids / "run.vtkhdf") as file:
        bodies = file["pbf/frames/bodies"][:, 0, :3]
    assert bodies[2, 2] != bodies[0, 2]
    for k in range(3):
        assert at(stage, "cork", [0, 0, 0], k) == pytest.approx(bodies[k])
    assert "left out lid (plane)" in err and not stage.GetPrimAtPath("/run/obstacles/lid")
    stage, err = convert(solids, "--no-obstacles")
    assert not stage.GetPrimAtPath("/run/obstacles") and err == ""


def test_particles_go_to_the_file_before_more_are_read(convert, samples, monkeypatch):
    whole, _ = convert(samples / "varying.h5")
    expected = [np.array(fluid(whole).GetPointsAttr().Get(k)) for k in range(8)]
    saved, layer = [], to_usd.usd().Sdf.Layer
    save = layer.Save
    monkeypatch.setattr(layer, "Save", lambda self, *a: (saved.append(1), save(self, *a))[1])
    monkeypatch.setattr(to_usd, "SAVED_BYTES", 1)
    stage, _ = convert(samples / "varying.h5")
    assert len(saved) == 9
    for k in range(8):
        assert np.array_equal(fluid(stage).GetPointsAttr().Get(k), expected[k])


def test_a_text_file_says_the_same(tools, samples, tmp_path):
    assert tools("to-usd", samples / "changing.h5", "-o", tmp_path / "a.usda")[0] == 0
    assert (tmp_path / "a.usda").read_text().startswith("#usda 1.0")
    stage = Usd.Stage.Open(str(tmp_path / "a.usda"))
    assert list(fluid(stage).GetIdsAttr().Get(0))[:3] == [0, 400000000, 600000000]


def test_what_cannot_be_written_is_one_line_and_leaves_nothing(tools, samples, tmp_path):
    run = samples / "constant.h5"
    for options, words in ((["-o", "a.abc"], "a.abc: the ending must be one of .usdc .usd .usda"),
                           (["-o", "a.usdc", "--every", "0"], "--every goes from 1"),
                           (["-o", "a.usdc", "--fps", "0"], "--fps from above 0"),
                           (["-o", "a.usdc", "--frames", "9"], "no such frame")):
        code, _, err = tools("to-usd", run, *options)
        assert code == 2 and words in err and err.count("\n") == 1
    (tmp_path / "file").touch()
    code, _, err = tools("to-usd", run, "-o", tmp_path / "file/a.usdc")
    assert code == 5 and "file/a.usdc: cannot write it: " in err and err.count("\n") == 1


def test_a_full_disk_is_one_line_and_keeps_the_file_of_before(samples, tmp_path):
    (tmp_path / "a.usdc").write_text("before")
    done = subprocess.run([sys.executable, "-B", "-m", "pbf_tools", "to-usd", samples / "constant.h5",
                           "-o", "a.usdc"], cwd=tmp_path, capture_output=True, text=True,
                          env={"PYTHONPATH": str(ROOT / "tools")},
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (9000, 9000)))
    assert done.returncode == 5, done.stderr
    assert done.stderr == "pbf_tools: error: a.usdc: cannot write it: Error occurred writing file: " \
        "File too large\n"
    assert (tmp_path / "a.usdc").read_text() == "before"
    assert [p.name for p in tmp_path.iterdir()] == ["a.usdc"]
