"""Draw docs/images/report.png: the top of a comparison's section in the page that `sheetbench report` writes.

Run it with the folder of a comparison, `sheetbench compare two-edges-clamped --out demo`, as its argument;
it needs the Debian package chromium.
"""

from __future__ import annotations

import sys
from pathlib import Path

from playwright.sync_api import sync_playwright

from comparisons.pages.page import page
from comparisons.pages.studies import read

FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
IMAGE = Path(__file__).parent / "images/report.png"


def main(folder: Path) -> None:
    target = folder / "report.html"
    target.write_text(page(read(folder), "A sheet with two clamped edges"), encoding="utf-8")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path="/usr/bin/chromium", args=FLAGS)
        shown = browser.new_page(viewport={"width": 1080, "height": 1350})
        shown.goto(target.resolve().as_uri())
        shown.get_by_label("Show", exact=True).select_option("both")
        shown.locator(".sv-stage canvas").focus()
        shown.keyboard.press("ArrowUp")
        shown.wait_for_timeout(500)
        shown.screenshot(path=IMAGE)
        browser.close()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
