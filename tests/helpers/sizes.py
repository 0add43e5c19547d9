"""Sizes of the packages, printed: files, lines, and lines of code.

    python tests/helpers/sizes.py

Code is what is neither blank, comment, docstring nor import; a statement of three lines counts as three.
"""

import ast
import io
import tokenize
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
GROUPS = {
    "lumped": ["lumped"],
    "fem_reference": ["fem_reference"],
    "sheetbench": ["sheetbench"],
    "the three": ["lumped", "fem_reference", "sheetbench"],
    "comparisons": ["comparisons"],
    "studies": ["studies"],
    "tests": ["tests"],
}
LAYOUT = {getattr(tokenize, name) for name in ("NL", "NEWLINE", "INDENT", "DEDENT", "COMMENT", "ENDMARKER")}
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


def spanned(node: ast.stmt) -> range:
    """Return the numbers of the lines that a statement spans."""
    return range(node.lineno, (node.end_lineno or node.lineno) + 1)


def docstring(node: ast.AST) -> ast.stmt | None:
    """Return the statement that is a module's, class's or function's docstring, if it has one."""
    if isinstance(node, DOCUMENTED) and ast.get_docstring(node, clean=False) is not None:
        return node.body[0]
    return None


def lines_of_code(source: str) -> int:
    """Return how many lines of a module are neither blank, comment, docstring nor import."""
    tokens = tokenize.generate_tokens(io.StringIO(source).readline)
    numbers = {n for t in tokens if t.type not in LAYOUT for n in range(t.start[0], t.end[0] + 1)}
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import | ast.ImportFrom):
            numbers.difference_update(spanned(node))
        elif text := docstring(node):
            numbers.difference_update(spanned(text))
    return len(numbers)


def sizes(folders: list[str]) -> tuple[int, int, int]:
    """Return the number of files, lines and lines of code in folders of the repository."""
    paths = [path for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))]
    sources = [path.read_text(encoding="utf-8") for path in paths]
    return len(sources), sum(s.count("\n") for s in sources), sum(map(lines_of_code, sources))


if __name__ == "__main__":
    print(f"{'':<14}{'files':>7}{'lines':>9}{'code':>9}")
    for name, folders in GROUPS.items():
        files, lines, code = sizes(folders)
        print(f"{name:<14}{files:>7}{lines:>9}{code:>9}")
    pages = [*sorted((ROOT / "docs").rglob("*.md")), ROOT / "README.md", ROOT / "CHANGELOG.md"]
    texts = [p.read_text(encoding="utf-8") for p in pages if "_build" not in p.parts]
    words = sum(len(t.split()) for t in texts)
    print(f"{'pages':<14}{len(texts):>7}{sum(t.count(chr(10)) for t in texts):>9}   {words} words")
