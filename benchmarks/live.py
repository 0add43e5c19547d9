"""`sheetbench live` in Chromium: from moving a slider to the lattice drawn, and to the shell's answer.

    export PYTHONPATH=.:tests/helpers
    python benchmarks/live.py [SCENE] [--grid N] [--elements N] [--drags N] [--json FILE] [--picture FILE]

The slider of Young's modulus is dragged by the mouse, a step at a time, each after the lattice and the shell
have answered the one before; then once in a sweep, without waiting. The page measures the first time itself,
from the input event to the frame with the new lattice (`requestAnimationFrame`), and so does this for the
shell. Milliseconds by the clock: on an idle machine. Needs Debian's `chromium`, which here draws in software;
with a graphics card the drawing's share is less.
"""

import argparse
import json
import shutil
import signal
import statistics
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from browser import FLAGS, PROGRAMS
from live_server import ANSWERED, until
from playwright.sync_api import Page, sync_playwright

from comparisons.live.panel import ELEMENTS


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("scene", nargs="?", default="two-edges-clamped")
    parser.add_argument("--grid", type=int, default=9)
    parser.add_argument("--elements", type=int, default=ELEMENTS)
    parser.add_argument("--drags", type=int, default=50)
    parser.add_argument("--json", metavar="FILE")
    parser.add_argument(
        "--picture", metavar="FILE", help="keep a picture of the page, as docs/images/live.png"
    )
    arguments = parser.parse_args()
    sizes = ("--grid", str(arguments.grid), "--elements", str(arguments.elements))
    with serving(arguments.scene, *sizes) as address, sync_playwright() as playwright:
        program = next(filter(None, map(shutil.which, PROGRAMS)), None)
        browser = playwright.chromium.launch(executable_path=program, args=list(FLAGS))
        page = browser.new_page(viewport={"width": 1200, "height": 820})
        page.goto(address)
        until(page, ANSWERED)
        drag(page, 5, waiting=True)  # the page's own code is compiled by then
        if arguments.picture:
            page.screenshot(path=arguments.picture)
        found: dict[str, Any] = {name: getattr(arguments, name) for name in ("scene", "grid", "elements")}
        found["lattice_ms"], found["shell_ms"] = drag(page, arguments.drags, waiting=True)
        found["sweep_ms"], _ = drag(page, arguments.drags, waiting=False)
        found["solve_ms"] = 1e3 * page.evaluate("live.shown.lattice.seconds")
        browser.close()
    print(
        f"{arguments.scene}, lattice {arguments.grid} × {arguments.grid} × 2, "
        f"shell of {arguments.elements} elements a side"
    )
    for name, said in {
        "lattice_ms": "drag to lattice drawn",
        "shell_ms": "drag to shell drawn",
        "sweep_ms": "to lattice drawn, without waiting",
    }.items():
        times = found[name]
        print(f"{said}: median {statistics.median(times):.0f} ms, worst of {len(times)} {max(times):.0f} ms")
    if arguments.json:
        with open(arguments.json, "w", encoding="utf-8") as file:
            json.dump(found, file)


def drag(page: Page, steps: int, waiting: bool) -> tuple[list[float], list[float]]:
    """Return the times [ms] to the lattice and to the shell of so many steps of the mouse, there and back."""
    box = page.locator("#slider-young").bounding_box()
    assert box is not None
    y, middle = box["y"] + box["height"] / 2, box["x"] + box["width"] / 2
    page.mouse.move(middle, y)
    page.mouse.down()
    before, shells = page.evaluate("live.latencies.length"), []
    for step in range(1, steps + 1):
        page.mouse.move(middle + 4 * (12 - abs(step % 24 - 12)), y)
        if waiting:
            until(page, f"{ANSWERED} && live.shown.shell.after")
            shells.append(page.evaluate("live.shown.shell.after"))
    page.mouse.up()
    until(page, ANSWERED)
    return page.evaluate("live.latencies")[before:], shells


@contextmanager
def serving(*options: str) -> Iterator[str]:
    """Yield the address of the page, served by a process of its own as users start it."""
    command = [sys.executable, "-m", "sheetbench", "live", *options, "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        yield process.stdout.readline().strip()
        process.send_signal(signal.SIGINT)


if __name__ == "__main__":
    main()
