"""Runs are named by their file or by their folder, in every command and in Python."""

import shutil

import h5py
import pytest
from conftest import drawn

import pbf_tools
from pbf_tools import logs


@pytest.fixture
def sweep(minimal, tmp_path):
    """A folder with the runs a and b, as those of a batch."""
    for name in "ab":
        (tmp_path / "sweep" / name).mkdir(parents=True)
        shutil.copy(minimal, tmp_path / "sweep" / name)
    return tmp_path / "sweep"


def status(folder, text):
    with h5py.File(folder / "run.vtkhdf", "r+") as file:
        file["pbf"].attrs["status"] = text


@pytest.mark.parametrize("words", [
    ("plot-log", "front_x"), ("plot-energy",), ("plot-stages",), ("compare",), ("plot-front",
                                                                            "--reference",
                                                                            "martin-moyce")])
def test_a_plot_of_a_run_folder_is_that_of_its_file(tools, minimal, tmp_path, words):
    said = []
    for run in (minimal, minimal.parent):
        runs = (run, run) if words[0] == "compare" else (run,)
        code, out, err = tools(words[0], *runs, *words[1:], "-o", tmp_path / "a.png")
        assert code == 0 and not err and drawn(tmp_path / "a.png")
        said.append(out)
    assert said[0] == said[1]


def test_a_run_folder_is_read_as_its_file(tools, minimal):
    assert pbf_tools.open(minimal.parent).path == minimal
    assert tools("to-csv", minimal.parent, "--log") == tools("to-csv", minimal, "--log")


def test_a_run_folder_that_a_command_reads_keeps_its_file(tools, sweep):
    before = (sweep / "a/run.vtkhdf").read_bytes()
    code, _, err = tools("to-csv", sweep / "a", "--log", "-o", sweep / "a/run.vtkhdf")
    assert code == 2 and "which this command reads and would overwrite" in err
    assert (sweep / "a/run.vtkhdf").read_bytes() == before


@pytest.mark.parametrize("command", [("plot-log",), ("plot-energy",), ("plot-gauges",),
                                     ("plot-stages",), ("plot-front",), ("to-csv",), ("surface",)])
def test_a_folder_without_a_run_says_where_runs_are(tools, sweep, tmp_path, command):
    code, _, err = tools(*command, sweep)
    assert code == 5 and "no run.vtkhdf in this folder, but in 2 below it" in err
    assert f"{sweep}/a, {sweep}/b" in err and f"{sweep}/*/run.vtkhdf" in err


def test_a_folder_without_a_run_says_what_is_in_it(sweep, tmp_path):
    def message(folder):
        with pytest.raises(pbf_tools.FileError) as caught:
            pbf_tools.open(folder)
        return str(caught.value)

    assert "plot-batch" not in message(sweep)
    (sweep / "summary.csv").write_text("name\n")
    assert f"plot-batch {sweep}" in message(sweep)
    shutil.rmtree(sweep / "b")
    assert message(sweep).endswith(f"but in {sweep}/a; name that")
    (sweep / "a/run.vtkhdf").rename(sweep / "a/mine.vtkhdf")
    assert f"but {sweep}/a/mine.vtkhdf; name the file" in message(sweep / "a")
    assert "the folder that `pbf run --out` wrote" in message(sweep)
    (sweep / "scene.resolved.yaml").write_text("")
    assert "writes no frames; give its scene `output: {}`" in message(sweep)
    with pytest.raises(pbf_tools.FileError, match="no such file"):
        pbf_tools.open(tmp_path / "none")


@pytest.mark.parametrize("text, said", [
    ("running", "is under way, or was killed"), ("stopped", "was stopped early"),
    ("diverged", "was stopped by the guard")])
def test_a_run_that_has_not_finished_is_drawn_with_a_note(tools, sweep, tmp_path, text, said):
    status(sweep / "a", text)
    for words in (("plot-log", sweep / "a", sweep / "b", "front_x"), ("plot-stages", sweep / "a")):
        code, _, err = tools(*words, "-o", tmp_path / "a.png")
        assert code == 0 and err.count("note:") == 1
        assert f"{sweep / 'a'}: this run {said}; it is shown up to 0.5 s" in err


