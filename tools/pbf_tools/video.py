"""A film from the pictures of a run: MP4 or WebM through ffmpeg, animated GIF or PNG without it.

Takes a folder of PNG files, a run folder (its frames/), or a run file (the pictures beside it).
"""

from __future__ import annotations

import argparse
import re
import shutil
import subprocess
from pathlib import Path

from .errors import BadInput, FileError, MissingPackage

EXAMPLE = """examples:
  python -m pbf_tools video out/demo                       (demo.mp4, .gif without ffmpeg)
  python -m pbf_tools video out/demo/frames --fps 25 --width 640 -o demo.gif"""
FILMS, ANIMATIONS = (".mp4", ".webm", ".mkv"), (".gif", ".png")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("source", metavar="SOURCE", help="folder of pictures, run folder, run file")
    parser.add_argument("-o", "--out", metavar="FILE",
                        help="film; .mp4 .webm .mkv need ffmpeg, .gif and .png (animated) do not "
                             "(default: NAME.mp4 where there is ffmpeg, else NAME.gif)")
    parser.add_argument("--fps", type=float, default=25, help="pictures per second (default 25)")
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


def run(args: argparse.Namespace) -> int:
    if not 0 < args.fps <= 1000 or args.every < 1 or \
            (args.width is not None and not 16 <= args.width <= 16384):
        raise BadInput("--fps goes from above 0 to 1000, --every from 1, --width from 16 to 16384")
    files = pictures(args.source)[::args.every]
    ffmpeg = shutil.which(args.ffmpeg)
    name = files[0].parent if files[0].parent.name not in ("frames", "render") \
        else files[0].parent.parent
    out = Path(args.out or f"{name.resolve().name}{'.mp4' if ffmpeg else '.gif'}")
    if out.suffix in FILMS:
        if not ffmpeg:
            raise MissingPackage(f"{args.ffmpeg}: not found, and {out.suffix} needs ffmpeg; "
                                 f"install it, or write {out.with_suffix('.gif')}")
        _film(ffmpeg, files, out, args)
    elif out.suffix in ANIMATIONS:
        _animation(files, out, args)
    else:
        raise BadInput(f"{out}: the ending must be one of {' '.join(FILMS + ANIMATIONS)}")
    print(f"wrote {out}: {len(files)} pictures, {len(files) / args.fps:.3g} s, "
          f"{out.stat().st_size / 1e6:.3g} MB")
    return 0


def _film(ffmpeg: str, files: list[Path], out: Path, args: argparse.Namespace) -> None:
    # yuv420p, what all players show, needs even sizes.
    scale = f"scale={args.width or 'iw'}:-1,pad=ceil(iw/2)*2:ceil(ih/2)*2"
    command = [ffmpeg, "-y", "-loglevel", "error", "-f", "image2pipe", "-framerate", str(args.fps),
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


def _animation(files: list[Path], out: Path, args: argparse.Namespace) -> None:
    try:
        from PIL import Image
    except ImportError:
        raise MissingPackage("Pillow is not installed: pip install pillow") from None

    def load(file: Path) -> Image.Image:
        with Image.open(file) as opened:
            image = opened.convert("RGB")
        width = args.width or min(640, image.width)
        height = max(1, round(image.height * width / image.width))
        return image.resize((width, height), Image.Resampling.LANCZOS)

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
                       duration=1000 / args.fps)
    except OSError as problem:
        raise FileError(f"{out}: {problem.strerror or problem}") from None
