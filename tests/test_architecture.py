"""Imports run one way: sheetbench.scenes → lumped, fem_reference → comparisons → studies.

The two solvers share the question, never the mechanics: what a scene's words mean (values over time, where
bent, tilted and moved edges are, which strains are outside the model) is the scene's to say, once; how
springs or elements carry it each solver derives for itself, for a shared derivation would be a shared bug.
"""

import ast
import re
from functools import cache
from importlib import import_module
from pathlib import Path

import pytest

import lumped

pytestmark = pytest.mark.smoke

ROOT = Path(__file__).parent.parent
GROUND = ("sheetbench.scenes", "sheetbench.choices", "sheetbench.files", "sheetbench.kernels")
GROUND += ("sheetbench.numerics", "sheetbench.clock", "sheetbench.errors", "sheetbench.answers")
GROUND += ("sheetbench.process", "sheetbench.runs", "sheetbench.heap", "sheetbench.sources")
ALLOWED = {
    "sheetbench/answers": {
        *("sheetbench.answers", "sheetbench.errors", "sheetbench.files", "sheetbench.scenes"),
    },
    "sheetbench/runs": {
        *("sheetbench.answers", "sheetbench.clock", "sheetbench.errors", "sheetbench.files"),
        *("sheetbench.numerics", "sheetbench.runs", "sheetbench.scenes", "sheetbench.sources"),
    },
    "sheetbench/scenes": {"sheetbench.errors", "sheetbench.process", "sheetbench.scenes"},
    "sheetbench/numerics": {
        *("sheetbench.answers", "sheetbench.errors", "sheetbench.kernels", "sheetbench.numerics"),
    },
    "lumped": {*GROUND, "lumped"},
    "fem_reference": {*GROUND, "fem_reference"} - {"sheetbench.files"},
    "comparisons": {*GROUND, "lumped", "fem_reference", "comparisons"},
    "studies": {*GROUND, "lumped", "fem_reference", "comparisons", "studies"},
}


def files_of(*packages):
    return sorted(path for package in packages for path in (ROOT / package).rglob("*.py"))


def text_of(path):
    return path.read_text(encoding="utf-8")


@cache
def nodes_of(path):
    """All of a file's code, read once."""
    return list(ast.walk(ast.parse(text_of(path))))


WORDS = {"interp", "sinc", "from_rotvec"}  # of values over time and of the kinematics of edges


@pytest.mark.parametrize("package", ["lumped", "fem_reference"])
def test_what_a_scenes_words_mean_is_left_to_the_scenes(package):
    for path in files_of(package):
        named = {node.attr for node in nodes_of(path) if isinstance(node, ast.Attribute)}
        assert not named & WORDS or path.parent.name == "verification", f"{path} has {named & WORDS}"


PACKAGES = ("sheetbench", "lumped", "fem_reference", "comparisons", "studies")


@cache
def names_in(path):
    """Names that a file imports; a literal's counts too, but for that of the plug-ins' entry points."""
    names = set()
    for node in nodes_of(path):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and "." in node.value:
            names.add(node.value)  # tables of modules that are loaded when requested
    return names - {"sheetbench.models"}


def imported(path):
    """Our packages that a file imports, the ground of all without the face."""
    parts = (name.split(".") for name in names_in(path))
    ours = [part for part in parts if part[0] in PACKAGES]
    return {second if (second := ".".join(part[:2])) in GROUND else part[0] for part in ours}


def circles(graph):
    """Return what of a graph, name to the names that it imports, lies on circles or leads to one."""
    while leaves := {name for name, below in graph.items() if not below & graph.keys()}:
        graph = {name: below for name, below in graph.items() if name not in leaves}
    return sorted(graph)


@pytest.mark.parametrize("package", ALLOWED)
def test_imports_run_one_way(package):
    assert files_of(package)
    for path in files_of(package):
        if path == ROOT / "sheetbench/scenes/__init__.py":
            continue  # it names answers that are imported from there too
        forbidden = imported(path) - ALLOWED[package]
        assert not forbidden, f"{path.relative_to(ROOT)} imports {', '.join(sorted(forbidden))}"


FLOORS = {  # of comparisons; CONTRIBUTING.md says what is in each room
    **dict.fromkeys(("models", "external", "pictures"), 0),
    **dict.fromkeys(("identification", "modes", "sweep"), 1),
    **dict.fromkeys(("codes", "comparison", "pages", "scoring", "stability"), 2),
    **dict.fromkeys(("calibration", "tradeoff"), 3),
    "live": 4,
    "cli": 5,
}


