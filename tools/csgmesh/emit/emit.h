/* SPDX-License-Identifier: MIT
 * --emit: the jobs of a plan as rules of a build system, on standard output. Each job is one rule:
 * csgmesh mesh with a dependency file. A job with a file for each part is a batch of one scene; its
 * parts are those that the scene has now.
 */
#ifndef CLI_EMIT_H
#define CLI_EMIT_H

#include <stdio.h>

#include "batch/batch_plan.h"

/* A word of a rule's command. */
typedef enum emit_kind {
    EMIT_TEXT,      /* the prefix, as it stands */
    EMIT_INPUT,     /* the scene */
    EMIT_OUTPUT,    /* the output `index` */
    EMIT_DIRECTORY, /* that of all outputs */
    EMIT_DEPFILE,
    EMIT_SOURCE /* the prefix, then a path of the source tree */
} emit_kind;

typedef struct emit_word {
    emit_kind kind;
    const char *prefix, *path;
    size_t index;
} emit_word;

typedef struct emit_rule {
    const batch_job *job;
    cli_list names, outputs; /* below the directory, and with it */
    const char *depfile;     /* the first output's, "out/mug.glb.d" */
    emit_word *words;
    size_t word_count;
} emit_rule;

typedef struct emit_rules {
    batch_plan *plan;
    emit_rule *items;
    size_t count;
} emit_rules;

/* The exit status. */
int emit_plan(batch_plan *plan);

/* Each writes the rules to standard output; an exit status. */
int emit_ninja(const emit_rules *rules);
int emit_make(const emit_rules *rules);
int emit_meson(const emit_rules *rules);
int emit_cmake(const emit_rules *rules);

/* 'text' for a POSIX shell, bare where that is safe. */
const char *emit_shell_quoted(cli_arena *arena, const char *text);
/* The word as text, with paths as they were given. */
const char *emit_word_text(cli_arena *arena, const emit_rule *rule, const emit_word *word,
                           const char *directory);
/* The command in a shell's quotes, its words with spaces between. */
const char *emit_command(cli_arena *arena, const emit_rules *rules, const emit_rule *rule);

#endif
