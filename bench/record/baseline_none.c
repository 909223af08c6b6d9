/* baseline_none.c - in the place of baseline.cu where make finds no nvcc. */
#include "baseline.h"

#include <stdio.h>

reference_status baseline_draw(const reference_volume *volume, const reference_march_job *job, double *rgba, double *ms,
                               int rounds, vodr_error *error)
{
    (void)volume, (void)job, (void)rgba, (void)ms, (void)rounds;
    snprintf(error->text, sizeof error->text, "this build has no CUDA");
    return REFERENCE_NO_DEVICE;
}
