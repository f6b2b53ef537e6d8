import pytest

from scratchwarp.frames import numbered, parse_frames


@pytest.mark.parametrize(
    ("text", "frames"),
    [
        ("5", [5]),
        ("1:3", [1, 2, 3]),
        ("1:10x2,15", [1, 3, 5, 7, 9, 15]),
        ("3:1", [3, 2, 1]),
        ("10:1x-4", [10, 6, 2]),
        ("-2:2x2", [-2, 0, 2]),
        ("101:102x0.1", [101 + i / 10 for i in range(11)]),
        ("1, 2 ,3", [1, 2, 3]),
    ],
)
def test_frames(text, frames):
    assert parse_frames(text) == frames


@pytest.mark.parametrize(
    "text", ["", "a", "1:", ":3", "1:2:3", "1x2", "1:5x0", "1:5x-1", "5:1x1", "nan", "1:inf", "1,,2"]
)
def test_what_is_no_frame(text):
    with pytest.raises(ValueError, match="frames"):
        parse_frames(text)


def test_too_many_frames_are_refused_before_they_are_listed():
    with pytest.raises(ValueError, match="1000000"):
        parse_frames("0:1e12")


@pytest.mark.parametrize(
    ("pattern", "frame", "name"),
    [
        ("a.###.exr", 7, "a.007.exr"),
        ("a.#.exr", 1234, "a.1234.exr"),
        ("a.###.##.exr", 101.5, "a.101.50.exr"),
        ("a.###.exr", -3, "a.-003.exr"),
        ("a.exr", 7, "a.exr"),
        ("a.###.exr", None, "a.###.exr"),
        ("shot#1/a.##.png", 4, "shot#1/a.04.png"),
    ],
)
def test_names(pattern, frame, name):
    assert numbered(pattern, frame) == name


def test_decimals_need_a_place():
    with pytest.raises(ValueError, match=r"101\.5"):
        numbered("a.###.exr", 101.5)
