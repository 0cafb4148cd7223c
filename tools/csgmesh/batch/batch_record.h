/* SPDX-License-Identifier: MIT
 * What one job has read and written, with digests: a small text, in the directory of the outputs
 * and in a cache. Names of files are kept by where they are found (beside the scene, in a folder of
 * -I), so that a record made in one checkout holds in another.
 */
#ifndef CLI_BATCH_RECORD_H
#define CLI_BATCH_RECORD_H

#include "batch/batch_memo.h"
#include "batch/batch_plan.h"

typedef struct batch_input {
    const char *path;
    batch_digest digest;
} batch_input;

typedef struct batch_output {
    const char *path;
    const char *format;
    const char *part; /* NULL: without */
    batch_digest digest;
    uint64_t bytes;
    int64_t changed_s, changed_ns; /* time of its last change: while that holds, its bytes do */
} batch_output;

typedef struct batch_record {
    batch_digest key;
    batch_input *inputs; /* the scene first */
    size_t input_count;
    cli_list absent; /* files that would have been found first, had they been there */
    batch_output *outputs;
    size_t output_count;
    double cpu_seconds; /* that it took; 0: not known */
} batch_record;

/* Program, options and parameters: all that the outputs come from but the files. */
batch_digest batch_record_key(const batch_job *job, const batch_digest *program);

/* The key together with the text of the scene: what is known before it is read. false: it cannot be
 * read. */
bool batch_record_scene_key(batch_memo *memo, const batch_job *job, const batch_digest *key,
                            batch_digest *out);

/* The same for a cache: times of outputs are those of one folder. */
batch_record batch_record_timeless(cli_arena *arena, const batch_record *record);
/* A name for the record in a cache: of all that this text says but how long it took. NULL: it is no
 * record. */
const char *batch_record_name(cli_arena *arena, const char *text);
const char *batch_record_print(cli_arena *arena, const batch_job *job, const batch_record *record);
/* false: it is none, or not whole. */
bool batch_record_parse(cli_arena *arena, const batch_job *job, const char *directory,
                        const char *text, batch_record *out);
/* Digests of the dependencies of a scene and what must stay absent. false: one of them cannot be
 * read, or changed after `since_s` (seconds and nanoseconds of the clock). */
bool batch_record_take_inputs(cli_arena *arena, batch_memo *memo, const batch_job *job,
                              const csgm_scene *scene, const int64_t since[2],
                              batch_record *record);
/* Are the files what they were? */
bool batch_record_inputs_hold(batch_memo *memo, const batch_record *record);
/* Size and time of an output that is there. */
bool batch_output_look(batch_output *output);
/* Where the output of a part in a format goes. */
const char *batch_output_path(cli_arena *arena, const batch_job *job, const char *directory,
                              const char *format, const char *part);

#endif
