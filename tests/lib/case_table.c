/* case_table.c - random premultiplied tables: the machine's, in integers only, and a reference renderer's. */
#include "case_parts.h"

#include <stdlib.h>

enum { RAMP, WINDOW, STEPS, FAINT, LOW, CORNERS, NOISE, KINDS };

/* Values where rounding turns over: both ends, both sides of the middle. */
static int64_t corner(rng *r, int64_t top)
{
    const int64_t corners[] = {0, 1, 2, top / 2, top / 2 + 1, top - 1, top};
    return corners[rng_int(r, 0, 6)];
}

/* The alpha, 0 to top, of entry i of `count`. lo to hi is the window; `opacity` scales, in 256ths. */
static int64_t entry_alpha(rng *r, int kind, int64_t i, int64_t count, int64_t lo, int64_t hi, int64_t opacity,
                           int64_t top)
{
    switch (kind) {
    case RAMP: return top * i / (count - 1) * opacity / 256;
    case WINDOW: return i >= lo && i <= hi ? top * opacity / 256 : 0;
    case STEPS: return i >= lo && i <= hi ? top : i > hi ? top / 5 : 0;
    case FAINT: return i < lo ? 0 : rng_int(r, 0, 3 + top / 200); /* near the rounding to zero of a narrower channel */
    case LOW: return i <= lo ? top * opacity / 256 : 0;
    case CORNERS: return corner(r, top);
    default: return rng_int(r, 0, top);
    }
}

bool case_make_table(test_case *c)
{
    rng *r = &c->random;
    int64_t count = (int64_t)1 << c->machine.density_bits;
    int64_t top = (1 << c->machine.tf_bits) - 1;
    int kind = (int)rng_int(r, 0, KINDS - 1);
    int64_t lo = rng_int(r, 0, rng_int(r, 0, count - 1));
    int64_t hi = rng_int(r, lo, count - 1);
    int64_t opacity = rng_int(r, 1, 256);
    bool grey = rng_one_in(r, 3);
    c->entries = calloc((size_t)count, sizeof *c->entries);
    if (!c->entries) {
        return false;
    }
    for (int64_t i = 0; i < count; i++) {
        int64_t a = entry_alpha(r, kind, i, count, lo, hi, opacity, top);
        int64_t red = kind == CORNERS ? corner(r, top) : rng_int(r, 0, a);
        int64_t green = rng_int(r, 0, a);
        red = red < a ? red : a;
        c->entries[i] = (vodr_rgba){.r = (uint16_t)(grey ? a : red),
                                    .g = (uint16_t)(grey ? a : green),
                                    .b = (uint16_t)(grey ? a : a * i / (count - 1)),
                                    .a = (uint16_t)a};
    }
    c->table = (vodr_table){.entries = c->entries, .count = (size_t)count};
    return true;
}

void case_fill_rgba(rng *r, double rgba[4 * CASE_COLUMNS * CASE_ROWS])
{
    const bool sparse = rng_one_in(r, 2);
    const int only = (int)rng_int(r, 0, CASE_COLUMNS - 1);
    const double most = rng_one_in(r, 4) ? 1 : rng_real(r, 0.001, 0.3);
    bool shows = rng_one_in(r, 2);
    for (int i = 0; i < CASE_COLUMNS * CASE_ROWS; i++) {
        if (i % CASE_COLUMNS == 0 || rng_one_in(r, 12))
            shows = !shows;
        if (sparse)
            shows = i % CASE_COLUMNS >= only && i % CASE_COLUMNS < only + 4;
        rgba[4 * i + 3] = shows ? rng_real(r, 0, most) : 0;
        for (int n = 0; n < 3; n++)
            rgba[4 * i + n] = rgba[4 * i + 3] * rng_real(r, 0, 1);
    }
}
