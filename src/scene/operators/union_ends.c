/* SPDX-License-Identifier: MIT
 * The search of a union's ends; see union_ends.h.
 */
#include "scene/operators/union_ends_private.h"

enum { MOST_WORK = 20000000 }; /* nodes times normals; above it the frame's own axes only */

/* Blends whose radius is r do not come to where all operands but one lie this many radii behind. */
static const double FAR = 2;

static void see_all(csg_end_search *s)
{
    s->seen_count = 0;
    s->seen[s->seen_count++] = s->root;
    for (size_t at = 0; at < s->seen_count; at++) {
        const csg_node *node = &s->scene->nodes[s->seen[at]];
        for (uint32_t k = 0; k < node->child_count && (at == 0 || !csg_union_adds(node)); k++)
            s->seen[s->seen_count++] = csg_scene_children(s->scene, node)[k];
    }
}

static double excess_of(const csg_end_search *s, const csg_node *node)
{
    return csg_blend_is_fillet(node->blend) ? 0 : csg_scene_excess(s->scene, node);
}

/* End number i: keeps how far the operands reach, and where they have a face there. */
static void take_reaches(csg_end_search *s, size_t i, size_t count)
{
    const csg_node *node = &s->scene->nodes[s->root];
    const csg_node_id *children = csg_scene_children(s->scene, node);
    double next = -INFINITY, r = csg_scene_blend(s->scene, node).n;
    csg_end_reach most = {-INFINITY, false};
    for (uint32_t k = 0; k < node->child_count; k++) {
        csg_end_reach one = s->reaches[children[k]];
        s->reached[k * count + i] = one.at;
        next = fmax(next, fmin(most.at, one.at));
        most = csg_farther_end_reach(most, one);
    }
    bool is_near = next >= most.at - FAR * r, is_round = s->made[i].is_round;
    bool ends = is_near && most.has_face && isfinite(most.at) && (!is_round || most.at > 0);
    s->flush[i] = ends ? most.at : INFINITY;
    if (i >= CSG_END_SIDES || is_round)
        return;
    csg_sides *known = &s->sides[s->settled[s->root] - 1];
    double box = csg_box_reach(s->scene->bounds[s->root], s->made[i].normal);
    double over = most.at + (is_near && !ends ? excess_of(s, node) : 0) - box;
    known->has_face[i] = most.has_face;
    known->over[i] = isfinite(box) && !(over <= csg_near_end(box)) ? over : 0;
    s->is_loose[s->root] |= known->over[i] > 0;
}

static bool reserve_ends(csg_end_search *s, size_t count, size_t operands)
{
    csg_memory *memory = s->scratch->memory;
    void *made = s->made, *reached = s->reached, *flush = s->flush;
    bool done = csg_memory_reserve(memory, &made, &s->made_capacity, count, sizeof *s->made) &&
                csg_memory_reserve(memory, &flush, &s->flush_capacity, count, sizeof *s->flush) &&
                csg_memory_reserve(memory, &reached, &s->reached_capacity, count * operands,
                                   sizeof *s->reached);
    s->made = made;
    s->flush = flush;
    s->reached = reached;
    return done;
}

/* The ends of the union; *found: how many. */
static bool find_ends(csg_end_search *s, size_t *found)
{
    see_all(s);
    if (!csg_end_find_normals(s))
        return false;
    size_t nodes = s->seen_count;
    if (nodes * s->found_count > MOST_WORK)
        s->found_count = CSG_END_SIDES;
    csg_end_find_axes(s);
    if (nodes * s->axis_count > MOST_WORK)
        s->axis_count = 0;
    size_t count = *found = s->found_count + s->axis_count;
    if (!reserve_ends(s, count, s->scene->nodes[s->root].child_count))
        return false;
    s->is_loose[s->root] = false;
    s->settled[s->root] = (uint32_t)++s->sides_count;
    for (size_t i = 0; i < count; i++) {
        bool is_round = i >= s->found_count;
        if (is_round) {
            s->made[i] = s->axes[i - s->found_count];
            csg_end_find_off(s, &s->axes[i - s->found_count]);
        } else {
            s->made[i] = (csg_fillet_end){.normal = s->found[i]};
            csg_end_find_reaches(s, s->found[i]);
        }
        take_reaches(s, i, count);
    }
    return true;
}

static bool is_sought(const csg_node *node, bool (*is_wanted)(const csg_node *node))
{
    return node->kind == CSG_NODE_UNION && is_wanted(node);
}

/* Nothing, where no union is wanted. */
static bool make_room(csg_end_search *s, bool (*is_wanted)(const csg_node *node))
{
    size_t nodes = s->scene->node_count, wanted = 0;
    for (size_t i = 0; i < nodes; i++)
        wanted += is_sought(&s->scene->nodes[i], is_wanted);
    if (!wanted)
        return true;
    s->seen = csg_arena_calloc(s->scratch, nodes, sizeof *s->seen);
    s->to_own = csg_arena_calloc(s->scratch, nodes, sizeof *s->to_own);
    s->is_placed = csg_arena_calloc(s->scratch, nodes, sizeof *s->is_placed);
    s->normals = csg_arena_calloc(s->scratch, nodes, sizeof *s->normals);
    s->reaches = csg_arena_calloc(s->scratch, nodes, sizeof *s->reaches);
    s->is_loose = csg_arena_calloc(s->scratch, nodes, sizeof *s->is_loose);
    s->settled = csg_arena_calloc(s->scratch, nodes, sizeof *s->settled);
    s->sides = csg_arena_calloc(s->scratch, wanted, sizeof *s->sides);
    return s->seen && s->to_own && s->is_placed && s->normals && s->reaches && s->is_loose &&
           s->settled && s->sides;
}

static bool has_loose_child(const csg_end_search *s, const csg_node *node)
{
    const csg_node_id *children = csg_scene_children(s->scene, node);
    for (uint32_t k = 0; k < node->child_count; k++)
        if (s->is_loose[children[k]])
            return true;
    return false;
}

csgm_status csg_union_ends_find(const csgm_scene *scene, bool (*is_wanted)(const csg_node *node),
                                csg_union_ends_take *take, void *user)
{
    csg_arena scratch;
    csg_memory *memory = &scene->context->memory;
    csg_arena_init(&scratch, memory);
    csg_end_search s = {.scene = scene, .scratch = &scratch};
    bool done = make_room(&s, is_wanted);
    for (size_t i = 0; done && s.seen && i < scene->node_count; i++) {
        s.is_loose[i] = has_loose_child(&s, &scene->nodes[i]);
        if (!is_sought(&scene->nodes[i], is_wanted))
            continue;
        size_t count = 0;
        s.root = (csg_node_id)i;
        done = find_ends(&s, &count) &&
               take(user, s.root, &(csg_union_ends){s.made, s.reached, s.flush, count});
    }
    csg_memory_release(memory, s.found, s.found_capacity * sizeof *s.found);
    csg_memory_release(memory, s.made, s.made_capacity * sizeof *s.made);
    csg_memory_release(memory, s.reached, s.reached_capacity * sizeof *s.reached);
    csg_memory_release(memory, s.flush, s.flush_capacity * sizeof *s.flush);
    csg_arena_reset(&scratch);
    return done ? CSGM_OK : CSGM_ERR_MEMORY;
}
