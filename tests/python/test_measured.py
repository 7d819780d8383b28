"""Measured values and readings: to-csv --gauges and --loads, units of columns, what is compared."""

import re
import subprocess

import numpy as np
import pytest

import pbf_tools
from pbf_tools import units


@pytest.fixture
def table(gauged, tmp_path):
    """table(head, row) -> a CSV of that head; of each reading of H: row(time, level)."""
    def write(head, row):
        time, level = pbf_tools.open(gauged).gauges["H"]
        path = tmp_path / "e.csv"
        path.write_text(head + "\n" + "".join(",".join(map(repr, row(t, y))) + "\n" for t, y in
                                              zip(time.tolist(), level.tolist())))
        return path

    return write


@pytest.fixture
def compared(gauged, tools, tmp_path):
    """compared(table, options...) -> (exit code, stdout, stderr) of plot-gauges."""
    return lambda path, *words: tools("plot-gauges", gauged, "--experiment", path, *words, "-o",
                                      tmp_path / "a.png")


def test_the_gauges_of_a_run_come_back_from_their_table_to_the_last_bit(gauged, tools, tmp_path):
    run = pbf_tools.open(gauged)
    assert tools("to-csv", gauged, "--gauges", "-o", tmp_path / "g.csv")[0] == 0
    table = pbf_tools.read_csv(tmp_path / "g.csv")
    expected = {"time_s": run.gauges["H"].time, "H_m": run.gauges["H"].value,
                "P_Pa": run.gauges["P"].value, "P_peak_Pa": run.gauges["P"].peak,
                "Q_kg_s": run.gauges["Q"].value, "Q_total_kg": run.gauges["Q"].total}
    expected |= {f"U_{c}_m_s": run.gauges["U"].value[:, k] for k, c in enumerate("xyz")}
    assert list(table) == list(expected)
    for name, values in expected.items():
        assert np.array_equal(table[name], values, equal_nan=True), name
        assert units.split(name)[1] == table.units[name]
    first = (tmp_path / "g.csv").read_text().splitlines()[0]
    assert first == (f"# source: run {gauged}, scene s (s.yaml), pbf {run.info['program_version']} "
                     f"({run.info['commit']})")


def test_the_table_of_a_run_is_measured_data_for_it_without_options(gauged, compared, tools,
                                                                    tmp_path):
    tools("to-csv", gauged, "--gauges", "-o", tmp_path / "g.csv")
    code, out, err = compared(tmp_path / "g.csv")
    assert code == 0 and err == ""
    which = [line.split(":")[0] for line in out.splitlines() if "RMS deviation 0 " in line]
    assert which == ["H", "P", "Q", "U_x", "U_y", "U_z"]
    # The first readings of P and Q are means over no time.
    assert (out.count("over 31 points"), out.count("over 30 points")) == (4, 2)


def test_loads_go_at_the_times_of_the_log(gauged, tools, tmp_path):
    log = pbf_tools.open(gauged).log
    assert tools("to-csv", gauged, "--loads", "-o", tmp_path / "l.csv")[0] == 0
    table = pbf_tools.read_csv(tmp_path / "l.csv")
    assert np.array_equal(table["time_s"], log["time"])
    for own, column in (("load_z_min_z_N", "load/z_min/force_z"),
                        ("load_x_max_torque_y_N_m", "load/x_max/torque_y"),
                        ("load_y_min_peak_N", "load/y_min/force_peak")):
        assert np.array_equal(table[own], log[column]) and table.units[own] == log.units[column]
    assert len(list(table)) == 1 + sum(name.startswith("load/") for name in log)


def test_gauges_and_loads_share_a_table_only_where_their_times_are_the_same(gauged, pbf, tools,
                                                                            tmp_path):
    code, out, err = tools("to-csv", gauged, "--gauges", "--loads")
    assert code == 2 and not out and "read at different times (31 and 16)" in err
    assert f"`to-csv {gauged} --gauges`" in err and f"`to-csv {gauged} --loads`" in err
    scene = (gauged.parent.parent / "s.yaml").read_text().replace(", gauges_every: 0.01", "")
    (tmp_path / "same.yaml").write_text(scene)
    subprocess.run([pbf, "run", "same.yaml", "--set", "time.end=0.1", "--quiet"], check=True,
                   cwd=tmp_path, capture_output=True)
    code, out, _ = tools("to-csv", tmp_path / "out/same", "--gauges", "--loads")
    head = out.splitlines()[2].split(",")
    assert code == 0 and head[:2] == ["time_s", "H_m"] and "load_z_min_z_N" in head


def test_what_has_no_readings_says_how_to_get_some(minimal, gauged, tools):
    for word, text in (("--gauges", "no gauges; give the scene some"), ("--loads", "loads: true")):
        code, _, err = tools("to-csv", minimal, word)
        assert code == 2 and text in err
    code, _, err = tools("to-csv", gauged, "--loads", "--log")
    assert code == 2 and "--loads goes alone or with --gauges" in err
    assert "not allowed with" in tools("to-csv", gauged, "--gauges", "--log")[2]


