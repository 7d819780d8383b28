"""waves: against sums of waves made here, with wave numbers by bisection and tables of books."""

import numpy as np
import pytest

import pbf_tools
from pbf_tools import waves
from pbf_tools.errors import BadInput
from pbf_tools.wave_records import record
from pbf_tools.wave_statistics import chi_square

DEPTH, PERIOD, HEIGHT = 0.3, 1.2, 0.04
OMEGA = 2 * np.pi / PERIOD


def bisected(omega):
    """The root k of omega^2 = g k tanh(k depth)."""
    low, high = 1e-6, 1e4
    for _ in range(100):
        k = (low + high) / 2
        low, high = (k, high) if 9.81 * k * np.tanh(k * DEPTH) < omega**2 else (low, k)
    return k


K = bisected(OMEGA)
LENGTH = 2 * np.pi / K


def regular(t, x, reflection, loss=0.0, k=K):
    """Waves that run to larger x, and what of them comes back."""
    a = HEIGHT / 2 * np.exp(-loss * x)
    return a * np.cos(OMEGA * t - k * x + 0.3) + reflection * a * np.cos(OMEGA * t + k * x + 1.1)


class Sea:
    """A sea state of JONSWAP, gamma 3.3, of lines 1/repeat apart and random phases, which a wall at
    x = 9 m reflects."""

    def __init__(self, hm0, tp, repeat, seed):
        f = np.arange(np.ceil(0.4 * repeat / tp), 3 * repeat / tp) / repeat
        width = np.where(f <= 1 / tp, 0.07, 0.09)
        s = f**-5 * np.exp(-1.25 / (tp * f)**4) * 3.3**np.exp(-(tp * f - 1)**2 / (2 * width**2))
        self.a = hm0 / 4 * np.sqrt(2 * s / s.sum())
        self.omega, self.phase = 2 * np.pi * f, np.random.default_rng(seed).uniform(0, 7, len(f))
        self.k = np.array([bisected(w) for w in self.omega])

    def __call__(self, t, x, reflection=0.0):
        def part(way):
            return np.cos(np.outer(t, self.omega) - self.k * way + self.phase) @ self.a
        return part(x) + (reflection * part(18 - x) if reflection else 0)


def test_wave_numbers_fulfil_the_dispersion_relation():
    for period in (0.3, 1.2, 2.0, 30.0):
        k = waves.wavenumber(period, DEPTH)
        assert k == pytest.approx(bisected(2 * np.pi / period), rel=1e-13)
    k = waves.wavenumber(np.array([0.01, 1e4]), DEPTH)  # deep and shallow
    assert k[0] == pytest.approx((200 * np.pi)**2 / 9.81, rel=1e-14)
    assert k[1] == pytest.approx(2e-4 * np.pi / np.sqrt(9.81 * DEPTH), rel=1e-6)


@pytest.mark.parametrize("places", [(0, 0.06), (0, 0.25), (0, 0.44), (0, 0.1, 0.25), (0, 0.3, 0.7),
                                    (0, 0.1, 0.25, 0.4, 0.9)], ids=str)
def test_incident_and_reflected_waves_of_a_known_sum(places):
    """The records start and end within a period, of which the step is no fraction."""
    x, rng = 2 + LENGTH * np.array(places), np.random.default_rng(5)
    for reflection in np.arange(0, 0.95, 0.1):
        t = 3.31 + 0.0173 * np.arange(500)
        clean = [regular(t, place, reflection) for place in x]
        found = waves.split([(t, y) for y in clean], x, DEPTH, PERIOD)
        assert abs(found.reflection - reflection) < 1e-6 and found.misfit < 1e-12
        assert found.incident_height == pytest.approx(HEIGHT, rel=1e-6)
        assert np.angle(found.incident[0]) == pytest.approx(0.3, abs=1e-6)
        noisy = [(t, y + 0.02 * HEIGHT * rng.standard_normal(len(t))) for y in clean]
        assert abs(waves.split(noisy, x, DEPTH, PERIOD).reflection - reflection) < 0.02


def test_two_waves_of_regular_records_are_split_at_uneven_times_and_over_a_gap():
    rng = np.random.default_rng(2)
    t = np.sort(rng.uniform(0, 9, 400))
    t = t[(t < 4) | (t > 4.5)]
    found = waves.split([(t, regular(t, x, 0.4)) for x in (2.0, 2.3)], [2.0, 2.3], DEPTH, PERIOD)
    assert found.reflection == pytest.approx(0.4, abs=1e-3)


