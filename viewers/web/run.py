"""serve: from a stage to an address that shows it."""

import webbrowser
from pathlib import Path
from typing import Any

from scratchwarp.pipeline import read_live
from scratchwarp.scene import Settings

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
        reading: frame, camera, session_layer, max_memory and so on, as ``scratchwarp.read`` has them.

    Raises OSError where the address cannot be had, ValueError when the stage is at fault.
    """
    live = read_live(stage_path, **reading)
    target = Path(save) if save else Path(stage_path).with_suffix(".look.usda")
    with Looking(live, Settings(width=width, spp=spp)) as looking, WebView(looking, target, host, port) as server:

        def tell() -> None:
            print(f"open  {server.guard.link()}", flush=True)

        server.entered = tell
        link = server.guard.link()
        print(f"open  {link}\n(each link opens the viewer in one browser; Ctrl+C ends it)", flush=True)
        if browse:
            webbrowser.open(link)
        shown = looking.shown
        while True:  # until interrupted, or until the thread that refines the image fails
            shown = looking.wait(shown.version, 1.0)
