"""Packages that are not installed: one line with the remedy and exit code 4, no traceback."""

import os
import subprocess
import sys

import pytest
from conftest import ROOT

from pbf_tools.__main__ import COMMANDS

NEEDED = ("numpy", "h5py", "matplotlib")


def call(without, tmp_path, *words):
    """python -m pbf_tools WORDS, where importing the package `without` fails."""
    (tmp_path / without).mkdir(exist_ok=True)
    (tmp_path / without / "__init__.py").write_text("raise ImportError('it is not there')")
    path = os.pathsep.join([str(tmp_path), str(ROOT / "tools")])
    return subprocess.run([sys.executable, "-B", "-m", "pbf_tools", *map(str, words)], text=True,
                          capture_output=True, env={**os.environ, "PYTHONPATH": path}, cwd=tmp_path)


def lacks(done, remedy):
    assert done.returncode == 4, done.stderr
    assert done.stderr.count("\n") == 1 and done.stderr.startswith("pbf_tools: error: ")
    assert remedy in done.stderr


@pytest.mark.parametrize("package", NEEDED)
def test_a_needed_package_that_is_missing_is_one_line(package, minimal, tmp_path):
    lacks(call(package, tmp_path, "plot-energy", minimal), f"pip install {package}\n")


def test_no_command_fails_with_a_traceback_without_numpy(tmp_path):
    for command in COMMANDS:
        lacks(call("numpy", tmp_path, command, "--help"), f"{command} needs numpy, ")


def test_what_a_command_does_not_need_it_does_not_miss(minimal, tmp_path):
    done = call("matplotlib", tmp_path, "to-csv", minimal, "--log")
    assert done.returncode == 0 and done.stdout.startswith("time,"), done.stderr
    done = call("h5py", tmp_path, "--help")
    assert done.returncode == 0 and "plot-energy" in done.stdout
    done = call("h5py", tmp_path, "plot-enrgy")
    assert done.returncode == 2 and "did you mean plot-energy" in done.stderr


def test_optional_packages_are_named_where_they_are_needed(minimal, pictures, tmp_path):
    for package, pip, words in (
            ("PIL", "pillow", ("video", pictures, "-o", "a.gif")),
            ("pysplashsurf", "pysplashsurf", ("surface", minimal, "-o", "a.ply")),
            ("pxr", "usd-core", ("to-usd", minimal, "-o", "a.usdc")),
            ("yaml", "pyyaml", ("to-npz", minimal, "-o", "a.npz")),
            ("yaml", "pyyaml", ("to-lagrangebench", minimal, "-o", "data")),
            ("pyvista", "pyvista", ("make-scene", "mesh", "--file", "a.stl", "--width", 1,
                                    "--spacing", 0.1, "-o", "a.yaml"))):
        lacks(call(package, tmp_path, *words), f"pip install {pip}\n")
    lacks(call("none", tmp_path, "video", pictures, "--ffmpeg", "no-ffmpeg", "-o", "a.mp4"),
          "needs ffmpeg; install it, or write a.gif")
