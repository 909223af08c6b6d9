#include "case_text.h"

#include <inttypes.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "columns.h"
#include "error.h"
#include "header.h"
#include "layout.h"
#include "modules.h"
#include "pixel_word.h"
#include "registers.h"

/* Larger ones would take the model in C long, and no vectors have them. */
enum { MOST_PIXELS = 1 << 28, MOST_BRICKS = 1 << 26, MOST_VOXELS = 1 << 18, MOST_SLICES = 1 << 14 };

/* ---- the view ---- */

/* The name of register i, in the order of hw/registers.txt; NULL for those of the volume. */
static const char *view_register(int i)
{
    const char *name = vodr_hw_registers[i].name;
    return strncmp(name, "dim_", 4) == 0 ? NULL : name;
}

/* ---- tables ---- */

static bool set_table_word(bench *b, vodr_block block, int64_t i, const uint8_t word[RTL_TABLE_BYTES])
{
    uint8_t is[RTL_TABLE_BYTES];
    if (block == VODR_BLOCK_VOLUME_DIVIDER) {
        b->own.walk.empty[i] = word[0];
    } else {
        b->own.tables.colours[i] = pixel_of_word(&b->machine, word_load(word, pixel_bytes(&b->machine)));
        b->own.tables.dead[i] = word[pixel_bytes(&b->machine)];
    }
    rtl_table_entry(block, &b->setup, i, is);
    return memcmp(is, word, RTL_TABLE_BYTES) == 0;
}

/* ---- writing ---- */

static void put_digits(FILE *file, const void *value, int32_t width_bits)
{
    char text[32];
    *column_put(text, value, width_bits, RTL_TABLE_BYTES) = '\0';
    fputs(text, file);
}

static void put_voxels(FILE *file, const vodr_volume *v)
{
    size_t voxels = (size_t)v->dims_vox[0] * (size_t)v->dims_vox[1] * (size_t)v->dims_vox[2];
    fputs("voxels ", file);
    for (size_t i = 0; i < voxels; i++)
        put_digits(file, (const char *)v->voxels + i * (size_t)v->voxel_bytes, 8 * v->voxel_bytes);
    fputc('\n', file);
}

static bool put_registers(FILE *file, vodr_block block, const bench *b)
{
    rtl_registers *registers = rtl_registers_of(&b->setup);
    fputs("registers", file);
    for (const module_register *r = rtl_module_of(block)->registers; registers && r->name; r++) {
        uint64_t value = 0;
        rtl_register(registers, r->name, &value);
        fputc(' ', file);
        put_digits(file, &value, r->width_bits);
    }
    fputc('\n', file);
    free(registers);
    return registers != NULL;
}

static void put_table(FILE *file, vodr_block block, const bench *b)
{
    int64_t entries = rtl_table_entries(block, &b->setup);
    fprintf(file, "table %" PRId64, entries);
    for (int64_t i = 0; i < entries; i++) {
        uint8_t word[RTL_TABLE_BYTES];
        rtl_table_entry(block, &b->setup, i, word);
        fputc(' ', file);
        put_digits(file, word, rtl_table_bits(block, &b->machine));
    }
    fputc('\n', file);
}

bool case_text_put(FILE *file, const char *name, uint64_t seed, const vectors_choice *choice, const bench *b)
{
    const int32_t *dims = b->scene.input.dims_vox;
    fprintf(file, "case %s seed=%016" PRIx64 "\nmachine ", name, seed);
    header_put_machine(file, &b->machine, &choice->machine, ' ');
    fputs("\nview", file);
    for (int i = 0; i < VODR_REGISTER_COUNT; i++) {
        int64_t value;
        if (view_register(i) && vodr_register_get(view_register(i), &b->scene.view, dims, &value))
            fprintf(file, " %s=%" PRId64, view_register(i), value);
    }
    fprintf(file, "\nvolume %" PRId32 "x%" PRId32 "x%" PRId32 "\n", dims[0], dims[1], dims[2]);
    if (b->scene.voxels)
        put_voxels(file, &b->scene.input);
    bool good = put_registers(file, choice->block, b);
    if (rtl_module_of(choice->block)->table)
        put_table(file, choice->block, b);
    return good;
}

/* ---- reading ---- */

typedef struct reader {
    case_text_source *next;
    void *context;
    const vectors_choice *choice;
    bench *b;
    vodr_error *error;
} reader;

static vectors_status refuse(const reader *r, const char *what)
{
    vodr_fail(r->error, VODR_INVALID, "%s", what);
    return VECTORS_INVALID;
}

