/* sweep_row.h - the columns of a sweep's file, and a point as a row. */
#ifndef HOST_SWEEP_ROW_H
#define HOST_SWEEP_ROW_H

#include "sweep_stage.h"

/* `point`, the names that vary, every counter and cost of --stats, `frame_sha256`, `refused`, and last `pareto`, which
 * is empty in a row as it is made. */
typedef struct sweep_columns {
    char **names;
    size_t count, coordinates; /* coordinates: how many come after `point` */
} sweep_columns;

host_status sweep_columns_make(sweep_columns *c, const sweep_stage *s, host_error *error);
void sweep_columns_free(sweep_columns *c);

/* The index of a column; count when there is none. */
size_t sweep_columns_find(const sweep_columns *c, const char *name);

/* Whether its values are numbers. */
bool sweep_column_is_number(const sweep_columns *c, const sweep_plan *p, size_t column);

/* Its unit ("bytes"), "" where there is none. */
const char *sweep_column_unit(const sweep_plan *p, const char *name);

/* The row with its line break; free() it. */
host_status sweep_row_make(const sweep_columns *c, const sweep_stage *s, uint64_t point, const sweep_sample *sample,
                           char **line, host_error *error);

#endif