def test_columns_are_converted_to_the_unit_of_the_gauge(table, compared):
    for head, row, words in (
            ("t_s,H_m", lambda t, y: (t, y), ()), ("time,H", lambda t, y: (t, y), ()),
            ("t_ms,H", lambda t, y: (1000 * t, y), ()),
            ("# units: t=ms, H=cm\nt,H", lambda t, y: (1000 * t, 100 * y), ()),
            ("t,H_mm", lambda t, y: (t, 1000 * y), ()),
            ("t_over_T,H", lambda t, y: (t / 0.25, y), ("--time-scale", 0.25)),
            ("t_min,H", lambda t, y: (t / 60 - 1, y), ("--time-scale", 60, "--shift", 60)),
            ("t,eta_mm", lambda t, y: (t, 1000 * (y - 0.3)), ("--column", "H=eta_mm", "--offset",
                                                              0.3)),
            ("t,F_N", lambda t, y: (t, 4 * y - 4), ("--column", "H=F_N", "--scale", 0.25,
                                                    "--offset", 1)),
            ("t,H_mm", lambda t, y: (t, 2 * y), ("--scale", 0.5))):
        code, out, err = compared(table(head, row), *words)
        rms, points = out.split("RMS deviation ")[1].split()[0], out.split("over ")[1].split()[0]
        assert code == 0 and float(rms) < 1e-12 and points == "31", (head, out, err)
    assert "RMS deviation 0 m" in compared(table("t,H", lambda t, y: (t, y)))[1]


def test_a_velocity_is_compared_by_component(gauged, compared, tools, tmp_path):
    time, value = pbf_tools.open(gauged).gauges["U"]
    (tmp_path / "u.csv").write_text("t,U_z_m_s,U,probe_x,speed\n" + "".join(
        f"{t!r},{z!r},{x!r},{x!r},{x + 0.5!r}\n" for t, (x, _, z) in
        zip(time.tolist(), value.tolist())))
    for words, line in (((), "U_z: U_z_m_s: RMS deviation 0 m/s"),
                        (("--component", "x"), "U_x: U: RMS deviation 0 m/s"),
                        (("--column", "U=probe_x"), "U_x: probe_x: RMS deviation 0 m/s"),
                        (("--column", "U=speed", "--component", "x"),
                         "U_x: speed: RMS deviation 0.5 m/s")):
        code, out, _ = compared(tmp_path / "u.csv", *words)
        assert code == 0 and out.count("RMS") == 1 and out.startswith(line), out
    code, _, err = compared(tmp_path / "u.csv", "--column", "U=speed")
    assert code == 2 and "give --component x, y or z" in err


@pytest.mark.parametrize("head, words, text", [
    ("t_over_T,H", (), "column t_over_T has no unit of time; give --time-scale, the seconds of one "
                       "unit"),
    ("T,H", (), "column T has no unit of time"), ("H_m,t", ("--time-column", "H_m"),
                                                  "column H_m has no unit of time"),
    ("t,H_Pa", (), "column H_Pa is in Pa, and H is in m"),
    ("t,F_N", ("--column", "H=F_N"), "column F_N is in N, and H is in m"),
    ("# units: H=acre\nt,H", (), "column H has no unit"),
    ("t,H", ("--time-scale", "2.01"), "15 of its 31 measured times lie within the run"),
    ("t,H", ("--shift", "0.22"), "9 of its 31 measured times lie within"),
    ("t,H", ("--shift", "5"), "0 of its 31 measured times lie within the run (0 to 0.3 s)")],
    ids=str)
def test_what_cannot_be_compared_is_an_error_and_never_nan(table, compared, head, words, text):
    path = table(head, lambda t, y: (t, y))
    code, out, err = compared(path, *words)
    assert code == 2 and "nan" not in out
    assert re.search(re.escape(str(path)) + r"(:\d+)?: ", err) and text in err, err


def test_half_of_the_measured_times_within_the_run_are_enough(table, compared):
    code, out, _ = compared(table("t,H", lambda t, y: (2 * t, y)))
    assert code == 0 and "over 16 points" in out


def test_a_constant_has_no_correlation_instead_of_nan(table, compared):
    code, out, _ = compared(table("t,H", lambda t, y: (t, 0.5)))
    assert code == 0 and "no correlation, as one is constant over 31 points" in out


def test_a_column_of_another_quantity_does_not_hide_the_right_one(table, compared):
    code, out, _ = compared(table("t,H_deg,H_mm", lambda t, y: (t, y, 1000 * y)))
    assert code == 0 and out.count("RMS") == 1 and "H: H_mm: " in out


def test_a_fitted_lag_moves_the_measured_curve_and_is_told_for_every_run(gauged, table, compared):
    path = table("t,H", lambda t, y: (t - 0.03, y))
    code, out, _ = compared(path, "--lag", "fit", "--lag-range=-0.1,0.1")
    assert code == 0 and "RMS deviation 0 m" in out and "; lag 0.03 s" in out, out
    figure = pbf_tools.plot.gauges(gauged, gauge="H", experiment=path, lag="fit",
                                   lag_range=(-0.1, 0.1))
    measured, run = figure.axes[0].lines
    assert np.allclose(measured.get_xdata(), run.get_xdata())
    assert figure.numbers["lag_s"][0] == pytest.approx(0.03)
    assert figure.numbers["impulse"][0] == pytest.approx(figure.numbers["impulse_data"][0])
    code, _, err = compared(path, "--lag", "fit")
    assert code == 2 and "lag_range is missing" in err


def test_the_numbers_of_a_plot_are_those_of_the_program(gauged, table, compared, pbf):
    path = table("t,H_mm", lambda t, y: (t, 1000 * y + 10 * t))
    for options in ({}, {"average": "0.04"}, {"between": (0.1, 0.25)}):
        said = pbf_tools.compare_data(gauged, path, gauge="H", program=pbf, **options)["H"]
        row = pbf_tools.plot.gauges(gauged, gauge="H", experiment=path, **options).numbers
        assert {name: row[name][0] for name in ("rms", "bias", "peak", "impulse", "points")} == {
            name: said[name] for name in ("rms", "bias", "peak", "impulse", "points")}
