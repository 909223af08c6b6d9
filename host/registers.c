/* registers.c - everything the machine is given for a frame but the voxels, as JSON (--registers). */
#include "registers.h"

#include "json.h"

static json_t *registers_object(const scene *s)
{
    json_t *object = json_object();
    for (size_t i = 0; i < VODR_REGISTER_COUNT; i++) {
        const char *name = vodr_hw_registers[i].name;
        int64_t value;
        if (!vodr_register_get(name, &s->view, s->densities.dims_vox, &value) ||
            json_object_set_new(object, name, json_integer(value)) != 0) {
            json_decref(object);
            return NULL;
        }
    }
    return object;
}

static json_t *table_array(const vodr_table *table)
{
    json_t *array = json_array();
    for (size_t i = 0; i < table->count; i++) {
        const vodr_rgba *e = &table->entries[i];
        if (json_array_append_new(array, json_pack("[i,i,i,i]", e->r, e->g, e->b, e->a)) != 0) {
            json_decref(array);
            return NULL;
        }
    }
    return array;
}

host_status registers_write(output *o, const scene *s, const view_options *options, host_error *error)
{
    json_t *root = json_pack("{s:s, s:o, s:o, s:o, s:o}", "schema", "vodr-registers-1", "registers",
                             registers_object(s), "machine", json_machine(s->machine_name, &s->machine), "volume",
                             json_volume(s, options), "table", table_array(&s->table));
    return json_write(o, root, error);
}
