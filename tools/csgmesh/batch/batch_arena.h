/* SPDX-License-Identifier: MIT
 * Memory of one batch: what is known of its jobs lives until the end, and goes all at once. The
 * first failed allocation sticks, so that callers may look once, at the end.
 */
#ifndef CLI_BATCH_ARENA_H
#define CLI_BATCH_ARENA_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#include "core/options.h"

typedef struct batch_arena {
    struct batch_chunk *chunks;
    bool failed;
} batch_arena;

/* Zeroed; NULL: no memory. */
void *batch_alloc(batch_arena *arena, size_t size);
/* These give "" when there is no memory, never NULL. */
const char *batch_strndup(batch_arena *arena, const char *text, size_t length);
const char *batch_strdup(batch_arena *arena, const char *text);
__attribute__((format(printf, 2, 3))) const char *batch_printf(batch_arena *arena,
                                                               const char *format, ...);
/* The place of a new element behind `*count` ones of `size` bytes; NULL: no memory. */
void *batch_push(batch_arena *arena, void **items, size_t *count, size_t size);
void batch_add(batch_arena *arena, cli_list *list, const char *text);
void batch_arena_reset(batch_arena *arena);

/* folder + "/" + name; name alone when the folder is "" or "." or the name is absolute. */
const char *batch_join(batch_arena *arena, const char *folder, const char *name);
/* Up to the last slash, without it; "" when there is none. */
const char *batch_folder_of(batch_arena *arena, const char *path);

#endif
