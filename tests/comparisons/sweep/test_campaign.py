"""Campaigns: each run carried out once and kept at once, through failures, dead workers and kill -9."""

import os
import signal
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from threading import Thread

import campaign_tasks
import pytest
from campaigns import Serial, alive, interrupt_when, rows_in, task, wait_for
from limits import at_most

from comparisons.sweep import campaign as runs_campaign
from comparisons.sweep.campaign import Progress, Run, campaign, carry_out, execute
from comparisons.sweep.store import FILE, Finished
from sheetbench.errors import BadInput
from sheetbench.sources import digest, source

pytestmark = pytest.mark.smoke

HERE = Path(campaign_tasks.__file__).parent


def test_outcomes_come_in_the_order_asked_and_are_kept(store):
    seen: list[Progress] = []
    runs = [task("square", x=x) for x in (3.0, 1.0, 2.0, 3.0)]
    found = carry_out(runs, store, workers=2, progress=seen.append)
    assert [outcome.row["square"] for outcome in found] == [9.0, 1.0, 4.0, 9.0]
    assert [(p.done, p.total) for p in seen if p.status == "done"] == [(1, 3), (2, 3), (3, 3)]
    assert seen[-1].seconds_left == 0.0
    going = [len(p.going) for p in seen if p.status != "done"]
    assert going in ([1, 2, 2], [1, 2, 1]) and not seen[-1].going  # the first two may end at once
    seen.clear()
    assert carry_out(runs, store, pool=pytest.fail, progress=seen.append) == found
    assert not seen


def test_the_key_is_what_is_asked_and_the_code_that_answers(monkeypatch):
    """After a fix yesterday's rows are not read: they are of other code."""
    assert task("square", x=1.0).key == Run("campaign_tasks:square", {"x": 1.0}, "other", timed=True).key
    assert task("square", x=1.0).key != task("square", x=2.0).key
    assert task("square", x=(1, 2)).key == task("square", x=[1, 2]).key
    before = task("square", x=1.0).key
    monkeypatch.setattr(runs_campaign, "source", lambda: "other code")
    assert task("square", x=1.0).key != before


def test_the_source_digest_sees_names_and_contents(tmp_path):
    one, other = tmp_path / "one.py", tmp_path / "other.py"
    one.write_text("x = 1")
    other.write_text("x = 2")
    digests = {digest(files) for files in ({"a": one}, {"b": one}, {"a": other}, {"a": one, "b": one})}
    assert len(digests) == 4
    assert source() == source() and len(source()) == 16


def test_other_code_in_the_worker_is_a_failure_and_not_an_answer():
    outcome = execute("a key of other code", "campaign_tasks:square", {"x": 1.0})
    assert outcome.status == "failed" and "another version" in outcome.message


def test_a_run_that_fails_is_a_row_and_a_fault_not_filed_as_the_users_mistake(store):
    found = carry_out([task(name) for name in ("refuse", "fail", "not_finite")], store, pool=Serial)
    refusal, fault = "x = −1: must be positive", "ZeroDivisionError: by nothing"
    ends = [("refused", refusal), ("failed", fault), ("done", found[2].message)]
    assert [(outcome.status, outcome.message) for outcome in found] == ends
    assert found[2].row == {"value": None}
    found = carry_out(
        [task("stumble", over=over) for over in ("value", "type", "matrix")], store, pool=Serial
    )
    for outcome, kind in zip(found, ("ValueError", "TypeError", "LinAlgError"), strict=True):
        assert outcome.status == "failed" and outcome.message.startswith(f"{kind}: ")
        assert "in stumble" in outcome.row["traceback"]


def test_what_has_not_enough_memory_is_lost_and_no_fault(store):
    (found,) = carry_out([task("stumble", over="memory")], store, pool=Serial)
    assert (found.status, found.row) == ("lost", {}) and found.message.startswith("not enough memory: ")


def test_an_interrupt_within_compiled_code_is_no_outcome(store):
    with pytest.raises(KeyboardInterrupt):
        carry_out([task("interrupted")], store, pool=Serial)
    assert not rows_in(store.path)


