"""Who may ask the viewer's server: one-time links, a cookie for each browser, known hosts, small bodies."""

import hmac
import secrets
import threading
from email.message import Message
from http.cookies import CookieError, SimpleCookie

# Bytes of a request's path and of its body: an edit of every control of a large stage fits.
LONGEST_PATH = 2048
LARGEST_BODY = 1 << 18
LOOPBACK = ("127.0.0.1", "localhost", "[::1]")


class Refused(Exception):
    """A request that is not answered: HTTP status and a sentence."""

    def __init__(self, status: int, sentence: str) -> None:
        super().__init__(sentence)
        self.status, self.sentence = status, sentence


class Guard:
    """Tokens that open the page once each, and the secret that a browser keeps in its cookie afterwards.

    ``host``: what the server is bound to; on a loopback address only requests that name one are answered, so that no
    other site's name can be pointed here.
    """

    def __init__(self, host: str, port: int) -> None:
        self.host, self.port = host, port
        self.cookie = f"scratchwarp_{port}"
        self._secret = secrets.token_urlsafe(32)
        self._tokens: set[str] = set()
        self._lock = threading.Lock()

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
        return f"{self.cookie}={self._secret}; Path=/; HttpOnly; SameSite=Strict"

    def check(self, headers: Message) -> None:
        """Refused unless the request carries the cookie."""
        try:
            jar = SimpleCookie(headers.get("Cookie") or "")
        except CookieError:
            raise Refused(403, "the cookie cannot be read") from None
        brought = jar[self.cookie].value if self.cookie in jar else ""
        if not hmac.compare_digest(brought.encode(), self._secret.encode()):
            raise Refused(403, "open the viewer by the link that it printed")

    def check_host(self, headers: Message) -> None:
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
    def body_size(headers: Message) -> int:
        """Bytes of a request's body; Refused where it does not say, says too many, or is no JSON."""
        length = headers.get("Content-Length")
        if headers.get("Transfer-Encoding") or length is None or not length.isascii() or not length.isdigit():
            raise Refused(411, "say how long the body is")
        if len(length) > 12 or int(length) > LARGEST_BODY:
            raise Refused(413, f"the body is larger than {LARGEST_BODY} bytes")
        if (headers.get("Content-Type") or "").split(";")[0].strip() != "application/json":
            raise Refused(415, "the body must be application/json")
        return int(length)
