"""A browser's side of the socket, by hand: what trame's client says, and what it should never say."""

import asyncio

import pytest

aiohttp = pytest.importorskip("aiohttp")
msgpack = pytest.importorskip("msgpack")
chunking = pytest.importorskip("wslink.chunking")

OWN = object()


class Closed(Exception):
    """The server would not talk."""


def messages(said):
    """What goes over the socket to say something."""
    return list(chunking.generate_chunks(msgpack.packb(said), 0))


def talk(server, cookie, asked, *, secret=OWN, origin=None, host=None, raw=(), listen=None, meanwhile=None):
    """Answers to calls (method, arguments); with ``listen`` also the first state pushed of which it is true, after
    ``meanwhile`` was done. ``raw``: bytes or text sent before. Closed where the server ends it."""
    port = server.address[1]
    headers = {"Cookie": cookie, "Origin": origin or f"http://{host or f'127.0.0.1:{port}'}"}
    headers |= {"Host": host} if host else {}
    given = server.guard.secret if secret is OWN else secret
    return asyncio.run(_talk(f"http://127.0.0.1:{port}/ws", headers, given, asked, raw, listen, meanwhile))


async def _talk(address, headers, secret, asked, raw, listen, meanwhile):
    async with aiohttp.ClientSession() as session:
        try:
            socket = await session.ws_connect(address, headers=headers)
        except aiohttp.WSServerHandshakeError as error:
            raise Closed(str(error.status)) from None
        async with socket:
            reads = chunking.UnChunker()
            reads.set_max_message_size(1 << 30)

            async def say(number, method, arguments):
                for chunk in messages({"wslink": "1.0", "id": number, "method": method, "args": arguments}):
                    await socket.send_bytes(chunk)

            async def hear(wanted):
                while True:
                    message = await socket.receive(30)
                    if message.type != aiohttp.WSMsgType.BINARY:
                        raise Closed(str(message.type))
                    whole = reads.process_chunk(message.data)
                    if whole is not None and wanted(whole):
                        return whole

            await say("system:c0:0", "wslink.hello", [{"secret": secret}])
            # whoever is not let in gets no answer at all, or an error
            await say("system:c0:1", "nothing", [])
            if "result" not in await hear(lambda one: str(one["id"]).startswith("system")):
                raise Closed("hello")
            answers = []
            for message in raw:
                await (socket.send_str if isinstance(message, str) else socket.send_bytes)(message)
            for i, (method, arguments) in enumerate(asked):
                await say(f"rpc:c0:{i}", method, arguments)
                answers.append(await hear(lambda one, i=i: one["id"] == f"rpc:c0:{i}"))
            if listen:
                done = asyncio.ensure_future(asyncio.to_thread(meanwhile))
                pushed = await hear(lambda one: str(one["id"]).startswith("publish") and listen(one["result"]))
                await done
                answers.append(pushed["result"])
            return answers
