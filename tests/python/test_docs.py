"""What the documents show works: doctests, the example, the README, --help, tools/figures."""

import doctest
import importlib
import os
import pkgutil
import re
import shutil
import subprocess
import sys

import pytest
from conftest import ROOT
from matplotlib.image import imread

import pbf_tools
from pbf_tools.__main__ import COMMANDS

ENVIRONMENT = {**os.environ, "PYTHONPATH": str(ROOT / "tools"), "PYTHONDONTWRITEBYTECODE": "1",
               "PYTHON": sys.executable}


def test_the_examples_in_docstrings_hold(minimal, tmp_path, monkeypatch):
    shutil.copy(minimal, tmp_path / "run.vtkhdf")
    monkeypatch.chdir(tmp_path)
    tried = 0
    for module in pkgutil.iter_modules(pbf_tools.__path__, "pbf_tools."):
        result = doctest.testmod(importlib.import_module(module.name))
        assert result.failed == 0, module.name
        tried += result.attempted
    assert tried > 20


def test_every_command_explains_itself_with_an_example(tools):
    for command in COMMANDS:
        code, out, _ = tools(command, "--help")
        assert code == 0 and f"python -m pbf_tools {command} " in out
    code, out, _ = tools("--help")
    assert code == 0 and "Example:" in out and all(c in out for c in COMMANDS)


def run_python(arguments, folder):
    done = subprocess.run([sys.executable, *arguments], cwd=folder, env=ENVIRONMENT,
                          capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture
def demo(minimal, tmp_path):
    """A folder with out/dam_break/run.vtkhdf, as after tools/demo."""
    (tmp_path / "out/dam_break").mkdir(parents=True)
    shutil.copy(minimal, tmp_path / "out/dam_break/run.vtkhdf")
    return tmp_path


def test_the_example_script_runs(demo):
    out = run_python([ROOT / "tools/example.py"], demo)
    assert "4000 particles" in out and "energy: 62.78 J at the start" in out


def test_the_readmes_python_examples_run(demo):
    blocks = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    assert len(blocks) >= 2 and any("pbf_tools.open" in b for b in blocks)
    for block in blocks:
        assert run_python(["-c", block], demo).strip()


def test_the_figures_of_the_readme_are_drawn_again_from_committed_times(tmp_path):
    done = subprocess.run([ROOT / "tools/figures", "--from-data", "--out", tmp_path], text=True,
                          env=ENVIRONMENT, capture_output=True)
    assert done.returncode == 0, done.stderr
    readme = (ROOT / "README.md").read_text()
    for name in ("reference_speedup", "reference_stages"):
        committed = imread(ROOT / f".github/{name}.png")
        assert abs(imread(tmp_path / f"{name}.png").shape[1] / committed.shape[1] - 1) < 0.05
        assert f".github/{name}.png" in readme
    done = subprocess.run([ROOT / "tools/figures", "--everything"], capture_output=True, text=True)
    assert done.returncode == 2 and "--everything" in done.stderr
