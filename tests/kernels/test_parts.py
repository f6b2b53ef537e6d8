"""Parts are built again only where their sources changed."""

from scratchwarp.kernels import Parts


def test_equal_sources_give_what_is_there():
    parts, built = Parts(), []

    def build():
        built.append(1)
        return object()

    first = parts.part("a", (1, "x"), build)
    assert parts.part("a", (1, "x"), build) is first and parts.last("a") == ((1, "x"), first)
    assert parts.part("b", (1, "x"), build) is not first and len(built) == 2
    assert set(parts.seconds) == {"a", "b"}
    parts.seconds.clear()
    assert parts.part("a", (2, "x"), build) is not first and set(parts.seconds) == {"a"}
    assert parts.last("c") is None
