"""`sheetbench live SCENE`: a page on this machine with sliders, where lattice and shell answer."""

from __future__ import annotations

from comparisons.cli.options import LatticeOptions

ELEMENTS = 8
REDIRECTION = """<!doctype html>
<meta charset="utf-8">
<meta name="referrer" content="no-referrer">
<meta http-equiv="refresh" content="0;url={address}">
<a href="{address}">sheetbench live</a>
"""


def command(
    scene: str,
    lattice: LatticeOptions,
    *,
    elements: str = str(ELEMENTS),
    port: int = 0,
    browser: bool = True,
) -> None:
    """Open a page with sliders, where lattice and shell are solved.

    The option --k adds a slider for k.

    The page is served on localhost only, at a secret URL. Ctrl-C ends it.

    Args:
        elements (N): Elements of the shell along the shorter side to start with.
        port (PORT): Port to listen on; 0: any free port.
        browser: Open the page in a browser, or only print its address.
    """
    import webbrowser
    from html import escape
    from pathlib import Path
    from tempfile import NamedTemporaryFile

    from comparisons.cli.console import note
    from comparisons.comparison.comparison import load_static
    from comparisons.live.panel import Panel
    from comparisons.live.server import Server
    from comparisons.models.grids import parse_elements
    from comparisons.models.resolve import resolve

    loaded = load_static(scene)
    resolved = resolve(loaded, lattice.spec).spec
    panel = Panel(loaded, parse_elements(elements), resolved.but(grid=lattice.grid))

    # Every user of the machine can read a browser's command line, so the secret address is in a private file.
    with (
        Server(panel, port) as server,
        NamedTemporaryFile("w", prefix="sheetbench-live-", suffix=".html") as file,
    ):
        note(f"{server.address}\nCtrl-C ends it.")
        if browser:
            file.write(REDIRECTION.format(address=escape(server.address)))
            file.flush()
            webbrowser.open(Path(file.name).as_uri())
        server.serve_forever()
