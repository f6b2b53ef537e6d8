"""serve: from a stage to an address that shows it."""

import threading
import webbrowser
from pathlib import Path
from typing import Any

from scratchwarp.image import read_texture
from scratchwarp.scene import Settings
from scratchwarp.stage import LiveStage

from ..looking import Looking
from .server import WebView


def serve(
    stage_path: Path | str,
    *,
    host: str = "127.0.0.1",
    port: int = 0,
    save: Path | str | None = None,
    width: int = 480,
    spp: int | None = None,
    browse: bool = False,
    **reading: Any,
) -> None:
    """Show a stage in browsers until interrupted; a link that opens it once is printed, another one after each use.

    Args:
        host, port: address to bind; port 0 is any that is free.
        save: the file that edits are saved to [beside the stage, ``<name>.look.usda``].
        width, spp: of the image; spp None is the stage's, else 16.
        browse: open the link in this machine's browser.
        reading: keywords of ``scratchwarp.read``.

    Raises OSError where the address cannot be had, ValueError when the stage is at fault.
    """
    live = LiveStage(stage_path, load_texture=read_texture, **reading)
    target = Path(save) if save else Path(stage_path).with_suffix(".look.usda")
    with Looking(live, Settings(width=width, spp=spp)) as looking, WebView(looking, target, host, port) as server:

        def tell() -> None:
            print(f"open  {server.guard.link()}", flush=True)

        server.entered = tell
        link = server.guard.link()
        print(f"open  {link}\n(each link opens the viewer in one browser; Ctrl+C ends it)", flush=True)
        if browse:
            webbrowser.open(link)
        thread = threading.Thread(target=server.serve_forever, args=(0.2,), name="web", daemon=True)
        thread.start()
        try:
            shown = looking.shown
            while True:  # until interrupted, or until the thread that refines the image fails
                shown = looking.wait(shown.version, 1.0)
        finally:
            server.shutdown()
