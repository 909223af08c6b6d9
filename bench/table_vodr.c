/* table_vodr.c - the paper's Table 1 beside this machine's counters, and what the paper leaves out.
 *
 *   table_vodr [table1|views]    both tables, or one; exit 1 when a counter is not what it must be
 *
 * Must be: at view 0,0 every voxel's centre is sampled once, 256^3 fragments; a line of 16 pixels misses once a slice
 * without division (4096*256), once a layer of bricks with it (4096*8, half of that for 32 pixels). In tile order a
 * line misses once a frame, at every view: the misses are the touched lines, counted here from the positions alone. */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "jobs.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

static const char program[] = "table_vodr";

enum { VIEWS = 4 };

static const double view_angles_deg[VIEWS][2] = {{0, 0}, {11, 17}, {30, 30}, {35, 45}};

typedef struct paper_row {
    job_machine ours;
    const char *paper;                  /* its hits, misses, MB and write-backs, as cells */
    uint64_t misses, bytes, writebacks; /* what ours must be */
} paper_row;

static const paper_row paper_rows[] = {
    {{.label = "general", .machine = "paper-general"},
     "-          | 15,728,643 | 1,049,372 | 64.3 MB    | -",
     1048576,
     67108864,
     1048576},
    {{.label = "16-pixel block", .machine = "paper-16"},
     "-          | 16,744,438 | 32,792    | 2.2 MB     | -",
     32768,
     2097152,
     32768},
    {{.label = "32-pixel block", .machine = "paper-32"},
     "-          | 16,760,832 | 16,590    | 2.1 MB     | -",
     16384,
     2097152,
     16384},
};

static const job_machine view_rows[] = {
    {"undivided, 16x1", "paper-general", {{0}}},
    {"undivided, 4x4", "paper-general", {{"line_px", "4x4"}}},
    {"layer, 16x1 (paper-16)", "paper-16", {{0}}},
    {"layer, 32x1 (paper-32)", "paper-32", {{0}}},
    {"layer, 16x1, linear frame buffer", "paper-16", {{"fb_layout", "linear"}}},
    {"layer, 16x1, linear, xor index", "paper-16", {{"fb_layout", "linear"}, {"index", "xor"}}},
    {"layer, 4x4", "paper-16", {{"line_px", "4x4"}}},
    {"layer, 8x8", "paper-16", {{"line_px", "8x8"}}},
    {"column, 16x1", "paper-16", {{"traversal", "column"}}},
    {"column, 4x4", "paper-16", {{"traversal", "column"}, {"line_px", "4x4"}}},
    {"tile, 16x1", "paper-16", {{"traversal", "tile"}}},
    {"tile, 4x4", "paper-16", {{"traversal", "tile"}, {"line_px", "4x4"}}},
};

static bool sample_inside(const vodr_view *v, int32_t x, int32_t y, int32_t k)
{
    bool inside = true;
    for (int c = 0; c < 3; c++) {
        int64_t position = v->base[c] + k * v->step_s[c] + x * v->step_u[c] + y * v->step_v[c];
        inside = inside && position >= 0 && position < (int64_t)CUBE_VOX << VODR_POSITION_BITS;
    }
    return inside;
}

/* Lines of w x h pixels that have a pixel with a fragment: what the best order of fragments must still read. */
static uint64_t touched_lines(const vodr_view *v, int32_t w, int32_t h)
{
    static const int32_t across = CUBE_VOX;
    bool touched[CUBE_VOX * CUBE_VOX] = {false};
    uint64_t count = 0;
    for (int32_t y = 0; y < v->height_px; y++)
        for (int32_t x = 0; x < v->width_px; x++) {
            bool *line = &touched[y / h * across + x / w];
            for (int32_t k = 0; k < v->slices && !*line; k++)
                *line = sample_inside(v, x, y, k);
        }
    for (size_t i = 0; i < COUNT(touched); i++)
        count += touched[i];
    return count;
}

static bool must_be(const char *label, const char *what, uint64_t is, uint64_t must)
{
    if (is != must)
        fprintf(stderr, "%s: %s: %s is %" PRIu64 ", must be %" PRIu64 "\n", program, label, what, is, must);
    return is == must;
}

static bool check_paper_row(const paper_row *r, const vodr_counters *c)
{
    const uint64_t fragments = (uint64_t)CUBE_VOX * CUBE_VOX * CUBE_VOX;
    bool good = must_be(r->ours.label, "fragments", c->fragments, fragments);
    good &= must_be(r->ours.label, "hits", c->hits, fragments - r->misses);
    good &= must_be(r->ours.label, "misses", c->misses, r->misses);
    good &= must_be(r->ours.label, "fb_read_bytes", c->fb_read_bytes, r->bytes);
    good &= must_be(r->ours.label, "fb_write_bytes", c->fb_write_bytes, r->bytes);
    return good & must_be(r->ours.label, "writebacks", c->writebacks, r->writebacks);
}

