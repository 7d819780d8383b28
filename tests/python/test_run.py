"""Running from Python: run and plan over the program, their errors and interrupts."""

import json
import os
import re
import signal
import subprocess
import sys
import time
import warnings

import numpy as np
import pytest
from conftest import DIVERGES, ROOT

import pbf_tools
from pbf_tools import program, scene_text

pytestmark = pytest.mark.usefixtures("here")


def test_a_dict_is_run_and_its_file_repeats_it(scene, pbf, tmp_path):
    run = pbf_tools.run(scene, "out/one", solver__iterations=2, time={"end": 0.1},
                        **{"bodies[0].velocity": np.array([0.5, 0, 0])})
    assert run.status == "finished" and run.counts[0] == 500 and run.times[-1] == \
        pytest.approx(0.1)
    assert "iterations: 2\n" in run.scene and "velocity: [0.5, 0, 0]" in run.scene
    assert len(run.log) > 1 and run.warnings == []
    shown = subprocess.run([pbf, "plan", "out/one.yaml", "--json"], capture_output=True)
    assert json.loads(shown.stdout)["particles"] == 500
    default = pbf_tools.run(scene)
    assert str(default.path) == "out/small/run.vtkhdf"
    with pytest.raises(pbf_tools.BadInput, match="out/one: the output folder exists; overwrite"):
        pbf_tools.run(scene, "out/one")
    assert pbf_tools.run(scene, "out/one", overwrite=True).times[-1] == pytest.approx(0.2)


def test_a_scene_without_a_name_has_that_of_its_file_and_a_dict_is_called_scene(scene, tmp_path):
    del scene["name"]
    assert pbf_tools.plan(scene)["scene"] == "scene"
    assert str(pbf_tools.run(scene).path) == "out/scene/run.vtkhdf"
    one = scene_text.write_scene({**scene, "output": {}}, tmp_path / "tank (1).yaml")
    assert pbf_tools.plan(one)["scene"] == "tank-1"
    assert str(pbf_tools.run(one).path) == "out/tank-1/run.vtkhdf"
    assert str(pbf_tools.run(one, resume=True).path) == "out/tank-1/run.vtkhdf"


def test_warnings_of_a_motion_come_before_the_run(scene):
    scene["obstacles"] = [{"name": "ball", "shape": "sphere", "center": [1, 0.2, 0.3],
                           "radius": 0.1, "motion": {"kind": "velocity",
                                                     "velocity": [0, 0, -2]}}]
    kinds = [warning["kind"] for warning in pbf_tools.plan(scene)["warnings"]]
    assert kinds == ["wall"]
    with pytest.warns(pbf_tools.PbfWarning, match=r"obstacles\[0\] \(ball\) goes through the wall"):
        pbf_tools.run(scene, "out/through")


def test_a_scene_file_is_run_as_it_stands(minimal):
    run = pbf_tools.run(ROOT / "configs/minimal.yaml", out="again", threads=2)
    assert np.array_equal(run["position"][-1], pbf_tools.open(minimal)["position"][-1])
    with pytest.raises(pbf_tools.BadInput, match="again: the output folder exists; overwrite=True"):
        pbf_tools.run(ROOT / "configs/minimal.yaml", out="again")


def test_a_run_file_is_run_again(minimal):
    run = pbf_tools.run(minimal, "again", time__end=0.02)
    assert np.array_equal(run["position"][1], pbf_tools.open(minimal)["position"][1])
    with pytest.raises(pbf_tools.BadInput, match="give out="):
        pbf_tools.run(minimal)


def test_a_run_is_planned_and_run_again_by_its_folder_too(minimal, tmp_path):
    assert pbf_tools.plan(minimal.parent)["particles"] == 4000
    assert pbf_tools.run(minimal.parent, "again", time__end=0.02).name == "minimal"
    for action in (pbf_tools.plan, pbf_tools.run):
        with pytest.raises(pbf_tools.FileError, match="no run.vtkhdf in this folder, but in .*run"):
            action(minimal.parent.parent)


def test_particle_files_of_a_dict_are_those_of_the_working_folder(scene, tmp_path):
    (tmp_path / "p.csv").write_text("x,y,z\n0.1,0.1,0.1\n0.2,0.1,0.1\n")
    scene["bodies"] = [{"shape": "file", "path": "p.csv"}]
    assert pbf_tools.plan(scene)["particles"] == 2
    assert pbf_tools.run(scene, "deep/er/out").counts[0] == 2


