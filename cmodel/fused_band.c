/* fused_band.c - a band's pixels and its place in the order of bricks. */
#include "fused_band.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"

static size_t pixel_bytes_of(const fused_scene *s)
{
    return s->table8 ? sizeof(uint32_t) : sizeof(uint64_t);
}

static vodr_status make_pixels(fused_band *b, vodr_error *error)
{
    size_t rows = (size_t)(b->px.y1 - b->px.y0), bytes = b->stride_px * rows * pixel_bytes_of(b->scene);
    b->pixels = calloc(bytes, 1);
    return b->pixels ? VODR_OK : vodr_fail(error, VODR_NO_MEMORY, "no memory for a band of %zu bytes", bytes);
}

vodr_status fused_band_start(fused_band *b, const fused_scene *scene, int32_t y0_px, int32_t y1_px, vodr_error *error)
{
    *b = (fused_band){.scene = scene,
                      .px = {0, y0_px, scene->view->width_px, y1_px},
                      .stride_px = (size_t)scene->view->width_px + FUSED_LANES};
    vodr_status status = make_pixels(b, error);
    return status != VODR_OK ? status
                             : volume_divider_start(&b->divider, &scene->walk, scene->volume, scene->view,
                                                    scene->edge_vox, &b->px, NULL, error);
}

vodr_status fused_band_split(fused_band *b, int32_t y_px, fused_band *other, vodr_error *error)
{
    size_t row_bytes = b->stride_px * pixel_bytes_of(b->scene);
    *other = (fused_band){.scene = b->scene, .px = b->px, .stride_px = b->stride_px};
    other->px.y0 = y_px;
    vodr_status status = make_pixels(other, error);
    if (status == VODR_OK)
        status = volume_divider_split(&b->divider, y_px, &other->divider, error);
    if (status != VODR_OK)
        return status;
    memcpy(other->pixels, (const uint8_t *)b->pixels + (size_t)(y_px - b->px.y0) * row_bytes,
           (size_t)(b->px.y1 - y_px) * row_bytes);
    b->px.y1 = y_px;
    return VODR_OK;
}

/* A row of mip's tokens as colours. */
static void read_out(const fused_scene *s, const uint32_t *tokens, void *pixels)
{
    for (int32_t x = 0; x < s->frame->width_px; x++) {
        const vodr_rgba nothing = {0}, *c = &nothing;
        if (tokens[x] & FUSED_TOUCHED)
            c = &s->texture->readout[tokens[x] & (FUSED_TOUCHED - 1)];
        const uint16_t channels[4] = {c->r, c->g, c->b, c->a};
        for (int i = 0; i < 4; i++) {
            if (s->frame->bits == 16)
                ((uint16_t *)pixels)[4 * x + i] = channels[i];
            else
                ((uint8_t *)pixels)[4 * x + i] = (uint8_t)channels[i];
        }
    }
}

void fused_band_store(const fused_band *b)
{
    const vodr_frame *f = b->scene->frame;
    size_t row_bytes = (size_t)f->width_px * (size_t)f->bits / 2;
    for (int32_t y = b->px.y0; y < b->px.y1; y++) {
        const uint8_t *from = (const uint8_t *)b->pixels + fused_band_at(b, 0, y) * pixel_bytes_of(b->scene);
        uint8_t *to = (uint8_t *)f->pixels + (size_t)y * row_bytes;
        if (b->scene->machine->blend == VODR_BLEND_MIP)
            read_out(b->scene, (const uint32_t *)(const void *)from, to);
        else
            memcpy(to, from, row_bytes);
    }
}

void fused_band_finish(fused_band *b)
{
    volume_divider_finish(&b->divider);
    free(b->pixels);
    b->pixels = NULL;
}
