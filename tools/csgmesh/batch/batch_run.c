/* SPDX-License-Identifier: MIT
 * Jobs on threads; see batch_run.h. First all jobs are looked at, many at a time: most are up to
 * date. Those that are not are made, one thread each; what turns out to be long work for one thread
 * is put off and then made by all threads together, one job after the other. Jobs that another
 * process is making are put off to the end: they will be up to date by then.
 */
#include "batch/batch_run.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "batch/batch_http.h"
#include "batch/batch_remote.h"
#include "batch/batch_report.h"
#include "core/options.h"

/* ---- one job -------------------------------------------------------------------------- */

static void finish_job(batch_run *run, size_t index)
{
    pthread_mutex_lock(&run->mutex);
    run->finished++;
    run->ended[run->results[index].outcome]++;
    if (run->results[index].outcome == BATCH_FAILED && run->app->options->fail_fast)
        run->stopped = true;
    batch_report_job(run, index);
    pthread_cond_signal(&run->changed);
    pthread_mutex_unlock(&run->mutex);
}

static void put_off(batch_run *run, size_t *list, size_t *count, size_t index)
{
    pthread_mutex_lock(&run->mutex);
    list[(*count)++] = index;
    pthread_mutex_unlock(&run->mutex);
}

/* The lock is held. true: it has ended. */
static bool make_locked(batch_run *run, size_t index)
{
    const batch_job *job = &run->plan->jobs[index];
    batch_result *result = &run->results[index];
    bool is_large = false;
    if (batch_is_current(run, job, result))
        return true; /* another process has made it meanwhile */
    if (batch_take_from_cache(run, job, result))
        return true;
    batch_make(run, job, run->threads_each, run->may_defer_large, result, &is_large);
    return !is_large;
}

static void make_job(batch_run *run, size_t index)
{
    batch_digest id = batch_job_id(&run->plan->jobs[index]);
    if (!batch_lock_job(&run->locks, &id, !run->may_defer_locked)) {
        put_off(run, run->locked, &run->locked_count, index);
        return;
    }
    bool ended = make_locked(run, index);
    batch_unlock_job(&run->locks, &id);
    if (ended)
        finish_job(run, index);
    else
        put_off(run, run->large, &run->large_count, index);
}

static void check_job(batch_run *run, size_t index)
{
    if (batch_is_current(run, &run->plan->jobs[index], &run->results[index]))
        finish_job(run, index);
    else
        put_off(run, run->large, &run->large_count, index); /* to be made */
}

/* ---- a phase -------------------------------------------------------------------------- */

typedef struct phase {
    batch_run *run;
    void (*work)(batch_run *run, size_t index);
    uint32_t busy; /* threads; run->mutex */
} phase;

static bool take_next(batch_run *run, size_t *index)
{
    pthread_mutex_lock(&run->mutex);
    bool any = !run->stopped && run->next < run->queue_count;
    if (any)
        *index = run->queue[run->next++];
    pthread_mutex_unlock(&run->mutex);
    return any;
}

static void *worker(void *argument)
{
    phase *p = argument;
    size_t index;
    while (take_next(p->run, &index))
        p->work(p->run, index);
    pthread_mutex_lock(&p->run->mutex);
    p->busy--;
    pthread_cond_signal(&p->run->changed);
    pthread_mutex_unlock(&p->run->mutex);
    return NULL;
}

/* The caller's thread draws the bar. */
static void wait_for(phase *p)
{
    enum { TENTH_NS = 100000000 };
    batch_run *run = p->run;
    pthread_mutex_lock(&run->mutex);
    while (p->busy) {
        struct timespec until;
        clock_gettime(CLOCK_REALTIME, &until);
        until.tv_nsec += TENTH_NS;
        if (until.tv_nsec >= 1000000000) {
            until.tv_nsec -= 1000000000;
            until.tv_sec++;
        }
        pthread_cond_timedwait(&run->changed, &run->mutex, &until);
        batch_report_progress(run);
    }
    pthread_mutex_unlock(&run->mutex);
}

/* All of the queue by `count` threads; without a single one, by this thread. */
static void run_phase(batch_run *run, uint32_t count, void (*work)(batch_run *, size_t))
{
    phase p = {run, work, 0};
    pthread_t *threads = malloc((count + 1) * sizeof *threads);
    uint32_t started = 0;
    count = run->queue_count < count ? (uint32_t)run->queue_count : count;
    run->next = 0;
    pthread_mutex_lock(&run->mutex); /* until all are counted */
    for (; threads && started < count; started++, p.busy++)
        if (pthread_create(&threads[started], NULL, worker, &p) != 0)
            break;
    pthread_mutex_unlock(&run->mutex);
    wait_for(&p);
    for (uint32_t i = 0; i < started; i++)
        pthread_join(threads[i], NULL);
    free(threads);
    if (!started && count) {
        p.busy = 1;
        worker(&p);
    }
}

