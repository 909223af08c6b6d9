/* json.c - pieces of JSON that several outputs share (jansson). */
#include "json.h"

#include <errno.h>
#include <string.h>

#include "text.h"

json_t *json_text(const char *text)
{
    json_t *string = json_string(text);
    if (string)
        return string;
    char plain[4096];
    size_t n = 0;
    for (; text[n] && n + 1 < sizeof plain; n++)
        plain[n] = (unsigned char)text[n] < 0x80 ? text[n] : '?';
    plain[n] = '\0';
    return json_string(plain);
}

json_t *json_machine(const char *name, const vodr_machine *machine)
{
    size_t count;
    const vodr_parameter *parameters = vodr_parameters(&count);
    json_t *object = json_pack("{s:o}", "name", json_text(name));
    for (size_t i = 0; i < count; i++) {
        char text[64];
        int64_t number;
        vodr_machine_get(machine, &parameters[i], text, sizeof text);
        bool integer = text_integer(text, INT32_MIN, INT32_MAX, &number);
        if (json_object_set_new(object, parameters[i].name, integer ? json_integer(number) : json_string(text)) != 0) {
            json_decref(object);
            return NULL;
        }
    }
    return object;
}

json_t *json_volume(const scene *s, const view_options *options)
{
    const volume *v = &s->volume;
    const volume_options *o = &options->volume;
    json_t *crop = json_null();
    if (o->crop)
        crop = json_pack("[[i,i],[i,i],[i,i]]", o->crop_lo[0], o->crop_hi[0], o->crop_lo[1], o->crop_hi[1],
                         o->crop_lo[2], o->crop_hi[2]);
    return json_pack("{s:o, s:s, s:[i,i,i], s:[f,f,f], s:s, s:f, s:f, s:f, s:f, s:o, s:[f,f]}", "path",
                     json_text(v->path), "format", v->format, "dims", v->dims_vox[0], v->dims_vox[1], v->dims_vox[2],
                     "spacing", v->spacing[0], v->spacing[1], v->spacing[2], "type", volume_type_name(v->type), "min",
                     v->min, "max", v->max, "slope", v->slope, "inter", v->inter, "crop", crop, "window", s->window_lo,
                     s->window_hi);
}

host_status json_write(output *o, json_t *root, host_error *error)
{
    if (!root)
        return host_fail(error, HOST_ENVIRONMENT, "no memory to write '%s'", o->path);
    int failed = json_dumpf(root, o->file, JSON_INDENT(2) | JSON_REAL_PRECISION(17)) || fputc('\n', o->file) == EOF;
    int code = errno;
    json_decref(root);
    return failed ? host_fail(error, HOST_ENVIRONMENT, "cannot write '%s': %s", o->path, strerror(code)) : HOST_OK;
}
