"""Frame specifications and numbered file names, as usdrecord has them.

``101:109x2,115`` is frames 101, 103, 105, 107, 109 and 115; ``ball.###.exr`` is numbered with at least three digits,
and ``ball.###.##.exr`` with two decimals besides.
"""

import re
from decimal import Decimal, InvalidOperation

_RANGE = re.compile(r"([^:x]+)(?::([^:x]+)(?:x([^:x]+))?)?")
_PLACE = re.compile(r"(#+)(?:\.(#+))?")


def parse_frames(text: str) -> list[float]:
    """The frames of ``text``, in its order; ValueError naming the part that is no frame or range START:STOP[xSTRIDE].

    A stride is 1 unless given; it must be positive when STOP is after START and negative when it is before.
    """
    frames: list[float] = []
    for part in text.split(","):
        start, stop, stride = _numbers(part.strip())
        stop = start if stop is None else stop
        step = Decimal(1 if stop >= start else -1) if stride is None else stride
        if step == 0 or (stop - start) * step < 0:
            raise ValueError(f"frames: {part.strip()!r} never arrives: its stride is {step}")
        count = int((stop - start) / step) + 1
        if count > 1_000_000:
            raise ValueError(f"frames: {part.strip()!r} is {count} frames, more than 1000000")
        frames += [float(start + i * step) for i in range(count)]
    return frames


def _numbers(part: str) -> tuple[Decimal, Decimal | None, Decimal | None]:
    match = _RANGE.fullmatch(part)
    try:
        start, stop, stride = (None if t is None else Decimal(t) for t in (match.groups() if match else ("", "", "")))
    except InvalidOperation:
        start = stop = stride = None
    if start is None or not all(v is None or v.is_finite() for v in (start, stop, stride)):
        raise ValueError(f"frames: {part!r} is neither a frame nor START:STOP nor START:STOPxSTRIDE")
    return start, stop, stride


def numbered(pattern: str, frame: float | None) -> str:
    """``pattern`` with its last group of # replaced by ``frame``; as it is without # or without a frame.

    ValueError when ``frame`` has decimals that the pattern has no place for.
    """
    places = list(_PLACE.finditer(pattern))
    if not places or frame is None:
        return pattern
    place = places[-1]
    decimals = len(place[2] or "")
    if abs(round(frame, decimals) - frame) > 1e-9:
        raise ValueError(f"output {pattern!r} has no place for the decimals of frame {frame:g}; write ###.### in it")
    whole, digits = f"{abs(frame):.{decimals}f}".partition(".")[::2]
    text = ("-" if frame < 0 else "") + whole.zfill(len(place[1])) + (f".{digits}" if digits else "")
    return pattern[: place.start()] + text + pattern[place.end() :]


def is_numbered(pattern: str) -> bool:
    """Whether ``pattern`` has a place for a frame number."""
    return "#" in pattern
