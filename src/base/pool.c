/* SPDX-License-Identifier: MIT
 * A pool of POSIX threads; see pool.h. One job at a time: workers sleep on `wake` until the job
 * number changes, claim items from an atomic counter, and the last one out signals `idle`.
 */
#include "base/pool.h"

#include <pthread.h>
#include <stdatomic.h>

#include "base/trace.h"

typedef struct job {
    csg_pool_work *work;
    void *user;
    size_t count;
    const char *zone; /* of a trace */
} job;

typedef struct worker {
    csg_pool *pool;
    uint32_t index;
    uint64_t seen; /* the last job before it was started */
    pthread_t thread;
} worker;

struct csg_pool {
    csg_memory *memory;
    csg_trace_lanes *trace; /* NULL = none */
    uint32_t threads;       /* with the caller */
    uint32_t running;       /* workers that there are: threads - 1, or 0 while the pool rests */
    pthread_mutex_t lock;
    pthread_cond_t wake, idle;
    uint64_t generation; /* of the job; under lock */
    uint32_t busy;       /* workers still in the job; under lock */
    bool quit;           /* under lock */
    job job;             /* written under lock, before generation changes */
    atomic_size_t next, done;
    atomic_bool stopped;
    uint32_t allocated; /* length of workers */
    worker workers[];
};

static void run_item(csg_pool *pool, uint32_t worker_index, size_t index)
{
    if (!pool->job.work(pool->job.user, worker_index, index))
        atomic_store(&pool->stopped, true);
    atomic_fetch_add(&pool->done, 1);
}

static bool claim(csg_pool *pool, size_t *index)
{
    if (atomic_load_explicit(&pool->stopped, memory_order_relaxed))
        return false;
    *index = atomic_fetch_add(&pool->next, 1);
    return *index < pool->job.count;
}

/* Items until there are none left. */
static void work_on_items(csg_pool *pool, uint32_t worker_index, csg_pool_poll *poll)
{
    csg_trace_loop loop = {0};
    size_t index, items = 0;
    if (pool->trace)
        loop = csg_trace_loop_begin(pool->job.zone);
    for (; claim(pool, &index); items++) {
        run_item(pool, worker_index, index);
        if (poll)
            poll(pool->job.user, atomic_load(&pool->done), pool->job.count);
    }
    if (pool->trace && items)
        csg_trace_loop_end(pool->trace, worker_index, &loop, items);
}

static void *worker_main(void *argument)
{
    worker *self = argument;
    csg_pool *pool = self->pool;
    uint64_t seen = self->seen;
    pthread_mutex_lock(&pool->lock);
    for (;;) {
        while (!pool->quit && pool->generation == seen)
            pthread_cond_wait(&pool->wake, &pool->lock);
        if (pool->quit)
            break;
        seen = pool->generation;
        pthread_mutex_unlock(&pool->lock);
        work_on_items(pool, self->index, NULL);
        pthread_mutex_lock(&pool->lock);
        if (--pool->busy == 0)
            pthread_cond_signal(&pool->idle);
    }
    pthread_mutex_unlock(&pool->lock);
    return NULL;
}

static size_t pool_bytes(uint32_t workers)
{
    return sizeof(csg_pool) + workers * sizeof(worker);
}

static void start_workers(csg_pool *pool, uint32_t count)
{
    for (pool->running = 0; pool->running < count; pool->running++) {
        worker *w = &pool->workers[pool->running];
        *w = (worker){.pool = pool, .index = pool->running + 1, .seen = pool->generation};
        if (pthread_create(&w->thread, NULL, worker_main, w) != 0)
            break; /* fewer workers give the same bytes */
    }
}

void csg_pool_rest(csg_pool *pool)
{
    pthread_mutex_lock(&pool->lock);
    pool->quit = true;
    pthread_cond_broadcast(&pool->wake);
    pthread_mutex_unlock(&pool->lock);
    for (uint32_t i = 0; i < pool->running; i++)
        pthread_join(pool->workers[i].thread, NULL);
    pool->running = 0;
    pool->quit = false;
}

csg_pool *csg_pool_create(csg_memory *memory, uint32_t threads)
{
    uint32_t extra = threads > 1 ? threads - 1 : 0;
    csg_pool *pool = csg_memory_alloc(memory, pool_bytes(extra));
    if (!pool)
        return NULL;
    *pool = (csg_pool){.memory = memory, .allocated = extra};
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->wake, NULL);
    pthread_cond_init(&pool->idle, NULL);
    start_workers(pool, extra);
    pool->threads = 1 + pool->running;
    return pool;
}

void csg_pool_destroy(csg_pool *pool)
{
    if (!pool)
        return;
    csg_pool_rest(pool);
    pthread_cond_destroy(&pool->idle);
    pthread_cond_destroy(&pool->wake);
    pthread_mutex_destroy(&pool->lock);
    csg_memory_release(pool->memory, pool, pool_bytes(pool->allocated));
}

uint32_t csg_pool_threads(const csg_pool *pool)
{
    return pool->threads;
}

void csg_pool_set_trace(csg_pool *pool, csg_trace_lanes *lanes)
{
    pool->trace = lanes; /* workers look after the lock that gives them a job */
}

bool csg_pool_run(csg_pool *pool, size_t count, csg_pool_work *work, csg_pool_poll *poll,
                  void *user)
{
    if (!pool->running && pool->threads > 1 && count > 1)
        start_workers(pool, pool->threads - 1);
    pthread_mutex_lock(&pool->lock);
    pool->job = (job){work, user, count, pool->trace ? csg_trace_open_name(pool->trace) : NULL};
    atomic_store(&pool->next, 0);
    atomic_store(&pool->done, 0);
    atomic_store(&pool->stopped, false);
    bool alone = pool->running == 0 || count < 2;
    if (!alone) {
        pool->busy = pool->running;
        pool->generation++;
        pthread_cond_broadcast(&pool->wake);
    }
    pthread_mutex_unlock(&pool->lock);
    work_on_items(pool, 0, poll);
    if (!alone) {
        pthread_mutex_lock(&pool->lock);
        while (pool->busy)
            pthread_cond_wait(&pool->idle, &pool->lock);
        pthread_mutex_unlock(&pool->lock);
    }
    return !atomic_load(&pool->stopped);
}
