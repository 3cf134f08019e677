# make demo   the starfish scene: starfish.usd, starfish.png and its timings
# make test   lint, format check and the tests that are quick and need no program beside Python
# make check  the same with all tests: slow ones, and those that need a browser, Blender or a CUDA device
# All make .venv first, from python3 (3.11 or newer; PYTHON=... names another one).

PYTHON ?= python3
BIN := .venv/bin
export WARP_CACHE_PATH ?= $(CURDIR)/.cache/warp

.PHONY: demo test check

demo: .venv/examples.installed
	$(BIN)/python -m examples starfish --demo

test: TESTS := -m "not (slow or browser or blender or device)"
check: export CAGECUT_NIGHTLY := 1
test check: .venv/test.installed
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/python -m pytest $(TESTS)

$(BIN)/pip:
	$(PYTHON) -m venv .venv

.venv/%.installed: pyproject.toml | $(BIN)/pip
	@echo "installing what is needed into .venv: once, for a minute or two"
	$(BIN)/python -m pip install --quiet --editable '.[$*]'
	touch $@
