"""compare, to-csv, make-scene, surface: against the program and other computations."""

import builtins
import io
import os
import re
import shutil
import subprocess

import h5py
import numpy as np
import pytest

import pbf_tools
from conftest import ROOT
from pbf_tools import fill, surface


def without(monkeypatch, package):
    """As if a package were not installed."""
    real = builtins.__import__

    def refuse(name, *args, **kwargs):
        if name.split(".")[0] == package:
            raise ImportError(name)
        return real(name, *args, **kwargs)

    monkeypatch.setattr(builtins, "__import__", refuse)


def test_no_file_that_a_command_reads_is_overwritten(tools, minimal, tmp_path):
    run = shutil.copy(minimal, tmp_path / "run.vtkhdf")
    os.link(run, tmp_path / "hard.png")
    before = run.read_bytes()
    for words in (("to-csv", run, "--log", "-o", run), ("compare", run, minimal, "--csv", run),
                  ("plot-energy", minimal, run, "-o", tmp_path / "hard.png")):
        code, _, err = tools(*words)
        assert code == 2 and "which this command reads and would overwrite" in err
    assert run.read_bytes() == before


def test_a_run_does_not_differ_from_itself_and_differs_from_a_moved_one(tools, minimal, tmp_path):
    code, out, _ = tools("compare", minimal, minimal, "--max-rms", 0, "--csv", tmp_path / "a.csv")
    assert code == 0 and "different" not in out
    table = pbf_tools.read_csv(tmp_path / "a.csv")
    assert len(table) == 26 and np.all(table["max"] == 0) and np.all(table["unmatched"] == 0)
    moved = shutil.copy(minimal, tmp_path / "moved.h5")
    with h5py.File(moved, "r+") as file:
        points = file["VTKHDF/Points"]
        points[:] = points[:] + np.float32([0.01, 0, 0])  # h = 0.04 m
    code, out, _ = tools("compare", minimal, moved, "--max-rms", 0.2, "--csv", tmp_path / "b.csv",
                         "-o", tmp_path / "b.png")
    table = pbf_tools.read_csv(tmp_path / "b.csv")
    assert code == 6 and "different: RMS distance 0.25 h at 0 s" in out
    for name in ("mean", "rms", "max", "centers"):
        assert np.allclose(table[name], 0.25, atol=1e-5)
    assert (tmp_path / "b.png").stat().st_size > 10000
    assert tools("compare", minimal, moved, "--max-rms", 0.26)[0] == 0


def test_a_run_that_ended_early_or_otherwise_differs(tools, pbf, minimal, tmp_path):
    short = tmp_path / "short/run.vtkhdf"
    subprocess.run([pbf, "run", ROOT / "configs/minimal.yaml", "--set", "output={}", "--quiet",
                    "--set", "time.end=0.004", "--out", short.parent], check=True,
                   capture_output=True)
    code, out, _ = tools("compare", minimal, short, "--max-rms", 1)
    assert code == 6 and "different: frames at a time of both: 1, of 26 in A and 2 in B" in out
    assert tools("compare", minimal, short)[0] == 0  # asked for nothing
    ended = shutil.copy(minimal, tmp_path / "ended.h5")
    with h5py.File(ended, "r+") as file:
        file["pbf"].attrs["status"] = "diverged"
    code, out, _ = tools("compare", minimal, ended, "--max-rms", 1)
    assert code == 6 and "different: A is finished, B is diverged" in out


def test_runs_without_a_common_time_cannot_be_compared(tools, minimal, tmp_path):
    later = shutil.copy(minimal, tmp_path / "later.h5")
    with h5py.File(later, "r+") as file:
        file["VTKHDF/Steps/Values"][:] += 100
    code, _, err = tools("compare", minimal, later)
    assert code == 2 and "no frame at the same time" in err


