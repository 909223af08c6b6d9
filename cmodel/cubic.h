/* cubic.h - the cubic filters in integers: the weights of four voxels along an axis, what 64 voxels make, and between
 * which bounds that lies (docs/architecture.md, section 6, "cardinal" and "bspline"). */
#ifndef VODR_CUBIC_H
#define VODR_CUBIC_H

#include "view.h"
#include "vodr.h"

enum { CUBIC_TAPS = 4, CUBIC_VOXELS = 64, CUBIC_MORE_BITS = 2 /* of a weight, beyond weight_bits */ };

/* Of voxels i-1 to i+2, with weight_bits + CUBIC_MORE_BITS fraction bits: they add up to one. */
typedef struct cubic_weights {
    int16_t tap[CUBIC_TAPS];
} cubic_weights;

typedef struct cubic {
    cubic_weights *weights; /* by the share that a position has of the way from voxel i to i+1 */
    int32_t weight_bits;    /* of a weight */
    int32_t guard_bits;
    int32_t drop_bits; /* fraction bits of a sum: guard bits, and those of a coefficient */
    int32_t most;      /* the largest density */
} cubic;

/* Makes the table of weights, if the machine's filter is cubic; false when the host is out of memory. Free with
 * cubic_finish() in either case. */
bool cubic_start(cubic *c, const vodr_machine *m);
void cubic_finish(cubic *c);

/* The filter's output: voxel x + 4*y + 16*z of `voxels`, weighted by the shares of the three axes. */
int32_t cubic_value(const cubic *c, const int32_t share[3], const int32_t voxels[CUBIC_VOXELS]);

/* Turns a range of what texture memory holds into bounds of the densities that any filter makes of it. */
void filter_range(const vodr_machine *m, int32_t *min, int32_t *max);

/* Bounds of the densities that the machine's filter makes of samples inside a box of the volume. */
void filter_bounds(const vodr_machine *m, const vodr_volume *volume, const vox_box *box, int32_t *min, int32_t *max);

#endif
