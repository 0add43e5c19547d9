"""`sheetbench live`: who is let in, what is refused, compare's answers, the page with its sliders."""

import http.client
import json
import socket
import stat
import webbrowser
from base64 import b64decode
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from urllib.parse import unquote, urlsplit

import numpy as np
import pytest
from browser import browser, opened  # noqa: F401
from commands import run
from live_server import ANSWERED, got, posted, serving, until
from terminals import COMMAND, Terminal

import sheetbench as sb
from comparisons.live import server
from comparisons.live.panel import ELEMENTS_CAP, MASSES_CAP, Panel, largest_count
from comparisons.live.server import CONNECTIONS, MESSAGE
from comparisons.models.spec import Lattice
from sheetbench.answers.solution import Status
from sheetbench.choices import CALIBRATIONS
from sheetbench.errors import BadInput

SCENE = sb.load("curved-edge")


@pytest.fixture(scope="module")
def panel():
    return Panel(SCENE, 2, Lattice(3))


@pytest.fixture(scope="module")
def address(panel):
    with serving(panel) as found:
        yield found


def query_of(panel, number=1, calibration="consistent", **values):
    start = {name: slider.value for name, slider in panel.sliders.items()}
    return json.dumps({"number": number, "values": start | values, "calibration": calibration})


def test_the_page_has_a_content_security_policy(address):
    answer = got(address, urlsplit(address).path)
    assert answer.status == 200 and b"sheetbench live" in answer.read()
    assert "default-src 'none'" in answer.headers["Content-Security-Policy"]
    assert "unsafe" not in answer.headers["Content-Security-Policy"]
    assert answer.headers["Referrer-Policy"] == "no-referrer"


NO_TOKEN = ("/", "/wrong/", "/panel", "/%2e%2e/", "//", "//[", "/[?]", "http://127.0.0.1/")
NO_FILE = ("../pyproject.toml", "%2e%2e/x", "..%2f..%2fetc/passwd", "/etc/passwd", "live.html", "models.py")


def test_without_the_token_nothing_is_answered_and_no_path_leads_to_a_file(address):
    assert {path: got(address, path).status for path in NO_TOKEN} == dict.fromkeys(NO_TOKEN, 403)
    own = urlsplit(address).path
    assert {path: got(address, own + path).status for path in NO_FILE} == dict.fromkeys(NO_FILE, 404)


def test_a_foreign_host_or_origin_is_refused(address, panel):
    place = urlsplit(address)
    assert got(address, place.path, Host="evil.example").status == 421
    assert got(address, place.path, Host=f"evil.example:{place.port}").status == 421
    assert got(address, place.path, Origin="http://evil.example").status == 403
    question, lattice = b"{}", place.path + "lattice"
    for origin in ("null", "http://evil.example", f"https://{place.netloc}", "http://127.0.0.1:1"):
        assert got(address, lattice, question, Origin=origin).status == 403
    connection = http.client.HTTPConnection(place.netloc, timeout=600)
    connection.request("POST", lattice, question)  # without an origin
    assert connection.getresponse().status == 403
    with server.Server(panel) as one:  # which only this machine sees
        assert one.socket.getsockname()[0] == "127.0.0.1"


def test_a_given_k_has_a_slider_and_goes_with_the_calibrations_that_take_it():
    panel = Panel(SCENE, 2, Lattice(3, "uniform", k=550.0, layer_distance=0.002))
    lattices = [panel.read(query_of(panel, 1, name, k=600.0)).lattice for name in ("uniform", "consistent")]
    assert [(one.k, one.layer_distance) for one in lattices] == [(600.0, 0.002), (None, 0.002)]
    assert "k" not in Panel(SCENE, 2).sliders
    assert not any(CALIBRATIONS[name].fitted for name in panel.calibrations)
    with pytest.raises(BadInput, match="near-square"):
        Panel(SCENE, 2, Lattice("3x9"))


