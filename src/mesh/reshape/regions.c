/* SPDX-License-Identifier: MIT
 * Thinning out on all threads; see decimate.h. Space is cut into cubes, an octree of those that
 * hold many triangles. What lies in a cube with all that it meets in a vertex is changed there, and
 * new triangles stay in it: so nothing of one cube ever meets what another changes, and each is
 * done on any thread, of any rank. Triangles that lie across the sides of cubes stay as they are;
 * the cubes that come next are shifted by a third of their size, and the last one holds everything.
 * Which cubes there are depends on the mesh and its place alone: so does the result.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/elementary.h"
#include "base/trace.h"
#include "field/field.h"
#include "mesh/reshape/decimate.h"
#include "mesh/reshape/region_record.h"

enum { MOST_OF_REGION = 10000, DEEPEST = 16, ROUNDS = 3 };
/* csg_triangle_quality of triangles that may be made. */
static const double LEAST_QUALITY = 0.004, LEAST_QUALITY_AT_LAST = 0.0003;
static const double ROUND_SHARE = 0.2; /* of what is left of the stage, for progress */

/* A cube and the triangles that meet it; those in it are changed there. */
typedef struct region {
    size_t first;
    uint32_t count;
    csg_vec3 low, high;
    uint32_t removed;                    /* of the triangles */
    uint32_t first_vertex, vertex_count; /* in cutting.vertices */
} region;

/* What one thread needs: its own view of the mesh, whose arrays are shared. */
typedef struct worker {
    csg_remesh remesh;
    csg_decimation decimation;
    csg_collapse_queue queue;
    csg_collapse_room *room;
} worker;

typedef struct cutting {
    csg_decimation *d;
    uint32_t *slots;     /* per triangle: where it stands among those of its region */
    uint32_t *inside;    /* per triangle: the region, NONE: across */
    uint32_t *region_of; /* per vertex */
    uint32_t *items;     /* the triangles of one region after another */
    size_t item_count, item_capacity;
    region *regions;
    size_t region_count, region_capacity;
    size_t *order; /* of regions: those of most triangles first */
    size_t order_capacity;
    uint32_t *vertices; /* of one region after another; NULL: nobody else has to be told */
    uint32_t *version;  /* per vertex, before the round; NULL likewise */
    csg_arena arena;
    worker *workers;
    uint32_t worker_count;
    atomic_int status;
    bool is_reported; /* what has ended it */
} cutting;

/* ---- cubes -------------------------------------------------------------------------------------
 */

/* Triangles in one cube keep clear of those in the next by more than rounding. */
static double margin_of(const csg_remesh *r)
{
    return 2 * r->tree.noise;
}

static bool is_in(const csg_triangle_box *box, csg_vec3 low, csg_vec3 high)
{
    return (double)box->min[0] > low.x && (double)box->max[0] < high.x &&
           (double)box->min[1] > low.y && (double)box->max[1] < high.y &&
           (double)box->min[2] > low.z && (double)box->max[2] < high.z;
}

/* It would take as much as a triangle's corners if it were kept. */
static csg_triangle_box box_of(const cutting *c, uint32_t triangle)
{
    csg_vec3 v[3];
    csg_triangle_tree_corners(&c->d->remesh->tree, triangle, v);
    return csg_triangle_box_of(v);
}

static bool add_region(cutting *c, const uint32_t *ids, uint32_t count, csg_vec3 low, csg_vec3 high)
{
    csg_memory *memory = c->d->remesh->memory;
    if (!csg_memory_reserve(memory, (void **)&c->regions, &c->region_capacity, c->region_count + 1,
                            sizeof *c->regions) ||
        !csg_memory_reserve(memory, (void **)&c->items, &c->item_capacity, c->item_count + count,
                            sizeof *c->items))
        return false;
    double margin = margin_of(c->d->remesh);
    csg_vec3 by = {margin, margin, margin};
    csg_box box = csg_box_intersect((csg_box){low, high}, (csg_box){c->d->low, c->d->high});
    region *new = &c->regions[c->region_count];
    *new = (region){
        c->item_count, count, csg_vec3_add(box.min, by), csg_vec3_sub(box.max, by), 0, 0, 0};
    memcpy(c->items + c->item_count, ids, count * sizeof *ids);
    for (uint32_t i = 0; i < count; i++) {
        csg_triangle_box own = box_of(c, ids[i]);
        if (!is_in(&own, new->low, new->high))
            continue;
        c->inside[ids[i]] = (uint32_t)c->region_count;
        c->slots[ids[i]] = i;
    }
    c->item_count += count;
    c->region_count++;
    return true;
}