def test_a_plan_says_what_a_scene_needs_and_runs_nothing(scene, tmp_path):
    plan = pbf_tools.plan(scene, precision="double")
    assert plan["particles"] == 500 and plan["memory"][0]["host_peak"] > 1e6
    own = next(m for m in plan["memory"] if (m["backend"], m["precision"]) == ("cpu", "double"))
    assert plan["host_bytes"] == own["host_peak"] and plan["device_bytes"] == 0
    assert plan["disk_bytes"] == sum(f["bytes"] for f in plan["files"])
    assert plan["run_time_s"] > 0 and plan["run_time_basis"]
    assert pbf_tools.plan(ROOT / "configs/dam_break.yaml")["scene"] == "dam_break"
    assert not list(tmp_path.iterdir())
    with pytest.raises(pbf_tools.PbfError, match=r"^scene \(a dict\): fluid.spacin"):
        pbf_tools.plan({**scene, "fluid": {"spacin": 0.1}})


@pytest.mark.parametrize("changes, code, text", [
    ({"solver__iteratons": 3}, 2, "argument solver__iteratons: solver.iteratons: unknown key, did"),
    ({"time": {"step": -1}}, 2, "time.step"), ({"gravity": float("nan")}, 2, "gravity"),
    ({"backend": "gpu"}, 2, "backend"), ({"name": object()}, 2, "a object is no value"),
    ({"bodies": [{"shape": "file", "path": "none.csv"}]}, 5, "none.csv")], ids=str)
def test_what_cannot_be_is_an_exception_with_the_programs_words(scene, changes, code, text):
    with pytest.raises(pbf_tools.ToolError) as error:
        pbf_tools.run(scene, "out", **changes)
    assert error.value.exit_code in (code, 2) and text in str(error.value)
    assert not os.path.exists("out")


@pytest.mark.parametrize("call", [pbf_tools.plan, pbf_tools.run, pbf_tools.batch])
@pytest.mark.parametrize("changes, said", [
    ({"fluid": {"spacin": 0.1, "spacing": 0.1}},
     "scene (a dict): fluid.spacin: unknown key, did you mean fluid.spacing?"),
    ({"bodies": [{"shape": "blok"}]}, 'scene (a dict): bodies[0].shape: "blok" is not one of'),
    ({"base": "none.yaml"}, "its path counts from the working folder"),
    ({"bodies": [{"shape": "file", "path": "none.csv"}]}, "relative to the working folder")])
def test_an_error_in_a_dict_names_its_key_and_no_file(scene, call, changes, said):
    with pytest.raises(pbf_tools.PbfError) as error:
        call(scene | changes)
    assert said in str(error.value)
    assert not re.search(r"yaml:\d|scene\.yaml|--set", str(error.value))


@pytest.mark.parametrize("call, argument, said", [
    (pbf_tools.run, "overwrit", "neither an argument of run nor a key of a scene, did you mean "
                                "overwrite?"),
    (pbf_tools.run, "max_waltime", "neither an argument of run nor a key of a scene, did you mean "
                                   "max_walltime?"),
    (pbf_tools.plan, "overwrite", "neither an argument of plan nor a key of a scene; there are "
                                  "scene, base_folder, program"),
    (pbf_tools.batch, "job", "neither an argument of batch nor a key of a scene, did you mean jobs?"),
    (pbf_tools.run, "solver__iteration", "solver.iteration: unknown key, did you mean "
                                         "solver.iterations?"),
    (pbf_tools.run, "treads", "treads: unknown key, did you mean threads?")])
def test_a_mistyped_argument_is_named_with_the_nearest(scene, call, argument, said):
    with pytest.raises(pbf_tools.PbfError) as error:
        call(scene, **{argument: 3})
    assert str(error.value) == f"argument {argument}: {said}"
    assert not os.path.exists("out")


@pytest.mark.parametrize("call", [pbf_tools.plan, pbf_tools.run, pbf_tools.batch, pbf_tools.open,
                                  pbf_tools.read_batch])
def test_a_path_that_is_not_there_is_one_kind_of_error(call, tmp_path):
    (tmp_path / "column.yaml").touch()
    path = "colum.yaml" if call not in (pbf_tools.open, pbf_tools.read_batch) else "nowhere"
    with pytest.raises(pbf_tools.NotThere, match=f"^{path}: .*no such") as error:
        call(path)
    assert isinstance(error.value, pbf_tools.FileError) and error.value.exit_code == 5
    assert not isinstance(error.value, (KeyError, pbf_tools.BadInput))  # of names in a run
    assert ("did you mean column.yaml?" in str(error.value)) == (path == "colum.yaml")


