"""Every single fault that may be put into a file: one expression or statement written otherwise.

    comparison   <  to  <= and >=, ==  to  !=, is and in turned round
    arithmetic   + for −, * for /, ** and @ for *, also in what adds on
    constant     another number (an index goes one up and one down), the other truth value
    boolean      and for or, a condition turned round
    sign         a minus or a not left out
    statement    left out, where nothing is named by it

Left alone is what no run can tell from the original or nobody would test: docstrings, annotations,
decorators, imports, texts with their formats, what an error says, arguments that guard or speed up alone,
numbers so small that they are tolerances.
"""

from __future__ import annotations

import ast
import copy
import zlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

COMPARISONS: dict[type[ast.cmpop], tuple[type[ast.cmpop], ...]] = {
    ast.Lt: (ast.LtE, ast.GtE),
    ast.LtE: (ast.Lt, ast.Gt),
    ast.Gt: (ast.GtE, ast.LtE),
    ast.GtE: (ast.Gt, ast.Lt),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
ARITHMETIC: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult,
    ast.Pow: ast.Mult,
    ast.MatMult: ast.Mult,
}
UNTOUCHED = (ast.JoinedStr, ast.Raise, ast.Import, ast.ImportFrom)
NOT_RUN = ("annotation", "returns", "decorator_list", "type_params")
GUARDS = ("strict", "optimize")
TOLERANCES = 1e-5
NO_NAME_HANGS_ON_IT = (ast.AugAssign, ast.Raise, ast.Break, ast.Continue)


@dataclass(frozen=True)
class Fault:
    """``name`` says where and what, and stays when lines above come or go; ``start``, ``end`` are bytes."""

    module: str
    function: str
    name: str
    line: int
    start: int
    end: int
    text: str

    def digest(self, seed: int = 1) -> int:
        """By which faults are drawn: as good as chance, and the same for the same name and seed."""
        return zlib.crc32(f"{seed} {self.name}".encode())

    def put_into(self, source: bytes) -> bytes:
        """The file with the fault."""
        return source[: self.start] + self.text.encode() + source[self.end :]


def faults(module: str, source: bytes) -> list[Fault]:
    """All faults of a file, in its order."""
    lines = source.splitlines(keepends=True)
    starts = [sum(map(len, lines[:row])) for row in range(len(lines))]
    found, seen = [], Counter[str]()
    for node, other, where in changes(ast.parse(source), ""):
        after = "pass" if isinstance(other, ast.Pass) else ast.unparse(other)
        name = f"{module} {where}: {brief(ast.unparse(node))} → {brief(after)}"
        seen[name] += 1
        start = starts[node.lineno - 1] + node.col_offset
        end = starts[node.end_lineno - 1] + node.end_col_offset
        text = f"({after})" if isinstance(other, ast.expr) else after
        again = f" ({seen[name]})" if seen[name] > 1 else ""
        found.append(Fault(module, where, name + again, node.lineno, start, end, text))
    return found


def brief(code: str) -> str:
    """Code on one line, its start and a digestible length."""
    line = " ".join(code.split())
    return line if len(line) <= 90 else line[:60] + " … " + line[-27:]


def changes(node: ast.AST, where: str) -> Iterator[tuple[ast.AST, ast.AST, str]]:
    """Each node that may be written otherwise, how, and the function that it stands in."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        where = f"{where}.{node.name}".lstrip(".")
    for other in [*expressions(node), *statements(node)]:
        yield node, other, where
    if isinstance(node, UNTOUCHED) or (isinstance(node, ast.keyword) and node.arg in GUARDS):
        return
    test = getattr(node, "test", None)
    if test is not None and not isinstance(test, ast.Compare):
        yield test, ast.UnaryOp(ast.Not(), test), where
    for field, value in ast.iter_fields(node):
        if field not in NOT_RUN:
            for child in value if isinstance(value, list) else [value]:
                if isinstance(child, ast.AST) and not (field == "slice" and isinstance(child, ast.Constant)):
                    yield from changes(child, where)


def expressions(node: ast.AST) -> Iterator[ast.AST]:
    """An expression, and what adds on, written otherwise."""
    match node:
        case ast.Compare(ops=ops):
            for place, op in enumerate(ops):
                for other in COMPARISONS[type(op)]:
                    yield changed(node, ops=[*ops[:place], other(), *ops[place + 1 :]])
        case ast.BinOp(op=op) | ast.AugAssign(op=op) if type(op) in ARITHMETIC and not joins_text(node):
            yield changed(node, op=ARITHMETIC[type(op)]())
        case ast.BoolOp(op=op):
            yield changed(node, op=ast.And() if isinstance(op, ast.Or) else ast.Or())
        case ast.UnaryOp(op=ast.USub() | ast.Not(), operand=operand):
            yield operand
        case ast.Subscript(slice=ast.Constant(value=int(index))):
            for step in (1, -1):
                yield changed(node, slice=ast.Constant(index + step))
        case ast.Constant(value=bool(value)):
            yield ast.Constant(not value)
        case ast.Constant(value=int(value)):
            yield ast.Constant(value + 1)
        case ast.Constant(value=float(value)) if not 0.0 < value < TOLERANCES:
            yield ast.Constant(2.0 * value or 1.0)


def statements(node: ast.AST) -> Iterator[ast.AST]:
    """A statement left out."""
    called = isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)
    stored = isinstance(node, ast.Assign) and all(
        isinstance(target, ast.Subscript | ast.Attribute) for target in node.targets
    )
    if isinstance(node, NO_NAME_HANGS_ON_IT) or called or stored:
        yield ast.Pass()


def changed(node: ast.AST, **fields: object) -> ast.AST:
    """A node with other fields."""
    other = copy.copy(node)
    for name, value in fields.items():
        setattr(other, name, value)
    return other


def joins_text(node: ast.AST) -> bool:
    """Whether a binary operator joins texts, not numbers."""
    return any(isinstance(part, ast.Constant) and isinstance(part.value, str) for part in ast.walk(node))
