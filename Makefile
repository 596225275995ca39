# Everything runs in .venv, which the first target that needs it makes; no environment has to be active.
#   make demo     the six-speed gearbox launches and shifts: out/demo/
#   make test     tests: C++ core under sanitizers, then Python; make test-all: also what takes long
#   make check    format, lint, types, import contracts, spelling
#   make bench    speed against peers; ARGS="--write" puts the table into docs/benchmarks.md
#   make wasm     the core as WebAssembly: src/clutchwork/page/static/core.wasm
#   make fmu-libraries  the library of FMUs for other platforms: src/clutchwork/fmu/static/
#   make wheel    sdist, and a wheel for machines like this one, tried without a compiler: dist/
#   make release-check    the same, and what has to be true before a tag: CONTRIBUTING.md
#   make page     the script of pages that compute (needs node): src/clutchwork/page/static/
#   make docs     the documentation: build/docs/index.html
#   make pictures the pictures of the guides that something has changed for: docs/pictures/
#   make setup    the package with derivatives, in its environment
#   make clean    removes .venv, build and out

PYTHON ?= python3
# the built-in default of make is g++ even where only clang is installed
ifeq ($(origin CXX),default)
CXX := c++
endif
export CXX
unexport PYTHONPATH PYTHONHOME VIRTUAL_ENV

VENV := .venv
BIN := $(VENV)/bin
STAMPS := $(VENV)/stamps
# a worker for each core; the tests of one file stay together, for they share what is costly
PYTEST = $(BIN)/python -m pytest --numprocesses $(JOBS) --dist loadfile --no-loadscope-reorder
PIP := $(BIN)/python -m pip --disable-pip-version-check --quiet
JOBS ?= $(shell getconf _NPROCESSORS_ONLN 2>/dev/null || echo 2)

