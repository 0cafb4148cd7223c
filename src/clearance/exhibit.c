/* SPDX-License-Identifier: MIT
 * See exhibit.h. One part is solid, the other is marked as # marks (seen through, over what is
 * behind it), all others as % does. What both have in common is red: the solid part is what it has
 * alone and what it shares, in two colours. Nearest points are two red balls and a rod between.
 */
#include "clearance/exhibit.h"

#include <math.h>

#include "scene/tree/excerpt.h"
#include "scene/tree/parts.h"

static const csg_color plain = {0.33f, 0.55f, 0.78f, 1}, place = {0.86f, 0.09f, 0.09f, 1};

typedef struct exhibit {
    csg_scene_builder b;
    csg_parts parts;
    size_t shown[2]; /* the solid part and the other, among the scene's */
    csg_span where;
} exhibit;

/* Which of the parts shown a unit belongs to; 2: another. */
static int side_of(const exhibit *e, const csg_part_unit *unit)
{
    uint32_t number = e->parts.ways[unit->way].look.part;
    for (int side = 0; side < 2; side++)
        if (e->parts.numbers[e->shown[side]] == number)
            return side;
    return 2;
}

/* The units of a side as one union. They are used up: later ones are copies of it. */
static csg_node_id build_side(exhibit *e, int side, csg_node_id *nodes)
{
    size_t count = 0;
    for (size_t i = 0; i < e->parts.unit_count; i++) {
        const csg_part_unit *unit = &e->parts.units[i];
        const csg_part_way *way = &e->parts.ways[unit->way];
        const csg_excerpt_item item = {unit->node, way->place, way->look};
        if (side_of(e, unit) != side)
            continue;
        nodes[count++] = csg_excerpt_place(&e->b, &item);
    }
    return csg_build_operator(&e->b, CSG_NODE_UNION, CSG_SHARP, nodes, count, e->where);
}

static csg_node_id build_two(exhibit *e, csg_node_kind kind, csg_node_id a, csg_node_id b)
{
    const csg_node_id both[] = {a, b};
    return csg_build_operator(&e->b, kind, CSG_SHARP, both, 2, e->where);
}

static csg_node_id paint(exhibit *e, csg_color color, csg_node_id node)
{
    return csg_build_color(&e->b, color, node, e->where);
}

static csg_node_id build_common(exhibit *e, csg_node_id solid, csg_node_id other)
{
    csg_node_id solid_again = csg_build_copy(&e->b, solid),
                other_again = csg_build_copy(&e->b, other);
    csg_node_id alone = build_two(e, CSG_NODE_DIFFERENCE, solid, other);
    csg_node_id common = build_two(e, CSG_NODE_INTERSECTION, solid_again, other_again);
    return build_two(e, CSG_NODE_UNION, paint(e, plain, alone), paint(e, place, common));
}

static csg_node_id build_ball(exhibit *e, csg_vec3 at, double r)
{
    csg_affine there = csg_affine_translate(at);
    return csg_build_transform(&e->b, &there, csg_build_ball(&e->b, r, e->where), e->where);
}

static csg_node_id build_nearest(exhibit *e, const csgm_clear_pair *pair, double mark,
                                 csg_node_id solid)
{
    static const double THIN = 0.4; /* of the balls' radius */
    csg_node_id node = paint(e, plain, solid);
    if (!(mark > 0) || pair->by_boxes || !isfinite(pair->gap.high) ||
        pair->state == CSGM_CLEAR_UNDECIDED)
        return node;
    csg_node_id rod = csg_build_capsule(&e->b, pair->nearest[0], pair->nearest[1], THIN * mark,
                                        THIN * mark, e->where);
    for (int i = 0; i < 2; i++)
        rod = build_two(e, CSG_NODE_UNION, rod, build_ball(e, pair->nearest[i], mark));
    return build_two(e, CSG_NODE_UNION, node, paint(e, place, rod));
}

/* The others as scenes of their own, and the root. nodes: room for all units. */
static csgm_status build(exhibit *e, const csgm_clear_pair *pair, double mark, csg_node_id *nodes,
                         csgm_scene *marked[CSGM_MARK_COUNT], csg_node_id *root)
{
    csg_node_id sides[3];
    for (int side = 0; side < 3; side++)
        sides[side] = build_side(e, side, nodes);
    csgm_status status = csg_build_snapshot(&e->b, sides[1], &marked[CSGM_MARK_HIGHLIGHT]);
    if (status == CSGM_OK && e->parts.count > 2)
        status = csg_build_snapshot(&e->b, sides[2], &marked[CSGM_MARK_BACKGROUND]);
    if (status == CSGM_OK)
        *root = pair->state == CSGM_CLEAR_INTERFERING ? build_common(e, sides[0], sides[1])
                                                      : build_nearest(e, pair, mark, sides[0]);
    return status == CSGM_OK ? e->b.status : status;
}

static csgm_status seal(exhibit *e, const csgm_clear_pair *pair, double mark, csg_node_id *nodes,
                        csgm_scene **out)
{
    csgm_scene *marked[CSGM_MARK_COUNT] = {NULL, NULL};
    csg_node_id root = CSG_NODE_NONE;
    csgm_status status = build(e, pair, mark, nodes, marked, &root);
    if (status == CSGM_OK)
        status = csg_build_finish(&e->b, root, NULL, 0, out);
    for (int i = 0; i < CSGM_MARK_COUNT; i++)
        if (status == CSGM_OK)
            (*out)->marked[i] = marked[i];
        else
            csg_scene_destroy(marked[i]);
    return status;
}

csgm_status csg_clear_exhibit(const csgm_scene *scene, const csgm_clear_pair *pair, int solid,
                              double mark, csgm_scene **out)
{
    csgm_context *context = scene->context;
    csg_memory *memory = &context->memory;
    exhibit e = {.where = scene->nodes[scene->root].where};
    csgm_status status = csg_parts_find(&e.parts, scene);
    size_t bytes = (e.parts.unit_count + 1) * sizeof(csg_node_id);
    csg_node_id *nodes = status == CSGM_OK ? csg_memory_alloc(memory, bytes) : NULL;
    if (status == CSGM_OK && !nodes)
        status = CSGM_ERR_MEMORY;
    if (status == CSGM_OK && (!csg_parts_index(&e.parts, pair->names[solid], &e.shown[0]) ||
                              !csg_parts_index(&e.parts, pair->names[1 - solid], &e.shown[1])))
        status = CSGM_ERR_ARGUMENT;
    if (status == CSGM_OK)
        status = csg_build_begin(&e.b, context);
    if (status == CSGM_OK) {
        status = csg_excerpt_load(&e.b, scene) ? seal(&e, pair, mark, nodes, out) : CSGM_ERR_MEMORY;
        csg_build_abandon(&e.b);
    }
    csg_memory_release(memory, nodes, bytes);
    csg_parts_reset(&e.parts);
    return status == CSGM_ERR_MEMORY ? csg_context_no_memory(context) : status;
}
