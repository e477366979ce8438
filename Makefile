# The front door: every target installs what is missing, configures, builds, then does its work.
#   make run [ARGS="configs/pool.json --threads 2"]   make test   make bench   make validate   make build
BUILD ?= build
ARGS ?=
CMAKE_ARGS ?=

.PHONY: run test build configure bench validate stress fuzz documents knobs program gpu-check gpu-bundle python site sanitize check-format check-headers format release library install clean

# Only what it needs: the tests are built by `make build`.
run: program
	@$(BUILD)/spindrift $(ARGS)

test: build
	ctest --test-dir $(BUILD) --output-on-failure -j $$(nproc)

# The first run on a machine is what later ones are compared with; rm .bench-baseline.json to begin anew.
bench: program
	@$(BUILD)/spindrift bench --baseline .bench-baseline.json $(ARGS)

# All flows with a known answer, about half an hour; figures and charts into build/validation. make validate ARGS="cavity_re100"
validate: program
	$(BUILD)/spindrift validate --out $(BUILD)/validation $(ARGS)

# Runs that are meant to break the physics, all of them, and maps of what is stable: a quarter of an hour.
stress: program
	$(BUILD)/spindrift stress --full --out $(BUILD)/stress $(ARGS)

# Any text as a scene file, for ten minutes: libFuzzer with AddressSanitizer and UndefinedBehaviorSanitizer; needs clang.
# What is found stays in build-fuzz/; make fuzz ARGS=build-fuzz/crash-... runs one input.
fuzz: install
	@command -v clang++ >/dev/null || { echo "make fuzz needs clang: apt-get install clang" >&2; exit 1; }
	@mkdir -p build-fuzz/corpus
	clang++ -std=c++20 -O1 -g1 -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined -Isource \
		$(filter-out %/system_plain.cpp,$(wildcard source/core/*.cpp)) source/scene/*.cpp tests/fuzz/scene_fuzz.cpp $$(pkg-config --cflags --libs hdf5) -lfmt -lassimp -lgomp -o build-fuzz/scene_fuzz
	build-fuzz/scene_fuzz -max_len=6000 -timeout=10 -artifact_prefix=build-fuzz/ -dict=tests/fuzz/scene.dict \
		$(or $(ARGS),-max_total_time=600 -print_final_stats=1 build-fuzz/corpus configs configs/test configs/validation)

# What docs/ACCURACY.md and docs/STABILITY.md say below their marks, measured anew: an hour. Missed targets don't end it.
documents: program
	-$(BUILD)/spindrift validate --out $(BUILD)/validation
	$(BUILD)/spindrift bench --error --out $(BUILD)/error
	-$(BUILD)/spindrift stress --full --random 3000 --out $(BUILD)/stress
	docs/fill_in.sh docs/ACCURACY.md $(BUILD)/validation/validation.md $(BUILD)/error/error.md
	docs/fill_in.sh docs/STABILITY.md $(BUILD)/stress/stability.md
	cp $(BUILD)/error/*.svg $(BUILD)/stress/*.svg docs/images/

# The knobs in docs/SCENES.md, after a change of source/scene/schema.h.
knobs: program
	@$(BUILD)/spindrift schema --markdown > $(BUILD)/knobs.md
	docs/fill_in.sh docs/SCENES.md $(BUILD)/knobs.md

# One format, by .clang-format: whether it is kept, and what makes it so.
check-format: install
	@git ls-files '*.cpp' '*.h' '*.cu' | xargs clang-format --dry-run --Werror

format: install
	@git ls-files '*.cpp' '*.h' '*.cu' | xargs clang-format -i

# Whether each header of source/ can be included by itself, two minutes.
check-headers: install
	tests/check_headers.sh

# For machines other than this one: kernels for each GPU architecture that nvcc knows, no tests.
release: install
	cmake -S . -B build-release -G Ninja --log-level=WARNING -DSPINDRIFT_TESTS=OFF \
		"-DSPINDRIFT_CUDA_ARCHITECTURES=75;80;86;89;90;100;120" $(CMAKE_ARGS)
	@cmake --build build-release --target spindrift

program: configure
	@cmake --build $(BUILD) --target spindrift

# What others build on, include/spindrift/spindrift.h and find_package(spindrift): make library PREFIX=/usr/local
library: configure
	@cmake --build $(BUILD) --target spindrift_sim
	cmake --install $(BUILD) --prefix $(or $(PREFIX),$(BUILD)/installed) --component library

# All checks and figures of the GPU, into docs/results/; without a GPU a dry run that writes nothing there. Programs that
# are there already (gpu-bundle made them on a machine with a compiler): make gpu-check BUNDLE=folder
gpu-check: $(if $(BUNDLE),,build)
	python3 tests/cuda/gpu_check.py $(or $(BUNDLE),$(BUILD)) $(ARGS)

# The programs that gpu-check needs and their libraries, in one folder and one archive that run on other machines with an
# H100 or H200 (sm_90; BUNDLE_ARCHITECTURES for others). The window and what it drags in stay at home.
BUNDLE_ARCHITECTURES ?= 90
gpu-bundle: install
	cmake -S . -B build-gpu -G Ninja --log-level=WARNING -DSPINDRIFT_WINDOW=OFF \
		"-DSPINDRIFT_CUDA_ARCHITECTURES=$(BUNDLE_ARCHITECTURES)" '-DCMAKE_BUILD_RPATH=$$ORIGIN/lib' \
		-DCMAKE_EXE_LINKER_FLAGS=-Wl,--disable-new-dtags $(CMAKE_ARGS)
	@cmake --build build-gpu --target spindrift unit_tests cuda_tests cuda_sort_bench
	tests/cuda/bundle.sh build-gpu $(or $(BUNDLE),build-gpu/bundle)

# import spindrift; PREFIX=/usr/local installs it there, else: PYTHONPATH=build/python python3
python: configure
	@cmake --build $(BUILD) --target spindrift_python
	$(if $(PREFIX),cmake --install $(BUILD) --prefix $(PREFIX) --component python)

build: configure
	@cmake --build $(BUILD)

# The documentation with its pictures as a site in build/site, links checked; needs mkdocs.
site:
	@command -v mkdocs >/dev/null || { echo "make site needs mkdocs: apt-get install mkdocs" >&2; exit 1; }
	mkdocs build --quiet --site-dir $(BUILD)/site

configure: install
	@test -f $(BUILD)/build.ninja || cmake -S . -B $(BUILD) -G Ninja --log-level=WARNING $(CMAKE_ARGS)

# The other build system, from the same source lists: AddressSanitizer and UndefinedBehaviorSanitizer, over all but the
# window's tests and those that take minutes with the checks in. One instruction set that every machine has, and double
# precision, are enough. (Optimization 3 takes four times as long to compile with the checks in.)
LONG_TESTS = HealthGuard.*:Rest.*:Plan.OfEachShippedScene:NeighbourLists.KeptListsMissNobody:Integrators.FlowsHaveTheirOrder:$\
	Conservation.*:BlockTimeSteps.LetAPoolRest:MeshesAndFluid.HaveFluidPackedBesideThem:MeshSolids.AreTheSameInEachWriting:$\
	*SumsAgreeAfterManySteps*
sanitize: install
	@test -f build-sanitize/build.ninja || meson setup build-sanitize \
		-Db_sanitize=address,undefined -Db_lundef=false -Doptimization=1 -Dsimd=sse
	@ninja -C build-sanitize spindrift flap_example unit_tests render_tests emulated_cuda_tests
	LSAN_OPTIONS=suppressions=$(CURDIR)/tests/lsan.supp GTEST_FILTER="-$(LONG_TESTS)" \
		meson test -C build-sanitize --no-rebuild --print-errorlogs --num-processes 2 unit render emulated_cuda example

install:
	@third_party/install.sh

clean:
	rm -rf build build-sanitize build-release build-gpu build-fuzz
