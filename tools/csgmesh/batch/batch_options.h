/* SPDX-License-Identifier: MIT
 * The options of one job: those of `csgmesh mesh` that apply to batches too, by the names of
 * options.def, from a manifest or the command line. In the end they are arguments again, in the
 * table's order: what a rule of a build system says, and what is hashed.
 */
#ifndef CLI_BATCH_OPTIONS_H
#define CLI_BATCH_OPTIONS_H

#include "batch/batch_hash.h"
#include "core/arena.h"
#include "core/json_tree.h"
#include "core/options.h"

typedef struct batch_settings {
    const char *arguments[CLI_OPTION_COUNT]; /* "--resolution=64"; "" takes an earlier one back */
    cli_list defines;                        /* "radius=5" */
    cli_list include_dirs;
    cli_list meta; /* "title=Mug" */
} batch_settings;

/* A key of a manifest, "cell_size" or "cell-size"; CLI_OPTION_COUNT: no option of a job. */
cli_option_id batch_option_find(const char *key);
/* All keys, for hints: names, then NULL. */
const char *const *batch_option_names(void);
/* Sets the option to a value of a manifest; false: it has no such type, *wanted says which. */
bool batch_option_set(cli_arena *arena, batch_settings *settings, cli_option_id id,
                      const cli_value *value, const char **wanted);
/* What the command line says. */
void batch_options_given(cli_arena *arena, const cli_options *options, batch_settings *out);
/* `over` wins; of -r, -s and their like only the later one holds. */
void batch_settings_overlay(cli_arena *arena, batch_settings *settings, const batch_settings *over);
/* Arguments of csgmesh mesh. */
cli_list batch_settings_arguments(cli_arena *arena, const batch_settings *settings);
/* Only what may change a byte of the outputs, or whether there are any; includes are hashed as the
 * files that they lead to. */
void batch_settings_hash(const batch_settings *settings, batch_hasher *hasher);
/* The same, text by text, for another hash. */
void batch_settings_visit(const batch_settings *settings,
                          void (*take)(void *user, const char *text), void *user);

/* A value as an expression of the scene language: 5, true, "text", [1, 2]. NULL: an object. */
const char *batch_expression(cli_arena *arena, const cli_value *value);

#endif
