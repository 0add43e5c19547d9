"""`make fuzz`: the whole run of what is thrown at the program, seeded, and resumed where it was interrupted.

    python -m fuzz.long FOLDER [--scenes 20000] [--solved 1000] [--commands 1000] [--measured 2000]

Examples are drawn in batches, each from a seed of its own; a batch without a fault is a line of
FOLDER/fuzz-SEED.jsonl and not drawn again. A fault does not end the run: the example and what was said of it
stand in FOLDER/faults, the run ends with status 1, and the next draws its batch again, to see that it is
mended. At the end a table of counts, FOLDER/fuzz.md.
"""

import signal
import sys
import tempfile
import time
import traceback
import zlib
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import count
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st

from comparisons.sweep.manifest import made_with
from fuzz import record, trials
from fuzz.grammar import command_lines, measured, shaped, sound, texts

LONGEST = 300.0  # s of the processor that one example may take; the longest honest one takes a few
STILL = 3600.0  # s by the clock, for one that waits for ever
FAULT = "fault"


@dataclass(frozen=True)
class Kind:
    """What is thrown, how it is judged, how many are requested, in batches of what size, and which count."""

    title: str
    drawn: st.SearchStrategy[Any]
    trial: trials.Trial
    count: int
    batch: int
    counts: tuple[str, ...] = ("done", "refused", "not converged", FAULT)


KINDS = {
    "scenes": Kind("scenes' files read", texts(), trials.reads, 20_000, 500),
    "commands": Kind("command lines", command_lines(), trials.obeys, 1000, 50),
    "measured": Kind("measured files", measured(), trials.measures, 2000, 100),
    "shapes": Kind("scenes of shapes", shaped(), trials.solves_shapes, 5000, 250),
    "compared": Kind("scenes of shapes compared", shaped(), trials.compares_shapes, 300, 25),
    "solved": Kind(
        "sound scenes solved", sound(), trials.compares, 1000, 50, ("done", "not converged", FAULT)
    ),
}


class Hang(BaseException):
    """An example took longer than any honest one; not an Exception, which the program might catch."""


@contextmanager
def in_time() -> Iterator[None]:
    """A block that ends in `Hang` where it takes too long, whatever else the machine does."""

    def ring(*_: object) -> None:
        raise Hang(f"longer than {LONGEST:g} s of the processor, or {STILL:g} s by the clock")

    timers = {signal.ITIMER_PROF: (signal.SIGPROF, LONGEST), signal.ITIMER_REAL: (signal.SIGALRM, STILL)}
    for timer, (rings, seconds) in timers.items():
        signal.signal(rings, ring)
        signal.setitimer(timer, seconds)
    try:
        yield
    finally:
        for timer in timers:
            signal.setitimer(timer, 0.0)


def batch(name: str, number: int, base: int, faults: Path) -> dict[str, Any]:
    """One batch: how many examples became what, and the processor's time."""
    kind, words, clock = KINDS[name], Counter[str](), time.process_time()
    with tempfile.TemporaryDirectory() as place:

        @seed(zlib.crc32(f"{base} {name} {number}".encode()))
        @settings(
            max_examples=kind.batch,
            phases=(Phase.generate,),
            database=None,
            deadline=None,
            suppress_health_check=list(HealthCheck),
        )
        @given(kind.drawn)
        def each(example: Any) -> None:
            own = Path(place) / f"{words.total()}"
            own.mkdir()
            try:
                with in_time():
                    words[kind.trial(own, example)] += 1
            except (Exception, Hang):
                words[FAULT] += 1
                faults.mkdir(exist_ok=True)
                file = faults / f"{name}-{number}-{words.total()}.txt"
                report = f"{example!r}\n\n{traceback.format_exc()}"
                file.write_text(report, encoding="utf-8", errors="backslashreplace")

        each()
    return {"kind": name, "batch": number, "words": words, "seconds": time.process_time() - clock}


def table(done: list[dict[str, Any]], base: int) -> str:
    """Counts of every kind, in Markdown, with the machine and the date."""
    lines = ["| input | tried | accepted | refused | not converged | faults |", "|---|---|---|---|---|---|"]
    for name, kind in KINDS.items():
        words = sum((Counter(line["words"]) for line in done if line["kind"] == name), Counter[str]())
        counts = (words.total(), *(words[word] for word in ("done", "refused", "not converged", FAULT)))
        lines.append(f"| {kind.title} | " + " | ".join(str(count) for count in counts) + " |")
    minutes = sum(line["seconds"] for line in done) / 60
    return "\n".join([*lines, "", f"Seed {base}, {minutes:.0f} minutes of processor time. {made_with()}", ""])


def main() -> int:
    arguments = record.parse_arguments(__doc__, {name: kind.count for name, kind in KINDS.items()})
    done: list[dict[str, Any]] = []
    with record.opened(arguments.folder / f"fuzz-{arguments.seed}.jsonl", "batch") as found:
        for name, kind in KINDS.items():
            counted, wanted = 0, getattr(arguments, name)
            for number in count():
                if counted >= wanted:
                    break
                line = found.get(name, number)
                if line is None or FAULT in line["words"]:
                    line = batch(name, number, arguments.seed, arguments.folder / "faults")
                    found.add(line)
                done.append(line)
                counted += sum(line["words"].get(word, 0) for word in kind.counts)
                print(f"{name}: {counted}/{wanted} {dict(line['words'])}", file=sys.stderr)
    said = table(done, arguments.seed)
    (arguments.folder / "fuzz.md").write_text(said, encoding="utf-8")
    print(said)
    return int(any(FAULT in line["words"] for line in done))


if __name__ == "__main__":
    sys.exit(main())
