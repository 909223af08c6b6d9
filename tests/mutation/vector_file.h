/* vector_file.h - test vectors (docs/vectors.md) in memory, to be replayed against many models of a module, and the
 * replay. It does what vectors/bench.v does, with no block in C either; but a reset lasts the one cycle that vectors
 * show, after whatever the case before has left. */
#ifndef TESTS_VECTOR_FILE_H
#define TESTS_VECTOR_FILE_H

#include "library.h"

typedef struct vector_file vector_file;

/* The first output that is not what the vectors say. */
typedef struct vector_difference {
    uint64_t line; /* of the file; 0: there is none */
    const char *name;
} vector_difference;

/* Reads a file. NULL when it cannot be read or is not whole; a sentence says why. */
vector_file *vector_file_read(const char *path, vodr_error *error);
void vector_file_free(vector_file *f);

/* Replays it against a model before its first eval(), up to the first difference. What means nothing is driven with
 * noise. with_rules: an output `rules` has to be up in every cycle, too. False when the model lacks a port; a sentence
 * says which. */
bool vector_file_replay(const vector_file *f, const rtl_library *model, bool with_rules, vector_difference *first,
                        vodr_error *error);

#endif
