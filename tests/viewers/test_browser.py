"""The viewer in headless Chromium: a depth slider is dragged and the picture changes, and so on through the page."""

import shutil
import time

import pytest

from scratchwarp.stage import LiveStage

from .look_stage import DEPTH, METAL

playwright = pytest.importorskip("playwright.sync_api")
WebView = pytest.importorskip("scratchwarp.viewers.web.server").WebView
CHROMIUM = next(
    (path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), None
)
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="no Chromium on this machine")


@pytest.fixture(scope="module")
def chromium():
    with playwright.sync_playwright() as started:
        browser = started.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield browser
        browser.close()


@pytest.fixture
def page(server, chromium):
    """The page in a browser of its own; its console must say no error, and all it asks for be here."""
    server.looking.reset()
    opened = chromium.new_context(viewport={"width": 1200, "height": 800}).new_page()
    said = []
    opened.on("console", lambda message: message.type in ("error", "warning") and said.append(message.text))
    opened.on("pageerror", lambda error: said.append(str(error)))
    here = tuple(f"{kind}://127.0.0.1:{server.address[1]}/" for kind in ("http", "ws"))
    opened.on("request", lambda asked: asked.url.startswith((*here, "data:")) or said.append(asked.url))
    failed = ("net::ERR_ABORTED", None)  # a picture that another one overtook
    opened.on("requestfailed", lambda asked: asked.failure in failed or said.append(f"{asked.url}: {asked.failure}"))
    opened.goto(server.guard.link())
    opened.wait_for_selector("#look")
    yield opened
    assert said == []
    opened.context.close()


def until(page, expression, argument=None, seconds=60):
    """Wait until a function of the page returns something true; the page's policy allows no evaluation inside it."""
    end = time.monotonic() + seconds
    while not (found := page.evaluate(expression, argument)):
        assert time.monotonic() < end, expression
        time.sleep(0.02)
    return found


def finished(page):
    until(page, "() => /^(\\d+) of \\1 /.test(document.getElementById('samples').textContent)")


def picture(page):
    return page.get_attribute("#after", "data-picture")


def drag(page, locator, start, end):
    box = locator.bounding_box()
    at = box["y"] + box["height"] * 0.5
    page.mouse.move(box["x"] + start * box["width"], at)
    page.mouse.down()
    page.mouse.move(box["x"] + end * box["width"], at, steps=6)
    page.mouse.up()


def depth_in(server):
    return next(c.value for c in server.looking.shown.controls if c.id == DEPTH)


def test_dragging_the_depth_slider_changes_the_picture(server, page):
    """The picture, the number beside the slider, the stage; reload and a second browser show the same."""
    finished(page)
    pixels, before = server.looking.shown.pixels, picture(page)
    row = page.locator(f'.control[data-id="{DEPTH}"]')
    assert "µm" in row.inner_text() and "Mean depth" in row.locator(".label").get_attribute("title")
    slider = row.locator("input[type=range]")
    drag(page, slider, 0.2, 0.4)
    until(page, "before => document.getElementById('after').dataset.picture != before", before)
    finished(page)
    shown = server.looking.finished(60)
    assert shown.pixels.shape != pixels.shape or (shown.pixels != pixels).any()
    assert depth_in(server) > 8.0
    until(page, f"() => document.querySelector('[data-id=\"{DEPTH}\"] input[type=number]').value != '4'")
    number = float(row.locator("input[type=number]").input_value())
    assert number == pytest.approx(depth_in(server), rel=1e-3)
    page.reload()
    page.wait_for_selector("#look")
    assert float(row.locator("input[type=number]").input_value()) == pytest.approx(number)
    second = page.context.browser.new_context().new_page()
    second.goto(server.guard.link())
    second.wait_for_selector("#look")
    beside = second.locator(f'.control[data-id="{DEPTH}"] input[type=number]')
    assert float(beside.input_value()) == pytest.approx(number)
    beside.fill("3")
    beside.press("Enter")
    until(page, f"() => document.querySelector('[data-id=\"{DEPTH}\"] input[type=number]').value == '3'")
    second.context.close()


def test_every_fold_of_the_panel_opens(page):
    """Controls of every kind are made without an error on the console."""
    names = page.evaluate("() => [...document.querySelectorAll('details')].map((fold) => fold.dataset.owner)")
    page.evaluate("() => document.querySelectorAll('details').forEach((fold) => { fold.open = true; })")
    assert "/settings" in names and f"{METAL}/cut" in names and "/World/lamp" in names
    until(page, "() => document.querySelectorAll('.control').length > 100")
    assert page.locator(".control .label").first.get_attribute("title")


