/* SPDX-License-Identifier: MIT
 * A second build within the first, whose vertices are held against the first one's triangles; see
 * measure.h.
 */
#include "mesh/measure.h"

#include <math.h>

#include "base/pool.h"
#include "mesh/tolerance.h"

enum { VERTICES_OF_ITEM = 4096, ITEMS_MOST = 1 << 12 };

typedef struct measurer {
    const csg_mesh_work *work;
    const csg_remesh *remesh;
    uint64_t of_item;
    double most[ITEMS_MOST];
} measurer;

static csg_vec3 vertex_at(const csg_mesh_work *w, uint64_t i)
{
    const float *p = w->mesh->positions + 3 * i;
    csg_vec3 at = csg_vec3_make((double)p[0], (double)p[1], (double)p[2]);
    return csg_vec3_sub(at, w->marching.shift);
}

static bool measure_item(void *user, uint32_t worker, size_t item)
{
    measurer *m = user;
    uint64_t first = item * m->of_item, end = first + m->of_item;
    end = end < m->work->mesh->vertex_count ? end : m->work->mesh->vertex_count;
    double far = 2 * csg_lattice_extent(&m->work->lattice);
    for (uint64_t i = first; i < end; i++)
        m->most[item] = fmax(
            m->most[item], csg_crossing_distance(&m->remesh->crossing, vertex_at(m->work, i), far));
    return !csg_mesh_should_stop((void *)m->work);
}

csgm_status csg_mesh_measure_against(csg_mesh_work *w)
{
    measurer *m = csg_memory_alloc(&w->context->memory, sizeof *m);
    if (!m)
        return csg_context_no_memory(w->context);
    *m = (measurer){.work = w, .remesh = w->goal->against};
    uint64_t count = w->mesh->vertex_count;
    m->of_item = count / ITEMS_MOST + 1;
    m->of_item = m->of_item < VERTICES_OF_ITEM ? VERTICES_OF_ITEM : m->of_item;
    size_t items = (size_t)((count + m->of_item - 1) / m->of_item);
    bool done = csg_pool_run(w->context->pool, items, measure_item, NULL, m);
    for (size_t i = 0; i < items; i++)
        w->goal->measured = fmax(w->goal->measured, m->most[i]);
    csg_memory_release(&w->context->memory, m, sizeof *m);
    w->goal->cell_size = INFINITY; /* nothing is said of this mesh: it is only looked at */
    return done ? CSGM_OK : csg_mesh_why_stopped(w);
}

csgm_status csg_mesh_measure(const csg_remesh *r, double cell_size, double *distance)
{
    const csg_mesh_work *w = r->work;
    csgm_mesh_options options = *w->options;
    csg_mesh_goal goal = {.against = r, .started_s = w->goal->started_s};
    csgm_mesh *mesh = NULL;
    options.cell_size = cell_size;
    options.certify = false;
    options.colors = false;
    options.monitor.progress = NULL;
    csgm_status status =
        csg_mesh_build_with(w->context, w->field, &options, w->share, &goal, &mesh, NULL);
    csg_mesh_destroy(mesh);
    *distance = goal.measured;
    return status;
}
