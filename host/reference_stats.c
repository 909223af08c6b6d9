/* reference_stats.c - what a frame of the reference renderer took, as JSON (--stats). */
#include "reference_stats.h"

#include <math.h>

#include "json.h"
#include "stats.h"

double reference_samples_per_s(const reference_result *r)
{
    return r->wall_s > 0 ? (double)r->samples / r->wall_s : 0;
}

/* null where the choice has no such thing. */
static json_t *real_or_null(bool there, double value)
{
    return there ? json_real(value) : json_null();
}

static json_t *reference_object(const scene *s, const reference_choice *c, const reference_result *r)
{
    const bool skips = c->accel != REFERENCE_ACCEL_NONE, turned = c->accel == REFERENCE_ACCEL_ALIGNED_PAPER;
    return json_pack("{s:s, s:o, s:s, s:s, s:s, s:s, s:o, s:o, s:s, s:o, s:o, s:o, s:o, s:o}", "device",
                     reference_device_word(c), "device_name", json_text(r->device), "method", reference_method_name(c),
                     "numbers", reference_numbers_name(c), "accel", reference_accel_name(c), "filter",
                     reference_filter_name(c, s), "step_vox", real_or_null(c->method == REFERENCE_RAYCAST, c->step_vox),
                     "block_vox", skips ? json_integer(c->block_vox) : json_null(), "shading",
                     reference_shading_name(c), "termination", real_or_null(!c->fixed, c->termination), "copies",
                     r->copies > 0 ? json_integer(r->copies) : json_null(), "theta_deg",
                     real_or_null(turned, r->theta_deg), "turn_ms", real_or_null(turned, r->turn_ms), "psnr_db",
                     real_or_null(turned && isfinite(r->psnr_db), r->psnr_db));
}

host_status reference_stats_write(output *o, const scene *s, const view_options *v, const reference_choice *c,
                                  const reference_result *r, host_error *error)
{
    return json_write(o,
                      json_pack("{s:s, s:s, s:o, s:o, s:o, s:o, s:i, s:I, s:s, s:i, s:i, s:f, s:f, s:f, s:f}", "schema",
                                "vodr-reference-stats-1", "version", VODR_VERSION, "reference",
                                reference_object(s, c, r), "machine", json_machine(s->machine_name, &s->machine),
                                "volume", json_volume(s, v), "view", stats_view(s), "slices", (int)s->view.slices,
                                "samples", (json_int_t)r->samples, "frame_sha256", r->frame_sha256, "threads",
                                (int)v->threads, "repeat", r->repeat, "wall_s", r->wall_s, "kernel_ms", r->kernel_ms,
                                "preprocess_ms", r->preprocess_ms, "samples_per_s", reference_samples_per_s(r)),
                      error);
}
