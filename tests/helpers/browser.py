"""A browser for tests that look at pages: the system's Chromium, cut off from the net, or a skip."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest

PROGRAMS = ("chromium", "chromium-browser", "google-chrome")
FLAGS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars")


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """Yield a Chromium with three-dimensional drawing without a graphics card."""
    found = next(filter(None, map(shutil.which, PROGRAMS)), None)
    if found is None:
        pytest.skip("needs a browser: install the Debian package chromium")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=found, args=list(FLAGS))
        yield started
        started.close()


class Watch:
    """A page's faults: errors and warnings of its console, and its requests."""

    def __init__(self, page: Any) -> None:
        self.said: list[str] = []
        self.requests: list[str] = []
        page.on("console", lambda m: self.said.append(m.text) if m.type in ("error", "warning") else None)
        page.on("pageerror", lambda error: self.said.append(str(error)))
        page.on("request", lambda request: self.requests.append(request.url))

    @property
    def troubles(self) -> list[str]:
        """The messages, except the drivers' remarks on reading pictures back without a graphics card."""
        return [text for text in self.said if "GPU stall" not in text]


@contextmanager
def opened(browser: Any, address: str, **context: Any) -> Iterator[tuple[Any, Watch]]:
    """Yield a page and a watch on it, in a context of its own, offline unless `offline` is false."""
    own = browser.new_context(**{"offline": True, "viewport": {"width": 1000, "height": 900}, **context})
    page = own.new_page()
    watch = Watch(page)
    page.goto(address)
    try:
        yield page, watch
    finally:
        own.close()


def pixels(page: Any, selector: str) -> np.ndarray:
    """Return the pixels of an element, (height, width, 3), 0 to 255."""
    from io import BytesIO

    from matplotlib.image import imread

    picture = imread(BytesIO(page.locator(selector).first.screenshot()), format="png")
    return (255 * picture[:, :, :3]).astype(int)


def colours(picture: np.ndarray) -> int:
    """Return the number of different colours in a picture."""
    return len(np.unique(picture.reshape(-1, 3), axis=0))
