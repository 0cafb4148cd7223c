/* SPDX-License-Identifier: MIT
 * Memory that goes all at once: of what is known of a batch until its end, of one message. The
 * first failed allocation sticks, so that callers may look once, at the end.
 */
#ifndef CLI_ARENA_H
#define CLI_ARENA_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

#include "core/option_kinds.h"

typedef struct cli_arena {
    struct cli_chunk *chunks;
    bool failed;
} cli_arena;

/* Zeroed; NULL: no memory. */
void *cli_arena_alloc(cli_arena *arena, size_t size);
/* These give "" when there is no memory, never NULL. */
const char *cli_arena_strndup(cli_arena *arena, const char *text, size_t length);
const char *cli_arena_strdup(cli_arena *arena, const char *text);
__attribute__((format(printf, 2, 3))) const char *cli_arena_printf(cli_arena *arena,
                                                                   const char *format, ...);
/* The place of a new element behind `*count` ones of `size` bytes; NULL: no memory. */
void *cli_arena_push(cli_arena *arena, void **items, size_t *count, size_t size);
void cli_list_add(cli_arena *arena, cli_list *list, const char *text);
void cli_arena_reset(cli_arena *arena);

/* folder + "/" + name; name alone when the folder is "" or "." or the name is absolute. */
const char *cli_path_join(cli_arena *arena, const char *folder, const char *name);
/* Up to the last slash, without it; "" when there is none. */
const char *cli_path_folder(cli_arena *arena, const char *path);

#endif
