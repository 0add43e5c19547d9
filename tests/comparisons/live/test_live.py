"""`sheetbench live`: who is let in, what is refused, that the newest question counts, compare's answers."""

import asyncio
import gc
import http.client
import json
import signal
import socket
import stat
import threading
import webbrowser
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from urllib.parse import unquote, urlsplit

import numpy as np
import pytest
from commands import run
from live_server import hear, serving, talking
from terminals import COMMAND, Terminal
from websockets.asyncio.connection import Connection
from websockets.exceptions import ConnectionClosed, InvalidStatus

import sheetbench as sb
from comparisons.cli import interruption
from comparisons.live import answers, server
from comparisons.live.panel import ELEMENTS_CAP, MASSES_CAP, Panel, most
from comparisons.live.server import MESSAGE
from comparisons.live.session import Newest, Session
from comparisons.models.spec import Lattice
from sheetbench.errors import BadInput

SCENE = sb.load("curved-edge")


@pytest.fixture(scope="module")
def panel():
    return Panel(SCENE, 2, Lattice(3))


@pytest.fixture(scope="module")
def address(panel):
    with serving(panel) as found:
        yield found


def asked(panel, number=1, calibration="consistent", **values):
    start = {name: slider.value for name, slider in panel.sliders.items()}
    return json.dumps({"number": number, "values": start | values, "calibration": calibration})


def got(address, path, **headers):
    """The answer to a request of a path, with headers of one's own in place of the usual ones."""
    place = urlsplit(address)
    connection = http.client.HTTPConnection(place.netloc, timeout=20)
    connection.putrequest("GET", path, skip_host=True)
    for name, value in {"Host": place.netloc, **headers}.items():
        connection.putheader(name, value)
    connection.endheaders()
    return connection.getresponse()


def test_the_page_is_there_with_a_policy(address):
    answer = got(address, urlsplit(address).path)
    assert answer.status == 200 and b"sheetbench live" in answer.read()
    assert "default-src 'none'" in answer.headers["Content-Security-Policy"]
    assert "unsafe" not in answer.headers["Content-Security-Policy"]
    assert answer.headers["Referrer-Policy"] == "no-referrer"


@pytest.mark.parametrize(
    "path", ["/", "/wrong/", "/socket", "/%2e%2e/", "//", "//[", "/[?]", "http://127.0.0.1/"]
)
def test_without_the_token_nothing_is_answered(address, path):
    assert got(address, path).status == 403


@pytest.mark.parametrize(
    "name", ["../pyproject.toml", "%2e%2e/x", "..%2f..%2fetc/passwd", "/etc/passwd", "live.html", "models.py"]
)
def test_no_path_leads_to_a_file(address, name):
    assert got(address, urlsplit(address).path + name).status == 404


def test_a_foreign_host_or_origin_is_refused(address):
    place = urlsplit(address)
    assert got(address, place.path, Host="evil.example").status == 421
    assert got(address, place.path, Host=f"evil.example:{place.port}").status == 421
    assert got(address, place.path, Origin="http://evil.example").status == 403
    for origin in (None, "null", "http://evil.example", f"https://{place.netloc}", "http://127.0.0.1:1"):
        with pytest.raises(InvalidStatus) as refused, talking(address, origin=origin):
            pass
        assert refused.value.response.status_code == 403


def test_it_listens_on_the_loopback_alone(address):
    with pytest.raises(OSError):
        socket.create_connection(
            (socket.gethostbyname(socket.gethostname()), urlsplit(address).port), 1
        ).close()
        if socket.gethostbyname(socket.gethostname()).startswith("127."):
            raise OSError("this machine knows itself by the loopback only")


def test_a_given_k_has_a_slider_and_goes_with_the_calibrations_that_take_it():
    panel = Panel(SCENE, 2, Lattice(3, "uniform", k=550.0, layer_distance=0.002))
    lattices = [panel.read(asked(panel, 1, name, k=600.0)).lattice for name in ("uniform", "consistent")]
    assert [(one.k, one.layer_distance) for one in lattices] == [(600.0, 0.002), (None, 0.002)]
    assert "k" not in Panel(SCENE, 2).sliders
    with pytest.raises(BadInput, match="near-square"):
        Panel(SCENE, 2, Lattice("3x9"))


