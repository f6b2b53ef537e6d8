"""The viewer's server by plain requests and messages: who gets in, what is served, what is refused."""

import http.client

import pytest

from scratchwarp.cli import main
from scratchwarp.stage import read

from .look_stage import DEPTH, METAL
from .socket_client import Closed, messages, talk


def ask(server, method, path, body=None, **headers):
    """(status, headers, body) of one request."""
    connection = http.client.HTTPConnection("127.0.0.1", server.address[1], timeout=30)
    try:
        connection.request(method, path, body, {k.replace("_", "-"): v for k, v in headers.items()})
        answer = connection.getresponse()
        return answer.status, answer.headers, answer.read()
    finally:
        connection.close()


def enter(server):
    """The cookie of a browser that came in by a link."""
    status, headers, _ = ask(server, "GET", server.guard.link().split(str(server.address[1]))[1])
    assert status == 303 and headers["Location"].startswith("/?") and "token" not in headers["Location"]
    assert "HttpOnly" in headers["Set-Cookie"] and "SameSite=Strict" in headers["Set-Cookie"]
    return headers["Set-Cookie"].split(";")[0]


@pytest.fixture(scope="module")
def browser(server):
    """``browser(method, path, body)`` with the cookie of one that came in."""
    cookie = enter(server)
    return lambda method, path, body=None, **headers: ask(
        server, method, path, body, **({"Cookie": cookie} | headers)
    )


@pytest.fixture(scope="module")
def wish(server):
    """``wish(name, body)``: what comes of it, over a socket as the page opens it."""
    cookie = enter(server)

    def ask_for(name, body, *more):
        (answer,) = talk(server, cookie, [("trame.trigger", [name, [body, *more], {}])])
        return answer["result"]

    return ask_for


def test_it_listens_on_this_machine_alone(server):
    assert server.address[0] == "127.0.0.1" and server.guard.link().startswith("http://127.0.0.1:")


def test_an_address_that_cannot_be_had_is_an_error(server):
    from scratchwarp.viewers.web.server import WebView

    with pytest.raises(OSError):
        WebView(server.looking, server.target, port=server.address[1])


def test_a_link_opens_once_and_the_cookie_stays(server, browser, wish):
    path = "/?token=" + server.guard.link().split("=")[1]
    assert ask(server, "GET", path)[0] == 303
    status, _, said = ask(server, "GET", path)
    assert status == 403 and b"used" in said
    for _ in range(2):  # a reload
        assert browser("GET", "/")[0] == browser("GET", "/?reconnect=auto")[0] == 200
    assert ask(server, "GET", "/", Cookie=enter(server))[0] == 200  # another browser, by another link
    link = wish("link", {})["link"]
    assert ask(server, "GET", "/" + link.rsplit("/", 1)[1])[0] == 303


@pytest.mark.parametrize(
    "path", ["/", "/look.js", "/trame.js", "/picture", "/before", "/preview", "/ws", "/?token=", "/?token=x", "/no"]
)
@pytest.mark.parametrize("cookie", ["", "scratchwarp=x", "\x80", "a=b; ;;=", "{name}=", "{name}=\x80"])
def test_nobody_gets_in_without(server, path, cookie):
    status, _, said = ask(server, "GET", path, Cookie=cookie.format(name=server.guard.cookie))
    assert status == 403 and b"link" in said
    assert ask(server, "POST", "/session", b"{}", Cookie=cookie.format(name=server.guard.cookie))[0] == 403


def test_only_the_page_s_own_files_are_served(browser):
    for path, kind in (("/", "text/html"), ("/look.js", "text/javascript"), ("/vue.js", "text/javascript"),
                       ("/trame.js", "text/javascript"), ("/style.css", "text/css")):  # fmt: skip
        status, headers, content = browser("GET", path)
        assert status == 200 and headers["Content-Type"].startswith(kind) and content
        assert "default-src 'self'" in headers["Content-Security-Policy"]
        assert headers["X-Content-Type-Options"] == "nosniff" and headers["Server"] == "scratchwarp"


def test_the_page_names_no_other_place():
    """Nothing is fetched from elsewhere: the page works without a network."""
    from scratchwarp.viewers.web.gate import files

    served = {path: content.decode() for path, (content, _) in files().items() if path not in ("/vue.js", "/trame.js")}
    assert len(served) >= 8
    for path, content in served.items():
        named = content.replace("http://www.w3.org/2000/svg", "")
        assert "http://" not in named and "https://" not in named and "@import" not in named, path
    assert "<script>" not in served["/"]


@pytest.mark.parametrize(
    "path",
    [
        "/secret.txt", "/../secret.txt", "/..%2fsecret.txt", "/%2e%2e/secret.txt", "/ball.usda", "//etc/passwd",
        "/etc/passwd", "/look.js/", "/look.js%00", "/page/look.js", "/server.py", "/./look.js", "/LOOK.JS",
        "/look.js;x", "/\\..\\secret.txt", "/picture/../before", "file:///etc/passwd", "http://example.org/", "*",
        "/index.html", "/vue.global.js", "/assets/", "/__trame_client_external_scripts/", "/paraview/", "//", "/%2e/",
        "/ws/",
    ],
)  # fmt: skip
def test_odd_paths_find_nothing(browser, path):
    status, _, said = browser("GET", path)
    assert status in (400, 403, 404) and b"secret" not in said and b"root:" not in said