def test_rooms_of_the_comparisons_import_from_lower_floors():
    """Never from a higher floor, and on one floor in no circle.

    Tasks, "module:function", are called by name by whoever carries them out, and count for nothing.
    """
    below: dict[str, set[str]] = {room: set() for room in FLOORS}
    for path in sorted((ROOT / "comparisons").rglob("*/*.py")):
        room = path.relative_to(ROOT / "comparisons").parts[0]
        for name in names_in(path):
            parts = name.split(".")
            if parts[0] == "comparisons" and len(parts) > 2 and ":" not in name:
                assert FLOORS[parts[1]] <= FLOORS[room], f"{path.relative_to(ROOT)} imports {name}"
                below[room].add(parts[1])
    assert not circles({room: others - {room} for room, others in below.items()})


def test_contributing_lists_every_package_of_comparisons():
    page = text_of(ROOT / "CONTRIBUTING.md").split("<!-- floors -->")[1].split("<!-- end of floors -->")[0]
    rooms = {path.name for path in (ROOT / "comparisons").iterdir() if (path / "__init__.py").is_file()}
    assert rooms == FLOORS.keys()
    for row in page.splitlines():
        if floor := re.match(r"\| comparisons (\d) \| ([^|]*)\|", row):
            named = set(re.findall(r"`([a-z]+)`", floor[2]))
            assert {FLOORS[room] for room in named} == {int(floor[1])}, row
            rooms -= named
    assert not rooms, f"CONTRIBUTING.md has no row of {', '.join(sorted(rooms))}"


def module_of(path):
    """The module's name; a folder's `__init__` under a name of its own: it only re-exports."""
    return ".".join(path.relative_to(ROOT).with_suffix("").parts)


def without_types(path):
    """A file's code without what it imports for types alone, which no program runs."""
    blocks = [node for node in nodes_of(path) if isinstance(node, ast.If)]
    for_types = [node for node in blocks if ast.unparse(node.test) == "TYPE_CHECKING"]
    left_out = {inner for block in for_types for part in block.body for inner in ast.walk(part)}
    return [node for node in nodes_of(path) if node not in left_out]


@pytest.mark.parametrize("package", PACKAGES)
def test_no_file_imports_itself_by_way_of_others(package):
    """Imports within functions count, and those for types too, but of the face; a folder stands for the files
    that it re-exports. A question computes its answer; the answer makes its tables and names its figures."""
    files = {module_of(path): path for path in (ROOT / package).rglob("*.py")}
    exported: dict[str, set[str]] = {}

    def modules(path):
        found = set()
        for node in without_types(path) if package == "sheetbench" else nodes_of(path):
            if isinstance(node, ast.ImportFrom):
                for name in (alias.name for alias in node.names):
                    inner, folder = f"{node.module}.{name}", f"{node.module}.__init__"
                    if node.module in files or inner in files:
                        found.add(inner if inner in files else node.module)
                    elif folder in files:
                        found |= exported.get(folder) or exported.setdefault(folder, modules(files[folder]))
        return found

    graph = {name: modules(path) for name, path in files.items() if path.name != "__init__.py"}
    assert not circles(graph)


ROOMS_OF_SCENES = {"language": 0, "objects": 1, "meaning": 2}  # what is in no room is above them


def test_rooms_of_the_scenes_import_from_lower_floors_and_in_no_circle():
    scenes = ROOT / "sheetbench/scenes"
    files = {module_of(path): path for path in scenes.rglob("*.py") if path.name != "__init__.py"}
    graph: dict[str, set[str]] = {}
    for name, path in files.items():
        below = {f"{module}.{part}" for module, part in names_from(path)} | {m for m, _ in names_from(path)}
        graph[name] = below & files.keys()
        floors = [ROOMS_OF_SCENES.get(other.split(".")[2], 3) for other in graph[name]]
        own = ROOMS_OF_SCENES.get(name.split(".")[2], 3)
        assert max(floors, default=0) <= own, f"{name} imports from a higher floor"
    assert not circles(graph)


def test_every_figure_of_the_pages_exists():
    """Figures are named by module and function, and loaded when they are drawn."""
    text = "".join(map(text_of, files_of(*PACKAGES)))
    named = set(re.findall(r'"((?:sheetbench|comparisons|fem_reference|studies)[\w.]*figure):(\w+)"', text))
    assert len(named) > 10
    for module, function in named:
        assert callable(getattr(import_module(module), function)), f"{module}:{function}"


