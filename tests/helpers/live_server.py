"""A server of `sheetbench live` in a thread of the tests, and both sides of the conversation with it."""

import http.client
import json
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from urllib.parse import urlsplit

from comparisons.live.panel import Panel
from comparisons.live.server import Server

ANSWERED = "live.shown.shell !== undefined && live.shown.shell.number === live.asked()"


@contextmanager
def serving(panel: Panel) -> Iterator[str]:
    """Yield the address of the panel's page."""
    with Server(panel) as server:
        thread = threading.Thread(target=server.serve_forever)
        thread.start()
        try:
            yield server.address
        finally:
            server.shutdown()
            thread.join(600)


def got(address: str, path: str, body: bytes | None = None, **headers: str) -> http.client.HTTPResponse:
    """Return the answer to a request of a path, a post if it has a body; headers replace the usual ones; the
    limit only ends a test that hangs."""
    place = urlsplit(address)
    connection = http.client.HTTPConnection(place.netloc, timeout=600)
    connection.putrequest("GET" if body is None else "POST", path, skip_host=True)
    usual = {"Host": place.netloc}
    if body is not None:
        usual |= {"Origin": f"http://{place.netloc}", "Content-Length": str(len(body))}
    for name, value in {**usual, **headers}.items():
        connection.putheader(name, value)
    connection.endheaders(body)
    return connection.getresponse()


def posted(address: str, what: str, question: str | bytes) -> tuple[int, Any]:
    """Return status and document of the answer to a question, sent as by the page."""
    body = question.encode() if isinstance(question, str) else question
    answer = got(address, urlsplit(address).path + what, body)
    return answer.status, json.loads(answer.read() or b"null")


def until(page: Any, expression: str) -> None:
    """Wait for an expression of the page to hold; its policy lets nobody wait within it."""
    for _ in range(100_000):
        if page.evaluate(f"window.live !== undefined && ({expression})"):
            return
        page.wait_for_timeout(5)
    raise AssertionError(f"never: {expression}")