/* Where the lower and the upper half of a cube begin and end along each axis. */
typedef struct halves {
    double low[3][2], high[3][2];
} halves;

static halves halves_of(csg_vec3 low, double half)
{
    const double from[3] = {low.x, low.y, low.z};
    halves h;
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < 2; i++) {
            h.low[axis][i] = from[axis] + i * half;
            h.high[axis][i] = h.low[axis][i] + half;
        }
    return h;
}

/* A bit for each of a cube's eighths that the box meets. */
static uint8_t eighths_met(const halves *h, const csg_triangle_box *box)
{
    static const uint8_t beside[3][2] = {{0x55, 0xAA}, {0x33, 0xCC}, {0x0F, 0xF0}};
    unsigned met = 0xFF;
    for (int axis = 0; axis < 3; axis++) {
        bool lower =
            (double)box->max[axis] >= h->low[axis][0] && (double)box->min[axis] <= h->high[axis][0];
        bool upper =
            (double)box->max[axis] >= h->low[axis][1] && (double)box->min[axis] <= h->high[axis][1];
        met &= (lower ? beside[axis][0] : 0u) | (upper ? beside[axis][1] : 0u);
    }
    return (uint8_t)met;
}

/* Cuts the cube that these triangles meet into eighths, and those that many of them meet again.
 * half: the side of an eighth. Boxes are asked for once for all eight. */
static bool cut(cutting *c, const uint32_t *ids, uint32_t count, csg_vec3 low, double half,
                int depth)
{
    const halves h = halves_of(low, half);
    csg_arena_mark mark = csg_arena_get_mark(&c->arena);
    uint32_t meeting[CSG_OCTANTS] = {0};
    uint8_t *met = csg_arena_alloc(&c->arena, count);
    bool done = met != NULL;
    for (uint32_t i = 0; done && i < count; i++) {
        csg_triangle_box box = box_of(c, ids[i]);
        met[i] = eighths_met(&h, &box);
        for (int o = 0; o < CSG_OCTANTS; o++)
            meeting[o] += met[i] >> o & 1;
    }
    for (int o = 0; o < CSG_OCTANTS && done; o++) {
        const int x = o & 1, y = o >> 1 & 1, z = o >> 2;
        csg_vec3 from = {h.low[0][x], h.low[1][y], h.low[2][z]};
        csg_arena_mark before = csg_arena_get_mark(&c->arena);
        uint32_t n = 0, *own = csg_arena_alloc(&c->arena, meeting[o] * sizeof *own);
        done = own != NULL;
        for (uint32_t i = 0; done && n < meeting[o]; i++)
            if (met[i] >> o & 1)
                own[n++] = ids[i];
        if (done && n && (n <= MOST_OF_REGION || depth == DEEPEST))
            done = add_region(c, own, n, from,
                              csg_vec3_make(h.high[0][x], h.high[1][y], h.high[2][z]));
        else if (done && n)
            done = cut(c, own, n, from, half / 2, depth + 1);
        csg_arena_release_to(&c->arena, before);
    }
    csg_arena_release_to(&c->arena, mark);
    return done;
}

/* The first cubes are eighths of one that holds all: places and sizes do not depend on how large
 * the mesh is, but for a factor of two. */
static bool cut_all(cutting *c, uint32_t *ids, uint32_t count, const csg_triangle_box *all,
                    int round)
{
    const csg_remesh *r = c->d->remesh;
    csg_vec3 center = r->marching->field->center;
    const double middle[3] = {center.x, center.y, center.z};
    double extent = 0, from[3], side = 1;
    for (int k = 0; k < 3; k++)
        extent = fmax(extent, (double)all->max[k] - (double)all->min[k]);
    side = ldexp(1, (int)ceil(csg_log2(fmax(extent, 1e-30))));
    for (int k = 0; k < 3; k++) {
        double shift = side * (0.29 + round / 3.0) - middle[k], begin = (double)all->min[k] - shift;
        from[k] = floor(begin / side) * side + shift;
    }
    return cut(c, ids, count, csg_vec3_make(from[0], from[1], from[2]), side, 0);
}

