/* SPDX-License-Identifier: MIT
 * A mesh's vertices against the field in double; see max_abs_field.h.
 */
#include "api/max_abs_field.h"

#include <math.h>

#include "api/view.h"
#include "io/parts.h"
#include "scene/reference.h"
#include "scene/tree/parts.h"

uint64_t csg_max_abs_step(const csgm_scene *scene, uint64_t vertex_count)
{
    enum { CALL_NODES = 32 }; /* that one evaluation costs, whatever it is of */
    static const uint64_t FEWEST_NODES = 1000000, MOST_NODES = 50000000;
    uint64_t nodes = vertex_count / 4 > FEWEST_NODES ? vertex_count / 4 : FEWEST_NODES;
    nodes = nodes < MOST_NODES ? nodes : MOST_NODES;
    return vertex_count / (nodes / (scene->node_count + CALL_NODES) + 1) + 1;
}

void csg_max_abs_look(csg_max_abs *known, const csgm_scene *scene, csgm_vec3 origin,
                      const float *at)
{
    csgm_status status = CSGM_OK;
    csgm_vec3 p = csg_vec3_add(origin, csg_vec3_from_floats(at));
    double value = fabs(csg_reference_eval(scene, p, &status).value);
    known->measured++;
    if (status != CSGM_OK || isnan(value))
        known->largest = NAN;
    else if (value > known->largest)
        known->largest = value;
}

void csg_max_abs_add(csg_max_abs *known, const csg_max_abs *other)
{
    known->measured += other->measured;
    if (isnan(other->largest) || other->largest > known->largest)
        known->largest = other->largest;
}

/* Vertices of [first, end), every step-th. */
static void look_at_stretch(csg_max_abs *known, const csgm_scene *scene, const csgm_mesh_view *mesh,
                            uint64_t first, uint64_t end, uint64_t step)
{
    for (uint64_t i = first; i < end && !isnan(known->largest); i += step)
        csg_max_abs_look(known, scene, mesh->origin, mesh->positions + 3 * i);
}

/* Each part of the mesh against the part of the scene with its name: where parts touch, the scene's
 * own field knows no surface. NaN when there is none of that name or memory runs out. */
static void look_at_part(csg_max_abs *known, const csg_parts *parts, const csgm_mesh_view *mesh,
                         uint64_t index, uint64_t step)
{
    csg_part_stretch part = csg_part_get(mesh, index);
    size_t i;
    csgm_scene *scene;
    if (!csg_parts_index(parts, part.name, &i) || csg_parts_scene(parts, i, &scene) != CSGM_OK) {
        known->largest = NAN;
        return;
    }
    look_at_stretch(known, scene, mesh, part.first_vertex, part.first_vertex + part.vertex_count,
                    step);
    csg_scene_destroy(scene);
}

double csgm_mesh_max_abs_field(const csgm_scene *scene, const csgm_mesh_view *mesh,
                               uint64_t *measured)
{
    uint64_t step = csg_max_abs_step(scene, mesh->vertex_count);
    csg_parts parts = {.scene = scene};
    csg_max_abs known = {0};
    if (csg_parts_find(&parts, scene) != CSGM_OK)
        known.largest = NAN;
    if (!parts.count || !mesh->part_count)
        look_at_stretch(&known, scene, mesh, 0, mesh->vertex_count, step);
    for (uint64_t i = 0; parts.count && i < mesh->part_count && !isnan(known.largest); i++)
        look_at_part(&known, &parts, mesh, i, step);
    csg_parts_reset(&parts);
    if (measured)
        *measured = known.measured;
    return known.largest;
}
