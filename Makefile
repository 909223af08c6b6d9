# vodr: make builds build/vodr; make help lists the rest. All that is made lies under build/.
#
# BUILD, CC, CFLAGS and SANITIZE may be given: make BUILD=build/clang-O0 CC=clang CFLAGS=-O0; COVER, of cmodel/ alone: scripts/coverage
BUILD    ?= build
ifeq ($(origin CC),default)
CC       := gcc
endif
CFLAGS   ?= -O3
SANITIZE ?=
COVER    ?=

# Positions and tables are made in floating point: contraction would let compilers differ in their last bit.
# No vector crosses a call that is not inlined, so gcc's notes on how vectors are passed (-Wpsabi) mean nothing here.
STRICT   := -std=c11 -D_POSIX_C_SOURCE=200809L -D_FILE_OFFSET_BITS=64 -ffp-contract=off \
            -Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wno-psabi -Werror
INCLUDES := -I$(BUILD)/gen -Icmodel -Ihost -Ireference -Icluster -Irtl -Ivectors -isystem /usr/include/nifti
COMPILE   = $(CC) $(STRICT) $(CFLAGS) $(SANITIZE) $(INCLUDES) -pthread -MMD -MP
REFERENCE_MATHS := -fno-math-errno -fno-trapping-math # lanes take square roots side by side; no result changes
# Where lanes are loops, without a processor's vectors, -O3 would take most of a build, and is no faster.
LOOPS    := $(if $(filter -O3,$(CFLAGS)),-O1)

# CUDA is optional: without nvcc the reference renderer draws on the CPU only. NVCC= leaves it out.
NVCC     ?= $(firstword $(shell command -v nvcc) $(wildcard /usr/local/cuda/bin/nvcc))
CUDA_ARCH ?= $(if $(shell command -v nvidia-smi),native,compute_80)
NVCCFLAGS := -std=c++17 -O3 -arch=$(CUDA_ARCH) -Xcompiler -Wall,-Wextra
CUDA_HOME := $(patsubst %/bin/nvcc,%,$(realpath $(NVCC)))
CUDA_LIBRARIES := $(if $(NVCC),-L$(CUDA_HOME)/lib64 -lcudart_static -lstdc++ -ldl -lrt)

comma := ,
# MPI is optional: without mpicc `vodr cluster` draws in one process only. MPICC= leaves it out. What calls MPI is a library
# of its own, which processes of mpirun load, so that the program starts fast and needs no MPI.
MPICC    ?= $(shell command -v mpicc)
MPI_FLAGS := $(if $(MPICC),$(patsubst -I%,-isystem %,$(shell $(MPICC) --showme:compile)))

