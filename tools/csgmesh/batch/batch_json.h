/* SPDX-License-Identifier: MIT
 * JSON files as trees: manifests and parameter sets are small.
 */
#ifndef CLI_BATCH_JSON_H
#define CLI_BATCH_JSON_H

#include "batch/batch_arena.h"
#include "core/cli.h"

typedef struct batch_value {
    csgm_json_kind kind; /* OBJECT, ARRAY, STRING, NUMBER or WORD */
    const char *key;     /* of a member of an object, else NULL */
    const char *text;    /* of STRING, NUMBER and WORD */
    struct batch_value *first, *next;
} batch_value;

/* CLI_DONE, or an exit status after a report. */
int batch_json_load(cli_app *app, batch_arena *arena, const char *path, batch_value **out);
/* A text that is in memory. *too_deep: more brackets are nested than any message has; without
 * memory arena->failed is set. */
csgm_status batch_json_parse(csgm_context *context, batch_arena *arena, const char *text,
                             size_t length, const char *name, batch_value **out, bool *too_deep);
/* The member of an object; NULL: there is none. */
const batch_value *batch_json_member(const batch_value *object, const char *key);

#endif
