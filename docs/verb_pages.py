"""A page of the documentation for every verb of the command line, from the verb itself."""

from pathlib import Path
from typing import Any

from comparisons.cli.app import VERBS, verb_group


def write_verb_pages(folder: Path) -> None:
    """Write `index.md` and a page a verb into the folder."""
    folder.mkdir(exist_ok=True)
    commands = verb_group().commands
    lines = ["# Verbs", "", "Every verb of `sheetbench`; `sheetbench VERB --help` says the same.", ""]
    lines += ["| verb | |", "| --- | --- |"]
    lines += [f"| [{verb}]({verb}.md) | {_first_sentence(commands[verb].help)} |" for verb in VERBS]
    lines += ["", "```{toctree}", ":hidden:", *VERBS, "```", ""]
    (folder / "index.md").write_text("\n".join(lines), encoding="utf-8")
    for verb in VERBS:
        (folder / f"{verb}.md").write_text(_page(verb, commands[verb]), encoding="utf-8")


def _page(verb: str, command: Any) -> str:
    arguments = [p for p in command.params if p.param_type_name == "argument"]
    options = [p for p in command.params if p.param_type_name == "option" and not p.hidden]
    usage = " ".join(["sheetbench", verb, *(_argument(a) for a in arguments), "[OPTIONS]"])
    lines = [f"# {verb}", "", "```sh", usage, "```", "", command.help or "", ""]
    lines += ["| option | |", "| --- | --- |"]
    for option in options:
        value = "" if option.is_flag else f" {option.metavar or option.type.name.upper()}"
        names = ", ".join(f"`{name}{value}`" for name in [*option.opts, *option.secondary_opts])
        default, help_text = option.default, _cell(getattr(option, "help", None))
        if default not in (None, False, True) and not callable(default) and "efault:" not in help_text:
            help_text += f" Default: `{_text(default)}`."
        lines.append(f"| {names} | {help_text} |")
    return "\n".join([*lines, ""])


def _argument(argument: Any) -> str:
    name = argument.metavar or argument.name.upper()
    return name if argument.required or name.startswith("[") else f"[{name}]"


def _text(default: Any) -> str:
    return ",".join(map(str, default)) if isinstance(default, list | tuple) else str(default)


def _cell(text: str | None) -> str:
    return " ".join((text or "").split()).replace("|", "\\|").replace("<", "&lt;")


def _first_sentence(text: str | None) -> str:
    return _cell((text or "").split("\n\n")[0])
