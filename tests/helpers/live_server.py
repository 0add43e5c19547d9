"""A server of `sheetbench live` in a thread of the tests, and a page's side of the conversation with it."""

import asyncio
import json
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlsplit

from websockets.sync.client import ClientConnection, connect

from comparisons.live.panel import Panel
from comparisons.live.server import served


@contextmanager
def serving(panel: Panel) -> Iterator[str]:
    """The address of the panel's page."""
    told: dict[str, Any] = {}
    there = threading.Event()

    async def serve() -> None:
        told["loop"], told["over"] = asyncio.get_running_loop(), asyncio.Event()
        async with served(panel) as address:
            told["address"] = address
            there.set()
            await told["over"].wait()

    thread = threading.Thread(target=lambda: asyncio.run(serve()))
    thread.start()
    assert there.wait(600)
    try:
        yield told["address"]
    finally:
        told["loop"].call_soon_threadsafe(told["over"].set)
        thread.join(600)


@contextmanager
def talking(address: str, **options: Any) -> Iterator[ClientConnection]:
    """A web socket as the page opens it, both models ready."""
    place = urlsplit(address)
    headers = {"origin": f"http://{place.netloc}", **options}
    with connect(f"ws://{place.netloc}{place.path}socket", **headers) as socket:
        yield socket


def hear(socket: ClientConnection, until: Callable[[dict[str, Any]], bool]) -> list[dict[str, Any]]:
    """The messages up to the one that is waited for. The limit only ends a test that hangs."""
    found = []
    while not found or not until(found[-1]):
        found.append(json.loads(socket.recv(600)))
    return found