@pytest.mark.parametrize("wrong", [None, 7, ["a.yaml", "b.yaml"]])
@pytest.mark.parametrize("call", [pbf_tools.plan, pbf_tools.run])
def test_what_is_no_scene_is_refused(call, wrong):
    with pytest.raises(pbf_tools.BadInput, match="expected a scene: a path or a dict") as error:
        call(wrong)
    assert ("batch" in str(error.value)) == isinstance(wrong, list)


def test_a_file_that_the_package_has_not_written_is_kept(scene, tmp_path):
    (tmp_path / "mine.yaml").write_text("notes")
    with pytest.raises(pbf_tools.BadInput, match="mine.yaml: .* another file is there"):
        pbf_tools.run(scene, "mine")
    assert (tmp_path / "mine.yaml").read_text() == "notes"
    (tmp_path / "file").touch()
    with pytest.raises(pbf_tools.FileError, match="Not a directory|File exists"):
        pbf_tools.run(scene, "file/out")


def test_a_stop_of_the_guard_carries_the_run(scene):
    with pytest.raises(pbf_tools.Diverged, match="stopped by the guard: at update") as error, \
            pytest.warns(pbf_tools.PbfWarning):
        pbf_tools.run({**scene, **DIVERGES}, "out")
    assert error.value.exit_code == 3
    assert error.value.run.status == "diverged" and len(error.value.run.log) > 0


def test_a_limit_of_time_stops_a_run_that_goes_on(scene):
    scene["time"]["end"] = 9000
    with pytest.raises(pbf_tools.Stopped, match="resume=True") as error:
        pbf_tools.run(scene, "out", max_walltime=0.3)
    assert error.value.exit_code == 75 and error.value.run.status == "stopped"
    done = int(error.value.run.updates[-1])
    scene["time"]["end"] = 0.004 * (done + 100)
    run = pbf_tools.run(scene, "out", resume=True)
    assert run.status == "finished" and run.updates[-1] >= done + 95


def test_warnings_of_the_program_are_warnings_and_with_strict_errors(scene):
    with pytest.warns(pbf_tools.PbfWarning, match="output.every"):
        pbf_tools.run(scene, "out", output={"every": 1})
    with pytest.raises(pbf_tools.PbfError, match="--strict") as error:
        pbf_tools.run(scene, "out", output={"every": 1}, strict=True, overwrite=True)
    assert error.value.exit_code == 6 and error.value.run is None  # the run there is another


def script(text, folder, **more):
    return subprocess.Popen([sys.executable, "-c", text], cwd=folder, text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            env={**os.environ, "PYTHONPATH": str(ROOT / "tools"), **more},
                            start_new_session=True)


@pytest.mark.parametrize("call, file", [
    ("run(scene, 'out')", "out/run.vtkhdf"),
    ("batch(scene, {'solver.iterations': [1, 2]}, 'out', jobs=2)",
     "out/out_iterations=2/run.vtkhdf")])
def test_an_interrupt_leaves_a_run_that_goes_on(scene, tmp_path, call, file):
    scene["time"]["end"] = 9000
    scene = scene_text.plain(scene, "scene")
    process = script(f"import pbf_tools\nscene = {scene!r}\npbf_tools.{call}", tmp_path)
    for _ in range(600):
        if (tmp_path / file).exists() or process.poll() is not None:
            break
        time.sleep(0.05)
    time.sleep(0.2)
    os.killpg(process.pid, signal.SIGINT)  # as Ctrl-C in a terminal
    _, err = process.communicate(timeout=60)
    assert "KeyboardInterrupt" in err and "stopped early, after saving" in err
    run = pbf_tools.open(tmp_path / file)
    assert run.status == "stopped" and (tmp_path / file).with_name("checkpoint.h5").exists()


def test_the_program_is_the_one_named_else_that_of_the_environment(pbf, tmp_path, monkeypatch):
    other = tmp_path / "bin/pbf"
    other.parent.mkdir()
    other.symlink_to(pbf)
    assert program.find() == str(pbf) and program.find(other) == str(other)
    monkeypatch.setenv("PATH", str(other.parent), prepend=os.pathsep)
    assert program.find() == str(pbf)
    monkeypatch.delenv("PBF")
    assert program.find() == str(other)
    monkeypatch.setattr(program.shutil, "which", lambda name: None)
    monkeypatch.setattr(program.os, "access", lambda *_: False)
    with pytest.raises(pbf_tools.MissingPackage, match="not on the PATH, .*; build it"):
        program.find()


