"""Loads over windows of time: from impulses, whatever the interval of the log is."""

import subprocess

import numpy as np
import pytest

import pbf_tools

SCENE = """dimensions: 2
domain: {min: [0, 0], max: [1, 0.8], loads: true}
fluid: {spacing: 0.04}
bodies: [{shape: block, min: [0, 0], max: [0.4, 0.48]}]
time: {step: 0.002, end: 0.6}
output: {every: 0.2}
"""


@pytest.fixture(scope="module")
def runs(pbf, tmp_path_factory):
    """The same run, measured every 5, 10 and 20 updates."""
    place = tmp_path_factory.mktemp("loaded")
    (place / "s.yaml").write_text(SCENE)
    for every in (5, 10, 20):
        subprocess.run([pbf, "run", "s.yaml", "--quiet", "--set", f"measure_every={every}", "--out",
                        str(every)], check=True, cwd=place, capture_output=True)
    return {every: pbf_tools.open(place / str(every)) for every in (5, 10, 20)}


def test_means_and_impulses_do_not_depend_on_how_often_a_run_is_measured(runs):
    rows = runs[20].log["time"][1:-1]
    fine = runs[5].load("x_max")
    for every in (10, 20):
        load = runs[every].load("x_max")
        at = np.searchsorted(fine.time, load.time - 1e-9)
        assert np.allclose(load.impulse, fine.impulse[at], rtol=1e-12, atol=1e-12)
        # Windows that begin and end at rows of all three.
        mean, other = load.mean(0.08), fine.mean(0.08)
        for t in rows:
            a, b = (np.flatnonzero(np.isclose(x.time, t))[0] for x in (load, fine))
            assert np.allclose(mean[a], other[b], rtol=1e-9, atol=1e-9)


def test_the_peak_over_a_window_is_that_of_the_forces_it_averages(runs):
    load = runs[5].load("x_max")
    force, time = load.peak(0.02, axis=0)
    sums = np.array([load.force[k:k + 2, 0].mean() for k in range(1, len(load.time) - 1)])
    assert force == pytest.approx(sums.max(), rel=1e-6) and force > 0
    assert time == pytest.approx(load.time[1 + sums.argmax()], abs=1e-9)
    assert load.peak(0.02)[0] >= force


def test_windows_that_no_log_holds_are_refused(runs):
    load = runs[20].load("x_max")
    with pytest.raises(pbf_tools.BadInput, match="shorter than the time between two rows"):
        load.mean(0.02)
    with pytest.raises(pbf_tools.BadInput, match="longer than the run"):
        load.peak(5)
    with pytest.raises(pbf_tools.UnknownName, match="did you mean x_max"):
        runs[20].load("xmax")
