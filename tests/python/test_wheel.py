"""tools/wheel: what is in the wheel, and that the installed program and package find each other."""

import base64
import csv
import hashlib
import io
import os
import subprocess
import sys
import zipfile

import pytest
from conftest import ROOT

CLEAN = {"PATH": "/usr/bin:/bin"}
SCENE = {"domain": {"min": [0, 0, 0], "max": [0.4, 0.4, 0.4]}, "fluid": {"spacing": 0.04},
         "bodies": [{"shape": "block", "min": [0, 0, 0], "max": [0.2, 0.2, 0.2]}],
         "time": {"step": 0.004, "end": 0.02}}


def pack(*options):
    return subprocess.run([ROOT / "tools/wheel", *options], capture_output=True, text=True)


@pytest.fixture(scope="module")
def wheel(pbf, tmp_path_factory):
    folder = tmp_path_factory.mktemp("wheel")
    done = pack("--program", pbf, "--out", folder)
    assert done.returncode == 0, done.stderr
    (path,) = folder.iterdir()
    return path


@pytest.fixture
def environment(wheel, tmp_path):
    """A virtual environment with the wheel; numpy and h5py are those of the tests."""
    home = tmp_path / "venv"
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", home], check=True)
    pip(home, "install", "--no-index", "--no-deps", wheel)
    site = next(home.glob("lib/python*/site-packages"))
    (site / "zz_of_the_tests.pth").write_text("\n".join(p for p in sys.path if "-packages" in p))
    return home


def pip(home, *words):
    done = subprocess.run([sys.executable, "-m", "pip", "--python", home / "bin/python",
                           "--disable-pip-version-check", *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def call(folder, *command, env=CLEAN):
    return subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True)


def test_the_record_of_a_wheel_has_the_hash_of_every_file_in_it(wheel):
    with zipfile.ZipFile(wheel) as packed:
        (own,) = [n for n in packed.namelist() if n.endswith(".dist-info/RECORD")]
        rows = list(csv.reader(io.StringIO(packed.read(own).decode())))
        assert sorted(packed.namelist()) == sorted(name for name, _, _ in rows)
        for name, digest, size in rows:
            if name == own:
                assert (digest, size) == ("", "")
                continue
            content = packed.read(name)
            algorithm, text = digest.split("=", 1)
            assert base64.urlsafe_b64decode(text + "=") == hashlib.new(algorithm, content).digest()
            assert int(size) == len(content)


def test_a_wheel_holds_program_scenes_package_and_licences(wheel):
    with zipfile.ZipFile(wheel) as packed:
        names = packed.namelist()
        metadata = packed.read(next(n for n in names if n.endswith("METADATA"))).decode()
        tags = packed.read(next(n for n in names if n.endswith("/WHEEL"))).decode()
    for end in (".data/scripts/pbf", "share/pbf/configs/stability.yaml", "pbf_tools/__init__.py",
                "pbf_tools/data/lobovsky_2014_front_h600.csv",
                "pbf_tools/data/stages.json", "licenses/pbf.txt",
                "licenses/libhdf5-dev.txt"):
        assert any(n.endswith(end) for n in names), end
    assert not any(n.endswith(".pyc") for n in names)
    for need in ("numpy", "h5py", "matplotlib"):
        assert f"Requires-Dist: {need} >=" in metadata
    assert f"Tag: {wheel.stem.split('-', 2)[2]}\n" in tags


def test_the_same_content_makes_the_same_wheel(wheel, pbf, tmp_path):
    assert pack("--program", pbf, "--out", tmp_path).returncode == 0
    assert (tmp_path / wheel.name).read_bytes() == wheel.read_bytes()


def test_an_installed_wheel_works_from_any_folder(environment, tmp_path):
    """The suite of `stability` and the scenes are found; exit codes and stdout are the program's."""
    assert call(tmp_path, environment / "bin/pbf", "info").stdout.startswith("pbf 0.")
    done = call(tmp_path, environment / "bin/pbf", "stability", "--reduced", "points_two_coincident")
    assert done.returncode == 0, done.stdout + done.stderr
    scene = environment / "share/pbf/configs/dam_break.yaml"
    done = call(tmp_path, environment / "bin/pbf", "run", scene, "--set", "time.end=0.01",
                "--max-walltime", "0.001", "--out", "out")
    assert done.returncode == 75, done.stderr
    done = call(tmp_path, environment / "bin/python", "-m", "pbf_tools", "--help")
    assert done.returncode == 0 and "plot-study" in done.stdout


def test_pbf_tools_of_a_wheel_runs_the_program_of_that_wheel(environment, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    (other / "pbf").write_text("#!/bin/sh\nexit 1\n")
    (other / "pbf").chmod(0o755)
    code = (f"import pbf_tools, pbf_tools.program as p; print(p.find())\n"
            f"run = pbf_tools.run({SCENE!r}, 'out'); print(run.times[-1])")
    done = call(tmp_path, environment / "bin/python", "-c", code,
                env={"PATH": f"{other}:/usr/bin:/bin"})
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == [str(environment / "bin/pbf"), "0.02"]
    # One that is named goes first, and a package of another place does not know the wheel.
    for more in ({"PBF": str(other / "pbf")}, {"PYTHONPATH": str(ROOT / "tools")}):
        done = call(tmp_path, environment / "bin/python", "-c",
                    "import pbf_tools.program as p; print(p.find())",
                    env={"PATH": f"{other}:/usr/bin:/bin", **more})
        assert done.stdout.strip() == str(other / "pbf")


def test_a_wheel_in_a_folder_of_its_own_finds_its_program(wheel, environment, tmp_path):
    home = tmp_path / "target"
    pip(environment, "install", "--no-index", "--no-deps", "--target", home, wheel)
    pip(environment, "uninstall", "--yes", "pbf")
    done = call(tmp_path, environment / "bin/python", "-c",
                "import pbf_tools.program as p; print(p.find())",
                env={**CLEAN, "PYTHONPATH": str(home)})
    assert done.stdout.strip() == str(home / "bin/pbf"), done.stderr
    done = call(tmp_path, home / "bin/pbf", "stability", "--reduced", "points_two_coincident")
    assert done.returncode == 0, done.stdout + done.stderr


def test_uninstalling_leaves_nothing(environment, tmp_path):
    call(tmp_path, environment / "bin/python", "-c", "import pbf_tools")  # leaves compiled files
    assert (environment / "share/pbf/configs").is_dir()
    pip(environment, "uninstall", "--yes", "pbf")
    left = [p for p in environment.rglob("*") if "pbf" in p.name and p.is_file()]
    assert left == []
    assert not (environment / "share").exists() or os.listdir(environment / "share") == []


@pytest.mark.parametrize("options, said", [
    (["--program", "/etc/hostname"], "/etc/hostname: is no program that can be run"),
    (["--program", "/nowhere/pbf"], "/nowhere/pbf: is no program that can be run"),
    (["--program", "/bin/true", "--cuda"], "--cuda says how to build"),
    (["--jobs"], "--jobs needs a value"),
    (["--fast"], "unknown argument '--fast'"),
])
def test_a_wheel_that_cannot_be_is_refused_with_the_reason(options, said, tmp_path):
    done = pack(*options, "--out", tmp_path) if options != ["--jobs"] else pack(*options)
    assert done.returncode == 2
    assert said in done.stderr
    assert list(tmp_path.iterdir()) == []
