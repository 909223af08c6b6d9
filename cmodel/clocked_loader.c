#include "clocked_loader.h"

#include "layout.h"
#include "voxels.h"

void loader_start(loader *l, const block_setup *setup, texture_buffer *buffers)
{
    const vodr_machine *m = setup->machine;
    *l = (loader){.machine = m, .buffers = buffers, .buffer_count = m->double_buffer ? 2 : 1};
    for (int c = 0; c < 3; c++)
        l->dims_vox[c] = setup->volume->dims_vox[c];
    l->texture_base = fb_layout_of(m, setup->view->width_px, setup->view->height_px).lines * line_bytes(m);
    l->brick_room_bytes = brick_room_bytes(m, setup->edge_vox);
}

static loader_visit *visit_at(loader *l, int64_t number)
{
    return &l->visits[number & (LOADER_VISITS - 1)];
}

/* A brick that was handed on: it is there, or will be when its turn comes, or one of the buffers takes it. */
static void add_visit(loader *l, const brick_port *brick)
{
    loader_visit *v = visit_at(l, l->known++);
    *v = (loader_visit){.brick = brick->brick};
    if (l->machine->traversal == VODR_TRAVERSAL_WHOLE)
        return;
    for (int i = 0; i < l->buffer_count; i++)
        if (l->holds[i] && l->held[i] == brick->brick) {
            l->last_buffer = v->buffer = i;
            return;
        }
    l->last_buffer = v->buffer = (l->last_buffer + 1) % l->buffer_count;
    l->held[v->buffer] = brick->brick;
    l->holds[v->buffer] = true;
    v->region = voxels_reach(l->dims_vox, &brick->box, filter_border_vox(l->machine));
    v->bytes = density_bytes(l->machine);
    for (int c = 0; c < 3; c++)
        v->bytes *= v->region.hi[c] - v->region.lo[c];
}

/* Data of the first visit that has not its brick. */
static void take_data(loader *l, const loaded_port *load)
{
    int32_t size = density_bytes(l->machine);
    const loader_visit *v = visit_at(l, l->loaded);
    texture_buffer *b = &l->buffers[v->buffer];
    b->region = v->region;
    for (int32_t i = 0; i < load->bytes; i++, l->done_bytes++) {
        uint16_t *density = &b->densities[l->done_bytes / size];
        bool second = l->done_bytes % size != 0; /* a beat may end within a density */
        *density = (uint16_t)(second ? *density | load->data[i] << 8 : load->data[i]);
    }
    if (l->done_bytes < v->bytes)
        return;
    l->done_bytes = 0;
    l->loaded++;
}

/* Visits whose brick is there need nothing. */
static void skip_resident(loader *l, int64_t *number)
{
    while (*number < l->known && !visit_at(l, *number)->bytes)
        (*number)++;
}

void loader_clock(loader *l, const texture_unit_in *in, bool fetches, load_port *out)
{
    if (in->brick->fresh)
        add_visit(l, in->brick);
    l->drawn += in->fragment->visit_done;
    l->drained = fetches ? l->drained : l->drawn;
    l->asked += in->load->granted;
    if (out->valid && in->load->ready)
        out->valid = false;
    if (in->load->data_valid)
        take_data(l, in->load);
    skip_resident(l, &l->loaded);
    skip_resident(l, &l->asked);
    bool underway = l->wanted > l->asked;
    if (underway || l->asked == l->known || l->asked - l->buffer_count >= l->drained)
        return;
    const loader_visit *v = visit_at(l, l->asked);
    l->wanted = l->asked + 1;
    *out = (load_port){
        .valid = true, .address = l->texture_base + (int64_t)v->brick * l->brick_room_bytes, .bytes = v->bytes};
}

bool loader_ready(const loader *l)
{
    return l->loaded > l->drawn;
}

int loader_buffer(const loader *l)
{
    return l->visits[l->drawn & (LOADER_VISITS - 1)].buffer;
}
