"""The server: the page's own files, the picture, and edits to the stage that is looked at; nothing else is served."""

import json
import sys
import threading
from collections.abc import Callable
from functools import cached_property
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

from scratchwarp.image.quick import png

from .. import preview
from ..looking import Looking, Shown
from ..turning import Move
from . import answers
from .guard import LONGEST_PATH, Guard, Refused

_PAGE = Path(__file__).parent / "page"
_FILES = {
    "/": ("index.html", "text/html; charset=utf-8"),
    "/app.js": ("app.js", "text/javascript; charset=utf-8"),
    "/panel.js": ("panel.js", "text/javascript; charset=utf-8"),
    "/style.css": ("style.css", "text/css; charset=utf-8"),
}
_HEADERS = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": "default-src 'self'; img-src 'self' data:; frame-ancestors 'none'; base-uri 'none'",
    "Referrer-Policy": "no-referrer",
    "X-Content-Type-Options": "nosniff",
}
# Seconds that a request for changes waits for some.
PATIENCE = 15.0


class WebView(ThreadingHTTPServer):
    """A server for one stage, for any number of browsers.

    Attributes: looking: what is looked at; guard: who may; target: the file that edits are saved to.
    """

    daemon_threads = True
    request_queue_size = 32

    def __init__(self, looking: Looking, target: Path, host: str = "127.0.0.1", port: int = 0) -> None:
        """``port`` 0 is any that is free. OSError where the address cannot be had."""
        super().__init__((host, port), Handler)
        self.looking, self.target = looking, target
        self.guard = Guard(host, self.server_address[1])
        self.entered: Callable[[], None] = lambda: None
        self._lock = threading.Lock()
        self._encoded: tuple[int, bytes] = (-1, b"")
        self._before = b""
        self._preview = preview.Preview()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """A browser that went away is no error; anything else is told on stderr."""
        if not isinstance(sys.exc_info()[1], ConnectionError | TimeoutError):
            super().handle_error(request, client_address)

    @cached_property
    def files(self) -> dict[str, tuple[bytes, str]]:
        """Path -> (content, type) of the page's own files."""
        return {path: ((_PAGE / name).read_bytes(), kind) for path, (name, kind) in _FILES.items()}

    def picture(self, shown: Shown) -> bytes:
        """The picture as PNG."""
        with self._lock:
            if self._encoded[0] != shown.picture:
                self._encoded = (shown.picture, png(shown.pixels))
            return self._encoded[1]

    def preview(self) -> bytes:
        """The 3D view as PNG; Refused before there is a scene, or where nothing can draw it."""
        scene, size = self.looking.shown.scene, self.looking.shown.size
        if scene is None:
            raise Refused(404, "the stage is not read yet")
        try:
            return png(self._preview.picture(scene, size))
        except ImportError as error:
            raise Refused(404, str(error)) from None

    def server_close(self) -> None:
        """Close the socket and the 3D view."""
        super().server_close()
        self._preview.close()

    @property
    def before(self) -> bytes:
        """The picture to compare with: the first one that was finished, or the one that was kept."""
        shown = self.looking.shown
        if not self._before and shown.finished:
            self._before = self.picture(shown)
        return self._before

    def keep(self) -> None:
        """Compare with the picture that there is from now on."""
        self._before = self.picture(self.looking.shown)


