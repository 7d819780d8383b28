"""pbf_tools.plot: its functions draw what the commands draw, and say what these print."""

import inspect
import json
import subprocess
import sys

import matplotlib
import numpy as np
import pytest
from conftest import ROOT
from matplotlib.image import imread
from test_plot_batch import summary
from test_plot_compare import REPORT
from test_plots import SEED, stability_map, study

import pbf_tools
from pbf_tools import style
from pbf_tools.__main__ import COMMANDS, parser


@pytest.fixture
def inputs(gauged, minimal, tools, tmp_path):
    """Of each function: arguments in Python, and the words of the command that mean the same."""
    tools("to-csv", gauged, "--gauges", "-o", tmp_path / "g.csv")
    tools("to-csv", minimal, "--log", "-o", tmp_path / "log.csv")
    (tmp_path / "r.json").write_text(json.dumps(REPORT))
    run, csv, table = pbf_tools.open(gauged), tmp_path / "g.csv", study(tmp_path / "study.csv")
    batch, cells = summary(tmp_path / "sweep"), stability_map(tmp_path / "map.csv")
    front = {"width": 0.4, "height": 0.5, "reference": "martin-moyce"}
    return {
        "gauges": ((run, {"experiment": csv, "gauge": ["H", "U"], "peaks": True, "title": "A"}),
                   (gauged, "--experiment", csv, "--gauge", "H", "--gauge", "U", "--peaks",
                    "--title", "A")),
        "log": (([run, gauged.parent], "load/*/force_x", "energy", {}),
                (gauged, gauged.parent, "load/*/force_x", "energy")),
        "energy": ((str(minimal), str(tmp_path / "log.csv"), {}), (minimal, tmp_path / "log.csv")),
        "front": ((run, front), (gauged, "--width", 0.4, "--height", 0.5, "--reference",
                                 "martin-moyce")),
        "batch": ((pbf_tools.read_batch(batch), {"log": False}), (batch, "--no-log")),
        "study": ((table, {"y": "compression_p99", "goal": "1:9"}),
                  (table, "--y", "compression_p99", "--goal", "1:9")),
        "map": ((cells, {"class_": "class"}), (cells, "--class", "class")),
        "stages": ((run, {"grouped": True}), (gauged, "--grouped")),
        "speedup": ((SEED, {"scene": "blob", "dpi": 80}), (SEED, "--scene", "blob", "--dpi", 80)),
        "time": ((SEED, {}), (SEED,)),
        "compare": ((tmp_path / "r.json", {}), (tmp_path / "r.json",))}


@pytest.mark.parametrize("name", dir(pbf_tools.plot))
def test_a_function_draws_the_pixels_of_its_command_and_says_what_it_prints(inputs, tools, tmp_path,
                                                                            name):
    (*given, options), words = inputs[name]
    code, out, _ = tools(f"plot-{name}", *words, "-o", tmp_path / "command.png")
    figure = getattr(pbf_tools.plot, name)(*given, **options)
    figure.savefig(tmp_path / "function.png")
    command, function = (imread(tmp_path / f"{who}.png") for who in ("command", "function"))
    assert code == 0 and isinstance(figure, matplotlib.figure.Figure)
    assert command.shape == function.shape and np.array_equal(command, function)
    assert command[..., :3].std() > 0.02  # not blank
    printed = [line for line in out.splitlines() if not line.startswith("wrote ")]
    assert figure.told == printed and len(figure.numbers) == len(printed)


def test_the_functions_are_the_commands_with_their_defaults():
    assert dir(pbf_tools.plot) == sorted(c[5:] for c in COMMANDS if c.startswith("plot-"))
    for name in dir(pbf_tools.plot):
        function = getattr(pbf_tools.plot, name)
        args = vars(parser(f"plot-{name}").parse_args([f"plot-{name}", "x.csv"]))
        for key, parameter in inspect.signature(function).parameters.items():
            if parameter.kind == parameter.KEYWORD_ONLY:
                assert parameter.default == args[key], (name, key)
                assert f"--{key.rstrip('_').replace('_', '-')}" in function.__doc__
        assert set(args) - set(inspect.signature(function).parameters) == {"run", "out"}


