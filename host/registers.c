/* registers.c - everything the machine is given for a frame but the voxels, as JSON (--registers). */
#include "registers.h"

#include <string.h>

#include "json.h"

enum { REGISTERS = 23 };

typedef struct named_value {
    const char *name;
    int64_t value;
} named_value;

static void list_registers(const int32_t dims_vox[3], const vodr_view *v, named_value list[REGISTERS])
{
    const named_value values[REGISTERS] = {
        {"dim_x", dims_vox[0]},          {"dim_y", dims_vox[1]},        {"dim_z", dims_vox[2]},
        {"width_px", v->width_px},       {"height_px", v->height_px},   {"slices", v->slices},
        {"perspective", v->perspective}, {"shift", v->shift},           {"footprint", v->footprint},
        {"base_x", v->base[0]},          {"base_y", v->base[1]},        {"base_z", v->base[2]},
        {"step_u_x", v->step_u[0]},      {"step_u_y", v->step_u[1]},    {"step_u_z", v->step_u[2]},
        {"step_v_x", v->step_v[0]},      {"step_v_y", v->step_v[1]},    {"step_v_z", v->step_v[2]},
        {"step_s_x", v->step_s[0]},      {"step_s_y", v->step_s[1]},    {"step_s_z", v->step_s[2]},
        {"depth_first", v->depth_first}, {"depth_step", v->depth_step},
    };
    memcpy(list, values, sizeof values);
}

_Static_assert((int)REGISTERS == (int)VODR_REGISTER_COUNT, "a register of hw/registers.txt is not written");

static json_t *registers_object(const scene *s)
{
    named_value list[REGISTERS];
    list_registers(s->densities.dims_vox, &s->view, list);
    json_t *object = json_object();
    for (size_t i = 0; i < REGISTERS; i++)
        if (json_object_set_new(object, list[i].name, json_integer(list[i].value)) != 0) {
            json_decref(object);
            return NULL;
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
