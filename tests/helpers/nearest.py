"""The test files that run a module, the nearest first.

A test file is the nearer, the fewer imports lie between it and the module; one that names the module, its
folder or a function is nearer than that, and so is one in the module's own folder or with its name. Of those
as near the shorter comes first: it takes less time.

Usage: python tests/helpers/nearest.py FILE [COUNT]   (10 unless given)
"""

import re
import sys
from pathlib import Path

FOLDERS = ("lumped", "fem_reference", "comparisons", "sheetbench", "tests")
# also in a text that a test runs as a program; all files by ast would take seconds
IMPORTS = re.compile(r"^[ \t]*(?:from ([\w.]+) )?import (\([^)]*\)|[^\n]*)", re.MULTILINE)
MENTION, FOLDER, NAMED = 2.0, 2.0, 4.0  # imports that a mention, each folder in common, its name are worth


class Nearest:
    """The imports of a tree, read once."""

    def __init__(self, tree: Path):
        files = {name: path for folder in FOLDERS for name, path in modules(tree, folder).items()}
        self._files = {str(path.relative_to(tree)): name for name, path in files.items()}
        self.imports = {name: imported(path, files) for name, path in files.items()}
        tests = {name: path for name, path in files.items() if path.name.startswith("test_")}
        self._tests = {name: str(path.relative_to(tree)) for name, path in tests.items()}
        self._texts = {name: path.read_text() for name, path in tests.items()}

    def tests(self, module: str, words: list[str]) -> list[str]:
        """Return all files of tests, the nearest first, with mentions of words."""
        distances = self._distances(self._files[module])
        farthest = max(distances.values()) + 1  # of what is not imported at all

        folders, stem = Path(module).parent.parts, Path(module).stem

        def nearness(test: str) -> tuple[float, int]:
            mentions = sum(has(self._texts[test], word) for word in words)
            place = Path(self._tests[test])
            beside = sum(map(str.__eq__, folders, place.parent.parts[1:]))
            near = MENTION * mentions + FOLDER * beside + NAMED * has(place.stem, stem)
            return distances.get(test, farthest) - near, len(self._texts[test])

        return [self._tests[test] for test in sorted(self._tests, key=nearness)]

    def _distances(self, module: str) -> dict[str, int]:
        """Return the number of imports between each file and a module."""
        distances, ahead = {module: 0}, [module]
        for name in ahead:
            for other, names in self.imports.items():
                if name in names and other not in distances:
                    distances[other] = distances[name] + 1
                    ahead.append(other)
        return distances


def words_of(module: str, function: str) -> list[str]:
    """Return what a test of a function may name: the function, its class, module and folder."""
    parts = [Path(module).parent.name, Path(module).stem, *function.split(".")]
    return [part for part in dict.fromkeys(parts) if part.strip("_")]


def has(text: str, word: str) -> bool:
    """Return whether a text has a name, or its words one after the other."""
    words = word.strip("_").replace("_", "[_ -]")
    return re.search(rf"(?<![a-zA-Z]){words}", text, re.IGNORECASE) is not None


def modules(tree: Path, folder: str) -> dict[str, Path]:
    """Return dotted names and files; tests import each other without their folder's name."""
    found = {}
    for path in sorted((tree / folder).rglob("*.py")):
        parts = path.relative_to(tree).with_suffix("").parts
        parts = parts[:-1] if parts[-1] == "__init__" else parts
        found[".".join(parts).removeprefix("tests.helpers.")] = path
    return found


def imported(path: Path, files: dict[str, Path]) -> set[str]:
    """Return our modules that a file imports."""
    found = set()
    for module, names in IMPORTS.findall(path.read_text()):
        named = [name.split()[0] for name in names.strip("()").split(",") if name.strip()]
        found |= {module, *(f"{module}.{name}" for name in named)} if module else set(named)
    return found & files.keys()


if __name__ == "__main__":
    file, count = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 10
    root = Path(__file__).parents[2]
    file = str(Path(file).resolve().relative_to(root))
    print("\n".join(Nearest(root).tests(file, words_of(file, ""))[:count]))
