/* SPDX-License-Identifier: MIT
 * See booleans.h. The library's memory is its own, so what it takes at most is asked for before.
 */
#include "shape/polyhedra/booleans.h"

#include "shape/polyhedra/manifold.h"

/* For each triangle of the operands, as was measured. */
static const uint64_t BYTES_MOST = 1024;

typedef struct booleans {
    const csg_boolean_step *steps;
    const csg_boolean_watch *watch;
    csg_marked_triangles *out;
} booleans;

void csg_marked_triangles_release(csg_marked_triangles *marked)
{
    csg_memory_release(marked->triangles.memory, marked->marks,
                       marked->mark_room * sizeof *marked->marks);
    csg_triangles_release(&marked->triangles);
}

static void give_point(void *user, size_t step, size_t i, double at[3])
{
    const csg_boolean_step *leaf = &((booleans *)user)->steps[step];
    csg_vec3 p = csg_affine_point(&leaf->place, leaf->triangles->points[i]);
    at[0] = p.x;
    at[1] = p.y;
    at[2] = p.z;
}

static void give_triangle(void *user, size_t step, size_t i, uint32_t corners[3])
{
    const csg_boolean_step *leaf = &((booleans *)user)->steps[step];
    bool is_mirrored = csg_affine_determinant(leaf->place) < 0;
    for (int k = 0; k < 3; k++)
        corners[k] = leaf->triangles->corners[i][is_mirrored ? 2 - k : k];
}

static bool should_stop(void *user)
{
    const csg_boolean_watch *watch = ((booleans *)user)->watch;
    return watch->should_stop(watch->user);
}

static bool take_point(void *user, const double at[3])
{
    return csg_triangles_add_point(&((booleans *)user)->out->triangles,
                                   csg_vec3_make(at[0], at[1], at[2]));
}

static bool take_triangle(void *user, const uint32_t corners[3], uint32_t mark)
{
    csg_marked_triangles *out = ((booleans *)user)->out;
    size_t number = out->triangles.count;
    if (!csg_memory_reserve(out->triangles.memory, (void **)&out->marks, &out->mark_room,
                            number + 1, sizeof *out->marks) ||
        !csg_triangles_add(&out->triangles, corners[0], corners[1], corners[2]))
        return false;
    out->marks[number] = mark;
    return true;
}

static csgm_status run_library(csg_memory *memory, booleans *b, size_t count, double tolerance)
{
    const csg_manifold_caller caller = {give_point, give_triangle, should_stop,
                                        take_point, take_triangle, b};
    size_t bytes = count * sizeof(csg_manifold_step);
    csg_manifold_step *steps = csg_memory_alloc(memory, bytes);
    if (!steps)
        return CSGM_ERR_MEMORY;
    uint64_t triangles = 0;
    for (size_t i = 0; i < count; i++) {
        const csg_boolean_step *s = &b->steps[i];
        steps[i] = (csg_manifold_step){.kind = s->kind, .operands = s->operands, .count = s->count};
        if (s->kind == CSG_BOOLEAN_LEAF) {
            steps[i].point_count = s->triangles->point_count;
            steps[i].triangle_count = s->triangles->count;
            steps[i].mark = s->mark;
            triangles += s->triangles->count;
        }
    }
    csgm_status status = CSGM_ERR_MEMORY;
    if (csg_memory_allows(memory, BYTES_MOST * triangles))
        status = csg_manifold_run(steps, count, tolerance, &caller);
    csg_memory_release(memory, steps, bytes);
    return status;
}

csgm_status csg_booleans(csg_memory *memory, const csg_boolean_step *steps, size_t count,
                         double tolerance, const csg_boolean_watch *watch,
                         csg_marked_triangles *out)
{
    booleans b = {steps, watch, out};
    *out = (csg_marked_triangles){0};
    csg_triangles_init(&out->triangles, memory);
    return run_library(memory, &b, count, tolerance);
}

bool csg_booleans_are_available(void)
{
    return csg_manifold_is_available();
}