# IceT is a peer of compositing, measured where Debian's paraview-dev, or these two, has it (make table-balance).
ICET     ?= $(firstword $(wildcard /usr/include/paraview-*/vtkicet/src/include))
ICET_LIBRARIES ?= $(foreach part,MPI Core,$(firstword $(wildcard /usr/lib/*/libvtkIceT$(part)-pv*.so)))

LIBRARIES := -lteem -lnifti2 -lznz -lpng -lz -ljansson -lcrypto -lm -pthread $(if $(COVER),--coverage)

HW       := hw/parameters.txt hw/registers.txt
MACHINES := $(sort $(wildcard hw/machines/*.txt))
GEN      := $(BUILD)/gen/vodr_hw.h $(BUILD)/gen/vodr_hw.c $(BUILD)/gen/vodr_hw.vh $(BUILD)/gen/energy_text.c $(BUILD)/gen/synthesis_text.c
CMODEL   := $(patsubst %.c,$(BUILD)/%.o,$(wildcard cmodel/*.c)) $(BUILD)/gen/vodr_hw.o
HOST     := $(patsubst %.c,$(BUILD)/%.o,$(filter-out host/main.c,$(wildcard host/*.c))) \
            $(BUILD)/gen/energy_text.o $(BUILD)/gen/synthesis_text.o
RTL      := $(patsubst %.c,$(BUILD)/%.o,$(wildcard rtl/*.c))
CLUSTER  := $(patsubst %.c,$(BUILD)/%.o,$(wildcard cluster/*.c))
VECTORS  := $(patsubst %.c,$(BUILD)/%.o,$(wildcard vectors/*.c))
REFERENCE := $(patsubst %.c,$(BUILD)/%.o,$(filter-out reference/device_no_cuda.c,$(wildcard reference/*.c))) \
             $(BUILD)/reference/$(if $(NVCC),device_cuda.o,device_no_cuda.o)
TESTLIB  := $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/lib/*.c))
BENCHLIB := $(patsubst %.c,$(BUILD)/%.o,$(wildcard bench/lib/*.c))
TESTS    := $(patsubst %.c,$(BUILD)/%,$(wildcard tests/*.c))
REFERENCE_TESTS := $(filter $(BUILD)/tests/test_reference% $(BUILD)/tests/test_cluster $(BUILD)/tests/test_gpu_record,$(TESTS))
MIP_CASES := $(BUILD)/bench/record/mip_case.o $(BUILD)/bench/lib/synthetic.o # cases of the maximum are the record's
BENCHES  := $(patsubst %.c,$(BUILD)/%,$(wildcard bench/*.c)) $(addprefix $(BUILD)/bench/,gpu_record mip_frames cubic_frames aligned_frames)
# Random cases, as the tests draw them.
CASES    := host/camera host/host host/spline tests/lib/cases tests/lib/case_table tests/lib/case_view tests/lib/case_volume
# What bench/gpu_record is made of: nothing that needs more than a C library, so that it builds beside any card.
RECORD   := bench/record/gpu_record bench/record/$(if $(NVCC),baseline,baseline_none) bench/lib/stopwatch tests/lib/outcome $(CASES)
# The same of bench/mip_frames.
MIP      := bench/record/mip_frames bench/record/mip_case bench/record/stand_in bench/lib/enlarge bench/lib/stopwatch $(CASES)
# The same of bench/cubic_frames.
CUBIC    := bench/record/cubic_frames bench/record/cubic_cases bench/record/stand_in bench/lib/enlarge bench/lib/stopwatch $(CASES)
# The same of bench/aligned_frames.
ALIGNED  := $(patsubst bench/record/cubic_frames,bench/record/aligned_frames,$(CUBIC))
SOURCES  := $(filter-out build/%,$(wildcard */*.[ch] */*/*.[ch] rtl/*.cpp))
SCRIPTS  := $(wildcard scripts/* tests/*.sh tests/lib/*.sh) bench/aligned bench/balance bench/balance-lib bench/cardinal bench/cluster bench/mip bench/model bench/peers-lib bench/reference bench/teem-lib .ci/run

# What a target starts itself runs on all cores, unless make was given -j.
PARALLEL  = $(if $(filter -j%,$(MAKEFLAGS)),,-j$(shell nproc))

.PHONY: all help deps demo check check-long tests table-vodr table-cycles table-balance bench bench-cosim bench-model bench-reference bench-mip bench-cardinal bench-aligned bench-sweep cosim-long vectors findings contact-sheet crosscheck coverage verification fuzz lint format docs synth prove mutation clean

all: $(BUILD)/libreference.a $(BUILD)/vodr $(if $(MPICC),$(BUILD)/vodr-mpi.so) ## build build/vodr

help: ## list the targets
	@sed -n 's/^\([a-z][a-z-]*\):.*## /\1 - /p' Makefile | sort

deps: ## install what the build, the demo, the tests and lint need (Debian 12)
	@scripts/deps

demo: ## draw a CT head: the picture, its statistics, a report and Table 1 in build/demo/
	@scripts/deps demo
	@$(MAKE) -s $(PARALLEL) all $(BUILD)/bench/table_vodr
	@scripts/demo $(BUILD)

tests: $(TESTS) $(BENCHES) $(BUILD)/tests/lockstep/lockstep $(BUILD)/tests/mutation/mutants

check: ## run every test; the last line is `N passed, N failed`
	@scripts/deps check fuzz
	@$(MAKE) -s $(PARALLEL) all tests
	@scripts/check $(BUILD)

check-long: ## the same, with 10,000 random cases, 20,000 for the cycles
	@scripts/deps check fuzz
	@$(MAKE) -s $(PARALLEL) all tests
	@scripts/check --long $(BUILD)

vectors: ## write the vectors and golden frames that are kept in vectors/ again
	@$(MAKE) -s $(PARALLEL) $(BUILD)/vodr $(BUILD)/tests/test_frames
	@scripts/vectors $(BUILD)

cosim-long: ## whole frames of 256^3 in Verilog beside C, a million transactions a block, faults in every block (hours)
	@scripts/deps rtl check
	@$(MAKE) -s $(PARALLEL) all tests
	@$(BUILD)/tests/lockstep/lockstep --transactions 1000000
	@$(BUILD)/tests/test_cosim 1000
	@$(BUILD)/tests/test_pairwise 0
	@tests/cosim.sh --long $(BUILD)/vodr
	@scripts/cosim $(BUILD) 256

synth: ## synthesise the Verilog with Yosys, place what an iCE40 holds, and write docs/table-synthesis.md again (a quarter of an hour)
	@scripts/deps synth
	@$(MAKE) -s $(BUILD)/gen/vodr_hw.vh
	@scripts/synth $(BUILD)
	@scripts/tables $(BUILD) synthesis
	@cat $(BUILD)/tables/synthesis

coverage: $(BUILD)/gen/vodr_hw.vh ## what the tests reach, and docs/table-coverage.md again; fails below what is asked (a quarter of an hour)
	@scripts/deps coverage
	@$(MAKE) -s $(PARALLEL) BUILD=$(BUILD)/coverage CFLAGS=-O1 COVER='-O0 --coverage -fprofile-update=atomic' NVCC= \
	    $(addprefix $(BUILD)/coverage/,vodr tests/digest tests/lockstep/lockstep) \
	    $(patsubst $(BUILD)/%,$(BUILD)/coverage/%,$(filter $(BUILD)/tests/test_%,$(TESTS)))
	@scripts/coverage $(BUILD)/coverage

verification: ## gather all tables of what was verified into docs/verification.md
	@scripts/verification >docs/verification.md.new && mv docs/verification.md.new docs/verification.md

mutation: $(BUILD)/gen/vodr_hw.vh ## judge mutants of every block by vectors, lock-step and a SAT solver, and write docs/table-mutation.md again (an hour)
	@scripts/deps rtl check
	@$(MAKE) -s $(PARALLEL) $(BUILD)/tests/mutation/mutants
	@scripts/mutation $(BUILD)
	@scripts/tables $(BUILD) mutation
	@cat $(BUILD)/tables/mutation

prove: ## prove what rtl/formal says of the Verilog, refute its broken variants, and write docs/table-proofs.md again (minutes)
	@scripts/deps prove
	@$(MAKE) -s $(BUILD)/gen/vodr_hw.vh
	@scripts/prove $(BUILD)
	@scripts/tables $(BUILD) proofs

bench-cosim: ## measure the machine in Verilog beside the model in C, and write docs/cosimulation.md's table again
	@scripts/deps rtl
	@$(MAKE) -s $(PARALLEL) $(BUILD)/bench/cosim_rate
	@scripts/tables $(BUILD) cosim
	@cat $(BUILD)/tables/cosim

fuzz: ## fuzz every parser for an hour each, two at a time
	@scripts/deps fuzz
	@scripts/fuzz 3600

contact-sheet: $(BUILD)/vodr ## draw every real volume at hand into build/contact-sheet/
	@scripts/contact-sheet $(BUILD)

crosscheck: ## hold the machine against the reference renderer: docs/crosscheck.md, build/crosscheck.html
	@scripts/deps build
	@$(MAKE) -s $(PARALLEL) all
	@scripts/crosscheck $(BUILD)

bench-model: $(BUILD)/vodr ## measure the model beside a software rasterizer, and write its table in the README again
	@scripts/tables $(BUILD) model
	@cat $(BUILD)/tables/model

bench-reference: ## measure the reference renderer on the CPU beside VTK, and write docs/table-reference.md again
	@$(MAKE) -s $(PARALLEL) $(BUILD)/bench/reference_frames
	@scripts/tables $(BUILD) reference
	@cat $(BUILD)/tables/reference

bench-mip: ## the paper on the maximum beside ours, VTK and teem (a quarter of an hour); writes docs/table-mip.md again
	@$(MAKE) -s $(PARALLEL) $(BUILD)/bench/mip_frames $(BUILD)/bench/reference_frames
	@scripts/tables $(BUILD) mip
	@cat $(BUILD)/tables/mip

bench-cardinal: ## measure the cubic filters on the CPU, and teem's, and write docs/table-cardinal.md again
	@$(MAKE) -s $(PARALLEL) $(BUILD)/bench/cubic_frames $(BUILD)/bench/teem_frames
	@scripts/tables $(BUILD) cardinal
	@cat $(BUILD)/tables/cardinal

bench-aligned: ## measure the thread-aligned projection on the CPU, and write docs/table-aligned.md again, with the newest record of a card
	@$(MAKE) -s $(PARALLEL) $(BUILD)/bench/aligned_frames $(BUILD)/bench/teem_frames
	@scripts/tables $(BUILD) aligned
	@cat $(BUILD)/tables/aligned

bench-sweep: $(BUILD)/vodr $(BUILD)/bench/sweep_rate ## measure what `vodr sweep` adds to the drawing itself, and write it in docs/sweep.md again
	@scripts/tables $(BUILD) sweep
	@cat $(BUILD)/tables/sweep

findings: ## hold the named machines against paper-16 on every volume at hand, and write docs/findings.md again (an hour)
	@scripts/deps check
	@$(MAKE) -s $(PARALLEL) all $(BUILD)/tests/limits
	@scripts/findings $(BUILD)

table-vodr: ## the paper's Table 1 beside ours, and what the paper leaves out
	@$(MAKE) -s $(PARALLEL) $(BUILD)/bench/table_vodr
	@$(BUILD)/bench/table_vodr

table-balance: all $(if $(ICET),$(if $(MPICC),$(BUILD)/icet_frames)) ## how even the cluster's nodes are, beside the paper's, and write docs/table-balance.md again (minutes)
	@scripts/tables $(BUILD) balance cluster
	@cat $(BUILD)/tables/balance $(BUILD)/tables/cluster

table-cycles: ## cycles a frame, divided or not; what counting them costs
	@$(MAKE) -s $(PARALLEL) $(BUILD)/bench/table_cycles
	@$(BUILD)/bench/table_cycles

lint: ## check formatting, shell scripts, Verilog, layers, links and docs/parameters.md
	@scripts/deps lint
	@$(MAKE) -s $(BUILD)/generate $(BUILD)/gen/vodr_hw.vh
	@clang-format --dry-run -Werror $(SOURCES)
	@shellcheck $(SCRIPTS)
	@scripts/lint-rtl $(BUILD)
	@scripts/layers
	@scripts/links
	@$(BUILD)/generate markdown $(HW) | diff -u docs/parameters.md - || { echo 'docs/parameters.md is stale: make docs' >&2; exit 1; }
	@echo 'lint: clean'

format: ## lay the C sources out by .clang-format
	clang-format -i $(SOURCES)

docs: ## write docs/parameters.md and what is generated in the pages again
	@$(MAKE) -s demo
	@$(MAKE) -s $(PARALLEL) $(BUILD)/bench/table_cycles
	@$(BUILD)/generate markdown $(HW) > docs/parameters.md
	@scripts/tables $(BUILD) size rtl synthesis proofs mutation table1 views cycles tour machines gpu

bench: ## measure the speed of frames, and of counting their cycles (written to docs/table-cycles.md)
	@$(MAKE) -s $(PARALLEL) $(BUILD)/bench/speed $(BUILD)/bench/table_cycles
	@$(BUILD)/bench/speed
	@scripts/tables $(BUILD) cycle-speed

$(BUILD)/generate: hw/generate.c
	@mkdir -p $(@D)
	$(CC) $(STRICT) -O1 -o $@ $<

$(BUILD)/gen/vodr_hw.h: $(BUILD)/generate $(HW) $(MACHINES)
	@mkdir -p $(@D)
	$(BUILD)/generate c-header $(HW) $(MACHINES) > $@.tmp && mv $@.tmp $@

$(BUILD)/gen/vodr_hw.c: $(BUILD)/generate $(HW) $(MACHINES)
	@mkdir -p $(@D)
	$(BUILD)/generate c-source $(HW) $(MACHINES) > $@.tmp && mv $@.tmp $@

$(BUILD)/gen/vodr_hw.vh: $(BUILD)/generate $(HW) $(MACHINES)
	@mkdir -p $(@D)
	$(BUILD)/generate verilog $(HW) $(MACHINES) > $@.tmp && mv $@.tmp $@

$(BUILD)/gen/energy_text.c: $(BUILD)/generate hw/energy.txt
	@mkdir -p $(@D)
	$(BUILD)/generate c-text hw_energy_text hw/energy.txt > $@.tmp && mv $@.tmp $@

$(BUILD)/gen/synthesis_text.c: $(BUILD)/generate rtl/synthesis.txt
	@mkdir -p $(@D)
	$(BUILD)/generate c-text rtl_synthesis_text rtl/synthesis.txt > $@.tmp && mv $@.tmp $@

$(BUILD)/gen/%.o: $(BUILD)/gen/%.c
	$(COMPILE) -c -o $@ $<

$(BUILD)/%.o: %.c | $(GEN)
	@mkdir -p $(@D)
	$(COMPILE) -c -o $@ $<

$(BUILD)/libvodr.a: $(CMODEL)
	@rm -f $@
	ar rcs $@ $^

$(BUILD)/cmodel/%.o: override CFLAGS += $(COVER)
$(BUILD)/reference/%.o: CFLAGS += $(REFERENCE_MATHS)
$(addprefix $(BUILD)/reference/,cpu_float.o cpu_double.o cpu_cubic_float.o cpu_cubic_double.o): CFLAGS += $(LOOPS)
ifeq ($(shell uname -m),x86_64)
$(BUILD)/reference/cpu_avx2.o $(BUILD)/reference/cpu_cubic_avx2.o: CFLAGS += -mavx2
$(BUILD)/reference/cpu_avx512.o $(BUILD)/reference/cpu_cubic_avx512.o: CFLAGS += -mavx512f -mavx512bw -mavx512dq -mavx512vl
endif

$(BUILD)/%.o: %.cu | $(GEN)
	@mkdir -p $(@D)
	$(NVCC) $(NVCCFLAGS) -I$(BUILD)/gen -Icmodel -Ireference -Ibench/record -MMD -MP -c -o $@ $<

$(BUILD)/libreference.a: $(REFERENCE)
	@rm -f $@
	ar rcs $@ $^

$(BUILD)/libcluster.a: $(CLUSTER)
	@rm -f $@
	ar rcs $@ $^

$(BUILD)/vodr-mpi.so: cluster/mpi/node_mpi.c cluster/node.h cluster/cluster.h | $(GEN)
	$(COMPILE) $(MPI_FLAGS) -fPIC -shared -o $@ $< $(shell $(MPICC) --showme:link)

$(BUILD)/librtl.a: $(RTL)
	@rm -f $@
	ar rcs $@ $^

$(BUILD)/libvectors.a: $(VECTORS)
	@rm -f $@
	ar rcs $@ $^

# Where co-simulation finds what it builds libraries of, and keeps them: builds of one tree share theirs.
WHERE := -DVODR_ROOT='"$(CURDIR)"' -DVODR_BUILD='"$(abspath $(if $(filter build/%,$(BUILD)),build,$(BUILD)))"'
$(BUILD)/host/cosim_options.o $(BUILD)/bench/cosim_rate.o $(BUILD)/tests/test_cells.o $(BUILD)/tests/test_cosim.o $(BUILD)/tests/test_pairwise.o: STRICT += $(WHERE)

$(BUILD)/libhost.a: $(HOST)
	@rm -f $@
	ar rcs $@ $^

$(BUILD)/vodr: $(BUILD)/host/main.o $(BUILD)/libhost.a $(BUILD)/libcluster.a $(BUILD)/libreference.a $(BUILD)/libvectors.a $(BUILD)/librtl.a $(BUILD)/libvodr.a
	$(CC) $(CFLAGS) $(SANITIZE) -o $@ $^ $(LIBRARIES) $(CUDA_LIBRARIES)

$(BUILD)/bench/gpu_record: $(RECORD:%=$(BUILD)/%.o) $(BUILD)/libreference.a $(BUILD)/libvodr.a
	$(CC) $(CFLAGS) $(SANITIZE) -o $@ $^ $(CUDA_LIBRARIES) -lm -pthread

$(BUILD)/bench/mip_frames: $(MIP:%=$(BUILD)/%.o) $(BUILD)/libreference.a $(BUILD)/libvodr.a
	$(CC) $(CFLAGS) $(SANITIZE) -o $@ $^ $(CUDA_LIBRARIES) -lm -pthread

$(BUILD)/bench/cubic_frames: $(CUBIC:%=$(BUILD)/%.o) $(BUILD)/libreference.a $(BUILD)/libvodr.a
	$(CC) $(CFLAGS) $(SANITIZE) -o $@ $^ $(CUDA_LIBRARIES) -lm -pthread

$(BUILD)/bench/aligned_frames: $(ALIGNED:%=$(BUILD)/%.o) $(BUILD)/libreference.a $(BUILD)/libvodr.a
	$(CC) $(CFLAGS) $(SANITIZE) -o $@ $^ $(CUDA_LIBRARIES) -lm -pthread

$(BUILD)/bench/teem_frames: $(BUILD)/bench/record/teem_frames.o $(BUILD)/bench/lib/stopwatch.o $(BUILD)/libreference.a $(BUILD)/libvodr.a
	$(CC) $(CFLAGS) $(SANITIZE) -o $@ $^ $(CUDA_LIBRARIES) -lm -pthread

$(BUILD)/bench/reference_frames: $(BUILD)/bench/reference_frames.o $(BENCHLIB) $(BUILD)/libreference.a $(BUILD)/libhost.a $(BUILD)/libvectors.a $(BUILD)/librtl.a $(BUILD)/libvodr.a
	$(CC) $(CFLAGS) $(SANITIZE) -o $@ $^ $(LIBRARIES) $(CUDA_LIBRARIES)

# Beside vodr-mpi.so, which it loads.
$(BUILD)/icet_frames: bench/icet/icet_frames.c $(BUILD)/bench/lib/stopwatch.o $(BUILD)/libcluster.a $(BUILD)/libreference.a $(BUILD)/libvodr.a $(BUILD)/vodr-mpi.so
	$(COMPILE) $(MPI_FLAGS) -Ibench/lib -isystem $(ICET) -o $@ $(filter %.c %.o %.a,$^) $(ICET_LIBRARIES) $(shell $(MPICC) --showme:link) $(CUDA_LIBRARIES) -lm

$(BUILD)/bench/texture_ceiling: $(BUILD)/bench/texture_ceiling.o
	$(NVCC) -o $@ $^

$(BUILD)/bench/%: $(BUILD)/bench/%.o $(BENCHLIB) $(BUILD)/libhost.a $(BUILD)/libvectors.a $(BUILD)/librtl.a $(BUILD)/libvodr.a
	$(CC) $(CFLAGS) $(SANITIZE) -o $@ $^ $(LIBRARIES)

LOCKSTEP := $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/lockstep/*.c))
$(LOCKSTEP): STRICT += $(WHERE)

$(BUILD)/tests/lockstep/lockstep: $(LOCKSTEP) $(TESTLIB) $(BUILD)/libhost.a $(BUILD)/libvectors.a $(BUILD)/librtl.a $(BUILD)/libvodr.a
	$(CC) $(CFLAGS) $(SANITIZE) -o $@ $^ -lcmocka $(LIBRARIES)

MUTATION := $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/mutation/*.c))
$(MUTATION): STRICT += $(WHERE)

$(BUILD)/tests/mutation/mutants: $(MUTATION) $(BUILD)/libhost.a $(BUILD)/libvectors.a $(BUILD)/librtl.a $(BUILD)/libvodr.a
	$(CC) $(CFLAGS) $(SANITIZE) -o $@ $^ $(LIBRARIES)

$(BUILD)/vectors/%.o: INCLUDES := -I$(BUILD)/gen -Icmodel -Irtl -Ivectors
$(BUILD)/tests/%.o: INCLUDES += -Itests/lib
$(REFERENCE_TESTS:%=%.o): INCLUDES += -Ibench/record -Ibench/lib
$(BUILD)/bench/%.o: INCLUDES += -Ibench/lib
$(BUILD)/bench/record/%.o: INCLUDES += -Itests/lib -Ibench/lib

# The functions whose failure it plays.
$(BUILD)/tests/test_no_memory: private WRAPPED := $(addprefix -Wl$(comma)--wrap=,malloc calloc realloc posix_memalign \
                                                    pthread_mutex_init pthread_cond_init pthread_create)

$(BUILD)/tests/%: $(BUILD)/tests/%.o $(TESTLIB) $(BUILD)/libhost.a $(BUILD)/libvectors.a $(BUILD)/librtl.a $(BUILD)/libvodr.a
	$(CC) $(CFLAGS) $(SANITIZE) $(WRAPPED) -o $@ $^ -lcmocka $(LIBRARIES)

$(BUILD)/tests/test_reference_cubic: $(BUILD)/bench/record/cubic_cases.o

$(REFERENCE_TESTS): $(BUILD)/tests/%: $(BUILD)/tests/%.o $(TESTLIB) $(MIP_CASES) $(BUILD)/libhost.a $(BUILD)/libcluster.a $(BUILD)/libreference.a $(BUILD)/libvectors.a $(BUILD)/librtl.a $(BUILD)/libvodr.a
	$(CC) $(CFLAGS) $(SANITIZE) -o $@ $(filter %.o,$^) $(filter %.a,$^) -lcmocka $(LIBRARIES) $(CUDA_LIBRARIES)

.SECONDARY: # keep the objects of programs
.DELETE_ON_ERROR:

clean: ## remove everything built
	rm -rf build

-include $(wildcard $(BUILD)/*/*.d $(BUILD)/*/*/*.d)
