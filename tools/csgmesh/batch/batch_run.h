/* SPDX-License-Identifier: MIT
 * Making the jobs of a plan: what is known of each, what became of it, and the threads.
 */
#ifndef CLI_BATCH_RUN_H
#define CLI_BATCH_RUN_H

#include "batch/batch_files.h"
#include "batch/batch_record.h"

typedef enum batch_outcome {
    BATCH_NOT_RUN,
    BATCH_UP_TO_DATE,
    BATCH_CACHED, /* copied from the cache */
    BATCH_MADE,
    BATCH_FAILED,
    BATCH_OUTCOMES
} batch_outcome;

typedef struct batch_result {
    batch_outcome outcome;
    int status;           /* exit status */
    bool endangers_files; /* --trace or --junit would overwrite what it reads or writes */
    char *messages;       /* what csgmesh mesh would have said; NULL or "" = nothing */
    double seconds;
    double cpu_seconds;    /* of all threads; of what was not made, the time that it took when it
                              was; 0: not known */
    uint64_t triangles;    /* of BATCH_MADE */
    batch_output *outputs; /* with their digests, sizes */
    size_t output_count;
    cli_arena arena; /* of the outputs */
} batch_result;

typedef struct batch_remote batch_remote; /* batch_remote.h */

typedef struct batch_run {
    cli_app *app;
    batch_plan *plan;
    batch_digest program; /* this very executable */
    batch_memo memo;
    batch_locks locks;
    batch_remote *remote; /* where --cache is an address; NULL: it is not, or cannot be used */
    const char *state;    /* folder of the records */
    batch_result *results;
    uint32_t threads;
    pthread_mutex_t mutex; /* of what follows, and of standard error */
    pthread_cond_t changed;
    size_t finished, ended[BATCH_OUTCOMES]; /* jobs, in all and by what became of them */
    bool stopped;                           /* --fail-fast has seen a failure */
    size_t *queue, queue_count, next;       /* jobs of this phase */
    size_t *large, large_count;             /* put off: for all threads together */
    size_t *locked, locked_count;           /* put off: another process is at it */
    uint32_t threads_each;
    bool may_defer_large, may_defer_locked;
    bool cache_is_full; /* its warning was given; mutex */
} batch_run;

/* Name of an outcome: "made", "up to date", ... */
const char *batch_outcome_name(batch_outcome outcome);

/* All jobs. CLI_DONE, or CLI_TROUBLE when it could not even begin (reported). */
int batch_run_all(batch_run *run);

/* batch_job.c: the job is meshed and written. *is_large instead when `may_defer` and it is long
 * work for one thread. */
void batch_make(batch_run *run, const batch_job *job, uint32_t threads, bool may_defer,
                batch_result *result, bool *is_large);

/* batch_state.c: records beside the outputs. */
batch_digest batch_job_id(const batch_job *job);
bool batch_is_current(batch_run *run, const batch_job *job, batch_result *result);
bool batch_take_from_cache(batch_run *run, const batch_job *job, batch_result *result);
/* Is this text, which a cache has, the record of this job as it is now? */
bool batch_record_is_taken(batch_run *run, cli_arena *arena, const batch_job *job,
                           const batch_digest *key, const char *text, batch_record *record);
/* Notes what was made; a failure here costs time later and nothing else. */
void batch_note(batch_run *run, const batch_job *job, batch_record *record);
bool batch_write_depfiles(cli_app *app, const batch_record *record, const batch_job *job);

#endif
