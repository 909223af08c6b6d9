/* volume_voxels.c - reads the voxels of a volume file: maps them where they lie as in memory, else reads plain bytes,
 * gzip or text run by run, so that a crop never needs the whole volume. */
#include "text.h"
#include "volume_file.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

/* Deflate cannot shrink data more than 1032 times. */
#define MAX_GZIP_RATIO 1100

/* Numbers converted at a time. */
#define PIECE_VOX 4096

typedef struct source {
    const volume_file *file;
    gzFile gzip;         /* VOLUME_GZIP only */
    size_t stored_bytes; /* of a voxel in the file (not VOLUME_TEXT) */
    size_t voxel_bytes;  /* of a voxel in memory */
    bool swap;
} source;

static host_status fail_short(const volume_file *f, host_error *error)
{
    return host_fail(error, HOST_BAD_INPUT,
                     "%s: ends early or is damaged, must hold %" PRId64 "x%" PRId64 "x%" PRId64 " voxels of %s",
                     f->data_path, f->dims_vox[0], f->dims_vox[1], f->dims_vox[2],
                     f->float64 ? "float64" : volume_type_name(f->type));
}

static host_status fail_long(const volume_file *f, host_error *error)
{
    return host_fail(error, HOST_BAD_INPUT,
                     "%s: holds more than the %" PRId64 "x%" PRId64 "x%" PRId64 " voxels of %s that its header names",
                     f->data_path, f->dims_vox[0], f->dims_vox[1], f->dims_vox[2],
                     f->float64 ? "float64" : volume_type_name(f->type));
}

/* ---- numbers ---- */

static void swap_bytes(unsigned char *data, size_t count, size_t bytes)
{
    for (size_t i = 0; i < count; i++, data += bytes)
        for (size_t j = 0; j < bytes / 2; j++) {
            unsigned char byte = data[j];
            data[j] = data[bytes - 1 - j];
            data[bytes - 1 - j] = byte;
        }
}

/* Stores a number read from text as voxel i; false if the type cannot hold it. */
static bool store_number(void *to, size_t i, volume_type type, double value)
{
    static const struct {
        double lo, hi;
    } ranges[] = {
        [VOLUME_UINT8] = {0, UINT8_MAX},          [VOLUME_INT8] = {INT8_MIN, INT8_MAX},
        [VOLUME_UINT16] = {0, UINT16_MAX},        [VOLUME_INT16] = {INT16_MIN, INT16_MAX},
        [VOLUME_UINT32] = {0, UINT32_MAX},        [VOLUME_INT32] = {INT32_MIN, INT32_MAX},
        [VOLUME_FLOAT32] = {-INFINITY, INFINITY},
    };
    if (type == VOLUME_FLOAT32) {
        ((float *)to)[i] = (float)value;
        return true;
    }
    if (!(value >= ranges[type].lo && value <= ranges[type].hi) || value != floor(value))
        return false;
    int64_t number = (int64_t)value;
    switch (volume_type_bytes(type)) {
    case 1: ((uint8_t *)to)[i] = (uint8_t)number; break;
    case 2: ((uint16_t *)to)[i] = (uint16_t)number; break;
    default: ((uint32_t *)to)[i] = (uint32_t)number;
    }
    return true;
}

static host_status read_text(const volume_file *f, void *to, size_t count, host_error *error)
{
    for (size_t i = 0; i < count; i++) {
        char word[64], *end;
        (void)!fscanf(f->data, "%*[ \t\r\n,]");
        if (fscanf(f->data, "%63[^ \t\r\n,]", word) != 1)
            return fail_short(f, error);
        double value = strtod(word, &end);
        if (*end || !store_number(to, i, f->type, value)) {
            text_make_printable(word);
            return host_fail(error, HOST_BAD_INPUT, "%s: '%.40s' among the voxels is no %s", f->data_path, word,
                             volume_type_name(f->type));
        }
    }
    return HOST_OK;
}

/* ---- bytes ---- */

static host_status read_bytes(const source *s, void *to, size_t bytes, host_error *error)
{
    unsigned char *next = to;
    while (bytes) {
        size_t piece = bytes < (1u << 30) ? bytes : 1u << 30;
        size_t got = 0;
        if (s->gzip) {
            int n = gzread(s->gzip, next, (unsigned)piece);
            got = n > 0 ? (size_t)n : 0;
        } else {
            got = fread(next, 1, piece, s->file->data);
        }
        if (got == 0)
            return fail_short(s->file, error);
        next += got;
        bytes -= got;
    }
    return HOST_OK;
}