/* ---- whose vertex is it ------------------------------------------------------------------------
 */

/* A vertex belongs to a region if all its triangles do. */
static void share_out(cutting *c)
{
    enum { NOT_MET = CSG_CORNER_NONE - 1 };
    const csg_corners *m = &c->d->remesh->corners;
    for (uint32_t v = 0; v < m->vertex_count; v++)
        c->region_of[v] = (uint32_t)NOT_MET;
    for (uint32_t t = 0; t < m->triangle_count; t++)
        for (uint32_t k = 3 * t; k < 3 * t + 3 && csg_corners_is_live(m, t); k++) {
            uint32_t *of = &c->region_of[m->vertex[k]];
            *of = *of == (uint32_t)NOT_MET || *of == c->inside[t] ? c->inside[t] : CSG_CORNER_NONE;
        }
    for (uint32_t v = 0; v < m->vertex_count; v++)
        if (c->d->state[v] == CSG_VERTEX_HELD_UP)
            c->d->state[v] = CSG_VERTEX_FRESH;
}

static bool make_cubes(cutting *c, int round)
{
    const csg_remesh *r = c->d->remesh;
    uint32_t count = r->corners.triangle_count, n = 0;
    uint32_t *live = csg_arena_alloc(&c->arena, r->corners.live * sizeof *live);
    if (!live)
        return false;
    c->item_count = c->region_count = 0;
    csg_triangle_box all = csg_triangle_box_nothing();
    for (uint32_t t = 0; t < count; t++) {
        c->inside[t] = CSG_CORNER_NONE;
        if (!csg_corners_is_live(&r->corners, t) || t < r->closing)
            continue;
        csg_triangle_box own = box_of(c, t);
        all = csg_triangle_box_around(&all, &own);
        live[n++] = t;
    }
    bool done = cut_all(c, live, n, &all, round);
    csg_arena_reset(&c->arena);
    if (done)
        share_out(c);
    return done;
}

/* ---- one region --------------------------------------------------------------------------------
 */

static bool thin_out_region(void *user, uint32_t worker_index, size_t place)
{
    cutting *c = user;
    size_t index = c->order[place];
    worker *w = &c->workers[worker_index];
    const csg_remesh *whole = c->d->remesh;
    region *g = &c->regions[index];
    const uint32_t *items = c->items + g->first;
    w->remesh.corners = whole->corners;
    w->remesh.error = whole->error;
    w->decimation.region = (uint32_t)index;
    w->decimation.low = g->low;
    w->decimation.high = g->high;
    csgm_status status = CSGM_ERR_MEMORY;
    if (csg_triangle_tree_make_of(&w->remesh.tree, &whole->tree, &w->remesh.corners, items,
                                  g->count, c->slots))
        status = csg_decimate_region(&w->decimation, items, g->count, 0);
    g->removed = whole->corners.live - w->remesh.corners.live;
    if (status == CSGM_OK)
        return true;
    atomic_store(&c->status, (int)status);
    return false;
}

/* Collapses leave boxes larger than they have to be; those in cubes leave them out of date. */
static csgm_status make_tree_again(csg_remesh *r)
{
    csg_triangle_tree_release(&r->tree);
    return csg_triangle_tree_make(&r->tree, &r->corners, r->at) ? CSGM_OK : CSGM_ERR_MEMORY;
}

static void report_regions(void *user, size_t done, size_t count)
{
    const cutting *c = user;
    csg_mesh_report_progress(c->d->remesh->watch, (double)done / (double)count);
}

typedef struct weighed {
    uint32_t count;
    size_t index;
} weighed;

static int compare_weighed(const void *a, const void *b)
{
    const weighed *p = a, *q = b;
    int order = (p->count < q->count) - (p->count > q->count);
    return order ? order : (p->index > q->index) - (p->index < q->index);
}

