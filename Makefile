# make demo   the starfish scene: starfish.usd, starfish.png and its timings
# make test   lint, format check and all tests
# Both make .venv first, from python3 (3.11 or newer; PYTHON=... names another one).

PYTHON ?= python3
BIN := .venv/bin
export WARP_CACHE_PATH ?= $(CURDIR)/.cache/warp

.PHONY: demo test

demo: .venv/examples.installed
	$(BIN)/python -m examples starfish --demo

test: .venv/test.installed
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/python -m pytest

$(BIN)/pip:
	$(PYTHON) -m venv .venv

.venv/%.installed: pyproject.toml | $(BIN)/pip
	$(BIN)/python -m pip install --quiet --editable '.[$*]'
	touch $@