def test_a_run_that_has_measured_nothing_yet_is_an_error(tools, sweep, tmp_path):
    with h5py.File(sweep / "a/run.vtkhdf", "r+") as file:
        file["pbf/log"].visititems(
            lambda _, d: d.resize(0, axis=0) if isinstance(d, h5py.Dataset) else None)
    code, _, err = tools("plot-energy", sweep / "a", "-o", tmp_path / "a.png")
    assert code == 2 and "has not measured anything yet" in err and "Traceback" not in err


def test_runs_are_told_apart_by_folder_name_or_path(minimal, sweep, tmp_path):
    assert logs.short_names([str(sweep / "a"), str(sweep / "b/run.vtkhdf")]) == ["a", "b"]
    (tmp_path / "a").mkdir()
    shutil.copy(minimal, tmp_path / "a/run.vtkhdf")
    same = [str(sweep / "a"), str(tmp_path / "a")]
    assert logs.short_names(same) == same


def test_the_stages_of_several_runs_have_a_bar_each(tools, sweep, tmp_path):
    code, _, _ = tools("plot-stages", sweep / "a", sweep / "b", "-o", tmp_path / "a.svg")
    assert code == 0
    (tmp_path / "t.csv").write_text("a,b\n1,2\n")
    code, _, err = tools("plot-stages", sweep / "a", tmp_path / "t.csv", "-o", tmp_path / "b.png")
    assert code == 2 and "not both" in err


@pytest.mark.parametrize("column, meant", [
    ("frontx", "front_x"), ("compresion_mean", "compression_mean"),
    ("lambda", "stage/lambda"), ("Kinetic_Energy", "kinetic_energy")])
def test_a_column_that_is_not_in_the_log_gets_suggestions_and_the_list(tools, minimal, tmp_path,
                                                                      column, meant):
    code, _, err = tools("plot-log", minimal, column, "-o", tmp_path / "a.png")
    assert code == 2 and f"no column {column}, did you mean {meant}" in err
    assert "There are time, " in err and "potential_energy" in err
    with pytest.raises(KeyError, match=f"did you mean {meant}"):
        pbf_tools.open(minimal).log[column]


def test_a_batch_repeats_runs_given_by_folder_or_by_file(minimal, sweep, pbf, tmp_path, monkeypatch):
    monkeypatch.setenv("PBF", str(pbf))
    table = pbf_tools.batch([sweep / "a", sweep / "b/run.vtkhdf"], {"time.end": [0.02]},
                            tmp_path / "again")
    assert table["reason"].tolist() == ["finished"] * 2
    assert [run.times[-1] for run in table.runs] == pytest.approx([0.02, 0.02])
    with pytest.raises(pbf_tools.FileError, match="no run.vtkhdf in this folder, but in 2 below"):
        pbf_tools.batch([sweep, sweep / "a"], out=tmp_path / "none")


def test_a_run_file_that_cannot_be_read_is_not_said_to_be_missing(tools, tmp_path):
    for name in ("linked", "folder"):
        (tmp_path / name).mkdir()
    (tmp_path / "linked/run.vtkhdf").symlink_to("nowhere")
    (tmp_path / "folder/run.vtkhdf").mkdir()
    for name in ("linked", "folder"):
        code, _, err = tools("plot-energy", tmp_path / name, "-o", tmp_path / "a.png")
        assert code == 5 and f"{name}/run.vtkhdf: cannot read the run file: " in err
        assert err.count("\n") == 1


@pytest.mark.parametrize("by_file", [False, True])
def test_a_run_goes_on_in_its_own_folder(here, scene, by_file):
    made = pbf_tools.run(scene, "own")
    given = made.path if by_file else "own"
    longer = pbf_tools.run(given, resume=True, time={"end": 0.24})
    assert longer.path == made.path and longer.log["time"][-1] == pytest.approx(0.24)
    with pytest.raises(pbf_tools.BadInput, match="give out=, the folder in which this run is"):
        pbf_tools.run(given)
    shutil.copy("own/run.vtkhdf", "copy.vtkhdf")
    with pytest.raises(pbf_tools.BadInput, match="give out="):
        pbf_tools.run("copy.vtkhdf", resume=True)
