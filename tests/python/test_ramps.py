"""make-scene ramps: random scenes for learning, against the program and geometry computed here."""

import re
import subprocess

import numpy as np
import pytest

yaml = pytest.importorskip("yaml")


def made(tools, folder, *words):
    code, out, err = tools("make-scene", "ramps", *words, "-o", folder)
    assert code == 0 and err == "", err
    return sorted(folder.glob("*.yaml"))


def plan(pbf, scene, *words):
    """Number of particles; the scene gives neither an error nor a warning."""
    done = subprocess.run([pbf, "plan", scene, *words], capture_output=True, text=True)
    assert done.returncode == 0 and done.stderr == "" and "warning" not in done.stdout, \
        (scene.read_text(), done.stderr)
    return int(re.search(r": (\d+) particles", done.stdout)[1])


@pytest.mark.parametrize("dimensions, particles", [(2, 200), (2, 2000), (3, 1000), (3, 4000)])
def test_ramps_run_without_warnings_and_have_about_as_many_particles_as_asked(
        tools, pbf, tmp_path, dimensions, particles):
    scenes = made(tools, tmp_path / "r", "--number", 12, "--dimensions", dimensions, "--particles",
                  particles, "--seed", 5)
    assert len(scenes) == 12
    counts = []
    for scene in scenes:
        counts.append(plan(pbf, scene))
        # No water begins in a plate, where the program would leave it out.
        assert plan(pbf, scene, "--set", "obstacles=[]") == counts[-1]
    assert 0.7 * particles < min(counts) < max(counts) < 1.3 * particles
    assert np.mean(counts) == pytest.approx(particles, rel=0.15)


def corners(plate, flat):
    """Of a plate, (4 or 8, D), turned about y or a level axis as the keys mean it: written out as
    two rotations that share nothing with the package."""
    half = np.array(plate["size"]) / 2
    signs = np.array(np.meshgrid(*[[-1, 1]] * len(half), indexing="ij")).reshape(len(half), -1).T
    p = signs * half
    a = np.radians(plate["turn_angle"])
    if flat:  # by the right-hand rule about y, x turns towards -z
        return plate["center"] + np.column_stack([np.cos(a) * p[:, 0] + np.sin(a) * p[:, 1],
                                                  -np.sin(a) * p[:, 0] + np.cos(a) * p[:, 1]])
    x, y, _ = plate["turn_axis"]
    along = p[:, 0] * x + p[:, 1] * y  # the part along the axis stays
    across = p[:, 0] * y - p[:, 1] * x  # to the right of it
    right = np.cos(a) * across + np.sin(a) * p[:, 2]
    up = -np.sin(a) * across + np.cos(a) * p[:, 2]
    return plate["center"] + np.column_stack([along * x + right * y, along * y - right * x, up])


def apart(a, b):
    """Distance of two boxes by their corners along the best of many directions: below the true one
    (a separating plane)."""
    directions = np.random.default_rng(1).normal(size=(4000, a.shape[1]))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    u, v = directions @ a.T, directions @ b.T
    return max((v.min(axis=1) - u.max(axis=1)).max(), (u.min(axis=1) - v.max(axis=1)).max())


@pytest.mark.parametrize("dimensions", [2, 3])
def test_plates_are_in_the_box_apart_from_each_other_and_thicker_than_two_spacings(
        tools, tmp_path, dimensions):
    several, gap = 0, 3 if dimensions == 2 else 2.5
    for path in made(tools, tmp_path / "r", "--number", 40, "--dimensions", dimensions):
        scene = yaml.safe_load(path.read_text())
        d, plates = scene["fluid"]["spacing"], scene["obstacles"]
        assert 1 <= len(plates) <= 4
        places = [corners(p, dimensions == 2) for p in plates]
        for plate, c in zip(plates, places):
            assert min(plate["size"]) >= 2 * d * 0.999
            assert np.all(c > np.array(scene["domain"]["min"]) + 0.99 * gap * d)
            assert np.all(c < np.array(scene["domain"]["max"]) - 0.99 * gap * d)
        for k, c in enumerate(places):
            for other in places[:k]:
                several += 1
                assert apart(c, other) > 0.8 * gap * d
    assert several > 10


