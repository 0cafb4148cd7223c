/* SPDX-License-Identifier: MIT
 * The files that a piece of work has looked for: each once, with whether it was there then.
 */
#ifndef CLI_LOOKED_H
#define CLI_LOOKED_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum cli_looked_kind {
    CLI_LOOKED_MISSING,
    CLI_LOOKED_FOUND,
    CLI_LOOKED_PATTERN /* a pattern of glob(3), instead of a path */
} cli_looked_kind;

typedef struct cli_looked_item {
    char *path;
    cli_looked_kind kind;
} cli_looked_item;

typedef struct cli_looked {
    cli_looked_item *items; /* in the order of being looked for */
    size_t count, capacity;
    uint32_t *slots; /* by the hash of paths, numbers of items + 1; 0: free */
    size_t slot_count;
} cli_looked;

/* *is_new: it was not in the list; the first word counts. false: out of memory. */
bool cli_looked_add(cli_looked *list, const char *path, cli_looked_kind kind, bool *is_new);
/* Where the path is in items; count: nowhere. */
size_t cli_looked_find(const cli_looked *list, const char *path);
void cli_looked_release(cli_looked *list);

/* FNV-1a, from *hash on; 0 begins. */
uint64_t cli_looked_hash(uint64_t hash, const char *text);

#endif