/* The rest of the next line when it begins with `word`. */
static vectors_status next_line(const reader *r, const char *word, const char **rest)
{
    const char *line = r->next(r->context);
    size_t length = strlen(word);
    if (line && strncmp(line, word, length) == 0 && (line[length] == ' ' || !line[length])) {
        *rest = line + length + (line[length] == ' ');
        return VECTORS_OK;
    }
    vodr_fail(r->error, VODR_INVALID, "a line '%s ...' must stand here", word);
    return VECTORS_INVALID;
}

static vectors_status read_machine(const reader *r)
{
    const char *rest;
    vectors_status status = next_line(r, "machine", &rest);
    r->b->machine = r->choice->machine;
    if (status == VECTORS_OK && bench_set(&r->b->machine, rest, r->error) != VODR_OK)
        return VECTORS_INVALID;
    return status;
}

static vectors_status read_view(const reader *r)
{
    const char *rest;
    vectors_status status = next_line(r, "view", &rest);
    for (int i = 0; status == VECTORS_OK && i < VODR_REGISTER_COUNT; i++) {
        const char *name = view_register(i);
        if (!name)
            continue;
        size_t length = strlen(name);
        int64_t value;
        int taken = 0;
        bool named = strncmp(rest, name, length) == 0 && rest[length] == '=';
        if (!named || sscanf(rest + length + 1, "%20" SCNd64 "%n", &value, &taken) != 1 ||
            !vodr_register_set(name, value, &r->b->scene.view)) {
            vodr_fail(r->error, VODR_INVALID, "%s=NUMBER must stand here, in its range", name);
            return VECTORS_INVALID;
        }
        rest += length + 1 + (size_t)taken;
        rest += *rest == ' ';
    }
    if (status != VECTORS_OK)
        return status;
    const vodr_view *v = &r->b->scene.view;
    if (*rest)
        return refuse(r, "the view has more than its registers");
    if (v->width_px < 1 || v->height_px < 1 || v->width_px > MOST_PIXELS / v->height_px || v->slices > MOST_SLICES)
        return refuse(r, "vectors have frames of at most 2^28 pixels and 2^14 slices");
    return VECTORS_OK;
}

static vectors_status read_volume(const reader *r)
{
    const char *rest;
    int32_t *d = r->b->scene.input.dims_vox;
    vectors_status status = next_line(r, "volume", &rest);
    int taken = 0;
    if (status != VECTORS_OK)
        return status;
    if (sscanf(rest, "%5" SCNd32 "x%5" SCNd32 "x%5" SCNd32 "%n", &d[0], &d[1], &d[2], &taken) != 3 || rest[taken])
        return refuse(r, "the volume must be WxHxD voxels");
    for (int c = 0; c < 3; c++)
        if (d[c] < 1 || d[c] > VODR_MAX_DIM_VOX)
            return refuse(r, "a side of the volume must be 1 to 32768 voxels");
    r->b->scene.input.voxel_bytes = density_bytes(&r->b->machine);
    return VECTORS_OK;
}

static vectors_status read_voxels(const reader *r)
{
    const char *rest;
    vodr_volume *v = &r->b->scene.input;
    const int32_t *d = v->dims_vox;
    vectors_status status = next_line(r, "voxels", &rest);
    size_t bytes = (size_t)v->voxel_bytes, voxels = (size_t)d[0] * (size_t)d[1] * (size_t)d[2];
    if (status != VECTORS_OK)
        return status;
    if (voxels > MOST_VOXELS || strlen(rest) != 2 * bytes * voxels)
        return refuse(r, "there must be as many digits of voxels as the volume has, 2^18 voxels at most");
    v->voxels = r->b->scene.voxels = calloc(voxels, bytes);
    if (!v->voxels)
        return VECTORS_ENVIRONMENT;
    for (size_t i = 0; i < voxels; i++, rest += 2 * bytes) {
        uint8_t *voxel = (uint8_t *)r->b->scene.voxels + i * bytes;
        if (column_known(rest, 2 * bytes) != COLUMN_DIGITS ||
            !column_get(rest, 2 * bytes, r->b->machine.density_bits > 8 ? 16 : 8, voxel, bytes) ||
            word_load(voxel, (int32_t)bytes) >> r->b->machine.density_bits)
            return refuse(r, "a voxel is no number of density_bits");
    }
    return VECTORS_OK;
}

/* One word of digits; the text behind it and the blank after it. */
static bool next_word(const char **text, int32_t width_bits, uint8_t word[RTL_TABLE_BYTES])
{
    size_t length = strcspn(*text, " ");
    bool good =
        column_known(*text, length) == COLUMN_DIGITS && column_get(*text, length, width_bits, word, RTL_TABLE_BYTES);
    *text += length;
    *text += **text == ' ';
    return good && length;
}

