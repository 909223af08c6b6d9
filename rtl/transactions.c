#include "transactions.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_CHANNELS = 8 };

/* What moved: the fields that it carries, one after the other. */
typedef struct event {
    struct event *next;
    size_t bytes;
    uint8_t data[];
} event;

/* A valid of an output port, and what it is the valid of. */
typedef struct channel {
    const signal_port *port;
    int16_t valid;
    int32_t ready_record; /* a link: where in the block's `in` its ready is; -1: a strobe */
    int16_t ready;
} channel;

/* One side: a block that is listened to. */
typedef struct tap {
    event *first[MAX_CHANNELS], *last[MAX_CHANNELS]; /* what has moved and was not compared yet */
    event *offered[MAX_CHANNELS];                    /* links: what is offered and has not moved */
} tap;

struct transactions {
    rtl_block rtl;
    block_faces inner, reference_inner; /* the C blocks, in their places */
    clocked *machine;
    transactions_reference *reference;
    channel channels[MAX_CHANNELS];
    int32_t count;
    tap mine, expected;
    difference first;
    bool failed; /* no memory */
};

/* ---- channels ---- */

/* The ready that answers STEM_valid. */
static bool find_ready(const block_signals *s, const char *valid, channel *c)
{
    size_t stem = strlen(valid) - strlen("valid");
    for (int32_t i = 0; i < s->count; i++)
        for (int32_t j = 0; j < s->ports[i].count && !s->ports[i].output; j++) {
            const signal_field *f = &s->ports[i].fields[j];
            if (strncmp(f->name, valid, stem) == 0 && strcmp(f->name + stem, "ready") == 0) {
                c->ready_record = s->ports[i].record;
                c->ready = f->offset;
                return true;
            }
        }
    return false;
}

static void find_channels(transactions *t, vodr_block block)
{
    const block_signals *s = signals_of(block);
    for (int32_t i = 0; i < s->count; i++) {
        const signal_port *p = &s->ports[i];
        for (int32_t j = 0; p->output && j < p->count; j++) {
            const signal_field *valid = &p->fields[j];
            bool carries = false;
            for (int32_t k = 0; k < p->count; k++)
                carries |= p->fields[k].when == valid->offset;
            if (valid->when != SIGNAL_ALWAYS || !carries)
                continue;
            channel *c = &t->channels[t->count++];
            *c = (channel){.port = p, .valid = valid->offset, .ready_record = -1};
            find_ready(s, valid->name, c);
        }
    }
}

/* ---- events ---- */

static event *event_of(transactions *t, const channel *c, const void *record)
{
    const vodr_machine *machine = t->rtl.machine;
    size_t bytes = 0;
    for (int32_t i = 0; i < c->port->count; i++)
        bytes += c->port->fields[i].when == c->valid ? signal_bytes(&c->port->fields[i], machine, record) : 0;
    event *e = malloc(sizeof *e + bytes);
    t->failed |= !e;
    if (!e)
        return NULL;
    *e = (event){.bytes = bytes};
    uint8_t *to = e->data;
    for (int32_t i = 0; i < c->port->count; i++) {
        const signal_field *f = &c->port->fields[i];
        size_t n = f->when == c->valid ? signal_bytes(f, machine, record) : 0;
        memcpy(to, (const char *)record + f->offset, n);
        to += n;
    }
    return e;
}

static void push(tap *side, int32_t i, event *e)
{
    if (!e)
        return;
    *(side->first[i] ? &side->last[i]->next : &side->first[i]) = e;
    side->last[i] = e;
}

static event *pop(tap *side, int32_t i)
{
    event *e = side->first[i];
    side->first[i] = e->next;
    return e;
}

/* Listens to a cycle of a block: `in` is what it saw, `out` what it registered. */
static void listen(transactions *t, tap *side, const void *in, const void *out)
{
    for (int32_t i = 0; i < t->count; i++) {
        const channel *c = &t->channels[i];
        const char *record = (const char *)out + c->port->record;
        bool valid = ((const bool *)record)[c->valid];
        if (c->ready_record < 0) {
            if (valid)
                push(side, i, event_of(t, c, record));
            continue;
        }
        const bool *answers = *(const bool *const *)((const char *)in + c->ready_record);
        if (side->offered[i] && answers[c->ready]) {
            push(side, i, side->offered[i]);
            side->offered[i] = NULL;
        }
        if (valid && !side->offered[i])
            side->offered[i] = event_of(t, c, record);
    }
}

/* ---- comparison ---- */

static void tell_nothing(transactions *t, const channel *c, const char *expected, const char *got)
{
    t->first = (difference){.found = true, .port = c->port};
    for (int32_t i = 0; i < c->port->count && !t->first.field; i++)
        if (c->port->fields[i].offset == c->valid)
            t->first.field = &c->port->fields[i];
    snprintf(t->first.expected, sizeof t->first.expected, "%s", expected);
    snprintf(t->first.got, sizeof t->first.got, "%s", got);
}