def test_long_paths_are_refused(browser):
    assert browser("GET", "/" + "a" * 3000)[0] == 414
    assert browser("GET", "/" + "a" * 30000)[0] == 400


@pytest.mark.parametrize("method", ["PUT", "DELETE", "HEAD", "OPTIONS", "TRACE", "POST", "BREW"])
def test_other_methods_are_refused(browser, method):
    for path in ("/", "/ws", *(() if method == "POST" else ("/session",))):
        assert browser(method, path)[0] in (400, 405)


def test_huge_bodies_are_refused(browser):
    """A body is not read before its length is known to be small."""
    for method, path in (("POST", "/session"), ("GET", "/"), ("GET", "/ws")):
        assert browser(method, path, b"x", Content_Length=str(10**12))[0] == 413
        assert browser(method, path, b"x" * (1 << 19))[0] == 413
        assert browser(method, path, b"", Transfer_Encoding="chunked")[0] == 411
        for length in ("-1", "1e3", "0x10", "\xb2"):
            assert browser(method, path, b"{}", Content_Length=length)[0] in (400, 411)
    assert browser("POST", "/session", b"{}")[0] == 200


def test_the_socket_wants_cookie_secret_and_its_own_page(server):
    """Neither another site nor whoever knows trame's usual secret gets an answer."""
    cookie, asked = enter(server), [("trame.state.get", [])]
    assert talk(server, cookie, asked)[0]["result"]["state"]["look"]["spp"] == 3
    for wrong in ({"cookie": ""}, {"origin": "http://evil.example"}, {"host": f"evil.example:{server.address[1]}"}):
        with pytest.raises(Closed, match="403"):
            talk(server, asked=asked, **({"cookie": cookie} | wrong))
    for secret in ("wslink-secret", "", None, 3):
        with pytest.raises(Closed, match="hello"):
            talk(server, cookie, asked, secret=secret)


def test_what_cannot_be_read_closes_the_socket_and_nothing_else(server):
    cookie = enter(server)
    (odd,) = messages({"id": "rpc:c0:0", "method": {4: 3}})
    huge = b"\1\0\0\0" + b"\0" * 4 + b"\xff\xff\xff\x7f" + b"x"  # says that two gigabytes follow
    for message in ("text", odd, b"", b"x", b"\xff" * 40, huge, b"x" * (1 << 19)):
        with pytest.raises(Closed):
            talk(server, cookie, [("trame.state.get", [])], raw=[message])
    begun = [n.to_bytes(4, "little") + b"\0" * 4 + (1 << 17).to_bytes(4, "little") + b"x" for n in range(20)]
    with pytest.raises(Closed):
        talk(server, cookie, [("trame.state.get", [])], raw=begun)
    assert talk(server, cookie, [("trame.state.get", [])])[0]["result"]["name"]


def test_a_browser_changes_the_state_by_wishes_alone(server):
    """What trame lets its clients do else is taken and does nothing, or is unknown."""
    changes = [{"key": "trame__template_main", "value": "<b>x</b>"}, {"key": "values", "value": {}}]
    told = talk(
        server,
        enter(server),
        [
            ("trame.state.update", [changes]), ("trame.lifecycle.update", ["server_bind"]),
            ("trame.error.client", ["x"]), ("trame.force.push", ["values"]), ("application.exit", []),
            ("application.exit.later", [1]), ("trame.trigger", ["nothing", [{}], {}]), ("trame.state.get", []),
        ],
    )  # fmt: skip
    assert ["error" in one for one in told] == [False, False, False, True, True, True, False, False]
    state = told[-1]["result"]["state"]
    assert "scratch-look" in state["trame__template_main"] and state["values"][DEPTH] == 4.0


@pytest.mark.parametrize(
    ("name", "body"),
    [
        ("edit", {"values": {DEPTH: -1}}),
        ("edit", {"values": {DEPTH: "deep"}}),
        ("edit", {"values": {DEPTH: float("nan")}}),
        ("edit", {"values": {f"{METAL}.scratch:layer:fine:maskTexture": "/etc/passwd"}}),
        ("edit", {"values": {"/World/ball.radius": 2}}),
        ("edit", {"values": 3}),
        ("edit", {}),
        ("edit", [1]),
        ("edit", None),
        ("move", {"prim": "/World/ball"}),
        ("move", {"prim": ["x"]}),
        ("move", {"prim": "", "right": "x"}),
        ("move", {"prim": "", "right": 1e300}),
        ("move", {"prim": "", "sideways": 1}),
        ("pick", {"x": 1.0, "y": 0.5}),
        ("pick", {"x": True, "y": 0.5}),
        ("pick", {}),
    ],
)
def test_senseless_wishes_are_refused_with_a_sentence(server, wish, name, body):
    before = server.looking.shown.edits
    assert wish(name, body)["error"] and server.looking.shown.edits == before
    assert wish(name, body, 2)["error"]


