"""Run.name, and what plots call their runs: the name that the scene says."""

import subprocess

import pytest
from conftest import ROOT
from test_plot_batch import summary

import pbf_tools
from pbf_tools import logs, plot_batch, style

SCENE = (ROOT / "configs/minimal.yaml").read_text()


@pytest.fixture(scope="module")
def make(pbf, tmp_path_factory):
    """make(file, name, folder) -> a run folder of a scene FILE.yaml with that line `name`."""
    place = tmp_path_factory.mktemp("named")

    def call(file, name, folder):
        kept = [line for line in SCENE.splitlines(keepends=True) if not line.startswith("name:")]
        (place / f"{file}.yaml").write_text((f"name: {name}\n" if name else "") + "".join(kept))
        if not (place / folder).exists():
            subprocess.run([pbf, "run", f"{file}.yaml", "--set", "output={}", "--set",
                            "time.end=0.02", "--set", "fluid.spacing=0.05", "--quiet", "--out",
                            folder], check=True, cwd=place, capture_output=True)
        return place / folder

    return call


@pytest.fixture
def figures(monkeypatch):
    """The figures that the commands draw."""
    kept, save = [], style.save
    monkeypatch.setattr(style, "save", lambda fig, args: (kept.append(fig), save(fig, args)))
    return kept


@pytest.mark.parametrize("line, name", [
    ("tall column", "tall column"), ('"12"', "12"), ("'it: \"x\" \\ #1'", 'it: "x" \\ #1'),
    ("", "file")])
def test_a_run_is_called_as_its_scene_says_else_as_its_file(make, line, name):
    run = pbf_tools.open(make("file", line, f"run_{name[:2]}"))
    assert run.name == name and run.title.startswith(f"{name}, ") and f"<run {name}, " in repr(run)


def test_legends_say_the_scenes_names_or_the_folders_where_these_are_the_same(make, tools, figures,
                                                                              tmp_path):
    one, two, three = make("a", "low", "1"), make("b", "high", "2"), make("a", "low", "3")
    for runs, labels in (((one, two), ["low", "high"]), ((one, three), ["1", "3"])):
        for words in (("plot-log", *runs, "front_x"), ("plot-energy", *runs)):
            assert tools(*words, "-o", tmp_path / "a.png")[0] == 0
            shown = [t.get_text() for t in figures.pop().axes[0].get_legend().get_texts()]
            assert shown == labels
        assert tools("plot-stages", *runs, "-o", tmp_path / "a.png")[0] == 0
        marks = figures.pop().axes[0].get_xticklabels()
        assert [t.get_text().split("\n")[0] for t in marks] == labels
    code, out, _ = tools("plot-log", one, "front_x", "-o", tmp_path / "a.png")
    assert code == 0 and out.startswith("front_x, low: ")
    assert pbf_tools.open(one).title in [t.get_text() for t in figures.pop().axes[0].texts]
    assert logs.labels(["x/a.csv", "x/b.csv"], ["a", "a"]) == ["a", "b"]


def test_a_batch_has_the_scenes_name_in_its_title(make, tools, figures, pbf, tmp_path):
    scene = make("file", "tall column", "run_ta").parent / "file.yaml"
    subprocess.run([pbf, "batch", scene, "--grid", "solver.iterations=2,4", "--set", "output={}",
                    "--set", "time.end=0.02", "--set", "fluid.spacing=0.05", "--quiet", "--out",
                    tmp_path / "sweep"], check=True, capture_output=True)
    assert tools("plot-batch", tmp_path / "sweep", "-o", tmp_path / "a.png")[0] == 0
    shown = [t.get_text() for t in figures.pop().axes[0].texts]
    assert any(text.startswith("tall column, 2 runs") for text in shown), shown


def test_scenes_of_a_batch_that_are_called_the_same_stay_apart(tmp_path):
    path = summary(tmp_path)  # its runs are gone: the names of the files
    assert set(plot_batch.read_summary(path)["scene"]) == {"dam"}
    path.write_text(path.read_text().replace("scenes/dam.yaml", "other/dam.yaml", 1))
    assert set(plot_batch.read_summary(path)["scene"]) == {"scenes/dam.yaml", "other/dam.yaml"}
