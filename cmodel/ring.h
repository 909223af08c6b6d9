/* ring.h - queues that grow: RING(name, type) declares name, name_push(), name_front(), name_at(), name_pop(),
 * name_reserve(), name_free(). A queue that never holds more than it has reserved does not run out of memory. */
#ifndef VODR_RING_H
#define VODR_RING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

#define RING(name, type)                                                                                               \
    typedef struct name {                                                                                              \
        type *items;                                                                                                   \
        size_t room, head, count; /* room: a power of two, or 0 */                                                     \
    } name;                                                                                                            \
    static inline type *name##_at(const name *r, size_t i)                                                             \
    {                                                                                                                  \
        return &r->items[(r->head + i) & (r->room - 1)];                                                               \
    }                                                                                                                  \
    static inline type *name##_front(const name *r)                                                                    \
    {                                                                                                                  \
        return name##_at(r, 0);                                                                                        \
    }                                                                                                                  \
    static inline type *name##_back(const name *r)                                                                     \
    {                                                                                                                  \
        return name##_at(r, r->count - 1);                                                                             \
    }                                                                                                                  \
    static inline type *name##_add(name *r) /* room for one more at the back, not initialised; NULL: no memory */      \
    {                                                                                                                  \
        if (r->count == r->room) {                                                                                     \
            size_t room = r->room ? 2 * r->room : 64;                                                                  \
            type *items = malloc(room * sizeof *items);                                                                \
            if (!items)                                                                                                \
                return NULL;                                                                                           \
            for (size_t i = 0; i < r->count; i++)                                                                      \
                items[i] = *name##_at(r, i);                                                                           \
            free(r->items);                                                                                            \
            r->items = items;                                                                                          \
            r->room = room;                                                                                            \
            r->head = 0;                                                                                               \
        }                                                                                                              \
        r->count++;                                                                                                    \
        return name##_back(r);                                                                                         \
    }                                                                                                                  \
    static inline bool name##_push(name *r, type item)                                                                 \
    {                                                                                                                  \
        type *back = name##_add(r);                                                                                    \
        if (back)                                                                                                      \
            *back = item;                                                                                              \
        return back != NULL;                                                                                           \
    }                                                                                                                  \
    static inline void name##_pop(name *r)                                                                             \
    {                                                                                                                  \
        r->head = (r->head + 1) & (r->room - 1);                                                                       \
        r->count--;                                                                                                    \
    }                                                                                                                  \
    static inline bool name##_reserve(name *r, size_t count) /* of an empty queue */                                   \
    {                                                                                                                  \
        for (r->room = 64; r->room < count; r->room *= 2)                                                              \
            ;                                                                                                          \
        r->items = malloc(r->room * sizeof *r->items);                                                                 \
        return r->items != NULL;                                                                                       \
    }                                                                                                                  \
    static inline void name##_free(name *r)                                                                            \
    {                                                                                                                  \
        free(r->items);                                                                                                \
        *r = (name){0};                                                                                                \
    }

#endif
