"""Campaigns on a cluster: lost workers and schedulers, patience, Ctrl-C."""

import subprocess
import sys
from pathlib import Path
from threading import Thread

import campaign_tasks
import pytest
from campaigns import interrupt_when, rows_in, task
from distributed import LocalCluster

from comparisons.sweep import campaign as runs_campaign
from comparisons.sweep import executors
from comparisons.sweep.campaign import carry_out
from comparisons.sweep.executors import Cluster, pool_of
from sheetbench.errors import BadInput

HERE = Path(campaign_tasks.__file__).parent


def test_no_scheduler_is_said_in_a_line():
    with pytest.raises(BadInput, match=r"--scheduler = 'tcp://127\.0\.0\.1:9'"):
        Cluster("tcp://127.0.0.1:9")


@pytest.fixture
def lonely(monkeypatch):
    """A cluster whose only worker is in this process; patience ends quickly."""
    monkeypatch.setattr(executors, "PATIENCE", 0.5)
    monkeypatch.setattr(runs_campaign, "POLL", 0.1)
    with LocalCluster(
        n_workers=1, threads_per_worker=1, processes=False, dashboard_address=None, protocol="tcp"
    ) as local:
        yield local


def test_without_workers_a_campaign_stops_in_a_line_and_keeps_its_rows(store, lonely):
    runs = [task("square", x=float(x)) for x in range(6)]
    with pool_of(lonely.scheduler_address) as pool:
        carry_out(runs[:2], store, pool=pool)
        lonely.scale(0)
        with pytest.raises(BadInput, match=r"no worker for 0\.5 s; finished runs are kept"):
            carry_out(runs, store, pool=pool)
    assert len(rows_in(store.path)) == 2


def test_a_patient_campaign_says_that_it_waits_and_goes_on(store, lonely):
    said: list[str] = []

    def say(text):
        said.append(text)
        lonely.scale(1)

    with pool_of(lonely.scheduler_address, True, say) as pool:
        lonely.scale(0)
        found = carry_out([task("square", x=2.0)], store, pool=pool)
    assert found[0].row["square"] == 4.0
    assert len(said) == 1 and "no worker for 0.5 s; waiting" in said[0]


def test_a_patient_campaign_obeys_ctrl_c(store, lonely):
    said: list[str] = []
    interrupting = Thread(target=interrupt_when, args=(lambda: bool(said),))
    interrupting.start()
    with pool_of(lonely.scheduler_address, True, said.append) as pool:
        lonely.scale(0)
        with pytest.raises(KeyboardInterrupt):
            carry_out([task("square", x=2.0)], store, pool=pool)
    interrupting.join()


def test_a_lost_scheduler_is_said_and_the_rows_are_kept(store, monkeypatch):
    monkeypatch.setattr(executors, "PATIENCE", 0.5)
    code = (
        "import sys, time; sys.path.insert(0, sys.argv[1]); import campaign_tasks\n"
        "from distributed import LocalCluster\n"
        "if __name__ == '__main__':\n"
        "    print(LocalCluster(n_workers=1, processes=False, dashboard_address=None, protocol='tcp')"
        ".scheduler_address, flush=True)\n"
        "    time.sleep(600)\n"
    )
    with subprocess.Popen([sys.executable, "-c", code, str(HERE)], stdout=subprocess.PIPE, text=True) as far:
        assert far.stdout is not None
        address = far.stdout.readline().strip()
        runs = [task("square", x=1.0), task("square", x=2.0, seconds=600.0)]
        with pool_of(address) as pool, pytest.raises(BadInput, match=r"no scheduler for .* are kept"):
            carry_out(runs, store, pool=pool, progress=lambda progress: far.kill() if progress.done else None)
    assert len(rows_in(store.path)) == 1


@pytest.mark.nightly
def test_dask_cluster_loses_a_worker_mid_run_and_finishes(store, tmp_path):
    task_file = str(HERE / "campaign_tasks.py")
    with LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, preload=[task_file]
    ) as local:
        runs = [task("die_once", x=x, folder=str(tmp_path), victim=3) for x in range(8)]
        with pool_of(local.scheduler_address) as pool:
            found = carry_out(runs, store, workers=2, pool=pool)
    assert [outcome.row["x"] for outcome in found] == list(range(8))
    assert found[3].row["process"] != int((tmp_path / "died").read_text(encoding="utf-8"))
