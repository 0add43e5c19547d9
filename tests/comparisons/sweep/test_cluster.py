"""Campaigns on a cluster: how many runs at once, timed ones, lost workers and schedulers, Ctrl-C."""

import logging
import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from threading import Thread

import campaign_tasks
import pytest
from campaigns import interrupt_when, rows_in, task, wait_for
from distributed import LocalCluster

from comparisons.sweep import campaign, executors, load
from comparisons.sweep.campaign import carry_out
from comparisons.sweep.executors import pool_of
from sheetbench.errors import BadInput

HERE = Path(campaign_tasks.__file__).parent


@pytest.fixture(autouse=True)
def hurried(monkeypatch):
    monkeypatch.setattr(executors, "TIME_LIMIT", 1.0)
    monkeypatch.setattr(campaign, "CHECK_INTERVAL", 0.2)


def cluster(workers):
    alone = {"threads_per_worker": 1, "processes": False, "dashboard_address": None, "protocol": "tcp"}
    return LocalCluster(n_workers=workers, **alone)


@pytest.mark.parametrize(("workers", "at_once"), [(None, 6), (2, 2)])
def test_a_cluster_is_as_wide_as_its_workers_whatever_this_machine_is(store, monkeypatch, workers, at_once):
    """Counted by how many go on as each ends; one that comes later is used too."""
    monkeypatch.setattr(os, "cpu_count", lambda: 1)
    seen = []
    runs = [task("where", x=x, seconds=0.2) for x in range(24)]
    with cluster(5) as local, pool_of(local.scheduler_address) as pool:
        local.scale(6)
        carry_out(runs, store, pool=pool, workers=workers, progress=lambda now: seen.append(len(now.going)))
    assert max(seen) == at_once


def test_timed_runs_are_all_on_one_worker(store):
    runs = [replace(task("where", x=x, seconds=0.05), timed=True) for x in range(6)]
    with cluster(3) as local, pool_of(local.scheduler_address) as pool:
        found = [carry_out(some, store, pool=pool, workers=None) for some in (runs[:3], runs)]
    (worker,) = {one.row["worker"] for some in found for one in some}
    rows = [{"load_average": 0.0, "worker": worker}]
    assert load.warnings(rows) == [f"all times are of one worker of the cluster, {worker}"]
    assert "not of one machine" in load.warnings([*rows, {"load_average": 0.0}])[0]


@pytest.mark.parametrize("timed", [False, True])
def test_the_last_workers_death_ends_a_campaign_and_the_rows_are_kept(store, timed):
    """Of timed runs that of their worker, as others have other times."""
    runs = [replace(task("square", x=x, seconds=600.0 * x), timed=timed) for x in (0.0, 1.0)]
    environment = {**os.environ, "PYTHONPATH": str(HERE)}
    with cluster(0) as local:
        command = [sys.executable, "-m", "dask", "worker", local.scheduler_address, "--no-nanny"]
        with subprocess.Popen(command, env=environment, stderr=subprocess.DEVNULL) as far:
            try:
                wait_for(lambda: local.scheduler_info["workers"])
                lost = "worker of the timed runs, tcp.* is gone" if timed else "cluster has no worker left"
                refused = pytest.raises(BadInput, match=f"the {lost}; 1 of 2 runs are kept: run the same")
                with pool_of(local.scheduler_address) as pool, refused:
                    if timed:
                        assert pool.one_worker
                        local.scale(1)
                        wait_for(lambda: len(local.scheduler_info["workers"]) == 2)
                    carry_out(runs, store, pool=pool, progress=lambda now: far.kill() if now.done else None)
            finally:
                far.kill()
    assert len(rows_in(store.path)) == 1


def test_a_cluster_without_workers_is_said_in_a_line():
    refused = pytest.raises(BadInput, match="no scheduler there with a worker")
    with cluster(0) as local, refused, pool_of(local.scheduler_address):
        pass


def test_errors_of_its_libraries_do_not_repeat_the_line(caplog):
    """A callback's traceback, of a future that ends with the last worker, stood before the line."""
    with cluster(1) as local, pool_of(local.scheduler_address):
        for library in ("distributed", "distributed.client", "tornado.application"):
            logging.getLogger(library).error("Exception in callback")
    assert "Exception in callback" not in caplog.text


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
