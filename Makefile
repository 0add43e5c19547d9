# Two commands do it all on a bare Debian machine: `make demo` and `make test`.
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
OUT    ?= demo
# as a path, which editors and type checkers follow; an import hook they do not
EDITABLE := --config-settings editable_mode=compat --editable
FUZZ   ?=
KILLS  ?=
CHECK  := $(addprefix tests/test_,architecture.py scenes.py refusals.py catalogue.py cli.py compare.py \
            lattice.py lattice_mechanics.py lumped_statics.py calibration.py balance.py dynamics_forces.py \
            shell_element.py shell_linear.py solid_element.py sections.py snaps.py campaign.py \
            report.py measurements.py) tests/fuzz

.PHONY: docs docs-scene help install demo wheel test check kernels slow fuzz kills catalogue verify locking coverage transfer expected-errors coarse tradeoff \
        advisor-study animations pictures notebooks reproduce crosscheck peers bench central simulators stability stability-full suite standing mutants viewer \
        wheel-check extras-check lint clean
help:
	@echo "make demo      set up and compare both models on test 1 of the published study, Habibi et al. (files in $(OUT)/)"
	@echo "make test      set up and run the tests, the linter and the type checker"
	@echo "make check     the linter and the part of the tests that finds most faults soonest (a minute and a half)"
	@echo "make slow      the tests that take minutes"
	@echo "make fuzz      20 000 scenes, 1 000 of them solved, command lines and measured files that no one would write"
	@echo "               (half an hour; goes on where it stopped; files in $(OUT)/fuzz/; others: FUZZ='--seed 2 --scenes 500')"
	@echo "make kills     a hundred kills of campaigns, runs and trade-offs, and what stands there after (ten minutes; $(OUT)/kills/)"
	@echo "make mutants   how many of 120 faults put into the packages the tests notice: docs/quality.md (an hour; goes on where it stopped)"
	@echo "make catalogue the table of the catalogue's answers, tests/catalogue.json, for a change that is meant"
	@echo "make verify    the references against published values, every row (about a minute)"
	@echo "make locking   the locking sweeps and their picture (files in $(OUT)/locking/)"
	@echo "make coverage  how often the references' error bars hold, on forty drawn scenes (20 minutes of one processor, resumed; files in $(OUT)/coverage/): a row of docs/theory.md"
	@echo "make central   the table of the calibration central, trained anew (three minutes)"
	@echo "make simulators  other simulators with what we export for them (two minutes; files in $(OUT)/simulators/)"
	@echo "make transfer  every calibration on every scene of the transfer study: docs/transfer.md (ten minutes)"
	@echo "make expected-errors  the expected error of a lattice's grid on a hundred scenes, beside the true one: a table of docs/theory.md (ten minutes; ARGS=--anew solves all again)"
	@echo "make coarse    coarse grids, even and graded by the scene's layers, on the transfer study's scenes (files in $(OUT)/coarse*/)"
	@echo "make tradeoff  error against time on test 1 of Habibi et al., with the picture (files in $(OUT)/)"
	@echo "make advisor-study  the advisor on sixty random scenes (files in $(OUT)/advisor/; up to half an hour)"
	@echo "make reproduce the study of Habibi et al. again: docs/reproduction.md and its pictures (a minute and a half)"
	@echo "make crosscheck every model and other people's programs on eight scenes: docs/crosscheck.md (ten minutes)"
	@echo "make peers     ours and other people's codes in one run: docs/peers.md and its picture (six minutes)"
	@echo "make stability where each solver holds, degrades, refuses or breaks: eight maps (six minutes; files in $(OUT)/stability/)"
	@echo "make stability-full  every cell of them, 257 x 257 masses among them: docs/stability.md and its maps (twenty minutes)"
	@echo "make bench     settling beside SciPy's BDF, statics, explicit steps, start-up: time and what it goes to (files in $(OUT)/, history in benchmarks/history/)"
	@echo "make suite     the reference set anew, comparisons/suite/data (ten minutes; a change of values is a new version)"
	@echo "make viewer    the viewer of sheets in a browser, comparisons/browser/viewer.js, from its source (needs Node)"
	@echo "make standing  where models, plug-ins and judges stand on that set (three minutes; MODELS=felupe:elements=4 for one that takes longer): docs/suite.md"
	@echo "make docs-scene  the page of every key of a scene and its sketch, docs/scene.md, from the types"
	@echo "make animations  the README's moving pictures, docs/images/settling.gif and actuated.gif (two minutes)"
	@echo "make pictures  the still pictures of the README and of docs/motion.md, live.md and report.md (a minute; needs chromium)"
	@echo "make notebooks the notebooks of docs/notebooks anew, with what they print and draw"
	@echo "make docs      the documentation as a site, docs/_build/html/index.html (three minutes; a warning is an error)"
	@echo "make wheel     a wheel for this Python with its kernels compiled (dist/)"
	@echo "make wheel-check  the wheel as its users get it: installed elsewhere, run there, uninstalled without a trace"
	@echo "make extras-check  the wheel with each extra on its own, and with none, in environments that have nothing else"
	@echo "make install   set up only: $(BIN)/sheetbench"
	@echo "make clean     remove the environment and the demo's files"

