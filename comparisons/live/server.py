"""The server of the page: a few fixed files and a web socket, on this machine's loopback alone.

`websockets` answers both: one dependency-free wheel, asyncio, and plain requests by `process_request`. What
comes in is bounded: one question is a message of 4 kB at most, and few pages are open at once.
"""

from __future__ import annotations

import asyncio
import logging
import signal
import socket
from collections.abc import AsyncIterator, Callable
from contextlib import asynccontextmanager, suppress
from http import HTTPStatus
from importlib import resources

from websockets.asyncio.server import ServerConnection, serve
from websockets.datastructures import Headers
from websockets.exceptions import ConnectionClosed
from websockets.http11 import Request, Response

from comparisons.browser import viewer
from comparisons.live.guard import LOOPBACK, Guard
from comparisons.live.models import Models
from comparisons.live.panel import Panel
from comparisons.live.session import Session
from sheetbench.errors import BadInput

MESSAGE = 4096  # bytes of a question at most
PAGES = 4  # open at once
SOCKET = "socket"
TYPES = {"html": "text/html", "css": "text/css", "js": "text/javascript"}


def run(panel: Panel, port: int, opened: Callable[[str], None]) -> None:
    """Serve the page until interrupted. opened: called with its address. Raises BadInput for a port that
    cannot be had.

    An interrupt may come in the midst of any instruction, a send of `websockets` too, which would then report
    a failed connection. So asyncio hears it here: it cancels the server, and raises KeyboardInterrupt after.
    """
    heard_by = signal.getsignal(signal.SIGINT)
    signal.signal(signal.SIGINT, signal.default_int_handler)  # which asyncio replaces by its own
    try:
        asyncio.run(_until_interrupted(panel, port, opened))
    finally:
        signal.signal(signal.SIGINT, heard_by)


async def _until_interrupted(panel: Panel, port: int, opened: Callable[[str], None]) -> None:
    async with served(panel, port) as address:
        opened(address)
        await asyncio.get_running_loop().create_future()


@asynccontextmanager
async def served(panel: Panel, port: int = 0) -> AsyncIterator[str]:
    """A server of the panel's page; its address, with the token. port: 0 takes any that is free."""
    models = Models()
    try:
        listening = _listening(port)
        guard = Guard(listening.getsockname()[1])
        first = panel.first()
        desk = _Desk(
            panel, models, guard, asyncio.ensure_future(models.warm_up(panel.scene_of(first), first))
        )
        async with serve(
            desk.converse,
            sock=listening,
            process_request=desk.answer,
            max_size=MESSAGE,
            max_queue=4,
            compression=None,  # on one machine it only takes time
            server_header=None,
            logger=_silent(),
        ):
            yield guard.address
    finally:
        models.close()


def _listening(port: int) -> socket.socket:
    try:
        return socket.create_server((LOOPBACK, port))
    except (OSError, OverflowError) as error:
        raise BadInput(f"--port = {port}: cannot be had: {error}") from None


class _Desk:
    """Requests and web sockets of the page, answered."""

    def __init__(self, panel: Panel, models: Models, guard: Guard, warm: asyncio.Future[None]) -> None:
        self._panel, self._models, self._guard, self._warm = panel, models, guard, warm
        self._assets = _assets()
        self._pages = 0

    def answer(self, connection: ServerConnection, request: Request) -> Response | None:
        """Return the answer to a request; None lets it open the web socket."""
        socket_asked = self._guard.name(request.path) == SOCKET
        refused = self._guard.refusal(request.path, request.headers, socket_asked)
        if refused is not None:
            return self._response(refused)
        if socket_asked:
            return self._response(HTTPStatus.SERVICE_UNAVAILABLE) if self._pages >= PAGES else None
        if request.method != "GET":
            return self._response(HTTPStatus.METHOD_NOT_ALLOWED)
        if (found := self._assets.get(self._guard.name(request.path))) is None:
            return self._response(HTTPStatus.NOT_FOUND)
        return self._response(HTTPStatus.OK, *found)

    async def converse(self, connection: ServerConnection) -> None:
        """Talk with a page until it is closed."""

        async def send(text: str) -> None:
            await connection.send(text)

        self._pages += 1
        try:
            with suppress(ConnectionClosed):
                await Session(self._panel, self._models, asyncio.shield(self._warm), send).run(
                    aiter(connection)
                )
        finally:
            self._pages -= 1

    def _response(self, status: HTTPStatus, kind: str = "text/plain", body: bytes = b"") -> Response:
        body = body or f"{status.value} {status.phrase}\n".encode()
        headers = {**self._guard.headers, "Content-Type": kind, "Content-Length": str(len(body))}
        headers["Connection"] = "close"
        return Response(status.value, status.phrase, Headers(headers), body)


def _assets() -> dict[str, tuple[str, bytes]]:
    """Return type and content of the page's files by name, read once; the page itself has none."""
    page = resources.files("comparisons.live").joinpath("page")
    own = {
        name: page.joinpath(name).read_text(encoding="utf-8") for name in ("live.html", "live.css", "live.js")
    }
    texts = {**own, "viewer.js": viewer.script(), "viewer.css": viewer.style()}
    found = {
        name: (f"{TYPES[name.rpartition('.')[2]]}; charset=utf-8", text.encode())
        for name, text in texts.items()
    }
    return {"": found.pop("live.html"), **found}


def _silent() -> logging.Logger:
    """Return a logger for requests that are turned away: they are nobody's fault here."""
    logger = logging.getLogger(__name__)
    logger.propagate = False
    if not logger.handlers:
        logger.addHandler(logging.NullHandler())
    return logger
