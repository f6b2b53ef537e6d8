"""What stands before every request, and the few paths that lead anywhere."""

import json
from asyncio import to_thread
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

from aiohttp import web
from trame_client.module import vue3

from .guard import Guard, Refused
from .pictures import Pictures

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]

_PAGE, _TRAME = Path(__file__).parent / "page", Path(vue3.www)
_HTML, _SCRIPT, _STYLE = (f"text/{kind}; charset=utf-8" for kind in ("html", "javascript", "css"))
_HEADERS = {
    "Cache-Control": "no-store",
    "Content-Security-Policy": (
        # Vue, which trame's page is made with, compiles its templates in the browser: that is 'unsafe-eval'
        "default-src 'self'; script-src 'self' 'unsafe-eval'; img-src 'self' data:; frame-ancestors 'none'; "
        "base-uri 'none'; form-action 'none'; object-src 'none'; connect-src 'self'"
    ),
    "Referrer-Policy": "no-referrer",
    "Server": "scratchwarp",
    "X-Content-Type-Options": "nosniff",
}


def files() -> dict[str, tuple[bytes, str]]:
    """Path -> (content, type) of the page's own files, trame's client among them."""
    own = {"/": _PAGE / "index.html", **{f"/{p.name}": p for p in sorted(_PAGE.iterdir()) if p.name != "index.html"}}
    (script,), (style,) = (tuple(_TRAME.glob(f"assets/index-*.{kind}")) for kind in ("js", "css"))
    trame = {"/vue.js": _TRAME / "vue.global.js", "/trame.js": script, "/trame.css": style}
    kinds = {".html": _HTML, ".js": _SCRIPT, ".css": _STYLE}
    return {path: (file.read_bytes(), kinds[file.suffix]) for path, file in (own | trame).items()}


def open_paths(app: web.Application, guard: Guard, pictures: Pictures, entered: Callable[[], None]) -> None:
    """Give an application its paths, and a gate before them and before the socket that wslink put there."""
    served = files()

    async def file(request: web.Request) -> web.Response:
        content, kind = served[request.path]
        return _answer(content, kind)

    async def home(request: web.Request) -> web.Response:
        if "token" not in request.query:
            return await file(request)
        cookie = guard.enter(request.query["token"])
        entered()
        return _answer(b"", _HTML, 303, {"Location": "/?reconnect=auto", "Set-Cookie": cookie})

    async def session(request: web.Request) -> web.Response:
        """Where trame's client asks for the socket and what to say there."""
        return _answer(
            json.dumps({"sessionURL": f"ws://{request.headers['Host']}/ws", "secret": guard.secret}).encode(),
            "application/json",
        )

    def picture(made: Callable[[], bytes]) -> Handler:
        async def shown(request: web.Request) -> web.Response:
            return _answer(await to_thread(made), "image/png")

        return shown

    gets: dict[str, Any] = dict.fromkeys(served, file) | {
        "/": home, "/picture": picture(pictures.now), "/before": picture(pictures.before),
        "/preview": picture(pictures.solid),
    }  # fmt: skip
    for path, handler in gets.items():
        app.router.add_get(path, handler, allow_head=False)
    app.router.add_post("/session", session)
    methods = dict.fromkeys((*gets, "/ws"), "GET") | {"/session": "POST"}

    @web.middleware
    async def gate(request: web.Request, handler: Handler) -> web.StreamResponse:
        try:
            path, _, query = request.raw_path.partition("?")
            guard.check_size(request.raw_path, request.headers)
            guard.check_host(request.headers)
            if not (path == "/" and "token" in request.query):
                guard.check(request.headers)
            if path not in methods:
                raise Refused(404, "there is nothing here")
            if request.method != methods[path]:
                raise Refused(405, f"{methods[path]} is all that is answered here")
            return await handler(request)
        except Refused as refused:
            answer = _answer(refused.sentence.encode(), "text/plain; charset=utf-8", refused.status)
            answer.force_close()  # a body may be left unread
            return answer

    app.middlewares.append(gate)


def _answer(content: bytes, kind: str, status: int = 200, headers: dict[str, str] | None = None) -> web.Response:
    return web.Response(body=content, status=status, headers={"Content-Type": kind, **_HEADERS, **(headers or {})})