static void compare(transactions *t, const channel *c, const event *expected, const event *got)
{
    const uint8_t *a = expected->data, *b = got->data;
    for (int32_t i = 0; i < c->port->count; i++) {
        const signal_field *f = &c->port->fields[i];
        int32_t bytes = (signal_width(f, t->rtl.machine) + 7) / 8;
        size_t n = (size_t)(bytes < f->bytes ? bytes : f->bytes), left = (size_t)(expected->data + expected->bytes - a);
        if (f->when != c->valid)
            continue;
        n = n < left ? n : left;
        if (memcmp(a, b, n) != 0) {
            t->first = (difference){.found = true, .port = c->port, .field = f};
            difference_tell(a, b, n, t->first.expected);
            difference_tell(b, a, n, t->first.got);
            return;
        }
        a += n;
        b += n;
    }
}

/* The reference draws until channel `i` has something, if it ever does. */
static bool wait_for(transactions *t, int32_t i)
{
    while (!t->expected.first[i] && !t->reference->done)
        t->reference->done = !clocked_step(t->reference->machine, NULL);
    return t->expected.first[i] != NULL;
}

static void compare_all(transactions *t)
{
    for (int32_t i = 0; i < t->count; i++)
        while (t->mine.first[i] && !t->first.found) {
            if (!wait_for(t, i)) {
                tell_nothing(t, &t->channels[i], "nothing more", "another");
                return;
            }
            event *got = pop(&t->mine, i), *expected = pop(&t->expected, i);
            if (expected->bytes != got->bytes)
                tell_nothing(t, &t->channels[i], "so many bytes", "more or less");
            else
                compare(t, &t->channels[i], expected, got);
            free(got);
            free(expected);
        }
}

bool transactions_end(transactions *t)
{
    for (int32_t i = 0; i < t->count && !t->first.found; i++)
        if (wait_for(t, i))
            tell_nothing(t, &t->channels[i], "another", "nothing more");
    while (!t->reference->done)
        t->reference->done = !clocked_step(t->reference->machine, NULL);
    const storage *mine = clocked_setup(t->machine)->storage, *theirs = clocked_setup(t->reference->machine)->storage;
    if (!t->first.found && t->rtl.block == VODR_BLOCK_FRAME_BUFFER)
        lockstep_compare_memory(theirs, mine, &t->first);
    return !t->first.found;
}

/* ---- faces ---- */

#define CLOCK(NAME, name)                                                                                              \
    static void clock_##name(void *state, const name##_in *in, name##_out *out)                                        \
    {                                                                                                                  \
        transactions *t = state;                                                                                       \
        rtl_block_clock(&t->rtl, in, out);                                                                             \
        listen(t, &t->mine, in, out);                                                                                  \
        compare_all(t);                                                                                                \
    }                                                                                                                  \
    static void clock_reference_##name(void *state, const name##_in *in, name##_out *out)                              \
    {                                                                                                                  \
        transactions *t = state;                                                                                       \
        t->reference_inner.name.clock(t->reference_inner.name.state, in, out);                                         \
        listen(t, &t->expected, in, out);                                                                              \
    }
LOCKSTEP_BLOCKS(CLOCK)

rtl_status transactions_open(transactions **made, const rtl_source *source, vodr_block block, clocked *machine,
                             transactions_reference *reference, vodr_error *error)
{
    transactions *t = *made = calloc(1, sizeof *t);
    if (!t)
        return rtl_fail(error, RTL_NO_MEMORY, "no memory for %s", signals_of(block)->name);
    t->machine = machine;
    t->reference = reference;
    find_channels(t, block);
    rtl_status status = rtl_block_open(&t->rtl, source, block, clocked_setup(machine),
                                       lockstep_out(block, clocked_reset(machine)), error);
    if (status != RTL_OK) {
        free(t);
        *made = NULL;
        return status;
    }
    block_faces *mine = clocked_faces(machine), *theirs = clocked_faces(reference->machine);
#define TAKE(NAME, name)                                                                                               \
    if (block == VODR_BLOCK_##NAME) {                                                                                  \
        t->inner.name = mine->name;                                                                                    \
        mine->name = (name##_face){.state = t, .clock = clock_##name};                                                 \
        t->reference_inner.name = theirs->name;                                                                        \
        theirs->name = (name##_face){.state = t, .clock = clock_reference_##name};                                     \
    }
    LOCKSTEP_BLOCKS(TAKE)
    return RTL_OK;
}

static void tap_free(tap *side)
{
    for (int i = 0; i < MAX_CHANNELS; i++) {
        free(side->offered[i]);
        while (side->first[i])
            free(pop(side, i));
    }
}

void transactions_close(transactions *t)
{
#define GIVE(NAME, name)                                                                                               \
    if (t->rtl.block == VODR_BLOCK_##NAME) {                                                                           \
        clocked_faces(t->machine)->name = t->inner.name;                                                               \
        clocked_faces(t->reference->machine)->name = t->reference_inner.name;                                          \
    }
    LOCKSTEP_BLOCKS(GIVE)
    tap_free(&t->mine);
    tap_free(&t->expected);
    rtl_block_close(&t->rtl);
    free(t);
}

rtl_block *transactions_block(transactions *t)
{
    return &t->rtl;
}

const difference *transactions_first(const transactions *t)
{
    return &t->first;
}

bool transactions_failed(const transactions *t)
{
    return t->failed;
}
