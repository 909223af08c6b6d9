/* alpha_blender.c - blending with one correctly rounded product a channel (docs/architecture.md, "Blend"). */
#include "alpha_blender.h"

#include "layout.h"

alpha_blender alpha_blender_of(const vodr_machine *m)
{
    return (alpha_blender){.mode = (vodr_blend)m->blend, .full = m->fb_bits == 16 ? 65535 : 255};
}

/* a*b / full, rounded to nearest, without a division; a and b are at most full. */
static inline uint16_t scale(uint32_t a, uint32_t b, uint32_t full)
{
    uint32_t bits = full == 255 ? 8 : 16, x = a * b + (1u << (bits - 1));
    return (uint16_t)((x + (x >> bits)) >> bits);
}

/* near in front of far. Neither sum can exceed `full`: both are premultiplied. */
static inline vodr_rgba composite(vodr_rgba near, vodr_rgba far, uint32_t full)
{
    uint32_t through = full - near.a;
    return (vodr_rgba){
        (uint16_t)(near.r + scale(far.r, through, full)), (uint16_t)(near.g + scale(far.g, through, full)),
        (uint16_t)(near.b + scale(far.b, through, full)), (uint16_t)(near.a + scale(far.a, through, full))};
}

static int32_t run_over(uint32_t full, const vodr_rgba *src, int32_t count, vodr_rgba *pixel)
{
    for (int32_t i = 0; i < count; i++)
        pixel[i] = composite(src[i], pixel[i], full);
    return count;
}

static int32_t run_under(uint32_t full, const vodr_rgba *src, int32_t count, vodr_rgba *pixel, uint64_t *terminated)
{
    int32_t written = 0;
    for (int32_t i = 0; i < count; i++) {
        if (pixel[i].a == full)
            continue;
        pixel[i] = composite(pixel[i], src[i], full);
        written++;
    }
    *terminated += (uint64_t)(count - written);
    return written;
}

/* A pixel's r is the largest density so far, its a whether there was one. */
static int32_t run_mip(const vodr_rgba *src, int32_t count, vodr_rgba *pixel)
{
    int32_t written = 0;
    for (int32_t i = 0; i < count; i++)
        if (!pixel[i].a || src[i].r > pixel[i].r) {
            pixel[i] = src[i];
            written++;
        }
    return written;
}

int32_t alpha_blender_run(const alpha_blender *b, const vodr_rgba *src, int32_t count, vodr_rgba *pixel,
                          uint64_t *terminated)
{
    switch (b->mode) {
    case VODR_BLEND_OVER: return b->full == 255 ? run_over(255, src, count, pixel) : run_over(65535, src, count, pixel);
    case VODR_BLEND_UNDER: return run_under(b->full, src, count, pixel, terminated);
    default: return run_mip(src, count, pixel);
    }
}
