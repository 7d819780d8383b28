"""video: GIFs and PNGs read back, and what ffmpeg is handed."""

import os
import stat

import pytest


def test_a_gif_shows_the_pictures_in_order(tools, pictures, tmp_path):
    image = pytest.importorskip("PIL.Image")
    code, out, _ = tools("video", pictures, "-o", tmp_path / "a.gif", "--fps", 20, "--width", 32)
    assert code == 0 and "12 pictures, 0.6 s" in out
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
