/* alpha_blender.h - a fragment meets its pixel: over, under, or maximum (Figure 2 of the paper). */
#ifndef VODR_ALPHA_BLENDER_H
#define VODR_ALPHA_BLENDER_H

#include "vodr.h"

typedef struct alpha_blender {
    vodr_blend mode;
    uint32_t full; /* the largest value of a channel, 255 or 65535 */
} alpha_blender;

alpha_blender alpha_blender_of(const vodr_machine *m);

/* Blends fragment src[i] onto pixel[i] for each i below count. Returns how many pixels were written; adds to
 * *terminated how many were found full (under). */
int32_t alpha_blender_run(const alpha_blender *b, const vodr_rgba *src, int32_t count, vodr_rgba *pixel,
                          uint64_t *terminated);

#endif
