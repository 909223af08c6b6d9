/* volume_nrrd.c - reads the header of an NRRD file, attached or detached, with teem. */
#include "orientation.h"
#include "text.h"
#include "volume_file.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <teem/nrrd.h>

/* teem writes the line at fault into a sentence of fixed size, so lines that it may refuse must be short; a data file's
 * path counts with its directory. */
enum { MAX_FIELD_BYTES = 512, MAX_LINE_BYTES = 65536 };

bool volume_is_nrrd(const char *path)
{
    char magic[8] = "";
    FILE *file = fopen(path, "rb");
    if (!file)
        return false;
    size_t n = fread(magic, 1, sizeof magic, file);
    fclose(file);
    return n == sizeof magic && memcmp(magic, "NRRD000", 7) == 0;
}

/* The value of a header line that names the data file, NULL for any other line. */
static const char *data_file_value(const char *line)
{
    static const char *const names[] = {"data file:", "datafile:"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        size_t length = strlen(names[i]);
        if (strncasecmp(line, names[i], length) == 0)
            return line + length + strspn(line + length, " \t");
    }
    return NULL;
}

/* Comments, content and key/value pairs may say anything. */
static bool is_free_text(const char *line)
{
    const char *pair = strstr(line, ":="), *field = strstr(line, ": ");
    return line[0] == '#' || strncasecmp(line, "content: ", 9) == 0 || (pair && (!field || pair < field));
}

/* teem hands a numbered data file's name to sprintf as it stands and opens "-" as standard input, so neither may reach
 * it. Voxels in several files are not supported anyway. */
static host_status check_data_file(const char *path, const char *value, host_error *error)
{
    if (strchr(value, '%') || strncasecmp(value, "LIST", 4) == 0 || strncasecmp(value, "SKIPLIST", 8) == 0)
        return host_fail(error, HOST_BAD_INPUT, "%s: field data file names several files, must be one", path);
    if (value[0] == '-' && strspn(value + 1, " \t") == strlen(value + 1))
        return host_fail(error, HOST_BAD_INPUT, "%s: field data file is '-', must be a file's name", path);
    if (strlen(path) + strlen(value) > MAX_FIELD_BYTES)
        return host_fail(error, HOST_BAD_INPUT, "%s: field data file makes a path of more than %d bytes", path,
                         MAX_FIELD_BYTES);
    return HOST_OK;
}

/* teem would read a negative size as a huge one or as 0. */
static host_status check_sizes(const char *path, const char *value, host_error *error)
{
    char *end;
    for (long long size; (size = strtoll(value, &end, 10)), end != value; value = end)
        if (size < 1 || size > VODR_MAX_DIM_VOX)
            return host_fail(error, HOST_BAD_INPUT, "%s: field sizes holds %lld, must be 1 to %d voxels", path, size,
                             VODR_MAX_DIM_VOX);
    return HOST_OK;
}

static host_status check_line(const char *path, const char *line, host_error *error)
{
    const char *value = data_file_value(line);
    size_t length = strlen(line), most = is_free_text(line) ? MAX_LINE_BYTES - 1 : MAX_FIELD_BYTES;
    if (length > most)
        return host_fail(error, HOST_BAD_INPUT, "%s: a line of the NRRD header has more than %zu bytes", path, most);
    if (strncasecmp(line, "sizes:", 6) == 0)
        return check_sizes(path, line + 6, error);
    return value ? check_data_file(path, value, error) : HOST_OK;
}

/* Reads a line without its end, which is '\n', '\r' or both, or its first MAX_LINE_BYTES bytes. Returns the byte that
 * ended it, EOF at the end of the file. */
static int read_line(FILE *file, char line[MAX_LINE_BYTES + 1], size_t *length)
{
    int c = getc(file);
    for (*length = 0; c != EOF && c != '\n' && c != '\r' && *length < MAX_LINE_BYTES; c = getc(file))
        line[(*length)++] = (char)c;
    line[*length] = '\0';
    if (c == '\r' && (c = getc(file)) != '\n') {
        ungetc(c, file);
        c = '\r';
    }
    return c;
}