install: $(VENV)/installed

$(VENV)/installed: pyproject.toml constraints.txt
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
	  { echo "sheetbench needs Python 3.11 or newer: install the Debian package python3, or name one with 'make PYTHON=python3.12 ...'."; exit 1; }
	@$(PYTHON) -c 'import venv, ensurepip' 2>/dev/null || \
	  { echo "$(PYTHON) cannot make virtual environments: install the Debian package python3-venv."; exit 1; }
	@echo "setting up $(VENV) (about a minute the first time)"
	@$(PYTHON) -m venv $(VENV)
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt $(EDITABLE) .
	@touch $@

# what only tests need comes with the first of them
$(VENV)/testing: $(VENV)/installed
	@echo "adding what the tests need (about half a minute the first time)"
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt $(EDITABLE) '.[test]'
	@touch $@

demo: install
	@$(BIN)/sheetbench compare two-edges-clamped --lumped 9 --reference shell --out $(OUT)

# a process that may not keep its byte code compiles every module anew, and the tests start many
test check: export PYTHONDONTWRITEBYTECODE :=
# the tests' processes are as many as processors are: BLAS's own threads would wait for each other, busily
test check: export OPENBLAS_NUM_THREADS := 1

test: $(VENV)/testing lint kernels
	@$(BIN)/python -m pytest --numprocesses auto --dist loadfile

check: $(VENV)/testing lint kernels
	@$(BIN)/python -m pytest --numprocesses auto --dist loadfile $(CHECK)

# once, and not by each of the tests' processes
kernels: $(VENV)/testing
	@$(BIN)/python tests/kernels.py

slow: $(VENV)/testing
	@$(BIN)/python -m pytest --numprocesses auto -m slow

fuzz: $(VENV)/testing
	@PYTHONPATH=tests $(BIN)/python -m fuzz.long $(OUT)/fuzz $(FUZZ)

kills: $(VENV)/testing
	@PYTHONPATH=tests $(BIN)/python -m fuzz.kills $(OUT)/kills $(KILLS)

catalogue: $(VENV)/testing
	@$(BIN)/python tests/catalogue.py

verify: install
	@$(BIN)/sheetbench verify

locking: install
	@$(BIN)/sheetbench verify --locking --out $(OUT)/locking

coverage: install
	@$(BIN)/sheetbench verify --coverage --out $(OUT)/coverage; status=$$?; \
	  $(BIN)/python docs/coverage_row.py $(OUT)/coverage/coverage.json && exit $$status

central: install
	@$(BIN)/python -m comparisons.cli.central_table

simulators: install
	@$(BIN)/python -m comparisons.cli.simulators_study --out $(OUT)/simulators

transfer: install
	@$(BIN)/sheetbench transfer --out $(OUT)/transfer
	@sed -e '1s/.*/# The transfer study, every table/' -e '3s/.*/Written by `make transfer`; read it with [calibration.md](calibration.md)./' \
	  $(OUT)/transfer/transfer.md > docs/transfer.md
	@$(BIN)/python -m pytest -m slow tests/test_transfer.py

expected-errors: install kernels
	@$(BIN)/python tests/expected_errors.py $(ARGS)

coarse: install
	@$(BIN)/sheetbench transfer --methods auto,consistent,consistent-membrane --part static --grids 9,17 --elements 16 \
	  --out $(OUT)/coarse-even
	@$(BIN)/sheetbench transfer --methods auto,consistent,consistent-membrane --part static --grids 9,17 --elements 16 \
	  --grading auto --out $(OUT)/coarse