# imported where they are used, as they decide how soon a command answers: the solvers (compiled kernels) and
# what draws, reads or writes by a large library; the command line and the face import nothing before its use
SLOW = (
    "lumped", "fem_reference", "scipy", "matplotlib", "vtkmodules", "pyvista", "meshio", "pandas", "xarray",
)  # fmt: skip
SLOW += ("mujoco", "KratosMultiphysics", "felupe", "distributed", "comparisons.models.training")
SLOW += ("ezc3d", "ezdxf", "svgelements", "shapely")
SLOW += ("comparisons.sweep.campaign",)  # multiprocessing, sqlite3
DRAWS = ("figure", "style", "layout", "motion_figure", "comparison_figure", "animation")
DRAWS += ("offscreen", "check_figure", "array_files", "toml")
AT_ONCE = ("comparisons/cli/", *(f"sheetbench/{n}.py" for n in ("face", "__init__", "__main__")))


def test_imports_within_functions_are_for_a_quick_start_alone():
    for path in files_of(*PACKAGES):
        place = path.relative_to(ROOT).as_posix()
        if place.startswith(AT_ONCE):
            continue
        for function in nodes_of(path):
            if isinstance(function, ast.FunctionDef):
                for node in ast.walk(function):
                    if isinstance(node, ast.ImportFrom | ast.Import):
                        module = node.module if isinstance(node, ast.ImportFrom) else node.names[0].name
                        slow = str(module).startswith(SLOW) or str(module).split(".")[-1] in DRAWS
                        assert slow, f"{place}:{node.lineno} imports {module} within a function"


def names_from(path):
    """(module, name) of every name that a file imports from a module of ours, and its own module's name."""
    return [
        (str(node.module), alias.name)
        for node in nodes_of(path)
        if isinstance(node, ast.ImportFrom) and str(node.module).split(".")[0] in PACKAGES
        for alias in node.names
    ]


def test_the_lattice_is_used_through_its_public_names():
    for path in files_of("comparisons", "studies"):
        for module, name in names_from(path):
            inside = module.startswith("lumped.") or (module == "lumped" and name not in lumped.__all__)
            assert not inside, f"{path.relative_to(ROOT)} imports {name} from {module}"


def test_no_file_of_lumped_imports_a_private_name():
    for path in files_of("lumped"):
        for module, name in names_from(path):
            assert not name.startswith("_"), f"{path.relative_to(ROOT)} imports {name} from {module}"


def test_misuse_is_refused_by_an_error_of_its_own():
    """Whoever reads BadInput knows that the input is to blame, and of any other error that the program is."""
    for path in files_of("lumped", "fem_reference", "comparisons", "studies"):
        for node in nodes_of(path):
            if isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
                raised = ast.unparse(node.exc.func)
                assert raised not in ("ValueError", "TypeError"), f"{path}:{node.lineno}: {raised}"


def test_tests_share_by_modules_of_their_own_and_stay_short():
    """No test module imports another: what two need is in conftest.py or a module without tests."""
    for path in files_of("tests"):
        assert len(text_of(path).splitlines()) <= 350, path
        shared = re.findall(r"^ *(?:from|import) (test_\w+)", text_of(path), re.M)
        assert not shared, f"{path.relative_to(ROOT)} imports {', '.join(shared)}"


CORE = ("lumped", "fem_reference", "sheetbench")


def test_a_class_name_means_one_thing_in_the_core():
    files = {}
    for path in files_of(*CORE):
        for node in ast.parse(text_of(path)).body:
            if isinstance(node, ast.ClassDef):
                files.setdefault(node.name, []).append(path.relative_to(ROOT).as_posix())
    twice = {name: where for name, where in files.items() if len(where) > 1}
    assert not twice


def test_functions_of_the_core_take_nine_parameters_at_most():
    """But compiled ones, which take no objects."""
    for path in files_of(*CORE):
        for node in (node for node in nodes_of(path) if isinstance(node, ast.FunctionDef)):
            if "jit" not in "".join(map(ast.unparse, node.decorator_list)):
                names = [a.arg for a in (*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs)]
                assert len({*names} - {"self", "cls"}) <= 9, f"{path.relative_to(ROOT)}: {node.name}"
