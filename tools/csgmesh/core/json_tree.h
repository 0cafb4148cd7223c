/* SPDX-License-Identifier: MIT
 * JSON as trees: of manifests, parameter sets and messages, which are small.
 */
#ifndef CLI_JSON_TREE_H
#define CLI_JSON_TREE_H

#include "core/arena.h"
#include "core/cli.h"

typedef struct cli_value {
    csgm_json_kind kind; /* OBJECT, ARRAY, STRING, NUMBER or WORD */
    const char *key;     /* of a member of an object, else NULL */
    const char *text;    /* of STRING, NUMBER and WORD; strings may hold NULs */
    size_t length;       /* of the text */
    struct cli_value *first, *next;
} cli_value;

/* CLI_DONE, or an exit status after a report. */
int cli_value_load(cli_app *app, cli_arena *arena, const char *path, cli_value **out);
/* A text that is in memory. *too_deep: more brackets are nested than any message has; without
 * memory arena->failed is set. */
csgm_status cli_value_parse(csgm_context *context, cli_arena *arena, const char *text,
                            size_t length, const char *name, cli_value **out, bool *too_deep);
/* The member of an object; NULL: there is none. */
const cli_value *cli_value_member(const cli_value *object, const char *key);

#endif
