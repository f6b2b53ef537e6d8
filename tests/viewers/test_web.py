"""The viewer's server by plain requests: who gets in, what is served, what is refused."""

import http.client
import json
import threading
import time

import pytest

from scratchwarp.cli import main
from scratchwarp.scene import Settings
from scratchwarp.stage import LiveStage, read
from scratchwarp.viewers.looking import Looking
from scratchwarp.viewers.web.server import WebView

from .look_stage import DEPTH, METAL, STAGE


@pytest.fixture(scope="module")
def server(tmp_path_factory):
    """A server on a free port, its image finished, and the folder that its stage lies in."""
    folder = tmp_path_factory.mktemp("web")
    (folder / "ball.usda").write_text(STAGE)
    (folder / "secret.txt").write_text("secret")
    live = LiveStage(folder / "ball.usda")
    with (
        Looking(live, Settings(width=32, spp=3, threads=2)) as looking,
        WebView(looking, folder / "look.usda") as served,
    ):
        thread = threading.Thread(target=served.serve_forever, args=(0.05,), daemon=True)
        thread.start()
        looking.finished(180)
        yield served
        served.shutdown()
        thread.join()


def ask(server, method, path, body=None, **headers):
    """(status, headers, body) of one request."""
    connection = http.client.HTTPConnection("127.0.0.1", server.server_address[1], timeout=30)
    if body is not None and not isinstance(body, bytes):
        body, headers = json.dumps(body).encode(), {"Content-Type": "application/json", **headers}
    try:
        connection.request(method, path, body, {k.replace("_", "-"): v for k, v in headers.items()})
        answer = connection.getresponse()
        return answer.status, answer.headers, answer.read()
    finally:
        connection.close()


@pytest.fixture(scope="module")
def browser(server):
    """``browser(method, path, body)`` with the cookie of one that came in by a link."""
    cookie = enter(server)
    return lambda method, path, body=None, **headers: ask(server, method, path, body, Cookie=cookie, **headers)


def enter(server):
    status, headers, _ = ask(server, "GET", server.guard.link().split(str(server.server_address[1]))[1])
    assert status == 303 and headers["Location"] == "/"
    assert "HttpOnly" in headers["Set-Cookie"] and "SameSite=Strict" in headers["Set-Cookie"]
    return headers["Set-Cookie"].split(";")[0]


def finished(server, browser, edits=None):
    """The state once the image is finished."""
    for _ in range(600):
        state = json.loads(browser("GET", "/state")[2])
        if state["samples"] == state["spp"] and (edits is None or state["edits"] > edits):
            return state
        time.sleep(0.1)
    raise AssertionError("the image was not finished")


def test_it_listens_on_this_machine_alone(server):
    assert server.server_address[0] == "127.0.0.1" and server.guard.link().startswith("http://127.0.0.1:")


def test_a_link_opens_once_and_the_cookie_stays(server, browser):
    path = "/?token=" + server.guard.link().split("=")[1]
    assert ask(server, "GET", path)[0] == 303
    status, _, said = ask(server, "GET", path)
    assert status == 403 and b"used" in said
    for _ in range(2):  # a reload
        assert browser("GET", "/")[0] == 200
    assert ask(server, "GET", "/", Cookie=enter(server))[0] == 200  # another browser, by another link
    link = json.loads(browser("POST", "/link", {})[2])["link"]
    assert ask(server, "GET", "/" + link.rsplit("/", 1)[1])[0] == 303


@pytest.mark.parametrize("path", ["/", "/app.js", "/state", "/picture", "/changes", "/before", "/?token=", "/?token=x"])
@pytest.mark.parametrize("cookie", ["", "scratchwarp=x", "\x80", "a=b; ;;="])
def test_nobody_gets_in_without(server, path, cookie):
    status, _, said = ask(server, "GET", path, Cookie=cookie)
    assert status == 403 and b"link" in said


def test_only_the_page_s_own_files_are_served(server, browser):
    for path, kind in (
        ("/", "text/html"),
        ("/app.js", "text/javascript"),
        ("/panel.js", "text"),
        ("/style.css", "text/css"),
    ):
        status, headers, content = browser("GET", path)
        assert status == 200 and headers["Content-Type"].startswith(kind) and content
        assert "default-src 'self'" in headers["Content-Security-Policy"]
        assert headers["X-Content-Type-Options"] == "nosniff"


