# vodr: make builds build/vodr; make help lists the rest.
#
# BUILD, CC, CFLAGS and SANITIZE may be given: make BUILD=build/clang-O0 CC=clang CFLAGS=-O0
BUILD    ?= build
ifeq ($(origin CC),default)
CC       := gcc
endif
CFLAGS   ?= -O3
SANITIZE ?=

# Positions and tables are made in floating point: contraction would let compilers differ in their last bit.
STRICT   := -std=c11 -D_POSIX_C_SOURCE=200809L -D_FILE_OFFSET_BITS=64 -ffp-contract=off \
            -Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Werror
INCLUDES := -I$(BUILD)/gen -Icmodel -Ihost -isystem /usr/include/nifti
COMPILE  := $(CC) $(STRICT) $(CFLAGS) $(SANITIZE) $(INCLUDES) -pthread -MMD -MP
LIBRARIES := -lteem -lnifti2 -lznz -lpng -lz -ljansson -lcrypto -lm -pthread

HW       := hw/parameters.txt hw/registers.txt
MACHINES := $(sort $(wildcard hw/machines/*.txt))
GEN      := $(BUILD)/gen/vodr_hw.h $(BUILD)/gen/vodr_hw.c $(BUILD)/gen/vodr_hw.vh
CMODEL   := $(patsubst %.c,$(BUILD)/%.o,$(wildcard cmodel/*.c)) $(BUILD)/gen/vodr_hw.o
HOST     := $(patsubst %.c,$(BUILD)/%.o,$(filter-out host/main.c,$(wildcard host/*.c)))
TESTLIB  := $(patsubst %.c,$(BUILD)/%.o,$(wildcard tests/lib/*.c))
TESTS    := $(patsubst tests/%.c,$(BUILD)/tests/%,$(wildcard tests/test_*.c))

.PHONY: all help deps demo check check-long table-vodr lint format docs clean

all: $(BUILD)/vodr

help:
	@sed -n 's/^\([a-z][a-z-]*\):.*## /\1 - /p' $(MAKEFILE_LIST) | sort

deps: ## install what the build, the demo and the tests need (Debian 12)
	scripts/deps

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

$(BUILD)/gen/%.o: $(BUILD)/gen/%.c
	$(COMPILE) -c -o $@ $<

$(BUILD)/%.o: %.c | $(GEN)
	@mkdir -p $(@D)
	$(COMPILE) -c -o $@ $<

$(BUILD)/libvodr.a: $(CMODEL)
	@rm -f $@
	ar rcs $@ $^

$(BUILD)/libhost.a: $(HOST)
	@rm -f $@
	ar rcs $@ $^

$(BUILD)/vodr: $(BUILD)/host/main.o $(BUILD)/libhost.a $(BUILD)/libvodr.a
	$(CC) $(CFLAGS) $(SANITIZE) -o $@ $^ $(LIBRARIES)

$(BUILD)/tests/%: $(BUILD)/tests/%.o $(TESTLIB) $(BUILD)/libhost.a $(BUILD)/libvodr.a
	$(CC) $(CFLAGS) $(SANITIZE) -o $@ $^ -lcmocka $(LIBRARIES)

clean: ## remove everything built
	rm -rf build

-include $(wildcard $(BUILD)/*/*.d $(BUILD)/*/*/*.d)
