/* fused.h - the fast path: the blocks from divider to blender fused into one loop, the machine's counters from its own
 * walk.
 *
 * The frame does not depend on the traversal (docs/architecture.md, section 3), so the fast path draws with bricks,
 * order and threads of its own choice, and lets the machine's own walk (pipeline.h, without a picture) count. What that
 * walk must know of fragments, the picture marks. docs/fast-path.md explains. */
#ifndef VODR_FUSED_H
#define VODR_FUSED_H

#include "pipeline.h"
#include "vodr.h"

/* Whether the fast path draws this frame: not a maximum in bricks left out by skip_empty alone, where what a fragment
 * writes does depend on the bricks; not one whose marks would take more than 48 MiB; not on a big-endian computer. */
bool fused_supports(const vodr_machine *machine, const vodr_view *view);

/* As vodr_render(), for a machine that is supported and inputs that `count`, a started pipeline without a picture, has
 * checked. Fills the frame and leaves `count` at its end. */
vodr_status fused_render(pipeline *count, const vodr_volume *volume, const vodr_options *options, vodr_frame *frame,
                         vodr_error *error);

#endif
