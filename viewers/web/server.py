"""The server: trame's, in a thread, whose state the browsers follow and whose triggers are their wishes."""

import asyncio
import secrets
import threading
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path
from typing import Any

from trame.app import get_server
from trame.ui.html import DivLayout
from trame_client.module import vue3

from .. import preview
from ..looking import Looking
from . import answers, gate, wire
from .guard import LARGEST_BODY, Guard, Refused
from .pictures import Pictures
from .wishes import Wish, Wishes

# All of it is in page/look.js. What a stage says goes there as data, never into this text, which browsers compile.
_TEMPLATE = '<scratch-look :look="look" :before="before" :values="values" :controls="controls" :about="about" />'
_GONE = "<scratch-gone />"
# Seconds between looks at whether the server shall end.
_TICK = 0.2


class WebView:
    """A server for one stage, for any number of browsers; it listens until it is closed.

    Attributes: looking: what is looked at; guard: who may; target: the file that edits are saved to; entered: called
    when a link was used; address: (host, port) that it listens on.
    """

    def __init__(self, looking: Looking, target: Path, host: str = "127.0.0.1", port: int = 0) -> None:
        """``port`` 0 is any that is free. OSError where the address cannot be had."""
        self.looking, self.target = looking, target
        self.guard = Guard(host)
        self.pictures = Pictures(looking)
        self.entered: Callable[[], None] = lambda: None
        self._end = threading.Event()
        listening: Future[int] = Future()
        work = self._serve(host, port, listening)
        self._thread = threading.Thread(target=asyncio.run, args=(work,), name="web", daemon=True)
        self._thread.start()
        try:
            self.address = (host, listening.result())
        except BaseException:
            self.close()
            raise

    def close(self) -> None:
        """End it, and the sockets of the browsers."""
        self._end.set()
        self._thread.join()
        self.pictures.close()

    def __enter__(self) -> "WebView":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    async def _serve(self, host: str, port: int, listening: "Future[int]") -> None:
        server = self._made(host)
        serving = asyncio.ensure_future(
            server.start(
                port=port, exec_mode="coroutine", thread=True, timeout=0, open_browser=False,
                show_connection_info=False, disable_logging=True,
            )
        )  # fmt: skip
        await asyncio.wait({serving, asyncio.ensure_future(server.ready)}, return_when=asyncio.FIRST_COMPLETED)
        if serving.done():
            listening.set_exception(serving.exception() or OSError(f"{host}:{port} cannot be listened on"))
            return
        self.guard.port = server.port
        listening.set_result(server.port)
        await self._follow(server.state)
        await server.stop()
        await serving

    def _made(self, host: str) -> Any:
        name = f"scratchwarp-{secrets.token_hex(4)}"  # trame keeps servers by name
        server = get_server(name, client_type="vue3", ws_max_msg_size=LARGEST_BODY)
        # nothing of this program's command line, no files by wslink's own paths, a secret that is none
        arguments = ["--host", host, "--authKey", self.guard.secret, "--no-http", "--no-ws-compress"]
        parse = server.cli.parse_known_args
        server.cli.parse_known_args = lambda: parse(arguments)
        server.enable_module({"www": vue3.www, "vue_use": ["scratchwarp"]})
        shown = self.looking.shown
        server.state.update({
            "trame__title": Path(self.looking.stage).name, "trame__template_error_reconnect": _GONE, "before": 0,
            "look": answers.state(shown), "values": answers.values(shown),
            "controls": [answers.described(c) for c in shown.controls],
            "about": {
                "stage": str(self.looking.stage), "target": self.target.name, "preview": preview.available(),
            },
        })  # fmt: skip
        wishes = Wishes(self.looking, self.target, self.guard).known | {"keep": self._keep}
        for wish in wishes:
            server.trigger(wish)(self._answering(server, wishes[wish]))
        with DivLayout(server) as layout:
            layout.root.add_child(_TEMPLATE)

        @server.controller.add("on_server_bind")
        def bind(served: Any) -> None:
            gate.open_paths(served.app, self.guard, self.pictures, lambda: self.entered())
            (handler,) = served._ws_handlers
            wire.narrow(handler)

        return server

    def _keep(self, body: dict[str, Any]) -> dict[str, Any]:
        self.pictures.keep()
        return {}

    def _answering(self, server: Any, wish: Wish) -> Callable[..., Any]:
        async def answer(*sent: Any, **_: Any) -> dict[str, Any]:
            """What comes of a wish, or {"error": why it is refused}."""
            try:
                if len(sent) != 1 or not isinstance(sent[0], dict):
                    raise ValueError("a wish is one object")
                told = await asyncio.to_thread(wish, sent[0])
            except (ValueError, OSError) as error:
                return {"error": str(error)[:2000]}
            server.state.before = self.pictures.kept
            return told

        return answer

    async def _follow(self, state: Any) -> None:
        """Give the browsers what there is to see, until the end."""
        version = edits = -1
        while not self._end.is_set():
            try:
                shown = await asyncio.to_thread(self.looking.wait, version, _TICK)
                if shown.finished and not self.pictures.kept:
                    await asyncio.to_thread(self.pictures.before)
            except Refused:
                continue
            except Exception as error:  # of the thread that refines: whoever started the server is told, too
                with state:
                    state.look = {**state.look, "message": f"the viewer has ended: {error}"}
                await asyncio.to_thread(self._end.wait)
                return
            if shown.version == version:
                continue
            with state:
                state.look, state.before = answers.state(shown), self.pictures.kept
                if shown.edits != edits:
                    state.values = answers.values(shown)
            version, edits = shown.version, shown.edits