static host_status read_float64(const source *s, float *to, size_t count, host_error *error)
{
    double piece[PIECE_VOX];
    host_status status = HOST_OK;
    while (count && status == HOST_OK) {
        size_t n = count < PIECE_VOX ? count : PIECE_VOX;
        status = read_bytes(s, piece, n * sizeof *piece, error);
        if (status == HOST_OK && s->swap)
            swap_bytes((unsigned char *)piece, n, sizeof *piece);
        for (size_t i = 0; status == HOST_OK && i < n; i++)
            *to++ = (float)piece[i];
        count -= n;
    }
    return status;
}

/* The next `count` voxels, as they are in memory. */
static host_status read_run(const source *s, void *to, size_t count, host_error *error)
{
    if (s->file->encoding == VOLUME_TEXT)
        return read_text(s->file, to, count, error);
    if (s->file->float64)
        return read_float64(s, to, count, error);
    host_status status = read_bytes(s, to, count * s->voxel_bytes, error);
    if (status == HOST_OK && s->swap)
        swap_bytes(to, count, s->voxel_bytes);
    return status;
}

static host_status skip_run(const source *s, size_t count, host_error *error)
{
    uint32_t piece[PIECE_VOX];
    host_status status = HOST_OK;
    if (s->file->encoding == VOLUME_PLAIN)
        return fseeko(s->file->data, (off_t)(count * s->stored_bytes), SEEK_CUR) ? fail_short(s->file, error) : HOST_OK;
    if (s->gzip) {
        /* gzseek() puts the work off and then does not mind the end of the data, so the last byte is read. */
        if (gzseek(s->gzip, (z_off_t)(count * s->stored_bytes - 1), SEEK_CUR) < 0)
            return fail_short(s->file, error);
        return read_bytes(s, piece, 1, error);
    }
    for (size_t n; count && status == HOST_OK; count -= n) {
        n = count < PIECE_VOX ? count : PIECE_VOX;
        status = read_text(s->file, piece, n, error);
    }
    return status;
}

/* Every voxel was read or skipped: the checksum must be right and, for exact files, nothing may follow. */
static host_status check_end(const source *s, host_error *error)
{
    char more[2] = "";
    bool found = false;
    if (s->gzip) {
        int code = Z_OK, n = gzread(s->gzip, more, 1);
        gzerror(s->gzip, &code);
        if (n < 0 || code != Z_OK)
            return fail_short(s->file, error);
        found = n > 0;
    } else if (s->file->encoding == VOLUME_TEXT) {
        (void)!fscanf(s->file->data, "%*[ \t\r\n,]");
        found = fscanf(s->file->data, "%1s", more) == 1;
    }
    return found && s->file->exact ? fail_long(s->file, error) : HOST_OK;
}

/* ---- the box ---- */

/* Reads the box run by run, a run being what lies together both in the file and in the box. */
static host_status read_box(const source *s, const int32_t lo[3], const int32_t hi[3], unsigned char *to,
                            host_error *error)
{
    const int64_t *dims = s->file->dims_vox;
    size_t row = (size_t)dims[0], slice = row * (size_t)dims[1], position = 0;
    size_t run = (size_t)(hi[0] - lo[0]);
    bool rows_joined = run == row;
    int32_t last_y = rows_joined ? lo[1] + 1 : hi[1];
    if (rows_joined)
        run *= (size_t)(hi[1] - lo[1]);
    host_status status = HOST_OK;
    for (int32_t z = lo[2]; z < hi[2]; z++)
        for (int32_t y = lo[1]; y < last_y; y++) {
            size_t begin = (size_t)z * slice + (size_t)y * row + (size_t)lo[0];
            if (begin > position)
                status = skip_run(s, begin - position, error);
            if (status == HOST_OK)
                status = read_run(s, to, run, error);
            if (status != HOST_OK)
                return status;
            to += run * s->voxel_bytes;
            position = begin + run;
        }
    size_t all = slice * (size_t)dims[2];
    if (all > position)
        status = skip_run(s, all - position, error);
    return status == HOST_OK ? check_end(s, error) : status;
}

static host_status open_gzip(source *s, host_error *error)
{
    const volume_file *f = s->file;
    int copy = dup(fileno(f->data));
    if (copy < 0 || lseek(copy, ftello(f->data), SEEK_SET) < 0 || !(s->gzip = gzdopen(copy, "rb"))) {
        if (copy >= 0)
            close(copy);
        return host_fail(error, HOST_ENVIRONMENT, "%s: %s", f->data_path, strerror(errno));
    }
    gzbuffer(s->gzip, 1u << 18);
    if (gzdirect(s->gzip))
        return host_fail(error, HOST_BAD_INPUT, "%s: its voxels are not gzip data, as its header says", f->data_path);
    if (f->skip_bytes && gzseek(s->gzip, (z_off_t)f->skip_bytes, SEEK_CUR) < 0)
        return fail_short(f, error);
    return HOST_OK;
}

