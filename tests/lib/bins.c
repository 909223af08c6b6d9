/* bins.c - draws a frame and asks the predicates of bins_table.h of every cycle, and of the whole. */
#include "bins.h"

#include "bins_watch.h"
#include "clocked.h"
#include "layout.h"

typedef struct bin_label {
    const char *group, *name;
} bin_label;

static const bin_label labels[] = {
#define CYCLE(group, name, met) {group, name},
#define FRAME(group, name, met) {group, name},
#include "bins_table.h"
#undef CYCLE
#undef FRAME
};

int bins_count(void)
{
    return (int)(sizeof labels / sizeof *labels);
}

const char *bins_group(int bin)
{
    return labels[bin].group;
}

const char *bins_name(int bin)
{
    return labels[bin].name;
}

/* ---- what the table says in words of its own ---- */

#define DIVIDED (m->traversal != VODR_TRAVERSAL_WHOLE)
#define LINEAR (m->filter == VODR_FILTER_LINEAR)
#define BACK (m->write_policy == VODR_WRITE_POLICY_BACK)
#define SINGLE (m->pipelines == 1) /* the ports are those of the first pipeline */
#define SEEN(in_perspective) (n->fragments > 0 && w->c->view.perspective == (in_perspective))
#define SIDE(axis) (was->volume_divider.brick.box.hi[axis] - was->volume_divider.brick.box.lo[axis])
#define WHITE (m->fb_bits == 16 ? UINT64_MAX : UINT32_MAX)
#define MISSES (LOOK.valid && LOOK.miss)
#define REPLACES (LOOK.valid && LOOK.replaced)
#define SETS ((uint64_t)(m->cache_bytes / (m->ways * line_bytes(m))))
#define LINE_BYTES ((uint64_t)line_bytes(m))
#define ROW(cycles) (m->memory == VODR_MEMORY_DRAM && SINGLE && w->begins && w->row_cycles == (cycles))
#define BRICKS (bricks_of(w, n))

/* All bricks of the volume. */
static uint64_t bricks_of(const bins_watch *w, const vodr_counters *n)
{
    uint64_t bricks = 1;
    for (int c = 0; c < 3 && n->brick_vox; c++) {
        bricks *= (uint64_t)ceil_div32(w->c->input.dims_vox[c], n->brick_vox);
    }
    return bricks;
}

static void ask_cycle(const bins_watch *w, bool *seen)
{
    const vodr_machine *m = w->machine;
    const block_outs *was = w->before, *now = w->now;
#define CYCLE(group, name, met) *seen++ |= (met);
#define FRAME(group, name, met) seen++;
#include "bins_table.h"
#undef CYCLE
#undef FRAME
}

static void ask_frame(const bins_watch *w, const vodr_counters *n, bool *seen)
{
    const vodr_machine *m = w->machine;
#define CYCLE(group, name, met) seen++;
#define FRAME(group, name, met) *seen++ |= (met);
#include "bins_table.h"
}

vodr_status bins_draw(const test_case *c, const vodr_machine *machine, bool *seen, vodr_error *error)
{
    bins_watch w = {.c = c, .machine = machine};
    clocked *frame;
    vodr_frame drawn;
    vodr_counters n;
    vodr_status status = clocked_start(&frame, machine, &c->input, &c->table, &c->view, NULL, error);
    if (status != VODR_OK) {
        return status;
    }
    bool left = true;
    while (left) {
        const block_outs *before = clocked_outs(frame);
        left = clocked_step(frame, NULL);
        bins_watch_cycle(&w, before, clocked_outs(frame));
        ask_cycle(&w, seen);
    }
    status = clocked_readout(frame, &drawn, &n, error);
    if (status == VODR_OK) {
        ask_frame(&w, &n, seen);
        vodr_frame_free(&drawn);
    }
    clocked_free(frame);
    return status;
}
