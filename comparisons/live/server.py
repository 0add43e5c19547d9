"""The server of the page: a few fixed files and its questions, on this machine's loopback alone.

    GET  /TOKEN/          the page; live.css, live.js, viewer.js, viewer.css beside it
    GET  /TOKEN/panel     the sliders
    POST /TOKEN/lattice   a question: the lattice's answer
    POST /TOKEN/shell     the same question: the shell's answer, and how far the lattice's is from it

Nothing is kept between questions, and the page asks one of each model at a time: there is no queue. The
lattice is solved on the request's thread, the shell in a process of its own, as `sheetbench compare` solves
them, without error bars. What comes in is bounded, and what contradicts itself is answered with status 400
and a sentence. Every page open in the browser can send requests here: `refusal` says which are answered.
"""

from __future__ import annotations

import json
import secrets
import sys
import threading
import traceback
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib import resources
from typing import Any

import numpy as np

from comparisons.live.panel import Panel, Question
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements
from comparisons.pages.sheets import own_text, packed, viewer_sheet
from comparisons.pictures.plan import on_sheet, plan_mesh
from comparisons.sweep.differences import error
from comparisons.sweep.executors import Processes
from sheetbench.answers.files import plain
from sheetbench.answers.solution import FieldMesh, Solution
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene

LOOPBACK = "127.0.0.1"
MESSAGE = 4096  # bytes of a question at most
CONNECTIONS = 32  # open at once
SHELL_CELLS = 24  # along the shorter side, of the picture of the shell
DIFFERENCE = {"name": "difference", "label": "Difference from the shell", "unit": "mm", "scale": 1e3}
KEPT = ("label", "status", "advice", "load_factor", "unknowns", "settings", "probes")  # of a solution
FAULT = "a fault of the program; the terminal that it was started from says more"
TYPES = {"html": "text/html", "css": "text/css", "js": "text/javascript"}
HEADERS = {  # of every answer: scripts, styles and answers of this server alone, and nobody's frame
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "img-src 'self' data:; connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cache-Control": "no-store",
}


class Server(ThreadingHTTPServer):
    """The panel, its secret address, and who answers; port: 0 takes any that is free."""

    def __init__(self, panel: Panel, port: int = 0) -> None:
        try:
            super().__init__((LOOPBACK, port), Desk)
        except (OSError, OverflowError) as error:
            raise BadInput(f"--port = {port}: cannot be had: {error}") from None
        self.panel, self.assets, self.token = panel, _assets(), secrets.token_urlsafe(32)
        self.hosts = {f"{name}:{self.server_port}" for name in (LOOPBACK, "localhost")}
        self.address = f"http://{LOOPBACK}:{self.server_port}/{self.token}/"
        self.turn, self.shells = threading.Lock(), Processes(1)

    def server_close(self) -> None:
        """Answer no more."""
        super().server_close()
        self.shells.shutdown(wait=False, cancel_futures=True)

    def verify_request(self, request: Any, client_address: Any) -> bool:
        """Return whether few enough connections are open for one more."""
        return threading.active_count() <= CONNECTIONS

    def handle_error(self, request: Any, client_address: Any) -> None:
        """A connection that breaks is nobody's fault here; anything else the terminal shows."""
        if not isinstance(error := sys.exception(), OSError):
            traceback.print_exception(error)

    def answer(self, what: str, message: bytes) -> dict[str, Any]:
        """Return the answer to a question, by one of WAYS. Raises BadInput for one that has none."""
        question = self.panel.read(message)
        scene = self.panel.scene_of(question)
        if what == "shell":
            return self.shells.submit(shell, scene, question).result()
        with self.turn:
            return WAYS[what](scene, question)


