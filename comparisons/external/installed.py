"""The external finite-element codes among the plug-ins, and which of them are installed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from comparisons.external import plugins
from comparisons.external.answer import ExternalCode
from sheetbench.errors import BadInput, require_choice


@dataclass(frozen=True)
class InstalledCode:
    """An external code: the name or `FILE.py:OBJECT` that selects it, and its version, None where absent."""

    model: str
    code: ExternalCode
    version: str | None


def find_codes(names: Sequence[str] | None = None) -> list[InstalledCode]:
    """Return the external codes of these names, or `FILE.py:OBJECT`; of all plug-ins unless given.

    Raises BadInput for a name that is no external code's, and for a named code that is not installed.
    """
    if names is None:
        return [InstalledCode(name, code, code.version()) for name, code in known_codes().items()]
    codes = []
    for name in names:
        if plugins.from_file(name) is None:
            require_choice("--judges", name, known_codes())
        code = plugins.plugin(name)
        if not isinstance(code, ExternalCode):
            raise BadInput(f"--judges = '{name}': no external code, it has no meshes or no version()")
        if (version := code.version()) is None:
            raise BadInput(f"--judges = '{name}': needs {code.needs}")
        codes.append(InstalledCode(name, code, version))
    return codes


def known_codes() -> dict[str, ExternalCode]:
    """Return the external codes among the plug-ins by name, without those that cannot be loaded."""
    codes = {}
    for name in plugins.names():
        try:
            model = plugins.plugin(name)
        except BadInput:
            continue
        if isinstance(model, ExternalCode):
            codes[name] = model
    return codes
