# Two commands do it all on a bare Debian machine: `make demo` and `make test`.
PYTHON ?= python3
VENV   := .venv
BIN    := $(VENV)/bin
OUT    ?= demo

.PHONY: help install demo test verify locking transfer lint clean
help:
	@echo "make demo      set up and compare both models on the seed's test 1 (files in $(OUT)/)"
	@echo "make test      set up and run the tests, the linter and the type checker"
	@echo "make verify    the references against published values, every row (about a minute)"
	@echo "make locking   the locking sweeps and their picture (files in $(OUT)/)"
	@echo "make transfer  every calibration on every scene of the transfer study (a quarter of an hour; files in $(OUT)/transfer/)"
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
	@$(BIN)/python -m pip install --quiet --disable-pip-version-check --constraint constraints.txt --editable '.[test]'
	@touch $@

demo: install
	@$(BIN)/sheetbench compare two-edges-clamped --lumped 9 --reference shell --out $(OUT)

test: install lint
	@$(BIN)/python -m pytest

verify: install
	@$(BIN)/sheetbench verify

locking: install
	@$(BIN)/sheetbench verify --locking --out $(OUT)

transfer: install
	@$(BIN)/sheetbench transfer --out $(OUT)/transfer
	@$(BIN)/python -m pytest -m slow tests/test_transfer.py

lint: install
	@$(BIN)/ruff check .
	@$(BIN)/mypy

clean:
	rm -rf $(VENV) $(OUT) build *.egg-info
