/* SPDX-License-Identifier: MIT
 * Shards; see batch_shard.h. All is counted in whole microseconds and in hashes of our own (FNV-1a
 * and the last step of SplitMix64), so that any two machines and builds agree.
 */
#include "batch/batch_shard.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "batch/batch_lines.h"
#include "batch/batch_options.h"
#include "core/options.h"

static const uint64_t SECOND_US = 1000000;
static const uint64_t SLACK = 16; /* a shard may get a sixteenth above the average */

/* ---- hashes --------------------------------------------------------------------------- */

static const uint64_t HASH_START = 14695981039346656037u;

static uint64_t hash_bytes(uint64_t hash, const void *bytes, size_t count)
{
    const uint8_t *at = bytes;
    for (size_t i = 0; i < count; i++)
        hash = (hash ^ at[i]) * 1099511628211u;
    return hash;
}

/* With its end, so that neighbours do not run together. */
static void hash_text(void *hash, const char *text)
{
    uint64_t *at = hash;
    *at = hash_bytes(*at, text, strlen(text) + 1);
}

static void hash_number(uint64_t *hash, uint64_t number)
{
    uint8_t bytes[8];
    for (int i = 0; i < 8; i++)
        bytes[i] = (uint8_t)(number >> 8 * i);
    *hash = hash_bytes(*hash, bytes, sizeof bytes);
}

/* Every bit of the result depends on every bit of x. */
static uint64_t mixed(uint64_t x)
{
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9u;
    x = (x ^ x >> 27) * 0x94D049BB133111EBu;
    return x ^ x >> 31;
}

static uint64_t hash_of_job(const batch_job *job)
{
    uint64_t hash = HASH_START;
    for (size_t i = 0; i < job->names.count; i++)
        hash_text(&hash, job->names.items[i]);
    hash_text(&hash, job->by_part ? job->pattern : "");
    return mixed(hash);
}

static void print_hash(uint64_t hash, char text[BATCH_JOB_NAME])
{
    snprintf(text, BATCH_JOB_NAME, "%016" PRIx64, hash);
}

void batch_job_name(const batch_job *job, char name[BATCH_JOB_NAME])
{
    print_hash(hash_of_job(job), name);
}

void batch_shard_name(const batch_shard *shard, char name[BATCH_JOB_NAME])
{
    print_hash(shard->batch, name);
}

/* ---- which one ------------------------------------------------------------------------ */

/* A whole number of at most eight digits; *end: behind it. */
static bool read_number(const char *text, const char **end, uint32_t *out)
{
    size_t digits = strspn(text, "0123456789");
    *end = text + digits;
    *out = digits && digits <= 8 ? (uint32_t)strtoul(text, NULL, 10) : 0;
    return digits && digits <= 8;
}

/* A variable of the environment that is a whole number; `otherwise`: it is not there. */
static uint32_t environment(const char *name, uint32_t otherwise, bool *good)
{
    const char *text = getenv(name), *end;
    uint32_t number;
    if (!text || !*text)
        return otherwise;
    *good = *good && read_number(text, &end, &number) && !*end;
    return *good ? number : 0;
}

/* Task ARRAY of an array's COUNT, and process PROC of the step's TASKS within it. */
static bool read_slurm(batch_shard *out)
{
    const uint32_t none = UINT32_MAX;
    bool good = true;
    uint32_t task = environment("SLURM_ARRAY_TASK_ID", none, &good);
    uint32_t first = environment("SLURM_ARRAY_TASK_MIN", 0, &good);
    uint32_t step = environment("SLURM_ARRAY_TASK_STEP", 1, &good);
    uint32_t count = environment("SLURM_ARRAY_TASK_COUNT", none, &good);
    uint32_t tasks = environment("SLURM_STEP_NUM_TASKS", 1, &good);
    uint32_t process = tasks > 1 ? environment("SLURM_PROCID", none, &good) : 0;
    bool is_array = task != none;
    if (!good || !step || !tasks || (is_array && (count == none || task < first)) ||
        (!is_array && tasks == 1))
        return false;
    uint64_t place = is_array ? (task - first) / step : 0, places = is_array ? count : 1;
    if (places * tasks > BATCH_SHARDS_MOST || place >= places || process >= tasks)
        return false;
    out->index = (uint32_t)(place * tasks + process + 1);
    out->count = (uint32_t)(places * tasks);
    return true;
}

/* A rank of an MPI job, as its launcher names it to the processes that it starts: no MPI is needed
 * to read that, and processes that tell each other nothing need no more of it. */
