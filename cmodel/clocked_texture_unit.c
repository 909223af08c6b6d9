/* clocked_texture_unit.c - the texture unit, clocked: what it accepts, and the loader that fetches bricks ahead. */
#include "clocked_machine.h"

/* Where a fragment's density comes from: the functional texture unit, loaded with its brick. */
fragment clocked_shade(clocked *c, int64_t number, const brick_slice *slice, const span *s)
{
    const candidate *b = &visit_at(c, number)->brick;
    const span one = {.y = s->y, .x0 = s->x0 + c->done_px, .x1 = s->x0 + c->done_px + 1};
    if (!c->visit_accepted)
        texture_unit_load(&c->texture, b->brick, &b->box);
    c->counters.texture_load_bytes += texture_unit_fetched(&c->texture, 1);
    texture_unit_filter(&c->texture, slice, &one, &c->density);
    return (fragment){.x = one.x0,
                      .y = one.y,
                      .cycle = c->now,
                      .dead = c->texture.dead[c->density],
                      .colour = c->texture.colours[c->density]};
}

void clock_texture_loader(clocked *c)
{
    if (c->load_visit > c->pushed || c->load_wanted)
        return;
    brick_visit *v = visit_at(c, c->load_visit);
    int64_t before = c->load_visit - (c->m->double_buffer ? 2 : 1);
    if (v->divided >= c->now || c->load_grant >= c->now)
        return;
    if (v->load_bytes == 0) {
        v->loaded = v->divided;
        c->load_visit++;
        clock_texture_loader(c);
    } else if (before < 0 || visit_at(c, before)->drained < c->now) {
        c->load_wanted = true;
        c->load_raised = c->now;
    }
}
