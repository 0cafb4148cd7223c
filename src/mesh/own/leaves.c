/* SPDX-License-Identifier: MIT
 * See leaves.h.
 */
#include "mesh/own/leaves.h"

#include "scene/primitives/kinds.h"
#include "shape/plane/region.h"
#include "shape/polyhedra/polyhedron.h"
#include "shape/polyhedra/prism.h"

csg_own_way csg_own_way_below(const csgm_scene *scene, const csg_node *node, csg_own_way way)
{
    if (node->kind == CSG_NODE_TRANSFORM)
        way.place = csg_affine_multiply(way.place, scene->transforms[node->payload]);
    else if (node->kind == CSG_NODE_COLOR)
        csg_look_take_inner(&way.look, &scene->looks[node->payload]);
    return way;
}

static bool is_shape(const csgm_scene *scene, const csg_node *node, csg_shape_kind kind)
{
    return node->kind == CSG_NODE_SHAPE && scene->shapes[node->payload]->kind == kind;
}

static bool is_sharp_box(const csgm_scene *scene, const csg_node *node)
{
    return node->kind == CSG_NODE_BOX && !(csg_scene_parameters(scene, node)[3] > 0);
}

static bool is_sharp_rectangle(const csgm_scene *scene, const csg_node *node)
{
    return node->kind == CSG_NODE_RECTANGLE && !(csg_scene_parameters(scene, node)[2] > 0);
}

/* ---- boxes -------------------------------------------------------------------------------------
 */

/* half: sizes. */
static csgm_status make_box(csg_memory *memory, csg_vec3 half, double middle, csg_own_leaf *leaf)
{
    static const uint32_t SIDES[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    csg_triangles triangles;
    bool added = true;
    csg_triangles_init(&triangles, memory);
    for (int i = 0; i < 8 && added; i++)
        added = csg_triangles_add_point(
            &triangles, csg_vec3_make(i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y,
                                      middle + (i & 4 ? half.z : -half.z)));
    for (int i = 0; i < 6 && added; i++)
        added = csg_triangles_add_face(&triangles, SIDES[i], 4);
    csgm_status status = CSGM_ERR_MEMORY;
    if (added)
        status = csg_polyhedron_create(memory, &triangles, NULL, &leaf->shape);
    csg_triangles_release(&triangles);
    return status;
}

/* ---- plates ------------------------------------------------------------------------------------
 */

/* Down to a leaf through transforms and colours. */
static const csg_node *leaf_below(const csgm_scene *scene, const csg_node *node, csg_own_way *way)
{
    while (node->kind == CSG_NODE_TRANSFORM || node->kind == CSG_NODE_COLOR) {
        *way = csg_own_way_below(scene, node, *way);
        node = &scene->nodes[csg_scene_children(scene, node)[0]];
    }
    return node;
}

/* To places that are floats in the scene, where these are the same all along z: triangles of a lid
 * that are thin are then as thin as they will be. */
static void round_points(csg_outline *outline, const csg_affine *place)
{
    csg_affine back;
    if (place->m[0][2] != 0 || place->m[1][2] != 0 || !csg_affine_invert(*place, &back))
        return;
    for (size_t i = 0; i < outline->point_count; i++) {
        csg_vec2 *p = &outline->points[i];
        csg_vec3 at = csg_affine_point(place, csg_vec3_make(p->x, p->y, 0));
        at.x = (double)(float)at.x;
        at.y = (double)(float)at.y;
        at = csg_affine_point(&back, at);
        *p = (csg_vec2){at.x, at.y};
    }
}

static csgm_status make_prism(const csgm_scene *scene, const csg_node *figure, double half,
                              double middle, csg_own_leaf *leaf)
{
    csg_memory *memory = &scene->context->memory;
    csg_outline outline;
    csg_triangles triangles;
    csg_repairs repairs;
    csgm_status status = CSGM_ERR_MEMORY;
    csg_outline_init(&outline, memory);
    if (csg_outline_append(&outline, csg_region_outline(scene->shapes[figure->payload]))) {
        round_points(&outline, &leaf->way.place);
        status = csg_prism(memory, &outline, middle - half, middle + half, &triangles);
    }
    csg_outline_release(&outline);
    if (status != CSGM_OK)
        return status;
    status = csg_polyhedron_create(memory, &triangles, &repairs, &leaf->shape);
    csg_triangles_release(&triangles);
    return status;
}

/* The shape stays NULL: the plate is none of an outline. */
static csgm_status extrude(const csgm_scene *scene, const csg_node *plate, csg_own_leaf *leaf)
{
    const csg_node_id *children = csg_scene_children(scene, plate);
    csg_own_way flat = {.place = csg_affine_identity(), .look = leaf->way.look}, ends = flat;
    const csg_node *figure = leaf_below(scene, &scene->nodes[children[0]], &flat);
    const csg_node *slab = leaf_below(scene, &scene->nodes[children[1]], &ends);
    if (slab->kind != CSG_NODE_SLAB)
        return CSGM_OK;
    leaf->way.place = csg_affine_multiply(leaf->way.place, csg_affine_of_plane(flat.place));
    leaf->way.look = flat.look;
    double half = csg_scene_parameters(scene, slab)[0], middle = ends.place.t[2];
    const double *sizes = csg_scene_parameters(scene, figure);
    csgm_status status = CSGM_OK;
    if (is_shape(scene, figure, CSG_SHAPE_REGION))
        status = make_prism(scene, figure, half, middle, leaf);
    else if (is_sharp_rectangle(scene, figure))
        status = make_box(&scene->context->memory, csg_vec3_make(sizes[0], sizes[1], half), middle,
                          leaf);
    return status == CSGM_ERR_MEMORY ? status : CSGM_OK;
}

/* ---- all of them -------------------------------------------------------------------------------
 */

csg_own_leaf_kind csg_own_leaf_kind_of(const csgm_scene *scene, const csg_node *node)
{
    csg_own_way ignored = {.place = csg_affine_identity()};
    if (is_shape(scene, node, CSG_SHAPE_POLYHEDRON))
        return CSG_OWN_LEAF_SHAPE;
    if (is_sharp_box(scene, node))
        return CSG_OWN_LEAF_BOX;
    if (!csg_node_is_plate(node))
        return CSG_OWN_LEAF_NONE;
    const csg_node_id *children = csg_scene_children(scene, node);
    const csg_node *figure = leaf_below(scene, &scene->nodes[children[0]], &ignored);
    const csg_node *slab = leaf_below(scene, &scene->nodes[children[1]], &ignored);
    return slab->kind != CSG_NODE_SLAB                 ? CSG_OWN_LEAF_NONE
           : is_shape(scene, figure, CSG_SHAPE_REGION) ? CSG_OWN_LEAF_SHAPE
           : is_sharp_rectangle(scene, figure)         ? CSG_OWN_LEAF_BOX
                                                       : CSG_OWN_LEAF_NONE;
}

csgm_status csg_own_leaf_make(const csgm_scene *scene, const csg_node *node, const csg_own_way *way,
                              csg_own_leaf *leaf)
{
    *leaf = (csg_own_leaf){.way = *way};
    if (csg_node_is_plate(node))
        return extrude(scene, node, leaf);
    if (is_sharp_box(scene, node)) {
        const double *half = csg_scene_parameters(scene, node);
        return make_box(&scene->context->memory, csg_vec3_make(half[0], half[1], half[2]), 0, leaf);
    }
    leaf->shape = scene->shapes[node->payload];
    csg_shape_retain(leaf->shape);
    return CSGM_OK;
}
