/* SPDX-License-Identifier: MIT
 * Tables, constants and rooms; see workers.h.
 */
#include "mesh/pipeline/workers.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/pool.h"
#include "field/kernels/dispatch.h"

static double unit_of(const csg_lattice *lattice, csg_vec3 shift)
{
    double most = fmax(fabs(shift.x), fmax(fabs(shift.y), fabs(shift.z)));
    return (double)FLT_EPSILON * (csg_lattice_extent(lattice) + most);
}

/* Vertices keep this far from the ends of their edge, so that those of different edges lie apart
 * and no triangle collapses where the surface runs through lattice points: three units in the last
 * place are more than all roundings on the way. */
static double end_distance_of(const csg_lattice *lattice, double unit)
{
    const double usual = 0x1p-12, most = 0.25;
    return fmin(fmax(3 * unit / lattice->cell_size, usual), most);
}

static void prepare_marching(csg_mesh_workers *w, const csg_mesh_input *in)
{
    const csg_lattice *lattice = &in->lattice;
    csg_vec3 shift = csg_vec3_sub(in->field->center, csg_mesh_origin_of(in));
    double slope = (double)in->field->tape.lipschitz, unit = unit_of(lattice, shift);
    csg_cell_tables_make(&w->tables);
    csg_marching_places_make(&w->places, &w->tables);
    w->marching = (csg_marching){
        .kernel = csg_kernel_for(in->context->isa),
        .field = in->field,
        .lattice = lattice,
        .tables = &w->tables,
        .places = &w->places,
        /* what a unit in the last place of a coordinate changes */
        .noise = (float)((double)FLT_EPSILON * csg_lattice_extent(lattice) * slope),
        .shift = shift,
        .unit = (float)unit,
        .end_distance = (float)end_distance_of(lattice, unit),
    };
}

csgm_status csg_mesh_workers_create(csg_mesh_workers *w, const csg_mesh_input *in)
{
    prepare_marching(w, in);
    csg_memory *memory = &in->context->memory;
    w->context = in->context;
    w->count = csg_pool_threads(in->context->pool);
    w->scratch_floats = csg_kernel_scratch_floats(in->field->depth);
    w->each = csg_memory_alloc(memory, w->count * sizeof(csg_mesh_worker));
    if (!w->each)
        return csg_context_no_memory(in->context);
    memset(w->each, 0, w->count * sizeof(csg_mesh_worker));
    for (uint32_t i = 0; i < w->count; i++) {
        csg_mesh_worker *worker = &w->each[i];
        worker->bounds = csg_box_empty();
        worker->room = csg_memory_alloc(memory, sizeof(csg_marching_room));
        worker->scratch = csg_memory_alloc(memory, w->scratch_floats * sizeof(float));
        if (!worker->room || !worker->scratch)
            return csg_context_no_memory(in->context);
        memset(worker->room, 0, sizeof(csg_marching_room));
        if (in->options->features == CSGM_FEATURES_SHARP) {
            worker->features = csg_memory_alloc(memory, sizeof(csg_feature_room));
            if (!worker->features)
                return csg_context_no_memory(in->context);
            csg_feature_room_init(worker->features);
        }
    }
    return CSGM_OK;
}

static void release_run(csg_memory *memory, csg_run_buffer *run)
{
    csg_memory_release(memory, run->positions, run->position_capacity * sizeof(float));
    csg_memory_release(memory, run->normals, run->normal_capacity * sizeof(float));
    csg_memory_release(memory, run->colors, run->color_capacity);
    csg_memory_release(memory, run->indices, run->index_capacity * sizeof(uint32_t));
    csg_memory_release(memory, run->corners, run->corner_capacity * sizeof(float));
    csg_memory_release(memory, run->joined, run->joined_capacity * sizeof(uint32_t));
}

void csg_mesh_workers_release(csg_mesh_workers *w)
{
    if (!w->each)
        return;
    csg_memory *memory = &w->context->memory;
    for (uint32_t i = 0; i < w->count; i++) {
        csg_mesh_worker *worker = &w->each[i];
        release_run(memory, &worker->run);
        csg_memory_release(memory, worker->room, sizeof(csg_marching_room));
        if (worker->features)
            csg_feature_room_release(worker->features);
        csg_memory_release(memory, worker->features, sizeof(csg_feature_room));
        csg_memory_release(memory, worker->scratch, w->scratch_floats * sizeof(float));
    }
    csg_memory_release(memory, w->each, w->count * sizeof(csg_mesh_worker));
    w->each = NULL;
}
