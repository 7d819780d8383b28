"""A film from the pictures of a run: MP4 or WebM through ffmpeg, animated GIF or PNG without it.

Takes a folder of PNG files, a run folder (its frames/), or a run file (the pictures beside it). The
film runs as fast as the scene, 1 s in 1 s: the run file in the same folder, or in the one above,
says when every picture was. Where there is none, 25 pictures are shown per second.
"""

from __future__ import annotations

import argparse
import math
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np

from .errors import BadInput, FileError, MissingPackage, note
from .logs import RUN_HELP
from .run_file import Run
from .run_path import RUN_FILE

EXAMPLE = """examples:
  python -m pbf_tools video out/demo                       (demo.mp4, .gif without ffmpeg)
  python -m pbf_tools video out/demo --speed 0.25 -o slow.gif
  python -m pbf_tools video out/demo/frames --fps 25 --width 640 -o demo.gif"""
FILMS, ANIMATIONS = (".mp4", ".webm", ".mkv"), (".gif", ".png")
FPS = 25.0  # where nothing says the times of the pictures
# More are not shown: screens show 60 in a second, and browsers slow down a GIF of more than 50.
MOST = {".gif": 50.0}
MOST_ELSEWHERE = 60.0
LEAST_FPS, LEAST_SECONDS = 5.0, 0.5  # below, a film at the speed of the scene gets a note


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("source", metavar="SOURCE", help="folder of pictures, run folder, run file")
    parser.add_argument("-o", "--out", metavar="FILE",
                        help="film; .mp4 .webm .mkv need ffmpeg, .gif and .png (animated) do not "
                             "(default: NAME.mp4 where there is ffmpeg, else NAME.gif)")
    pace = parser.add_mutually_exclusive_group()
    pace.add_argument("--speed", type=float, metavar="F",
                      help="seconds of the scene in a second of the film (default 1); where that "
                           "is more than 60 pictures (50 of a GIF) per second, some are left out")
    pace.add_argument("--fps", type=float, help="pictures per second instead, whatever speed "
                                                "that is")
    parser.add_argument("--times", metavar="RUN",
                        help=f"{RUN_HELP} whose frames the pictures show, when they are elsewhere")
    parser.add_argument("--width", type=int, metavar="PX",
                        help="of the film (default: as the pictures, but 640 for .gif and .png)")
    parser.add_argument("--every", type=int, default=1, metavar="N", help="take each N-th picture")
    parser.add_argument("--ffmpeg", default="ffmpeg", metavar="PROGRAM", help="ffmpeg to use")


def pictures(source: str) -> list[Path]:
    """The PNG files in the order of the numbers in their names."""
    path = Path(source)
    if not path.exists():
        raise FileError(f"{source}: no such file or folder")
    folders = [path, path / "frames", path / "render"]
    if path.is_file():
        folders = [path.parent / "frames", path.parent / "render"]
    for folder in folders:
        found = sorted(folder.glob("*.png"),
                       key=lambda p: ([int(n) for n in re.findall(r"\d+", p.stem)], p.name))
        if found:
            return found
    raise FileError(f"{source}: no PNG pictures there; draw some: pbf render RUN --out FOLDER")


def times_of(files: list[Path], run: str | None) -> np.ndarray | None:
    """When each picture was, s: the number in its name is that of a frame of the run beside the
    pictures, or in the folder above. None without one that has these frames."""
    folder = files[0].absolute().parent
    beside = next((f / RUN_FILE for f in (folder, folder.parent) if (f / RUN_FILE).is_file()), None)
    numbers = [re.findall(r"\d+", file.stem) for file in files]
    if run is None and (beside is None or not all(numbers)):
        return None
    try:
        times, frames = Run(run or beside).times, [int(n[-1]) if n else -1 for n in numbers]
    except FileError as problem:
        if run:
            raise
        note(f"{problem}; without it, the times of the pictures are not known")
        return None
    strange = [file for file, k in zip(files, frames) if not 0 <= k < len(times)]
    if strange and run:
        raise BadInput(f"{run}: has {len(times)} frames, and {strange[0]} is not one of them")
    return None if strange else times[frames]


def pace(times: np.ndarray | None, args: argparse.Namespace,
         most: float) -> tuple[int, float, float | None]:
    """Which pictures to take, each n-th; how many of these per second; and the seconds of the scene
    between two of all pictures, None where these are not known."""
    if times is None or len(times) < 2:
        return 1, args.fps or FPS, None
    interval = float(times[-1] - times[0]) / (len(times) - 1)
    if not interval > 0:
        raise BadInput("the pictures are not in the order of time: number them as the frames of "
                       "their run")
    if np.max(np.diff(times)) > 1.5 * np.min(np.diff(times)):
        note("the times between the pictures differ: the speed of the film is a mean")
    if args.fps is not None:
        return 1, args.fps, interval
    speed = 1.0 if args.speed is None else args.speed
    n = max(1, math.ceil(speed / (interval * most) - 1e-6))
    return n, speed / (interval * n), interval


