"""The plots: their numbers against computations apart, their pictures' existence, bad input."""

import csv
import re
import subprocess

import numpy as np
import pytest
from conftest import ROOT, drawn
from matplotlib.backends.backend_agg import FigureCanvasAgg

import pbf_tools
from pbf_tools import Table, front_data, plot_front, plot_stages, plot_study, style
from pbf_tools.bench import Setup

SEED = ROOT / "tests/regression/bench/reference_speedup_nvidia_h200.csv"


def test_speedup_is_the_quotient_of_the_times_in_the_table(tools, tmp_path):
    code, out, _ = tools("plot-speedup", SEED, "-o", tmp_path / "a.png")
    assert code == 0 and drawn(tmp_path / "a.png")
    with open(SEED, newline="") as file:
        ms = {(r["scene"], r["backend"], r["n_particles"]): float(r["ms_per_step_median"])
              for r in csv.DictReader(file)}
    rows = [line.split() for line in out.splitlines() if line.endswith(" x")]
    assert len(rows) == 16
    for scene, n, _, ratio, _ in rows:
        assert float(ratio) == pytest.approx(ms[scene, "cpu", n] / ms[scene, "cuda", n], rel=1e-3)


def test_time_per_particle_takes_cpu_time_of_one_thread_and_wall_time_of_more(tools, tmp_path):
    row = "bench,cpu,A,{v},float,{t},{n},late,{ms},{ms},{ms},{cpu}\n"
    (tmp_path / "cpu.csv").write_text(
        "scene,backend,device,driver,precision,threads,n_particles,state,ms_per_step_median,ms_min,"
        "ms_max,cpu_ms_per_step_median\n" +
        "".join(row.format(v=v, t=t, n=n, ms=ms, cpu=cpu) for v, t, n, ms, cpu in (
            ("avx2", 1, 1000, 4, 2), ("avx2", 1, 4000, 20, 10), ("avx2", 2, 1000, 3, 6),
            ("scalar", 1, 1000, 9, 8))))
    code, out, _ = tools("plot-time", tmp_path / "cpu.csv", "-o", tmp_path / "a.png")
    lines = out.splitlines()
    assert code == 0 and drawn(tmp_path / "a.png")
    assert lines[0].split() == ("cpu, float, 1 thread, avx2 1000: 2 us 4000: 2.5 us greatest / least "
                                "1.25").split()
    assert "2 threads" in lines[1] and "1000: 3 us" in lines[1]
    assert "scalar" in lines[2] and "1000: 8 us" in lines[2]
    out = tools("plot-time", tmp_path / "cpu.csv", "--setup", "cpu:2", "-o", tmp_path / "a.png")[1]
    assert len(out.splitlines()) == 2
    code, _, err = tools("plot-time", tmp_path / "cpu.csv", "--setup", "cpu:7")
    assert code == 2 and "no rows for cpu, 7 threads" in err


def test_titles_are_not_cut_at_the_edges(tools, minimal, tmp_path, monkeypatch):
    figures, save = [], style.save
    monkeypatch.setattr(style, "save", lambda fig, args: (figures.append(fig), save(fig, args)))
    long = "A title of many words that nobody would give to so small a picture, but for a test " * 2
    for words in ((), ("--title", long), ("--grouped",)):
        assert tools("plot-stages", minimal, *words, "-o", tmp_path / "a.png")[0] == 0
    assert tools("plot-stages", SEED, "--title", long, "-o", tmp_path / "a.png")[0] == 0
    for fig in figures:
        FigureCanvasAgg(fig).draw()
        text = fig._suptitle.get_text()  # get_suptitle() came with matplotlib 3.8
        box = fig._suptitle.get_window_extent()
        assert box.x0 >= 0 and box.x1 <= fig.bbox.x1 and box.y1 <= fig.bbox.y1, text
    assert figures[1]._suptitle.get_text().replace("\n", " ") == long.strip()


