/* SPDX-License-Identifier: MIT
 * Nodes taken apart, and what single pieces are; see pieces.h.
 */
#include "solid/pieces.h"

#include <math.h>

#include "scene/primitives/kinds.h"
#include "scene/primitives/primitive.h"
#include "shape/plane/region.h"
#include "shape/polyhedra/polyhedron.h"

void csg_pieces_init(csg_solid_pieces *pieces, csg_memory *memory)
{
    *pieces = (csg_solid_pieces){.memory = memory};
}

void csg_pieces_release(csg_solid_pieces *pieces)
{
    csg_memory_release(pieces->memory, pieces->items, pieces->capacity * sizeof *pieces->items);
    csg_pieces_init(pieces, pieces->memory);
}

/* ---- maps and extrusions --------------------------------------------------------------------- */

/* How much longer lengths become; 0 when the map is no similarity. */
double csg_map_factor(const csg_affine *map)
{
    double smallest, largest;
    if (!csg_affine_is_similarity(map))
        return 0;
    csg_affine_singular_values(map, &smallest, &largest);
    return largest;
}

/* The plane's and the map's stretch of a length across z: what a tolerance is compared with. */
double csg_map_stretch(const csg_affine *map)
{
    double smallest, largest;
    csg_affine_singular_values(map, &smallest, &largest);
    return largest;
}

/* Of a flat piece the plane part alone is a similarity or not. */
csg_affine csg_map_of_plane(csg_affine map)
{
    double size = sqrt(fabs(map.m[0][0] * map.m[1][1] - map.m[0][1] * map.m[1][0]));
    map.m[0][2] = map.m[1][2] = map.m[2][0] = map.m[2][1] = map.t[2] = 0;
    map.m[2][2] = size > 0 ? size : 1;
    return map;
}

/* Half height and middle of an extrusion's slab. */
void csg_piece_slab(const csgm_scene *scene, const csg_node *node, double *half, double *middle)
{
    const csg_node *slab = &scene->nodes[csg_scene_children(scene, node)[1]];
    *middle = 0;
    if (slab->kind == CSG_NODE_TRANSFORM) {
        *middle = scene->transforms[slab->payload].t[2];
        slab = &scene->nodes[csg_scene_children(scene, slab)[0]];
    }
    *half = scene->parameters[slab->payload];
}

/* ---- taking apart ---------------------------------------------------------------------------- */

bool csg_pieces_add(csg_solid_pieces *pieces, csg_solid_piece piece)
{
    if (!csg_memory_reserve(pieces->memory, (void **)&pieces->items, &pieces->capacity,
                            pieces->count + 1, sizeof piece))
        return false;
    pieces->items[pieces->count++] = piece;
    return true;
}

/* What stands below a node that is not a piece of its own: fills `inner` and returns true. */
static bool is_transparent(const csgm_scene *scene, const csg_solid_piece *piece,
                           csg_solid_piece *inner)
{
    const csg_node *node = &scene->nodes[piece->node];
    *inner = *piece;
    switch (node->kind) {
    case CSG_NODE_TRANSFORM:
        inner->map = csg_affine_multiply(piece->map, scene->transforms[node->payload]);
        return piece->grow == 0 || csg_map_factor(&scene->transforms[node->payload]) > 0;
    case CSG_NODE_COLOR:
        return true;
    case CSG_NODE_OFFSET: {
        double r = scene->parameters[node->payload], factor = csg_map_factor(&piece->map);
        inner->grow += r * factor;
        return r > 0 && factor > 0;
    }
    case CSG_NODE_UNION:
        return csg_blend_is_sharp(node->blend);
    default:
        return false;
    }
}

bool csg_pieces_collect(const csgm_scene *scene, csg_node_id root, csg_solid_pieces *pieces)
{
    csg_solid_pieces work;
    csg_pieces_init(&work, pieces->memory);
    bool ok = csg_pieces_add(&work, (csg_solid_piece){root, csg_affine_identity(), 0});
    while (ok && work.count) {
        csg_solid_piece inner, piece = work.items[--work.count];
        const csg_node *node = &scene->nodes[piece.node];
        if (!is_transparent(scene, &piece, &inner)) {
            ok = node->kind == CSG_NODE_EMPTY || csg_pieces_add(pieces, piece);
            continue;
        }
        for (uint32_t i = node->child_count; i-- > 0 && ok;) {
            inner.node = csg_scene_children(scene, node)[i];
            ok = csg_pieces_add(&work, inner);
        }
    }
    csg_pieces_release(&work);
    return ok;
}

/* ---- prisms ---------------------------------------------------------------------------------- */

/* Does the map keep z apart from x and y? */
static bool keeps_z(const csg_affine *map)
{
    double size = csg_map_stretch(map), slack = 1e-12 * size;
    return fabs(map->m[0][2]) <= slack && fabs(map->m[1][2]) <= slack &&
           fabs(map->m[2][0]) <= slack && fabs(map->m[2][1]) <= slack;
}