def test_csv_of_log_frames_and_track_reads_back_bit_for_bit(tools, minimal, tmp_path):
    run = pbf_tools.open(minimal)
    tools("to-csv", minimal, "--log", "-o", tmp_path / "log.csv")
    log = pbf_tools.read_csv(tmp_path / "log.csv")
    assert all(np.array_equal(log[name], run.log[name]) for name in run.log)
    _, out, _ = tools("to-csv", minimal, "--frames", "3:9:5", "--fields", "position,id")
    rows = np.genfromtxt(io.StringIO(out), delimiter=",", names=True, dtype=None)
    assert rows.shape == (8000,) and rows.dtype.names[:2] == ("time", "position_x")
    z = run["position"][3:9:5, :, 2].ravel()
    assert np.array_equal(rows["position_z"].astype(np.float32), z)
    _, out, _ = tools("to-csv", minimal, "--track", 99)
    rows = np.genfromtxt(io.StringIO(out), delimiter=",", names=True)
    assert np.array_equal(rows["velocity_z"].astype(np.float32), run["velocity"][:, 99, 2])


def test_particles_that_appear_and_disappear_are_rows_of_their_frames(tools, samples, tmp_path):
    changing = samples / "changing.h5"
    run = pbf_tools.open(changing)
    _, out, _ = tools("to-csv", changing, "--frames", "all", "--fields", "id,density")
    rows = np.genfromtxt(io.StringIO(out), delimiter=",", names=True, dtype=None)
    assert rows["id"].tolist() == np.concatenate([run.ids[k] for k in range(8)]).tolist()
    assert set(rows["time"]) == set(run.times) - {run.times[5]}
    _, out, _ = tools("to-csv", changing, "--frames", "all", "--xyz")
    assert [n for n in out.splitlines() if " " not in n] == [str(n) for n in run.counts]
    code, out, _ = tools("to-csv", changing, "--track", 200_000_000 * 16)
    assert code == 0 and len(out.splitlines()) == 1 + 5
    code, _, err = tools("to-csv", changing, "--track", 7)
    assert code == 2 and "no particle with id 7 in any frame" in err
    # In the last frame of another file the first particle has moved, and the last is another one.
    other = shutil.copy(changing, tmp_path / "other.h5")
    with h5py.File(other, "r+") as file:
        first = file["VTKHDF/Steps/PointDataOffsets/id"][-1]
        file["VTKHDF/PointData/id"][first + 14] += 1
        file["VTKHDF/Points"][file["VTKHDF/Steps/PointOffsets"][-1]] += [0, 0.08, 0]  # 2 h
    code, out, _ = tools("compare", changing, other, "--csv", tmp_path / "d.csv")
    table = pbf_tools.read_csv(tmp_path / "d.csv")
    assert code == 0 and "2 particles at most are in one run only" in out
    assert table["particles"].tolist() == [15, 15, 15, 15, 15, 0, 15, 14]
    assert table["unmatched"].tolist() == [0, 0, 0, 0, 0, 0, 0, 2]
    assert np.allclose(table["max"], [0] * 7 + [2], atol=0.01)
    assert tools("compare", changing, other, "--max-rms", 3)[0] == 6
    assert tools("compare", changing, changing, "--max-rms", 0)[0] == 0


