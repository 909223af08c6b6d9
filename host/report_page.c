/* report_page.c - a report as one HTML page that needs nothing but itself.
 *
 * The page's frame is written here; its script fills it from two blocks of JSON: "stats", which is what --stats writes,
 * and "report" (report_data.h). Text of files and command lines reaches the page escaped: in HTML by write_text(), in
 * JSON by write_json(), in the script as text nodes only. */
#include "report_page.h"

#include <openssl/evp.h>
#include <stdlib.h>
#include <string.h>

#include "image.h"
#include "stats.h"

static const char body[] =
    "</p>\n"
    "<p id='facts'></p>\n"
    "</header>\n"
    "<noscript><p>This page draws its figures with a script, which this browser does not run.</p></noscript>\n"
    "<section id='tiles' aria-label='Headline figures'></section>\n"
    "<section class='pair'>\n"
    "<figure><h2>The frame</h2><div class='stage' id='frame-stage'>";

static const char after_picture[] =
    "<div class='mark'></div></div><figcaption id='frame-note'></figcaption></figure>\n"
    "<figure><h2>Cache misses per screen tile</h2><div class='stage' id='heat-stage'>"
    "<canvas id='heat' role='img' aria-label='Heat map of cache misses'></canvas><div class='mark'></div></div>"
    "<figcaption><div class='legend'><span id='heat-low'></span><span class='ramp' id='heat-ramp'></span>"
    "<span id='heat-high'></span><select id='heat-scale' aria-label='Scale'><option value='linear'>linear "
    "scale</option>"
    "<option value='log'>logarithmic scale</option></select></div><span id='heat-note'></span></figcaption></figure>\n"
    "</section>\n"
    "<section id='order'><h2>The order in which bricks are visited</h2><div class='pair'>\n"
    "<figure><div class='stage'><canvas id='visits' role='img' aria-label='Bricks visited'></canvas></div>"
    "<figcaption><div class='legend'><span>first visit</span><span class='ramp' id='visit-ramp'></span>"
    "<span>last</span></div></figcaption></figure>\n"
    "<div><div id='player'><button type='button' id='play'>Play</button>"
    "<button type='button' id='back' aria-label='One step back'>&#8249;</button>"
    "<input type='range' id='slider' min='0' step='1' aria-label='Visit'>"
    "<button type='button' id='next' aria-label='One step on'>&#8250;</button></div>\n"
    "<dl id='visit'></dl><h3>Misses as the frame is drawn</h3><div id='curve'></div><p id='order-note'></p></div>\n"
    "</div></section>\n"
    "<section id='cycles'><h2>Cycles</h2><p id='cycles-note'></p><div class='pair'>"
    "<div id='blocks'><h3>The blocks, with their busy share</h3></div>"
    "<div id='stalls'><h3>What they wait for</h3></div></div></section>\n"
    "<section><h2>Frame-buffer traffic beside the paper's machines</h2><p id='traffic-note'></p>\n"
    "<div id='bars'></div><table id='runs'></table>\n"
    "<h3>For reference: the paper's Table 1</h3>\n"
    "<p>Another volume and view: 256<sup>3</sup> voxels along an axis, 256&#215;256 pixels, 256 slices, a 4-way cache "
    "of "
    "4 KB. The paper's own figures, as printed there.</p>\n"
    "<table><thead><tr><th>machine</th><th>hits</th><th>misses</th><th>from the frame buffer</th></tr></thead><tbody>\n"
    "<tr><td>general (paper-general)</td><td>15,728,643</td><td>1,049,372</td><td>64.3 MB</td></tr>\n"
    "<tr><td>16-pixel block (paper-16)</td><td>16,744,438</td><td>32,792</td><td>2.2 MB</td></tr>\n"
    "<tr><td>32-pixel block (paper-32)</td><td>16,760,832</td><td>16,590</td><td>2.1 MB</td></tr>\n"
    "</tbody></table></section>\n"
    "<section><h2>The machine's parameters</h2><p id='parameters-note'></p><table id='parameters'></table></section>\n"
    "<section><h2>Run it again</h2><pre id='command'></pre><p id='version'></p></section>\n"
    "</main>\n";