def test_the_split_of_irregular_waves_and_the_lines_that_are_left_out():
    sea, places = Sea(0.05, 1.5, 120, 7), (3.0, 3.2, 3.5)
    t = 3.1 + 0.1 * np.arange(1200)
    for reflection in (0.0, 0.3, 0.6, 0.9):
        pairs = [(t, sea(t, x, reflection)) for x in places]
        whole = waves.split(pairs, places, DEPTH, taper=0)
        assert whole.reflection == pytest.approx(reflection, abs=0.002) and not whole.left_out
        rows = np.searchsorted(sea.omega, 2 * np.pi * whole.frequency - 1e-6)
        assert np.allclose(whole.incident, sea.a[rows] * np.exp(1j * sea.phase[rows]), atol=1e-9)
        # A wall has what comes back arrive later, so a window has other waves of it.
        part = waves.split([(u[:-57], y[:-57]) for u, y in pairs], places, DEPTH)
        assert part.reflection == pytest.approx(reflection, abs=0.02)
        assert part.incident_height == pytest.approx(whole.incident_height, rel=0.03)
        rng = np.random.default_rng(1)
        noisy = [(u, y + 0.02 * 0.05 / 2 * rng.standard_normal(len(u))) for u, y in pairs]
        assert waves.split(noisy, places, DEPTH, taper=0).reflection == pytest.approx(reflection,
                                                                                     abs=0.02)
    band, places = (0.396, 1.604), (3.0, 3.9)
    pairs = [(t, sea(t, x, 0.3)) for x in places]
    found = waves.split(pairs, places, DEPTH, band=band, taper=0)
    inside = [n for n in range(600) if band[0] <= n / 120 <= band[1]]
    lines = np.array(inside) / 120
    power = sum(abs(np.fft.fft(y)[inside])**2 for _, y in pairs)
    bad = [np.linalg.cond(np.array([[np.exp(-1j * k * x), np.exp(1j * k * x)] for x in places])) > 6
           for k in (bisected(2 * np.pi * f) for f in lines)]
    assert 5 < sum(bad) < len(lines) / 2 and found.left_out == sum(bad)
    assert np.allclose(found.frequency, lines[~np.array(bad)])
    assert found.reflection == pytest.approx(0.3, abs=0.002)
    assert found.left_out_share == pytest.approx(power[bad].sum() / power.sum(), rel=1e-9)


def test_two_gauges_serve_up_to_a_condition_number_of_6():
    t = 0.02 * np.arange(600)
    limit = np.arccos(35 / 37) / K  # (1 + c)/(1 - c) = 36, for c = |cos k s| at a distance s
    assert 0.05 < limit / LENGTH < 0.06
    for apart, works in ((0.999 * limit, False), (1.001 * limit, True),
                         (LENGTH / 2 - 1.001 * limit, True), (LENGTH / 2 - 0.999 * limit, False)):
        pairs = [(t, regular(t, x, 0.5)) for x in (0, apart)]
        if works:
            found = waves.split(pairs, [0, apart], DEPTH, PERIOD)
            assert found.condition[0] == pytest.approx(6, rel=2e-3)
        else:
            with pytest.raises(BadInput, match="cannot split the waves"):
                waves.split(pairs, [0, apart], DEPTH, PERIOD)


def test_a_window_of_time_has_the_readings_from_its_first_to_its_last_second():
    t = 0.1 * np.arange(100)
    found = record((t, t**2), (2, 4))
    assert np.array_equal(found.time, t[20:41]) and found.mean == np.mean(t[20:41]**2)
    assert np.allclose(found.elevation, t[20:41]**2 - found.mean)
    assert len(record((t, t), (-0.1, 9.95)).time) == 100


def test_heights_phases_and_harmonics_along_a_flume():
    x = np.array([3.0, 1.0, 1.4, 2.2, 6.0])
    k, loss = 1.015 * K, -np.log(0.94) / LENGTH
    t = 0.017 * np.arange(900)

    def record(place):
        second = 0.2 * HEIGHT / 2 * np.exp(-loss * place) * np.cos(2 * OMEGA * t - 2 * k * place)
        return t, 0.3 + regular(t, place, 0, loss, k) + second

    found = waves.along([record(place) for place in x], x, DEPTH, PERIOD)
    assert found.wavenumber / found.theory == pytest.approx(1.015, abs=1e-9)
    assert found.loss == pytest.approx(0.06, abs=1e-9)
    assert np.all(np.diff(found.table["x"]) > 0) and np.allclose(found.table["second"], 0.2)
    assert np.allclose(found.table["height"], HEIGHT * np.exp(-loss * np.sort(x)))
    assert np.allclose(np.diff(found.table["phase"]), -k * np.diff(np.sort(x)))