class Desk(BaseHTTPRequestHandler):
    """The requests of one connection."""

    server: Server
    protocol_version = "HTTP/1.1"
    timeout = 60.0  # s after which a connection that says nothing is closed
    server_version = sys_version = ""

    def log_message(self, *_: object) -> None:
        """Requests are not logged: the address in them is secret."""

    def refusal(self, own: bool = False) -> HTTPStatus | None:
        """Return why a request is not answered; own: whether it must name its origin.

        The path needs the random token, compared in constant time; Host must be the loopback's, else a
        foreign name that was made to lead here (DNS rebinding) would do; an Origin that comes must be the
        page's own, and a question, which browsers let any page post, needs one.
        """
        hosts, origins = self.headers.get_all("Host", []), self.headers.get_all("Origin", [])
        if len(hosts) != 1 or hosts[0].lower() not in self.server.hosts:
            return HTTPStatus.MISDIRECTED_REQUEST
        _, token, *_ = *self.path.partition("?")[0].split("/", 2), ""
        known = secrets.compare_digest(token.encode(), self.server.token.encode())
        ours = {f"http://{host}" for host in self.server.hosts}
        one = len(origins) <= 1 and (origins or not own) and ours.issuperset(map(str.lower, origins))
        return None if known and one else HTTPStatus.FORBIDDEN

    @property
    def what(self) -> str:
        """What the path is, below the token."""
        return self.path.partition("?")[0].removeprefix(f"/{self.server.token}").removeprefix("/")

    def do_GET(self) -> None:
        """Answer with a file of the page, or with its panel."""
        refused, asset = self.refusal(), self.server.assets.get(self.what)
        if refused or not (asset or self.what == "panel"):
            return self.reply(refused or HTTPStatus.NOT_FOUND)
        if asset:
            return self.send(HTTPStatus.OK, *asset)
        return self.reply(HTTPStatus.OK, self.server.panel.document())

    def do_POST(self) -> None:
        """Answer a question; one that contradicts itself is refused in a line."""
        length, refused = self.headers.get("Content-Length", ""), self.refusal(own=True)
        if not (length.isascii() and length.isdigit() and int(length) <= MESSAGE):
            refused = refused or HTTPStatus.REQUEST_ENTITY_TOO_LARGE
        if refused or self.what not in WAYS:
            return self.reply(refused or HTTPStatus.NOT_FOUND)
        try:
            self.reply(HTTPStatus.OK, self.server.answer(self.what, self.rfile.read(int(length))))
        except BadInput as error:
            self.reply(HTTPStatus.BAD_REQUEST, {"said": str(error)})
        except Exception as error:  # a fault of the program: the page goes on, and the terminal shows it
            traceback.print_exception(error)
            self.reply(HTTPStatus.INTERNAL_SERVER_ERROR, {"said": FAULT})

    def reply(self, status: HTTPStatus, document: dict[str, Any] | None = None) -> None:
        """Send JSON; without any refuse, and end the connection, whose further bytes are not looked at."""
        self.close_connection |= document is None
        body = json.dumps(document or {"said": status.phrase}, allow_nan=False)
        self.send(status, "application/json", body.encode())

    def send(self, status: HTTPStatus, kind: str, body: bytes) -> None:
        """Send an answer of this type."""
        self.send_response(status)
        closing = {"Connection": "close"} if self.close_connection else {}
        own = {"Content-Type": kind, "Content-Length": str(len(body)), **closing}
        for name, value in {**HEADERS, **own}.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)


def solved(scene: Scene, question: Question) -> Solution:
    """Return the lattice's solution. Raises BadInput for what is contradictory, as do the others here."""
    return solve(resolve(scene, question.lattice))


def lattice(scene: Scene, question: Question) -> dict[str, Any]:
    """Return the lattice's message."""
    solution = solved(scene, question)
    flat = {**DIFFERENCE, "kind": "difference", "values": packed(np.zeros(len(solution.mesh.points)))}
    return _message(question, scene, solution, "lattice", solution.mesh, flat)


def shell(scene: Scene, question: Question) -> dict[str, Any]:
    """Return the shell's message, with what the lattice differs by: `error` (a fraction, null where it has no
    meaning), and `difference` [m] at the masses, of those beyond a rim at the nearest point of the sheet."""
    beside = solved(scene, question)
    solution = solve(resolve(scene, Elements("shell", int(question.values["elements"]))))
    plan, probes = plan_mesh(scene, SHELL_CELLS), scene.probe_points()
    u = solution.displacement(plan.points[:, :2])
    mesh = FieldMesh(plan.points, plan.cells, {"displacement": u})
    places = on_sheet(scene, beside.mesh.points[:, :2])
    off = np.linalg.norm(beside.displacement(places) - solution.displacement(places), axis=1)
    known = beside.comparable and solution.comparable
    return {
        **_message(question, scene, solution, "shell", mesh),
        "error": error(beside.displacement(probes), solution.displacement(probes)) if known else None,
        "difference": packed(np.nan_to_num(off)),
    }


def _message(
    question: Question, scene: Scene, solution: Solution, model: str, mesh: FieldMesh, *fields: dict[str, Any]
) -> dict[str, Any]:
    known = plain(solution.document(scene))
    said = solution.message or ("" if solution.comparable else solution.status.advice)
    sheet = viewer_sheet(model, mesh, model.capitalize(), [*fields], scene)
    found = {"number": question.number, "said": said, "seconds": solution.solve_seconds, "sheet": sheet}
    return found | {name: known[name] for name in KEPT}


WAYS = {"lattice": lattice, "shell": shell}


def _assets() -> dict[str, tuple[str, bytes]]:
    """Return type and content of the page's files by name, read once; the page itself has none."""
    folder, names = resources.files("comparisons.live").joinpath("page"), ("live.html", "live.css", "live.js")
    texts = {name: folder.joinpath(name).read_text("utf-8") for name in names}
    texts |= {name: own_text(name) for name in ("viewer.js", "viewer.css")}
    return {
        name.replace("live.html", ""): (f"{TYPES[name.rpartition('.')[2]]}; charset=utf-8", text.encode())
        for name, text in texts.items()
    }