def test_a_package_that_pip_took_out_of_its_tree_finds_the_program_built_in_the_working_folder(
        pbf, tmp_path, monkeypatch):
    monkeypatch.delenv("PBF")
    monkeypatch.setattr(program.shutil, "which", lambda name: None)
    monkeypatch.setattr(program, "__file__", str(tmp_path / "lib/pbf_tools/program.py"))
    monkeypatch.chdir(tmp_path)
    with pytest.raises(pbf_tools.MissingPackage, match="no build/pbf in the working folder"):
        program.find()
    (tmp_path / "build/pbf").mkdir(parents=True)  # a folder is no program
    with pytest.raises(pbf_tools.MissingPackage):
        program.find()
    (tmp_path / "build/pbf").rmdir()
    (tmp_path / "build/pbf").symlink_to(pbf)
    assert program.find() == str(tmp_path / "build/pbf")


def test_what_is_named_and_is_no_program_is_refused(tmp_path, monkeypatch):
    (tmp_path / "text").touch()
    with pytest.raises(pbf_tools.BadInput, match=r"text \(program\): is no program"):
        program.find("./text")
    monkeypatch.setenv("PBF", "none")
    with pytest.raises(pbf_tools.BadInput, match=r"none \(the environment variable PBF\)"):
        pbf_tools.plan("s.yaml")


def test_a_program_that_is_killed_says_so(tmp_path):
    fake = tmp_path / "fake"
    fake.write_text("#!/bin/sh\ncase $1 in plan) echo '{\"scene\":\"s\",\"files\":[]}';;\n"
                    "*) kill -9 $$;; esac\n")
    fake.chmod(0o755)
    (tmp_path / "s.yaml").touch()
    with pytest.raises(pbf_tools.PbfError, match="ended by signal 9") as error:
        pbf_tools.run("s.yaml", "out", program=fake)
    assert error.value.exit_code == 137


class Screen:
    """stderr as a terminal or, with the name of its module, as a notebook."""

    def __init__(self, terminal):
        self.text, self.terminal = "", terminal

    def isatty(self):
        return self.terminal

    def write(self, text):
        self.text += text

    def flush(self):
        pass


class NotebookScreen(Screen):
    __module__ = "ipykernel.iostream"


@pytest.mark.parametrize("screen, overwritten", [
    (Screen(True), True), (NotebookScreen(False), True), (Screen(False), False)])
def test_progress_is_one_line_that_is_overwritten(monkeypatch, tmp_path, screen, overwritten):
    fake = tmp_path / "fake"
    fake.write_text("#!/bin/sh\necho 'pbf 0.1' >&2\necho '  5 %  update 10/200' >&2\n"
                    "echo '100 %  update 200/200' >&2\n")
    fake.chmod(0o755)
    monkeypatch.setattr(sys, "stderr", screen)
    assert program.call(str(fake), [], None) == (0, "")
    assert screen.text == ("\r5 %  update 10/200\r100 %  update 200/200\n" if overwritten else "")
    screen.text = ""
    program.call(str(fake), [], False)
    assert screen.text == ""
    program.call(str(fake), [], True)
    assert screen.text.count("\r") == (2 if overwritten else 0) and "200/200\n" in screen.text


def test_the_programs_own_lines_of_progress_are_known(scene):
    """What the program prints, and not what this package believes that it prints."""
    scene["time"]["end"] = 9000
    seen = []

    class Spy(program.Line):
        def show(self, text):
            seen.append(text)

    with pytest.MonkeyPatch.context() as patch, pytest.raises(pbf_tools.Stopped):
        patch.setattr(program, "Line", Spy)
        pbf_tools.run(scene, "out", time__end=40, fluid__spacing=0.02, max_walltime=5)
    assert seen and all(re.match(r"\d+ %  update \d+/\d+", line) for line in seen)


def test_nothing_warns_where_nothing_is_wrong(scene):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        pbf_tools.run(scene, "out")
        pbf_tools.batch(scene, None, "batch")


def test_a_warning_made_an_error_ends_the_program_too(scene):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(pbf_tools.PbfWarning, match="output.every"):
            pbf_tools.run(scene, "out", output={"every": 9000}, time__end=8000)
