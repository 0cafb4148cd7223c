/* SPDX-License-Identifier: MIT
 * Names of outputs from a pattern: {scene}-{set}-{part}.{ext}.
 */
#ifndef CLI_BATCH_NAMES_H
#define CLI_BATCH_NAMES_H

#include "core/arena.h"

typedef struct batch_name_parts {
    const char *scene;      /* its path */
    const char *folder;     /* the scene's, as it was given */
    const char *set, *part; /* NULL = without */
    const char *ext;
} batch_name_parts;

/* NULL: the pattern is sound; else what is wrong with it. */
const char *batch_name_problem(cli_arena *arena, const char *pattern);
bool batch_name_has_part(const char *pattern);
/* A placeholder without a value goes with the -, _, . or space before it. Slashes and control
 * characters in values become _. */
const char *batch_name_expand(cli_arena *arena, const char *pattern, const batch_name_parts *parts);
/* Does the name stay below its folder: relative, without .. or empty pieces? */
bool batch_name_stays_below(const char *name);

#endif