/* Checks the lines of the header, up to the empty one, before teem parses them. */
static host_status check_lines(const char *path, FILE *file, host_error *error)
{
    char *line = malloc(MAX_LINE_BYTES + 1);
    host_status status = line ? HOST_OK : host_fail(error, HOST_ENVIRONMENT, "%s: out of memory", path);
    int end = 0;
    while (status == HOST_OK && end != EOF) {
        size_t length;
        end = read_line(file, line, &length);
        if (!length && end == '\n')
            break;
        /* What is behind it would not be looked at here, and teem goes on to the empty line. */
        status = strlen(line) == length
                     ? check_line(path, line, error)
                     : host_fail(error, HOST_BAD_INPUT, "%s: a line of the NRRD header holds a byte of value 0", path);
    }
    free(line);
    rewind(file);
    return status;
}

/* Of teem's lines, one a caller, the last is the cause: keeps it without the function's name. */
static host_status fail_with_biff(const char *path, host_error *error)
{
    char *text = biffGetDone(NRRD);
    const char *cause = "cannot be read";
    if (text) {
        size_t length = strlen(text);
        while (length && isspace((unsigned char)text[length - 1]))
            text[--length] = '\0';
        const char *line = strrchr(text, '\n');
        cause = line ? line + 1 : text;
        const char *message = strstr(cause, ": ");
        if (cause[0] == '[' && message)
            cause = message + 2;
        text_make_printable(text);
    }
    host_fail(error, HOST_BAD_INPUT, "%s: is no valid NRRD file: %.400s", path, cause);
    free(text);
    return HOST_BAD_INPUT;
}

static host_status read_type(const char *path, const Nrrd *nrrd, volume_file *f, host_error *error)
{
    switch (nrrd->type) {
    case nrrdTypeUChar: f->type = VOLUME_UINT8; break;
    case nrrdTypeChar: f->type = VOLUME_INT8; break;
    case nrrdTypeUShort: f->type = VOLUME_UINT16; break;
    case nrrdTypeShort: f->type = VOLUME_INT16; break;
    case nrrdTypeUInt: f->type = VOLUME_UINT32; break;
    case nrrdTypeInt: f->type = VOLUME_INT32; break;
    case nrrdTypeFloat: f->type = VOLUME_FLOAT32; break;
    case nrrdTypeDouble:
        f->type = VOLUME_FLOAT32;
        f->float64 = true;
        break;
    default:
        return host_fail(error, HOST_BAD_INPUT,
                         "%s: field type is %s, must be an integer of 8, 16 or 32 bits, float or double", path,
                         airEnumStr(nrrdType, nrrd->type));
    }
    return HOST_OK;
}

static host_status read_encoding(const char *path, const Nrrd *nrrd, const NrrdIoState *nio, volume_file *f,
                                 host_error *error)
{
    f->encoding = VOLUME_PLAIN;
    if (nio->encoding == nrrdEncodingGzip)
        f->encoding = VOLUME_GZIP;
    else if (nio->encoding == nrrdEncodingAscii)
        f->encoding = VOLUME_TEXT;
    else if (nio->encoding != nrrdEncodingRaw)
        return host_fail(error, HOST_BAD_INPUT, "%s: field encoding is %s, must be raw, gzip or ascii", path,
                         nio->encoding->name);
    if (f->encoding == VOLUME_GZIP && nio->byteSkip < 0)
        return host_fail(error, HOST_BAD_INPUT, "%s: field byte skip is %ld, must be at least 0 with gzip", path,
                         nio->byteSkip);
    if (f->encoding == VOLUME_GZIP)
        f->skip_bytes = (uint64_t)nio->byteSkip;
    f->big_endian = nrrdElementSize(nrrd) > 1 && nio->endian == airEndianBig;
    return HOST_OK;
}

/* Picks the three axes that count: axes of one sample beyond three are left out, the last first. */
static host_status pick_axes(const char *path, const Nrrd *nrrd, const NrrdAxisInfo *axes[3], host_error *error)
{
    unsigned extra = nrrd->dim > 3 ? nrrd->dim - 3 : 0, kept = 0;
    bool drop[NRRD_DIM_MAX] = {false};
    for (unsigned i = nrrd->dim; i-- > 0 && extra;)
        if (nrrd->axis[i].size == 1) {
            drop[i] = true;
            extra--;
        }
    if (nrrd->dim < 3 || extra)
        return host_fail(error, HOST_BAD_INPUT, "%s: field dimension is %u, must be 3 (axes of size 1 aside)", path,
                         nrrd->dim);
    for (unsigned i = 0; i < nrrd->dim; i++)
        if (!drop[i])
            axes[kept++] = &nrrd->axis[i];
    return HOST_OK;
}

