# `make test` and `make demo` work in a fresh clone; all they need besides make is Python 3.11.

PYTHON ?= python3.11
VENV := .venv
BIN := $(VENV)/bin
NOTEBOOKS := $(wildcard notebooks/*.ipynb)
DEMO := demo
GALLERY := gallery

.PHONY: help install format check test demo notebooks clean
.DEFAULT_GOAL := help

help:  ## Show this list
	@grep -E '^[a-z]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 12

install: $(VENV)/installed  ## Set up .venv with the tested versions

# torch first and alone: a version that is there is kept, so nobody gets a second build of it. The checker of
# OpenDRIVE files needs an older numpy, and LeRobot's reader asks for an older torch, so they live apart.
$(VENV)/installed: pyproject.toml constraints.txt scripts/opendrive_checker.txt scripts/lerobot_reader.txt
	$(PYTHON) -m venv $(VENV)
	$(BIN)/pip install --quiet --constraint constraints.txt torch
	$(BIN)/pip install --quiet --constraint constraints.txt --editable ".[dev]"
	$(PYTHON) -m venv $(VENV)/checker
	$(VENV)/checker/bin/pip install --quiet --requirement scripts/opendrive_checker.txt
	$(BIN)/pip install --quiet --no-deps --upgrade --target $(VENV)/lerobot --requirement scripts/lerobot_reader.txt
	touch $@

format: install  ## Format and mend what can be mended
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .

check: install  ## Lint, types, import contracts and tests: exactly what CI runs
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/typos
	$(BIN)/mypy
	$(BIN)/lint-imports
	# One thread each: there are as many processes as cores, and threads that share a core wait for each other.
	OMP_NUM_THREADS=1 $(BIN)/pytest --numprocesses auto --dist loadgroup $(if $(NOTEBOOKS),--nbmake notebooks) tests

test: check  ## The same

demo: install  ## Collect, train and drive small, in the folder demo/
	mkdir -p $(DEMO)
	cd $(DEMO) && ../$(BIN)/mjdrive collect --town town01 --preset quick
	cd $(DEMO) && ../$(BIN)/mjdrive train da-ibc --preset quick --overwrite
	cd $(DEMO) && ../$(BIN)/mjdrive drive --town town02
	@echo "Pictures:"
	@ls -d $(CURDIR)/$(DEMO)/data/town01/*.png $(CURDIR)/$(DEMO)/drives/*/*.png

notebooks: install  ## Run the notebooks, and show them on one page in gallery/
	$(BIN)/python scripts/notebook_gallery.py --out $(GALLERY)

clean:  ## Remove .venv, demo/ and gallery/
	rm -rf $(VENV) $(DEMO) $(GALLERY)
