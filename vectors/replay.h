/* replay.h - a block in C, cycle by cycle, as lines of vectors tell it: who makes vectors and who checks them does the
 * same. Behind the frame buffer lies its memory, which answers as it does beside the Verilog. */
#ifndef VECTORS_REPLAY_H
#define VECTORS_REPLAY_H

#include "bench.h"
#include "columns.h"
#include "external_memory.h"

/* Characters of a line of columns, however wide. */
enum { REPLAY_LINE = 8 * PORT_LINE_BYTES + 64 * COLUMNS_MOST };

typedef struct replay {
    const bench *b;
    const block_bench *what;
    columns columns;
    void *rules;
    block_outs shown; /* what the block registered last, in its place */
    struct {
        external_memory memory;
        int32_t *bytes; /* of the answer that is due, a ring as long as the memory's; 0: none */
        int32_t delay;
        uint8_t answer[PORT_BEAT_BYTES]; /* in this cycle, */
        int32_t answer_bytes;            /* of which so many mean something */
    } behind;
} replay;

/* Of a bench before its first cycle. False when there is no memory; to be ended in either case. */
bool replay_start(replay *r, const bench *b, const block_bench *what);
void replay_end(replay *r);

/* The cycle begins: memory moves on. Returns what is illegal of the inputs, or NULL. */
const char *replay_before(replay *r, const void *in);

/* The cycle is over: what the block registered. */
void replay_after(replay *r, const void *out);

/* Writes the line of the cycle, or of reset, where inputs are nothing, without a newline. Returns its end. */
char *replay_line(const replay *r, bool rst, const void *in, char *line);

/* The block's record among `shown`. */
const void *replay_shown(const replay *r);

#endif