static bool read_mpi(batch_shard *out)
{
    static const char *const launchers[][2] = {
        {"OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE"}, /* Open MPI */
        {"PMI_RANK", "PMI_SIZE"},                         /* Hydra: MPICH, Intel MPI */
    };
    const uint32_t none = UINT32_MAX;
    for (size_t i = 0; i < sizeof launchers / sizeof *launchers; i++) {
        bool good = true;
        uint32_t rank = environment(launchers[i][0], none, &good);
        uint32_t ranks = environment(launchers[i][1], none, &good);
        if (good && rank == none && ranks == none)
            continue;
        if (!good || ranks > BATCH_SHARDS_MOST || rank >= ranks)
            return false;
        *out = (batch_shard){.index = rank + 1, .count = ranks};
        return true;
    }
    return false;
}

int batch_shard_read(cli_app *app, batch_shard *out)
{
    const char *text = app->options->shard, *slash, *end;
    *out = (batch_shard){.index = 1, .count = 1};
    if (!text)
        return CLI_DONE;
    if (strcmp(text, "slurm") == 0)
        return read_slurm(out)
                   ? CLI_DONE
                   : cli_usage_error(app, "or name the shard yourself, as --shard 3/8",
                                     "--shard slurm: the environment has no task of a Slurm array "
                                     "(SLURM_ARRAY_TASK_ID, _MIN and _COUNT) or step "
                                     "(SLURM_PROCID, SLURM_STEP_NUM_TASKS)");
    if (strcmp(text, "mpi") == 0)
        return read_mpi(out) ? CLI_DONE
                             : cli_usage_error(app, "or name the shard yourself, as --shard 3/8",
                                               "--shard mpi: the environment has no rank of a job "
                                               "of mpirun (OMPI_COMM_WORLD_RANK and _SIZE, or "
                                               "PMI_RANK and PMI_SIZE)");
    if (!read_number(text, &slash, &out->index) || *slash != '/' ||
        !read_number(slash + 1, &end, &out->count) || *end)
        return cli_usage_error(app, "as --shard 3/8", "--shard wants I/N, not '%.80s'", text);
    if (out->count < 1 || out->count > BATCH_SHARDS_MOST)
        return cli_usage_error(app, NULL, "--shard: N is from 1 to %d, not %" PRIu32,
                               BATCH_SHARDS_MOST, out->count);
    if (out->index < 1 || out->index > out->count)
        return cli_usage_error(app, NULL,
                               "--shard: there is no shard %" PRIu32 " of %" PRIu32
                               ", they count from 1 to %" PRIu32,
                               out->index, out->count, out->count);
    return CLI_DONE;
}

/* ---- costs ---------------------------------------------------------------------------- */

typedef struct weight {
    uint64_t job;  /* hash */
    uint64_t cost; /* millionths of a second of one thread; 0: not known */
    size_t at;     /* in the plan, or the line of the report */
    uint32_t shard;
} weight;

typedef struct weights {
    cli_arena *arena;
    weight *items;
    size_t count;
} weights;

static int by_job(const void *a, const void *b)
{
    const weight *left = a, *right = b;
    if (left->job != right->job)
        return left->job < right->job ? -1 : 1;
    return left->at < right->at ? -1 : left->at > right->at;
}

static int take_time(void *user, const batch_line *line)
{
    weights *times = user;
    const double longest_s = 1e9;
    const char *name = batch_line_text(line->object, "job");
    double seconds = batch_line_number(line->object, "cpu_seconds");
    if (!name || !(seconds > 0))
        return CLI_DONE;
    seconds = seconds < longest_s ? seconds : longest_s;
    uint64_t cost = (uint64_t)(seconds * 1e6);
    weight *place =
        cli_arena_push(times->arena, (void **)&times->items, &times->count, sizeof *place);
    if (place)
        *place = (weight){strtoull(name, NULL, 16), cost ? cost : 1, line->number, 0};
    return CLI_DONE;
}

/* The last that was said of the job. */
static uint64_t time_of(const weights *times, uint64_t job)
{
    size_t low = 0, high = times->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (times->items[middle].job <= job)
            low = middle + 1;
        else
            high = middle;
    }
    return low && times->items[low - 1].job == job ? times->items[low - 1].cost : 0;
}

static int by_cost(const void *a, const void *b)
{
    const weight *left = a, *right = b;
    if (left->cost != right->cost)
        return left->cost > right->cost ? -1 : 1;
    return by_job(a, b);
}

