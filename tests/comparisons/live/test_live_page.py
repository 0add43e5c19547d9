"""The page of `sheetbench live` in a browser: a slider is dragged, lattice and shell answer."""

import pytest
from browser import browser, opened  # noqa: F401
from live_server import serving

import sheetbench as sb
from comparisons.live.panel import Panel
from comparisons.models.spec import Lattice

ANSWERED = "live.shown.shell !== undefined && live.shown.shell.number === live.asked()"
PLACES = "Array.from(live.viewer.sheets.get('lattice').positions.array)"


def until(page, expression):
    """Wait for an expression to hold; the page's policy lets nobody wait within it."""
    for _ in range(20_000):
        if page.evaluate(f"window.live !== undefined && ({expression})"):
            return
        page.wait_for_timeout(30)
    raise AssertionError(f"never: {expression}")


@pytest.fixture(scope="module")
def address():
    with serving(Panel(sb.load("two-edges-clamped"), 2, Lattice(3))) as found:
        yield found


@pytest.fixture(scope="module")
def page(browser, address):  # noqa: F811
    with opened(browser, address, offline=False) as (found, watch):
        until(found, ANSWERED)
        yield found, watch


def cell(page, fact, model):
    return page.inner_text(f"[data-fact^='{fact}'] [data-model={model}]")


def test_dragging_moves_the_lattice_and_the_shell_follows(page, address):
    page, watch = page
    assert watch.requests and all(url.startswith(address) for url in watch.requests)
    before = page.evaluate(PLACES), cell(page, "Largest", "lattice"), cell(page, "Largest", "shell")
    number = page.evaluate("live.asked()")
    box = page.locator("#slider-young").bounding_box()
    across, height = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(across, height)
    page.mouse.down()
    for step in range(8):
        page.mouse.move(across - 10 * step, height)
    page.mouse.up()
    until(page, ANSWERED)
    after = page.evaluate(PLACES), cell(page, "Largest", "lattice"), cell(page, "Largest", "shell")
    assert page.evaluate("live.asked()") > number + 3
    assert min(after[0][2::3]) < 1.1 * min(before[0][2::3])  # softer: it hangs lower
    assert all(float(new) > 1.1 * float(old) for new, old in zip(after[1:], before[1:], strict=True))
    assert cell(page, "Status", "lattice") == cell(page, "Status", "shell") == "converged"
    assert page.inner_text("#error").endswith(" %")
    assert page.evaluate("live.latencies.length") > 0
    assert watch.troubles == []


def test_values_are_typed_in_the_units_of_the_box_or_in_others(page):
    page, _ = page
    box = page.locator(".slider:has(#slider-young) input[type=text]")
    start = box.input_value()
    for text, shown in (("60 MPa", "60"), ("0,08 GPa", "80"), ("9e7 Pa", "90"), (start, start)):
        box.fill(text)
        box.press("Enter")
        assert (box.input_value(), page.inner_text("#refused")) == (shown, ""), text
    for text, said in (("2 GPa", "2000 MPa is beyond this page"), ("3 mm", "cannot be read")):
        box.fill(text)
        box.press("Enter")
        assert said in page.inner_text("#refused") and "Pa" in page.inner_text("#refused")
        assert box.input_value() == start
    box.fill("")
    box.press("Enter")
    assert box.input_value() == start
    box.fill(f"{start} MPa")
    box.press("Enter")
    until(page, ANSWERED)


def test_a_grid_by_keys_is_drawn(page):
    page, watch = page
    page.locator("#slider-grid").focus()
    for _ in range(2):
        page.keyboard.press("ArrowRight")
    until(page, ANSWERED)
    assert len(page.evaluate(PLACES)) == 3 * 5 * 5 * 2
    assert watch.troubles == []