bool csg_piece_prism(csg_solid_job *job, const csg_solid_piece *piece, csg_solid_pieces *figure,
                     double heights[2])
{
    csg_scene_builder *builder = job->builder;
    const csg_node node = builder->scene->nodes[piece->node];
    const double *p = builder->scene->parameters + node.payload;
    csg_node_id flat;
    double half, middle = 0;
    if (piece->grow > 0 || !keeps_z(&piece->map))
        return false;
    if (csg_node_is_plate(&node)) {
        csg_piece_slab(builder->scene, &node, &half, &middle);
        flat = csg_scene_children(builder->scene, &node)[0];
    } else if (node.kind == CSG_NODE_BOX && p[3] == 0) {
        const double sides[3] = {p[0], p[1], 0};
        half = p[2];
        flat = csg_build_primitive(builder, CSG_NODE_RECTANGLE, sides, node.where);
    } else if (node.kind == CSG_NODE_FRUSTUM && p[0] == p[1] && p[3] == 0) {
        const double radius = p[0];
        half = p[2];
        flat = csg_build_primitive(builder, CSG_NODE_CIRCLE, &radius, node.where);
    } else {
        return false;
    }
    size_t first = figure->count;
    flat = csg_solid_done(job, flat);
    if (flat == CSG_NODE_NONE || !csg_pieces_collect(job->builder->scene, flat, figure)) {
        csg_solid_no_memory(job);
        return false;
    }
    for (size_t i = first; i < figure->count; i++)
        figure->items[i].map =
            csg_affine_multiply(csg_map_of_plane(piece->map), figure->items[i].map);
    double a = piece->map.m[2][2] * (middle - half) + piece->map.t[2];
    double b = piece->map.m[2][2] * (middle + half) + piece->map.t[2];
    heights[0] = fmin(a, b);
    heights[1] = fmax(a, b);
    return true;
}

/* ---- looks ----------------------------------------------------------------------------------- */

static bool is_convex_region(const csg_outline *outline)
{
    size_t count = outline->point_count;
    if (outline->loop_count != 1)
        return false;
    csg_box box = csg_outline_box(outline);
    double slack = 1e-12 * (box.max.x - box.min.x) * (box.max.y - box.min.y);
    for (size_t i = 0; i < count; i++) {
        csg_vec2 a = outline->points[i], b = outline->points[(i + 1) % count],
                 c = outline->points[(i + 2) % count];
        if ((b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x) < -slack)
            return false;
    }
    return true;
}

bool csg_piece_is_convex(const csg_solid_job *job, const csg_solid_piece *piece)
{
    const csgm_scene *scene = job->builder->scene;
    const csg_node *node = &scene->nodes[piece->node];
    csg_solid_piece inner = *piece;
    csg_solid_pieces figure;
    /* what is no distance gives no cloud: a tessellation stands for it, which need not be convex */
    const unsigned wanted = CSG_TRAIT_CONVEX | CSG_TRAIT_BOUNDED | CSG_TRAIT_OUTSIDE;
    if (csg_node_is_named_primitive(node->kind))
        return (csg_primitive_of(node->kind)->traits & wanted) == wanted;
    if (node->kind == CSG_NODE_SHAPE) {
        const csg_shape *shape = scene->shapes[node->payload];
        return shape->kind == CSG_SHAPE_POLYHEDRON ? csg_polyhedron_is_convex(shape)
                                                   : is_convex_region(csg_region_outline(shape));
    }
    if (!csg_node_is_plate(node))
        return false;
    inner.node = csg_scene_children(scene, node)[0];
    csg_pieces_init(&figure, job->memory);
    bool convex = csg_pieces_collect(job->builder->scene, inner.node, &figure) &&
                  figure.count == 1 &&
                  scene->nodes[figure.items[0].node].kind != CSG_NODE_INTERSECTION &&
                  csg_piece_is_convex(job, &figure.items[0]);
    csg_pieces_release(&figure);
    return convex;
}

bool csg_piece_ball(const csgm_scene *scene, const csg_solid_piece *piece, csg_ball *out)
{
    const csg_node *node = &scene->nodes[piece->node];
    bool flat = node->kind == CSG_NODE_CIRCLE;
    csg_affine map = flat ? csg_map_of_plane(piece->map) : piece->map;
    double factor = csg_map_factor(&map);
    if ((node->kind != CSG_NODE_SPHERE && !flat) || factor == 0)
        return false;
    out->at = csg_affine_point(&map, csg_vec3_make(0, 0, 0));
    out->radius = scene->parameters[node->payload] * factor + piece->grow;
    return true;
}

csg_node_id csg_piece_placed(csg_solid_job *job, const csg_solid_piece *piece)
{
    csg_node_id node = csg_solid_done(job, csg_build_copy(job->builder, piece->node));
    return csg_solid_grown(job, csg_solid_moved(job, node, &piece->map), piece->grow);
}