/* What no report has the time of is supposed to be as the middle one of those that it has. Longest
 * first; the same order on every machine, whatever that of the plan. */
static void settle_costs(weights *jobs, const weights *times)
{
    size_t known = 0;
    for (size_t i = 0; i < jobs->count; i++) {
        jobs->items[i].cost = time_of(times, jobs->items[i].job);
        known += jobs->items[i].cost > 0;
    }
    qsort(jobs->items, jobs->count, sizeof *jobs->items, by_cost);
    uint64_t middle = known ? jobs->items[known / 2].cost : SECOND_US;
    for (size_t i = known; i < jobs->count; i++)
        jobs->items[i].cost = middle;
    qsort(jobs->items, jobs->count, sizeof *jobs->items, by_cost);
}

/* ---- shares --------------------------------------------------------------------------- */

/* From the longest job to the shortest, each to the shard that likes it best of those with room,
 * where none has room to the one that has least. loads: zeroed, for each shard. */
static void assign(const weights *jobs, uint32_t count, uint64_t *loads)
{
    uint64_t total = 0;
    for (size_t i = 0; i < jobs->count; i++)
        total += jobs->items[i].cost;
    uint64_t room = total / count + total / count / SLACK;
    for (size_t i = 0; i < jobs->count; i++) {
        weight *job = &jobs->items[i];
        uint32_t best = count, least = 0;
        uint64_t most_liked = 0, least_liked = 0;
        for (uint32_t s = 0; s < count; s++) {
            uint64_t liking = mixed(job->job + (s + 1) * 0x9E3779B97F4A7C15u);
            if (loads[s] + job->cost <= room && (best == count || liking > most_liked)) {
                best = s;
                most_liked = liking;
            }
            if (s == 0 || loads[s] < loads[least] ||
                (loads[s] == loads[least] && liking > least_liked)) {
                least = s;
                least_liked = liking;
            }
        }
        best = best == count ? least : best;
        loads[best] += job->cost;
        job->shard = best + 1;
    }
}

/* Which batch it is: its jobs, what they are made with, and how they are shared out. */
static uint64_t hash_of_batch(const batch_plan *plan, const weights *jobs)
{
    uint64_t hash = HASH_START;
    hash_number(&hash, plan->shard.count);
    for (size_t i = 0; i < jobs->count; i++) {
        hash_number(&hash, jobs->items[i].job);
        hash_number(&hash, jobs->items[i].cost);
        batch_settings_visit(plan->jobs[jobs->items[i].at].settings, hash_text, &hash);
    }
    return mixed(hash);
}

/* The jobs of other shards are forgotten. */
static void keep_own(batch_plan *plan, const weights *jobs, bool *is_own)
{
    size_t kept = 0;
    for (size_t i = 0; i < jobs->count; i++)
        is_own[jobs->items[i].at] = jobs->items[i].shard == plan->shard.index;
    for (size_t i = 0; i < plan->count; i++)
        if (is_own[i])
            plan->jobs[kept++] = plan->jobs[i];
        else
            cli_options_release(plan->jobs[i].options);
    plan->count = kept;
}

int batch_shard_choose(batch_plan *plan)
{
    cli_app *app = plan->app;
    cli_arena *arena = &plan->arena;
    weights times = {.arena = arena}, jobs = {.arena = arena, .count = plan->count};
    int status = CLI_DONE;
    if (app->options->times)
        status = batch_lines_read(app, app->options->times, take_time, &times);
    if (status != CLI_DONE)
        return status;
    uint64_t *loads = cli_arena_alloc(arena, plan->shard.count * sizeof *loads);
    bool *is_own = cli_arena_alloc(arena, plan->count + 1);
    jobs.items = cli_arena_alloc(arena, (plan->count + 1) * sizeof *jobs.items);
    if (arena->failed) {
        cli_console_say(&app->console, CSGM_ERROR, NULL, "out of memory");
        return CLI_TROUBLE;
    }
    for (size_t i = 0; i < plan->count; i++) {
        plan->jobs[i].number = i + 1;
        jobs.items[i] = (weight){.job = hash_of_job(&plan->jobs[i]), .at = i};
    }
    if (times.count)
        qsort(times.items, times.count, sizeof *times.items, by_job);
    settle_costs(&jobs, &times);
    assign(&jobs, plan->shard.count, loads);
    plan->shard.all = plan->count;
    plan->shard.batch = hash_of_batch(plan, &jobs);
    keep_own(plan, &jobs, is_own);
    return CLI_DONE;
}
