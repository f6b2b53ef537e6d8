"""A renderer that renders nothing, so that the command line is tested by itself."""

from types import SimpleNamespace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.plan import cost
from scratchwarp.scene import RenderOptions


class Renderer:
    """Stands in for read, make_plan and render, and notes how it was called."""

    def __init__(self):
        self.reads, self.settings, self.renders = [], [], []
        self.warnings = ()
        self.options = RenderOptions()
        self.during_render = lambda: None

    def read(self, path, **how):
        self.reads.append((str(path), how))
        return SimpleNamespace(path=str(path), warnings=tuple(self.warnings), options=self.options)

    def make_plan(self, scene, settings):
        self.settings.append(settings)
        effect = SimpleNamespace(enabled=False, reason="nothing can occlude", prims=("/World/Ball",))
        return SimpleNamespace(
            warnings=(),
            effects={"shadows": effect},
            explain=lambda: "shadows off nothing can occlude",
            settings=settings,
        )

    def render(self, scene, plan, progress=None, **how):
        self.renders.append(how)
        progress(1, 2, "trace")
        self.during_render()
        aovs = {"color": np.ones((2, 3, 3), np.float32), "alpha": np.ones((2, 3), np.float32)}
        aovs["depth"] = np.ones((2, 3), np.float32)
        stats = {"rays": np.int64(6), "error": 0.008, "halving": 2.5}
        metadata = {"scratchwarp:spp": 16}
        return SimpleNamespace(
            aovs=aovs, metadata=metadata, crop=None, full_size=(3, 2), stats=stats, warnings=("dim",)
        )


@pytest.fixture
def renderer(monkeypatch):
    fake = Renderer()
    for name in ("read", "make_plan", "render"):
        monkeypatch.setattr(sw, name, getattr(fake, name))
    priced = SimpleNamespace(record=lambda: {"trace": 1.0}, text=lambda stats: "trace 1 s", seconds=1.0)
    monkeypatch.setattr(cost, "forecast", lambda scene, plan: priced)
    return fake
