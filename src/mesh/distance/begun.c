/* SPDX-License-Identifier: MIT
 * Triangle by triangle, some at a time on each thread; see begun.h.
 */
#include "mesh/distance/begun.h"

#include <math.h>

#include "base/rank_loop.h"
#include "shape/polyhedra/within.h"

enum { TRIANGLES = 64 /* of an item */ };

/* Of the field's noise. */
static const double ROUNDED = 64;
/* Pieces of one triangle: some seconds. */
static const uint64_t MOST_PIECES = 1 << 20;

/* ---- the surface ------------------------------------------------------------------------------
 */

static csg_box box_of(const csg_remesh *r)
{
    csg_box box = csg_box_empty();
    for (uint32_t v = 0; v < r->mesh->vertex_count; v++) {
        csg_vec3 p = csg_remesh_first_place(r, v);
        box = csg_box_hull(box, (csg_box){p, p});
    }
    return box;
}

/* The triangles that the mesh began with, in the frame. False: out of memory. */
static bool make_chain(const csg_remesh *r, const csg_triangle_frame *frame, csg_arena *scratch,
                       csg_triangles *out)
{
    const csgm_mesh *mesh = r->mesh;
    *out = (csg_triangles){
        .memory = r->memory, .point_count = mesh->vertex_count, .count = mesh->triangle_count};
    out->points = csg_arena_alloc(scratch, mesh->vertex_count * sizeof *out->points);
    out->corners = csg_arena_alloc(scratch, mesh->triangle_count * sizeof *out->corners);
    if (!out->points || !out->corners)
        return false;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        out->points[v] = csg_triangle_frame_round_point(
            csg_triangle_frame_enter(frame, csg_remesh_first_place(r, v)));
    for (size_t t = 0; t < mesh->triangle_count; t++)
        for (size_t k = 0; k < 3; k++)
            out->corners[t][k] = mesh->indices[3 * t + k];
    return true;
}

csgm_status csg_begun_make(const csg_remesh *r, csg_begun *out)
{
    static const double LATTICE = 0x1p-38; /* what rounding a point onto it moves it by, and more */
    csg_arena scratch;
    csg_triangles chain;
    *out = (csg_begun){0};
    if (!r->is_own || !r->mesh->triangle_count || !csg_triangle_frame_make(box_of(r), &out->frame))
        return CSGM_OK;
    csg_arena_init(&scratch, r->memory);
    bool done = make_chain(r, &out->frame, &scratch, &chain) &&
                csg_tree_make(r->memory, &scratch, &chain, &out->tree);
    csg_arena_reset(&scratch);
    if (!done)
        return csg_context_no_memory(r->context);
    out->slack = ROUNDED * (double)r->probe.noise +
                 (csg_piece_slack(&out->tree) + LATTICE) * out->frame.unscale;
    return CSGM_OK;
}

void csg_begun_release(csg_begun *begun)
{
    if (begun->tree.memory)
        csg_tree_release(&begun->tree);
    *begun = (csg_begun){0};
}

bool csg_begun_is_decisive(const csg_begun *begun, double error)
{
    return error >= 2 * begun->slack;
}

/* ---- the proof --------------------------------------------------------------------------------
 */

typedef struct check {
    const csg_begun *begun;
    const csg_remesh *remesh;
    double limit; /* frame units */
    uint8_t *pending;
    csg_begun_proof *items; /* of so many triangles each */
} check;

static void check_triangle(const check *c, csg_within_search *search, uint32_t t,
                           csg_begun_proof *out)
{
    const csg_triangle_frame *frame = &c->begun->frame;
    csg_vec3 v[3];
    for (uint32_t k = 0; k < 3; k++)
        v[k] = csg_triangle_frame_enter(frame, csg_remesh_corner(c->remesh, 3 * t + k));
    c->pending[t] = csg_triangle_is_within(search, v, MOST_PIECES) != CSG_WITHIN;
    if (c->pending[t] && !out->open++)
        out->place = csg_triangle_frame_leave(frame, search->beyond);
}

/* Triangles of an item. */
static uint32_t count_of_item(const check *c, size_t index)
{
    uint32_t left = c->remesh->corners.triangle_count - (uint32_t)index * TRIANGLES;
    return left < TRIANGLES ? left : TRIANGLES;
}

static bool check_item(void *user, uint32_t worker, size_t index)
{
    (void)worker;
    const check *c = user;
    const csg_corners *m = &c->remesh->corners;
    csg_begun_proof *out = &c->items[index];
    csg_within_search search = {.tree = &c->begun->tree, .limit = c->limit};
    uint32_t first = (uint32_t)index * TRIANGLES, end = first + count_of_item(c, index);
    *out = (csg_begun_proof){0};
    for (uint32_t t = first; t < end; t++) {
        bool is_asked = csg_corners_is_live(m, t) && c->pending[t];
        c->pending[t] = 0;
        if (is_asked && !(c->limit > 0 && csg_remesh_is_as_begun(c->remesh, t)))
            check_triangle(c, &search, t, out);
    }
    out->pieces = search.pieces;
    return !csg_mesh_should_stop(c->remesh->watch);
}

static void report_items(void *user, size_t done, size_t count)
{
    const check *c = user;
    csg_mesh_report_progress(c->remesh->watch, (double)done / (double)count);
}

/* What each rank has found, to all: of an item its proof, then which triangles stayed open. */
static csgm_status exchange_items(check *c, size_t count, csgm_status own)
{
    csgm_context *context = c->remesh->context;
    csg_records records = {0};
    csg_record_reader reader;
    for (size_t i = 0; i < count && own == CSGM_OK; i++)
        if (csg_ranks_have(context, i) &&
            (!csg_records_add(&context->memory, &records, &c->items[i], sizeof *c->items) ||
             !csg_records_add(&context->memory, &records, c->pending + i * TRIANGLES,
                              count_of_item(c, i))))
            own = csg_context_no_memory(context);
    csgm_status status = csg_ranks_exchange(context, own, count, &records, &reader);
    for (size_t i = 0; i < count && status == CSGM_OK; i++) {
        csg_record_read(&reader, i, &c->items[i], sizeof *c->items);
        csg_record_read(&reader, i, c->pending + i * TRIANGLES, count_of_item(c, i));
    }
    csg_record_reader_end(&context->memory, &reader);
    return status;
}

csgm_status csg_begun_check(const csg_begun *begun, const csg_remesh *r, double error,
                            uint8_t *pending, csg_begun_proof *out)
{
    size_t count = ((size_t)r->corners.triangle_count + TRIANGLES - 1) / TRIANGLES;
    size_t bytes = count * sizeof(csg_begun_proof);
    check c = {begun, r, (error - begun->slack) * begun->frame.scale, pending,
               csg_memory_alloc(r->memory, bytes)};
    *out = (csg_begun_proof){0};
    if (!c.items)
        return csg_context_no_memory(r->context);
    csgm_status status = CSGM_OK;
    if (!csg_ranks_run(r->context, count, CSG_ITEMS_SMALL, check_item, report_items, &c))
        status = csg_mesh_why_stopped(r->watch);
    if (csg_ranks_share(r->context, count, CSG_ITEMS_SMALL))
        status = exchange_items(&c, count, status);
    for (size_t i = 0; i < count && status == CSGM_OK; i++) {
        out->pieces += c.items[i].pieces;
        if (c.items[i].open && !out->open)
            out->place = c.items[i].place;
        out->open += c.items[i].open;
    }
    csg_memory_release(r->memory, c.items, bytes);
    return status;
}
