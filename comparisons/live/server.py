"""The server of the page: a few fixed files and its questions, on this machine's loopback alone.

    GET  /TOKEN/          the page; live.css, live.js, viewer.js, viewer.css beside it
    GET  /TOKEN/panel     the sliders, and the number of the page's first question
    POST /TOKEN/lattice   a question: the lattice's answer
    POST /TOKEN/shell     the same question: the shell's answer, and how far the lattice's is from it
    POST /TOKEN/text      the springs or the scene of a question, as TOML

The page asks one question of each model at a time and leaves out those that a newer one overtakes, so the
server keeps no queue. The lattice is solved on the request's thread, one question at a time; the shell in a
process of its own, so that neither waits for the other. Sought from the last
equilibrium an answer takes a third of the time; one of a question with `rest` is sought from flat, as
`sheetbench compare` does.

What comes in is bounded: a question has 4 kB at most, a connection that says nothing for a minute is closed,
and few are open at once. A question that contradicts itself is answered with status 400 and a sentence.
"""

from __future__ import annotations

import json
import sys
import threading
import traceback
from collections import OrderedDict
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib import resources
from itertools import count
from typing import Any

from comparisons.calibration.answer import to_toml as springs_to_toml
from comparisons.live import answers
from comparisons.live.answers import Answered
from comparisons.live.guard import HEADERS, LOOPBACK, Guard
from comparisons.live.panel import Panel, Question
from comparisons.models.resolve import resolve
from comparisons.pages import viewer
from comparisons.sweep.executors import Processes, single_threaded
from sheetbench.errors import BadInput
from sheetbench.scenes.language.toml import to_toml

MESSAGE = 4096  # bytes of a question at most
CONNECTIONS = 32  # open at once
KEPT = 16  # answers of the lattice, which the shell's are held against
QUESTIONS = 10**6  # of one page
SILENCE = 60.0  # s after which a connection that says nothing is closed
FAULT = "a fault of the program; the terminal that it was started from says more"
TYPES = {"html": "text/html", "css": "text/css", "js": "text/javascript"}


def run(panel: Panel, port: int, opened: Callable[[str], None]) -> None:
    """Serve the page until interrupted. opened: called with its address. Raises BadInput for a port that
    cannot be had."""
    with served(panel, port) as server:
        opened(server.guard.address)
        server.serve_forever()


@contextmanager
def served(panel: Panel, port: int = 0) -> Iterator[Server]:
    """A server of the panel's page, which answers while `serve_forever` runs. port: 0 takes any that is
    free."""
    server = Server(panel, port)
    threading.Thread(target=server.warm_up, daemon=True).start()
    try:
        yield server
    finally:
        server.server_close()
        server.shells.shutdown(wait=False, cancel_futures=True)


class Server(ThreadingHTTPServer):
    """The panel, who may ask, and who answers."""

    def __init__(self, panel: Panel, port: int) -> None:
        try:
            super().__init__((LOOPBACK, port), Desk)
        except (OSError, OverflowError) as error:
            raise BadInput(f"--port = {port}: cannot be had: {error}") from None
        self.panel, self.guard, self.assets = panel, Guard(self.server_address[1]), _assets()
        self.lattice_turn, self.shells = threading.Lock(), Processes(1)
        self.answers: OrderedDict[int, Answered] = OrderedDict()  # by the numbers of their questions
        self.numbers = count(0, QUESTIONS)
        self._open = threading.BoundedSemaphore(CONNECTIONS)

    def verify_request(self, request: Any, client_address: Any) -> bool:
        """Return whether few enough connections are open for one more."""
        return self._open.acquire(blocking=False)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """Answer until the connection is closed."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            self._open.release()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """A connection that breaks is nobody's fault here; anything else the terminal shows."""
        if not isinstance(error := sys.exception(), OSError):
            traceback.print_exception(error)

    def warm_up(self) -> None:
        """Let both models solve the first question, so that nothing is left to import or compile."""
        first = self.panel.first()
        with suppress(Exception), self.lattice_turn, single_threaded():  # the page's first question tells
            found = answers.lattice(self.panel.scene_of(first), first)
            self.shells.submit(answers.shell, found.scene, first, *found.places())

    def lattice(self, question: Question) -> dict[str, Any] | None:
        """Return the lattice's answer; None where it is the one that the page has already."""
        with self.lattice_turn:
            near = None if question.rest else next(reversed(self.answers.values()), None)
            answered = answers.lattice(self.panel.scene_of(question), question, near)
            before = self.answers.pop(question.number, None)
            self.answers[question.number] = answered
            while len(self.answers) > KEPT:
                self.answers.popitem(last=False)
        return None if before and answered.agrees(before) else answered.document()

    def shell(self, question: Question) -> dict[str, Any] | None:
        """Return the shell's answer beside the lattice's; None where the lattice's is no longer kept."""
        if (answered := self.answers.get(question.number)) is None:
            return None
        found: dict[str, Any] = self.shells.submit(
            answers.shell, answered.scene, answered.question, *answered.places()
        ).result()
        return found

    def text(self, question: Question) -> dict[str, Any]:
        """Return what is to be copied, as TOML: the lattice's [springs], or the scene."""
        scene = self.panel.scene_of(question)
        if question.copy == "scene":
            return {"text": to_toml(scene)}
        with self.lattice_turn:
            return {"text": springs_to_toml(resolve(scene, question.lattice, "springs").springs)}


