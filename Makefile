# The front door: every target installs what is missing, configures, builds, then does its work.
#   make run [ARGS="configs/pool.json --threads 2"]   make test   make bench   make build
BUILD ?= build
ARGS ?=
CMAKE_ARGS ?=

.PHONY: run test build bench meson sanitize install clean

run: build
	@$(BUILD)/spindrift $(ARGS)

test: build
	ctest --test-dir $(BUILD) --output-on-failure

bench: build
	$(BUILD)/spindrift_bench $(ARGS)

build: install
	@test -f $(BUILD)/build.ninja || cmake -S . -B $(BUILD) -G Ninja $(CMAKE_ARGS)
	@cmake --build $(BUILD)

# The same targets from the same source lists with the other build system, and the same tests.
meson: install
	@test -f build-meson/build.ninja || meson setup build-meson --buildtype=release
	meson test -C build-meson --print-errorlogs

# AddressSanitizer and UndefinedBehaviorSanitizer over the unit tests.
sanitize: install
	@test -f build-sanitize/build.ninja || cmake -S . -B build-sanitize -G Ninja -DSPINDRIFT_CUDA=OFF \
		-DSPINDRIFT_BENCH=OFF -DSPINDRIFT_SANITIZE=address,undefined
	@cmake --build build-sanitize --target unit_tests
	ctest --test-dir build-sanitize --output-on-failure -L unit

install:
	@third_party/install.sh

clean:
	rm -rf build build-meson build-sanitize