/* The order in which regions are taken, and shared out: so nobody has much more than others. */
static bool order_regions(cutting *c)
{
    csg_memory *memory = c->d->remesh->memory;
    weighed *each = csg_arena_alloc(&c->arena, c->region_count * sizeof *each);
    if (!each || !csg_memory_reserve(memory, (void **)&c->order, &c->order_capacity,
                                     c->region_count, sizeof *c->order))
        return false;
    for (size_t i = 0; i < c->region_count; i++)
        each[i] = (weighed){c->regions[i].count, i};
    qsort(each, c->region_count, sizeof *each, compare_weighed);
    for (size_t i = 0; i < c->region_count; i++)
        c->order[i] = each[i].index;
    csg_arena_reset(&c->arena);
    return true;
}

/* ---- what other ranks have made of theirs ------------------------------------------------------
 */

/* The vertices of each region, and how they are before it is changed. */
static void note_before(cutting *c)
{
    const csg_corners *m = &c->d->remesh->corners;
    uint32_t first = 0;
    memcpy(c->version, c->d->version, m->vertex_count * sizeof *c->version);
    for (uint32_t v = 0; v < m->vertex_count; v++)
        if (c->region_of[v] < c->region_count)
            c->regions[c->region_of[v]].vertex_count++;
    for (size_t i = 0; i < c->region_count; i++) {
        c->regions[i].first_vertex = first;
        first += c->regions[i].vertex_count;
        c->regions[i].vertex_count = 0;
    }
    for (uint32_t v = 0; v < m->vertex_count; v++)
        if (c->region_of[v] < c->region_count) {
            region *g = &c->regions[c->region_of[v]];
            c->vertices[g->first_vertex + g->vertex_count++] = v;
        }
}

static csg_region_of_mesh region_of_mesh(const cutting *c, size_t index)
{
    const region *g = &c->regions[index];
    return (csg_region_of_mesh){.decimation = c->d,
                                .triangles = c->items + g->first,
                                .inside = c->inside,
                                .vertices = c->vertices + g->first_vertex,
                                .version = c->version,
                                .region = (uint32_t)index,
                                .triangle_count = g->count,
                                .vertex_count = g->vertex_count};
}

static csgm_status report_end(const csg_remesh *r, csgm_status status)
{
    return status == CSGM_ERR_MEMORY  ? csg_context_no_memory(r->context)
           : status == CSGM_CANCELLED ? csg_mesh_why_stopped(r->watch)
                                      : status;
}

/* Records of this rank's regions to all, and theirs taken over. */
static csgm_status exchange_regions(cutting *c, csgm_status own)
{
    csgm_context *context = c->d->remesh->context;
    csg_records records = {0};
    csg_record_reader reader;
    for (size_t i = 0; i < c->region_count && own == CSGM_OK; i++) {
        if (!csg_ranks_have(context, i))
            continue;
        csg_region_of_mesh g = region_of_mesh(c, c->order[i]);
        if (!csg_records_add(&context->memory, &records, &c->regions[g.region].removed,
                             sizeof(uint32_t)) ||
            !csg_region_pack(&g, &records))
            own = csg_context_no_memory(context);
    }
    csgm_status status = csg_ranks_exchange(context, own, c->region_count, &records, &reader);
    for (size_t i = 0; i < c->region_count && status == CSGM_OK; i++) {
        if (csg_ranks_have(context, i))
            continue;
        csg_region_of_mesh g = region_of_mesh(c, c->order[i]);
        csg_record_read(&reader, i, &c->regions[g.region].removed, sizeof(uint32_t));
        csg_region_unpack(&g, &reader, i);
    }
    csg_record_reader_end(&context->memory, &reader);
    return status;
}

/* ---- rounds ------------------------------------------------------------------------------------
 */

static csgm_status run_round(cutting *c, int round, double share)
{
    csg_remesh *r = c->d->remesh;
    if (!make_cubes(c, round) || !order_regions(c))
        return CSGM_ERR_MEMORY;
    bool shares = csg_ranks_share(r->context, c->region_count, CSG_ITEMS_LARGE);
    if (shares)
        note_before(c);
    c->d->region_of = c->region_of;
    for (uint32_t i = 0; i < c->worker_count; i++)
        c->workers[i].decimation.region_of = c->region_of;
    csg_mesh_take(r->watch, CSGM_STAGE_RESHAPE, share);
    csgm_status status = CSGM_OK;
    if (!csg_ranks_run(r->context, c->region_count, CSG_ITEMS_LARGE, thin_out_region,
                       report_regions, c))
        status = (csgm_status)atomic_load(&c->status);
    if (shares) {
        status = exchange_regions(c, report_end(r, status));
        c->is_reported = status != CSGM_OK;
    }
    for (size_t i = 0; i < c->region_count && status == CSGM_OK; i++)
        r->corners.live -= c->regions[i].removed;
    return status;
}

