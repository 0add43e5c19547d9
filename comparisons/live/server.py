"""HTTP server of the page: fixed files and solves of the page's requests, on this machine's loopback
interface.

    GET  /TOKEN/          the page; live.css, live.js, viewer.js, viewer.css beside it
    GET  /TOKEN/panel     the sliders
    POST /TOKEN/lattice   a question: the lattice's answer
    POST /TOKEN/shell     that question: the shell's answer, and the lattice's distance from it

Nothing is kept between questions, and the page sends one for each model at a time: there is no queue. The
lattice is solved on the request's thread, the shell in a process of its own, as `sheetbench compare` solves
them, without error bars. What comes in is bounded, and what contradicts itself is answered with status 400
and a sentence. Every page open in the browser can send requests here: `refusal` has the rules.
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
from comparisons.pages.sheets import field, own_text, packed, viewer_sheet
from comparisons.pictures.plan import on_sheet, plan_mesh
from comparisons.sweep.differences import error
from comparisons.sweep.executors import Processes
from sheetbench.answers.files import plain
from sheetbench.answers.solution import FieldMesh, Solution
from sheetbench.errors import BadInput

LOOPBACK = "127.0.0.1"
MESSAGE = 4096  # bytes of a question at most
CONNECTIONS = 32  # open at once
SHELL_CELLS = 24  # along the shorter side, of the picture of the shell
SENT_KEYS = ("label", "status", "advice", "load_factor", "unknowns", "settings", "probes")  # of a solution
FAULT = "a fault of the program; details are in its terminal"
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
    """HTTP server of one panel, under a secret address; port: 0 for any free one."""

    def __init__(self, panel: Panel, port: int = 0) -> None:
        self.lattice_lock, self.shells = (
            threading.Lock(),
            Processes(1),
        )  # which a port that is taken closes again
        try:
            super().__init__((LOOPBACK, port), RequestHandler)
        except (OSError, OverflowError) as error:
            raise BadInput(f"--port = {port}: cannot be used: {error}") from None
        self.panel, self.assets, self.token = panel, _load_assets(panel), secrets.token_urlsafe(32)
        self.hosts = {f"{name}:{self.server_port}" for name in (LOOPBACK, "localhost")}
        self.address = f"http://{LOOPBACK}:{self.server_port}/{self.token}/"

    def server_close(self) -> None:
        """Close the server and end its worker process."""
        super().server_close()
        self.shells.shutdown(wait=False, cancel_futures=True)

    def verify_request(self, request: Any, client_address: Any) -> bool:
        """Return whether another connection can be opened."""
        return threading.active_count() <= CONNECTIONS

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Ignore broken connections; print the traceback of any other error."""
        if not isinstance(error := sys.exception(), OSError):
            traceback.print_exception(error)


