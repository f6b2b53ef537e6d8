"""Error against seconds on logarithmic axes, as SVG."""

import html
import math
from collections.abc import Mapping, Sequence

from .report import Row

COLORS = (
    "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#7a5195", "#8c564b", "#444444", "#a0a000",
    "#00a0a0", "#b04080",
)  # fmt: skip
_WIDE, _HIGH, _LEFT, _TOP, _RIGHT, _LOW = 760, 420, 74, 14, 16, 46
_COLUMNS = 3


def chart(
    lines: Mapping[str, Sequence[Row]],
    dots: Sequence[Row] = (),
    front: Sequence[Row] = (),
    floor: float | None = None,
    axis: str = "error (relMSE)",
    colored: Sequence[str] = (),
) -> str:
    """One line for each knob by its rows, grey dots for other settings, the front as a dashed stair, a cross at the
    defaults and a dotted line at the ``floor``, the noise of the reference. ``axis``: what the errors are. ``colored``:
    knobs in the order of their colours, where that is not the order of the lines.

    Hovering over a point names it. Errors of 0 are drawn at the lower edge.
    """
    every = [row for rows in lines.values() for row in rows] + [*dots, *front]
    errors = [row.error for row in every if row.error > 0.0] or [1.0]
    seconds = [max(row.seconds, 1e-6) for row in every] or [1.0]
    x0, x1 = _span(min(seconds), max(seconds))
    y0, y1 = _span(min(*errors, *([floor] if floor else []), max(errors)), max(errors))

    names = list(colored) or list(lines)
    colors = {name: COLORS[names.index(name) % len(COLORS)] for name in lines}

    def x(row: Row) -> float:
        share = (math.log10(max(row.seconds, 1e-6)) - x0) / (x1 - x0)
        return _LEFT + (_WIDE - _LEFT - _RIGHT) * share

    def level(error: float) -> float:
        share = (math.log10(max(error, 10**y0)) - y0) / (y1 - y0)
        return _HIGH - _LOW - (_HIGH - _LOW - _TOP) * share

    def y(row: Row) -> float:
        return level(row.error)

    legend = [*lines, *(["several knobs"] if dots else []), *(["front"] if front else [])]
    base = next((row for row in every if not row.knobs), None)
    legend += ["defaults"] if base is not None else []
    height = _HIGH + 20 * math.ceil(len(legend) / _COLUMNS) + 10
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDE} {height}" role="img" '
        'aria-label="error against seconds">',
        '<g font-family="sans-serif" font-size="12" fill="#444" stroke="none">',
    ]
    for power, step, label in _ticks(x0, x1):
        at = _LEFT + (_WIDE - _LEFT - _RIGHT) * (power - x0) / (x1 - x0)
        parts.append(f'<path d="M{at:.1f} {_TOP}V{_HIGH - _LOW}" stroke="{"#ccc" if step == 1 else "#eee"}"/>')
        if label:
            parts.append(f'<text x="{at:.1f}" y="{_HIGH - _LOW + 16}" text-anchor="middle">{label}</text>')
    for power, step, label in _ticks(y0, y1):
        at = _HIGH - _LOW - (_HIGH - _LOW - _TOP) * (power - y0) / (y1 - y0)
        parts.append(f'<path d="M{_LEFT} {at:.1f}H{_WIDE - _RIGHT}" stroke="{"#ccc" if step == 1 else "#eee"}"/>')
        if label:
            parts.append(f'<text x="{_LEFT - 6}" y="{at + 4:.1f}" text-anchor="end">{label}</text>')
    middle = (_HIGH - _LOW + _TOP) / 2
    parts.append(f'<text x="{(_WIDE + _LEFT) / 2}" y="{_HIGH - 8}" text-anchor="middle">seconds</text>')
    parts.append(f'<text transform="translate(14 {middle}) rotate(-90)" text-anchor="middle">{axis}</text>')
    if floor:
        at = level(floor)
        parts.append(f'<path d="M{_LEFT} {at:.1f}H{_WIDE - _RIGHT}" stroke="#b00" stroke-dasharray="2 4"/>')
        parts.append(f'<text x="{_WIDE - _RIGHT - 4}" y="{at - 5:.1f}" text-anchor="end" fill="#b00">'
                     "noise of the reference</text>")  # fmt: skip
    if front:
        ordered = sorted(front, key=lambda row: row.seconds)
        path = f"M{x(ordered[0]):.1f} {_TOP}V{y(ordered[0]):.1f}"
        path += "".join(f"H{x(row):.1f}V{y(row):.1f}" for row in ordered[1:]) + f"H{_WIDE - _RIGHT}"
        parts.append(f'<path d="{path}" fill="none" stroke="#222" stroke-dasharray="5 4"/>')
        parts += [f'<circle cx="{x(r):.1f}" cy="{y(r):.1f}" r="8" fill="none" stroke="#222"/>' for r in ordered]
    parts += [_dot(x(row), y(row), "#999", row) for row in dots]
    for name, rows in lines.items():
        color = colors[name]
        points = " ".join(f"{x(row):.1f},{y(row):.1f}" for row in rows)
        parts.append(f'<polyline points="{points}" fill="none" stroke="{color}" stroke-width="1.6"/>')
        parts += [_dot(x(row), y(row), color, row) for row in rows]
    if base is not None:
        parts.append(f'<path d="{_cross(x(base), y(base), 7)}" stroke="#000" stroke-width="2"/>')
    for number, name in enumerate(legend):
        left, below = _LEFT + 225 * (number % _COLUMNS), _HIGH + 14 + 20 * (number // _COLUMNS)
        parts.append(_key(name, colors.get(name, ""), left, below))
        parts.append(f'<text x="{left + 28}" y="{below}">{html.escape(name)}</text>')
    return "\n".join([*parts, "</g>", "</svg>"])


def _key(name: str, color: str, left: float, below: float) -> str:
    """What a legend's text stands beside."""
    at = below - 4
    if color:
        return f'<path d="M{left} {at}h22" stroke="{color}" stroke-width="3"/>'
    if name == "front":
        dashes = f'<path d="M{left} {at}h22" stroke="#222" stroke-dasharray="5 4"/>'
        return f'{dashes}<circle cx="{left + 11}" cy="{at}" r="6" fill="none" stroke="#222"/>'
    if name == "defaults":
        return f'<path d="{_cross(left + 11, at, 6)}" stroke="#000" stroke-width="2"/>'
    return f'<circle cx="{left + 11}" cy="{at}" r="4" fill="#999"/>'


def _cross(x: float, y: float, arm: float) -> str:
    return f"M{x - arm:.1f} {y:.1f}h{2 * arm}M{x:.1f} {y - arm:.1f}v{2 * arm}"


def _dot(x: float, y: float, color: str, row: Row) -> str:
    says = f"{row.name}: {row.seconds:.3g} s, relMSE {row.error:.3g}"
    return f'<circle cx="{x:.1f}" cy="{y:.1f}" r="4" fill="{color}"><title>{html.escape(says)}</title></circle>'


def _span(low: float, high: float) -> tuple[float, float]:
    """Powers of ten about a range, a little wider than it."""
    a, b = math.log10(low), math.log10(high)
    gap = max(0.08 * (b - a), 0.1)
    return a - gap, b + gap


def _ticks(low: float, high: float) -> list[tuple[float, int, str]]:
    """(power, first digit, label or nothing) of 1, 2 and 5 times powers of ten, of every digit over less than one."""
    found = []
    for power in range(math.floor(low), math.ceil(high) + 1):
        for digit in (1, 2, 5) if high - low > 0.9 else range(1, 10):
            at = power + math.log10(digit)
            if low <= at <= high:
                label = f"{digit * 10.0**power:.3g}" if digit == 1 or high - low < 2.5 else ""
                found.append((at, digit, label))
    return found
