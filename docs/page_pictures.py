"""Draw docs/images/report.png and docs/images/live.png: `make pictures`.

The page that `sheetbench report` writes of a comparison, whose folder is the argument, and the page of
`sheetbench live`. Needs the Debian package chromium.
"""

import subprocess
import sys
from pathlib import Path
from shutil import which

from playwright.sync_api import Browser, sync_playwright

from comparisons.pages.page import page
from comparisons.pages.studies import read

FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
IMAGES = Path(__file__).parent / "images"
LIVE = [sys.executable, "-m", "sheetbench", "live", "curved-edge", "--no-browser"]


def main(folder: Path) -> None:
    target = folder / "report.html"
    target.write_text(page(read(folder), "A sheet with two clamped edges"), encoding="utf-8")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=which("chromium"), args=FLAGS)
        shown = browser.new_page(viewport={"width": 1080, "height": 1350})
        shown.goto(target.resolve().as_uri())
        shown.wait_for_timeout(500)
        shown.screenshot(path=IMAGES / "report.png")
        live(browser)
        browser.close()


def live(browser: Browser) -> None:
    """The page of `sheetbench live`, both models' answers there."""
    with subprocess.Popen(LIVE, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        shown = browser.new_page(viewport={"width": 1280, "height": 800})
        shown.goto(server.stdout.readline().strip())
        shown.locator("#error").filter(has_text="%").wait_for(timeout=300_000)
        shown.wait_for_timeout(2000)
        shown.screenshot(path=IMAGES / "live.png")
        server.terminate()


if __name__ == "__main__":
    main(Path(sys.argv[1]))