static int by_number(const void *a, const void *b)
{
    size_t left = *(const size_t *)a, right = *(const size_t *)b;
    return left < right ? -1 : left > right;
}

/* The jobs put off to `list` become the queue, in the order of the plan. */
static void requeue(batch_run *run, size_t *list, size_t *count)
{
    memcpy(run->queue, list, *count * sizeof *list);
    qsort(run->queue, *count, sizeof *list, by_number);
    run->queue_count = *count;
    *count = 0;
}

static void run_phases(batch_run *run)
{
    uint32_t threads = run->threads;
    for (size_t i = 0; i < run->plan->count; i++)
        run->queue[i] = i;
    run->queue_count = run->plan->count;
    run_phase(run, threads, check_job);
    requeue(run, run->large, &run->large_count);

    bool many = run->queue_count >= threads && run->queue_count > 1;
    run->threads_each = many ? 1 : threads;
    run->may_defer_large = many && threads > 1;
    run->may_defer_locked = true;
    run_phase(run, many ? threads : 1, make_job);

    requeue(run, run->large, &run->large_count);
    run->threads_each = threads;
    run->may_defer_large = false;
    run_phase(run, 1, make_job);

    requeue(run, run->locked, &run->locked_count);
    run->may_defer_locked = false;
    run_phase(run, 1, make_job);
}

/* ---- the whole ------------------------------------------------------------------------ */

static int refuse(batch_run *run, const char *path)
{
    cli_console_say(&run->app->console, CSGM_ERROR, NULL, "cannot write %s: %s", path,
                    strerror(errno));
    return CLI_TROUBLE;
}

/* Another program, or another version of it, or of a library, may write other bytes. */
static batch_digest hash_program(void)
{
    batch_hasher hasher;
    batch_digest executable = {{0}};
    batch_hash_path("/proc/self/exe", &executable);
    batch_hash_begin(&hasher);
    batch_hash_text(&hasher, csgm_version());
    batch_hash_text(&hasher, csgm_build_features());
    batch_hash_add(&hasher, executable.bytes, sizeof executable.bytes);
    return batch_hash_end(&hasher);
}

/* In all folders of outputs, if nobody else is at work there. */
static void sweep(batch_run *run)
{
    cli_arena arena = {0};
    const char *latest = "";
    csgm_files_sweep(run->state);
    for (size_t i = 0; i < run->plan->count; i++)
        for (size_t j = 0; j < run->plan->jobs[i].outputs.count; j++) {
            const char *folder = cli_path_folder(&arena, run->plan->jobs[i].outputs.items[j]);
            if (strcmp(folder, latest) != 0)
                csgm_files_sweep(*folder ? folder : ".");
            latest = folder;
        }
    cli_arena_reset(&arena);
}

static int open_state(batch_run *run)
{
    cli_arena *arena = &run->plan->arena;
    const char *directory = run->plan->directory, *cache = run->app->options->cache;
    run->state = cli_path_join(arena, directory, ".csgmesh-cache");
    if (!batch_make_folders(directory, true) || access(directory, W_OK | X_OK) != 0)
        return refuse(run, directory);
    if (!batch_make_folders(run->state, true) ||
        !batch_locks_open(&run->locks, cli_path_join(arena, run->state, "lock")))
        return refuse(run, run->state);
    if (cache && !batch_http_is_address(cache) &&
        (!batch_make_folders(cache, true) || access(cache, W_OK | X_OK) != 0))
        return refuse(run, cache);
    if (run->locks.alone)
        sweep(run);
    batch_locks_share(&run->locks);
    return CLI_DONE;
}

static bool allocate(batch_run *run)
{
    cli_arena *arena = &run->plan->arena;
    size_t count = run->plan->count;
    run->results = cli_arena_alloc(arena, (count + 1) * sizeof *run->results);
    run->queue = cli_arena_alloc(arena, (count + 1) * sizeof *run->queue);
    run->large = cli_arena_alloc(arena, (count + 1) * sizeof *run->large);
    run->locked = cli_arena_alloc(arena, (count + 1) * sizeof *run->locked);
    return !arena->failed;
}

int batch_run_all(batch_run *run)
{
    run->locks.fd = -1;
    if (!allocate(run)) {
        errno = ENOMEM;
        return refuse(run, run->plan->directory);
    }
    int status = open_state(run);
    if (status != CLI_DONE)
        return status;
    run->program = hash_program();
    run->threads = csgm_context_threads(run->app->context);
    pthread_mutex_init(&run->mutex, NULL);
    pthread_cond_init(&run->changed, NULL);
    batch_memo_init(&run->memo);
    if (batch_http_is_address(run->app->options->cache) && run->plan->count)
        run->remote = batch_remote_open(run);
    run_phases(run);
    batch_remote_close(run->remote);
    run->remote = NULL;
    batch_memo_release(&run->memo);
    pthread_cond_destroy(&run->changed);
    pthread_mutex_destroy(&run->mutex);
    batch_locks_close(&run->locks);
    return CLI_DONE;
}
