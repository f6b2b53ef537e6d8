"""Milliseconds from a step of a depth slider in Chromium to the picture that shows it. Run by hand on an idle machine:

    python tests/benchmarks/web.py [STAGE] [--width 480] [--steps 12] [--screenshot page.png]

Without STAGE: the demo ball. The first slider of the panel that is called Depth is dragged step by step; each step
waits until another picture has been loaded. It must be within half a second in the median, and the console must say no
error.
"""

import argparse
import os
import shutil
import tempfile
import time
from pathlib import Path

import numpy as np
import warp as wp
from playwright.sync_api import sync_playwright

from scratchwarp.image import read_texture
from scratchwarp.pipelines.author_demo import author
from scratchwarp.scene import Settings
from scratchwarp.stage import LiveStage
from scratchwarp.viewers.looking import Looking
from scratchwarp.viewers.web.server import WebView

BAR = 0.5
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("stage", nargs="?")
    parser.add_argument("--width", type=int, default=480)
    parser.add_argument("--steps", type=int, default=12)
    parser.add_argument("--screenshot")
    args = parser.parse_args()
    wp.config.log_level = wp.LOG_ERROR
    folder = tempfile.mkdtemp()
    stage = args.stage or author(folder, names=["ball"])[0]
    print(f"{os.cpu_count()} processors, load {os.getloadavg()[0]:.1f}")
    seconds, said = [], []
    with (
        Looking(LiveStage(stage, load_texture=read_texture), Settings(width=args.width, spp=4)) as looking,
        WebView(looking, Path(folder, "look.usda")) as server,
        sync_playwright() as started,
    ):
        looking.finished(300)
        browser = started.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        page = browser.new_context(viewport={"width": 1280, "height": 800}).new_page()
        page.on("console", lambda message: message.type in ("error", "warning") and said.append(message.text))
        page.on("pageerror", lambda error: said.append(str(error)))
        page.goto(server.guard.link())
        page.wait_for_selector("#look")
        page.evaluate("() => document.querySelectorAll('details').forEach((fold) => { fold.open = true; })")
        page.wait_for_selector(".control")
        row = page.locator(".control", has=page.locator(".label", has_text="Depth")).first
        slider = row.locator("input[type=range]")
        slider.scroll_into_view_if_needed()
        box = slider.bounding_box()
        assert box is not None
        page.mouse.move(box["x"] + 0.2 * box["width"], box["y"] + 0.5 * box["height"])
        page.mouse.down()
        for step in range(1, args.steps + 1):
            before = page.get_attribute("#after", "data-picture")
            start = time.perf_counter()
            page.mouse.move(box["x"] + (0.2 + 0.02 * step) * box["width"], box["y"] + 0.5 * box["height"])
            while page.get_attribute("#after", "data-picture") == before:
                time.sleep(0.002)
            seconds.append(time.perf_counter() - start)
        page.mouse.up()
        looking.finished(300)
        time.sleep(0.5)
        if args.screenshot:
            page.screenshot(path=args.screenshot)
        browser.close()
    median = float(np.median(seconds))
    first, worst = 1e3 * seconds[0], 1e3 * max(seconds[1:])
    print(f"a step to another picture: median {1e3 * median:.0f} ms, first {first:.0f} ms, then at most {worst:.0f} ms")
    print(f"the console said {said or 'nothing'}")
    return int(median > BAR or bool(said))


if __name__ == "__main__":
    raise SystemExit(main())
