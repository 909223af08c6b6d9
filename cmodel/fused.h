/* fused.h - the fast path: the blocks from divider to blender fused into one loop, the machine's counters from its
 * geometry.
 *
 * The frame does not depend on the traversal (docs/architecture.md, section 3), so the fast path draws with bricks,
 * order and threads of its own choice, and lets the machine's own walk (pipeline.h, without a picture) count.
 * docs/fast-path.md explains. */
#ifndef VODR_FUSED_H
#define VODR_FUSED_H

#include "pipeline.h"
#include "vodr.h"

/* Whether the fast path draws this machine's frames. */
bool fused_supports(const vodr_machine *machine);

/* As vodr_render(), for a machine that is supported and inputs that `count`, a started pipeline without a picture, has
 * checked. Fills the frame and leaves `count` at its end. */
vodr_status fused_render(pipeline *count, const vodr_volume *volume, const vodr_options *options, vodr_frame *frame,
                         vodr_error *error);

#endif
