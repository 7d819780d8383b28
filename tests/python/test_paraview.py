"""tools/paraview_state.py without ParaView: what it reads from the scene, what it refuses."""

import shutil
import sys
import types

import pytest
from conftest import ROOT

STATE = ROOT / "tools/paraview_state.py"


def state(monkeypatch, version, *words):
    """What the script defines, and how it ended, with nothing but a ParaView's version."""
    paraview = types.ModuleType("paraview")
    paraview.__version__ = version
    paraview.simple = types.ModuleType("paraview.simple")
    monkeypatch.setitem(sys.modules, "paraview", paraview)
    monkeypatch.setattr(sys, "argv", [str(STATE), *map(str, words)])
    defined = {}
    with pytest.raises(SystemExit) as end:
        exec(compile(STATE.read_text(), STATE, "exec"), defined)
    return defined, str(end.value)


def test_a_paraview_that_is_too_old_and_a_file_that_is_not_there_are_named(monkeypatch, minimal):
    _, said = state(monkeypatch, "5.11.0", minimal)
    assert "ParaView 5.11.0 shows only" in said and "install 5.13" in said
    _, said = state(monkeypatch, "5.13.2", "nowhere.vtkhdf")
    assert said.endswith("nowhere.vtkhdf: no such file; name a run file in PBF_RUN or as an argument")


def test_the_domain_and_the_spacing_are_those_of_the_scene(monkeypatch, minimal, tmp_path):
    defined, _ = state(monkeypatch, "5.11.0", minimal)
    assert defined["domain"](str(minimal)) == (0, 0, 0, 1.6, 0.4, 0.8)
    assert defined["spacing"](str(minimal)) == 0.02
    shutil.copy(minimal, tmp_path / "run.vtkhdf")  # without its scene
    assert defined["domain"](str(tmp_path / "run.vtkhdf")) is None
    assert defined["spacing"](str(tmp_path / "run.vtkhdf")) is None
