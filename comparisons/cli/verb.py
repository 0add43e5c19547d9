"""Verbs from functions: signature and docstring define the command and the function in Python.

Options have the function's names and defaults, `--layer-distance` in the terminal and `layer_distance` in
Python, and descriptions by `comparisons.cli.options`; a parameter of a group's type stands for the group's
options. Options without effect beside others are declared by `no_effect`, valid values by the choices of a
`Kind`; violations of both are refused uniformly.
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

NAMES = {"grid": ("--lumped", "--grid"), "grids": ("--grids", "--grid", "--lumped")}  # synonyms
TERMINAL = ("json",)  # options of the terminal alone
WITHOUT_WORDS = {  # parameters that are no options
    "lattice": "The lattice as a specification, in place of its keywords",
    "progress": "Called with the progress",
}
SEVERAL = "Several with commas, or the option again."
OPTIONS = re.compile(r"(?:^|(?<=with )|(?<=without )|(?<=missing )|(?<=, ))--([a-z][a-z-]*)")  # in a refusal
Command = Callable[..., Any]


def no_effect(**rules: str) -> Callable[[Command], Command]:
    """Declare options without effect: with_duration="branch export" lists options without effect beside
    --duration, without_duration="every" options that need it."""

    def declare(command: Command) -> Command:
        command.no_effect = rules  # type: ignore[attr-defined]
        return command

    return declare


class _Declared:
    """A command's parameters, with the options of its groups."""

    def __init__(self, command: Command) -> None:
        self.command, self.signature = command, evaluated(command)
        self.groups: dict[str, type[Group]] = {
            name: parameter.annotation
            for name, parameter in self.signature.parameters.items()
            if isclass(parameter.annotation) and issubclass(parameter.annotation, Group)
        }
        described = [base for kind in self.groups.values() for base in kind.__mro__[:-1]]
        self.words = words_of(command, *described, options)
        self.rules = dict(getattr(command, "no_effect", {}))
        for kind in described:
            for rule, names in vars(kind).get("no_effect", {}).items():
                self.rules[rule] = f"{self.rules.get(rule, '')} {names}"
        self.separators = {  # of list options
            p.name: kind_of(p).separator
            for p in self.parameters()
            if "list[" in str(plain(p).annotation) and not self.words.get(p.name, Words()).argument
        }

    @property
    def prose(self) -> str:
        """The command's description without its options."""
        return cleandoc(self.command.__doc__ or "").partition("\n\nArgs:")[0]

    def parameters(self) -> Iterable[Parameter]:
        """Yield the parameters, in place of a group's parameter its options."""
        for name, parameter in self.signature.parameters.items():
            yield from self.groups[name].parameters() if name in self.groups else [parameter]

    def given(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Return the values that differ from the parameters' defaults."""
        defaults = {parameter.name: parameter.default for parameter in self.parameters()}
        return {
            name: value
            for name, value in values.items()
            if name in defaults
            and value is not None
            and not (type(value) is type(defaults[name]) and value == defaults[name])
        }

    def require(self, values: Mapping[str, Any], shown: Callable[[str], str]) -> None:
        """Raise BadInput for the first option without effect beside the others, or with an invalid choice."""
        from sheetbench.errors import require_choice, require_effect  # imports numpy, slow for help

        given = self.given(values)
        for rule, names in self.rules.items():
            relation, _, other = rule.partition("_")
            if (other in given) == (relation == "with"):
                options = {shown(name): name in given for name in names.split()}
                require_effect(f"{relation} {shown(other)}", options)
        for parameter in self.parameters():
            if (choices := kind_of(parameter).choices) and parameter.name in given:
                value = given[parameter.name]
                for item in value if isinstance(value, list) else [value]:
                    require_choice(shown(parameter.name), str(item), choices)

    def itemised(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """Return the values with the texts of lists split at their separators."""
        lists = {name: by for name, by in self.separators.items() if values.get(name) is not None}
        return {**values, **{name: items_of(name, values[name], by) for name, by in lists.items()}}

    def grouped(self, values: dict[str, Any], **output: Any) -> dict[str, Any]:
        """Return the values with the options of each group combined to one object; output: further fields of
        the output options."""
        values = dict(values)
        for group, kind in self.groups.items():
            fields = output if issubclass(kind, OutputOptions) else {}
            if issubclass(kind, LatticeOptions):
                fields = {"lattice": values.pop(group, None)}
            options = {p.name: values.pop(p.name) for p in kind.parameters() if p.name in values}
            values[group] = kind(**fields, **options)
        return values

    def for_typer(self, parameter: Parameter, hidden: bool = False) -> Parameter:
        """Return a parameter with its typer settings: help, metavar, names, parser."""
        parameter = parameter.replace(kind=Parameter.KEYWORD_ONLY)
        if parameter.annotation is typer.Context:
            return parameter
        words, kind = self.words.get(parameter.name, Words()), kind_of(parameter)
        annotation = plain(parameter).annotation
        text = f"{words.text} {SEVERAL}" if parameter.name in self.separators else words.text
        settings: dict[str, Any] = {"help": text.replace("[", "\\["), "metavar": words.metavar}
        if words.argument:
            return parameter.replace(annotation=Annotated[annotation, typer.Argument(**settings)])
        settings |= {} if kind.unit is None else {"parser": _quantity_in(kind.unit)}
        info = typer.Option(*_names(parameter), hidden=hidden, min=kind.least, **settings)
        return parameter.replace(annotation=Annotated[annotation, info])


def evaluated(command: Command) -> Signature:
    """Return a command's signature with evaluated types of its parameters, not of its result."""
    own, names = signature(command), vars(getmodule(command))
    types = [eval(parameter.annotation, names) for parameter in own.parameters.values()]
    pairs = zip(own.parameters.values(), types, strict=True)
    return own.replace(parameters=[parameter.replace(annotation=kind) for parameter, kind in pairs])


def _flag(name: str) -> str:
    """Return a parameter's name as an option: an argument's in capitals, for_ as --for."""
    return name if name.isupper() else f"--{name.strip('_').replace('_', '-')}"


def as_verb(name: str, command: Command) -> Callable[..., None]:
    """Return the command as a function for typer, with the options of its groups and of all verbs. An
    Impossible scene is refused with the name of its file."""
    declared = _Declared(command)
    parameters = [declared.for_typer(parameter) for parameter in declared.parameters()]
    draws = any(parameter.name == "no_pictures" for parameter in parameters)
    of_campaign = any(issubclass(kind, CampaignOptions) for kind in declared.groups.values())
    for flag in (*(() if draws else ("no_pictures",)), "quiet", "verbose"):
        added = Parameter(flag, Parameter.KEYWORD_ONLY, default=False, annotation=bool)
        # verbs without pictures accept --no-pictures too, for scripts
        parameters.append(declared.for_typer(added, hidden=flag == "no_pictures"))
    arguments = {option for option, words in declared.words.items() if words.argument}

    def shown(option: str) -> str:
        return option.upper() if option in arguments else _flag(option)

    @wraps(command)
    def run(*, quiet: bool, verbose: bool, **values: Any) -> None:
        resumed = of_campaign or values.get("duration") is not None
        interruption.set_interrupt_notice(name, values.get("out"), resumed)
        values = declared.itemised(values)
        declared.require(values, shown)
        no_pictures = {} if draws else {"no_pictures": values.pop("no_pictures")}
        grouped = declared.grouped(values, verb=name, **no_pictures)
        with ExitStack() as stack:
            if quiet or verbose:
                from comparisons.cli import console  # imports rich, slow for help

                stack.enter_context(console.verbosity(quiet, verbose))
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

    paragraphs = declared.prose.replace("[", "\\[").split("\n\n")
    run.__doc__ = "\n\n".join(" ".join(text.split()) for text in paragraphs)  # the help page breaks lines
    run.__signature__ = Signature(parameters)  # type: ignore[attr-defined]
    run.__annotations__ = {parameter.name: parameter.annotation for parameter in parameters}
    return run


def _names(parameter: Parameter) -> tuple[str, ...]:
    """Return option names that differ from typer's default: `--name` alone for a flag that is off by default,
    the name without a final "_", and synonyms."""
    flag = _flag(parameter.name)
    if "bool" in str(parameter.annotation):
        return (flag,) if parameter.default is False else (f"{flag}/--no-{flag[2:]}",)
    return (flag,) if parameter.name.endswith("_") else NAMES.get(parameter.name, ())


def _quantity_in(unit: str) -> Callable[[str], float]:
    """Return a parser of an option's text, a number in an SI unit or a quantity with another unit."""

    def parse(text: str) -> float:
        from sheetbench.errors import BadInput  # imports numpy and pydantic, slow for help
        from sheetbench.scenes.language.units import quantity

        try:
            return quantity(str(text), unit)
        except BadInput as error:
            raise typer.BadParameter(str(error)) from None

    return parse


@cache
def as_function(name: str, command: Command) -> Callable[..., Any]:
    """Return the verb as a function of `import sheetbench` that returns the command's answer.

    Its arguments are the command's options: scenes and lattices as objects or names, lists for options that
    can be repeated, quantities as numbers or text; `out` and its options for files; `progress`, called with
    the current work. Raises BadInput with Python's names; warns about implausible values of a Scene.
    """
    declared = _Declared(command)
    parameters: list[Parameter] = []
    for parameter in declared.signature.parameters.values():
        kind = declared.groups.get(parameter.name)
        if kind is None:
            parameters.append(parameter)
        elif issubclass(kind, LatticeOptions):
            parameters.append(parameter.replace(default=None, annotation="Lattice | None"))
        parameters += kind.parameters() if kind is not None else []
    has_output = any(issubclass(kind, OutputOptions) for kind in declared.groups.values())
    if has_output:
        settings: Any = {"default": None, "annotation": "Callable[[Any], object] | None"}
        parameters.append(Parameter("progress", Parameter.KEYWORD_ONLY, **settings))

    def order(p: Parameter) -> tuple[int, bool]:
        return p.kind, p.kind is Parameter.KEYWORD_ONLY and p.default is not Parameter.empty

    metavars = {name: words.metavar for name, words in declared.words.items()}
    accepted = (in_python(p, metavars.get(p.name)) for p in parameters if p.name not in TERMINAL)
    api = Signature(sorted(accepted, key=order), return_annotation=declared.signature.return_annotation)
    converters = {p.name: conversion(p, declared.separators.get(p.name)) for p in declared.parameters()}

    @wraps(command)
    def run(*values: Any, **named: Any) -> Any:
        from comparisons.models.context import running
        from sheetbench.errors import BadInput, WrongArgument
        from sheetbench.scenes import Scene
        from sheetbench.scenes.meaning.plausibility import warn_of_slips

        if "lumped" in named and "grid" in api.parameters:  # one option, as on the command line
            if "grid" in named:
                raise WrongArgument(f"{name}: lumped and grid are the same option; give one of them")
            named["grid"] = named.pop("lumped")
        try:
            bound = api.bind(*values, **named)
        except TypeError as error:
            wrong = next((key for key in named if key not in api.parameters), "")
            hint = "".join(f"; did you mean {key}?" for key in get_close_matches(wrong, api.parameters, 1))
            raise WrongArgument(f"{name}: {error}; it has {', '.join(api.parameters)}{hint}") from None
        bound.apply_defaults()
        arguments = dict(bound.arguments)
        scenes = [value for value in arguments.values() if isinstance(value, Scene)]
        if name != "check":  # its answer lists the warnings
            warn_of_slips(((f"scene '{scene.name}'", scene) for scene in scenes), stacklevel=2)
        arguments = {k: converters[k](value) if k in converters else value for k, value in arguments.items()}
        settings = {"progress": arguments.pop("progress", None), "large": arguments.get("large", False)}
        if settings["progress"] is not None and not callable(settings["progress"]):
            raise BadInput(f"progress = {settings['progress']!r}: not a function")
        try:
            declared.require(arguments, lambda option: option)
            output = {"verb": name, "terminal": False} if has_output else {}
            with ExitStack() as stack:
                if not has_output:
                    stack.enter_context(redirect_stdout(StringIO()))
                elif settings["progress"] is None and "ipykernel" in sys.modules:
                    from comparisons.cli import console  # imports rich

                    if console.err.is_jupyter:
                        settings["progress"] = stack.enter_context(console.progress())
                stack.enter_context(running(**{key: value for key, value in settings.items() if value}))
                return command(**declared.grouped(arguments, **output))
        except BadInput as error:
            error.args = (OPTIONS.sub(_in_python, str(error)),)
            raise

    run.__signature__ = api  # type: ignore[attr-defined]
    run.__doc__ = "\n".join([declared.prose, "", *_sections(api, declared.words), ""])
    run.__annotations__ = {one.name: one.annotation for one in api.parameters.values()}
    return run


def _in_python(option: re.Match[str]) -> str:
    name = option[1].replace("-", "_")
    return f"{name}_" if name in ("for", "open") else name


def _sections(api: Signature, words: Mapping[str, Words]) -> Iterable[str]:
    """Yield the lines of numpydoc's sections of a verb as a function."""
    yield from ("Parameters", "----------")
    for name, parameter in api.parameters.items():
        text = re.sub(
            r"--([a-z][a-z-]*)", _in_python, words.get(name, Words(WITHOUT_WORDS.get(name, ""))).text
        )
        yield f"{name} : {parameter.annotation}"
        yield f"    {text[:1].upper()}{text[1:].rstrip('.')}."
    kinds = dict.fromkeys(re.findall(r"\b[A-Z]\w+", str(api.return_annotation).replace("Annotated", "")))
    file = "The file that was written." if "Path" in kinds else "The answer, with its tables and pictures."
    yield from ("", "Returns", "-------", " or ".join(kinds), f"    {file}")
    yield from ("", "Raises", "------", "BadInput", "    An argument that cannot be used as given.")