class RequestHandler(BaseHTTPRequestHandler):
    """Handler of one HTTP/1.0 request; the connection ends with the response."""

    server: Server
    timeout = 60.0  # s after which a connection that says nothing is closed
    server_version = sys_version = ""

    def log_message(self, *_: object) -> None:
        """Do nothing: a logged request would reveal the secret address."""

    def refusal(self, needs_origin: bool = False) -> HTTPStatus | None:
        """Set `what` to the path below the token; return the HTTP status if the request is refused, else
        None.

        The path needs the random token, compared in constant time; Host must be the loopback's, else a
        foreign name that was made to lead here (DNS rebinding) would do; an Origin that comes must be the
        page's own, and a question, which browsers let any page post, needs one.
        """
        hosts, origins = self.headers.get_all("Host", []), self.headers.get_all("Origin", [])
        if len(hosts) != 1 or hosts[0].lower() not in self.server.hosts:
            return HTTPStatus.MISDIRECTED_REQUEST
        _, token, self.what, *_ = *self.path.partition("?")[0].split("/", 2), "", ""
        known = secrets.compare_digest(token.encode(), self.server.token.encode())
        ours = {f"http://{host}" for host in self.server.hosts}
        one = len(origins) <= 1 and (origins or not needs_origin) and ours.issuperset(map(str.lower, origins))
        return None if known and one else HTTPStatus.FORBIDDEN

    def do_GET(self) -> None:
        """Send a file of the page, or the panel."""
        refused = self.refusal()
        if refused or self.what not in self.server.assets:
            return self.reply(refused or HTTPStatus.NOT_FOUND)
        self.reply(HTTPStatus.OK, *self.server.assets[self.what])

    def do_POST(self) -> None:
        """Solve a question and send the result; a contradictory question gets status 400 and a sentence."""
        length, refused = self.headers.get("Content-Length", ""), self.refusal(needs_origin=True)
        if not (length.isascii() and length.isdigit() and len(length) < 9 and int(length) <= MESSAGE):
            refused = refused or HTTPStatus.REQUEST_ENTITY_TOO_LARGE
        if refused or self.what not in SOLVERS:
            return self.reply(refused or HTTPStatus.NOT_FOUND)
        try:
            question = self.server.panel.read(self.rfile.read(int(length)))
            if self.what == "shell":
                found = self.server.shells.submit(shell, question).result()
            else:
                with self.server.lattice_lock:
                    found = SOLVERS[self.what](question)
            self.reply(HTTPStatus.OK, found)
        except BadInput as error:
            self.reply(HTTPStatus.BAD_REQUEST, {"said": str(error)})
        except Exception as error:  # a fault of the program: the page goes on, and the terminal shows it
            traceback.print_exception(error)
            self.reply(HTTPStatus.INTERNAL_SERVER_ERROR, {"said": FAULT})

    def reply(self, status: HTTPStatus, body: Any = None, kind: str = "application/json") -> None:
        """Send a response, bytes or a JSON document; by default the phrase of the status."""
        if not isinstance(body, bytes):
            body = json.dumps(body or {"said": status.phrase}, allow_nan=False).encode()
        own = {"Content-Type": kind, "Content-Length": str(len(body))}
        self.send_response(status)
        for name, value in {**HEADERS, **own}.items():
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)


def solve_lattice(question: Question) -> Solution:
    """Return the lattice's solution. Raises BadInput for a contradiction, like the others here."""
    return solve(resolve(question.scene, question.lattice))


def lattice(question: Question) -> dict[str, Any]:
    """Return the lattice's message."""
    solution = solve_lattice(question)
    return _encode_answer(question, solution, "lattice", solution.mesh)


def shell(question: Question) -> dict[str, Any]:
    """Return the shell's message with the lattice's difference from it: `error`, a fraction or null if it is
    not defined, and `difference` [m] at the masses, for masses off the sheet at its nearest point."""
    scene, beside = question.scene, solve_lattice(question)
    solution = solve(resolve(scene, Elements("shell", question.elements)))
    plan, probes = plan_mesh(scene, SHELL_CELLS), scene.probe_points()
    mesh = FieldMesh(plan.points, plan.cells, {"displacement": solution.displacement(plan.points[:, :2])})
    places = on_sheet(scene, beside.mesh.points[:, :2])
    off = np.linalg.norm(beside.displacement(places) - solution.displacement(places), axis=1)
    known = beside.comparable and solution.comparable
    return {
        **_encode_answer(question, solution, "shell", mesh),
        "error": error(beside.displacement(probes), solution.displacement(probes)) if known else None,
        "difference": packed(np.nan_to_num(off)),
    }


def _encode_answer(question: Question, solution: Solution, model: str, mesh: FieldMesh) -> dict[str, Any]:
    known = plain(solution.document(question.scene))
    said = solution.message or ("" if solution.comparable else solution.status.advice)
    flat = field("difference", "Difference from the shell", np.zeros(len(mesh.points)), "mm", 1e3)
    fields = [{**flat, "kind": "difference"}] if model == "lattice" else []  # until the shell has answered
    sheet = viewer_sheet(model, mesh, model.capitalize(), fields, question.scene)
    found = {"number": question.number, "said": said, "seconds": solution.solve_seconds, "sheet": sheet}
    return found | {name: known[name] for name in SENT_KEYS}


SOLVERS = {"lattice": lattice, "shell": shell}


def _load_assets(panel: Panel) -> dict[str, tuple[Any, str]]:
    """Return content and type of the page's files, by name; the page itself has none."""
    folder, own = resources.files("comparisons.live").joinpath("page"), ("live.html", "live.css", "live.js")
    texts = {name: folder.joinpath(name).read_text("utf-8") for name in own}
    texts |= {name: own_text(name) for name in ("viewer.js", "viewer.css")}
    return {"panel": (panel.document(), "application/json")} | {
        name.replace("live.html", ""): (text.encode(), f"{TYPES[name.rpartition('.')[2]]}; charset=utf-8")
        for name, text in texts.items()
    }