def test_what_failed_is_done_again_only_when_asked(store, tmp_path):
    runs = [task("square", x=1.0), task("needs", path=str(tmp_path / "file"))]
    first = carry_out(runs, store, pool=Serial)
    assert [outcome.status for outcome in first] == ["done", "failed"]
    (tmp_path / "file").touch()
    assert carry_out(runs, store, pool=pytest.fail) == first
    again = carry_out(runs, store, pool=Serial, retry=True)
    assert again[0] == first[0] and again[1].status == "done"


def test_a_run_that_takes_its_process_down_is_the_only_one_lost(store):
    first, *others = (task("square", x=x, seconds=0.6 / x) for x in (1.0, 2.0, 3.0))
    found = carry_out([first, task("die"), *others], store, workers=2)
    assert [outcome.status for outcome in found] == ["done", "lost", "done", "done"]
    assert "crashed" in found[1].message


def test_timed_runs_go_alone_and_on_one_thread(store, tmp_path):
    path, environment = str(tmp_path / "log"), dict(os.environ)
    timed = [Run("campaign_tasks:log", {"x": x, "path": path, "seconds": 0.05}, timed=True) for x in range(4)]
    untimed = [task("square", x=1.0, seconds=0.1), task("threads")]
    found = carry_out([*timed, *untimed], store, workers=2)
    lines = Path(path).read_text().split("\n")[:-1]
    assert lines == [line for x in range(4) for line in (f"start {x}", f"end {x}")]
    assert max(o.finished for o in found[4:]) <= min(o.started for o in found[:4])
    assert found[-1].row["threads"] == "1"
    assert dict(os.environ) == environment


GATED = """
import sys; sys.path.insert(0, {here!r})
from pathlib import Path
from comparisons.sweep.campaign import Run, campaign, carry_out
if __name__ == '__main__':
    runs = [Run('campaign_tasks:gated', {{'x': x, 'folder': {folder!r}}}) for x in range(8)]
    with campaign(Path({folder!r})) as store:
        carry_out(runs, store, workers=2)
"""


def test_kill_9_loses_nothing_that_had_finished_and_leaves_no_worker(tmp_path):
    file = tmp_path / "study.py"
    file.write_text(GATED.format(here=str(HERE), folder=str(tmp_path)), encoding="utf-8")

    def started():
        lines = (tmp_path / "started").read_text(encoding="utf-8").splitlines()
        return [[int(part) for part in line.split()] for line in lines]

    command = [sys.executable, str(file)]
    first = subprocess.Popen(command)
    wait_for(lambda: len(rows_in(tmp_path / FILE)) == 4 and len(started()) == 6)
    os.kill(first.pid, signal.SIGKILL)
    first.wait()
    kept = rows_in(tmp_path / FILE)
    assert len(kept) == 4
    workers = {process for _, process in started()}
    wait_for(lambda: not any(alive(process) for process in workers))  # they follow their parent

    (tmp_path / "gate").touch()
    subprocess.run(command, check=True)
    after = rows_in(tmp_path / FILE)
    assert len(after) == 8 and {key: after[key] for key in kept} == kept  # time stamps and all
    assert sorted(x for x, _ in started()) == [0, 1, 2, 3, 4, 4, 5, 5, 6, 7]


def changed(path, statement, *values):
    with closing(sqlite3.connect(path)) as database, database:
        database.execute(statement, values)


def overwritten(path, first):
    content = bytearray(path.read_bytes())
    content[first : first + 3000] = bytes(range(250)) * 12
    path.write_bytes(content)