class Desk(BaseHTTPRequestHandler):
    """The requests of one connection."""

    server: Server
    protocol_version = "HTTP/1.1"
    timeout = SILENCE
    server_version = sys_version = ""

    def log_message(self, *_: object) -> None:
        """Requests are not logged: the address in them is secret."""

    def do_GET(self) -> None:
        """Answer with a file of the page, or with its panel and the number that its questions begin with."""
        server = self.server
        if (refused := server.guard.refusal(self.path, self.headers)) is not None:
            self._reply(refused)
        elif (name := server.guard.name(self.path)) == "panel":
            self._reply(HTTPStatus.OK, {**server.panel.document(), "number": next(server.numbers)})
        elif (asset := server.assets.get(name)) is None:
            self._reply(HTTPStatus.NOT_FOUND)
        else:
            self._send(HTTPStatus.OK, *asset)

    def do_POST(self) -> None:
        """Answer a question; one that contradicts itself is refused in a line."""
        server, length = self.server, self.headers.get("Content-Length", "")
        ways = {"lattice": server.lattice, "shell": server.shell, "text": server.text}
        if (refused := server.guard.refusal(self.path, self.headers, own=True)) is not None:
            return self._reply(refused)
        if not (length.isascii() and length.isdigit() and int(length) <= MESSAGE):
            return self._reply(HTTPStatus.REQUEST_ENTITY_TOO_LARGE)
        if (answer := ways.get(server.guard.name(self.path))) is None:
            return self._reply(HTTPStatus.NOT_FOUND)
        try:
            document = answer(server.panel.read(self.rfile.read(int(length))))
        except BadInput as error:
            return self._reply(HTTPStatus.BAD_REQUEST, {"said": str(error)})
        except Exception as error:  # a fault of the program: the page goes on, and the terminal shows it
            traceback.print_exception(error)
            return self._reply(HTTPStatus.INTERNAL_SERVER_ERROR, {"said": FAULT})
        self._reply(HTTPStatus.OK if document else HTTPStatus.NO_CONTENT, document)

    def _reply(self, status: HTTPStatus, document: dict[str, Any] | None = None) -> None:
        """Send JSON; a refusal without one ends the connection, whose further bytes are not looked at."""
        if document is None and status is not HTTPStatus.NO_CONTENT:
            self.close_connection = True
            document = {"said": status.phrase}
        text = "" if document is None else json.dumps(document, allow_nan=False)
        self._send(status, "application/json", text.encode())

    def _send(self, status: HTTPStatus, kind: str, body: bytes) -> None:
        self.send_response(status)
        own = {"Content-Type": kind} if body else {}
        own |= {"Connection": "close"} if self.close_connection else {}
        own |= {"Content-Length": str(len(body))} if status is not HTTPStatus.NO_CONTENT else {}
        for name, value in {**HEADERS, **own}.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)


def _assets() -> dict[str, tuple[str, bytes]]:
    """Return type and content of the page's files by name, read once; the page itself has none."""
    folder = resources.files("comparisons.live").joinpath("page")
    own = {name: folder.joinpath(name).read_text("utf-8") for name in ("live.html", "live.css", "live.js")}
    texts = {**own, "viewer.js": viewer.script(), "viewer.css": viewer.style()}
    return {
        name.replace("live.html", ""): (f"{TYPES[name.rpartition('.')[2]]}; charset=utf-8", text.encode())
        for name, text in texts.items()
    }
