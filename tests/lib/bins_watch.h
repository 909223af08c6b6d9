/* bins_watch.h - a clocked machine watched at its ports: what a bin's predicate may ask of a cycle, or of the frame. */
#ifndef TESTS_BINS_WATCH_H
#define TESTS_BINS_WATCH_H

#include "blocks.h"
#include "cases.h"

enum { BINS_WAITING = 1024 };

/* A link in this cycle. */
typedef struct bins_link {
    bool moved, waited, twice; /* it moved; it could not; it moved in the cycle before, too */
    uint64_t moves;            /* so often by now */
} bins_link;

typedef struct bins_watch {
    const test_case *c;
    const vodr_machine *machine;
    const block_outs *before, *now; /* what blocks registered in the cycle before this one, and in it */
    bins_link brick, slice, fragment, load, colour;

    bool blends; /* in this cycle the colour `source` meets `pixel` */
    uint64_t source, pixel;

    int64_t fills, writes;   /* under way to the frame buffer, and back */
    bool begins;             /* a transaction's first beat */
    int64_t row_cycles;      /* so long did it wait for its row */
    uint64_t flushed;        /* writes since the last read of a pixel: at the frame's end those of the flush */
    uint64_t clean, cleared; /* misses that replaced or filled without a transfer: by the frame's end */

    struct { /* what the above is made of */
        uint64_t colours[BINS_WAITING], gone, blended, door_colour;
        bool door_dead, beat, write;
        int64_t next_beat, row_cycles;
    } own;
} bins_watch;

/* A cycle. */
void bins_watch_cycle(bins_watch *w, const block_outs *before, const block_outs *now);

/* ---- of the frame's view ---- */

bool bins_octant(const bins_watch *w, int octant);    /* parallel: bit c: slices go down along axis c */
bool bins_eye(const bins_watch *w, int c, int place); /* the eye before (-1), within (0), beyond (1) the volume */
bool bins_dominant(const bins_watch *w, int c);
bool bins_tie(const bins_watch *w); /* two axes are dominant alike */

/* ---- of a cycle ---- */

/* A block says that it waits for this cause. */
bool bins_stalled(const report_port *report, vodr_stall cause);

/* The fragment that is accepted: it has a voxel beyond the volume's near or far side on an axis; its weight on an axis
 * is this share of the largest (0 or 1); it lies on a border of voxels. */
bool bins_clamps(const bins_watch *w, bool far);
bool bins_weight(const bins_watch *w, bool largest);
bool bins_on_border(const bins_watch *w);

/* A blend whose alphas are none (0), some (1) or all (2); in mip one of densities. */
bool bins_blend(const bins_watch *w, vodr_blend mode, int source, int pixel);
bool bins_opaque_without(const bins_watch *w);     /* a source that is opaque, one of its channels nothing */
bool bins_first(const bins_watch *w);              /* in mip: the pixel was not written yet */
bool bins_maximum(const bins_watch *w, int order); /* the source's density beside the pixel's: -1, 0, 1 */

#endif
