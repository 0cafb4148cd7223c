/* SPDX-License-Identifier: MIT
 * A parallel loop over the blocks of a slab; see output.h.
 */
#include "mesh/pipeline/output.h"

#include <string.h>

#include "base/pool.h"
#include "base/trace.h"
#include "mesh/features/emit.h"
#include "mesh/pipeline/survey.h"

/* ---- one block ---------------------------------------------------------------------------------
 */

static csg_box box_of(const float *positions, uint64_t count, csg_box box)
{
    for (uint64_t i = 0; i < count; i++, positions += 3) {
        csg_vec3 p = {(double)positions[0], (double)positions[1], (double)positions[2]};
        box = csg_box_hull(box, (csg_box){p, p});
    }
    return box;
}

/* Where the vertices and triangles of some blocks go: arrays that begin with the first one's, or
 * loose triangles, 9 floats each. */
typedef struct places {
    csg_marching_output arrays;
    float *corners;   /* NULL: in arrays */
    uint32_t *joined; /* as csg_mesh_run.joined, where it is not in arrays; or NULL */
    const csg_block *first;
} places;

/* The indices of a block's triangles, without copies of vertices. */
static void join_block(const csg_mesh_output *o, const csg_block *block,
                       const csg_feature_block *features, csg_marching_room *room, uint32_t *joined)
{
    const csg_marching *m = &o->workers->marching;
    csg_marching_output out = {.indices = joined};
    if (features)
        csg_feature_triangles(m, block, &o->creases->store, features, false, room, &out);
    else
        csg_marching_triangles(m, block, room, &out);
}

static void make_block(csg_mesh_output *o, csg_mesh_worker *self, const csg_block *block,
                       const places *to)
{
    const csg_marching *m = &o->workers->marching;
    const csg_feature_store *store = &o->creases->store;
    const csg_feature_block *features = csg_feature_store_find(store, block->at);
    csg_marching_room *room = self->room;
    float *scratch = self->scratch;
    size_t scratch_floats = o->workers->scratch_floats;
    size_t v = block->first_vertex - to->first->first_vertex;
    size_t t = (size_t)(block->first_triangle - to->first->first_triangle);
    uint64_t points, gradients = 0;
    if (to->corners) {
        float *at = to->corners + 9 * t;
        points = features ? csg_feature_corners(m, block, store, features, room, at, scratch,
                                                scratch_floats)
                          : csg_marching_corners(m, block, room, at, scratch, scratch_floats);
        if (o->input->clipped)
            self->bounds = box_of(at, 3 * (uint64_t)block->triangle_count, self->bounds);
    } else {
        const csg_marching_output *a = &to->arrays;
        csg_marching_output out = {
            .positions = a->positions + 3 * v,
            .normals = a->normals ? a->normals + 3 * v : NULL,
            .colors = a->colors ? a->colors + 4 * v : NULL,
            .indices = a->indices + 3 * t,
            .materials = a->materials ? a->materials + 2 * v : NULL,
        };
        points = csg_marching_vertices(m, block, room, &out, scratch, scratch_floats);
        if (features) {
            bool split = o->creases->split;
            csg_feature_vertices(m, block, store, features, split, room, &out, scratch,
                                 scratch_floats);
            csg_feature_triangles(m, block, store, features, split, room, &out);
        } else {
            csg_marching_triangles(m, block, room, &out);
        }
        if (o->input->clipped)
            self->bounds = box_of(out.positions, block->vertex_count, self->bounds);
        gradients = out.normals ? block->vertex_count : 0;
    }
    if (to->joined)
        join_block(o, block, features, room, to->joined + 3 * t);
    self->point_evaluations += points;
    self->gradient_evaluations += gradients;
    self->primitive_evaluations += (points + gradients) * (block->node_count + 1) / 2;
}

/* ---- the blocks of an item ---------------------------------------------------------------------
 */

/* The run's places in the mesh. */
static void find_in_mesh(const csg_mesh_output *o, const csg_mesh_run *run, places *to)
{
    const csgm_mesh *mesh = o->mesh;
    size_t v = (size_t)(run->first_vertex - o->before.vertices);
    to->arrays = (csg_marching_output){
        .positions = mesh->positions + 3 * v,
        .normals = mesh->normals ? mesh->normals + 3 * v : NULL,
        .colors = mesh->colors ? mesh->colors + 4 * v : NULL,
        .indices = mesh->indices + 3 * (run->first_triangle - o->before.triangles),
        .materials = mesh->materials ? mesh->materials + 2 * v : NULL,
    };
}