static bool print_table1(const cube *c, const vodr_view views[VIEWS])
{
    job jobs[COUNT(paper_rows)] = {{0}};
    for (size_t i = 0; i < COUNT(jobs); i++)
        jobs[i] = (job){.row = &paper_rows[i].ours, .view = &views[0]};
    if (!jobs_draw(program, c, jobs, COUNT(jobs), false))
        return false;
    bool good = true;
    puts("|                |       | fragments  | hits       | misses    | bytes read | write-backs |\n"
         "| -------------- | ----- | ---------- | ---------- | --------- | ---------- | ----------- |");
    for (size_t i = 0; i < COUNT(jobs); i++) {
        const paper_row *r = &paper_rows[i];
        const vodr_counters *n = &jobs[i].counters;
        char text[5][32];
        printf("| %-14s | paper | %s           |\n", r->ours.label, r->paper);
        printf("| %-14s | vodr  | %-10s | %-10s | %-9s | %-10s | %-11s |\n", "", job_commas(n->fragments, text[0]),
               job_commas(n->hits, text[1]), job_commas(n->misses, text[2]), job_commas(n->fb_read_bytes, text[3]),
               job_commas(n->writebacks, text[4]));
        good &= check_paper_row(r, n);
    }
    return good;
}

static void print_cell(uint64_t misses, uint64_t accesses)
{
    char text[32];
    printf(" %9s (%5.2f %%) |", job_commas(misses, text), 100 - 100.0 * (double)misses / (double)accesses);
}

static bool print_view_row(const job *jobs)
{
    bool good = true;
    printf("| %-32s |", jobs[0].row->label);
    for (int v = 0; v < VIEWS; v++) {
        const vodr_counters *c = &jobs[v].counters;
        const vodr_machine *m = &jobs[v].machine;
        print_cell(c->misses, c->hits + c->misses);
        if (m->traversal == VODR_TRAVERSAL_TILE)
            good &= must_be(jobs[v].row->label, "misses", c->misses,
                            touched_lines(jobs[v].view, m->line_px.width, m->line_px.height));
    }
    puts("");
    return good;
}

static void print_touched_row(const vodr_view views[VIEWS], const char *label, int32_t width_px, int32_t height_px,
                              const uint64_t accesses[VIEWS])
{
    printf("| %-32s |", label);
    for (int v = 0; v < VIEWS; v++)
        print_cell(touched_lines(&views[v], width_px, height_px), accesses[v]);
    puts("");
}

static bool print_views(const cube *c, const vodr_view views[VIEWS])
{
    job jobs[COUNT(view_rows) * VIEWS] = {{0}};
    for (size_t i = 0; i < COUNT(jobs); i++)
        jobs[i] = (job){.row = &view_rows[i / VIEWS], .view = &views[i % VIEWS]};
    if (!jobs_draw(program, c, jobs, COUNT(jobs), false))
        return false;
    bool good = true;
    uint64_t accesses[VIEWS];
    printf("| misses (hit rate)                |");
    for (int v = 0; v < VIEWS; v++) {
        char label[32];
        snprintf(label, sizeof label, "view %.0f,%.0f", view_angles_deg[v][0], view_angles_deg[v][1]);
        printf(" %-19s |", label);
        accesses[v] = jobs[v].counters.hits + jobs[v].counters.misses;
    }
    printf("\n| -------------------------------- |");
    for (int v = 0; v < VIEWS; v++)
        printf(" ------------------- |");
    puts("");
    for (size_t i = 0; i < COUNT(view_rows); i++)
        good &= print_view_row(jobs + i * VIEWS);
    print_touched_row(views, "the least: touched 16x1 lines", 16, 1, accesses);
    print_touched_row(views, "the least: touched 4x4 lines", 4, 4, accesses);
    return good;
}

static bool make_views(vodr_view views[VIEWS], host_error *error)
{
    for (int v = 0; v < VIEWS; v++)
        if (cube_view(view_angles_deg[v][0], view_angles_deg[v][1], &views[v], error) != HOST_OK)
            return false;
    return true;
}

int main(int argc, char **argv)
{
    const char *which = argc == 2 ? argv[1] : "";
    bool table1 = argc == 1 || strcmp(which, "table1") == 0, others = argc == 1 || strcmp(which, "views") == 0;
    if (!table1 && !others) {
        fputs("usage: table_vodr [table1|views]\n", stderr);
        return 2;
    }
    cube c;
    vodr_view views[VIEWS];
    host_error error;
    if (cube_make(&c, &error) != HOST_OK || !make_views(views, &error)) {
        fprintf(stderr, "table_vodr: %s\n", error.text);
        return 3;
    }
    bool good = true;
    if (argc == 1)
        puts("Table 1: 256^3 voxels, 256x256 pixels, 256 slices, view 0,0, cache 4 KB, 4 ways\n");
    if (table1)
        good &= print_table1(&c, views);
    if (argc == 1)
        puts("\nWhat the paper leaves out: misses and hit rate of the same machine at other views, with other frame\n"
             "buffers, lines and orders of bricks\n");
    if (others)
        good &= print_views(&c, views);
    cube_free(&c);
    return good ? 0 : 1;
}
