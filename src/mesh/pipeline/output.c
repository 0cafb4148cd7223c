/* SPDX-License-Identifier: MIT
 * Where vertices and triangles go: to their places in the mesh's arrays, or, run by run, through a
 * buffer of the worker's to a receiver.
 */
#include <float.h>
#include <math.h>
#include <string.h>

#include "base/pool.h"
#include "field/kernels/dispatch.h"
#include "mesh/features/emit.h"
#include "mesh/work.h"

/* ---- blocks -------------------------------------------------------------------------------- */

static csg_box box_of(const float *positions, uint64_t count, csg_box box)
{
    for (uint64_t i = 0; i < count; i++, positions += 3) {
        csg_vec3 p = {(double)positions[0], (double)positions[1], (double)positions[2]};
        box = csg_box_hull(box, (csg_box){p, p});
    }
    return box;
}

static void make_block(csg_mesh_work *w, csg_mesh_worker *self, const csg_block *block,
                       const csg_marching_output *out)
{
    const csg_feature_store *store = &w->features;
    const csg_feature_block *features = csg_feature_store_find(store, block->at);
    uint64_t points = csg_marching_vertices(&w->marching, block, self->room, out, self->scratch,
                                            w->scratch_floats);
    if (features) {
        csg_feature_vertices(&w->marching, block, store, features, w->split, self->room, out,
                             self->scratch, w->scratch_floats);
        csg_feature_triangles(&w->marching, block, store, features, w->split, self->room, out);
    } else {
        csg_marching_triangles(&w->marching, block, self->room, out);
    }
    if (w->clipped)
        self->bounds = box_of(out->positions, block->vertex_count, self->bounds);
    uint64_t gradients = out->normals ? block->vertex_count : 0;
    self->point_evaluations += points;
    self->gradient_evaluations += gradients;
    self->primitive_evaluations += (points + gradients) * (block->node_count + 1) / 2;
}

/* Makes blocks [first, end); arrays of `out` begin with the first block's. */
static void make_blocks(csg_mesh_work *w, csg_mesh_worker *self, size_t first, size_t end,
                        const csg_marching_output *out)
{
    const csg_block *start = w->blocks[first];
    for (size_t i = first; i < end; i++) {
        const csg_block *block = w->blocks[i];
        size_t v = block->first_vertex - start->first_vertex;
        size_t t = (size_t)(block->first_triangle - start->first_triangle);
        csg_marching_output place = {
            .positions = out->positions + 3 * v,
            .normals = out->normals ? out->normals + 3 * v : NULL,
            .colors = out->colors ? out->colors + 4 * v : NULL,
            .indices = out->indices + 3 * t,
            .materials = out->materials ? out->materials + 2 * v : NULL,
        };
        make_block(w, self, block, &place);
    }
}

static bool reserve_run(csg_mesh_work *w, csg_run_buffer *run, size_t vertices, size_t triangles)
{
    csg_memory *memory = &w->context->memory;
    return csg_memory_reserve(memory, (void **)&run->positions, &run->position_capacity,
                              3 * vertices, sizeof(float)) &&
           (!w->counts.normals ||
            csg_memory_reserve(memory, (void **)&run->normals, &run->normal_capacity, 3 * vertices,
                               sizeof(float))) &&
           (!w->counts.colors || csg_memory_reserve(memory, (void **)&run->colors,
                                                    &run->color_capacity, 4 * vertices, 1)) &&
           csg_memory_reserve(memory, (void **)&run->indices, &run->index_capacity, 3 * triangles,
                              sizeof(uint32_t));
}

static void release_run(csg_memory *memory, csg_run_buffer *run)
{
    csg_memory_release(memory, run->positions, run->position_capacity * sizeof(float));
    csg_memory_release(memory, run->normals, run->normal_capacity * sizeof(float));
    csg_memory_release(memory, run->colors, run->color_capacity);
    csg_memory_release(memory, run->indices, run->index_capacity * sizeof(uint32_t));
    csg_memory_release(memory, run->corners, run->corner_capacity * sizeof(float));
}

/* Vertices and indices of blocks [first, end) in the worker's buffer. */
static bool fill_indexed(csg_mesh_work *w, csg_mesh_worker *self, size_t first, size_t end,
                         csg_mesh_run *run)
{
    csg_run_buffer *buffer = &self->run;
    if (!reserve_run(w, buffer, (size_t)run->vertex_count, (size_t)run->triangle_count))
        return false;
    csg_marching_output out = {.positions = buffer->positions,
                               .normals = buffer->normals,
                               .colors = buffer->colors,
                               .indices = buffer->indices};
    make_blocks(w, self, first, end, &out);
    run->positions = buffer->positions;
    run->normals = buffer->normals;
    run->colors = buffer->colors;
    run->indices = buffer->indices;
    return true;
}