def test_sample_k_is_the_same_for_every_number_and_another_for_every_seed(tools, tmp_path):
    few = made(tools, tmp_path / "few", "--seed", 3, "--number", 3)
    many = made(tools, tmp_path / "many", "--seed", 3, "--number", 7)
    other = made(tools, tmp_path / "other", "--seed", 4, "--number", 7)
    assert [p.read_text() for p in few] == [p.read_text() for p in many[:3]]
    geometry = [p.read_text().partition("bodies:")[2] for p in [*many, *other]]
    assert len(set(geometry)) == 14
    # Further ones go into the same folder, and what is there stays.
    stamps = [p.stat().st_ino for p in few]
    more = made(tools, tmp_path / "few", "--seed", 3, "--number", 7)
    assert [p.read_text() for p in more] == [p.read_text() for p in many]
    assert [p.stat().st_ino for p in few] == stamps


def test_a_set_has_blocks_and_balls_at_rest_and_in_motion(tools, tmp_path):
    bodies = [yaml.safe_load(p.read_text())["bodies"] for p in made(tools, tmp_path / "r", "--number", 40)]
    assert all(len(b) == 1 for b in bodies)
    kinds = {(b[0]["shape"], "velocity" in b[0]) for b in bodies}
    assert kinds == {(s, v) for s in ("block", "sphere") for v in (False, True)}
    for b in bodies:
        if "velocity" in b[0]:
            assert 0.5 <= np.hypot(*b[0]["velocity"]) <= 2 and b[0]["velocity"][1] <= 0


@pytest.mark.parametrize("words, frames, every", [
    ((), 400, 0.0025), (("--dimensions", 3, "--frames", 2), 2, 0.0025),
    (("--every", 0.007, "--frames", 5), 5, 0.007), (("--dimensions", 3, "--particles", 1000), 400, 0.005)])
def test_a_run_has_the_frames_asked_for_at_equal_times(tools, pbf, tmp_path, words, frames, every):
    scene, = made(tools, tmp_path / "r", "--number", 1, *words)
    keys = yaml.safe_load(scene.read_text())
    assert keys["output"]["every"] == every
    assert keys["time"]["step"] <= 0.015 * np.sqrt(2 * keys["fluid"]["spacing"] / 9.81) * 1.001
    text = subprocess.run([pbf, "plan", scene], capture_output=True, text=True, check=True).stdout
    assert f"({frames} frames)" in text


@pytest.mark.parametrize("words, text", [
    (("--number", 0), "--number must be from 1"), (("--number", 100001), "--number must be from 1"),
    (("--seed", -1), "--seed must be"), (("--particles", 199), "at least 200 with --dimensions 2"),
    (("--particles", 999, "--dimensions", 3), "at least 1000 with --dimensions 3"),
    (("--frames", 1), "--frames must be"), (("--every", 0), "--every must be above 0"),
    (("--every", "nan"), "--every must be above 0"), (("--dimensions", 1), "invalid choice"),
    (("--count", 100), "give ramps --particles")], ids=str)
def test_ramps_that_cannot_be_made_say_why(tools, tmp_path, words, text):
    code, _, err = tools("make-scene", "ramps", *words, "-o", tmp_path / "r")
    assert code == 2 and text in err and not (tmp_path / "r").exists()


def test_options_of_ramps_are_refused_for_other_shapes(tools, tmp_path):
    code, _, err = tools("make-scene", "block", "--particles", 100, "-o", tmp_path / "s.yaml")
    assert code == 2 and "--particles is of ramps" in err and not (tmp_path / "s.yaml").exists()


def test_scenes_of_another_set_in_the_folder_are_named_and_stay(tools, tmp_path):
    folder = tmp_path / "r"
    made(tools, folder, "--seed", 1, "--number", 3)
    before = {p: p.read_bytes() for p in folder.iterdir()}
    for words in (("--seed", 2, "--number", 3), ("--seed", 1, "--number", 2)):
        code, _, err = tools("make-scene", "ramps", *words, "-o", folder)
        assert code == 2 and "ramp_0000" in err and "not of this set" in err
    assert {p: p.read_bytes() for p in folder.iterdir()} == before
    (tmp_path / "file").touch()
    code, _, err = tools("make-scene", "ramps", "-o", tmp_path / "file")
    assert code == 5 and "cannot write" in err