def test_the_numbers_are_a_table_of_what_is_printed(inputs):
    (run, options), _ = inputs["gauges"]
    numbers = pbf_tools.plot.gauges(run, **options).numbers
    assert numbers["gauge"].tolist() == ["H", "U_x", "U_y", "U_z"]
    assert numbers["rms"].tolist() == [0] * 4 and numbers["points"].tolist() == [31] * 4
    log = run.log
    row = pbf_tools.plot.log(run, "front_x").numbers
    assert (row["least"][0], row["most"][0], row["end"][0]) == (
        log["front_x"].min(), log["front_x"].max(), log["front_x"][-1])
    assert len(pbf_tools.plot.stages(run).numbers) == 0


def test_a_batch_is_drawn_with_a_column_that_it_was_given(tmp_path):
    batch = pbf_tools.read_batch(summary(tmp_path / "sweep"))
    batch["mine"] = np.arange(len(batch)) + 1.0
    before = batch["scene"].tolist()
    figure = pbf_tools.plot.batch(batch, y="mine")
    good = batch["reason"] == "finished"
    assert sorted(figure.numbers["mine"]) == batch["mine"][good].tolist()
    assert batch["scene"].tolist() == before  # as the caller has it


def test_what_others_draw_keeps_its_look_and_a_figure_its_own(gauged, tmp_path):
    before = dict(matplotlib.rcParams)
    figure = pbf_tools.plot.energy(gauged)
    figure.savefig(tmp_path / "a.png")
    assert dict(matplotlib.rcParams) == before
    with matplotlib.rc_context({"xtick.labelsize": 30, "grid.color": "red", "font.size": 20}):
        figure.savefig(tmp_path / "b.png")
        pbf_tools.plot.energy(gauged).savefig(tmp_path / "c.png")
    a, b, c = (imread(tmp_path / f"{name}.png") for name in "abc")
    assert np.array_equal(a, b) and np.array_equal(a, c)
    assert figure._repr_png_().startswith(b"\x89PNG")


def test_wrong_arguments_are_named(gauged, tmp_path):
    plot = pbf_tools.plot
    for call, error, text in (
            (lambda: plot.gauges(), pbf_tools.BadInput, "runs: there is none; run file or run folder"),
            (lambda: plot.batch(), TypeError, "missing"),
            (lambda: plot.gauges(gauged, gague="H"), TypeError, "unexpected keyword argument 'gague'"),
            (lambda: plot.gauges(gauged, out="a.png"), TypeError, "argument 'out'"),
            (lambda: plot.gauges(gauged, scale="x"), pbf_tools.BadInput, "scale: could not convert"),
            (lambda: plot.gauges(gauged, dpi=5), pbf_tools.BadInput, "dpi: 5: give a number from 10"),
            (lambda: plot.front(gauged, axis="w"), pbf_tools.BadInput, "axis: 'w' is not one of x, y"),
            (lambda: plot.study("a.csv", goal="1"), pbf_tools.BadInput, "goal: '1' is not TIME:ERROR"),
            (lambda: plot.log(gauged), pbf_tools.BadInput, "name columns to draw; there are time"),
            (lambda: plot.gauges(gauged, gauge="h"), pbf_tools.UnknownName, "did you mean H?"),
            (lambda: plot.surface, AttributeError, "no attribute 'surface'")):
        with pytest.raises(error) as caught:
            call()
        assert text in str(caught.value)


def test_matplotlib_is_read_with_the_first_figure(gauged):
    code = "import sys, pbf_tools\nassert 'plot' in dir(pbf_tools) and pbf_tools.plot.__doc__\n" \
           "assert dir(pbf_tools.plot) and not {'matplotlib', 'numpy', 'h5py'} & set(sys.modules)\n" \
           f"pbf_tools.plot.energy({str(gauged)!r})\nassert 'matplotlib' in sys.modules\n" \
           "assert 'matplotlib.pyplot' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True, env={"PYTHONPATH": str(ROOT / "tools")})


def test_every_figure_has_a_case_above(inputs):
    assert sorted(inputs) == dir(pbf_tools.plot)
    assert isinstance(pbf_tools.plot.time(SEED), style.Picture)
