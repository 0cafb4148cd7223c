/* SPDX-License-Identifier: MIT
 * Any piece as convex ones, each a cloud of balls in the common frame:
 *   a convex piece is its own cloud;
 *   an extrusion is those over the convex parts of its figure;
 *   a torus, or an arc of one, is a chain of capsules;
 *   a polyhedron is cut by its own planes (shape/polyhedra/convex_parts.h);
 *   all others are tessellated, as finely as their parts are not too many.
 */
#include <math.h>

#include "scene/outlines/flatten.h"
#include "scene/primitives/kinds.h"
#include "shape/plane/polygons.h"
#include "shape/polyhedra/convex_parts.h"
#include "solid/measure.h"
#include "solid/pieces.h"

void csg_clouds_init(csg_clouds *clouds, csg_memory *memory)
{
    *clouds = (csg_clouds){.memory = memory};
}

void csg_clouds_release(csg_clouds *clouds)
{
    for (size_t i = 0; i < clouds->count; i++)
        csg_cloud_release(&clouds->items[i]);
    csg_memory_release(clouds->memory, clouds->items, clouds->capacity * sizeof *clouds->items);
    csg_clouds_init(clouds, clouds->memory);
}

/* An empty cloud at the end; NULL: no memory. */
static csg_cloud *add_cloud(csg_clouds *clouds)
{
    if (!csg_memory_reserve(clouds->memory, (void **)&clouds->items, &clouds->capacity,
                            clouds->count + 1, sizeof *clouds->items))
        return NULL;
    csg_cloud *made = &clouds->items[clouds->count++];
    csg_cloud_init(made, clouds->memory);
    return made;
}

static bool add_corner(csg_cloud *cloud, const csg_solid_piece *piece, csg_vec3 at)
{
    return csg_cloud_add(cloud, csg_affine_point(&piece->map, at), piece->grow);
}

/* ---- kinds of pieces ------------------------------------------------------------------------- */

static csgm_status clouds_of_extrusion(csg_solid_job *job, const csg_solid_piece *piece,
                                       double within, csg_clouds *out)
{
    const csgm_scene *scene = job->builder->scene;
    const csg_node node = scene->nodes[piece->node];
    csg_outline outline, parts;
    double half, middle;
    csg_piece_slab(scene, &node, &half, &middle);
    csgm_status status =
        csg_flatten(job->builder, csg_scene_children(scene, &node)[0], within, &outline);
    if (status != CSGM_OK)
        return status;
    status = csg_polygons_convex_parts(&outline, job->memory, &parts);
    csg_outline_release(&outline);
    if (status != CSGM_OK)
        return status;
    bool ok = true;
    for (size_t loop = 0; loop < parts.loop_count && ok; loop++) {
        csg_cloud *cloud = add_cloud(out);
        ok = cloud != NULL;
        for (size_t i = csg_outline_first(&parts, loop); i < parts.ends[loop] && ok; i++) {
            csg_vec2 p = parts.points[i];
            ok = add_corner(cloud, piece, csg_vec3_make(p.x, p.y, middle - half)) &&
                 add_corner(cloud, piece, csg_vec3_make(p.x, p.y, middle + half));
        }
    }
    csg_outline_release(&parts);
    return ok ? CSGM_OK : CSGM_ERR_MEMORY;
}

/* Its balls stand in order along the ring. */
static csgm_status clouds_of_torus(csg_solid_job *job, const csg_solid_piece *piece, double within,
                                   csg_clouds *out)
{
    const csgm_scene *scene = job->builder->scene;
    const csg_node *node = &scene->nodes[piece->node];
    bool is_closed = csg_scene_parameters(scene, node)[2] >= 180, ok = true;
    csg_cloud ring;
    csg_cloud_init(&ring, job->memory);
    csgm_status status = csg_piece_cloud(job, piece, within, &ring);
    size_t links = ring.count - (ring.count && !is_closed);
    for (size_t i = 0; i < links && ok && status == CSGM_OK; i++) {
        csg_ball ends[2] = {ring.balls[i], ring.balls[(i + 1) % ring.count]};
        csg_cloud *cloud = add_cloud(out);
        ok = cloud && csg_cloud_add(cloud, ends[0].at, ends[0].radius) &&
             csg_cloud_add(cloud, ends[1].at, ends[1].radius);
    }
    csg_cloud_release(&ring);
    return ok ? status : CSGM_ERR_MEMORY;
}

static csgm_status clouds_of_triangles(csg_solid_job *job, const csg_solid_piece *piece,
                                       const csg_triangles *triangles, double slack, size_t most,
                                       csg_clouds *out)
{
    csg_convex_parts parts;
    csg_convex_parts_init(&parts, job->memory);
    csgm_status status = csg_convex_parts_find(triangles, slack, most, &parts);
    bool ok = csg_solid_check_time(job);
    for (size_t i = 0; i < parts.count && ok && status == CSGM_OK; i++) {
        csg_cloud *cloud = add_cloud(out);
        ok = cloud != NULL;
        for (size_t k = i ? parts.ends[i - 1] : 0; k < parts.ends[i] && ok; k++)
            ok = add_corner(cloud, piece, parts.points[k]);
    }
    csg_convex_parts_release(&parts);
    return status != CSGM_OK ? status : ok ? CSGM_OK : CSGM_ERR_MEMORY;
}

/* Its corners are floats, which is what counts as one place. */
static csgm_status clouds_of_any(csg_solid_job *job, const csg_solid_piece *piece, csg_clouds *out)
{
    enum { FINEST = 32, COARSEST = 8, MOST = 200 };
    const double float_slack = 4e-6;
    csgm_status status = CSGM_ERR_LIMIT;
    for (uint32_t cells = FINEST; status == CSGM_ERR_LIMIT && !job->stop && cells >= COARSEST;
         cells /= 2) {
        csg_triangles triangles;
        csg_triangles_init(&triangles, job->memory);
        status = csg_solid_triangles_by(job, piece->node, cells, &triangles);
        if (status == CSGM_OK)
            status = clouds_of_triangles(
                job, piece, &triangles,
                float_slack * csg_box_longest_side(csg_triangles_box(&triangles)), MOST, out);
        csg_triangles_release(&triangles);
    }
    return status;
}

csgm_status csg_piece_convex_clouds(csg_solid_job *job, const csg_solid_piece *piece, double within,
                                    csg_clouds *out)
{
    const double coarser = 10; /* where each step of a curve is a piece of its own */
    const csgm_scene *scene = job->builder->scene;
    const csg_node *node = &scene->nodes[piece->node];
    if (csg_piece_is_convex(job, piece)) {
        csg_cloud *cloud = add_cloud(out);
        return cloud ? csg_piece_cloud(job, piece, within, cloud) : CSGM_ERR_MEMORY;
    }
    if (csg_node_is_plate(node))
        return clouds_of_extrusion(job, piece, coarser * within / csg_map_stretch(&piece->map),
                                   out);
    if (node->kind == CSG_NODE_TORUS && csg_map_factor(&piece->map) > 0)
        return clouds_of_torus(job, piece, coarser * within, out);
    if (node->kind == CSG_NODE_SHAPE &&
        scene->shapes[node->payload]->kind == CSG_SHAPE_POLYHEDRON) {
        const double slack = 1e-9;
        const csg_triangles *own = csg_polyhedron_triangles(scene->shapes[node->payload]);
        return clouds_of_triangles(job, piece, own,
                                   slack * csg_box_longest_side(csg_triangles_box(own)),
                                   CSG_MOST_CONVEX_PIECES, out);
    }
    return clouds_of_any(job, piece, out);
}