ROW, CANNOT = "the row of a run of .* is damaged", "cannot be written"
DAMAGE: dict[str, tuple[Callable[[Path], object], str]] = {
    "text": (lambda path: path.write_text("not a database, but long enough" * 10), "not a database"),
    "half": (lambda path: path.write_bytes(path.read_bytes()[:6000]), "malformed|damaged"),
    "head": (lambda path: overwritten(path, 0), "not a database"),
    "middle": (lambda path: overwritten(path, 9000), "malformed|damaged"),
    "folder": (lambda path: (path.unlink(), path.mkdir()), CANNOT),
    "link": (lambda path: (path.rename(path.with_name("other")), path.symlink_to("other")), CANNOT),
    "schema": (
        lambda path: (path.unlink(), changed(path, "create table runs (key text, something text)")),
        "belongs to another program or version",
    ),
    "broken row": (lambda path: changed(path, "update runs set row = ?", '{"square": '), ROW),
    "empty row": (lambda path: changed(path, "update runs set row = ?", "{}"), ROW),
    "status": (lambda path: changed(path, "update runs set status = ?", "converged"), ROW),
}


@pytest.mark.sweep(2)
@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_file_is_refused_in_a_line_with_the_remedy_and_left_alone(tmp_path, damage):
    path, runs = tmp_path / FILE, [task("square", x=float(x)) for x in range(40)]
    with campaign(tmp_path) as store:
        for run in runs:
            found = {"square": run.arguments["x"] ** 2, "ballast": "x" * 400}
            store.add(run.task, run.arguments, Finished(run.key, "done", found, "", "", "", 0.0))
    spoil, said = DAMAGE[damage]
    spoil(path)
    before = path.read_bytes() if path.is_file() else None
    refused = pytest.raises(BadInput, match=f"{path}: .*({said}).*(move|is there)")
    with refused, campaign(tmp_path) as store:
        carry_out(runs, store, pool=pytest.fail)
    assert (path.read_bytes() if path.is_file() else None) == before


def test_a_file_that_another_program_uses_is_refused(tmp_path, monkeypatch):
    connect = sqlite3.connect
    monkeypatch.setattr(sqlite3, "connect", lambda path: connect(path, timeout=0.05))
    with campaign(tmp_path):
        pass
    other = connect(tmp_path / FILE)
    other.execute("begin exclusive")
    refused = pytest.raises(BadInput, match=r"database is locked; .* no other program's lock")
    with refused, campaign(tmp_path):
        pass
    other.close()


def test_a_full_disk_ends_a_campaign_in_a_line_and_loses_nothing(store):
    """A limit on file sizes stands for the disk."""
    runs = [task("ballast", x=x, size=20_000) for x in range(4)]
    carry_out(runs[:1], store, pool=Serial)
    refused = pytest.raises(BadInput, match=f"{store.path}: .*.* with room on the disk")
    with at_most(50_000), refused:
        carry_out(runs, store, pool=Serial)
    kept = rows_in(store.path)
    assert 1 <= len(kept) < 4
    found = carry_out(runs, store, pool=Serial)
    assert [outcome.row["x"] for outcome in found] == [0, 1, 2, 3]
    after = rows_in(store.path)
    assert {key: after[key] for key in kept} == kept


def test_two_campaigns_at_one_folder_do_not_meet(tmp_path):
    with campaign(tmp_path) as store:
        with pytest.raises(BadInput, match=f"{tmp_path}: another process writes here"):
            campaign(tmp_path).__enter__()
        carry_out([task("square", x=1.0)], store, pool=Serial)
    with campaign(tmp_path) as store:
        assert carry_out([task("square", x=1.0)], store, pool=pytest.fail)[0].status == "done"


def test_ctrl_c_is_obeyed_and_leaves_no_process(store, tmp_path):
    runs = [task("mark", x=x, folder=str(tmp_path), seconds=0.0 if x == 0 else 600.0) for x in range(2)]
    interrupting = Thread(target=interrupt_when, args=((tmp_path / "1.started").exists,))
    interrupting.start()
    with pytest.raises(KeyboardInterrupt):
        carry_out(runs, store, workers=1)
    interrupting.join()
    assert len(rows_in(store.path)) == 1
    process = int((tmp_path / "1.started").read_text() or 0)
    wait_for(lambda: not alive(process), 120.0)
