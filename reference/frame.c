/* frame.c - frames of 8 or 16 bits a channel. */
#include <math.h>
#include <stdlib.h>

#include "state.h"

reference_status reference_frame_make(int32_t width_px, int32_t height_px, int32_t bits, vodr_frame *frame,
                                      vodr_error *error)
{
    size_t bytes = (size_t)width_px * (size_t)height_px * (size_t)bits / 2;
    *frame = (vodr_frame){width_px, height_px, bits, malloc(bytes), bytes};
    if (frame->pixels)
        return REFERENCE_OK;
    *frame = (vodr_frame){0};
    return reference_fail(error, REFERENCE_NO_MEMORY, "no memory for a frame of %zu bytes", bytes);
}

void reference_frame_set(vodr_frame *frame, size_t i, uint16_t value)
{
    if (frame->bits == 8)
        ((uint8_t *)frame->pixels)[i] = (uint8_t)value;
    else
        ((uint16_t *)frame->pixels)[i] = value;
}

reference_status reference_quantise(const reference_camera *camera, const double *rgba, int32_t bits, vodr_frame *frame,
                                    vodr_error *error)
{
    reference_status status = reference_frame_make(camera->width_px, camera->height_px, bits, frame, error);
    double full = bits == 16 ? 65535 : 255;
    size_t channels = 4 * (size_t)camera->width_px * (size_t)camera->height_px;
    for (size_t i = 0; status == REFERENCE_OK && i < channels; i++)
        reference_frame_set(frame, i, (uint16_t)floor(fmin(fmax(rgba[i], 0), 1) * full + 0.5));
    return status;
}
