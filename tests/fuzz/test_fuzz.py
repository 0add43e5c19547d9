"""An exit status, words and numbers as documented, and no file but where it was requested."""

import os
import signal

import pytest
from fuzz import trials
from fuzz.grammar import command_lines, measured_files, shaped, sound, texts
from hypothesis import HealthCheck, Phase, given, seed, settings

pytestmark = pytest.mark.smoke

SEED, BATCH = os.environ.get("FUZZ", ""), 50
LONGEST = 300  # s of the processor that one example may take; the longest honest one takes a few
TRIALS = {  # how many examples of what by day, what is done with each, and how many batches of `make fuzz`
    "a scene's file is read or refused in a line": (100, texts(), trials.reads, 400),
    "a scene is checked and written only where asked": (10, texts(), trials.checks, 0),
    "a sound scene is solved and what converges is in balance": (10, sound(), trials.compares, 24),
    "a scene of shapes is refused or solved in balance": (20, shaped(), trials.solves_shapes, 100),
    "a command line is obeyed or refused": (10, command_lines(), trials.obeys, 20),
    "a measured file is read or refused": (10, measured_files(), trials.measures, 40),
}


def hang(*_):
    raise RuntimeError(f"longer than {LONGEST} s of the processor")


def tried(folder, drawn, trial, **how):
    """Draw examples, each in a folder of its own, and judge them."""
    held = dict(database=None, print_blob=True, deadline=None, phases=(Phase.explicit, Phase.generate))
    signal.signal(signal.SIGPROF, hang)

    @settings(**held, suppress_health_check=list(HealthCheck), **how)
    @given(drawn)
    def each(example):
        own = folder / str(len(list(folder.iterdir())))
        own.mkdir()
        signal.setitimer(signal.ITIMER_PROF, LONGEST)
        try:
            trial(own, example)
        finally:
            signal.setitimer(signal.ITIMER_PROF, 0.0)

    return each


@pytest.mark.parametrize("what", TRIALS)
def test_derandomised_trials_end_as_documented(tmp_path, what):
    examples, drawn, trial, _ = TRIALS[what]
    tried(tmp_path, drawn, trial, max_examples=examples, derandomize=True)()


@pytest.mark.skipif(not SEED, reason="make fuzz")
@pytest.mark.parametrize(
    ("what", "batch"), [(what, n) for what, (*_, batches) in TRIALS.items() if SEED for n in range(batches)]
)
def test_random_trials_end_as_documented(tmp_path, what, batch):
    _, drawn, trial, _ = TRIALS[what]
    seed(f"{SEED} {what} {batch}")(tried(tmp_path, drawn, trial, max_examples=BATCH))()