@pytest.mark.parametrize(("message", "said"), [
    ({"grid": MASSES_CAP + 1}, "grid = 34: from 3 to 33"),
    ({"grid": 4.5}, "grid = 4.5: a whole number"),
    ({"elements": ELEMENTS_CAP + 1}, "elements = 17"),
    ({"young": float("nan")}, "NaN: not a finite number"),
    ({"young": float("inf")}, "Infinity: not a finite number"),
    ({"young": "5e7"}, "young: a finite number is needed"),
    ({"young": True}, "young: a finite number is needed"),
    ({"young": 10**400}, "young: a finite number is needed"),
    ({"young": -1.0}, "young = -1: from"),
    ({"weight": 1.0}, "values: weight"),
    ({"calibration": "magic"}, "calibration: choose from consistent"),
    ({"calibration": []}, "calibration: choose from consistent"),
    ({"calibration": {}}, "calibration: choose from consistent"),
    ("[" * 4000, "no JSON"),
    ("1e999", "not a question"),
    (b"\xff", "no JSON"),
], ids=str)  # fmt: skip
def test_a_question_beyond_the_bounds_is_refused_in_a_line(panel, message, said):
    text = asked(panel, **message) if isinstance(message, dict) else message
    with pytest.raises(BadInput) as refused:
        panel.read(text)
    assert said in str(refused.value) and "\n" not in str(refused.value)


def test_a_number_that_overflows_is_refused(panel):
    with pytest.raises(BadInput, match="young"):
        panel.read(asked(panel, young=0.0).replace('"young": 0.0', '"young": 1e999'))


def test_a_narrow_sheet_gets_no_more_masses_than_a_square_one():
    strip = SCENE.sheet.replace(length_y=10 * SCENE.sheet.length_x)
    assert most(SCENE.sheet, 32) == 32
    n = most(strip, 32)
    assert 10 * n * n <= 32 * 32 < 10 * (n + 1) ** 2


def test_answers_are_those_of_compare(address, panel):
    values = {"grid": 5, "thickness": 0.0025, "curvature_x0": 3.0, "gravity": 0.5}
    with talking(address) as page:
        hear(page, lambda m: m["kind"] == "ready")
        page.send(asked(panel, 7, **values))
        lattice, shell = hear(page, lambda m: m["kind"] == "shell")
    scene = sb.load("curved-edge")
    weight = tuple(0.5 * g for g in scene.gravity.acceleration)
    bent = [s.replace(curvature=3.0) if s.kind == "curved" else s for s in scene.supports]
    scene = scene.replace(
        sheet=scene.sheet.replace(thickness=0.0025),
        gravity=scene.gravity.replace(acceleration=weight),
        supports=tuple(bent),
    )
    both = sb.compare(scene, grid=5, calibration="consistent", elements=2, uncertainty=False)
    assert (lattice["number"], shell["number"]) == (7, 7)
    for message, solution in zip((lattice, shell), both.solutions, strict=True):
        assert message["status"] == solution.status == "converged"
        for name, u in both.probes(solution).items():
            np.testing.assert_allclose(message["probes"][name], u, rtol=1e-9, atol=1e-12)
    assert shell["error"] == pytest.approx(both.error(both.solutions[0]), rel=1e-6)


def test_springs_and_scene_can_be_had_as_text(address, panel):
    with talking(address) as page:
        hear(page, lambda m: m["kind"] == "ready")
        for of in ("springs", "scene"):
            page.send(json.dumps({**json.loads(asked(panel, young=2e6)), "copy": of}))
        springs, scene = (m["text"] for m in hear(page, lambda m: m.get("of") == "scene"))
    changed = SCENE.replace(material=SCENE.material.replace(young=2e6))
    expected = sb.calibrate(changed, grid=3)
    assert f"axial = {expected.document()['springs']['axial']!r}" in springs
    assert springs.startswith("[springs]\ngrid = [3, 3, 2]") and "young = 2e6" in scene


def test_what_does_not_go_together_is_refused_and_the_page_goes_on(address, panel):
    with talking(address) as page:
        hear(page, lambda m: m["kind"] == "ready")
        page.send("{")
        page.send(asked(panel, 2, calibration="uniform", grading=0.3))
        page.send(asked(panel, 3))
        told = hear(page, lambda m: m["kind"] == "shell")
    refused = {m["number"]: m["said"] for m in told if m["kind"] == "refused"}
    assert refused[None] == "not a question: no JSON"
    assert 2 not in refused or "cells of one size" in refused[2]  # where it was not overtaken
    assert told[-1]["number"] == 3


def test_a_question_that_is_overtaken_is_dropped():
    async def story():
        newest: Newest[int] = Newest()
        for number in (1, 2, 3):
            newest.put(number)
        first = await newest.get()
        newest.put(4)
        return [first, await newest.get()]

    assert asyncio.run(story()) == [3, 4]