@pytest.mark.parametrize(("message", "said"), [
    ({"grid": MASSES_CAP + 1}, "grid = 34: a whole number from 3 to 33"),
    ({"grid": 4.5}, "grid = 4.5: a whole number"),
    ({"elements": ELEMENTS_CAP + 1}, "elements = 17"),
    ({"young": float("nan")}, "values.young: Input should be a finite number"),
    ({"young": "5e7"}, "values.young: Input should be a valid number"),
    ({"young": True}, "values.young: Input should be a valid number"),
    ({"young": 10**400}, "values.young: Input should be a finite number"),
    ({"young": -1.0}, "young = -1: from"),
    ({"young": 1234.5}, "young"),
    ({"weight": 1.0}, "values: weight"),
    ({"calibration": "magic"}, "calibration = 'magic': unknown, choose one of consistent"),
    ({"calibration": []}, "calibration: Input should be a valid string"),
    ("[" * 4000, "Invalid JSON"),
    ("1e999", "no question"),
    (b"\xff", "Invalid JSON"),
], ids=str)  # fmt: skip
def test_a_question_beyond_the_bounds_is_refused_in_a_line(panel, message, said):
    text = query_of(panel, **message) if isinstance(message, dict) else message
    text = text.replace("1234.5", "1e999") if isinstance(text, str) else text  # which overflows
    with pytest.raises(BadInput) as refused:
        panel.read(text)
    assert said in str(refused.value) and "\n" not in str(refused.value)


WOVEN = {"kind": "orthotropic", "young_1": 1e8, "young_2": 2e7, "poisson_12": 0.3, "shear_12": 8e6}
PRESSED = sb.load("one-edge-clamped").replace(
    material={**WOVEN, "density": 1e3}, loads=[{"kind": "area", "force_per_area": (0.0, 0.0, 1.0)}]
)
EVEN = {"thickness": (7.5e-4, 0.012, 0.003), "gravity": (0, 3, 1), "grading": (0, 1, 0)}
EVEN |= {"elements": (2, 16, 2)}
SLIDERS = {  # of a bent and of a woven sheet: ends and where they begin
    "bent": {"poisson": (0, 0.495, 0.48), "young": (54.5e6 / 30, 54.5e6 * 30, 54.5e6),
             "curvature_x0": (-8, 8, 4), "grid": (3, 33, 3), "k": (550 / 30, 550 * 30, 550)},
    "woven": {"angle": (-np.pi, np.pi, 0), "young_1": (1e8 / 30, 3e9, 1e8), "young_2": (2e7 / 30, 6e8, 2e7),
              "loads": (-3, 3, 1), "grid": (3, 33, 5)},
}  # fmt: skip


@pytest.mark.parametrize("name", SLIDERS)
def test_sliders_have_ends_and_begin_at_the_scene(name):
    lattice = Lattice(3, "uniform", k=550.0) if name == "bent" else Lattice(5)
    panel = Panel(SCENE if name == "bent" else PRESSED, 2, lattice)
    found = {key: (slider.low, slider.high, slider.value) for key, slider in panel.sliders.items()}
    assert found.keys() == (EVEN | SLIDERS[name]).keys()
    for key, known in (EVEN | SLIDERS[name]).items():
        assert found[key] == pytest.approx(known), key
    turned = {"angle": 0.5, "loads": 2.0} if name == "woven" else {}
    moved = panel.read(query_of(panel, **turned)).scene
    assert name == "bent" or (moved.material.angle, moved.loads[0].last_factor) == (0.5, 2.0)
    assert 10 * largest_count(SCENE.sheet.replace(length_y=10 * SCENE.sheet.length_x), 32) ** 2 <= 32 * 32


