#include "phantom.h"

#include "rng.h"

enum { N = PHANTOM_SIDE_VOX, LEVELS = 256, NOISE = 3, BALLS = 96, ONE = 1 << 14 };

/* From 0 to `top` as x goes from -width to width. */
static int64_t rise(int64_t x, int64_t width, int64_t top)
{
    return x <= -width ? 0 : x >= width ? top : top * (x + width) / (2 * width);
}

/* An egg round a point: 4096 at its skin, 0 in its middle, growing by the square. Radii and places in half voxels. */
static int64_t egg(const int64_t at[3], int64_t x, int64_t y, int64_t z, const int64_t radii[3])
{
    const int64_t d[3] = {at[0] - x, at[1] - y, at[2] - z};
    int64_t sum = 0;
    for (int c = 0; c < 3; c++)
        sum += 4096 * d[c] * d[c] / (radii[c] * radii[c]);
    return sum;
}

static int64_t head(const int64_t at[3])
{
    static const int64_t skin[3] = {36, 44, 40}, outer[3] = {33, 41, 37}, inner[3] = {29, 37, 33},
                         hollow[3] = {4, 9, 6};
    int64_t value = rise(4096 - egg(at, 0, 0, 0, skin), 260, 70);
    value += rise(4096 - egg(at, 0, 0, 0, outer), 300, 140);
    value -= rise(4096 - egg(at, 0, 0, 0, inner), 400, 115);
    value -= rise(4096 - egg(at, 7, 3, 0, hollow), 900, 40);
    return value - rise(4096 - egg(at, -7, 3, 0, hollow), 900, 40);
}

/* The tube is balls whose middles turn by a small angle from one to the next: sine and cosine in ONEs, exact enough to
 * come round, and the same everywhere. */
static int64_t vessels(const int64_t at[3])
{
    const int64_t cosine = 16069, sine = 3196; /* of 3 turns in BALLS steps */
    int64_t x = 24 * (int64_t)ONE, z = 0, most = 0;
    for (int i = 0; i < BALLS; i++) {
        const int64_t radius = 10 - 7 * i / BALLS, radii[3] = {radius, radius, radius};
        int64_t inside = rise(4096 - egg(at, x / ONE, 44 - 88 * i / BALLS, z / ONE, radii), 1500, 190);
        most = inside > most ? inside : most;
        const int64_t turned = (x * cosine - z * sine) / ONE;
        z = (x * sine + z * cosine) / ONE;
        x = turned;
    }
    const int64_t straight[3] = {6, 100, 6};
    int64_t inside = rise(4096 - egg(at, 0, 0, 0, straight), 1500, 160);
    return 30 + (inside > most ? inside : most);
}

void phantom_fill(phantom_kind kind, int32_t density_bits, uint16_t *voxels)
{
    rng r = {48};
    for (int64_t z = 0; z < N; z++)
        for (int64_t y = 0; y < N; y++)
            for (int64_t x = 0; x < N; x++) {
                const int64_t at[3] = {2 * x + 1 - N, 2 * y + 1 - N, 2 * z + 1 - N};
                int64_t value = (kind == PHANTOM_HEAD ? head(at) : vessels(at)) + rng_int(&r, -NOISE, NOISE);
                value = value < 0 ? 0 : value >= LEVELS ? LEVELS - 1 : value;
                *voxels++ = (uint16_t)(value << (density_bits - 8));
            }
}

void phantom_table(phantom_kind kind, int32_t tf_bits, size_t count, vodr_rgba *entries)
{
    const int64_t full = tf_bits == 16 ? 65535 : 255, from = kind == PHANTOM_HEAD ? 20 : 60;
    for (size_t i = 0; i < count; i++) {
        int64_t level = (int64_t)i * LEVELS / (int64_t)count;
        int64_t alpha = level < from ? 0 : level < 140 ? full * (level - from) / 1600 : full * (level - 130) / 70;
        alpha = alpha > full ? full : alpha;
        entries[i] = (vodr_rgba){.r = (uint16_t)alpha,
                                 .g = (uint16_t)(alpha * level / LEVELS),
                                 .b = (uint16_t)(level < 140 ? alpha / 2 : alpha * (level - 100) / LEVELS),
                                 .a = (uint16_t)alpha};
    }
}