/* What is left, as one region. */
static csgm_status run_last(cutting *c, uint32_t least)
{
    csg_decimation *d = c->d;
    const csg_corners *m = &d->remesh->corners;
    memset(c->region_of, 0, m->vertex_count * sizeof *c->region_of);
    for (uint32_t v = 0; v < m->vertex_count; v++)
        if (d->state[v] == CSG_VERTEX_HELD_UP)
            d->state[v] = CSG_VERTEX_FRESH;
    d->region_of = c->region_of;
    d->region = 0;
    d->low = csg_vec3_make(-INFINITY, -INFINITY, -INFINITY);
    d->high = csg_vec3_make(INFINITY, INFINITY, INFINITY);
    return csg_decimate_region(d, NULL, m->triangle_count, least);
}

/* Once more with all that is left, which is little: now slivers may be made on the way to fewer
 * triangles. Places where a crease was missed, by less than the error, go like that. */
static csgm_status run_loosened(cutting *c, uint32_t least)
{
    csg_decimation *d = c->d;
    d->least_quality = LEAST_QUALITY_AT_LAST;
    for (uint32_t v = 0; v < d->remesh->corners.vertex_count; v++)
        if (d->state[v] == CSG_VERTEX_SLIVERED)
            d->state[v] = CSG_VERTEX_FRESH;
    csgm_status status = CSGM_OK;
    bool any = true;
    for (int round = 0; round < ROUNDS && any && status == CSGM_OK; round++) {
        status = csg_decimation_loosen(d, &any) ? CSGM_OK : CSGM_CANCELLED;
        if (status == CSGM_OK && (any || round == 0))
            status = run_last(c, least);
    }
    return status;
}

/* ---- beginning and ending ----------------------------------------------------------------------
 */

static bool begin_worker(cutting *c, worker *w)
{
    const csg_remesh *whole = c->d->remesh;
    *w = (worker){.remesh = *whole, .decimation = *c->d};
    w->remesh.tree = (csg_triangle_tree){0};
    w->room = csg_memory_alloc(whole->memory, sizeof *w->room);
    if (w->room)
        memset(w->room, 0, sizeof *w->room);
    w->decimation.remesh = &w->remesh;
    w->decimation.queue = &w->queue;
    w->decimation.room = w->room;
    w->decimation.tried = w->decimation.made = 0;
    return csg_probe_make(&w->remesh.probe, whole->marching, whole->memory) && w->room;
}

static void end_worker(worker *w, csg_memory *memory)
{
    csg_triangle_tree_release(&w->remesh.tree);
    csg_probe_release(&w->remesh.probe);
    csg_memory_release(memory, w->queue.heap, w->queue.capacity * sizeof *w->queue.heap);
    if (w->room)
        csg_memory_release(memory, w->room->owner, w->room->owner_capacity * sizeof(uint32_t));
    csg_memory_release(memory, w->room, sizeof *w->room);
}

static bool begin(cutting *c, bool in_cubes)
{
    const csg_remesh *r = c->d->remesh;
    size_t triangles = r->corners.triangle_count, vertices = r->corners.vertex_count;
    csg_memory *memory = r->memory;
    csg_arena_init(&c->arena, memory);
    c->region_of = csg_memory_alloc(memory, vertices * sizeof *c->region_of);
    if (!c->region_of || !in_cubes)
        return c->region_of != NULL;
    c->slots = csg_memory_alloc(memory, triangles * sizeof *c->slots);
    c->inside = csg_memory_alloc(memory, triangles * sizeof *c->inside);
    c->worker_count = csg_pool_threads(r->context->pool);
    c->workers = csg_memory_alloc(memory, c->worker_count * sizeof *c->workers);
    bool done = c->slots && c->inside && c->workers;
    if (r->context->ranks) {
        c->vertices = csg_memory_alloc(memory, vertices * sizeof *c->vertices);
        c->version = csg_memory_alloc(memory, vertices * sizeof *c->version);
        done = done && c->vertices && c->version;
    }
    for (uint32_t i = 0; c->workers && i < c->worker_count; i++)
        done = begin_worker(c, &c->workers[i]) && done;
    return done;
}

