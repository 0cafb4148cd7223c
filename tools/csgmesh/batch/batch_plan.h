/* SPDX-License-Identifier: MIT
 * What a batch is to make: scenes and manifests -> jobs, each one scene with one set of parameters,
 * meshed once and written in one or more formats. Everything that can be known to be wrong without
 * looking into a scene is said before the first one is read.
 */
#ifndef CLI_BATCH_PLAN_H
#define CLI_BATCH_PLAN_H

#include "batch/batch_sets.h"

typedef struct batch_settings batch_settings;

typedef struct batch_job {
    const char *place; /* "parts.json: jobs[3]", or the scene */
    const char *scene;
    const char *parameter_file; /* NULL: none */
    const char *set;
    batch_digest set_digest; /* of the set's own text */
    const char *title;       /* for people: the scene, and the set in brackets */
    const char *folder;      /* of the scene, for {folder} */
    batch_settings *settings;
    cli_list arguments; /* of csgmesh mesh: options, set */
    cli_options *options;
    const char *pattern; /* of names */
    bool by_part;        /* it has {part} */
    cli_list formats;    /* names, "glb" */
    cli_list names;      /* of the outputs, below the directory; those without a part */
    cli_list outputs;    /* the same with the directory */
    size_t number;       /* in the whole batch, from 1 on */
} batch_job;

/* The part of a batch that one machine makes; see batch_shard.h. */
typedef struct batch_shard {
    uint32_t index, count; /* 3 of 8; 1 of 1: all */
    size_t all;            /* jobs of all shards together */
    uint64_t batch;        /* which batch it is: of jobs, options and costs */
} batch_shard;

typedef struct batch_plan {
    cli_app *app;
    cli_arena arena;
    const char *directory;
    batch_job *jobs;
    size_t count;
    batch_shard shard;
    /* while the plan is made */
    batch_settings *given;
    batch_sets_cache sets;
} batch_plan;

/* CLI_DONE, or an exit status after a report. Released in any case. */
int batch_plan_make(cli_app *app, batch_plan *plan);
void batch_plan_release(batch_plan *plan);

#endif
