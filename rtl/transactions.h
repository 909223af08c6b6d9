/* transactions.h - a block in Verilog whose latency is its own: not its cycles are compared but what it hands on. A
 * machine in C draws the same frame beside; at each port of the block the same values have to move in the same order,
 * whenever that is. Levels, statuses and strobes that carry nothing are not compared. */
#ifndef VODR_TRANSACTIONS_H
#define VODR_TRANSACTIONS_H

#include "clocked.h"
#include "lockstep.h"

/* The machine in C. It goes on only as far as somebody asks for. */
typedef struct transactions_reference {
    clocked *machine;
    bool done;
} transactions_reference;

typedef struct transactions transactions;

/* Puts the Verilog of a block into a machine before its first cycle, and listens at the same block of the reference,
 * which is before its first cycle too. To be closed on success, before either machine is freed. */
rtl_status transactions_open(transactions **t, const rtl_source *source, vodr_block block, clocked *machine,
                             transactions_reference *reference, vodr_error *error);
void transactions_close(transactions *t);

rtl_block *transactions_block(transactions *t);

/* What moved and should not have, or as something else. */
const difference *transactions_first(const transactions *t);

/* Whether there was no memory for what moved. */
bool transactions_failed(const transactions *t);

/* After the last cycle: false when something should have moved still, which transactions_first() then tells. */
bool transactions_end(transactions *t);

#endif
