/* vodr.h - the public interface of libvodr: a bit-exact model of a volume graphics machine.
 *
 * A frame is drawn by one call, vodr_render(), from four values that the caller owns: the machine (its parameters), the
 * volume, the transfer-function table, and the view (the registers an application writes). docs/architecture.md is
 * normative for every byte and every count that comes out.
 *
 * Threads: the library holds no mutable global state. Any number of calls may run at once, on the same inputs too.
 * Errors: a function that can fail returns a vodr_status and writes one sentence to its vodr_error. */
#ifndef VODR_H
#define VODR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vodr_hw.h" /* generated from hw/: vodr_machine, its enums, vodr_parameter, vodr_register */

#ifdef __cplusplus
extern "C" {
#endif

#define VODR_VERSION "0.3.0"

typedef enum vodr_status {
    VODR_OK = 0,
    VODR_INVALID,   /* an input is outside what the machine can do; the sentence says which, and the range */
    VODR_NO_MEMORY, /* the host is out of memory */
} vodr_status;

/* One sentence without a final newline: what was wrong, where, and what would be right. */
typedef struct vodr_error {
    char text[512];
} vodr_error;

/* ---- the machine (Figure 2 of the paper; parameters in hw/parameters.txt) ---- */

/* The parameters, in the order of hw/parameters.txt. *count receives how many. */
const vodr_parameter *vodr_parameters(size_t *count);

/* The name of machine i of hw/machines, in alphabetical order; NULL past the last. */
const char *vodr_machine_name(size_t i);

/* Every parameter at its default. */
vodr_machine vodr_machine_default(void);

/* The machine called `name`; VODR_INVALID, with the names there are, if there is none. */
vodr_status vodr_machine_named(const char *name, vodr_machine *machine, vodr_error *error);

/* The text of a named machine's file, comments and all; NULL if there is no such machine. Static. */
const char *vodr_machine_text(const char *name);

/* Sets one parameter from text, as `--set` does. The machine is untouched when the name or the value is wrong. */
vodr_status vodr_machine_set(vodr_machine *machine, const char *name, const char *value, vodr_error *error);

/* Reads a machine file's text: lines `name = value`, `#` to the end of a line is a comment, what is not named keeps its
 * default. A parameter named twice is an error. `where` names the text in error sentences ("my.txt"). */
vodr_status vodr_machine_parse(const char *text, const char *where, vodr_machine *machine, vodr_error *error);

/* Writes a parameter's value as text ("16x1", "layer", "4096"). size >= 32. */
void vodr_machine_get(const vodr_machine *machine, const vodr_parameter *parameter, char *text, size_t size);

/* Whether the combination of parameters can be built; the sentence says why not. */
vodr_status vodr_machine_check(const vodr_machine *machine, vodr_error *error);

/* ---- the volume ---- */

#define VODR_MAX_DIM_VOX 32768

/* A volume in memory, x fastest, then y, then z. The caller owns the voxels and keeps them for the whole call.
 * voxel_bytes 1: density of voxel v is map[v], or v itself where map is NULL (then density_bits must be 8).
 * voxel_bytes 2: density is the voxel, in native byte order, clamped to 2^density_bits - 1; map is not used.
 * filter=bspline takes coefficients instead, voxel_bytes 2: int16_t, with 3 fraction bits where density_bits is 8, none
 * where it is 12 (docs/architecture.md, section 11, says how the application makes them); map is not used.
 * Entries of map are below 2^density_bits. Nothing is copied: a voxel is converted as it enters texture memory.
 *
 * Only samples in [lo, hi) are drawn, cut into bricks from lo on; both 0, 0, 0: all. What lies around is there to be
 * filtered, so that a node of a cluster draws its part of a larger volume as that is drawn. */
typedef struct vodr_volume {
    int32_t dims_vox[3];
    int32_t voxel_bytes;
    const void *voxels;
    const uint16_t *map;
    int32_t lo_vox[3], hi_vox[3];
} vodr_volume;

/* ---- the transfer-function table ---- */

/* One premultiplied colour: each of r, g, b at most a, a at most 255 or 65535 (8 or 16 bits a channel). */
typedef struct vodr_rgba {
    uint16_t r, g, b, a;
} vodr_rgba;

/* The table the texture unit classifies with: 2^density_bits entries of tf_bits a channel, indexed by density. The
 * opacity is the one of a slice (corrected for the slices' spacing by whoever fills the table). The caller owns it. */
typedef struct vodr_table {
    const vodr_rgba *entries;
    size_t count;
} vodr_table;

/* ---- the view: the registers of hw/registers.txt ---- */

#define VODR_MAX_SIZE_PX 16384
#define VODR_MAX_SLICES 16384
#define VODR_POSITION_BITS 24  /* fraction bits of a position, Q19.24 */
#define VODR_DEPTH_BITS 16     /* fraction bits of depth_first and depth_step beyond a slice's depth */
#define VODR_FOOTPRINT_BITS 20 /* fraction bits of footprint */

/* Where pixel (x, y) of slice k samples the volume, in voxels, component by component (docs/architecture.md,
 * "Positions"). Slice 0 is the farthest, row 0 the top of the frame; voxel i covers [i, i+1) and has its centre at i +
 * 0.5. */
/* parallel: base + k*step_s + x*step_u + y*step_v */
/* perspective: base + ((z*(step_s + x*step_u + y*step_v)) >> shift) with z = (depth_first + k*depth_step) >> 16 */
typedef struct vodr_view {
    int32_t width_px, height_px; /* 1 to VODR_MAX_SIZE_PX */
    int32_t slices;              /* 1 to VODR_MAX_SLICES */
    bool perspective;
    int32_t shift;      /* 0 to 30; 0 in parallel views */
    uint32_t footprint; /* UQ12.20, at least 1: see hw/registers.txt and the volume divider's page */
    int64_t base[3];    /* Q19.24 voxels */
    int64_t step_u[3], step_v[3], step_s[3];
    int64_t depth_first, depth_step;
} vodr_view;

/* A register of hw/registers.txt by its name, as a view of a volume of these sides has it. False when there is none. */
bool vodr_register_get(const char *name, const vodr_view *view, const int32_t dims_vox[3], int64_t *value);

/* Writes a register of the view. False when it has none of this name (dim_x, dim_y, dim_z are the volume's) or its
 * field cannot hold the value; what the machine accepts vodr_view_check() says. */
bool vodr_register_set(const char *name, int64_t value, vodr_view *view);

/* Whether every position of the view fits its format; the sentence names the register. */
vodr_status vodr_view_check(const vodr_view *view, const int32_t dims_vox[3], vodr_error *error);

/* ---- a frame ---- */

/* The blocks, in the order of Figure 2. */
typedef enum vodr_block {
    VODR_BLOCK_VOLUME_DIVIDER,
    VODR_BLOCK_SLICE_GENERATOR,
    VODR_BLOCK_RASTERIZER,
    VODR_BLOCK_TEXTURE_UNIT,
    VODR_BLOCK_ALPHA_BLENDER,
    VODR_BLOCK_PIXEL_CACHE,
    VODR_BLOCK_FRAME_BUFFER,
    VODR_BLOCK_COUNT,
} vodr_block;

/* Why a block waits (docs/timing.md). */
typedef enum vodr_stall {
    VODR_STALL_DIVIDER,       /* the divider: the slice generator has not taken the last brick */
    VODR_STALL_SLICE,         /* the slice generator: the rasterizer has not taken the last slice */
    VODR_STALL_TEXTURE_LOAD,  /* rasterizer and texture unit: the brick is not in texture memory yet */
    VODR_STALL_FRAGMENT_FIFO, /* rasterizer and texture unit: no room before the alpha blender */
    VODR_STALL_CACHE,         /* the alpha blender: the pixel cache takes no access */
    VODR_STALL_HAZARD,        /* the alpha blender, or a non-blocking cache: the pixel is still being blended */
    VODR_STALL_WRITE_BACK,    /* the pixel cache: the replaced line has to leave first */
    VODR_STALL_FILL,          /* the pixel cache: the line is on its way */
    VODR_STALL_DRAM_ROW,      /* the frame buffer: a row closes and opens */
    VODR_STALL_DRAM_REFRESH,  /* the frame buffer: the memory refreshes */
    VODR_STALL_TEXTURE_FETCH, /* the rasterizer: the texture unit fetches voxels of the fragment before */
    VODR_STALL_COUNT,
} vodr_stall;

/* A block's cycles: busy + stalled + idle = total. */
typedef struct vodr_block_cycles {
    uint64_t busy, stalled, idle;
} vodr_block_cycles;

typedef struct vodr_cycles {
    uint64_t total; /* 0 when not asked for, or when there was nothing to look at */
    vodr_block_cycles blocks[VODR_BLOCK_COUNT];
    uint64_t stalls[VODR_STALL_COUNT];
} vodr_cycles;

typedef struct vodr_counters {
    uint64_t fragments;            /* samples inside the volume, in bricks that were visited */
    uint64_t killed_fragments;     /* of these, dropped by kill_transparent before the pixel cache */
    uint64_t terminated_fragments; /* of these, found their pixel full (under) */
    uint64_t hits, misses;         /* pixel-cache accesses: hits + misses = fragments - killed_fragments */
    uint64_t evictions;            /* valid lines replaced */
    uint64_t writebacks;           /* dirty lines written, the flush at the frame's end included */
    uint64_t fb_read_bytes, fb_write_bytes;
    uint64_t texture_load_bytes; /* into texture memory; whole: fetched from the external texture memory */
    uint64_t bricks;             /* distinct bricks visited */
    uint64_t brick_visits;       /* visits: in tile order a brick may have several */
    uint64_t brick_slices;       /* slices of bricks that have a fragment, summed over visits */
    uint64_t
        brick_overflows; /* visits whose fragments span more than T columns or rows, T = floor(sqrt(cache pixels)) */
    uint64_t skipped_bricks; /* bricks that skip_empty left out, whether or not on the screen */
    int32_t brick_vox;       /* edge of a brick; 0 when the volume is drawn whole */
    int32_t tile_px;         /* T */
    vodr_cycles cycles;
} vodr_counters;

/* Which program draws the frame. */
typedef enum vodr_path {
    VODR_PATH_FAST,   /* blocks joined in one loop, where the machine allows it (docs/fast-path.md), else block by block
                       */
    VODR_PATH_BLOCKS, /* block by block, one fragment after the other: the slow truth */
    VODR_PATH_CLOCKED, /* every block clocked, cycle by cycle: the slow truth of cycles */
} vodr_path;

/* Which instructions the fast path may use; one the computer lacks falls back to the next lower. */
typedef enum vodr_simd {
    VODR_SIMD_BEST,
    VODR_SIMD_PORTABLE,
    VODR_SIMD_AVX2,
    VODR_SIMD_AVX512,
} vodr_simd;

/* A brick whose first fragment is about to be drawn: its number (x fastest) and half-open box, and the half-open
 * rectangle of pixels that its fragments are clipped to (a tile, in tile order; else the frame, or the pipeline's band
 * of it). */
typedef struct vodr_visit {
    uint64_t brick;
    int32_t lo_vox[3], hi_vox[3];
    int32_t x0_px, y0_px, x1_px, y1_px;
} vodr_visit;

/* Told of events in the machine's own order, all from the calling thread; those of several pipelines, each in its own
 * order, come one after the other or mixed. Either function may be NULL. */
typedef struct vodr_observer {
    void *context;
    void (*visit)(void *context, const vodr_visit *visit);
    void (*miss)(void *context, int32_t x_px, int32_t y_px); /* the pixel whose access missed */
} vodr_observer;

/* How to compute the frame; none of it changes a byte or a count. All-zero is a good choice. */
typedef struct vodr_options {
    int32_t threads; /* at least 1; 0 = as many as the machine has cores */
    vodr_path path;
    vodr_simd simd;
    bool cycles; /* count cycles too; those of several pipelines are clocked, whatever the path, and take long */
    /* Called now and then from the calling thread with the done share, 0 to 1, which never falls; NULL for silence. */
    void (*progress)(void *context, double done);
    void *progress_context;
    const vodr_observer *observer; /* NULL: nobody */
} vodr_options;

/* A finished frame, premultiplied RGBA after read-out, rows top to bottom: fb_bits a channel, so 4 or 8 bytes a pixel
 * in native byte order. */
typedef struct vodr_frame {
    int32_t width_px, height_px;
    int32_t bits; /* 8 or 16 */
    void *pixels; /* owned by the frame: vodr_frame_free() */
    size_t bytes;
} vodr_frame;

/* Draws one frame. On success *frame is new and must be freed, *counters is filled; on failure both are zeroed.
 * VODR_INVALID when the machine, the table or the view fails its check, or a brick does not fit texture memory. */
vodr_status vodr_render(const vodr_machine *machine, const vodr_volume *volume, const vodr_table *table,
                        const vodr_view *view, const vodr_options *options, vodr_frame *frame, vodr_counters *counters,
                        vodr_error *error);

/* Frees the pixels and zeroes the frame. A zeroed frame may be freed. */
void vodr_frame_free(vodr_frame *frame);

#ifdef __cplusplus
}
#endif

#endif
