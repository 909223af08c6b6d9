/* phantom.h - volumes that look like real ones, in integers alone: the same voxels on every computer (docs/vectors.md).
 */
#ifndef VECTORS_PHANTOM_H
#define VECTORS_PHANTOM_H

#include "vodr.h"

enum { PHANTOM_SIDE_VOX = 48 };

typedef enum phantom_kind {
    PHANTOM_HEAD,    /* skin, skull, a brain with two hollows; air round it */
    PHANTOM_VESSELS, /* a tube that winds round the y axis and grows thinner, and a straight one, in faint tissue */
} phantom_kind;

/* Fills a cube of PHANTOM_SIDE_VOX^3 densities of density_bits; noise is drawn from one seed. */
void phantom_fill(phantom_kind kind, int32_t density_bits, uint16_t *voxels);

/* A premultiplied table of `count` entries of tf_bits: a band of faint tissue and, from its upper half on, a bright
 * one; what lies below the band is clear. */
void phantom_table(phantom_kind kind, int32_t tf_bits, size_t count, vodr_rgba *entries);

#endif
