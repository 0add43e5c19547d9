"""A verb from its function: its signature and docstring make the command, and the function in Python.

Options have the function's names and defaults, `--layer-distance` in the terminal and `layer_distance` in
Python, and words as `comparisons.cli.options` says; a parameter of a group's type stands for the group's
options. What an option does only with or without another is declared by `no_effect`, what alone it takes by
the choices of its `Kind`; both are refused in one way for all.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack, redirect_stdout
from difflib import get_close_matches
from functools import cache, wraps
from inspect import Parameter, Signature, cleandoc, getmodule, isclass, signature
from io import StringIO
from typing import Annotated, Any

import typer

from comparisons.cli import interruption, options
from comparisons.cli.arguments import conversion, in_python, items_of, kind_of, plain
from comparisons.cli.options import CampaignOptions, Group, LatticeOptions, Words, words_of
from comparisons.cli.output import OutputOptions

NAMES = {"grid": ("--lumped", "--grid"), "grids": ("--grids", "--grid", "--lumped")}  # of one option
TERMINAL = ("json",)  # options of the terminal alone
WITHOUT_WORDS = {  # parameters that are no options
    "lattice": "The lattice as a specification, in place of its keywords",
    "progress": "Called with the progress",
}
SEVERAL = "Several with commas, or the option again."
OPTIONS = re.compile(r"(?:^|(?<=with )|(?<=without )|(?<=missing )|(?<=, ))--([a-z][a-z-]*)")  # in a refusal
Command = Callable[..., Any]


def no_effect(**rules: str) -> Callable[[Command], Command]:
    """Declare options without effect: with_duration="branch export", those that have none beside
    --duration, without_duration="every", those that have none but with it."""

    def declare(command: Command) -> Command:
        command.no_effect = rules  # type: ignore[attr-defined]
        return command

    return declare


class _Declared:
    """A command's parameters, those of its groups one by one."""

    def __init__(self, command: Command) -> None:
        self.command, self.own = command, evaluated(command)
        self.groups: dict[str, type[Group]] = {
            name: one.annotation
            for name, one in self.own.parameters.items()
            if isclass(one.annotation) and issubclass(one.annotation, Group)
        }
        described = [of for kind in self.groups.values() for of in kind.__mro__[:-1]]
        self.words = words_of(command, *described, options)
        self.rules = dict(getattr(command, "no_effect", {}))
        for kind in described:
            for rule, names in vars(kind).get("no_effect", {}).items():
                self.rules[rule] = f"{self.rules.get(rule, '')} {names}"
        self.separators = {  # of the options that are lists
            one.name: kind_of(one).separator
            for one in self.each()
            if "list[" in str(plain(one).annotation) and not self.words.get(one.name, Words()).argument
        }

    @property
    def prose(self) -> str:
        """What the command does, without its options."""
        return cleandoc(self.command.__doc__ or "").partition("\n\nArgs:")[0]

    def each(self) -> Iterable[Parameter]:
        for name, one in self.own.parameters.items():
            yield from self.groups[name].parameters() if name in self.groups else [one]

    def given(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Return the values that are not the parameters' defaults."""
        usual = {one.name: one.default for one in self.each()}
        return {
            name: value
            for name, value in values.items()
            if name in usual
            and value is not None
            and not (type(value) is type(usual[name]) and value == usual[name])
        }

    def require(self, values: Mapping[str, Any], shown: Callable[[str], str]) -> None:
        """Raise BadInput for the first option that has no effect with the others, or is none of its
        choices."""
        from sheetbench.errors import require_choice, require_effect  # with numpy: help must not wait

        given = self.given(values)
        for rule, names in self.rules.items():
            how, _, other = rule.partition("_")
            if (other in given) == (how == "with"):
                options = {shown(name): name in given for name in names.split()}
                require_effect(f"{how} {shown(other)}", options)
        for one in self.each():
            if (choices := kind_of(one).choices) and one.name in given:
                value = given[one.name]
                for each in value if isinstance(value, list) else [value]:
                    require_choice(shown(one.name), str(each), choices)

    def itemised(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Return the values with every list's texts split at its commas."""
        lists = {name: of for name, of in self.separators.items() if values.get(name) is not None}
        return {**values, **{name: items_of(name, values[name], of) for name, of in lists.items()}}

    def grouped(self, values: dict[str, Any], **of_output: Any) -> dict[str, Any]:
        """Return the values with those of each group in one."""
        values = dict(values)
        for group, kind in self.groups.items():
            more = of_output if issubclass(kind, OutputOptions) else {}
            if issubclass(kind, LatticeOptions):
                more = {"lattice": values.pop(group, None)}
            own = {one.name: values.pop(one.name) for one in kind.parameters() if one.name in values}
            values[group] = kind(**more, **own)
        return values

    def read_by_typer(self, one: Parameter, hidden: bool = False) -> Parameter:
        """Return a parameter with what typer is to know of it."""
        one = one.replace(kind=Parameter.KEYWORD_ONLY)
        if one.annotation is typer.Context:
            return one
        words, kind, own = self.words.get(one.name, Words()), kind_of(one), plain(one).annotation
        text = f"{words.text} {SEVERAL}" if one.name in self.separators else words.text
        settings: dict[str, Any] = {"help": text.replace("[", "\\["), "metavar": words.metavar}
        if words.argument:
            return one.replace(annotation=Annotated[own, typer.Argument(**settings)])
        settings |= {} if kind.unit is None else {"parser": _quantity_in(kind.unit)}
        info = typer.Option(*_names(one), hidden=hidden, min=kind.least, **settings)
        return one.replace(annotation=Annotated[own, info])


def evaluated(command: Command) -> Signature:
    """Return a command's signature, its parameters' types evaluated; what it returns is not imported."""
    own, names = signature(command), vars(getmodule(command))
    types = [eval(one.annotation, names) for one in own.parameters.values()]
    each = zip(own.parameters.values(), types, strict=True)
    return own.replace(parameters=[one.replace(annotation=kind) for one, kind in each])


def _flag(name: str) -> str:
    """Return a parameter's name as an option: an argument's in capitals, for_ as --for."""
    return name if name.isupper() else f"--{name.strip('_').replace('_', '-')}"


def as_verb(name: str, command: Command) -> Callable[..., None]:
    """Return the command as typer reads it, with the options of its groups and those of every verb.

    An Impossible scene is refused with the name of its file.
    """
    declared = _Declared(command)
    parameters = [declared.read_by_typer(one) for one in declared.each()]
    draws = any(parameter.name == "no_pictures" for parameter in parameters)
    of_campaign = any(issubclass(kind, CampaignOptions) for kind in declared.groups.values())
    for flag in (*(() if draws else ("no_pictures",)), "quiet", "verbose"):
        added = Parameter(flag, Parameter.KEYWORD_ONLY, default=False, annotation=bool)
        # no pictures of verbs that draw none either, for scripts
        parameters.append(declared.read_by_typer(added, hidden=flag == "no_pictures"))
    arguments = {option for option, words in declared.words.items() if words.argument}

    def shown(option: str) -> str:
        return option.upper() if option in arguments else _flag(option)

    @wraps(command)
    def run(*, quiet: bool, verbose: bool, **values: Any) -> None:
        resumed = of_campaign or values.get("duration") is not None
        interruption.promise(name, values.get("out"), resumed)
        values = declared.itemised(values)
        declared.require(values, shown)
        undrawn = {} if draws else {"no_pictures": values.pop("no_pictures")}
        grouped = declared.grouped(values, verb=name, **undrawn)
        with ExitStack() as stack:
            if quiet or verbose:
                from comparisons.cli import console  # with rich: help must not wait for it

                stack.enter_context(console.speaking(quiet, verbose))
            if values.get("large"):
                from comparisons.models.context import running

                stack.enter_context(running(large=True))
            try:
                command(**grouped)
            except ValueError as error:
                from sheetbench.errors import Impossible, SceneError

                if isinstance(error, Impossible) and values.get("scene"):
                    raise SceneError(f"{values['scene']}: {error}") from None
                raise

    paragraphs = declared.prose.replace("[", "\\[").split("\n\n")  # whose lines a help page breaks itself
    run.__doc__ = "\n\n".join(" ".join(one.split()) for one in paragraphs)
    run.__signature__ = Signature(parameters)  # type: ignore[attr-defined]
    run.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return run


def _names(parameter: Parameter) -> tuple[str, ...]:
    """Return an option's names where typer would have others: of a flag `--name` alone unless it can be on by
    default, of a parameter that ends in "_" what is before."""
    flag = _flag(parameter.name)
    if "bool" in str(parameter.annotation):
        return (flag,) if parameter.default is False else (f"{flag}/--no-{flag[2:]}",)
    return (flag,) if parameter.name.endswith("_") else NAMES.get(parameter.name, ())


def _quantity_in(unit: str) -> Callable[[str], float]:
    """Return a parser of an option's text, a number in an SI unit or a quantity with a unit of its own."""

    def parse(text: str) -> float:
        from sheetbench.errors import BadInput  # with numpy and pydantic: help must not wait for them
        from sheetbench.scenes.language.units import quantity

        try:
            return quantity(str(text), unit)
        except BadInput as error:
            raise typer.BadParameter(str(error)) from None

    return parse


@cache
def as_function(name: str, command: Command) -> Callable[..., Any]:
    """Return the verb as a function of `import sheetbench`, which returns what the command shows.

    It takes what the command takes: a Scene or a Lattice as well as their names, a list where the command's
    option may have several, a number as well as a quantity in words; `out` and what goes with it for
    files; `progress`, called with what is being done. Raises BadInput in Python's names. Warns of what is
    hardly meant in a Scene.
    """
    declared = _Declared(command)
    found: list[Parameter] = []
    for one in declared.own.parameters.values():
        kind = declared.groups.get(one.name)
        if kind is None:
            found.append(one)
        elif issubclass(kind, LatticeOptions):
            found.append(one.replace(default=None, annotation="Lattice | None"))
        found += kind.parameters() if kind is not None else []
    has_output = any(issubclass(kind, OutputOptions) for kind in declared.groups.values())
    if has_output:
        shown: Any = {"default": None, "annotation": "Callable[[Any], object] | None"}
        found.append(Parameter("progress", Parameter.KEYWORD_ONLY, **shown))

    def place(one: Parameter) -> tuple[int, bool]:
        return one.kind, one.kind is Parameter.KEYWORD_ONLY and one.default is not Parameter.empty

    metavars = {name: words.metavar for name, words in declared.words.items()}
    taken = (in_python(one, metavars.get(one.name)) for one in found if one.name not in TERMINAL)
    own = Signature(sorted(taken, key=place), return_annotation=declared.own.return_annotation)
    converted = {one.name: conversion(one, declared.separators.get(one.name)) for one in declared.each()}

    @wraps(command)
    def run(*values: Any, **named: Any) -> Any:
        from comparisons.models.context import running
        from sheetbench.errors import BadInput, WrongArgument
        from sheetbench.scenes import Scene
        from sheetbench.scenes.meaning.plausibility import warn_of_slips

        if "lumped" in named and "grid" in own.parameters:  # one option, as on the command line
            if "grid" in named:
                raise WrongArgument(f"{name}: lumped and grid are one; give one of them")
            named["grid"] = named.pop("lumped")
        try:
            bound = own.bind(*values, **named)
        except TypeError as error:
            wrong = next((key for key in named if key not in own.parameters), "")
            near = "".join(f"; did you mean {key}?" for key in get_close_matches(wrong, own.parameters, 1))
            raise WrongArgument(f"{name}: {error}; it has {', '.join(own.parameters)}{near}") from None
        bound.apply_defaults()
        found = dict(bound.arguments)
        written = [one for one in found.values() if isinstance(one, Scene)]
        if name != "check":  # whose answer has them
            warn_of_slips(((f"scene '{one.name}'", one) for one in written), stacklevel=2)
        found = {key: converted[key](value) if key in converted else value for key, value in found.items()}
        held = {"progress": found.pop("progress", None), "large": found.get("large", False)}
        if held["progress"] is not None and not callable(held["progress"]):
            raise BadInput(f"progress = {held['progress']!r}: not a function")
        try:
            declared.require(found, lambda option: option)
            of_output = {"verb": name, "terminal": False} if has_output else {}
            with ExitStack() as stack:
                if not has_output:
                    stack.enter_context(redirect_stdout(StringIO()))
                elif held["progress"] is None and "ipykernel" in sys.modules:
                    from comparisons.cli import console  # with rich

                    if console.err.is_jupyter:
                        held["progress"] = stack.enter_context(console.progress())
                stack.enter_context(running(**{key: value for key, value in held.items() if value}))
                return command(**declared.grouped(found, **of_output))
        except BadInput as error:
            error.args = (OPTIONS.sub(_in_python, str(error)),)
            raise

    run.__signature__ = own  # type: ignore[attr-defined]
    run.__doc__ = "\n".join([declared.prose, "", *_sections(own, declared.words), ""])
    run.__annotations__ = {one.name: one.annotation for one in own.parameters.values()}
    return run


def _in_python(option: re.Match[str]) -> str:
    name = option[1].replace("-", "_")
    return f"{name}_" if name in ("for", "open") else name


def _sections(own: Signature, words: Mapping[str, Words]) -> Iterable[str]:
    """Yield the lines of numpydoc's sections of a verb as a function."""
    yield from ("Parameters", "----------")
    for name, parameter in own.parameters.items():
        text = re.sub(
            r"--([a-z][a-z-]*)", _in_python, words.get(name, Words(WITHOUT_WORDS.get(name, ""))).text
        )
        yield f"{name} : {parameter.annotation}"
        yield f"    {text[:1].upper()}{text[1:].rstrip('.')}."
    kinds = dict.fromkeys(re.findall(r"\b[A-Z]\w+", str(own.return_annotation).replace("Annotated", "")))
    file = "The file that was written." if "Path" in kinds else "The answer, with its tables and pictures."
    yield from ("", "Returns", "-------", " or ".join(kinds), f"    {file}")
    yield from ("", "Raises", "------", "BadInput", "    An argument that cannot be used as given.")
