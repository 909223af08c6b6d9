/* library.h - a module made into a library, loaded, and held against the ports that its block has to have. */
#ifndef VODR_LIBRARY_H
#define VODR_LIBRARY_H

#include "registers.h"
#include "signals.h"
#include "vodr_rtl.h"

typedef enum rtl_status {
    RTL_OK,
    RTL_DIFFERS,     /* Verilog and C differ, or something hangs */
    RTL_INVALID,     /* a module, or a machine, that cannot be taken */
    RTL_NO_MEMORY,   /* the host is out of memory */
    RTL_ENVIRONMENT, /* there is no Verilator, the library cannot be written or loaded */
} rtl_status;

enum { RTL_PATH_BYTES = 4096 };

/* What was asked for last, and where it lies: who opens one library often has it looked for once. Zeroed at first. */
typedef struct rtl_found {
    char asked[2 * RTL_PATH_BYTES], path[RTL_PATH_BYTES];
} rtl_found;

/* Where a library comes from. */
typedef struct rtl_source {
    const char *root;  /* of the project: its scripts/ and rtl/ */
    const char *build; /* where it is built: its gen/ has the header that hw/ gives, its rtl/ keeps libraries */
    const char *file;  /* the module's; NULL: ours */
    bool trace;        /* one that writes waveforms */
    uint32_t seed;     /* of what its registers hold before the reset */
    rtl_found *found;  /* the caller's; NULL: it is looked for each time */
    /* An input beside ports and registers, which is held at `selected`; NULL: there is none. */
    const char *selector;
    uint64_t selected;
} rtl_source;

typedef struct rtl_library {
    void *handle;
    char file[256]; /* that the module came from, as sentences call it */
    vodr_rtl_model model;
} rtl_library;

/* Builds the library of a block's module when it is not there, and makes a model of it. To be closed on success. */
rtl_status rtl_library_open(const rtl_source *source, vodr_block block, const rtl_registers *registers, rtl_library *l,
                            vodr_error *error);

/* The same of a module that is no block, in source->file: whatever ports it has, and its own defaults. */
rtl_status rtl_module_open(const rtl_source *source, const char *module, rtl_library *l, vodr_error *error);

void rtl_library_close(rtl_library *l);

/* The model's port of this name; NULL when it has none. */
const vodr_rtl_port *rtl_library_port(const rtl_library *l, const char *name);

/* One sentence, printf-like; returns `status`. */
rtl_status rtl_fail(vodr_error *error, rtl_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