static uint64_t corners_of_block(csg_mesh_work *w, csg_mesh_worker *self, const csg_block *block,
                                 float *at)
{
    const csg_feature_block *features = csg_feature_store_find(&w->features, block->at);
    if (features)
        return csg_feature_corners(&w->marching, block, &w->features, features, self->room, at,
                                   self->scratch, w->scratch_floats);
    return csg_marching_corners(&w->marching, block, self->room, at, self->scratch,
                                w->scratch_floats);
}

/* Loose triangles of blocks [first, end) in the worker's buffer. */
static bool fill_corners(csg_mesh_work *w, csg_mesh_worker *self, size_t first, size_t end,
                         csg_mesh_run *run)
{
    csg_run_buffer *buffer = &self->run;
    if (!csg_memory_reserve(&w->context->memory, (void **)&buffer->corners,
                            &buffer->corner_capacity, 9 * (size_t)run->triangle_count,
                            sizeof(float)))
        return false;
    run->corners = buffer->corners;
    float *at = buffer->corners;
    for (size_t i = first; i < end; i++) {
        const csg_block *block = w->blocks[i];
        uint64_t points = corners_of_block(w, self, block, at);
        if (w->clipped)
            self->bounds = box_of(at, 3 * (uint64_t)block->triangle_count, self->bounds);
        self->point_evaluations += points;
        self->primitive_evaluations += points * (block->node_count + 1) / 2;
        at += 9 * (size_t)block->triangle_count;
    }
    return true;
}

/* One item for a receiver: made in the worker's buffer, then handed on. */
static bool hand_on(csg_mesh_work *w, uint32_t worker_index, size_t first, size_t end)
{
    csg_mesh_worker *self = &w->workers[worker_index];
    const csg_block *start = w->blocks[first], *last = w->blocks[end - 1];
    csg_mesh_run run = {
        .worker = worker_index,
        .first_vertex = start->first_vertex,
        .vertex_count = (uint64_t)last->first_vertex + last->vertex_count - start->first_vertex,
        .first_triangle = start->first_triangle,
        .triangle_count = last->first_triangle + last->triangle_count - start->first_triangle,
    };
    if (!(w->receiver->wants_corners ? fill_corners : fill_indexed)(w, self, first, end, &run)) {
        atomic_store(&w->out_of_memory, true);
        return false;
    }
    if (w->receiver->put(w->receiver->user, &run))
        return true;
    atomic_store(&w->refused, true);
    return false;
}

static void keep_in_mesh(csg_mesh_work *w, uint32_t worker_index, size_t first, size_t end)
{
    const csg_block *start = w->blocks[first];
    csgm_mesh *mesh = w->mesh;
    size_t v = start->first_vertex;
    csg_marching_output out = {
        .positions = mesh->positions + 3 * v,
        .normals = mesh->normals ? mesh->normals + 3 * v : NULL,
        .colors = mesh->colors ? mesh->colors + 4 * v : NULL,
        .indices = mesh->indices + 3 * start->first_triangle,
        .materials = mesh->materials ? mesh->materials + 2 * v : NULL,
    };
    make_blocks(w, &w->workers[worker_index], first, end, &out);
}

static bool make_item(void *user, uint32_t worker_index, size_t item)
{
    csg_mesh_work *w = user;
    if (csg_mesh_should_stop(w))
        return false;
    size_t first = item * CSG_BLOCKS_PER_ITEM, end = first + CSG_BLOCKS_PER_ITEM;
    end = end < w->block_count ? end : w->block_count;
    if (w->receiver)
        return hand_on(w, worker_index, first, end);
    keep_in_mesh(w, worker_index, first, end);
    return true;
}

/* ---- beginning ------------------------------------------------------------------------------- */

/* Far from the scene's origin floats are coarse: there the mesh keeps its own. Up to 64 times the
 * size, an ulp is below 1e-5 of it. */
csg_vec3 csg_mesh_origin(csg_vec3 center, csg_box bounds)
{
    enum { FAR = 64 };
    csg_vec3 size = csg_box_size(bounds);
    double extent = fmax(size.x, fmax(size.y, size.z));
    return csg_vec3_norm(center) > FAR * extent ? center : csg_vec3_make(0, 0, 0);
}

static double unit_of(const csg_mesh_work *w)
{
    csg_vec3 shift = w->marching.shift;
    double most = fmax(fabs(shift.x), fmax(fabs(shift.y), fabs(shift.z)));
    return (double)FLT_EPSILON * (csg_lattice_extent(&w->lattice) + most);
}