def test_stages_sum_to_the_whole_update_and_groups_lose_nothing(tools, tmp_path):
    rows = Table({"n_particles": np.array([10.0, 20.0]), "ms_per_step_median": np.array([8.0, 9]),
                  "ms_grid": np.array([1.0, 1]), "ms_lambda": np.array([3.0, 4]),
                  "ms_xsph": np.array([2.0, 2]), "ms_density": np.array([np.nan, np.nan])})
    stages, total = plot_stages.stage_times(rows, 10)
    assert stages == {"grid": 1, "lambda": 3, "xsph": 2, "other": 2} and total == 8
    assert sum(plot_stages.grouped(stages).values()) == 8
    assert {s for group in style.GROUPS.values() for s in group} | {"other"} == set(style.STAGES)
    code, _, _ = tools("plot-stages", SEED, "--grouped", "-o", tmp_path / "a.png")
    assert code == 0 and drawn(tmp_path / "a.png")


def test_stages_of_a_run_that_are_not_in_the_list_are_drawn_as_other(tools, minimal, tmp_path,
                                                                     monkeypatch):
    figures, save = [], style.save
    monkeypatch.setattr(style, "save", lambda fig, args: (figures.append(fig), save(fig, args)))
    assert "not know" not in tools("plot-stages", minimal, "-o", tmp_path / "a.png")[2]
    for name in ("grid", "neighbors"):
        monkeypatch.delitem(style.STAGES, name)
    code, _, err = tools("plot-stages", minimal, "-o", tmp_path / "b.png")
    assert code == 0 and "does not know the stages grid, neighbors; they are drawn as other" in err
    before, after = ([bar.get_height() for bar in fig.axes[0].patches] for fig in figures)
    assert sum(before) == pytest.approx(100) and sum(after) == pytest.approx(100)
    assert len(after) == len(before) - 1  # two less, and other


def test_stages_of_a_table_that_are_not_in_the_list_are_other(tools, tmp_path, monkeypatch):
    assert "not know" not in tools("plot-stages", SEED, "-o", tmp_path / "a.png")[2]
    rows = Table({"n_particles": np.array([10.0]), "ms_per_step_median": np.array([8.0]),
                  "ms_min": np.array([7.0]), "ms_max": np.array([9.0]), "ms_warp": np.array([3.0]),
                  "ms_weft": np.array([4.0]), "ms_note": np.array(["text"])})
    assert plot_stages.stage_times(rows, 10) == ({"other": 8}, 8)
    for name in ("grid", "neighbors"):
        monkeypatch.delitem(style.STAGES, name)
    code, _, err = tools("plot-stages", SEED, "-o", tmp_path / "b.png")
    assert code == 0 and drawn(tmp_path / "b.png")
    assert err.count("does not know the stages grid, neighbors; they are drawn as other") == 1


def test_plots_of_a_run_file_are_drawn(tools, minimal, tmp_path):
    for command in ("plot-energy", "plot-stages"):
        assert tools(command, minimal, "-o", tmp_path / f"{command}.png")[0] == 0
        assert drawn(tmp_path / f"{command}.png")
    assert tools("to-csv", minimal, "--log", "-o", tmp_path / "log.csv")[0] == 0
    one = tools("plot-energy", minimal, "-o", tmp_path / "a.png")[1].splitlines()[0]
    two = tools("plot-energy", tmp_path / "log.csv", "-o", tmp_path / "b.svg")[1].splitlines()[0]
    assert one == two and "62.7844 J at the start" in one
    code, out, _ = tools("plot-energy", minimal, tmp_path / "log.csv", "-o", tmp_path / "c.png")
    assert code == 0 and drawn(tmp_path / "c.png") and "1 at most" in out


def test_any_column_of_the_log_is_drawn_and_its_extremes_are_printed(tools, minimal, tmp_path):
    code, out, _ = tools("plot-log", minimal)
    assert code == 0 and re.search(r"^front_x +m$", out, re.MULTILINE)
    log = pbf_tools.open(minimal).log
    code, out, _ = tools("plot-log", minimal, "front_x", "compression_*", "-o", tmp_path / "a.png")
    assert code == 0 and drawn(tmp_path / "a.png")
    lines = out.splitlines()
    assert lines[0] == (f"front_x, minimal: {log['front_x'].min():.6g} to "
                        f"{log['front_x'].max():.6g} m, at the end {log['front_x'][-1]:.6g}")
    assert [line.split(",")[0] for line in lines[1:5]] == [
        n for n in log if n.startswith("compression_")]
    tools("to-csv", minimal, "--log", "-o", tmp_path / "log.csv")
    assert tools("plot-log", minimal, tmp_path / "log.csv", "front_x", "-o",
                 tmp_path / "b.png")[1].splitlines()[1].split(":")[1] == lines[0].split(":")[1]