/* Text between tags or in an attribute. */
static void write_text(FILE *file, const char *text)
{
    for (; *text; text++)
        switch (*text) {
        case '&': fputs("&amp;", file); break;
        case '<': fputs("&lt;", file); break;
        case '>': fputs("&gt;", file); break;
        case '"': fputs("&quot;", file); break;
        case '\'': fputs("&#39;", file); break;
        default: putc(*text, file);
        }
}

/* JSON writes non-ASCII escaped, and a '<', which only a string can hold, must not end the script element. */
static int write_piece(const char *buffer, size_t size, void *file)
{
    for (size_t i = 0; i < size; i++)
        if (buffer[i] == '<')
            fputs("\\u003c", file);
        else
            putc(buffer[i], file);
    return ferror((FILE *)file) ? -1 : 0;
}

static host_status write_json(output *o, const char *id, json_t *root, size_t flags, host_error *error)
{
    if (!root)
        return host_fail(error, HOST_ENVIRONMENT, "no memory to write '%s'", o->path);
    fprintf(o->file, "<script type='application/json' id='%s'>\n", id);
    int failed = json_dump_callback(root, write_piece, o->file, flags | JSON_ENSURE_ASCII | JSON_REAL_PRECISION(17));
    json_decref(root);
    fputs("\n</script>\n", o->file);
    /* A failed write is told by output_close(). */
    return failed && !ferror(o->file) ? host_fail(error, HOST_ENVIRONMENT, "no memory to write '%s'", o->path)
                                      : HOST_OK;
}

static void write_base64(FILE *file, const unsigned char *bytes, size_t count)
{
    enum { CHUNK = 3 * 1024 };
    unsigned char text[CHUNK / 3 * 4 + 1];
    for (size_t i = 0; i < count; i += CHUNK) {
        size_t n = count - i < CHUNK ? count - i : CHUNK;
        fwrite(text, 1, (size_t)EVP_EncodeBlock(text, bytes + i, (int)n), file);
    }
}

static host_status write_picture(output *o, const report *r, host_error *error)
{
    char *bytes = NULL;
    size_t count = 0;
    output memory = {.path = o->path, .file = open_memstream(&bytes, &count)};
    if (!memory.file)
        return host_fail(error, HOST_ENVIRONMENT, "no memory for the picture in '%s'", o->path);
    host_status status = image_write_png(&memory, &r->result->frame, &r->options->style, error);
    if (fclose(memory.file) != 0 && status == HOST_OK)
        status = host_fail(error, HOST_ENVIRONMENT, "no memory for the picture in '%s'", o->path);
    if (status == HOST_OK) {
        fputs("<img id='frame' alt='The frame' src='data:image/png;base64,", o->file);
        write_base64(o->file, (const unsigned char *)bytes, count);
        fputs("'>", o->file);
    }
    free(bytes);
    return status;
}

static const char *file_name(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash && slash[1] ? slash + 1 : path;
}

static void write_head(FILE *file, const char *name)
{
    fputs("<!DOCTYPE html>\n<html lang='en'>\n<head>\n<meta charset='utf-8'>\n"
          "<meta name='viewport' content='width=device-width, initial-scale=1'>\n"
          "<meta http-equiv='Content-Security-Policy' content=\"default-src 'none'; img-src data:; "
          "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n<title>",
          file);
    write_text(file, name);
    fputs(" - vodr report</title>\n<style>\n", file);
    fputs(report_style, file);
    fputs("</style>\n</head>\n<body>\n<main>\n<header><h1>", file);
    write_text(file, name);
    fputs("</h1><p id='machine'>", file);
}

host_status report_page_write(output *o, const report *r, host_error *error)
{
    write_head(o->file, file_name(r->scene->volume.path));
    fputs(body, o->file);
    host_status status = write_picture(o, r, error);
    fputs(after_picture, o->file);
    if (status == HOST_OK)
        status = write_json(o, "stats", stats_json(r->scene, r->options, r->result), JSON_INDENT(2), error);
    if (status == HOST_OK)
        status = write_json(o, "report", report_json(r), JSON_COMPACT, error);
    fputs("<script>\n", o->file);
    fputs(report_script, o->file);
    fputs("</script>\n</body>\n</html>\n", o->file);
    return status;
}
