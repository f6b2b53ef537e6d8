"""Who may ask the viewer's server: one-time links, a cookie for each browser, known hosts, small requests."""

import hmac
import secrets
import threading
from collections.abc import Mapping
from http.cookies import CookieError, SimpleCookie

# Bytes of a request's path, and of a message or a body: an edit of every control of a large stage fits.
LONGEST_PATH = 2048
LARGEST_BODY = 1 << 18
LOOPBACK = ("127.0.0.1", "localhost", "[::1]")


class Refused(Exception):
    """A request that is not answered: HTTP status and a sentence."""

    def __init__(self, status: int, sentence: str) -> None:
        super().__init__(sentence)
        self.status, self.sentence = status, sentence


class Guard:
    """Tokens that open the page once each, and the secrets that a browser keeps afterwards.

    ``host``: what the server is bound to; on a loopback address only requests that name one are answered, so that no
    other site's name can be pointed here. ``port``: 0, and nobody gets in, until the server listens. ``secret``: what a
    browser with a cookie is given to open the socket with, too.
    """

    def __init__(self, host: str, port: int = 0) -> None:
        self.host, self.port = host, port
        self.secret = secrets.token_urlsafe(32)
        self._cookie = secrets.token_urlsafe(32)
        self._tokens: set[str] = set()
        self._lock = threading.Lock()

    @property
    def cookie(self) -> str:
        """Name of the cookie: browsers keep one jar for all ports of a host."""
        return f"scratchwarp_{self.port}"

    def link(self) -> str:
        """An address that opens the page, once."""
        token = secrets.token_urlsafe(24)
        with self._lock:
            self._tokens.add(token)
        shown = f"[{self.host}]" if ":" in self.host else self.host
        return f"http://{'127.0.0.1' if shown == '0.0.0.0' else shown}:{self.port}/?token={token}"

    def enter(self, token: str) -> str:
        """The cookie for whoever brings a token, which is spent; Refused when it is none."""
        with self._lock:
            known = next((t for t in self._tokens if hmac.compare_digest(t.encode(), token.encode())), None)
            if known is None:
                raise Refused(403, "this link was used or never given; ask the one that started the viewer for another")
            self._tokens.remove(known)
        return f"{self.cookie}={self._cookie}; Path=/; HttpOnly; SameSite=Strict"

    def check(self, headers: Mapping[str, str]) -> None:
        """Refused unless the request carries the cookie."""
        try:
            jar = SimpleCookie(headers.get("Cookie") or "")
        except CookieError:
            raise Refused(403, "the cookie cannot be read") from None
        brought = jar[self.cookie].value if self.cookie in jar else ""
        if not self.port or not hmac.compare_digest(brought.encode(errors="replace"), self._cookie.encode()):
            raise Refused(403, "open the viewer by the link that it printed")

    def check_host(self, headers: Mapping[str, str]) -> None:
        """Refused unless the request names this server, and comes from no other site."""
        names = (*LOOPBACK, self.host) if self.host in ("127.0.0.1", "::1", "localhost") else ()
        known = {f"{name}:{self.port}" for name in names}
        host = headers.get("Host") or ""
        if known and host not in known:
            raise Refused(403, "the viewer answers under its own address only")
        origin = headers.get("Origin")
        if origin is not None and origin != f"http://{host}":
            raise Refused(403, "the viewer answers no other site")

    @staticmethod
    def check_size(path: str, headers: Mapping[str, str]) -> None:
        """Refused where the path is long, or a body is large or does not say how large it is."""
        if len(path) > LONGEST_PATH:
            raise Refused(414, "the path is too long")
        length = headers.get("Content-Length") or "0"
        if headers.get("Transfer-Encoding") or not length.isascii() or not length.isdigit():
            raise Refused(411, "say how long the body is")
        if len(length) > 12 or int(length) > LARGEST_BODY:
            raise Refused(413, f"the body is larger than {LARGEST_BODY} bytes")