def test_answers_are_those_of_compare(address, panel):
    values = {"grid": 5, "elements": 3, "thickness": 0.0025, "curvature_x0": 3.0, "gravity": 0.5}
    question = query_of(panel, 7, **values)
    (_, lattice), (_, shell) = (posted(address, of, question) for of in ("lattice", "shell"))
    weight = tuple(0.5 * g for g in SCENE.gravity.acceleration)
    bent = [s.replace(curvature=3.0) if s.kind == "curved" else s for s in SCENE.supports]
    scene = SCENE.replace(thickness=0.0025, gravity={"acceleration": weight}, supports=bent)
    both = sb.compare(scene, grid=5, calibration="consistent", elements=3, uncertainty=False)
    assert (lattice["number"], shell["number"]) == (7, 7)
    for message, solution in zip((lattice, shell), both.solutions, strict=True):
        assert message["status"] == solution.status == "converged" and message["seconds"] > 0.0
        for name, u in both.probes(solution).items():
            np.testing.assert_allclose(message["probes"][name], u, rtol=1e-9, atol=1e-12)
    assert shell["error"] == pytest.approx(both.error(both.solutions[0]), rel=1e-6)
    places = both.solutions[0].mesh.points[:, :2]
    coarse, fine = (solution.displacement(places) for solution in both.solutions)
    shown = np.frombuffer(b64decode(shell["difference"]["float32"]), "<f4")
    np.testing.assert_allclose(shown, np.linalg.norm(coarse - fine, axis=1), rtol=1e-5, atol=1e-9)


def test_there_is_no_error_where_the_lattice_has_no_answer(panel, monkeypatch):
    question = panel.read(query_of(panel, 0))
    found = replace(server.solve_lattice(question), status=Status.DIVERGED)
    monkeypatch.setattr(server, "solve_lattice", lambda *_: found)
    assert server.shell(question)["error"] is None


def test_what_does_not_go_together_is_refused_and_the_page_goes_on(address, panel):
    status, document = posted(address, "lattice", "{")
    assert status == 400 and document["said"].startswith("no question: Invalid JSON")
    assert posted(address, "solid", query_of(panel))[0] == 404
    status, document = posted(address, "lattice", query_of(panel, 2, calibration="uniform", grading=0.3))
    assert status == 400 and "cells of one size" in document["said"]
    assert posted(address, "lattice", query_of(panel, 3))[1]["number"] == 3


def test_a_fault_of_the_program_is_told_and_the_page_goes_on(address, panel, monkeypatch, capsys):
    monkeypatch.setitem(server.SOLVERS, "lattice", lambda *_: 1 / 0)
    status, document = posted(address, "lattice", query_of(panel, 4))
    assert status == 500 and "a fault of the program" in document["said"]
    assert "ZeroDivisionError" in capsys.readouterr().err
    monkeypatch.undo()
    assert posted(address, "lattice", query_of(panel, 4))[0] == 200


def test_a_question_that_is_too_long_is_not_read(address):
    for length in (str(MESSAGE + 1), "-1", "1e3", "٣".encode().decode("latin-1"), "9" * 30, "9" * 5000):
        headers = {"Content-Length": length}
        assert got(address, urlsplit(address).path + "lattice", b"{}", **headers).status == 413, length


