"""trame's socket made narrow: small messages, and no more of its calls than the page needs."""

from typing import Any

from wslink.chunking import UnChunker

from .guard import LARGEST_BODY

# Of the calls that trame offers these are answered; the others that its client makes are taken and do nothing. So a
# browser changes the state, and thereby the pages of other browsers, by wishes alone, and cannot end the server.
ANSWERED = ("trame.state.get", "trame.trigger")
IGNORED = ("trame.state.update", "trame.lifecycle.update", "trame.error.client")
MOST_PENDING = 8


class _Small(UnChunker):
    """Puts messages together, small ones only, and few at a time."""

    def set_max_message_size(self, size: int) -> None:
        super().set_max_message_size(min(size, LARGEST_BODY))

    def process_chunk(self, chunk: bytes) -> Any:
        if len(self.pending_messages) >= MOST_PENDING:
            raise ValueError("too many messages are begun")
        return super().process_chunk(chunk)


class _Clients(dict[str, UnChunker]):
    """wslink's record of who sends what, which keeps small ones whatever it is given."""

    def __setitem__(self, client: str, _: UnChunker) -> None:
        super().__setitem__(client, _Small())


def narrow(handler: Any) -> None:
    """Narrow wslink's handler of a socket, before it listens; a browser that sends what cannot be read is cut off."""
    handler.unchunkers = _Clients()
    answered = {name: handler.functionMap[name] for name in ANSWERED}
    handler.functionMap = answered | dict.fromkeys(IGNORED, (None, lambda *_: None))
    read = handler.onMessage

    async def message(binary: bool, sent: Any, client: str) -> None:
        try:
            if not binary:
                raise ValueError("text is not expected")
            await read(binary, sent, client)
        except (ValueError, TypeError, KeyError, AttributeError, IndexError):
            await handler.connections[client].close(code=1008)

    handler.onMessage = message