def test_what_a_stage_says_is_text(server, page):
    """Nothing of it is taken for a template or for HTML, which the page would run."""
    name = f"{METAL}.scratch:layer:fine:maskPrimvar"
    for odd in ("{{ 7 * 7 }}", "<img src=x onerror='throw 1'>"):
        box = page.locator(f'.control[data-id="{name}"] input')
        box.fill(odd)
        box.press("Enter")
        end = time.monotonic() + 60
        while odd not in [c.value for c in server.looking.shown.controls]:
            assert time.monotonic() < end
            time.sleep(0.02)
        page.reload()
        page.wait_for_selector("#look")
        assert box.input_value() == odd and page.locator("#panel img").count() == 0


def test_layers_are_switched_and_reordered(server, page):
    finished(page)
    before = picture(page)
    page.locator(f'input[data-enabled="{METAL}.scratch:layer:fine:enabled"]').uncheck()
    until(page, "before => document.getElementById('after').dataset.picture != before", before)
    names = (
        "() => [...document.querySelectorAll('details')].map(d => d.dataset.owner).filter(o => o.includes(' ')).join()"
    )
    assert page.evaluate(names) == f"{METAL} fine,{METAL} coarse"
    page.locator(f'details[data-owner="{METAL} fine"] button[data-step="1"]').click()
    until(page, f"() => ({names})() == '{METAL} coarse,{METAL} fine'")
    server.looking.finished(60)
    scene = server.looking.do(lambda live, session: live.scene)
    assert [layer.name for m in scene.materials for layer in m.layers] == ["coarse"]
    page.locator(f'input[data-enabled="{METAL}.scratch:layer:fine:enabled"]').check()
    finished(page)
    scene = server.looking.do(lambda live, session: live.scene)
    assert [layer.name for m in scene.materials for layer in m.layers] == ["coarse", "fine"]


def test_the_3d_view_lies_over_the_picture_while_the_camera_is_dragged(page):
    finished(page)
    until(page, "() => document.getElementById('preview')?.hidden")
    box = page.locator("#picture").bounding_box()
    page.mouse.move(box["x"] + 100, box["y"] + 100)
    page.mouse.down()
    first = page.get_attribute("#preview", "src")
    for step in range(600):  # until the view from elsewhere is there
        page.mouse.move(box["x"] + 102 + step % 80, box["y"] + 100)
        time.sleep(0.02)
        if page.locator("#preview").is_visible() and page.get_attribute("#preview", "src") != first:
            break
    else:
        raise AssertionError("the 3D view was not seen")
    assert page.evaluate("() => document.getElementById('preview').naturalWidth") == 64
    # the drag rests: the picture, once it is there, is seen though the button is held
    until(page, "() => document.getElementById('preview').hidden")
    page.mouse.up()
    finished(page)
    assert page.locator("#preview").is_hidden()


def test_camera_light_pixel_before_and_save(server, page, tmp_path_factory):
    finished(page)
    eye = server.looking.do(lambda live, session: live.scene.camera.transform)
    drag(page, page.locator("#picture"), 0.3, 0.5)
    until(page, "() => document.getElementById('redone').textContent.includes('film')")
    assert (server.looking.do(lambda live, session: live.scene.camera.transform) != eye).any()
    page.select_option("#mode", "/World/lamp")
    lamp = server.looking.do(lambda live, session: live.matrix("/World/lamp"))
    drag(page, page.locator("#picture"), 0.3, 0.5)
    finished(page)
    until(page, "() => true")
    assert (server.looking.do(lambda live, session: live.matrix("/World/lamp")) != lamp).any()
    page.select_option("#mode", "pick")
    page.locator("#picture").click()
    page.wait_for_selector("#pixel:not([hidden])")
    said = page.locator("#pixel").inner_text()
    assert all(word in said for word in ("/World/ball", "footprint", "fine", "coarse", "scratches.worley"))
    assert page.locator("#pixel svg").count() == 2
    drag(page, page.locator("#split"), 0.02, 0.5)
    assert page.locator("#before").is_visible() and page.locator("#line").is_visible()
    page.click("#save")
    until(page, "() => document.getElementById('redone').textContent.startsWith('saved')")
    values = {c.id: c.value for c in server.looking.shown.controls}
    assert {c.id: c.value for c in LiveStage(server.target).controls()} == values


def test_a_page_whose_server_ended_says_so(server, chromium, tmp_path):
    with WebView(server.looking, tmp_path / "look.usda") as other:
        left = chromium.new_context().new_page()
        left.goto(other.guard.link())
        left.wait_for_selector("#look")
    left.wait_for_selector("#gone")
    assert "does not answer" in left.inner_text("#gone")
    left.context.close()