static vectors_status read_registers(const reader *r)
{
    const char *rest;
    vectors_status status = next_line(r, "registers", &rest);
    rtl_registers *registers = rtl_registers_of(&r->b->setup);
    if (!registers)
        return VECTORS_ENVIRONMENT;
    for (const module_register *m = rtl_module_of(r->choice->block)->registers; status == VECTORS_OK && m->name; m++) {
        uint64_t value = 0, must = 0;
        uint8_t word[RTL_TABLE_BYTES];
        bool good = next_word(&rest, m->width_bits, word);
        value = word_load(word, 8);
        rtl_register(registers, m->name, &must);
        must &= m->width_bits < 64 ? ((uint64_t)1 << m->width_bits) - 1 : UINT64_MAX;
        if (good && value == must)
            continue;
        vodr_fail(r->error, VODR_INVALID,
                  "register %s must be %0*" PRIx64 ", which follows from machine, view and volume", m->name,
                  (int)((m->width_bits + 3) / 4), must);
        status = VECTORS_INVALID;
    }
    free(registers);
    if (status == VECTORS_OK && *rest)
        return refuse(r, "there are more registers than the block has");
    return status;
}

static vectors_status read_table(const reader *r)
{
    const char *rest;
    vodr_block block = r->choice->block;
    int64_t entries = rtl_table_entries(block, &r->b->setup), count = -1;
    vectors_status status = next_line(r, "table", &rest);
    int taken = 0;
    if (status != VECTORS_OK)
        return status;
    if (sscanf(rest, "%9" SCNd64 "%n", &count, &taken) != 1 || count != entries) {
        vodr_fail(r->error, VODR_INVALID, "the table must have %" PRId64 " entries", entries);
        return VECTORS_INVALID;
    }
    rest += taken;
    rest += *rest == ' ';
    for (int64_t i = 0; i < entries; i++) {
        uint8_t word[RTL_TABLE_BYTES];
        if (next_word(&rest, rtl_table_bits(block, &r->b->machine), word) && set_table_word(r->b, block, i, word))
            continue;
        vodr_fail(r->error, VODR_INVALID, "entry %" PRId64 " of the table is missing, or is no such entry", i);
        return VECTORS_INVALID;
    }
    return *rest ? refuse(r, "the table has more entries than it says") : VECTORS_OK;
}

/* What the block is made from; the table's place is made, and what is in it comes later. */
static vectors_status set_up(const reader *r)
{
    bench *b = r->b;
    size_t count = (size_t)1 << b->machine.density_bits;
    int64_t bricks = 1;
    int32_t edge = volume_divider_edge(&b->machine, &b->scene.view);
    for (int c = 0; c < 3; c++)
        bricks *= edge ? ceil_div32(b->scene.input.dims_vox[c], edge) : 1;
    if (bricks > MOST_BRICKS)
        return refuse(r, "vectors have volumes of at most 2^26 bricks");
    b->scene.entries = calloc(count, sizeof *b->scene.entries);
    b->scene.table = (vodr_table){.entries = b->scene.entries, .count = count};
    if (!b->scene.entries)
        return VECTORS_ENVIRONMENT;
    vodr_status status = bench_set_up(b, r->error);
    return status == VODR_OK ? VECTORS_OK : status == VODR_INVALID ? VECTORS_INVALID : VECTORS_ENVIRONMENT;
}

vectors_status case_text_get(const char *first, case_text_source *next, void *context, const vectors_choice *choice,
                             bench *b, vodr_error *error)
{
    const reader r = {next, context, choice, b, error};
    *b = (bench){.random = {0}};
    if (strncmp(first, "case ", 5) != 0)
        return refuse(&r, "a line 'case ...', or the last one, 'end NUMBER', must stand here");
    vectors_status status = read_machine(&r);
    if (status == VECTORS_OK)
        status = read_view(&r);
    if (status == VECTORS_OK)
        status = read_volume(&r);
    if (status == VECTORS_OK && choice->block == VODR_BLOCK_FRAME_BUFFER)
        status = read_voxels(&r);
    if (status == VECTORS_OK)
        status = set_up(&r);
    if (status == VECTORS_OK)
        status = read_registers(&r);
    if (status == VECTORS_OK && rtl_module_of(choice->block)->table)
        status = read_table(&r);
    if (status == VECTORS_OK && bench_start(b, choice->block, error) != VODR_OK)
        status = VECTORS_ENVIRONMENT;
    return status;
}
