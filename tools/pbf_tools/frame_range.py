"""Which frames: the same words as in `pbf render --frames`."""

from __future__ import annotations

import re

from .errors import BadInput

HELP = "all, k, a:b or a:b:step; b excluded, negative from the end"


def parse(text: str, count: int) -> list[int]:
    """Frame numbers out of 0..count-1; BadInput when the text is not understood or none is left.

    >>> parse("all", 3), parse("-1", 3), parse("0:-1:2", 6)
    ([0, 1, 2], [2], [0, 2, 4])
    """
    if text == "all":
        numbers = list(range(count))
    elif re.fullmatch(r"-?\d+", text):
        k = int(text)
        numbers = [k % count] if -count <= k < count else []
    elif re.fullmatch(r"(-?\d*):(-?\d*)(:\d+)?", text):
        parts = [int(p) if p else None for p in text.split(":")]
        if len(parts) == 3 and parts[2] == 0:
            raise BadInput(f"--frames {text}: the step must be above 0")
        numbers = list(range(count))[slice(*parts)]
    else:
        raise BadInput(f"--frames {text}: write {HELP}")
    if not numbers:
        raise BadInput(f"--frames {text}: no such frame; the file has {count}")
    return numbers