/* Vertices keep this far from the ends of their edge, so that those of different edges lie apart
 * and no triangle collapses where the surface runs through lattice points: three units in the last
 * place are more than all roundings on the way. */
static double end_distance_of(const csg_mesh_work *w)
{
    const double usual = 0x1p-12, most = 0.25;
    return fmin(fmax(3 * unit_of(w) / w->lattice.cell_size, usual), most);
}

static void prepare_marching(csg_mesh_work *w)
{
    double slope = (double)w->field->tape.lipschitz;
    w->marching = (csg_marching){
        .kernel = csg_kernel_for(w->context->isa),
        .field = w->field,
        .lattice = &w->lattice,
        .tables = &w->tables,
        .places = &w->places,
        .index = &w->index,
        /* what a unit in the last place of a coordinate changes */
        .noise = (float)((double)FLT_EPSILON * csg_lattice_extent(&w->lattice) * slope),
        .shift = csg_vec3_sub(w->field->center, csg_mesh_origin_of(w)),
    };
    w->marching.unit = (float)unit_of(w);
    w->marching.end_distance = (float)end_distance_of(w);
}

/* Where the mesh goes: arrays of its own, or a receiver. */
static csgm_status begin_arrays(csg_mesh_work *w)
{
    csg_mesh_counts *counts = &w->counts;
    counts->normals = w->options->normals != CSGM_NORMALS_NONE;
    const csg_mesh_share *share = w->share;
    bool materials = w->options->colors && (share ? share->materials : w->field->has_materials);
    counts->colors = w->options->colors && (share ? share->colors : csg_mesh_is_colored(w->field));
    counts->origin = csg_mesh_origin_of(w);
    if (w->receiver)
        return w->receiver->begin(w->receiver->user, counts);
    csgm_status status = csg_mesh_create(w->context, counts->vertex_count, counts->triangle_count,
                                         counts->normals, counts->colors, &w->mesh);
    if (status == CSGM_OK) {
        w->mesh->origin = counts->origin;
        w->mesh->split = w->split;
    }
    if (status == CSGM_OK && materials)
        status = csg_mesh_add_materials(w->mesh);
    return status;
}

csgm_status csg_mesh_create_workers(csg_mesh_work *w)
{
    prepare_marching(w);
    w->split = w->options->normals == CSGM_NORMALS_CREASE;
    csg_memory *memory = &w->context->memory;
    w->worker_count = csg_pool_threads(w->context->pool);
    w->scratch_floats = csg_kernel_scratch_floats(w->field->depth);
    w->workers = csg_memory_alloc(memory, w->worker_count * sizeof(csg_mesh_worker));
    if (!w->workers)
        return csg_context_no_memory(w->context);
    memset(w->workers, 0, w->worker_count * sizeof(csg_mesh_worker));
    for (uint32_t i = 0; i < w->worker_count; i++) {
        w->workers[i].bounds = csg_box_empty();
        w->workers[i].room = csg_memory_alloc(memory, sizeof(csg_marching_room));
        w->workers[i].scratch = csg_memory_alloc(memory, w->scratch_floats * sizeof(float));
        if (!w->workers[i].room || !w->workers[i].scratch)
            return csg_context_no_memory(w->context);
        memset(w->workers[i].room, 0, sizeof(csg_marching_room));
        if (w->options->features == CSGM_FEATURES_SHARP) {
            w->workers[i].features = csg_memory_alloc(memory, sizeof(csg_feature_room));
            if (!w->workers[i].features)
                return csg_context_no_memory(w->context);
            csg_feature_room_init(w->workers[i].features);
        }
    }
    return CSGM_OK;
}

csgm_status csg_mesh_begin_output(csg_mesh_work *w)
{
    return begin_arrays(w);
}

csgm_status csg_mesh_make_blocks(csg_mesh_work *w)
{
    bool done = csg_pool_run(w->context->pool, csg_mesh_item_count(w), make_item, csg_mesh_poll, w);
    return done ? CSGM_OK : csg_mesh_why_stopped(w);
}

void csg_mesh_release_output(csg_mesh_work *w)
{
    csg_memory *memory = &w->context->memory;
    for (uint32_t i = 0; w->workers && i < w->worker_count; i++) {
        release_run(memory, &w->workers[i].run);
        csg_memory_release(memory, w->workers[i].room, sizeof(csg_marching_room));
        if (w->workers[i].features)
            csg_feature_room_release(w->workers[i].features, memory);
        csg_memory_release(memory, w->workers[i].features, sizeof(csg_feature_room));
        csg_memory_release(memory, w->workers[i].scratch, w->scratch_floats * sizeof(float));
    }
    csg_memory_release(memory, w->workers, w->worker_count * sizeof(csg_mesh_worker));
}
