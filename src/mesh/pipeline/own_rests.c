/* SPDX-License-Identifier: MIT
 * See own_rests.h.
 */
#include "mesh/pipeline/own_rests.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "base/trace.h"
#include "mesh/pipeline/stats.h"
#include "mesh/pipeline/tries.h"
#include "shape/polyhedra/polyhedron.h"

/* How far beyond everything a rest is cut, in tolerances: its cut is then nowhere near a surface of
 * the whole. */
static const double MARGIN = 8;

/* ---- a rest as a scene -------------------------------------------------------------------------
 */

/* Around the solid and around all polyhedra, what is taken off them too. */
static csg_box box_of_everything(const csg_own_rests *rests, const csg_own_units *units)
{
    csg_box box = rests->input->field->bounds;
    for (size_t i = 0; i < units->count; i++)
        if (!units->items[i].member_count)
            box = csg_box_hull(box, units->items[i].box);
    return csg_box_grow(box, MARGIN * rests->tolerance);
}

/* That box, where the rest reaches out of it, else empty: nothing has to be cut. */
static csg_box box_to_cut(const csg_own_rests *rests, const csg_own_units *units,
                          const csg_own_unit *unit)
{
    const csgm_scene *scene = rests->input->field->scene;
    csg_box whole = box_of_everything(rests, units);
    for (size_t i = 0; i < unit->member_count; i++) {
        const csg_excerpt_item *member = &units->members[unit->first_member + i];
        csg_box own = scene->bounds[member->node];
        if (csg_box_is_empty(own))
            continue;
        if (!csg_box_is_finite(own) ||
            !csg_box_contains_box(whole, csg_affine_box(&member->place, own)))
            return whole;
    }
    return csg_box_empty();
}

static csgm_status begin_rest(const csg_own_rests *rests, const csg_own_units *units,
                              const csg_own_unit *unit, csg_own_rest *rest)
{
    const csg_excerpt excerpt = {.kind = unit->kind,
                                 .items = units->members + unit->first_member,
                                 .count = unit->member_count,
                                 .within = box_to_cut(rests, units, unit)};
    csgm_context *context = rests->input->context;
    csgm_status status = csg_scene_excerpt(rests->input->field->scene, &excerpt, &rest->scene);
    if (status == CSGM_ERR_MEMORY ||
        (status == CSGM_OK && !csg_reference_room_begin(&rest->room, rest->scene)))
        return csg_context_no_memory(context);
    return status;
}

/* ---- its triangles -----------------------------------------------------------------------------
 */

static csgm_status make_triangles(const csgm_mesh *mesh, csg_triangles *out)
{
    bool added = true;
    csg_triangles_init(out, &mesh->context->memory);
    for (uint64_t i = 0; i < mesh->vertex_count && added; i++)
        added = csg_triangles_add_point(
            out, csg_vec3_add(mesh->origin, csg_vec3_from_floats(mesh->positions + 3 * i)));
    for (uint64_t i = 0; i < mesh->triangle_count && added; i++)
        added = csg_triangles_add(out, mesh->indices[3 * i], mesh->indices[3 * i + 1],
                                  mesh->indices[3 * i + 2]);
    return added ? CSGM_OK : CSGM_ERR_MEMORY;
}

static csgm_status give_triangles(csg_own_unit *unit, const csgm_mesh *mesh)
{
    csg_triangles triangles;
    csg_shape *shape;
    csgm_status status = make_triangles(mesh, &triangles);
    if (status == CSGM_OK && triangles.count) {
        status = csg_polyhedron_create(&mesh->context->memory, &triangles, NULL, &shape);
        if (status == CSGM_OK)
            csg_own_units_give(unit, shape);
    }
    csg_triangles_release(&triangles);
    return status == CSGM_ERR_MEMORY ? csg_context_no_memory(mesh->context) : CSGM_OK;
}

