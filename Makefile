# Two commands do it all on a bare Debian machine: `make demo` and `make test`.
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
OUT    ?= demo
# as a path, which editors and type checkers follow; an import hook they do not
EDITABLE := --config-settings editable_mode=compat --editable
SEED   ?= 1
RELEASED ?= python3.11 python3.12 python3.13
# uv installs in a tenth of pip's time; where it cannot, pip does
packages = $(BIN)/uv pip install --quiet --python $(BIN)/python --constraint constraints.txt $(1) 2>/dev/null || \
           $(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt $(1)

.PHONY: docs docs-scene help install demo ready test check nightly kernels slow fuzz kills sizes catalogue verify tradeoff animations pictures \
        bench mutants tests-of viewer wheel-check extras-check release-check lint clean
help:
	@echo "make demo      set up and compare both models on test 1 of the published study, Habibi et al. (files in $(OUT)/)"
	@echo "make test      set up and run the tests, the linter and the type checker"
	@echo "make check     the linter and the part of the tests that finds most faults soonest (a minute and a half)"
	@echo "make slow      the tests that take minutes"
	@echo "make fuzz      20 000 scenes, 6 500 solved, command lines and measured files that no one would write"
	@echo "               (half an hour; others: SEED=2)"
	@echo "make kills     a hundred kills of campaigns, runs and trade-offs, and what stands there after (ten minutes; others: SEED=2)"
	@echo "make tests-of  the test files that run FILE=lumped/actuators/division.py, the nearest first"
	@echo "make mutants   faults put into FILE=… or PACKAGE=… that the tests which run them do not notice, of 20 (COUNT=…); docs/development/robustness.md"
	@echo "make sizes     files, lines and lines of code of the packages, words of the pages"
	@echo "make catalogue the table of the catalogue's answers, tests/helpers/catalogue.json, for a change that is meant"
	@echo "make verify    the references against published values, every row (about a minute)"
	@echo "make nightly   every other test, as those of the studies, notebooks, browsers and the slow ones (half an hour)"
	@echo "make studies   what the studies of the laboratory are, and the target of each (studies/Makefile)"
	@echo "make tradeoff  error against time on test 1 of Habibi et al., with the picture (files in $(OUT)/)"
	@echo "make bench     settling beside SciPy's BDF, statics, explicit steps, start-up: time and what it goes to (files in $(OUT)/, history in benchmarks/history/)"
	@echo "make viewer    the viewer of sheets in a browser, comparisons/pages/viewer.js, from its source (needs Node)"
	@echo "make docs-scene  the sketch of a scene, docs/images/scene.svg"
	@echo "make animations  the moving pictures of README and catalogue, docs/images/*.gif (four minutes)"
	@echo "make pictures  the still pictures of the README and of the pages (five minutes; needs chromium)"
	@echo "make docs      the documentation as a site, docs/_build/html/index.html (four minutes; a warning is an error)"
	@echo "make wheel-check  the wheel as its users get it: installed elsewhere, run there, uninstalled without a trace"
	@echo "make extras-check  the wheel with each extra on its own, and with none, in environments that have nothing else"
	@echo "make release-check  the wheel and the source distribution in dist/, the wheel tried bare on $(RELEASED)"
	@echo "make install   set up only: $(BIN)/sheetbench"
	@echo "make clean     remove the environment and the demo's files"

install: $(VENV)/installed

$(VENV)/installed: pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "sheetbench needs Python 3.11 or newer: install the Debian package python3, or name one with 'make PYTHON=python3.12 ...'."; exit 1; }
	@$(PYTHON) -c 'import venv, ensurepip' 2>/dev/null || \
	  { echo "$(PYTHON) cannot make virtual environments: install the Debian package python3-venv."; exit 1; }
	@echo "setting up $(VENV) (half a minute the first time)"
	@$(PYTHON) -m venv $(VENV)
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt uv || echo "without uv: pip takes a minute longer"
	@$(call packages,$(EDITABLE) .)
	@touch $@

# what only tests need comes with the first of them
$(VENV)/testing: $(VENV)/installed
	@echo "adding what the tests need (ten seconds the first time)"
	@$(call packages,$(EDITABLE) '.[test]')
	@touch $@

demo: install
	@$(BIN)/sheetbench compare two-edges-clamped --lumped 9 --reference shell --out $(OUT)

# a process that may not keep its byte code compiles every module anew, and the tests start many
demo test check nightly: export PYTHONDONTWRITEBYTECODE :=
# the tests' processes are as many as processors are: BLAS's own threads would wait for each other, busily
test check nightly: export OPENBLAS_NUM_THREADS := 1

# the type checker has one process: kernels are compiled beside it
ready: $(VENV)/testing
	@$(MAKE) --no-print-directory --jobs --output-sync lint kernels

test: ready
	@$(BIN)/python -m pytest --numprocesses auto --dist loadfile

