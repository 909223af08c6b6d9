/* accel.c - which ways past what does not show, and of reading what does, go with which filters and blends. */
#include "reference.h"

bool reference_is_cubic(reference_filter filter)
{
    return filter == REFERENCE_CARDINAL || filter == REFERENCE_BSPLINE;
}

bool reference_accel_is_aligned(reference_accel accel)
{
    return accel == REFERENCE_ACCEL_ALIGNED || accel == REFERENCE_ACCEL_ALIGNED_BEST ||
           accel == REFERENCE_ACCEL_ALIGNED_PAPER;
}

bool reference_accel_suits(reference_accel accel, reference_blend blend, reference_filter filter)
{
    switch (accel) {
    case REFERENCE_ACCEL_BLOCK: return !reference_is_cubic(filter);
    case REFERENCE_ACCEL_BISECT:
    case REFERENCE_ACCEL_SEED: return !reference_is_cubic(filter) && blend == REFERENCE_MIP;
    case REFERENCE_ACCEL_RIVAL:
    case REFERENCE_ACCEL_HULL: return reference_is_cubic(filter);
    case REFERENCE_ACCEL_ALIGNED:
    case REFERENCE_ACCEL_ALIGNED_BEST:
    case REFERENCE_ACCEL_ALIGNED_PAPER: return filter == REFERENCE_BSPLINE;
    case REFERENCE_ACCEL_UNSAFE: return filter == REFERENCE_CARDINAL;
    default: return true;
    }
}