# what the compiled core and the type stub are made from; other Python files take effect without a build
CORE_SOURCES := $(shell find CMakeLists.txt cpp interfaces/python interfaces/fmi $(addprefix src/clutchwork/,base declare elements laws signals face/names.py) \
	-name '*.py' -o -name '*.hpp' -o -name '*.cpp' -o -name '*.h' -o -name '*.txt' 2>/dev/null) \
	$(wildcard tools/gen_registry.py tools/registry/*.py tools/gen_stubs.py)
WASM := src/clutchwork/page/static/core.wasm
# the page that computes: bundled where node is there
NODE := $(shell command -v npm 2>/dev/null)
PAGE := $(if $(NODE),build/page/stamp)
PAGE_SOURCES := $(wildcard interfaces/page/*.* interfaces/page/src/*)
CPP_FILES = $(shell git ls-files 'cpp/*.hpp' 'cpp/*.cpp' 'cpp/*.h' 'interfaces/*.cpp' 'interfaces/*.hpp' 'tests/cpp/*.cpp' 'tests/cpp/*.hpp')

# each recipe takes JOBS cores itself, and all install into one environment
.NOTPARALLEL:
.PHONY: help fmu-libraries setup demo test test-rest test-all test-cpp test-python page test-page check-page check format bench wasm wheel release-check docs picture pictures clean
.DELETE_ON_ERROR:

help:
	@sed -n '2,14p' Makefile | cut -c 3-

# ---------------------------------------------------------------- environment

setup: $(STAMPS)/package $(STAMPS)/draw

$(STAMPS)/venv: tools/prerequisites.sh
	@tools/prerequisites.sh $(PYTHON) $(CXX)
	@echo "making $(VENV)"
	@$(PYTHON) -m venv $(VENV)
	@mkdir -p $(STAMPS)
	@touch $@

# a stamp for each purpose, named as its extra in pyproject.toml
EXTRAS := build plot draw test check docs bench wasm wheel
WITH_EXTRA = $(BIN)/python tools/extras.py $(1) | $(PIP) install --no-compile --requirement /dev/stdin && touch $(STAMPS)/$(1)
$(EXTRAS:%=$(STAMPS)/%): $(STAMPS)/%: $(STAMPS)/venv pyproject.toml tools/extras.py
	@echo "installing what '$*' needs"
	@$(call WITH_EXTRA,$*)

# compiled for this machine, with or without derivatives; a wheel for others has a build of its own
COMPILER = CMAKE_BUILD_PARALLEL_LEVEL=$(JOBS) PATH="$(CURDIR)/$(BIN):$$PATH"
SETTING = --config-settings=cmake.define.CLUTCHWORK_
INSTALL = $(COMPILER) $(PIP) install --no-build-isolation --no-deps $(SETTING)NATIVE=ON $(SETTING)DERIVATIVES=$(1) --editable .

$(STAMPS)/package: $(STAMPS)/build $(CORE_SOURCES)
	@echo "building and installing clutchwork (a minute or two)"
	@$(call INSTALL,ON)
	@touch $(STAMPS)/core $@

# the same without derivatives, which take as long to compile as all the rest; matplotlib is installed meanwhile
$(STAMPS)/core: $(STAMPS)/build $(CORE_SOURCES)
	@echo "building and installing the core of clutchwork (about a minute)"
	@mkdir -p build
	@($(call WITH_EXTRA,plot)) >build/plot.log 2>&1 & plot=$$!; $(call INSTALL,OFF); failed=$$?; wait $$plot; exit $$failed
	@touch $@

# ---------------------------------------------------------------- what people want

# derivatives that are there stay
demo: $(STAMPS)/$(if $(wildcard $(STAMPS)/package),package,core) $(STAMPS)/plot
	@$(BIN)/clutchwork demo

# `test` has what is quick and a part of the random cases, `test-rest` all the others, `test-all` both: CONTRIBUTING.md
# all parts run, a failure of any fails the target, and pytest has the last word
test: TIER := first
test-rest: TIER := last
test-all: TIER := all
test test-all: PARTS := test-cpp $(if $(NODE),test-page)
# of the core: whole runs of other scalars, and all random cases
test-rest: PARTS := test-cpp
test: export CORE_TESTS := first_tier
test: export CTEST := -LE scalar
test-rest: export CTEST := -L last
test test-rest test-all: export CLUTCHWORK_TIER = $(TIER)
test test-rest test-all: $(STAMPS)/package $(STAMPS)/test $(WASM) $(PAGE)
	@failed="$$CLUTCHWORK_FAILED"; \
	for part in $(PARTS); do $(MAKE) --no-print-directory $$part || failed="$$failed make $$part;"; done; \
	CLUTCHWORK_FAILED="$$failed" $(PYTEST) --tier $(TIER) && [ "$$failed" = "$$CLUTCHWORK_FAILED" ]

test-cpp: $(STAMPS)/build
	@mkdir -p build
	@$(BIN)/cmake -S . -B build/cpp -G Ninja -DCMAKE_MAKE_PROGRAM=$(CURDIR)/$(BIN)/ninja \
		-DCMAKE_CXX_COMPILER=$(CXX) -DPython_EXECUTABLE=$(CURDIR)/$(BIN)/python \
		-DCLUTCHWORK_PYTHON=OFF -DCLUTCHWORK_TESTS=ON -DCLUTCHWORK_QUICK=ON >build/cpp.log 2>&1 || { cat build/cpp.log; exit 1; }
	@echo "building the tests of the core"
	@$(BIN)/cmake --build build/cpp --parallel $(JOBS) --target $(or $(CORE_TESTS),all) >build/cpp.log 2>&1 || { cat build/cpp.log; exit 1; }
	@$(BIN)/ctest --test-dir build/cpp --parallel $(JOBS) --output-on-failure $(CTEST)

# the script of pages, into the package
page: build/page/stamp

interfaces/page/node_modules/.package-lock.json: interfaces/page/package-lock.json
	@echo "installing what the page is made with"
	@cd interfaces/page && npm ci --silent && touch node_modules/.package-lock.json

build/page/stamp: interfaces/page/node_modules/.package-lock.json $(PAGE_SOURCES)
	@cd interfaces/page && npm run --silent build
	@touch $@

test-page: build/page/stamp
	@cd interfaces/page && npm run --silent test

check-page: interfaces/page/node_modules/.package-lock.json
	@cd interfaces/page && npm run --silent types && npm run --silent lint

test-python: $(STAMPS)/package $(STAMPS)/test $(WASM) $(PAGE)
	@$(PYTEST)

# every checker runs, so that one call shows all there is to fix
check: $(STAMPS)/package $(STAMPS)/check
	@bad=; try() { echo "== $$*" | cut -c 1-60; "$$@" || bad="$$bad $$1"; }; \
	try $(BIN)/ruff format --check --quiet .; \
	try $(BIN)/ruff check --quiet .; \
	try $(BIN)/mypy; \
	try $(BIN)/lint-imports --no-logo; \
	try $(BIN)/codespell; \
	try $(BIN)/clang-format --dry-run --Werror $(CPP_FILES); \
	try $(BIN)/lizard --languages cpp --length 60 --CCN 25 --warnings_only --exclude "*/node_modules/*" cpp interfaces; \
	if [ -n "$(NODE)" ]; then try $(MAKE) --no-print-directory check-page; fi; \
	if [ -n "$$bad" ]; then echo "make check found something:$$bad"; exit 1; fi; echo "make check: all is well"

format: $(STAMPS)/check
	$(BIN)/python tools/rooms.py
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .
	$(BIN)/clang-format -i $(CPP_FILES)

bench: $(STAMPS)/package $(STAMPS)/bench
	@$(BIN)/python -m benchmarks $(ARGS)

docs: $(STAMPS)/package $(STAMPS)/docs $(WASM) $(PAGE)
	@JOBS=$(JOBS) $(BIN)/python -m sphinx -W --keep-going -q --jobs $(JOBS) -b html -d build/doctrees docs build/docs
	@echo "build/docs/index.html"

wasm: $(WASM)

# made smaller where node is there
$(WASM): $(STAMPS)/wasm $(if $(NODE),interfaces/page/node_modules/.package-lock.json) $(CORE_SOURCES) tools/build_wasm.py
	@echo "compiling the core to WebAssembly (a minute or so)"
	@JOBS=$(JOBS) $(BIN)/python tools/build_wasm.py

# each FMU that is made where they are runs on all of these platforms
fmu-libraries: $(STAMPS)/wasm
	@echo "compiling the library of FMUs for other platforms (some minutes each)"
	@$(BIN)/python tools/build_fmu_libraries.py $(PLATFORMS)

# sdist, the wheel that it makes, repaired to a manylinux tag on Linux, and what a user does with it
# what it holds of pages needs npm here
wheel: $(STAMPS)/wheel $(WASM) build/page/stamp
	@rm -rf build/wheel && mkdir -p build/wheel/good dist
	@echo "packing the sdist, and building a wheel from it"
	@$(BIN)/python -c 'from scikit_build_core.build import build_sdist; build_sdist("build/wheel/good")' >build/wheel/sdist.log
	@$(COMPILER) $(PIP) wheel --no-build-isolation --no-deps --config-settings=build-dir=$(CURDIR)/build/wheel/cmake \
		$(SETTING)NATIVE=OFF $(SETTING)DERIVATIVES=ON --wheel-dir build/wheel/raw build/wheel/good/*.tar.gz
	@if [ "$$(uname)" = Linux ]; then \
		PATH="$(CURDIR)/$(BIN):$$PATH" $(BIN)/python -m auditwheel repair --wheel-dir build/wheel/good build/wheel/raw/*.whl; \
	else mv build/wheel/raw/*.whl build/wheel/good; fi
	@echo "installing it from an index of this machine, as README.md says"
	@$(PYTHON) tools/try_release.py build/wheel/good/*.whl
	@cp build/wheel/good/* dist && cd build/wheel/good && for made in *; do echo "dist/$$made"; done

# before a tag: the files of a release, what PyPI asks of them, and what pages say of the release
release-check: wheel $(STAMPS)/test
	@$(BIN)/python -m twine check --strict build/wheel/good/*
	@$(PYTEST) tests/docs/test_release.py tests/docs/test_changelog.py tests/docs/test_readme.py

# those of the guides that are missing or stale; ARGS=--all draws all of them
pictures: $(STAMPS)/package $(STAMPS)/docs
	@JOBS=$(JOBS) $(BIN)/python docs/figures/committed.py $(ARGS)

# the picture at the top of the README
picture: $(STAMPS)/package $(STAMPS)/plot $(WASM) build/page/stamp
	@$(BIN)/python tools/front_picture.py docs/_static/drag.gif
	@$(BIN)/python docs/figures/engagement.py docs/_static/engagement.png

clean:
	rm -rf $(VENV) build out docs/reference interfaces/page/node_modules src/clutchwork/page/static