/* Whether the file can hold what its header says: before any memory is taken. */
static host_status check_size(const source *s, size_t count, host_error *error)
{
    const volume_file *f = s->file;
    struct stat status;
    off_t begin = ftello(f->data);
    if (fstat(fileno(f->data), &status) || begin < 0)
        return host_fail(error, HOST_BAD_INPUT, "%s: %s", f->data_path, strerror(errno));
    if (!S_ISREG(status.st_mode))
        return host_fail(error, HOST_BAD_INPUT, "%s: is not a regular file", f->data_path);
    uint64_t have = status.st_size > begin ? (uint64_t)(status.st_size - begin) : 0;
    uint64_t need = (uint64_t)count * s->stored_bytes;
    if (f->encoding == VOLUME_PLAIN && (have < need || (f->exact && have > need)))
        return host_fail(error, HOST_BAD_INPUT,
                         "%s: holds %" PRIu64 " bytes of voxels, but %" PRId64 "x%" PRId64 "x%" PRId64
                         " voxels of %s are %" PRIu64,
                         f->data_path, have, f->dims_vox[0], f->dims_vox[1], f->dims_vox[2],
                         f->float64 ? "float64" : volume_type_name(f->type), need);
    if ((f->encoding == VOLUME_GZIP && (need > have * MAX_GZIP_RATIO || f->skip_bytes > have * MAX_GZIP_RATIO)) ||
        (f->encoding == VOLUME_TEXT && have < 2 * (uint64_t)count - 1))
        return fail_short(f, error);
    return HOST_OK;
}

/* Maps the whole of the voxels; false, with nothing done, where the file is not as memory must be. */
static bool map_voxels(const source *s, volume *v)
{
    off_t begin = ftello(s->file->data);
    off_t page = sysconf(_SC_PAGESIZE), lead = begin % page;
    if (s->file->encoding != VOLUME_PLAIN || s->file->float64 || begin % (off_t)s->voxel_bytes)
        return false;
    size_t bytes = v->bytes + (size_t)lead;
    void *start = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE, fileno(s->file->data), begin - lead);
    if (start == MAP_FAILED)
        return false;
    v->mapping = start;
    v->mapping_bytes = bytes;
    v->voxels = (unsigned char *)start + lead;
    if (s->swap)
        swap_bytes(v->voxels, v->bytes / s->voxel_bytes, s->voxel_bytes);
    return true;
}

static host_status allocate(volume *v, host_error *error)
{
    uint64_t memory = (uint64_t)sysconf(_SC_PHYS_PAGES) * (uint64_t)sysconf(_SC_PAGESIZE);
    if (v->bytes > memory)
        return host_fail(error, HOST_BAD_INPUT, "%s: its voxels take %zu bytes, more than the %" PRIu64 " of memory",
                         v->path, v->bytes, memory);
    v->voxels = malloc(v->bytes);
    return v->voxels ? HOST_OK : host_fail(error, HOST_ENVIRONMENT, "%s: no memory for %zu bytes", v->path, v->bytes);
}

host_status volume_read_voxels(const volume_file *f, const int32_t lo[3], const int32_t hi[3], volume *v,
                               host_error *error)
{
    source s = {.file = f, .voxel_bytes = volume_type_bytes(f->type)};
    s.stored_bytes = f->float64 ? sizeof(double) : s.voxel_bytes;
    s.swap = s.stored_bytes > 1 && f->big_endian != volume_native_big_endian();
    size_t all = (size_t)f->dims_vox[0] * (size_t)f->dims_vox[1] * (size_t)f->dims_vox[2];
    size_t count = (size_t)(hi[0] - lo[0]) * (size_t)(hi[1] - lo[1]) * (size_t)(hi[2] - lo[2]);
    v->bytes = count * s.voxel_bytes;
    host_status status = check_size(&s, all, error);
    if (status != HOST_OK || (count == all && map_voxels(&s, v)))
        return status;
    if (f->encoding == VOLUME_GZIP)
        status = open_gzip(&s, error);
    if (status == HOST_OK)
        status = allocate(v, error);
    if (status == HOST_OK)
        status = read_box(&s, lo, hi, v->voxels, error);
    if (s.gzip)
        gzclose(s.gzip);
    return status;
}

void volume_free_voxels(volume *v)
{
    if (v->mapping)
        munmap(v->mapping, v->mapping_bytes);
    else
        free(v->voxels);
    v->mapping = NULL;
    v->voxels = NULL;
}
