"""video: GIFs and PNGs read back, and what ffmpeg is handed."""

import os
import shutil
import stat

import numpy as np
import pytest

from pbf_tools import video


def test_a_gif_shows_the_pictures_in_order(tools, pictures, tmp_path):
    image = pytest.importorskip("PIL.Image")
    code, out, _ = tools("video", pictures, "-o", tmp_path / "a.gif", "--fps", 20, "--width", 32)
    assert code == 0 and "12 pictures, 0.6 s, speed unknown" in out
    with image.open(tmp_path / "a.gif") as film:
        assert film.n_frames == 12 and film.size == (32, 24) and film.info["duration"] == 50
        reds = []
        for k in range(12):
            film.seek(k)
            reds.append(film.convert("RGB").getpixel((5, 5))[0])
    assert reds == sorted(reds) and reds[0] < 25 and reds[-1] > 230
    assert tools("video", pictures, "-o", tmp_path / "a.png", "--every", 4)[0] == 0
    with image.open(tmp_path / "a.png") as film:
        assert film.n_frames == 3


def test_ffmpeg_gets_all_pictures_and_its_failure_is_reported(tools, pictures, tmp_path):
    program = tmp_path / "ffmpeg"  # a stand-in: keeps its input, writes the output
    program.write_text('#!/bin/sh\ncat >"$0.in"\n[ -z "$FAIL" ] || { echo no codec >&2; exit 1; }\n'
                       'for last; do :; done; echo film >"$last"\n')
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    assert tools("video", pictures, "-o", tmp_path / "a.mp4", "--ffmpeg", program)[0] == 0
    sent = (tmp_path / "ffmpeg.in").read_bytes()
    files = [pictures / "frames" / f"frame_{k}.png" for k in range(12)]
    assert sent == b"".join(f.read_bytes() for f in files)
    os.environ["FAIL"] = "1"
    try:
        code, _, err = tools("video", pictures, "-o", tmp_path / "b.mp4", "--ffmpeg", program)
    finally:
        del os.environ["FAIL"]
    assert code == 5 and "ffmpeg failed: no codec" in err


def test_a_film_that_cannot_be_made_says_why(tools, pictures, tmp_path):
    code, _, err = tools("video", pictures, "-o", tmp_path / "a.mp4", "--ffmpeg", "no-such-ffmpeg")
    assert code == 4 and "a.gif" in err
    code, _, err = tools("video", tmp_path, "-o", tmp_path / "a.gif")
    assert code == 5 and "pbf render" in err
    assert tools("video", tmp_path / "nowhere")[0] == 5
    assert tools("video", pictures, "-o", tmp_path / "a.avi")[0] == 2
    assert tools("video", pictures, "--fps", 0)[0] == 2


@pytest.fixture
def filmed(minimal, pictures):
    """A run folder with 12 pictures and the run whose first frames, 0.02 s apart, they show."""
    shutil.copy(minimal, pictures)
    return pictures


def shown(path):
    """Milliseconds of every picture of an animation."""
    from PIL import Image
    times = []
    with Image.open(path) as film:
        for k in range(film.n_frames):
            film.seek(k)
            times.append(film.info["duration"])
    return times


@pytest.mark.parametrize("words, durations, said", [
    ((), [20] * 12, "0.24 s, at the speed of the scene"),
    (("--speed", 1), [20] * 12, "at the speed of the scene"),
    (("--speed", 0.25), [80] * 12, "0.96 s, 0.25 times as fast as the scene"),
    (("--speed", 2), [20] * 6, "0.12 s, 2 times as fast as the scene"),
    (("--fps", 25), [40] * 12, "0.48 s, 0.5 times as fast as the scene"),
    (("--every", 3), [60] * 4, "0.24 s, at the speed of the scene"),
    (("--every", 3, "--fps", 50), [20] * 4, "0.08 s, 3 times as fast as the scene")], ids=str)
def test_a_film_is_as_fast_as_the_scene_or_as_asked_for(tools, filmed, tmp_path, words, durations,
                                                       said):
    pytest.importorskip("PIL")
    for source in (filmed, filmed / "frames", filmed / "run.vtkhdf"):
        code, out, _ = tools("video", source, "-o", tmp_path / "a.gif", *words)
        assert code == 0 and said in out
        assert shown(tmp_path / "a.gif") == durations


def test_a_gif_is_right_in_the_sum_where_no_picture_can_be(tools, filmed, tmp_path):
    pytest.importorskip("PIL")
    assert tools("video", filmed, "-o", tmp_path / "a.gif", "--speed", 0.6)[0] == 0
    assert sum(shown(tmp_path / "a.gif")) == 400 and set(shown(tmp_path / "a.gif")) == {30, 40}
    for fps in (7, 24, 30, 60, 99.5):
        assert abs(sum(video.durations(1000, fps)) - 1e6 / fps) <= 5