check: ready
	@$(BIN)/python -m pytest --numprocesses auto --dist loadfile -m 'smoke and not nightly and not slow'

# what type checkers read of `import sheetbench`
stubs:
	@PYTHONPATH=tests/helpers $(BIN)/python tests/helpers/stubs.py

# once, and not by each of the tests' processes
kernels: $(VENV)/testing
	@$(BIN)/python tests/helpers/kernels.py

nightly: $(VENV)/testing kernels
	@$(BIN)/python -m pytest --numprocesses auto --dist loadfile -m 'nightly or slow'

slow: $(VENV)/testing
	@$(BIN)/python -m pytest --numprocesses auto -m slow

fuzz: $(VENV)/testing
	@FUZZ=$(SEED) $(BIN)/python -m pytest --numprocesses auto tests/fuzz/test_fuzz.py -k others

kills: $(VENV)/testing
	@FUZZ=$(SEED) $(BIN)/python -m pytest --numprocesses auto tests/fuzz/test_kills.py

sizes:
	@$(PYTHON) tests/helpers/sizes.py

catalogue: $(VENV)/testing
	@$(BIN)/python tests/helpers/catalogue.py

verify: install
	@$(BIN)/sheetbench verify

tradeoff: install
	@$(call packages,./examples/plug-ins)
	@$(BIN)/sheetbench tradeoff two-edges-clamped --lumped 3,5,7,9,17,33 --calibration consistent,consistent-interior,cauchy,uniform \
	  --shell 2,3,4,8,12,16 --solid 2,4,8 --model mujoco:grid=5 --model mujoco:grid=9 --model mujoco:grid=17 \
	  --out $(OUT)
	@cp $(OUT)/tradeoff.png docs/images/tradeoff.png

docs: install
	@$(call packages,$(EDITABLE) '.[docs]')
	@$(BIN)/python -m sphinx --quiet --fail-on-warning --keep-going --builder html docs docs/_build/html
	@echo "docs/_build/html/index.html"

bench: install
	@mkdir -p $(OUT)
	@$(BIN)/python benchmarks/settling.py --json $(OUT)/settling.json --keep
	@$(BIN)/python benchmarks/statics.py --json $(OUT)/statics.json --keep
	@$(BIN)/python benchmarks/shell.py --keep
	@OMP_NUM_THREADS=1 $(BIN)/python benchmarks/explicit_steps.py --keep
	@$(BIN)/python benchmarks/startup.py --first --keep

animations: install
	@$(BIN)/sheetbench simulate two-edges-settling --duration 1 --animate --out $(OUT)/settling
	@$(BIN)/sheetbench simulate actuated-edge --duration 1 --animate --out $(OUT)/actuated
	@$(BIN)/sheetbench compare two-edges-settling --duration 1 --animate --no-uncertainty --out $(OUT)/both
	@cp $(OUT)/both/both.gif docs/images/both.gif
	@cp $(OUT)/settling/animation.gif docs/images/settling.gif
	@cp $(OUT)/actuated/animation.gif docs/images/actuated.gif
	@$(BIN)/sheetbench simulate muscle-bands --duration 1.5 --animate --out $(OUT)/muscles
	@cp $(OUT)/muscles/animation.gif docs/images/muscles.gif
	@$(BIN)/sheetbench simulate strip-on-table --duration 1 --animate --out $(OUT)/laid
	@cp $(OUT)/laid/animation.gif docs/images/laid.gif

pictures: install
	@$(BIN)/python docs/pictures.py
	@$(BIN)/sheetbench compare two-edges-clamped --no-pictures --overwrite --out $(OUT)/page >/dev/null
	@$(BIN)/python docs/page_pictures.py $(OUT)/page

docs-scene: install
	@$(BIN)/python docs/scene_sketch.py

# FILE=lumped/actuators/division.py: the test files that run it, the nearest first; COUNT of them
tests-of:
	@$(PYTHON) tests/helpers/nearest.py $(FILE) $(COUNT)

# COUNT faults in FILE or PACKAGE, and which of them its nearest tests do not notice; goes on where it stopped
mutants: $(VENV)/testing
	@$(call packages,$(EDITABLE) . cosmic-ray)
	@$(BIN)/python tests/helpers/mutants.py $(OUT)/mutants $(FILE)$(PACKAGE) $(COUNT)

wheel-check: install
	@.ci/wheel-check $(BIN)/python

release-check:
	@.ci/release-check $(RELEASED)

extras-check: install
	@.ci/extras-check $(PYTHON)

viewer:
	@cd comparisons/pages/source && npm ci --ignore-scripts --silent && npm run --silent build

lint: $(VENV)/testing
	@$(BIN)/ruff check .
	@$(BIN)/mypy

clean:
	rm -rf $(VENV) $(OUT) build *.egg-info docs/_build docs/_try docs/verbs docs/tables docs/scene.md docs/examples

include studies/Makefile