def test_the_pareto_front_is_that_of_brute_force():
    random = np.random.default_rng(3)
    for _ in range(30):
        x, y = random.integers(1, 12, (2, 25)) / 4.0
        brute = [not any((x[j] <= x[i] and y[j] <= y[i] and (x[j], y[j]) != (x[i], y[i]))
                         for j in range(25)) for i in range(25)]
        mask = plot_study.front(x, y)
        assert {(a, b) for a, b in zip(x[mask], y[mask])} == \
            {(a, b) for a, b in zip(x[brute], y[brute])}


def study(path, pareto=True):
    lines = ["solver.iterations,method,backend,precision,threads,particles,seconds_median,"
             "seconds_spread,compression_mean,compression_p99" + (",pareto" if pareto else "")]
    for method, factor in (("jacobi", 1), ("stored", 0.4)):
        for it in (1, 2, 4, 8):
            lines.append(f"{it},{method},cpu,float,2,4000,{it * factor},{0.1 * it},{0.04 / it},0.1"
                         + (f",{int(method == 'stored')}" if pareto else ""))
    path.write_text("\n".join(lines + ["1,jacobi,cpu,float,2,4000,nan,,," + pareto * ",0"]) + "\n")
    return path


def test_a_study_is_drawn_with_the_front_given_or_computed(tools, tmp_path):
    for pareto in (True, False):
        table = study(tmp_path / "study.csv", pareto)
        code, out, err = tools("plot-study", table, "-o", tmp_path / "a.png")
        assert code == 0 and drawn(tmp_path / "a.png") and "left out: 1 rows" in err
        front = [line for line in out.splitlines() if " s  compression_mean" in line]
        assert len(front) == 4 and all("stored" in line for line in front)
    code, _, err = tools("plot-study", table, "--y", "drift", "-o", tmp_path / "b.png")
    assert code == 2 and "no column drift" in err
    code, out, _ = tools("plot-study", tmp_path, "-o", tmp_path / "c.png")
    assert code == 0 and drawn(tmp_path / "c.png")
    (tmp_path / "empty").mkdir()
    code, _, err = tools("plot-study", tmp_path / "empty", "-o", tmp_path / "d.png")
    assert code == 5 and "no study.csv in this folder" in err


def test_panels_show_the_tables_of_one_name_and_a_series_looks_the_same_in_all(tools, tmp_path):
    one, two = study(tmp_path / "one.csv", False), tmp_path / "two.csv"
    lines = one.read_text().splitlines()
    two.write_text("\n".join([lines[0]] + lines[5:9]) + "\n")  # the second series alone
    call = ("plot-study", one, two, "--series", "method", "-o", tmp_path / "a.svg")
    code, out, _ = tools(*call, "--panels", "shallow", "deep", "--goal", "1:2", "0.5:3")
    assert code == 0
    front = [line for line in out.splitlines() if " s  compression_mean" in line]
    assert len(front) == 8 and front[:4] == front[4:] and all("stored" in line for line in front)
    panels = (tmp_path / "a.svg").read_text().split('id="axes_')[1:]
    mark = re.compile(r'<use [^>]*y="([\d.]+)" style="fill: (#\w+)')
    left, right = (set(mark.findall(panel)) for panel in panels)
    heights = {y for y, _ in left}
    assert len({color for _, color in left} - {"#ffffff"}) == 2
    assert {color for y, color in right if y in heights} == {style.COLORS[1].lower()}
    together = tools(*call)[1]
    assert len([line for line in together.splitlines() if "stored" in line]) == 4
    assert tools(*call, "--panels", "same", "same")[1] == together
    code, out, _ = tools(*call, "--panels", "shallow", "deep", "--y", "compression_mean",
                         "compression_p99")  # an error of its own in each panel
    lines_of = [line for line in out.splitlines() if " s  compression_" in line]
    assert code == 0 and lines_of[:4] == front[:4]
    assert len(lines_of) == 5 and "compression_p99 10 %" in lines_of[4]
    for words, said in ((("--panels", "one"), "1 names for 2 tables"),
                        (("--panels", "a", "b", "--y", "x", "y", "z"), "3 columns for 2 panels"),
                        (("--panels", "a", "b", "--goal", "1:2"), "1 goals for 2 panels"),
                        (("--goal", "1"), "'1' is not TIME:ERROR"),
                        (("--goal", "0:1"), "shows what is above 0")):
        code, _, err = tools(*call, *words)
        assert code == 2 and said in err
    two.write_text(lines[0] + "\n1,stored,cpu,float,2,4000,0,0,0,0\n")
    code, _, err = tools(*call, "--panels", "shallow", "deep")
    assert code == 2 and "panel deep: no row that finished" in err


