/* sweep_head.c - what a sweep's file begins with. Nothing in it depends on where the sweep runs, on how many threads,
 * or on what is done with its rows afterwards: two files of one sweep begin alike. */
#include "sweep_head.h"

#include <stdlib.h>
#include <string.h>

#include "digest.h"
#include "json.h"
#include "transfer_builtin.h"

static json_t *volumes(const sweep_stage *s)
{
    json_t *array = json_array();
    for (size_t i = 0; array && i < s->file_count; i++) {
        const stage_file *f = &s->files[i];
        const volume *v = &f->header;
        json_array_append_new(array, json_pack("{s:o, s:s, s:s, s:[i,i,i], s:[f,f,f], s:s}", "path", json_text(f->path),
                                               "sha256", f->file_sha256, "voxels_sha256", f->voxels_sha256, "dims",
                                               v->dims_vox[0], v->dims_vox[1], v->dims_vox[2], "spacing", v->spacing[0],
                                               v->spacing[1], v->spacing[2], "type", volume_type_name(v->type)));
    }
    return array;
}

static json_t *axis_names(const sweep_plan *p, size_t axis)
{
    json_t *array = json_array();
    for (size_t i = 0; array && i < p->name_count; i++)
        if (p->names[i].axis == axis)
            json_array_append_new(array, json_text(p->names[i].name));
    return array;
}

static json_t *axes(const sweep_plan *p)
{
    json_t *array = json_array();
    for (size_t a = 0; array && a < p->axis_count; a++) {
        json_t *values = json_array();
        for (size_t i = 0; values && i < p->axes[a].cells; i++)
            json_array_append_new(values, json_text(p->axes[a].values[i]));
        json_array_append_new(array, json_pack("{s:o, s:o}", "names", axis_names(p, a), "values", values));
    }
    return array;
}

static json_t *machines(const sweep_stage *s)
{
    json_t *array = json_array();
    for (size_t i = 0; array && i < s->machine_count; i++)
        json_array_append_new(array, json_machine(s->machines[i].name, &s->machines[i].machine));
    return array;
}

/* A built-in function is known by its name, a file by its content. */
static json_t *transfers(const sweep_stage *s, host_error *error)
{
    json_t *array = json_array();
    for (size_t i = 0; array && i < s->transfer_count; i++) {
        const char *name = s->transfers[i].name;
        char sha256[DIGEST_CHARS];
        const bool builtin = transfer_builtin_find(name) != NULL;
        if (!builtin && digest_file(name, sha256, error) != HOST_OK) {
            json_decref(array);
            return NULL;
        }
        json_array_append_new(array,
                              json_pack("{s:o, s:s?}", "name", json_text(name), "sha256", builtin ? NULL : sha256));
    }
    return array;
}

/* The tables that cells are looked up in; NULL after an error. */
static json_t *cells(const sweep_stage *s, host_error *error)
{
    char own[DIGEST_CHARS], file[DIGEST_CHARS];
    if (digest_bytes(rtl_synthesis_text, strlen(rtl_synthesis_text), own, error) != HOST_OK ||
        (s->fixed->cells && digest_file(s->fixed->cells, file, error) != HOST_OK))
        return NULL;
    return json_pack("{s:s, s:o, s:s?}", "synthesis_sha256", own, "file",
                     s->fixed->cells ? json_text(s->fixed->cells) : json_null(), "file_sha256",
                     s->fixed->cells ? file : NULL);
}

/* An object as lines of JSON behind '#', one a key. */
static char *as_comment(json_t *root)
{
    char *out;
    size_t size;
    const char *key, *before = "# {\n";
    json_t *value;
    FILE *file = open_memstream(&out, &size);
    if (!file)
        return NULL;
    bool good = true;
    json_object_foreach(root, key, value)
    {
        char *text = json_dumps(value, JSON_ENCODE_ANY | JSON_REAL_PRECISION(15));
        good = good && text;
        fprintf(file, "%s#   \"%s\": %s", before, key, text ? text : "");
        before = ",\n";
        free(text);
    }
    fputs("\n# }\n", file);
    if (fclose(file) == 0 && good)
        return out;
    free(out);
    return NULL;
}

host_status sweep_head(const sweep_stage *s, const char *repeats, char **text, host_error *error)
{
    host_error reason = {""};
    json_t *root = json_pack("{s:s, s:s, s:o, s:o, s:o, s:I, s:b, s:o, s:o, s:o, s:o}", "schema", "vodr-sweep-1",
                             "version", VODR_VERSION, "command", json_text(repeats), "volumes", volumes(s), "axes",
                             axes(s->plan), "points", (json_int_t)s->plan->points, "cycles", (int)s->fixed->cycles,
                             "machines", machines(s), "transfer_functions", transfers(s, &reason), "energy_pj",
                             energy_json(&s->tables.energy), "cells", cells(s, &reason));
    *text = root ? as_comment(root) : NULL;
    json_decref(root);
    if (*text)
        return HOST_OK;
    return reason.text[0] ? host_fail(error, HOST_BAD_INPUT, "%s", reason.text)
                          : host_fail(error, HOST_ENVIRONMENT, "no memory for the sweep's head");
}
