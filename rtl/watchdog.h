/* watchdog.h - tells a machine in which nothing moves any more, and which handshake hangs. */
#ifndef VODR_WATCHDOG_H
#define VODR_WATCHDOG_H

#include "blocks.h"

enum { WATCHDOG_LINKS = 5 };

typedef struct watchdog {
    uint64_t moved;                 /* the cycle in which anything moved last */
    uint64_t since[WATCHDOG_LINKS]; /* that a link is offered, and not taken */
} watchdog;

/* Cycles without a move after which a machine hangs: more than any of its waits can take. */
uint64_t watchdog_limit(const vodr_machine *machine);

/* Goes on by a cycle: what all blocks registered before and after it. `*w` begins zeroed. */
void watchdog_cycle(watchdog *w, uint64_t cycle, const block_outs *before, const block_outs *after);

/* Says what hangs. */
void watchdog_tell(const watchdog *w, const block_outs *outs, char *text, size_t size);

#endif
