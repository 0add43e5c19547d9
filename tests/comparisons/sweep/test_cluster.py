"""Campaigns on a cluster: lost workers and schedulers, Ctrl-C."""

import subprocess
import sys
from pathlib import Path
from threading import Thread

import campaign_tasks
import pytest
from campaigns import interrupt_when, rows_in, task
from distributed import LocalCluster

from comparisons.sweep import executors
from comparisons.sweep.campaign import carry_out
from comparisons.sweep.executors import pool_of
from sheetbench.errors import BadInput

HERE = Path(campaign_tasks.__file__).parent


@pytest.fixture(autouse=True)
def hurried(monkeypatch):
    monkeypatch.setattr(executors, "PATIENCE", 1.0)


def cluster(workers):
    return LocalCluster(n_workers=workers, processes=False, dashboard_address=None, protocol="tcp")


def test_a_cluster_without_workers_is_said_in_a_line():
    refused = pytest.raises(BadInput, match="no scheduler there with a worker")
    with cluster(0) as local, refused, pool_of(local.scheduler_address):
        pass


def test_a_campaign_on_a_cluster_obeys_ctrl_c(store):
    begun: list[object] = []
    interrupting = Thread(target=interrupt_when, args=(lambda: bool(begun),))
    interrupting.start()
    runs = [task("square", x=2.0, seconds=1.0)]
    with cluster(1) as local, pool_of(local.scheduler_address) as pool, pytest.raises(KeyboardInterrupt):
        carry_out(runs, store, pool=pool, progress=begun.append)
    interrupting.join()


def test_a_lost_scheduler_is_said_and_the_rows_are_kept(store):
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
        with pool_of(address) as pool, pytest.raises(BadInput, match="connection to the cluster was lost"):
            carry_out(runs, store, pool=pool, progress=lambda progress: far.kill() if progress.done else None)
    assert len(rows_in(store.path)) == 1
