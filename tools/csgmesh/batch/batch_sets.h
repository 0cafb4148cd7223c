/* SPDX-License-Identifier: MIT
 * Parameter sets: the names in a file and what each one holds, and the choice among them by
 * patterns.
 */
#ifndef CLI_BATCH_SETS_H
#define CLI_BATCH_SETS_H

#include "batch/batch_hash.h"
#include "core/arena.h"
#include "core/cli.h"

typedef struct batch_set {
    const char *name;
    batch_digest digest; /* of its text: another set of the file may change without harm */
} batch_set;

typedef struct batch_sets {
    const char *path;
    batch_set *items;
    size_t count;
} batch_sets;

typedef struct batch_sets_cache { /* files are read once */
    batch_sets *files;
    size_t count;
} batch_sets_cache;

/* CLI_DONE, or an exit status after a report. */
int batch_sets_load(cli_app *app, cli_arena *arena, batch_sets_cache *cache, const char *path,
                    batch_sets *out);
/* A name, or a pattern with * and ?. The names chosen, in the file's order; none is an error, told
 * with its place. */
int batch_sets_choose(cli_app *app, cli_arena *arena, const batch_sets *sets, const char *place,
                      const cli_list *patterns, batch_set **chosen, size_t *count);

#endif