def said_speed(speed: float | None) -> str:
    """How fast the film is, for the message at the end.

    >>> said_speed(1.0), said_speed(0.25)
    ('at the speed of the scene', '0.25 times as fast as the scene')
    """
    if speed is None:
        return "speed unknown: no run file with the times of the pictures"
    return "at the speed of the scene" if abs(speed - 1) < 5e-3 else \
        f"{speed:.3g} times as fast as the scene"


def run(args: argparse.Namespace) -> int:
    for name, low, high in (("fps", 0, 1000), ("speed", 0, 1e9)):
        value = getattr(args, name)
        if value is not None and not low < value <= high:
            raise BadInput(f"--{name} {value:g}: give a number above {low}, at most {high:g}")
    if args.every < 1 or (args.width is not None and not 16 <= args.width <= 16384):
        raise BadInput("--every goes from 1, --width from 16 to 16384")
    files = pictures(args.source)[::args.every]
    ffmpeg = shutil.which(args.ffmpeg)
    name = files[0].parent if files[0].parent.name not in ("frames", "render") \
        else files[0].parent.parent
    out = Path(args.out or f"{name.resolve().name}{'.mp4' if ffmpeg else '.gif'}")
    if out.suffix not in FILMS + ANIMATIONS:
        raise BadInput(f"{out}: the ending must be one of {' '.join(FILMS + ANIMATIONS)}")
    times = times_of(files, args.times)
    if times is None and args.speed is not None:
        raise BadInput(f"--speed {args.speed:g}: no run file beside {files[0].parent} says when "
                       "the pictures were; name it with --times, or give --fps")
    n, fps, interval = pace(times, args, MOST.get(out.suffix, MOST_ELSEWHERE))
    files = files[::n]
    if out.suffix in FILMS:
        if not ffmpeg:
            raise MissingPackage(f"{args.ffmpeg}: not found, and {out.suffix} needs ffmpeg; "
                                 f"install it, or write {out.with_suffix('.gif')}")
        _film(ffmpeg, files, out, fps, args.width)
    else:
        _animation(files, out, fps, args.width)
    seconds = len(files) / fps
    print(f"wrote {out}: {len(files)} pictures, {seconds:.3g} s, "
          f"{said_speed(interval and n * interval * fps)}, {out.stat().st_size / 1e6:.3g} MB")
    if interval and args.fps is None and args.speed is None and \
            (fps < LEAST_FPS or seconds < LEAST_SECONDS):
        note(f"at this speed the film has {fps:.3g} pictures per second and lasts {seconds:.2g} s; "
             f"--speed {FPS * interval:.2g} shows all pictures, {FPS:g} per second")
    return 0


def _film(ffmpeg: str, files: list[Path], out: Path, fps: float, width: int | None) -> None:
    # yuv420p, what all players show, needs even sizes.
    scale = f"scale={width or 'iw'}:-1,pad=ceil(iw/2)*2:ceil(ih/2)*2"
    command = [ffmpeg, "-y", "-loglevel", "error", "-f", "image2pipe", "-framerate", f"{fps:.6g}",
               "-i", "-", "-vf", scale, "-pix_fmt", "yuv420p", str(out)]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stdin is not None
    try:
        for file in files:
            process.stdin.write(file.read_bytes())
    except BrokenPipeError:
        pass  # ffmpeg gave up; why, stands in its messages
    _, messages = process.communicate()
    if process.returncode:
        raise FileError(f"{out}: ffmpeg failed: {messages.decode(errors='replace').strip()}")


def durations(count: int, fps: float) -> list[int]:
    """How long each picture is shown, ms: whole hundredths of a second, which is what a GIF can
    say, and right in the sum.

    >>> durations(4, 30), durations(2, 25)
    ([30, 40, 30, 30], [40, 40])
    """
    ends = [round(100 * k / fps) for k in range(count + 1)]
    return [10 * max(1, b - a) for a, b in zip(ends, ends[1:])]


def _animation(files: list[Path], out: Path, fps: float, width: int | None) -> None:
    try:
        from PIL import Image
    except ImportError:
        raise MissingPackage("Pillow is not installed: pip install pillow") from None

    def load(file: Path) -> Image.Image:
        with Image.open(file) as opened:
            image = opened.convert("RGB")
        across = width or min(640, image.width)
        height = max(1, round(image.height * across / image.width))
        return image.resize((across, height), Image.Resampling.LANCZOS)

    try:
        images = [load(file) for file in files]
        if out.suffix == ".gif":
            # One palette for all, from up to 9 of them one below the other: colours do not flicker.
            some = images[::max(1, len(images) // 8)]
            strip = Image.new("RGB", (images[0].width, sum(image.height for image in some)))
            for k, image in enumerate(some):
                strip.paste(image, (0, sum(other.height for other in some[:k])))
            palette = strip.quantize(256)
            images = [image.quantize(palette=palette) for image in images]
        images[0].save(out, save_all=True, append_images=images[1:], loop=0,
                       duration=durations(len(images), fps))
    except OSError as problem:
        raise FileError(f"{out}: {problem.strerror or problem}") from None