def test_a_wrong_period_is_told(capsys):
    t = 0.02 * np.arange(1000)
    waves.along([(t, regular(t, x, 0)) for x in (1, 1.4)], [1, 1.4], DEPTH, 0.93)
    assert "is not of waves of 0.93 s; is this their period" in capsys.readouterr().err


@pytest.mark.parametrize("count", [5900, 5899])
def test_the_spectrum_of_a_sea_state(count):
    """Of about 480 waves, the significant height of which is 0.95 of Hm0."""
    tp, t = 1.5, 0.1 * np.arange(count)
    sea = Sea(0.05, tp, 600, 3)
    y = sea(t, 1.0)
    found = waves.spectrum((t, 0.4 + y))
    assert found.hm0 == pytest.approx(0.05, rel=0.01) and found.tp == pytest.approx(tp, rel=0.05)
    total = np.sum(found.bands["density"] * found.bands["width"])
    assert total == pytest.approx(np.var(y), rel=1e-12)
    f, weight = sea.omega / (2 * np.pi), sea.a**2
    for name, exact in (("tm01", weight.sum() / (weight @ f)),
                        ("tm02", np.sqrt(weight.sum() / (weight @ f**2))),
                        ("tm10", (weight @ (1 / f)) / weight.sum())):
        assert getattr(found, name) == pytest.approx(exact, rel=0.015), name
    one = waves.spectrum((t, y), average=7).bands
    assert np.all(one["freedom"][:-1] == 14) and np.allclose(one["width"][:-1], 7 / (0.1 * count))
    counted = waves.zero_crossings((t, y))
    assert 440 < counted.number < 520 and counted.tz == pytest.approx(found.tm02, rel=0.03)
    assert 0.93 < counted.h13 / found.hm0 < 0.97
    assert counted.h13 < counted.h110 < counted.hmax < 2.2 * found.hm0


def test_confidence_intervals_have_the_quantiles_of_chi_square():
    """Those of printed tables."""
    for share, freedom, value in ((0.1, 1, 0.0158), (0.9, 1, 2.7055), (0.1, 2, 0.2107),
                                  (0.9, 2, 4.6052), (0.1, 15, 8.5468), (0.1, 100, 82.3581),
                                  (0.9, 100, 118.498)):
        assert chi_square(share, freedom) == pytest.approx(value, abs=6e-5 * max(1, value / 10))
    rng = np.random.default_rng(4)
    t, y = np.arange(4096.0), rng.standard_normal(4096)
    for count in (4096, 4095):
        bands = waves.spectrum((t[:count], y[:count]), average=8).bands
        assert np.sum(bands["freedom"]) == count - 1
        total = np.sum(bands["density"] * bands["width"])
        assert total == pytest.approx(np.var(y[:count]), rel=1e-12)
    bands = waves.spectrum((t, y), average=8).bands  # white: density 2
    inside = (bands["low"] < 2) & (bands["high"] > 2)
    assert 0.74 < inside.mean() < 0.86


def test_waves_are_counted_from_one_up_crossing_to_the_next():
    heights = [0.1, 0.04, 0.08, 0.06, 0.02, 0.05, 0.03]
    periods = [1.0, 1.2, 0.8, 1.0, 1.6, 1.0, 0.4]
    ripple = 0.2

    def wave(height, period):
        n = round(period / 0.01)
        return height / 2 * np.sin(2 * np.pi * np.arange(n) / n)

    def row(parts):  # between half a trough and half a crest
        y = np.concatenate([wave(0.1, 1.0)[50:], *parts, wave(0.1, 1.0)[:51]])
        return 5 + 0.01 * np.arange(len(y)), y

    found = waves.zero_crossings(row([wave(h, p) for h, p in zip(heights, periods)]))
    assert found.number == 7 and np.allclose(found.table["height"], heights)
    assert np.allclose(found.table["period"], periods) and found.tz == pytest.approx(1.0)
    assert found.table["start"][0] == pytest.approx(5.5)
    assert found.hmax == pytest.approx(0.1) and found.h13 == pytest.approx(0.09)
    assert np.isnan(found.h110) and np.allclose(found.table["crest"], -found.table["trough"])

    t, y = row([part for h, p in zip(heights, periods) for part in (wave(h, p), wave(0.004, ripple))])
    assert waves.zero_crossings((t, y)).number == 14
    found = waves.zero_crossings((t, y), smallest=0.01)
    assert found.number == 7 and np.allclose(found.table["height"], heights)
    assert np.allclose(found.table["period"], np.array(periods) + ripple)
    calm = waves.zero_crossings((t, 0.001 * y), smallest=0.01)
    assert calm.number == 0 and np.isnan(calm.hmax) and np.isnan(calm.tz)