def test_dragging_is_answered_in_order_and_ends_with_the_newest(address, panel):
    count = 40
    with talking(address) as page:
        hear(page, lambda m: m["kind"] == "ready")
        for number in range(count):
            page.send(asked(panel, number, gravity=number / count))
        told = hear(page, lambda m: m["kind"] == "shell" and m["number"] == count - 1)
    for kind in ("lattice", "shell"):
        numbers = [m["number"] for m in told if m["kind"] == kind]
        assert numbers == sorted(set(numbers)) and numbers[-1] == count - 1
    assert sum(m["kind"] == "shell" for m in told) < count


def test_a_message_that_is_too_long_ends_the_conversation(address):
    with talking(address) as page:
        page.send("x" * (MESSAGE + 1))
        with pytest.raises(Exception, match="1009"):
            hear(page, lambda m: False)


def test_no_command_line_has_the_secret_address(capsys, monkeypatch):
    """The browser's had it, which every user of the machine can read."""
    told = {}

    def browse(given):
        file = Path(unquote(urlsplit(given).path))
        told.update(given=given, text=file.read_text(), modes=[p.stat().st_mode for p in (file, file.parent)])

    monkeypatch.setattr(webbrowser, "open", browse)
    monkeypatch.setattr(server, "run", lambda panel, port, opened: opened("http://127.0.0.1:1/secret/"))
    assert run("live", "two-edges-clamped") == 0
    assert told["given"].startswith("file:///") and "secret" not in told["given"]
    assert 'content="0;url=http://127.0.0.1:1/secret/"' in told["text"]
    assert [stat.S_IMODE(mode) for mode in told["modes"]] == [0o600, 0o700]
    assert not Path(urlsplit(told["given"]).path).parent.exists()
    assert "http://127.0.0.1:1/secret/" in capsys.readouterr().out  # for who has no browser here


def test_it_ends_by_ctrl_c():
    terminal = Terminal(COMMAND, "live", "two-edges-clamped", "--no-browser")
    terminal.wait_for("Ctrl-C ends it")
    with talking(terminal.shown.split()[0]) as page:
        hear(page, lambda m: m["kind"] == "ready")
        terminal.press(b"\x03")
    assert terminal.end() == 130
    assert "nothing was kept" not in terminal.shown and "the server has stopped" in terminal.shown
    assert "Traceback" not in terminal.shown and "http://127.0.0.1:" in terminal.shown


def test_an_interrupt_in_the_midst_of_a_send_is_no_fault(panel, monkeypatch, caplog):
    async def interrupted(session, document):
        monkeypatch.setattr(Connection, "send_data", struck)
        await say(session, document)

    def struck(connection):
        monkeypatch.setattr(Connection, "send_data", send)
        signal.raise_signal(signal.SIGINT)
        send(connection)

    def visit(address):
        with suppress(ConnectionClosed), talking(address) as page:
            hear(page, lambda message: False)

    say, send = Session._say, Connection.send_data
    monkeypatch.setattr(interruption, "PATIENCE", 600.0)  # on a busy machine too, this process goes on
    monkeypatch.setattr(Session, "_say", interrupted)
    with interruption.heeded(), pytest.raises(KeyboardInterrupt):
        server.run(panel, 0, lambda address: threading.Thread(target=visit, args=(address,)).start())
    gc.collect()  # a task whose exception nobody took says so when it goes
    assert not caplog.records


def test_a_drawn_sheet_with_fibres_has_their_sliders_and_is_compared_where_it_is():
    """Masses beyond a rim are compared at the nearest point of the sheet."""
    fibres = {"kind": "orthotropic", "young_1": 1e8, "young_2": 2e7, "poisson_12": 0.3, "shear_12": 8e6}
    scene = sb.load("one-edge-clamped").replace(
        outline=[(0.0, 0.0), (0.188, 0.05), (0.188, 0.14), (0.0, 0.188)],
        material={**fibres, "density": 1e3},
        patches=[
            {"shape": {"circle": {"centre": (0.05, 0.09), "radius": 0.02}}, "young": 1e9, "poisson": 0.3}
        ],
        loads=[{"kind": "area", "force_per_area": (0.0, 0.0, 1.0)}],
    )
    panel = Panel(scene, elements=2, lattice=Lattice(5))
    assert {"young_1", "young_2", "angle", "patch1.young", "loads"} <= set(panel.sliders)
    assert "uniform" not in panel.calibrations
    question = panel.first()
    moved = panel.scene_of(replace(question, values={**question.values, "angle": 0.5, "loads": 2.0}))
    assert moved.material.angle == 0.5 and moved.loads[0].force_per_area[2] == 2.0
    found = answers.lattice(moved, question)
    assert answers.compared(found, answers.shell(moved, question, found.masses))["error"] < 0.2