/* Of `count` rests it is number `index`. */
static csgm_status mesh_field(csg_own_rests *rests, const csgm_field *field, size_t index,
                              size_t count, csgm_mesh **out)
{
    const csg_mesh_input *input = rests->input;
    csgm_mesh_options options = *input->options;
    options.bounds = csg_box_empty();
    options.normals = CSGM_NORMALS_NONE;
    options.colors = false;
    options.triangles = 0;
    options.simplify_error = rests->tolerance;
    csg_mesh_share share = {.origin = csg_mesh_origin_of(input),
                            .is_operand = true,
                            .started_s = rests->started_s,
                            .amount = 1};
    if (input->share) {
        share = *input->share;
        share.is_operand = true;
        share.colors = share.materials = false;
    }
    share.amount /= (double)count;
    share.before += (double)index * share.amount;
    csgm_mesh_stats stats = {0};
    csgm_status status =
        csg_mesh_build_tries(input->context, field, &options, &share, NULL, out, &stats);
    csg_mesh_add_stats(&rests->stats, &stats);
    return status;
}

static csgm_status mesh_rest(csg_own_rests *rests, const csg_own_units *units, csg_own_unit *unit,
                             csg_own_rest *rest)
{
    csgm_field *field = NULL;
    csgm_mesh *mesh = NULL;
    csgm_status status = begin_rest(rests, units, unit, rest);
    if (status == CSGM_OK)
        status = csg_field_compile(rests->input->context, rest->scene, &field);
    if (status == CSGM_OK && !csg_box_is_empty(field->bounds)) {
        rest->box = csg_box_grow(field->bounds, rests->tolerance);
        status = mesh_field(rests, field, rests->count - 1, units->rest_count, &mesh);
    }
    if (status == CSGM_OK && mesh)
        status = give_triangles(unit, mesh);
    csg_mesh_destroy(mesh);
    csg_field_destroy(field);
    return status;
}

csgm_status csg_own_rests_mesh(csg_own_rests *rests, csg_own_units *units,
                               const csg_mesh_input *input)
{
    csg_memory *memory = &input->context->memory;
    *rests =
        (csg_own_rests){.input = input, .room = units->rest_count, .started_s = csg_clock_now_s()};
    if (!units->rest_count)
        return CSGM_OK;
    CSG_ZONE(input->context, "own triangles: rests");
    rests->tolerance = csg_mesh_tries_tolerance(input->field, input->options, input->share);
    rests->items = csg_memory_alloc(memory, rests->room * sizeof *rests->items);
    if (!rests->items)
        return csg_context_no_memory(input->context);
    memset(rests->items, 0, rests->room * sizeof *rests->items);
    csgm_status status = CSGM_OK;
    for (size_t i = 0; i < units->count && status == CSGM_OK; i++)
        if (units->items[i].member_count)
            status = mesh_rest(rests, units, &units->items[i], &rests->items[rests->count++]);
    return status;
}

void csg_own_rests_release(csg_own_rests *rests)
{
    for (size_t i = 0; i < rests->count; i++) {
        csg_own_rest *rest = &rests->items[i];
        if (rest->room.heap)
            csg_reference_room_end(&rest->room, rest->scene);
        csg_scene_destroy(rest->scene);
    }
    if (rests->items)
        csg_memory_release(&rests->input->context->memory, rests->items,
                           rests->room * sizeof *rests->items);
    *rests = (csg_own_rests){0};
}

/* ---- normals -----------------------------------------------------------------------------------
 */

/* A mesh within the tolerance has places where the field is that large. */
static bool is_on(const csg_own_rests *rests, csg_own_rest *rest, csg_vec3 at, csg_vec3 *gradient)
{
    if (!csg_box_contains_box(rest->box, (csg_box){at, at}))
        return false;
    csg_node_id root = rest->scene->root;
    csg_sample sample = csg_reference_below(&rest->room, rest->scene, 0, root, at);
    *gradient = csg_vec3_normalize(
        csg_reference_true_gradient(&rest->room, rest->scene, 0, root, at, sample));
    return fabs(sample.value) <= 2 * rests->tolerance;
}

bool csg_own_rests_normal(void *user, csg_vec3 place, csg_vec3 face, csg_vec3 *normal)
{
    csg_own_rests *rests = user;
    csg_vec3 at = csg_vec3_add(place, csg_mesh_origin_of(rests->input));
    for (size_t i = 0; i < rests->count; i++) {
        csg_vec3 gradient;
        if (!rests->items[i].room.heap || !is_on(rests, &rests->items[i], at, &gradient))
            continue;
        double along = csg_vec3_dot(gradient, face);
        if (fabs(along) > CSG_OWN_LEAST_COSINE) {
            *normal = csg_vec3_scale(gradient, along > 0 ? 1 : -1);
            return true;
        }
    }
    return false;
}
