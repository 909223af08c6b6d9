/* pages.h - private to reference/: memory in pages as large as there are. */
#ifndef REFERENCE_PAGES_H
#define REFERENCE_PAGES_H

#include <stddef.h>

/* Memory to be freed with free(); NULL where there is none. Rays change small pages at almost every sample. */
void *pages_alloc(size_t bytes);

#endif