def stability_map(path, change=lambda row: row):
    rows = ["x_key,y_key,x,y,iterations,class,dt_hat,compression_mean"]
    for it in (1, 4):
        for dt in (0.001, 0.002, 0.004):
            for ratio in (2, 3):
                name = "stable" if dt * ratio / it < 0.002 else "degraded" if it > 1 else "stopped"
                rows.append(change(f"time.step,fluid.smoothing_ratio,{dt},{ratio},{it},{name},"
                                   f"{dt * 15},{dt if name != 'stopped' else 'nan'}"))
    path.write_text("\n".join(rows) + "\n")
    return path


def test_a_stability_map_counts_its_classes_and_refuses_unknown_or_double_ones(tools, tmp_path):
    table = stability_map(tmp_path / "map.csv")
    code, out, _ = tools("plot-map", table, "-o", tmp_path / "a.png")
    text = table.read_text()
    assert code == 0 and drawn(tmp_path / "a.png")
    for name in ("stable", "degraded", "stopped"):
        assert f"{name:9} {text.count(',' + name + ','):5d} of 12" in out
    bad = stability_map(tmp_path / "bad.csv", lambda row: row.replace("stopped", "exploded"))
    code, _, err = tools("plot-map", bad, "-o", tmp_path / "b.png")
    assert code == 2 and "exploded" in err and "the classes are stable" in err
    code, out, _ = tools("plot-map", table, "--x", "iterations", "--panels", "y", "--y", "x", "-o",
                         tmp_path / "turned.png")
    assert code == 0 and drawn(tmp_path / "turned.png")
    code, out, _ = tools("plot-map", table, "--x", "iterations", "-o", tmp_path / "b.png")
    assert code == 2  # three values of x in one cell
    code, _, err = tools("plot-map", table, table, "-o", tmp_path / "c.png")
    assert code == 2 and "two runs have the same" in err


def test_the_references_have_sources_and_axes():
    for name, reference in front_data.REFERENCES.items():
        head = (front_data.FOLDER / reference.file).read_text().splitlines()[0]
        assert head.startswith("# ") and reference.label.split()[0] in head, name
        data = reference.read()
        assert np.all(np.diff(data["T"]) > 0) and np.all(np.diff(data["Z"]) > 0)
        assert 0.99 < data["Z"][0] < 1.3


def test_a_front_made_from_the_measured_one_deviates_by_nothing(tools, tmp_path):
    data = front_data.REFERENCES["martin-moyce"].read()
    a, g = 0.3, 9.81
    t = np.concatenate([[0], data["T"]]) * np.sqrt(a / (2 * g))
    for late, z in ((0, 0), (0.1, 0.0), (0, 0.5)):
        x = (np.concatenate([[1], data["Z"]]) + z) * a
        rows = "".join(f"{p!r},{q!r}\n" for p, q in
                       zip((t - late * np.sqrt(a / (2 * g))).tolist(), x.tolist()))
        (tmp_path / "front.csv").write_text("time,front_x\n" + rows)
        code, out, _ = tools("plot-front", tmp_path / "front.csv", "--width", a, "--height", 2 * a,
                             "--reference", "martin-moyce", "-o", tmp_path / "a.png")
        assert code == 0 and drawn(tmp_path / "a.png")
        if late:
            assert "0.000 with T shifted by +0.10" in out
        else:
            assert f"RMS deviation of Z {z:.3f} over 15 points" in out


