#include "lockstep.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* ---- comparison ---- */

void difference_tell(const uint8_t *value, const uint8_t *other, size_t bytes, char text[DIFFERENCE_CHARS])
{
    uint64_t number = 0;
    size_t first = 0, shown;
    if (bytes <= sizeof number) {
        memcpy(&number, value, bytes);
        snprintf(text, DIFFERENCE_CHARS, number > 0xFFFFFF ? "0x%" PRIx64 : "%" PRIu64, number);
        return;
    }
    while (first < bytes && value[first] == other[first])
        first++;
    shown = bytes - first < 16 ? bytes - first : 16;
    int length = snprintf(text, DIFFERENCE_CHARS, "from byte %zu on", first);
    for (size_t i = 0; i < shown; i++)
        length += snprintf(text + length, (size_t)(DIFFERENCE_CHARS - length), " %02x", value[first + i]);
}

/* Fields that always mean something, or those that only do sometimes: a valid that is down explains its payload. */
static bool compare_fields(const signal_port *p, bool always, const vodr_machine *machine, const void *expected,
                           const void *got, difference *d)
{
    for (int32_t i = 0; i < p->count; i++) {
        const signal_field *f = &p->fields[i];
        const uint8_t *a = (const uint8_t *)expected + f->offset, *b = (const uint8_t *)got + f->offset;
        if ((f->when == SIGNAL_ALWAYS) != always || !signal_counts(f, expected))
            continue;
        size_t bytes = signal_bytes(f, machine, expected);
        if (memcmp(a, b, bytes) == 0)
            continue;
        *d = (difference){.found = true, .port = p, .field = f};
        difference_tell(a, b, bytes, d->expected);
        difference_tell(b, a, bytes, d->got);
        return false;
    }
    return true;
}

bool lockstep_compare(vodr_block block, const vodr_machine *machine, const void *expected, const void *got,
                      difference *d)
{
    const block_signals *s = signals_of(block);
    for (int always = 1; always >= 0; always--)
        for (int32_t i = 0; i < s->count; i++) {
            const signal_port *p = &s->ports[i];
            if (p->output && !compare_fields(p, always, machine, (const char *)expected + p->record,
                                             (const char *)got + p->record, d))
                return false;
        }
    return true;
}

void lockstep_compare_memory(const storage *expected, const storage *got, difference *d)
{
    static const signal_field memory_field = {.name = "memory_write_data", .when = SIGNAL_ALWAYS};
    static const signal_port memory_port = {.fields = &memory_field, .count = 1, .output = true};
    const uint8_t *a = expected->lines, *b = got->lines;
    const size_t bytes = (size_t)expected->texture_base;
    if (memcmp(a, b, bytes) == 0)
        return;
    *d = (difference){.found = true, .port = &memory_port, .field = &memory_field};
    difference_tell(a, b, bytes, d->expected);
    difference_tell(b, a, bytes, d->got);
}

/* ---- faces ---- */

#define CLOCK(NAME, name)                                                                                              \
    static void clock_##name(void *state, const name##_in *in, name##_out *out)                                        \
    {                                                                                                                  \
        lockstep *l = state;                                                                                           \
        rtl_block_clock(&l->rtl, in, out);                                                                             \
        l->inner.name.clock(l->inner.name.state, in, &l->expected.name);                                               \
        if (!l->first.found)                                                                                           \
            lockstep_compare(VODR_BLOCK_##NAME, l->rtl.machine, &l->expected.name, out, &l->first);                    \
    }
LOCKSTEP_BLOCKS(CLOCK)

void *lockstep_out(vodr_block block, block_outs *outs)
{
#define OUT(NAME, name)                                                                                                \
    if (block == VODR_BLOCK_##NAME)                                                                                    \
        return &outs->name;
    LOCKSTEP_BLOCKS(OUT)
    return NULL;
}

/* Makes the frame buffer in C again, on a memory of its own. */
static bool move_memory(lockstep *l, const block_setup *setup, block_faces *faces, block_outs *outs)
{
    block_setup own = *setup;
    own.storage = &l->behind;
    faces->frame_buffer.finish(faces->frame_buffer.state);
    return storage_start(&l->behind, own.machine, own.view, own.volume, own.edge_vox) &&
           clocked_frame_buffer(&own, &faces->frame_buffer, &outs->frame_buffer);
}

rtl_status lockstep_open(lockstep *l, const rtl_source *source, vodr_block block, const block_setup *setup,
                         block_faces *faces, block_outs *outs, vodr_error *error)
{
    void *reset = lockstep_out(block, outs), *expected = lockstep_out(block, &l->expected);
    l->first = (difference){0};
    l->behind = (storage){0};
    if (block == VODR_BLOCK_FRAME_BUFFER && !move_memory(l, setup, faces, outs))
        return rtl_fail(error, RTL_NO_MEMORY, "no memory for a second frame buffer");
    rtl_status status = rtl_block_open(&l->rtl, source, block, setup, expected, error);
    if (status != RTL_OK)
        return status;
    /* Outputs at reset are compared too: what the C block's were stand in `outs`. */
    lockstep_compare(block, setup->machine, reset, expected, &l->first);
#define TAKE(NAME, name)                                                                                               \
    if (block == VODR_BLOCK_##NAME) {                                                                                  \
        name##_out swap = outs->name;                                                                                  \
        outs->name = l->expected.name;                                                                                 \
        l->expected.name = swap;                                                                                       \
        l->inner.name = faces->name;                                                                                   \
        faces->name = (name##_face){.state = l, .clock = clock_##name};                                                \
    }
    LOCKSTEP_BLOCKS(TAKE)
    return RTL_OK;
}

void lockstep_close(lockstep *l, block_faces *faces)
{
#define GIVE(NAME, name)                                                                                               \
    if (l->rtl.block == VODR_BLOCK_##NAME)                                                                             \
        faces->name = l->inner.name;
    LOCKSTEP_BLOCKS(GIVE)
    rtl_block_close(&l->rtl);
    storage_finish(&l->behind);
}

bool lockstep_end(lockstep *l)
{
    if (l->behind.lines && !l->first.found)
        lockstep_compare_memory(&l->behind, l->rtl.memory.storage, &l->first);
    return !l->first.found;
}