def test_few_connections_are_open_at_once(address):
    place = urlsplit(address)
    patience = server.RequestHandler.timeout / 2  # s: those that are let in are closed by silence, later
    with ExitStack() as opened:
        idle = [
            opened.enter_context(socket.create_connection((place.hostname, place.port), patience))
            for _ in range(2 * CONNECTIONS)
        ]
        assert [one.recv(1) for one in idle[-CONNECTIONS // 2 :]] == [b""] * (CONNECTIONS // 2)


def test_no_command_line_has_the_secret_address(capsys, monkeypatch):
    """The browser's had it, which every user of the machine can read."""
    seen = {}

    def browse(given):
        file = Path(unquote(urlsplit(given).path))
        seen.update(given=given, text=file.read_text(), mode=stat.S_IMODE(file.stat().st_mode))

    monkeypatch.setattr(webbrowser, "open", browse)
    monkeypatch.setattr(server.secrets, "token_urlsafe", lambda size: "secret")
    monkeypatch.setattr(server.Server, "serve_forever", lambda server: None)
    assert run("live", "two-edges-clamped") == 0
    assert seen["given"].startswith("file:///") and "secret" not in seen["given"]
    assert 'content="0;url=http://127.0.0.1:' in seen["text"] and '/secret/"' in seen["text"]
    assert seen["mode"] == 0o600 and not Path(urlsplit(seen["given"]).path).exists()
    assert "/secret/" in capsys.readouterr().out  # for who has no browser here


def test_it_ends_by_ctrl_c():
    terminal = Terminal(COMMAND, "live", "two-edges-clamped", "--no-browser")
    terminal.wait_for("Ctrl-C ends it")
    address = terminal.shown.split()[0]
    assert got(address, urlsplit(address).path + "panel").status == 200
    terminal.press(b"\x03")
    assert terminal.end() == 130
    assert "nothing was kept" not in terminal.shown and "the server has stopped" in terminal.shown
    assert "Traceback" not in terminal.shown and "http://127.0.0.1:" in terminal.shown


# ---- in a browser
PLACES = "Array.from(live.viewer.sheets.get('lattice').positions.array)"


@pytest.fixture(scope="module")
def served():
    with serving(Panel(sb.load("two-edges-clamped"), 2, Lattice(3))) as found:
        yield found


@pytest.fixture(scope="module")
def page(browser, served):  # noqa: F811
    with opened(browser, served, offline=False) as (found, watch):
        until(found, ANSWERED)
        yield found, watch


def cell(page, fact, model):
    return page.inner_text(f"[data-fact^='{fact}'] [data-model={model}]")


def test_dragging_moves_the_lattice_and_the_shell_follows(page, served):
    page, watch = page
    assert watch.requests and all(url.startswith(served) for url in watch.requests)
    before = page.evaluate(PLACES), cell(page, "Largest", "lattice"), cell(page, "Largest", "shell")
    number = page.evaluate("live.asked()")
    box = page.locator("#slider-young").bounding_box()
    across, height = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(across, height)
    page.mouse.down()
    for step in range(8):
        page.mouse.move(across - 10 * step, height)
    page.mouse.up()
    until(page, ANSWERED)
    after = page.evaluate(PLACES), cell(page, "Largest", "lattice"), cell(page, "Largest", "shell")
    assert page.evaluate("live.asked()") > number + 3
    assert min(after[0][2::3]) < 1.1 * min(before[0][2::3])  # softer: it hangs lower
    assert all(float(new) > 1.1 * float(old) for new, old in zip(after[1:], before[1:], strict=True))
    assert cell(page, "Status", "lattice") == cell(page, "Status", "shell") == "converged"
    assert page.inner_text("#error").endswith(" %")
    assert page.evaluate("live.latencies.length") > 0
    assert watch.troubles == []


def test_values_are_typed_in_the_units_of_the_box_or_in_others(page):
    page, _ = page
    box = page.locator(".slider:has(#slider-young) input[type=text]")
    start = box.input_value()
    for text, shown in (("60 MPa", "60"), ("0,08 GPa", "80"), ("9e7 Pa", "90"), (start, start)):
        box.fill(text)
        box.press("Enter")
        assert (box.input_value(), page.inner_text("#refused")) == (shown, ""), text
    for text, said in (("2 GPa", "2000 MPa is beyond this page"), ("3 mm", "cannot be read")):
        box.fill(text)
        box.press("Enter")
        assert said in page.inner_text("#refused") and "Pa" in page.inner_text("#refused")
        assert box.input_value() == start
    box.fill("")
    box.press("Enter")
    assert box.input_value() == start
    box.fill(f"{start} MPa")
    box.press("Enter")
    until(page, ANSWERED)


def test_a_grid_by_keys_is_drawn(page):
    page, watch = page
    page.locator("#slider-grid").focus()
    for _ in range(2):
        page.keyboard.press("ArrowRight")
    until(page, ANSWERED)
    assert len(page.evaluate(PLACES)) == 3 * 5 * 5 * 2
    assert watch.troubles == []