/* What is needed for cubes alone: what comes after them needs as much. */
static void end_cubes(cutting *c)
{
    const csg_remesh *r = c->d->remesh;
    size_t triangles = r->corners.triangle_count, vertices = r->corners.vertex_count;
    csg_memory *memory = r->memory;
    for (uint32_t i = 0; c->workers && i < c->worker_count; i++) {
        c->d->tried += c->workers[i].decimation.tried;
        c->d->made += c->workers[i].decimation.made;
        end_worker(&c->workers[i], memory);
    }
    csg_memory_release(memory, c->order, c->order_capacity * sizeof *c->order);
    csg_memory_release(memory, c->version, vertices * sizeof *c->version);
    csg_memory_release(memory, c->vertices, vertices * sizeof *c->vertices);
    csg_memory_release(memory, c->workers, c->worker_count * sizeof *c->workers);
    csg_memory_release(memory, c->inside, triangles * sizeof *c->inside);
    csg_memory_release(memory, c->slots, triangles * sizeof *c->slots);
    csg_memory_release(memory, c->items, c->item_capacity * sizeof *c->items);
    csg_memory_release(memory, c->regions, c->region_capacity * sizeof *c->regions);
    csg_arena_reset(&c->arena);
    *c = (cutting){.d = c->d, .region_of = c->region_of, .is_reported = c->is_reported};
}

static void end(cutting *c)
{
    end_cubes(c);
    csg_memory_release(c->d->remesh->memory, c->region_of,
                       c->d->remesh->corners.vertex_count * sizeof *c->region_of);
    c->d->region_of = NULL;
}

csgm_status csg_decimate(csg_decimation *d, uint32_t least)
{
    csg_remesh *r = d->remesh;
    cutting c = {.d = d};
    /* where a number of triangles is the goal the cheapest of all have to go */
    bool in_cubes = least <= CSG_DECIMATE_ALL && r->corners.live > MOST_OF_REGION;
    memset(d->state, CSG_VERTEX_FRESH, r->corners.vertex_count);
    d->least_quality = LEAST_QUALITY;
    if (in_cubes)
        csg_triangle_tree_forget(&r->tree); /* each cube has its own */
    csgm_status status = begin(&c, in_cubes) ? CSGM_OK : CSGM_ERR_MEMORY;
    if (status == CSGM_OK && !in_cubes && !r->tree.nodes)
        status = make_tree_again(r);
    for (int round = 0; round < ROUNDS && in_cubes && status == CSGM_OK; round++) {
        CSG_ZONE(r->context, "cubes");
        status = run_round(&c, round, ROUND_SHARE);
    }
    if (status == CSGM_OK && in_cubes) {
        end_cubes(&c);
        status = make_tree_again(r);
    }
    if (status == CSGM_OK) {
        CSG_ZONE(r->context, "seams");
        status = run_last(&c, least);
    }
    if (status == CSGM_OK && least <= CSG_DECIMATE_ALL) {
        CSG_ZONE(r->context, "loosening");
        status = make_tree_again(r);
        if (status == CSGM_OK)
            status = run_loosened(&c, least);
    }
    if (status == CSGM_OK)
        status = make_tree_again(r);
    end(&c);
    return c.is_reported ? status : report_end(r, status);
}

csgm_status csg_decimate_within(csg_decimation *d, csg_vec3 low, csg_vec3 high, double share)
{
    csg_remesh *r = d->remesh;
    cutting c = {.d = d};
    memset(d->state, CSG_VERTEX_FRESH, r->corners.vertex_count);
    d->least_quality = LEAST_QUALITY;
    d->low = low;
    d->high = high;
    csgm_status status = begin(&c, true) ? CSGM_OK : CSGM_ERR_MEMORY;
    for (int round = 0; round < ROUNDS && status == CSGM_OK; round++)
        status = run_round(&c, round, share / ROUNDS);
    end(&c);
    return c.is_reported ? status : report_end(r, status);
}