/* Room for the run in the worker's buffer. False: out of memory. */
static bool reserve_run(const csg_mesh_output *o, csg_run_buffer *buffer, csg_mesh_run *run,
                        places *to)
{
    csg_memory *memory = &o->watch->context->memory;
    size_t vertices = (size_t)run->vertex_count, triangles = (size_t)run->triangle_count;
    bool corners = o->receiver->wants_corners, joined = o->receiver->wants_joined;
    if (joined && (corners || o->creases->split)) {
        if (!csg_memory_reserve(memory, (void **)&buffer->joined, &buffer->joined_capacity,
                                3 * triangles, sizeof(uint32_t)))
            return false;
        run->joined = to->joined = buffer->joined;
    }
    if (corners) {
        if (!csg_memory_reserve(memory, (void **)&buffer->corners, &buffer->corner_capacity,
                                9 * triangles, sizeof(float)))
            return false;
        run->corners = to->corners = buffer->corners;
        return true;
    }
    if (!csg_memory_reserve(memory, (void **)&buffer->positions, &buffer->position_capacity,
                            3 * vertices, sizeof(float)) ||
        (o->counts.normals &&
         !csg_memory_reserve(memory, (void **)&buffer->normals, &buffer->normal_capacity,
                             3 * vertices, sizeof(float))) ||
        (o->counts.colors && !csg_memory_reserve(memory, (void **)&buffer->colors,
                                                 &buffer->color_capacity, 4 * vertices, 1)) ||
        !csg_memory_reserve(memory, (void **)&buffer->indices, &buffer->index_capacity,
                            3 * triangles, sizeof(uint32_t)))
        return false;
    run->positions = to->arrays.positions = buffer->positions;
    run->normals = to->arrays.normals = buffer->normals;
    run->colors = to->arrays.colors = buffer->colors;
    run->indices = to->arrays.indices = buffer->indices;
    if (joined && !run->joined)
        run->joined = run->indices;
    return true;
}

/* Makes the blocks of an item where they belong, or in the worker's buffer for the receiver. */
static bool make_item(void *user, uint32_t worker_index, size_t item)
{
    csg_mesh_output *o = user;
    if (csg_mesh_should_stop(o->watch))
        return false;
    csg_mesh_worker *self = &o->workers->each[worker_index];
    size_t first = item * CSG_BLOCKS_PER_ITEM, end = csg_mesh_item_end(&o->blocks, item);
    const csg_block *start = o->blocks.block[first], *last = o->blocks.block[end - 1];
    csg_mesh_run run = {
        .worker = worker_index,
        .first_vertex = start->first_vertex,
        .vertex_count = (uint64_t)last->first_vertex + last->vertex_count - start->first_vertex,
        .first_triangle = start->first_triangle,
        .triangle_count = last->first_triangle + last->triangle_count - start->first_triangle,
    };
    places to = {.first = start};
    if (!o->receiver)
        find_in_mesh(o, &run, &to);
    else if (!reserve_run(o, &self->run, &run, &to))
        return csg_mesh_stop_without_memory(o->watch);
    for (size_t i = first; i < end; i++)
        make_block(o, self, o->blocks.block[i], &to);
    if (!o->receiver || o->receiver->put(o->receiver->user, &run))
        return true;
    atomic_store(&o->watch->refused, true);
    return false;
}

/* ---- all of them -------------------------------------------------------------------------------
 */

/* What this process makes of it comes after how much, and is how much. */
static csg_cell_sum find_own(csg_mesh_output *o, const csg_mesh_slabs *slabs)
{
    o->before = (csg_cell_sum){0};
    if (!slabs->before) /* it makes all */
        return (csg_cell_sum){slabs->vertex_count, slabs->triangle_count};
    o->before = slabs->before[slabs->first_cell];
    csg_cell_sum end = slabs->before[slabs->end_cell];
    return (csg_cell_sum){end.vertices - o->before.vertices, end.triangles - o->before.triangles};
}

csgm_status csg_mesh_begin_output(csg_mesh_output *o, const csg_mesh_slabs *slabs)
{
    const csg_mesh_input *in = o->input;
    csg_cell_sum own = find_own(o, slabs);
    o->counts = (csg_mesh_counts){.vertex_count = slabs->vertex_count,
                                  .triangle_count = slabs->triangle_count,
                                  .normals = in->options->normals != CSGM_NORMALS_NONE,
                                  .colors = csg_mesh_gets_colors(in),
                                  .split = o->creases->split,
                                  .origin = csg_mesh_origin_of(in),
                                  .bounds = in->bounds};
    o->counts.bounds.min = csg_vec3_sub(o->counts.bounds.min, o->counts.origin);
    o->counts.bounds.max = csg_vec3_sub(o->counts.bounds.max, o->counts.origin);
    if (o->receiver)
        return o->receiver->begin(o->receiver->user, &o->counts);
    csgm_status status = csg_mesh_create(in->context, own.vertices, own.triangles,
                                         o->counts.normals, o->counts.colors, &o->mesh);
    if (status == CSGM_OK) {
        o->mesh->origin = o->counts.origin;
        o->mesh->split = o->creases->split;
    }
    if (status == CSGM_OK && csg_mesh_gets_materials(in))
        status = csg_mesh_add_materials(o->mesh);
    return status;
}

static void poll_progress(void *user, size_t done, size_t count)
{
    const csg_mesh_output *o = user;
    csg_mesh_report_progress(o->watch, (double)done / (double)count);
}

csgm_status csg_mesh_make_slabs(csg_mesh_output *o, csg_mesh_slabs *slabs)
{
    CSG_ZONE(o->watch->context, "marching");
    csgm_status status = CSGM_OK;
    for (size_t i = slabs->to_make; i-- > 0 && status == CSGM_OK;) {
        status = csg_mesh_take_slab(slabs, i);
        if (status != CSGM_OK)
            break;
        o->blocks = slabs->at_hand;
        if (o->watch->context->survey)
            csg_survey_blocks(o->watch->context->survey, o->input, o->blocks);
        if (!csg_pool_run(o->watch->context->pool, csg_mesh_item_count(&o->blocks), make_item,
                          poll_progress, o))
            return csg_mesh_why_stopped(o->watch);
        status = slabs->keeper ? slabs->keeper->made(o, slabs, i) : CSGM_OK;
        if (status == CSGM_OK)
            status = csg_mesh_leave_slab(slabs, i);
    }
    return status;
}