@pytest.mark.parametrize(
    "path",
    [
        "/secret.txt", "/../secret.txt", "/..%2fsecret.txt", "/%2e%2e/secret.txt", "/ball.usda", "//etc/passwd",
        "/etc/passwd", "/app.js/", "/app.js%00", "/page/app.js", "/server.py", "/./app.js", "/APP.JS", "/app.js;x",
        "/\\..\\secret.txt", "/picture/../state", "file:///etc/passwd", "http://example.org/", "*",
    ],
)  # fmt: skip
def test_odd_paths_find_nothing(browser, path):
    status, _, said = browser("GET", path)
    assert status in (403, 404) and b"secret" not in said and b"root:" not in said


@pytest.mark.parametrize(
    ("path", "status"),
    [
        ("/" + "a" * 3000, 414),
        ("/changes?after=x", 400),
        ("/changes?after=" + "9" * 100, 400),
        ("/changes?" + "&".join(f"a{i}=1" for i in range(50)), 400),
    ],
)
def test_odd_questions_are_refused(browser, path, status):
    assert browser("GET", path)[0] == status


@pytest.mark.parametrize("method", ["PUT", "DELETE", "HEAD", "OPTIONS", "TRACE"])
def test_other_methods_are_refused(browser, method):
    assert browser(method, "/")[0] == 501


def test_huge_and_senseless_bodies_are_refused(server, browser):
    """A body is not read before its length is known to be small."""
    assert browser("POST", "/edit", b"x", Content_Type="application/json", Content_Length=str(10**12))[0] == 413
    assert browser("POST", "/edit", b"x" * (1 << 19), Content_Type="application/json")[0] == 413
    assert browser("POST", "/edit", b"{}", Content_Type="text/plain")[0] == 415
    for length in ("-1", "1e3", "0x10", "\xb2"):
        assert browser("POST", "/edit", b"{}", Content_Type="application/json", Content_Length=length)[0] == 411
    assert browser("POST", "/edit", b"", Content_Type="application/json", Transfer_Encoding="chunked")[0] == 411
    for body in (b"", b"{", b"[" * 100000, b"\xff\xfe", b"[1]", b"null", b'{"values": 3}', b'{"values": {"x": 1}}'):
        assert browser("POST", "/edit", body, Content_Type="application/json")[0] == 400
    assert browser("POST", "/nothing", {})[0] == 404
    assert browser("GET", "/state")[0] == 200


@pytest.mark.parametrize(
    ("path", "body"),
    [
        ("/edit", {"values": {DEPTH: -1}}),
        ("/edit", {"values": {DEPTH: "deep"}}),
        ("/edit", {"values": {f"{METAL}.scratch:layer:fine:maskTexture": "/etc/passwd"}}),
        ("/edit", {"values": {"/World/ball.radius": 2}}),
        ("/move", {"prim": "/World/ball"}),
        ("/move", {"prim": ["x"]}),
        ("/move", {"prim": "", "right": "x"}),
        ("/move", {"prim": "", "right": 1e300}),
        ("/move", {"prim": "", "sideways": 1}),
        ("/pick", {"x": 1.0, "y": 0.5}),
        ("/pick", {"x": True, "y": 0.5}),
        ("/pick", {}),
    ],
)
def test_senseless_wishes_are_refused_with_a_sentence(server, browser, path, body):
    before = server.looking.shown.edits
    status, _, said = browser("POST", path, body)
    assert status == 400 and said and server.looking.shown.edits == before


def test_other_sites_are_refused(server, browser):
    """Neither a name that was pointed here nor a page of another origin."""
    port = server.server_address[1]
    assert browser("GET", "/state", Host=f"evil.example:{port}")[0] == 403
    assert browser("GET", "/state", Host="127.0.0.1")[0] == 403
    assert browser("POST", "/edit", {"values": {}}, Origin="http://evil.example")[0] == 403
    assert browser("POST", "/edit", {"values": {}}, Origin=f"http://127.0.0.1:{port}")[0] == 200
    assert browser("GET", "/state", Host=f"localhost:{port}")[0] == 200


