/* second.h - a second implementation of the machine, slow and plain, from docs/architecture.md alone.
 *
 * It shares no code and no idea of speed with cmodel/: every sample of the frame becomes a fragment in a list, the list
 * is sorted into the order that the document prescribes, and is then replayed one access at a time. What it takes and
 * gives back are the plain data types of vodr.h; it calls no function of libvodr. */
#ifndef TESTS_SECOND_H
#define TESTS_SECOND_H

#include "vodr.h"

/* Draws one frame as vodr_render() does; the caller frees the frame with vodr_frame_free(). VODR_INVALID where the
 * document refuses the machine, for itself or for this volume; the view is taken to be valid. */
vodr_status second_render(const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                          const vodr_view *view, vodr_frame *frame, vodr_counters *counters);

#endif