/* A direction in the file's space, in the world's axes. Spaces that are not a patient's are the world, x right, y up.
 */
static void space_to_world(int space, const double d[3], double world[3])
{
    const double ras[3] = {space == nrrdSpaceRightAnteriorSuperior ? d[0] : -d[0],
                           space == nrrdSpaceLeftPosteriorSuperior ? -d[1] : d[1], d[2]};
    switch (space) {
    case nrrdSpaceRightAnteriorSuperior:
    case nrrdSpaceLeftAnteriorSuperior:
    case nrrdSpaceLeftPosteriorSuperior: orientation_of_patient(ras, world); break;
    default:
        world[0] = d[0];
        world[1] = d[1];
        world[2] = space == nrrdSpace3DLeftHanded ? -d[2] : d[2];
    }
}

static host_status read_geometry(const char *path, const Nrrd *nrrd, volume_file *f, host_error *error)
{
    const NrrdAxisInfo *axes[3] = {NULL};
    host_status status = pick_axes(path, nrrd, axes, error);
    if (status != HOST_OK)
        return status;
    f->oriented = nrrd->spaceDim == 3;
    for (int i = 0; i < 3; i++) {
        f->dims_vox[i] = axes[i]->size > INT64_MAX ? INT64_MAX : (int64_t)axes[i]->size;
        f->spacing[i] = isnan(axes[i]->spacing) ? 1 : axes[i]->spacing;
        f->oriented = f->oriented && !isnan(axes[i]->spaceDirection[0]);
    }
    for (int i = 0; i < 3 && f->oriented; i++) {
        const double *d = axes[i]->spaceDirection;
        f->spacing[i] = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        space_to_world(nrrd->space, d, f->direction[i]);
    }
    return HOST_OK;
}

static host_status read_data_path(const char *path, const NrrdIoState *nio, volume_file *f, host_error *error)
{
    f->exact = nio->dataFNArr->len == 0;
    if (!f->data)
        return host_fail(error, HOST_BAD_INPUT, "%s: field data file names no single file", path);
    const char *name = f->exact ? path : nio->dataFN[0];
    const char *directory = f->exact || name[0] == '/' || !nio->path ? "" : nio->path;
    size_t size = strlen(directory) + strlen(name) + 2;
    f->data_path = malloc(size);
    if (!f->data_path)
        return host_fail(error, HOST_ENVIRONMENT, "%s: out of memory", path);
    snprintf(f->data_path, size, "%s%s%s", directory, directory[0] ? "/" : "", name);
    return HOST_OK;
}

/* Reads the header from `file` with teem, which looks for a data file beside it. */
static host_status load(const char *path, FILE *file, Nrrd *nrrd, NrrdIoState *nio, host_error *error)
{
    const char *slash = strrchr(path, '/');
    nio->path = slash ? strndup(path, slash > path ? (size_t)(slash - path) : 1) : strdup(".");
    nio->skipData = 1;
    nio->keepNrrdDataFileOpen = 1;
    if (nrrdRead(nrrd, file, nio))
        return fail_with_biff(path, error);
    return HOST_OK;
}

host_status volume_nrrd_header(const char *path, volume_file *f, host_error *error)
{
    f->format = "nrrd";
    FILE *file = fopen(path, "rb");
    if (!file)
        return host_fail(error, HOST_BAD_INPUT, "%s: %s", path, strerror(errno));
    Nrrd *nrrd = nrrdNew();
    NrrdIoState *nio = nrrdIoStateNew();
    host_status status = check_lines(path, file, error);
    if (status == HOST_OK)
        status = load(path, file, nrrd, nio, error);
    if (status == HOST_OK) {
        f->data = nio->dataFile;
        status = read_data_path(path, nio, f, error);
    }
    if (status == HOST_OK)
        status = read_type(path, nrrd, f, error);
    if (status == HOST_OK)
        status = read_encoding(path, nrrd, nio, f, error);
    if (status == HOST_OK)
        status = read_geometry(path, nrrd, f, error);
    nrrdNuke(nrrd);
    nrrdIoStateNix(nio);
    if (file != f->data)
        fclose(file);
    return status;
}
