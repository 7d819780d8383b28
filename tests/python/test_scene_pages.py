"""configs/README.md: its scenes and commands work as printed, and its table is a free fall."""

import os
import re
import shlex
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT, drawn

import pbf_tools

PAGE = (ROOT / "configs/README.md").read_text()
CHEAPER = "--set time.end=0.6"


def section(title):
    return PAGE.partition(f"\n## {title}\n")[2].partition("\n## ")[0]


def blocks(text, kind=""):
    found = re.findall(r"^```(\w*)\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
    return [block for fence, block in found if fence == kind]


FILMS = section("From a scene to a plot and a film")
FALL = next(block for block in blocks(section("Motion")) if block.startswith("t,x,y,z\n"))


@pytest.fixture
def shell(pbf, tmp_path):
    """shell(line) -> a finished process in a folder in which `pbf` and `python3` are the tested."""
    commands = tmp_path / "bin"
    commands.mkdir()
    (commands / "pbf").symlink_to(pbf)
    (commands / "python3").write_text(f'#!/bin/sh\nexec {shlex.quote(sys.executable)} -B "$@"\n')
    (commands / "python3").chmod(0o755)
    environment = {**os.environ, "PATH": f"{commands}:/usr/bin:/bin",
                   "PYTHONPATH": str(ROOT / "tools")}

    def call(line):
        return subprocess.run(["bash", "-c", line], cwd=tmp_path, env=environment, text=True,
                              capture_output=True)

    return call


def do(shell, line, pictures):
    """Runs a line as printed, at less cost; without OpenGL with pictures made before."""
    words = line
    if line.startswith(("pbf run", "pbf batch")):
        words += f" {CHEAPER}" + ("" if "render" in line else " --set 'render.size=[320, 240]'")
    done = shell(words)
    if done.returncode == 4 and "OpenGL" in done.stderr:
        done = shell(f"{words} --overwrite --set render=off")
        out = line.split("--out ")[1].split()[0]
        shell(f"cp -r {shlex.quote(str(pictures / 'frames'))} {out}/frames")
    assert done.returncode == 0, (line, done.stderr)
    return done


def test_from_a_scene_to_a_plot_and_a_film(shell, pictures, tmp_path):
    drop, rod = blocks(FILMS, "yaml")
    (tmp_path / "drop.yaml").write_text(drop)
    kept = [line for line in drop.splitlines(keepends=True) if "sphere" not in line]
    (tmp_path / "rod.yaml").write_text("".join(kept).replace("name: drop", "name: rod") + rod)
    (tmp_path / "fall.csv").write_text(FALL)
    lines = "".join(blocks(FILMS)).splitlines()
    assert [line.split()[0] for line in lines].count("pbf") == 4 and len(lines) == 9
    said = {line: do(shell, line, pictures) for line in lines}
    for line, done in said.items():
        if "pbf_tools" in line:
            assert done.stderr == "" or " video " in line, (line, done.stderr)
            out = tmp_path / shlex.split(line)[-1]
            assert out.suffix == ".gif" and out.stat().st_size > 1000 or drawn(out), line
        else:
            assert "warning" not in done.stderr, done.stderr
    sweep = pbf_tools.read_batch(tmp_path / "out/sweep")
    assert sorted(sweep["fluid.spacing"]) == [0.02, 0.04]
    assert {run.name for run in sweep.runs} == {"drop"}


def test_every_height_of_the_page_is_there(pbf, tools, tmp_path):
    drop, rod = blocks(FILMS, "yaml")
    (tmp_path / "fall.csv").write_text(FALL)
    (tmp_path / "s.yaml").write_text(drop + rod)
    subprocess.run([pbf, "run", "s.yaml", "--set", "time.end=0.02", "--set", "render=off",
                    "--quiet", "--out", "run"], check=True, cwd=tmp_path, capture_output=True)
    columns = re.findall(r"`plot-log RUN (\S+)`", FILMS)
    assert columns == ["front_z", "center_of_mass_z", "pose/NAME/z"]
    for column in columns:
        code, _, err = tools("plot-log", tmp_path / "run", column.replace("NAME", "rod"), "-o",
                             tmp_path / "a.png")
        assert code == 0 and not err
    log = pbf_tools.open(tmp_path / "run").log
    assert log["pose/rod/z"][0] == pytest.approx(0.54, abs=1e-12)  # its middle


def test_a_cylinder_of_water_falls_as_the_page_says(pbf, tmp_path):
    body = re.search(r"`(\{shape: cylinder[^`]*\})` in place of the sphere", FILMS)[1]
    drop = blocks(FILMS, "yaml")[0]
    sphere = re.search(r"\{shape: sphere[^}]*\}", drop)[0]
    (tmp_path / "s.yaml").write_text(drop.replace(sphere, body))
    subprocess.run([pbf, "run", "s.yaml", "--set", "render=off", "--set", "time.end=0.1",
                    "--set", "time.step=0.001", "--set", "measure_every=100", "--quiet",
                    "--out", "run"], check=True, cwd=tmp_path, capture_output=True)
    x = pbf_tools.open(tmp_path / "run")["position"]
    falling = x[0][:, 2] > 0.3
    assert 400 < falling.sum() < 700  # pi 0.08^2 0.2 / 0.02^3 = 503
    fallen = (x[0][falling, 2] - x[-1][falling, 2]).mean()
    assert fallen == pytest.approx(9.81 * 0.1**2 / 2, rel=0.02)


def free_fall(t):
    """Displacement of a fall that begins at rest at t = 0 and is braked evenly in 0.28 to 0.3 s."""
    braked = np.clip(t - 0.28, 0, 0.02)
    return -9.81 * (np.minimum(t, 0.28) ** 2 / 2 + 0.28 * (braked - braked**2 / 0.04))


def test_the_rows_of_the_table_are_a_free_fall(tmp_path):
    (tmp_path / "fall.csv").write_text(FALL)
    table = pbf_tools.read_csv(tmp_path / "fall.csv")
    assert np.abs(table["z"] - free_fall(table["t"])).max() < 1e-6
    assert not table["x"].any() and not table["y"].any() and table["t"][-1] >= 10


@pytest.mark.parametrize("begin, end, step", [
    (0, 0.4, 0.001), (0, 0.004, 1e-5), (0.279, 0.023, 1e-4)], ids=["all", "start", "stop"])
def test_the_table_falls_freely_to_within_what_the_page_says(pbf, tmp_path, begin, end, step):
    (tmp_path / "fall.csv").write_text(FALL)
    (tmp_path / "s.yaml").write_text(
        "domain: {min: [0, 0, 0], max: [1, 1, 1]}\n"
        "fluid: {spacing: 0.1}\n"
        "bodies: [{shape: block, min: [0, 0, 0], max: [0.2, 0.2, 0.2]}]\n"
        "obstacles: [{name: rod, shape: cylinder, from: [0.6, 0.2, 0.75], to: [0.6, 0.8, 0.75],\n"
        "             radius: 0.2, motion: {kind: file, path: fall.csv}}]\n"
        f"time: {{step: {step}, end: {end}, motion_begin: {begin}}}\n"
        "measure_every: 1\n"
        "precision: double\n"
        "output: {every: 1}\n")
    subprocess.run([pbf, "run", "s.yaml", "--quiet", "--out", "run"], check=True, cwd=tmp_path,
                   capture_output=True)
    log = pbf_tools.open(tmp_path / "run").log
    off = np.abs(log["pose/rod/z"] - 0.75 - free_fall(begin + log["time"])).max()
    stated = float(re.search(r"stopped within 0\.02 s, to within ([\d.]+) mm", PAGE)[1])
    assert off < stated / 1000


def test_two_dimensions_have_the_solids_motions_and_gauges_of_the_page(pbf, tmp_path):
    text = section("Two dimensions")
    for word in ("`sphere`", "`cylinder`", "`box`", "`capsule`", "`plane`", "`size: [0.6]`",
                 "`at: [x, z]`", "`axis: [0, 1, 0]`", "`angular: [0, 90, 0]`"):
        assert word in text
    (tmp_path / "fall.csv").write_text(FALL)
    (tmp_path / "s.yaml").write_text("""
dimensions: 2
domain: {min: [0, 0], max: [2, 1], loads: true}
fluid: {spacing: 0.02}
bodies:
  - {shape: block, min: [0, 0], max: [0.6, 0.4]}
  - {shape: sphere, center: [1, 0.3], radius: 0.1}
obstacles:
  - {name: disc, shape: sphere, center: [0.3, 0.95], radius: 0.05,
     motion: {kind: file, path: fall.csv}}
  - {name: rod, shape: cylinder, from: [1.3, 0.5], to: [1.3, 0.5], radius: 0.05,
     motion: {kind: sine, direction: [0, 1], amplitude: 0.05, period: 0.5}}
  - {name: blade, shape: box, min: [1.5, 0.5], max: [1.7, 0.55],
     motion: {kind: velocity, velocity: [0, 0.1], angular: [0, 90, 0]}}
  - {name: flap, shape: box, min: [1, 0.6], max: [1.1, 0.9],
     motion: {kind: sine, axis: [0, 1, 0], pivot: [1.05, 0.6], amplitude: 15, period: 2}}
  - {name: pipe, shape: capsule, from: [0.9, 0.1], to: [1.1, 0.1], radius: 0.05}
  - {name: slope, shape: plane, point: [1.8, 0], normal: [-1, 1]}
gauges:
  - {name: H, kind: level, at: [0.1]}
  - {name: U, kind: velocity, at: [0.3, 0.1]}
  - {name: Q, kind: flow, center: [0.3, 0.3], normal: [1, 0], size: [0.6]}
  - {name: P, kind: pressure, on: z_min, at: [0.3, 0], radius: 0.05}
time: {step: 0.002, end: 0.3}
output: {every: 0.1}
""")
    done = subprocess.run([pbf, "run", "s.yaml", "--quiet", "--out", "run"], cwd=tmp_path,
                          capture_output=True, text=True)
    assert done.returncode == 0 and "warning" not in done.stderr, done.stderr
    run = pbf_tools.open(tmp_path / "run")
    assert run["position"].shape[2] == 3 and sorted(run.gauges) == ["H", "P", "Q", "U"]
    log = run.log
    assert log["pose/disc/z"][-1] == pytest.approx(0.95 - 0.41202, abs=1e-4)
    assert log["pose/blade/z"][-1] == pytest.approx(0.525 + 0.03, abs=1e-6)
    turn, _ = run.obstacle_pose("blade", log["time"][-1])
    assert turn[0, 0] == pytest.approx(np.cos(np.radians(27)), abs=1e-6)


def test_forces_in_two_dimensions_divided_by_the_spacing_are_per_metre(pbf, tmp_path):
    """Of water at rest on a wall: rho g H^2 / 2."""
    (tmp_path / "s.yaml").write_text(
        "dimensions: 2\ndomain: {min: [0, 0], max: [0.5, 0.5], loads: true}\n"
        "fluid: {spacing: 0.02}\nbodies: [{shape: block, min: [0, 0], max: [0.5, 0.4]}]\n"
        "time: {step: auto, end: 0.6}\noutput: {every: 0.1}\n")
    subprocess.run([pbf, "run", "s.yaml", "--quiet", "--out", "run"], check=True, cwd=tmp_path,
                   capture_output=True)
    log = pbf_tools.open(tmp_path / "run").log
    late = log["time"] > 0.2
    force = log["load/x_max/force_x"][late].mean() / 0.02
    assert force == pytest.approx(1000 * 9.81 * 0.4**2 / 2, rel=0.05)


def test_the_scene_on_a_base_and_the_command_of_several_gauged_runs_work(pbf, tools, tmp_path):
    (tmp_path / "base").mkdir()
    (tmp_path / "base/tank.yaml").write_text(blocks(FILMS, "yaml")[0])
    text = section("A scene that builds on another")
    (tmp_path / "steep.yaml").write_text(blocks(text, "yaml")[0])
    change = re.search(r"`--set '(bodies\[1\][^']*)'`", text)[1]
    done = subprocess.run([pbf, "plan", "steep.yaml", "--resolved", "--set", change], cwd=tmp_path,
                          capture_output=True, text=True)
    assert done.returncode == 0 and done.stdout.startswith("name: steep\n"), done.stderr
    assert "radius: 0.1, velocity: [0, 0, -2]" in done.stdout \
        and "\nviscosity: off\n" in done.stdout

    text = section("Gauges")
    (tmp_path / "gauged.yaml").write_text(blocks(text, "yaml")[0])
    for name, spacing in (("coarse", 0.06), ("fine", 0.05)):
        subprocess.run([pbf, "run", "gauged.yaml", "--set", f"fluid.spacing={spacing}", "--set",
                        "gauges[3].radius=0.12", "--set", "time.end=0.1", "--quiet", "--out",
                        f"out/{name}"], check=True, cwd=tmp_path, capture_output=True)
    (tmp_path / "heights.csv").write_text("t,h2\n" + "".join(f"{k / 100},0\n" for k in range(11)))
    words = [tmp_path / word if word.startswith("out/") or word.endswith((".csv", ".png")) else word
             for word in next(line for line in blocks(text) if "plot-gauges" in line).split()[3:]]
    code, out, _ = tools(*words)
    assert code == 0 and drawn(tmp_path / "gauges.png")
    assert re.search(r"^H2, coarse: h2: RMS .* 11 points.*\nH2, fine: h2: RMS", out, re.MULTILINE)


def test_three_commands_lead_from_an_experiment_to_a_picture(shell, tmp_path):
    (tmp_path / "configs").symlink_to(ROOT / "configs")
    text = section("Comparison with measurements")
    lines = blocks(text)[0].splitlines()
    assert [line.split()[:2] for line in lines] == [["pbf", "run"], ["pbf", "compare-data"],
                                                    ["python3", "-m"]]
    said = {}
    for line in lines:
        done = shell(line)
        assert done.returncode == 0 and "warning" not in done.stderr, (line, done.stderr)
        said[line.split()[1]] = done.stdout
    assert drawn(tmp_path / "heights.png")
    for number in ("RMS", "lag", "peak", "impulse"):  # the page's to a twentieth: another machine rounds
        page, here = (re.search(rf"{number} (-?[\d.]+)", t)[1]
                      for t in (blocks(text, "text")[0], said["compare-data"]))
        assert float(here) == pytest.approx(float(page), rel=0.05, abs=0.01), number
    rms = re.search(r"RMS (\S+) m", said["compare-data"])[1]
    assert f"H2: H2_m: RMS deviation {rms} m" in said["-m"]