def test_controls_say_what_the_schema_says(browser):
    state = json.loads(browser("GET", "/state")[2])
    depth = next(c for c in state["controls"] if c["id"] == DEPTH)
    assert depth["units"] == "micrometer" and depth["value"] == 4.0 and depth["kind"] == "number"
    assert "Mean depth" in depth["documentation"] and depth["least"] == 0.0 and depth["high"] == 500.0


def test_two_browsers_see_an_edit_and_the_saved_layer_has_it(server, browser):
    other = enter(server)
    first = finished(server, browser)
    picture = browser("GET", "/picture")[2]
    assert picture.startswith(b"\x89PNG") and browser("GET", "/before")[2] == picture
    answers = []
    path = f"/changes?after={first['version']}&edits={first['edits']}"
    waiting = threading.Thread(target=lambda: answers.append(ask(server, "GET", path, Cookie=other)))
    waiting.start()
    assert browser("POST", "/edit", {"values": {DEPTH: 9.0}})[0] == 200
    waiting.join(30)
    told = json.loads(answers[0][2])
    assert told["version"] > first["version"] and ("values" not in told or told["values"][DEPTH] == 9.0)
    after = finished(server, browser, first["edits"])
    assert next(c["value"] for c in after["controls"] if c["id"] == DEPTH) == 9.0
    assert browser("GET", "/picture")[2] != picture and browser("GET", "/before")[2] == picture
    assert browser("POST", "/before", {})[0] == 200 and browser("GET", "/before")[2] != picture
    assert json.loads(browser("POST", "/save", {})[2]) == {"saved": str(server.target)}
    again = read(server.target)
    assert [one.depth for m in again.materials for one in m.layers if one.name == "fine"] == [9.0]
    assert browser("POST", "/reset", {})[0] == 200
    back = finished(server, browser, after["edits"])
    assert next(c["value"] for c in back["controls"] if c["id"] == DEPTH) == 4.0
    assert browser("GET", "/picture")[2] == picture


def test_a_pixel_is_explained(browser):
    report = json.loads(browser("POST", "/pick", {"x": 0.5, "y": 0.5})[2])
    assert report["prim"] == "/World/ball" and [one["name"] for one in report["layers"]] == ["fine", "coarse"]
    assert len(report["layers"][0]["lobe"]) == len(report["layers"][0]["angles"]) > 0
    assert report["footprint"][0] > 0 and {"scratches.worley"} <= {name for name, _ in report["effects"]}
    sky = json.loads(browser("POST", "/pick", {"x": 0.0, "y": 0.0})[2])
    assert sky["prim"] == "" and sky["distance"] is None


def test_the_3d_view_is_drawn_where_pyvista_is(server, browser, monkeypatch):
    pytest.importorskip("pyvista")
    monkeypatch.delenv("DISPLAY", raising=False)
    status, headers, content = browser("GET", "/preview")
    assert status == 200 and headers["Content-Type"] == "image/png" and len(content) > 200
    monkeypatch.setattr(server._preview, "picture", lambda *_: (_ for _ in ()).throw(ImportError("no pyvista")))
    assert browser("GET", "/preview")[0] == 404


def test_a_camera_that_is_moved_shows_another_picture(server, browser):
    first = finished(server, browser)
    picture = browser("GET", "/picture")[2]
    for prim in ("", "/World/lamp"):
        assert browser("POST", "/move", {"prim": prim, "right": 0.3, "up": 0.1})[0] == 200
    after = finished(server, browser, first["edits"])
    assert not after["message"] and browser("GET", "/picture")[2] != picture
    browser("POST", "/reset", {})


def test_the_command_line_hands_on_what_it_is_given(monkeypatch, capsys):
    from scratchwarp import viewers

    calls = []
    monkeypatch.setattr(viewers, "view_web", lambda *args, **options: calls.append((*args, options)))
    argv = ["view", "a.usda", "--web", "--port", "8000", "--save", "b.usda", "-w", "100", "--spp", "2"]
    assert main(argv) == 0
    given = {"browse": False, "frame": None, "camera": None, "port": 8000, "save": "b.usda", "width": 100, "spp": 2}
    assert calls == [("a.usda", given)]
    for wrong in (["--port", "1"], ["--web", "--screenshot", "a.png"], ["--web", "--profile"]):
        assert main(["view", "a.usda", *wrong]) == 2
