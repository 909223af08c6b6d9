/* stand_in.h - a volume enlarged to the size of one that a paper measured, and views of it. */
#ifndef BENCH_STAND_IN_H
#define BENCH_STAND_IN_H

#include "reference.h"

enum { STAND_IN_VIEWS = 5 };

typedef struct stand_in {
    const char *name, *path, *type; /* uint8 or int16, little endian */
    int32_t from[3], to[3];         /* voxels in the file and enlarged */
    int side_px;
} stand_in;

/* Reads the sizes WxHxD. */
bool stand_in_size(const char *text, int32_t size[3]);

/* The voxels, from 0 to 65535; NULL after a sentence. free() them. */
uint16_t *stand_in_read(const stand_in *s);

/* The rays of a view: parallel, a sample a voxel, the volume's greater side as wide as the picture. */
bool stand_in_rays(const stand_in *s, int view, reference_camera *camera);
const char *stand_in_view(int view);

/* The same of a frame of an orbit: once round, and thrice up and down by 75 degrees. */
bool stand_in_orbit(const stand_in *s, int frame, int frames, reference_camera *camera);

#endif
