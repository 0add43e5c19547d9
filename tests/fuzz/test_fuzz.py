"""An exit status, words and numbers as documented, and no file but where it was requested.

Some 160 examples, the same ones every time; `make fuzz` draws 24 000 others (`fuzz.long`).
"""

import pytest
from fuzz import trials
from fuzz.grammar import command_lines, measured, shaped, sound, texts
from hypothesis import HealthCheck, Phase, given, settings

pytestmark = pytest.mark.smoke

TRIALS = {  # how many examples of what, and what is done with each
    "a scene's file is read or refused in a line": (100, texts(), trials.reads),
    "a scene is checked and written only where asked": (10, texts(), trials.checks),
    "a sound scene is solved and what converges is in balance": (10, sound(), trials.compares),
    "a scene of shapes is refused or solved in balance": (20, shaped(), trials.solves_shapes),
    "a command line is obeyed or refused": (10, command_lines(), trials.obeys),
    "a measured file is read or refused": (10, measured(), trials.measures),
}


@pytest.mark.parametrize("what", TRIALS)
def test_it_ends_as_documented(tmp_path, what):
    examples, drawn, trial = TRIALS[what]
    same = settings(
        max_examples=examples,
        derandomize=True,
        database=None,
        print_blob=True,
        deadline=None,
        suppress_health_check=list(HealthCheck),
        phases=(Phase.explicit, Phase.generate),
    )

    @same
    @given(drawn)
    def each(example):
        trial(tmp_path, example)

    each()
