"""pbf_tools.probe: gauges on the frames of a finished run."""

import subprocess

import numpy as np
import pytest

import pbf_tools

SCENE = """dimensions: 2
domain: {min: [0, 0], max: [1, 0.8]}
fluid: {spacing: 0.04}
bodies: [{shape: block, min: [0, 0], max: [0.4, 0.48]}]
gauges: [{name: H, kind: level, at: [0.1]}, {name: U, kind: velocity, at: [0.2, 0, 0.1]}]
time: {step: 0.0025, end: 0.3}
output: {every: 0.05, gauges_every: 0.05}
"""


@pytest.fixture(scope="module")
def probed(pbf, tmp_path_factory):
    place = tmp_path_factory.mktemp("probed")
    (place / "a.yaml").write_text(SCENE)
    subprocess.run([pbf, "run", "a.yaml", "--quiet", "--out", "a"], check=True, cwd=place,
                   capture_output=True)
    return place / "a"


def test_a_probe_reads_what_the_run_read(probed, pbf, tmp_path):
    run = pbf_tools.open(probed)
    (tmp_path / "more.yaml").write_text(
        "gauges: [{name: H, kind: level, at: [0.1]}, {name: U, kind: velocity, at: [0.2, 0, 0.1]}]\n")
    listed = [{"name": "H", "kind": "level", "at": np.array([0.1])},
              {"name": "U", "kind": "velocity", "at": (0.2, 0, 0.1)}]
    for found in (pbf_tools.probe(probed, tmp_path / "more.yaml", program=pbf),
                  pbf_tools.probe(run, listed, program=pbf)):
        assert list(found) == ["time_s", "H_m", "U_x_m_s", "U_y_m_s", "U_z_m_s"]
        assert found.units["U_x_m_s"] == "m/s" and found.units["time_s"] == "s"
        assert np.array_equal(found["time_s"], run.times)
        assert found["H_m"] == pytest.approx(run.gauges["H"].value, abs=2e-5)
        assert found["U_z_m_s"] == pytest.approx(run.gauges["U"].value[:, 2], abs=2e-5)


def test_a_probe_says_what_no_frame_holds(probed, pbf):
    pressure = {"name": "P", "kind": "pressure", "on": "z_min", "at": [0.2, 0, 0], "radius": 0.1}
    with pytest.raises(pbf_tools.PbfError, match=r"gauges\[0\]: a pressure comes from") as refused:
        pbf_tools.probe(probed, [pressure], program=pbf)
    assert "/tmp" not in str(refused.value)
    with pytest.raises(pbf_tools.PbfError, match="outside the domain"):
        pbf_tools.probe(probed, [{"name": "H", "kind": "level", "at": [7]}], program=pbf)


def test_the_peaks_of_a_summary_are_those_of_the_loads(pbf, tmp_path):
    (tmp_path / "s.yaml").write_text(SCENE.replace("max: [1, 0.8]", "max: [1, 0.8], loads: true")
                                     + "measure_every: 2\n")
    sweep = pbf_tools.batch(tmp_path / "s.yaml", {"solver.iterations": [4]}, tmp_path / "sweep",
                            program=pbf, progress=False)
    load = sweep.runs[0].load("x_max")
    for axis, name in ((0, "x"), (2, "z")):
        peak = load.peak(0.02, axis)[0]
        assert sweep[f"load/x_max/force_{name}/max_20ms"][0] == pytest.approx(peak, rel=1e-9)
    assert sweep.units["load/x_max/impulse_x"] == "N s"
