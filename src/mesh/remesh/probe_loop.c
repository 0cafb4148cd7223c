/* SPDX-License-Identifier: MIT
 * Stretches of numbers, taken by the pool; see probe_loop.h.
 */
#include "mesh/remesh/probe_loop.h"

#include "base/pool.h"

typedef struct probe_loop {
    csg_mesh_watch *watch;
    csg_probe *probes; /* one per thread */
    size_t count, stretch;
    csg_probe_visit *visit;
    void *user;
} probe_loop;

static bool visit_stretch(void *user, uint32_t worker, size_t item)
{
    const probe_loop *l = user;
    size_t first = item * l->stretch, left = l->count - first;
    if (csg_mesh_should_stop(l->watch))
        return false;
    l->visit(l->user, &l->probes[worker], first, first + (left < l->stretch ? left : l->stretch));
    return true;
}

/* All by the first probe. */
static bool visit_in_turn(probe_loop *l, size_t items)
{
    for (size_t i = 0; i < items; i++)
        if (!visit_stretch(l, 0, i))
            return false;
    return true;
}

bool csg_probe_loop(csg_mesh_watch *watch, const csg_marching *marching, size_t count,
                    size_t stretch, csg_probe_visit *visit, void *user)
{
    csgm_context *context = watch->context;
    csg_memory *memory = &context->memory;
    const uint32_t threads = csg_pool_threads(context->pool);
    const size_t items = (count + stretch - 1) / stretch;
    probe_loop l = {
        .watch = watch, .count = count, .stretch = stretch, .visit = visit, .user = user};
    if (!items)
        return true;
    l.probes = csg_memory_alloc(memory, threads * sizeof *l.probes);
    const uint32_t wanted = items > 1 ? threads : 1;
    uint32_t made = 0;
    while (l.probes && made < wanted && csg_probe_make(&l.probes[made], marching, memory))
        made++;
    bool done = !made            ? csg_mesh_stop_without_memory(watch)
                : made < threads ? visit_in_turn(&l, items) /* one, or little memory */
                                 : csg_pool_run(context->pool, items, visit_stretch, NULL, &l);
    for (uint32_t i = 0; i < made; i++)
        csg_probe_release(&l.probes[i]);
    csg_memory_release(memory, l.probes, threads * sizeof *l.probes);
    return done;
}
