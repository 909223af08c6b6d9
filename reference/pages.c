/* pages.c - memory in pages as large as there are. */
#define _DEFAULT_SOURCE /* madvise() */
#include "pages.h"

#include <stdlib.h>
#include <sys/mman.h>

enum { HUGE_PAGE_BYTES = 1 << 21 };

void *pages_alloc(size_t bytes)
{
    void *pages;
    if (posix_memalign(&pages, HUGE_PAGE_BYTES, bytes) != 0)
        return NULL;
#ifdef MADV_HUGEPAGE
    madvise(pages, bytes, MADV_HUGEPAGE); /* advice: nothing is lost where it is not taken */
#endif
    return pages;
}