def test_pictures_of_a_folder_elsewhere_are_timed_by_the_run_that_is_named(tools, filmed, minimal,
                                                                          tmp_path):
    pytest.importorskip("PIL")
    away = shutil.move(filmed / "frames", tmp_path / "elsewhere")
    code, out, _ = tools("video", away, "-o", tmp_path / "a.gif")
    assert code == 0 and "0.48 s, speed unknown" in out
    code, _, err = tools("video", away, "-o", tmp_path / "a.gif", "--speed", 1)
    assert code == 2 and "name it with --times, or give --fps" in err
    code, out, _ = tools("video", away, "-o", tmp_path / "a.gif", "--times", minimal.parent)
    assert code == 0 and "at the speed of the scene" in out
    shutil.copy(away / "frame_0.png", away / "first.png")
    code, _, err = tools("video", away, "-o", tmp_path / "a.gif", "--times", minimal)
    assert code == 2 and "first.png is not one of them" in err
    (away / "first.png").unlink()
    (away / "frame_11.png").rename(away / "frame_26.png")  # the run has frames 0 to 25
    code, _, err = tools("video", away, "-o", tmp_path / "a.gif", "--times", minimal)
    assert code == 2 and "has 26 frames, and" in err and "frame_26.png is not one of them" in err


def test_a_film_that_is_over_at_once_or_stands_still_says_how_to_mend_that(tools, filmed, tmp_path):
    pytest.importorskip("PIL")
    code, _, err = tools("video", filmed, "-o", tmp_path / "a.gif")
    assert code == 0 and "note:" in err and "--speed 0.5 shows all pictures, 25 per second" in err
    assert "note" not in tools("video", filmed, "-o", tmp_path / "a.gif", "--speed", 1)[2]
    code, _, err = tools("video", filmed, "-o", tmp_path / "a.gif", "--every", 11)
    assert "note:" in err


def test_a_film_of_pictures_at_uneven_times_says_that_its_speed_is_a_mean(tools, filmed, tmp_path):
    pytest.importorskip("PIL")
    (filmed / "frames/frame_11.png").rename(filmed / "frames/frame_22.png")
    code, out, err = tools("video", filmed, "-o", tmp_path / "a.gif", "--speed", 1)
    assert code == 0 and "the speed of the film is a mean" in err
    assert sum(shown(tmp_path / "a.gif")) == 480  # 12 times 0.04 s, the mean


def test_a_run_file_that_cannot_be_read_does_not_keep_one_from_a_film(tools, filmed, tmp_path):
    pytest.importorskip("PIL")
    (filmed / "run.vtkhdf").write_text("no HDF5\n" * 1000)
    code, out, err = tools("video", filmed, "-o", tmp_path / "a.gif")
    assert code == 0 and "12 pictures, 0.48 s, speed unknown" in out
    assert "note:" in err and "not an HDF5 file; without it" in err
    code, _, err = tools("video", filmed, "-o", tmp_path / "b.gif", "--times", filmed)
    assert code == 5 and "not an HDF5 file" in err


def test_ffmpeg_is_told_the_rate_that_gives_the_speed(tools, filmed, tmp_path):
    program = tmp_path / "ffmpeg"
    program.write_text('#!/bin/sh\ncat >/dev/null\necho "$@" >"$0.words"\n'
                       'for last; do :; done; echo film >"$last"\n')
    program.chmod(program.stat().st_mode | stat.S_IXUSR)
    for words, rate in (((), "50"), (("--speed", 0.1), "5"), (("--speed", 2), "50"),
                        (("--fps", 60), "60")):
        assert tools("video", filmed, "-o", tmp_path / "a.mp4", "--ffmpeg", program, *words)[0] == 0
        assert f"-framerate {rate} " in (tmp_path / "ffmpeg.words").read_text()


@pytest.mark.parametrize("words", [("--speed", 0), ("--speed", -1), ("--speed", "nan"),
                                   ("--fps", "nan"), ("--speed", 1, "--fps", 25)], ids=str)
def test_a_pace_that_cannot_be_is_refused(tools, filmed, tmp_path, words):
    code, _, err = tools("video", filmed, "-o", tmp_path / "a.gif", *words)
    assert code == 2 and words[0] in err and not (tmp_path / "a.gif").exists()


def test_pictures_are_left_out_only_above_what_a_screen_can_show():
    args = type("", (), {"fps": None, "speed": None})
    assert video.pace(np.arange(10) / 60, args, 60)[:2] == (1, pytest.approx(60))
    assert video.pace(np.arange(10) / 1000, args, 50)[:2] == (20, pytest.approx(50))
