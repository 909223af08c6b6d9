/* lerp.c - the texture unit's interpolation in Verilog, of all pairs of 8-bit densities and all weights of 8 bits, with
 * 4 guard bits: 2^24 results as docs/architecture.md, section 6, has them. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

#include "exhaustive.h"
#include "library.h"

enum { BITS = 8, GUARD_BITS = 4 };

static int32_t expected(int32_t a, int32_t b, int32_t weight)
{
    a *= 1 << GUARD_BITS;
    b *= 1 << GUARD_BITS;
    return a + (((b - a) * weight) >> BITS);
}

void lockstep_lerp(void **state)
{
    (void)state;
    const rtl_source source = {
        .root = VODR_ROOT, .build = VODR_BUILD, .file = VODR_ROOT "/tests/lockstep/lerp_alone.v"};
    rtl_library library;
    vodr_error error;
    if (rtl_module_open(&source, "lerp_alone", &library, &error) != RTL_OK) {
        fail_msg("%s", error.text);
    }
    uint8_t *a = rtl_library_port(&library, "first")->data, *b = rtl_library_port(&library, "second")->data;
    uint8_t *weight = rtl_library_port(&library, "share")->data;
    const uint16_t *result = rtl_library_port(&library, "result")->data;
    for (int32_t i = 0; i < 1 << 3 * BITS; i++) {
        *a = (uint8_t)i;
        *b = (uint8_t)(i >> BITS);
        *weight = (uint8_t)(i >> 2 * BITS);
        library.model.eval(library.model.state);
        if (*result != expected(*a, *b, *weight)) {
            fail_msg("lerp(%d, %d, %d): expected %d, got %d", *a, *b, *weight, expected(*a, *b, *weight), *result);
        }
    }
    rtl_library_close(&library);
}
