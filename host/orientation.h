/* orientation.h - private to the volume readers: which file axis runs right, up and towards the eye at view 0,0. */
#ifndef HOST_ORIENTATION_H
#define HOST_ORIENTATION_H

#include "volume.h"

/* The direction (right, anterior, superior) of a patient in the world's axes: the head stands upright and faces the
 * viewer, so world right is the patient's left, up is superior, towards the eye is anterior. */
void orientation_of_patient(const double ras[3], double world[3]);

/* Whether the directions [file axis][world axis], of any length, span space, as a rotation's do. */
bool orientation_is_sound(const double direction[3][3]);

/* Fills axis and sign with the permutation of axes nearest to the directions [file axis][world axis], of any length:
 * the one with the largest sum of absolute cosines. Ties go to the one that moves fewer of the first axes. */
void orientation_nearest(const double direction[3][3], int axis[3], int sign[3]);

/* The orientation in words: "right +x, up +z, towards the eye -y". */
void orientation_words(const volume *v, char *text, size_t size);

#endif
