/* cells_cuda.h - private to device_cuda.cu: the volume as the card's packed cells (kernel_types.h, lanes_cuda.h). */
#ifndef REFERENCE_CELLS_CUDA_H
#define REFERENCE_CELLS_CUDA_H

#include <stdint.h>

/* A cell of 8-bit or 16-bit voxels is eight of them. */
template <typename voxel, typename word>
static __global__ void pack_cells(const voxel *voxels, int3 size, word *cells, unsigned count)
{
    unsigned i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= count)
        return;
    const int row = size.x + 1, layer = row * (size.y + 1);
    int z = i / layer, y = i % layer / row, x = i % layer % row;
    union {
        voxel corner[8];
        word whole_cell;
    } cell;
    for (int n = 0; n < 8; n++) {
        int nx = min(max(x - 1 + (n & 1), 0), size.x - 1), ny = min(max(y - 1 + (n >> 1 & 1), 0), size.y - 1);
        int nz = min(max(z - 1 + (n >> 2), 0), size.z - 1);
        cell.corner[n] = voxels[((size_t)nz * size.y + ny) * size.x + nx];
    }
    cells[i] = cell.whole_cell;
}

#endif
