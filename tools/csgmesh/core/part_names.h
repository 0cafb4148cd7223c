/* SPDX-License-Identifier: MIT
 * Names of parts, as --part and --parts take them.
 */
#ifndef CLI_PART_NAMES_H
#define CLI_PART_NAMES_H

#include "core/cli.h"

/* Names of those of a field's parts that have one, with room for another, to be freed. NULL: out of
 * memory. */
const char **cli_part_names(const csgm_field *field, size_t *count);

/* Is one of the file's parts called so? names: room for count + 1, NULL where a part has none;
 * their order changes. CLI_DONE, or CLI_INPUT_AT_FAULT, and the nearest name is told. */
int cli_part_find(cli_app *app, const char *path, const char *wanted, const char **names,
                  size_t count);

#endif
