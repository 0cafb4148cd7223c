/* SPDX-License-Identifier: MIT
 * See part_names.h.
 */
#include "core/part_names.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char **cli_part_names(const csgm_field *field, size_t *count)
{
    size_t parts = 0;
    const char *name;
    while (csgm_field_part(field, parts, &name))
        parts++;
    const char **names = calloc(parts + 1, sizeof *names);
    *count = 0;
    for (size_t i = 0; names && i < parts; i++)
        if (csgm_field_part(field, i, &name) && name)
            names[(*count)++] = name;
    return names;
}

int cli_part_find(cli_app *app, const char *path, const char *wanted, const char **names,
                  size_t count)
{
    char hint[160];
    size_t kept = 0;
    for (size_t i = 0; i < count; i++) {
        if (names[i] && strcmp(names[i], wanted) == 0)
            return CLI_DONE;
        if (names[i])
            names[kept++] = names[i];
    }
    names[kept] = NULL;
    const char *near = cli_nearest(wanted, names);
    snprintf(hint, sizeof hint, near ? "did you mean \"%.80s\"?" : "its first part is \"%.80s\"",
             near ? near : names[0]);
    cli_console_say(
        &app->console, CSGM_ERROR, kept ? hint : "part(\"lid\") in a scene names a part",
        kept ? "%s has no part \"%.80s\"" : "%s has no named parts, so no \"%.80s\"", path, wanted);
    return CLI_INPUT_AT_FAULT;
}