def test_uneven_times_are_resampled_with_a_word_and_gaps_refused(capsys):
    sea, rng = Sea(0.05, 1.5, 120, 7), np.random.default_rng(6)
    even = 0.05 * np.arange(2400)
    uneven = even + rng.uniform(-0.02, 0.02, len(even))
    exact = waves.spectrum((even, sea(even, 1.0)))
    assert capsys.readouterr().err == ""
    found = waves.spectrum((uneven, sea(uneven, 1.0)))
    assert "its times are not even" in capsys.readouterr().err
    assert found.hm0 == pytest.approx(exact.hm0, rel=3e-3)
    places = (3.0, 3.2, 3.5)
    times = (uneven, even, 0.03 + 0.06 * np.arange(1990))
    parts = waves.split([(t, sea(t, x, 0.5)) for t, x in zip(times, places)], places, DEPTH)
    assert parts.reflection == pytest.approx(0.5, abs=0.02)
    gap = np.delete(even, np.arange(300, 310))
    with pytest.raises(BadInput, match="no reading from 14.95 to 15.5 s, 11 of its usual steps"):
        waves.spectrum((gap, sea(gap, 1.0)))


T = 0.02 * np.arange(600)
FLAT = np.where(np.arange(600) == 300, np.nan, 0.01)


@pytest.mark.parametrize("call, text", [
    (lambda: waves.split([(T, T)], [0], DEPTH, PERIOD), "1 gauge: incident and reflected"),
    (lambda: waves.split([(T, T), (T, T)], [1, 1], DEPTH, PERIOD),
     "gauge 1 and gauge 2 are at the same place, 1 m"),
    (lambda: waves.split([(T, T), (T, T)], [1], DEPTH, PERIOD), "2 gauges need as many positions"),
    (lambda: waves.split([(T, np.sin(T)), (T, FLAT)], [1, 2], DEPTH, PERIOD),
     "gauge 2: 1 of 600 readings are no numbers, or 0 where a level gauge is dry, the first at 6 s"),
    (lambda: waves.split([(T, T), (T, T)], [0, LENGTH / 2], DEPTH, PERIOD), "0.5 wavelengths apart"),
    (lambda: waves.split([(T, T), (T, T)], [0, 0.3], DEPTH, 20), "too short for a period of 20 s"),
    (lambda: waves.split([(T, T), (T, T)], [0, 0.3], DEPTH, 0.03), "too coarse for a period"),
    (lambda: waves.split([(T, T), (T, T)], [0, 0.3], DEPTH, -1), "a number above 0"),
    (lambda: waves.split([(T, T), (T, T)], [0, 0.3], 0, 1), "the depth of 0 m"),
    (lambda: waves.split([(T, np.sin(5 * T))] * 2, [0, 0.3], DEPTH), "give the period of regular"),
    (lambda: waves.split([(T, T), (T, T)], [0, 0.3], DEPTH, 1, between=(5, 50)),
     "5 to 50 s must lie within its readings, from 0 to 11.98 s"),
    (lambda: waves.split([(T, T), (T, T)], [0, 0.3], DEPTH, 1, between=(5, 5.1)), "too few for"),
    (lambda: waves.along([(T, T), (T, T)], [0, 1], DEPTH, float("nan")), "need their period"),
    (lambda: waves.zero_crossings((T[:5], T[:5])), "5 readings are too few for waves"),
    (lambda: waves.zero_crossings((T[::-1], T)), "must be numbers that ascend"),
    (lambda: waves.zero_crossings((T, T[1:])), "two arrays of one length"),
    (lambda: waves.spectrum((T, 0 * T)), "no waves between"),
    (lambda: waves.spectrum((T, np.sin(T)), average=0), "give a number of lines from 1 to 300")])
def test_records_that_cannot_be_read_are_refused_in_one_sentence(call, text):
    with pytest.raises(BadInput) as error:
        call()
    assert text in str(error.value) and error.value.exit_code == 2 and "\n" not in str(error.value)


def test_the_run_up_that_2_percent_exceed_needs_50_of_them():
    heights = np.random.default_rng(8).permutation(np.arange(101)) / 100
    for number, exact in ((101, 0.98), (49, np.nan)):
        table = pbf_tools.Table({"time": np.arange(number), "height": heights[:number]})
        found = waves.RunUp(np.zeros(1), np.zeros(1), 0.0, table).r2
        assert found == pytest.approx(exact, nan_ok=True)
