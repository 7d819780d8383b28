"""cmake --install: the program and its scenes work from any folder, wherever they are put."""

import shutil
import subprocess

import pytest


@pytest.fixture(scope="module")
def installed(pbf, tmp_path_factory):
    prefix = tmp_path_factory.mktemp("prefix")
    subprocess.run(["cmake", "--install", pbf.parent, "--prefix", prefix], check=True,
                   capture_output=True)
    return prefix


def call(folder, *command):
    clean = {"PATH": "/usr/bin:/bin", "HOME": str(folder)}
    return subprocess.run(command, cwd=folder, env=clean, capture_output=True, text=True)


def test_an_installed_program_runs_an_installed_scene(installed, tmp_path):
    done = call(tmp_path, installed / "bin/pbf", "run", installed / "share/pbf/configs/minimal.yaml",
                "--set", "time.end=0.01", "--out", "out")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out/DONE").exists()


def test_the_suite_of_stability_is_found_from_any_folder_and_after_a_move(installed, tmp_path):
    moved = tmp_path / "moved"
    shutil.copytree(installed, moved)
    for place in (installed, moved):
        done = call(tmp_path, place / "bin/pbf", "stability", "--reduced", "points_two_coincident")
        assert done.returncode == 0, done.stdout + done.stderr
        assert "1 cases on cpu float, reduced: 0 failed" in done.stdout


def test_a_build_finds_its_suite_from_any_folder(pbf, tmp_path):
    done = call(tmp_path, pbf, "stability", "--reduced", "points_two_coincident")
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_program_alone_says_which_file_is_missing(pbf, tmp_path):
    shutil.copy(pbf, tmp_path / "pbf")
    done = call(tmp_path, tmp_path / "pbf", "stability")
    assert done.returncode != 0
    assert "configs/stability.yaml" in done.stderr