def test_the_front_of_a_run_starts_at_one_and_ends_before_the_wall(tools, pbf, tmp_path):
    subprocess.run([pbf, "run", ROOT / "configs/dam_break.yaml", "--set", "fluid.spacing=0.05",
                    "--set", "render=off", "--set", "time.end=0.6", "--set", "time.step=0.004",
                    "--set", "measure_every=2", "--quiet", "--threads", "2", "--out",
                    tmp_path / "run"], check=True, capture_output=True)
    parser = __import__("argparse").ArgumentParser()
    plot_front.add_arguments(parser)
    path = str(tmp_path / "run/run.vtkhdf")
    front = plot_front.read_front(path, parser.parse_args([path]))
    # The start has been relieved of its compression: it is no longer the lattice to the last digit.
    assert front.ratio == pytest.approx(2, rel=1e-3)
    assert front.z[0] == pytest.approx(1, abs=1e-3)
    assert front.t[0] == 0 and 3 < front.z[-1] < 4 - 0.1 / 0.4
    # The dry-bed front of Ritter (1892), 2 sqrt(g H), is an upper bound of its speed.
    assert np.diff(front.z).max() / np.diff(front.t).max() < 2
    code, out, _ = tools("plot-front", path, "-o", tmp_path / "a.png")
    assert code == 0 and drawn(tmp_path / "a.png") and out.count("RMS deviation") == 5
    code, _, err = tools("plot-front", path, "--width", 0.1, "-o", tmp_path / "a.png")
    assert code == 2 and "8 times as high" in err
    assert tools("plot-front", path, "--axis", "z", "-o", tmp_path / "a.png")[0] == 2


@pytest.mark.parametrize("arguments, code, text", [
    (("plot-speedup", "nothing.csv"), 5, "nothing.csv: cannot read the table: No such file"),
    (("plot-speedup", SEED, "--base", "cpu:7"), 2, "no rows for cpu, 7 threads"),
    (("plot-speedup", SEED, "--base", "cpu:quick"), 2, "cpu:1 or cuda:float"),
    (("plot-speedup", SEED, "--scene", "lake"), 2, "there are blob, stream"),
    (("plot-speedup", SEED, "-o", "/no/such/folder/a.png"), 5, "cannot write the picture"),
    (("plot-speedup", SEED, "-o", "a.doc"), 2, "a.doc"),
    (("plot-speedup", SEED, "-o", "a.png", "--dpi", "1e9"), 2, "--dpi"),
    (("plot-stages", SEED, "--state", "late"), 2, "no rows of state late"),
    (("plot-energy", SEED), 2, "no column time"),
    (("plot-log", SEED, "frame"), 2, "no column time"),
    (("plot-log", "front_x"), 2, "front_x: no such run or table"),
    (("plot-log", "none.vtkhdf", "front_x"), 5, "none.vtkhdf: cannot read the run file"),
    (("plot-front", SEED), 2, "--width"),
    (("plot-gauge",), 2, "no command plot-gauge, did you mean plot-gauges? There are plot-log"),
    ((), 2, "required: COMMAND"),
    (("plot-energy", ROOT / "README.md"), 5, "not an HDF5 file")], ids=str)
def test_bad_input_is_one_error_with_the_programs_exit_code(tools, tmp_path, monkeypatch, arguments,
                                                           code, text):
    monkeypatch.chdir(tmp_path)
    result, _, err = tools(*arguments)
    assert result == code and text in err and "Traceback" not in err


def test_a_table_with_a_short_line_is_named_by_line(tools, tmp_path):
    (tmp_path / "a.csv").write_text("# source\ntime,kinetic_energy,potential_energy\n0,1,2\n1,2\n")
    code, _, err = tools("plot-energy", tmp_path / "a.csv")
    assert code == 2 and "a.csv:4: 2 values for 3 columns" in err
    (tmp_path / "b.csv").write_text("# nothing\n")
    assert "is empty" in tools("plot-energy", tmp_path / "b.csv")[2]


def test_a_setup_left_open_must_be_one():
    rows = Table({"backend": np.array(["cpu", "cpu"]), "threads": np.array([1.0, 4.0]),
                  "precision": np.array(["float", "float"]), "device": np.array(["a", "a"])})
    assert len(Setup.parse("cpu:4").rows(rows)) == 1
    with pytest.raises(Exception, match="several kinds of threads"):
        Setup.parse("cpu").rows(rows)
