"""A small command line of every verb but `live`, and the files that some of them read."""

from pathlib import Path

MEASURED = "x,y,ux,uy,uz\n0.188,0.188,-0.0004,-0.0004,-0.0135\n0.094,0.094,0,0,-0.00245\n0.1,0.15,,,-0.0075\n"
ANSWERS = "case,probe,ux,uy,uz\n" + "".join(f"thick,P{n},0,0,{-5e-4 * n}\n" for n in (1, 2, 3, 4))
SEED, SETTLING = "two-edges-clamped", "two-edges-settling"
SMALL = {
    "new": ["new", "new.toml"],
    "check": ["check", SEED],
    "scenes": ["scenes"],
    "compare": ["compare", SEED, "--lumped", "3", "--elements", "2"],
    "calibrate": ["calibrate", SEED, "--grid", "3"],
    "identify": ["identify", SEED, "--measured", "measured.csv", "--lumped", "3"],
    "simulate": ["simulate", SETTLING, "--lumped", "3", "--duration", "0.02", "--every", "0.004"],
    "tradeoff": [
        *("tradeoff", SEED, "--lumped", "3", "--plate", "", "--shell", "2", "--solid", ""),
        *("--elements", "4", "--repeats", "1", "--workers", "1", "--out", "tradeoff"),
    ],
    "crosscheck": [
        *("crosscheck", SEED, "--lumped", "3,5", "--plate", "", "--shell", "2,3", "--solid", ""),
        *("--judges", "", "--workers", "1", "--out", "crosscheck"),
    ],
    "advise": ["advise", "one-edge-clamped", "--tolerance", "0.2"],
    "stability": [
        *("stability", SEED, "--lumped", "3", "--elements", "2", "--vary", "slenderness"),
        *("--vary", "time-step", "--workers", "1", "--out", "stability"),
    ],
    "verify": ["verify", "--case", "patch"],
    "modes": ["modes", SEED, "--lumped", "3", "--elements", "2", "--count", "3"],
    "schema": ["schema"],
    "suite": ["suite", "--suite", "modes"],
    "score": ["score", "answers.csv", "--case", "thick"],
    "linearise": ["linearise", "one-edge-clamped", "--lumped", "3", "--modes", "3"],
    "homogenise": ["homogenise", "equilateral", SEED],
    "report": ["report", "stability"],
    "study": ["study", "reproduction", "--part", "tables", "--elements", "2"],
}


def write_inputs(folder: Path) -> None:
    """Write what `identify` and `score` read."""
    (folder / "measured.csv").write_text(MEASURED, encoding="utf-8")
    (folder / "answers.csv").write_text(ANSWERS, encoding="utf-8")