tradeoff: install
	@$(BIN)/sheetbench tradeoff two-edges-clamped --lumped 3,5,7,9,17,33 --calibration consistent,consistent-interior,cauchy,uniform \
	  --shell 2,3,4,8,12,16 --solid 2,4,8 --model mujoco:grid=5 --model mujoco:grid=9 --model mujoco:grid=17 \
	  --out $(OUT)
	@cp $(OUT)/tradeoff.png docs/images/tradeoff.png

# other people's codes in an environment of their own; CalculiX where ccx is on the PATH
.venv-peers/installed: pyproject.toml constraints.txt
	@echo "setting up .venv-peers (about two minutes the first time)"
	@$(PYTHON) -m venv .venv-peers
	@.venv-peers/bin/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt \
	  $(EDITABLE) '.[kratos,felupe,mujoco]'
	@touch $@

peers: .venv-peers/installed
	@OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 NUMBA_NUM_THREADS=1 \
	  .venv-peers/bin/python -m comparisons.cli.peers_study --out $(OUT)/peers
	@sed 's#(peers.png)#(images/peers.png)#' $(OUT)/peers/peers.md > docs/peers.md
	@cp $(OUT)/peers/peers.png docs/images/peers.png

reproduce: install
	@$(BIN)/sheetbench reproduce --out $(OUT)/reproduction --overwrite
	@sed 's#](\([a-z0-9-]*\)\.png)#](images/reproduction/\1.png)#' $(OUT)/reproduction/reproduction.md > docs/reproduction.md
	@mkdir -p docs/images/reproduction
	@cp $(OUT)/reproduction/*.png docs/images/reproduction/

crosscheck: install
	@$(BIN)/python -m sheetbench crosscheck all docs/crosscheck/*.toml --out $(OUT)/crosscheck
	@cp $(OUT)/crosscheck/crosscheck.md docs/crosscheck.md

advisor-study: install
	@$(BIN)/python -m comparisons.cli.advisor_study --out $(OUT)/advisor

stability: install
	@$(BIN)/sheetbench stability --out $(OUT)/stability
	@$(BIN)/python -m pytest -m slow tests/test_stability.py

stability-full: install
	@$(BIN)/sheetbench stability --full --out $(OUT)/stability-full
	@cp $(OUT)/stability-full/*.csv $(OUT)/stability-full/*.png $(OUT)/stability-full/stability.md \
	  $(OUT)/stability-full/manifest.json docs/stability/
	@$(BIN)/python docs/stability_page.py

suite: install
	@$(BIN)/python -m comparisons.suite.regenerate
	@$(BIN)/python -m comparisons.suite.standing
	@$(BIN)/python -m sheetbench suite --out $(OUT)/suite --overwrite
	@cp $(OUT)/suite/cases.md docs/suite.md

standing: install
	@$(BIN)/python -m comparisons.suite.standing $(MODELS)
	@$(BIN)/python -m sheetbench suite --out $(OUT)/suite --overwrite
	@cp $(OUT)/suite/cases.md docs/suite.md

docs: install
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt $(EDITABLE) '.[docs]'
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
	@cp $(OUT)/settling/animation.gif docs/images/settling.gif
	@cp $(OUT)/actuated/animation.gif docs/images/actuated.gif

pictures: install
	@$(BIN)/python docs/pictures.py
	@$(BIN)/sheetbench compare two-edges-clamped --no-pictures --overwrite --out $(OUT)/page >/dev/null
	@$(BIN)/python docs/page_pictures.py $(OUT)/page

notebooks: $(VENV)/testing
	@$(BIN)/python docs/run_notebooks.py

docs-scene: install
	@$(BIN)/python docs/scene_sketch.py
	@$(BIN)/sheetbench schema --markdown > docs/scene.md

# OPTIONS='--survivors TEXT --tests FILE…' tries again what survived
mutants: $(VENV)/testing
	@$(BIN)/python tests/mutants/session.py $(OUT)/mutants $(OPTIONS)
	@$(BIN)/python tests/mutants/page.py docs/quality.md

wheel-check: install
	@.ci/wheel-check $(BIN)/python

wheel: install
	@.ci/wheel $(BIN)/python dist

extras-check: install
	@.ci/extras-check $(PYTHON)

viewer:
	@cd comparisons/browser/source && npm ci --ignore-scripts --silent && npm run --silent build

lint: $(VENV)/testing
	@$(BIN)/ruff check .
	@$(BIN)/mypy

clean:
	rm -rf $(VENV) $(OUT) build *.egg-info docs/_build docs/verbs docs/examples
