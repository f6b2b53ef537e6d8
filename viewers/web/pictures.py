"""The pictures that browsers fetch, as PNG: the stage now, as it was, and in 3D."""

import threading

from scratchwarp.image.quick import png

from .. import preview
from ..looking import Looking, Shown
from .guard import Refused


class Pictures:
    """Pictures of one stage for any number of browsers, each made once.

    Attributes: kept: version of the picture to compare with, 0 before there is one.
    """

    def __init__(self, looking: Looking) -> None:
        self.looking, self.kept = looking, 0
        self._lock = threading.Lock()
        self._now: tuple[int, bytes] = (-1, b"")
        self._before = b""
        self._preview = preview.Preview()

    def now(self) -> bytes:
        """The stage as it is."""
        return self._encoded(self.looking.shown)

    def before(self) -> bytes:
        """What to compare with: the first picture that was finished, or the one that was kept; Refused without."""
        shown = self.looking.shown
        if not self.kept and shown.finished:
            self._before, self.kept = self._encoded(shown), shown.picture
        if not self.kept:
            raise Refused(404, "no picture is finished yet")
        return self._before

    def keep(self) -> None:
        """Compare with the picture that there is from now on."""
        shown = self.looking.shown
        self._before, self.kept = self._encoded(shown), shown.picture

    def solid(self) -> bytes:
        """The 3D view; Refused where nothing can draw it."""
        scene, size = self.looking.shown.scene, self.looking.shown.size
        if scene is None:
            raise Refused(404, "the stage is not read yet")
        try:
            return png(self._preview.picture(scene, size))
        except (ImportError, OSError) as error:
            raise Refused(404, str(error)) from None

    def close(self) -> None:
        """Close the 3D view."""
        self._preview.close()

    def _encoded(self, shown: Shown) -> bytes:
        with self._lock:
            if self._now[0] != shown.picture:
                self._now = (shown.picture, png(shown.pixels))
            return self._now[1]