def test_the_program_starts_from_a_frame_written_as_particles(tools, pbf, minimal, tmp_path):
    assert tools("to-csv", minimal, "--frames", 10, "--particles", "-o", tmp_path / "p.csv")[0] == 0
    (tmp_path / "s.yaml").write_text(
        "domain: {min: [0, 0, 0], max: [2, 2, 2]}\nfluid: {spacing: 0.02}\n"
        "bodies: [{shape: file, path: p.csv}]\ntime: {step: 0.002, end: 0.004}\n"
        "solver: {prestabilize: false}\noutput: {every: 0.002}\n")
    done = subprocess.run([pbf, "run", "s.yaml", "--out", "out", "--quiet"], cwd=tmp_path,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    start, frame = pbf_tools.open(tmp_path / "out/run.vtkhdf").frames[0], \
        pbf_tools.open(minimal).frames[10]
    assert np.allclose(start["position"], frame["position"], atol=1e-7)
    assert np.allclose(start["velocity"], frame["velocity"], atol=1e-6)
    code, _, err = tools("to-csv", minimal, "--frames", "all", "--particles")
    assert code == 2 and "one frame" in err


def test_extended_xyz_holds_every_field_of_every_frame(tools, minimal):
    _, out, _ = tools("to-csv", minimal, "--frames", "0:2", "--xyz")
    lines, run = out.splitlines(), pbf_tools.open(minimal)
    assert len(lines) == 2 * 4002 and lines[0] == lines[4002] == "4000"
    assert "Properties=species:S:1:pos:R:3:" in lines[1] and "Time=0.02" in lines[4003]
    columns = re.search(r"Properties=(\S+)", lines[1])[1].split(":")
    widths = dict(zip(columns[0::3], map(int, columns[2::3])))
    assert widths == {"species": 1, "pos": 3, "density": 1, "id": 1, "velocity": 3}
    words = lines[4004 + 7].split()
    assert words[0] == "F" and len(words) == sum(widths.values())
    assert np.array_equal(np.float32(words[1:4]), run["position"][1, 7])


@pytest.mark.parametrize("frames", ["26", "-27", "5:5", "1:2:0", "x", "1:2:3:4", ""])
def test_frames_that_are_not_there_are_refused(tools, minimal, frames):
    code, _, err = tools("to-csv", minimal, f"--frames={frames}")
    assert code == 2 and "--frames" in err


def plan_count(pbf, scene):
    done = subprocess.run([pbf, "plan", scene], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return int(re.search(r": (\d+) particles", done.stdout)[1])


@pytest.mark.parametrize("arguments", [
    ("blob", "--count", 5000), ("stream", "--count", 131072), ("block",), ("block", "--count", 1),
    ("block", "--count", 5000), ("block", "--count", 16383), ("stream", "--count", 7),
    ("block", "--size", "0.3,0.3,0.3", "--box", "1,1,1", "--count", 777)], ids=str)
def test_the_program_takes_a_made_scene_and_counts_the_same(tools, pbf, tmp_path, arguments):
    scene = tmp_path / "s.yaml"
    code, out, _ = tools("make-scene", *arguments, "-o", scene)
    count = int(re.search(r": (\d+) particles", out)[1])
    wanted = arguments[arguments.index("--count") + 1] if "--count" in arguments else 16384
    assert code == 0 and plan_count(pbf, scene) == count == wanted
    warned = subprocess.run([pbf, "plan", scene], capture_output=True, text=True).stdout
    assert "warnings" not in warned  # no particle too near to one of another body


def test_a_picture_becomes_fluid_where_it_is_dark(tools, pbf, tmp_path):
    from matplotlib.image import imsave
    pixels = np.ones((40, 80, 4))
    pixels[:20, :20, :3] = 0  # a dark square, upper left
    pixels[20:, 60:] = [0, 0, 0, 0]  # black but transparent: background
    imsave(tmp_path / "p.png", pixels)
    x = fill.fill_image(str(tmp_path / "p.png"), 0.8, 0.1, 0.01, 0.5, False)
    assert len(x) == 20 * 20 * 10
    assert x[:, 0].max() < 0.2 and x[:, 2].min() > 0.2 and x[:, 1].max() < 0.1
    assert len(fill.fill_image(str(tmp_path / "p.png"), 0.8, 0.1, 0.01, 0.5, True)) == 28000
    code, out, _ = tools("make-scene", "image", "--file", tmp_path / "p.png", "--width", 0.8,
                         "--depth", 0.1, "--spacing", 0.01, "-o", tmp_path / "p.yaml")
    assert code == 0 and "4000 particles" in out and plan_count(pbf, tmp_path / "p.yaml") == 4000
    with h5py.File(tmp_path / "p_particles.h5") as file:
        low, high = file["position"][:].min(axis=0), file["position"][:].max(axis=0)
    assert np.allclose(low, [0.105, 0.055, 0.005]) and np.allclose(high, [0.295, 0.145, 0.195])


def test_a_mesh_is_filled_to_its_volume(tools, pbf, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    pyvista.Sphere(radius=3, theta_resolution=60, phi_resolution=60).save(tmp_path / "ball.stl")
    code, _, _ = tools("make-scene", "mesh", "--file", tmp_path / "ball.stl", "--width", 0.4,
                       "--spacing", 0.02, "-o", tmp_path / "ball.yaml")
    assert code == 0
    assert plan_count(pbf, tmp_path / "ball.yaml") == pytest.approx(4 / 3 * np.pi * 1000, rel=0.02)
    pyvista.Plane().save(tmp_path / "open.stl")
    code, _, err = tools("make-scene", "mesh", "--file", tmp_path / "open.stl", "--width", 0.4,
                         "--spacing", 0.02, "-o", tmp_path / "s.yaml")
    assert code == 2 and "open edges" in err


@pytest.mark.parametrize("arguments, code, text", [
    (("image", "--width", 1, "--spacing", 0.1), 2, "--file"),
    (("image", "--file", "no.png", "--width", 1, "--spacing", 0.1), 5, "no such picture"),
    (("image", "--file", "s.txt", "--width", 1, "--spacing", 0.1), 5, "cannot read the picture"),
    (("image", "--file", "s.txt", "--width", 1, "--spacing", 2), 2, "below --width"),
    (("block", "--size", "2,1,1"), 2, "larger than --box"),
    (("block", "--size", "2,1"), 2, "three numbers"),
    (("blob", "--count", 0), 2, "at least 1"), (("pond",), 2, "invalid choice"),
    (("blob", "--end", 0), 2, "--end")], ids=str)
def test_scenes_that_cannot_be_made_say_why(tools, tmp_path, monkeypatch, arguments, code, text):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "s.txt").write_text("no picture")
    result, _, err = tools("make-scene", *arguments, "-o", "s.yaml")
    assert result == code and text in err and not (tmp_path / "s.yaml").exists()


def test_optional_packages_are_named_when_they_are_missing(tools, minimal, pictures, monkeypatch,
                                                           tmp_path):
    for package, arguments in (
            ("pysplashsurf", ("surface", minimal)), ("PIL", ("video", pictures, "-o", "a.gif")),
            ("pyvista", ("make-scene", "mesh", "--file", "a.stl", "--width", 1, "--spacing", 0.1,
                         "-o", tmp_path / "s.yaml"))):
        with monkeypatch.context() as patch:
            without(patch, package)
            code, _, err = tools(*arguments)
        assert code == 4 and f"pip install {package.replace('PIL', 'pillow')}" in err
    run = pbf_tools.open(minimal)
    for package, call in (("pandas", run.log.pandas), ("pyvista", run.frames[0].polydata)):
        with monkeypatch.context() as patch:
            without(patch, package)
            with pytest.raises(pbf_tools.MissingPackage, match=f"pip install {package}"):
                call()


def test_the_log_becomes_a_data_frame(minimal):
    pytest.importorskip("pandas")
    frame = pbf_tools.open(minimal).log.pandas()
    assert len(frame) == 26 and frame.attrs["units"]["kinetic_energy"] == "J"


def test_pyvista_gets_points_and_fields(minimal):
    pytest.importorskip("pyvista")
    run = pbf_tools.open(minimal)
    data = run.frames[5].polydata()
    assert data.n_points == 4000 and np.array_equal(data["velocity"], run["velocity"][5])


def test_a_ply_file_holds_the_triangles(tmp_path):
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], float)
    faces = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], np.uint64)
    surface.write_ply(tmp_path / "t.ply", corners, faces)
    head, body = (tmp_path / "t.ply").read_bytes().split(b"end_header\n")
    assert b"element vertex 4" in head and b"element face 4" in head and len(body) == 100
    assert np.array_equal(np.frombuffer(body[:48], "<f4").reshape(4, 3), corners)
    assert np.array_equal(np.frombuffer(body[48:], "u1").reshape(4, 13)[:, 0], [3] * 4)


def test_a_surface_encloses_the_volume_of_the_fluid(tools, minimal, tmp_path):
    pytest.importorskip("pysplashsurf")
    code, out, _ = tools("surface", minimal, "--frames", 0, "-o", tmp_path, "--smoothing", 0)
    assert code == 0 and "surface_00000.ply" in out
    v, t = surface.reconstruct(pbf_tools.open(minimal)["position"][0], 0.02, 0.5, 0)
    a, b, c = (v[t[:, k].astype(int)].astype(float) for k in range(3))
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6  # divergence theorem
    assert volume == pytest.approx(4000 * 0.02**3, rel=0.05)