def test_other_sites_are_refused(server, browser):
    """Neither a name that was pointed here nor a page of another origin."""
    port = server.address[1]
    assert browser("GET", "/picture", Host=f"evil.example:{port}")[0] == 403
    assert browser("GET", "/picture", Host="127.0.0.1")[0] == 403
    assert browser("POST", "/session", b"{}", Origin="http://evil.example")[0] == 403
    assert browser("POST", "/session", b"{}", Origin=f"http://127.0.0.1:{port}")[0] == 200
    assert browser("GET", "/picture", Host=f"localhost:{port}")[0] == 200


def test_controls_say_what_the_schema_says(server):
    (told,) = talk(server, enter(server), [("trame.state.get", [])])
    depth = next(c for c in told["result"]["state"]["controls"] if c["id"] == DEPTH)
    assert depth["units"] == "micrometer" and depth["value"] == 4.0 and depth["kind"] == "number"
    assert "Mean depth" in depth["documentation"] and depth["least"] == 0.0 and depth["high"] == 500.0


def test_two_browsers_see_an_edit_and_the_saved_layer_has_it(server, browser, wish):
    picture = browser("GET", "/picture")[2]
    assert picture.startswith(b"\x89PNG") and browser("GET", "/before")[2] == picture
    first, cookie = server.looking.shown.edits, enter(server)
    edit = ("trame.trigger", ["edit", [{"values": {DEPTH: 9.0}}], {}])
    _, pushed = talk(server, cookie, [("trame.state.get", [])], listen=lambda state: DEPTH in state.get("values", {}),
                     meanwhile=lambda: talk(server, enter(server), [edit]))  # fmt: skip
    assert pushed["values"][DEPTH] == 9.0
    after = server.looking.finished(60)
    assert after.edits > first and next(c.value for c in after.controls if c.id == DEPTH) == 9.0
    assert browser("GET", "/picture")[2] != picture and browser("GET", "/before")[2] == picture
    assert wish("keep", {}) == {} and browser("GET", "/before")[2] != picture
    assert wish("save", {}) == {"saved": str(server.target)}
    again = read(server.target)
    assert [one.depth for m in again.materials for one in m.layers if one.name == "fine"] == [9.0]
    assert wish("reset", {}) == {}
    back = server.looking.finished(60)
    assert next(c.value for c in back.controls if c.id == DEPTH) == 4.0
    assert browser("GET", "/picture")[2] == picture


def test_a_pixel_is_explained(wish):
    report = wish("pick", {"x": 0.5, "y": 0.5})
    assert report["prim"] == "/World/ball" and [one["name"] for one in report["layers"]] == ["fine", "coarse"]
    assert len(report["layers"][0]["lobe"]) == len(report["layers"][0]["angles"]) > 0
    assert report["footprint"][0] > 0 and {"scratches.worley"} <= {name for name, _ in report["effects"]}
    sky = wish("pick", {"x": 0.0, "y": 0.0})
    assert sky["prim"] == "" and sky["distance"] is None


def test_the_3d_view_is_drawn_where_pyvista_is(server, browser, monkeypatch):
    pytest.importorskip("pyvista")
    monkeypatch.delenv("DISPLAY", raising=False)
    status, headers, content = browser("GET", "/preview")
    assert status == 200 and headers["Content-Type"] == "image/png" and len(content) > 200
    monkeypatch.setattr(
        server.pictures._preview, "picture", lambda *_: (_ for _ in ()).throw(ImportError("no pyvista"))
    )
    assert browser("GET", "/preview")[0] == 404


def test_a_camera_that_is_moved_shows_another_picture(server, browser, wish):
    first, picture = server.looking.finished(60), browser("GET", "/picture")[2]
    for prim in ("", "/World/lamp"):
        assert wish("move", {"prim": prim, "right": 0.3, "up": 0.1}) == {}
    after = server.looking.finished(60)
    assert after.edits > first.edits and not after.message and browser("GET", "/picture")[2] != picture
    wish("reset", {})
    server.looking.finished(60)


def test_the_command_line_hands_on_what_it_is_given(monkeypatch, capsys):
    from scratchwarp import viewers

    calls = []
    monkeypatch.setattr(viewers, "view_web", lambda *args, **options: calls.append((*args, options)))
    argv = ["view", "a.usda", "--web", "--port", "8000", "--save", "b.usda", "-w", "100", "--spp", "2"]
    assert main([*argv, "--max-memory", "2G"]) == 0
    given = {"browse": False, "frame": None, "camera": None, "max_memory": 2e9}
    given |= {"port": 8000, "save": "b.usda", "width": 100, "spp": 2}
    assert calls == [("a.usda", given)]
    for wrong in (["--port", "1"], ["--web", "--screenshot", "a.png"], ["--web", "--profile"]):
        assert main(["view", "a.usda", *wrong]) == 2