class Handler(BaseHTTPRequestHandler):
    """One request."""

    server: WebView
    protocol_version = "HTTP/1.1"
    server_version = "scratchwarp"
    sys_version = ""
    timeout = 60

    def do_GET(self) -> None:
        """The page, its files, the picture, what has changed."""
        self._answered(self._get)

    def do_POST(self) -> None:
        """An edit, a move, a question about a pixel."""
        self._answered(self._post)

    def log_message(self, format: str, *args: Any) -> None:
        """Say nothing: the terminal is for links."""

    def _answered(self, answer: Callable[[str, dict[str, list[str]]], None]) -> None:
        try:
            if len(self.path) > LONGEST_PATH:
                raise Refused(414, "the path is too long")
            if not self.path.startswith("/"):
                raise Refused(404, "there is nothing here")
            parts = urlsplit(self.path)
            self.server.guard.check_host(self.headers)
            answer(parts.path, parse_qs(parts.query, max_num_fields=8))
        except Refused as refused:
            self._refuse(refused.status, refused.sentence)
        except (ValueError, OSError) as error:
            if isinstance(error, ConnectionError | TimeoutError):
                raise
            self._refuse(400, str(error)[:2000])

    def _get(self, path: str, query: dict[str, list[str]]) -> None:
        server = self.server
        if path == "/" and "token" in query:
            cookie = server.guard.enter(query["token"][0])
            self._send(303, b"", "text/plain", {"Location": "/", "Set-Cookie": cookie})
            server.entered()
            return
        server.guard.check(self.headers)
        if path in server.files:
            self._send(200, *server.files[path])
        elif path == "/state":
            shown = server.looking.shown
            told = answers.state(shown) | {
                "stage": str(server.looking.stage), "target": server.target.name, "preview": preview.available(),
                "controls": [answers.described(c) for c in shown.controls],
            }  # fmt: skip
            self._json(told)
        elif path == "/changes":
            self._changes(_whole(query, "after"), _whole(query, "edits"))
        elif path == "/picture":
            self._send(200, server.picture(server.looking.shown), "image/png")
        elif path == "/preview":
            self._send(200, server.preview(), "image/png")
        elif path == "/before":
            if not server.before:
                raise Refused(404, "no picture is finished yet")
            self._send(200, server.before, "image/png")
        else:
            raise Refused(404, "there is nothing here")

    def _changes(self, after: int, edits: int) -> None:
        shown = self.server.looking.wait(after, PATIENCE)
        told = answers.state(shown) | {"before": bool(self.server.before)}
        if shown.edits != edits:
            told["values"] = answers.values(shown)
        self._json(told)

    def _post(self, path: str, query: dict[str, list[str]]) -> None:
        size = self.server.guard.body_size(self.headers)
        self.server.guard.check(self.headers)
        try:
            body = json.loads(self.rfile.read(size).decode("utf-8"))
        except (ValueError, RecursionError):
            raise Refused(400, "the body is no JSON") from None
        if not isinstance(body, dict):
            raise Refused(400, "the body must be an object")
        action = {
            "/edit": self._edit, "/move": self._move, "/pick": self._pick, "/save": self._save, "/reset": self._reset,
            "/before": self._keep, "/link": self._link,
        }.get(path)  # fmt: skip
        if action is None:
            raise Refused(404, "there is nothing here")
        self._json(action(body))

    def _edit(self, body: dict[str, Any]) -> dict[str, Any]:
        values = body.get("values")
        if not isinstance(values, dict):
            raise Refused(400, "values must be an object")
        known = {c.id: c for c in self.server.looking.shown.controls}
        unknown = next((name for name in values if name not in known), None)
        if unknown is not None:
            raise Refused(400, f"{unknown[:200]!r} is nothing that can be turned")
        self.server.looking.edit({name: known[name].checked(value) for name, value in values.items()})
        return {}

    def _move(self, body: dict[str, Any]) -> dict[str, Any]:
        prim = body.pop("prim", "")
        lights = {c.owner for c in self.server.looking.shown.controls if c.section == "light"}
        if not isinstance(prim, str) or (prim and prim not in lights):
            raise Refused(400, f"{str(prim)[:200]!r} is no light that can be moved")
        names = set(body) - {"right", "up", "across", "along", "nearer"}
        if names:
            raise Refused(400, f"{sorted(names)[0][:50]!r} is no part of a move")
        self.server.looking.move(prim, Move(**body))
        return {}

    def _pick(self, body: dict[str, Any]) -> dict[str, Any]:
        width, height = self.server.looking.shown.size
        pixel = (int(_share(body, "x") * width), int(_share(body, "y") * height))
        return answers.pixel(self.server.looking.do(lambda live, session: session.inspect(pixel)))

    def _save(self, body: dict[str, Any]) -> dict[str, Any]:
        target = self.server.target
        self.server.looking.do(lambda live, session: live.save(target))
        return {"saved": str(target)}

    def _reset(self, body: dict[str, Any]) -> dict[str, Any]:
        self.server.looking.reset()
        return {}

    def _keep(self, body: dict[str, Any]) -> dict[str, Any]:
        self.server.keep()
        return {}

    def _link(self, body: dict[str, Any]) -> dict[str, Any]:
        return {"link": self.server.guard.link()}

    def _json(self, told: dict[str, Any]) -> None:
        self._send(200, json.dumps(told, allow_nan=False).encode(), "application/json")

    def _refuse(self, status: int, sentence: str) -> None:
        self.close_connection = True  # a body may be left unread
        self._send(status, sentence.encode(), "text/plain; charset=utf-8", {"Connection": "close"})

    def _send(self, status: int, content: bytes, kind: str, headers: dict[str, str] | None = None) -> None:
        self.send_response(status)
        sent = {"Content-Type": kind, "Content-Length": str(len(content)), **_HEADERS, **(headers or {})}
        for name, value in sent.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(content)


def _whole(query: dict[str, list[str]], name: str) -> int:
    text = query.get(name, ["-1"])[0]
    if not text.lstrip("-").isdigit() or len(text) > 12:
        raise Refused(400, f"{name} must be a whole number")
    return int(text)


def _share(body: dict[str, Any], name: str) -> float:
    value = body.get(name)
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < 1:
        raise Refused(400, f"{name} must be a share of the picture in [0, 1)")
    return float(value)
