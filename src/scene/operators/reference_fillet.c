/* SPDX-License-Identifier: MIT
 * The tree of a fillet in the reference; see reference.h. Signs go down to the pieces, as on
 * the tape; what transforms, offsets and warps do to a value and its gradient goes up to them.
 */

#include "scene/operators/blend_kinds.h"
#include "scene/operators/fillet.h"
#include "scene/reference.h"

bool csg_fillet_is_outermost(const csg_node *node)
{
    return csg_node_is_fillet(node) &&
           (!(node->flags & CSG_FLAG_HELD) || node->flags & CSG_FLAG_PIECE);
}

/* Whether it hands up its children in the tree of this root. */
static bool is_open(const csg_node *node, csg_node_id id, csg_node_id root)
{
    return id == root || !(node->flags & CSG_FLAG_PIECE);
}

static double scale_of(const csgm_scene *scene, const csg_node *node)
{
    return node->kind == CSG_NODE_TRANSFORM ? scene->scales[node->payload]
           : node->kind == CSG_NODE_WARP    ? csg_warp_scale(&scene->warps[node->payload])
                                            : 1;
}

static void hand_down(const csgm_scene *scene, csg_node_id id, csg_fillet_node *room)
{
    const csg_node *node = &scene->nodes[id];
    for (uint32_t k = 0; k < node->child_count; k++) {
        csg_fillet_node *child = &room[csg_scene_children(scene, node)[k]];
        child->factor = room[id].factor * scale_of(scene, node);
        child->node_is_negated =
            room[id].node_is_negated != (node->kind == CSG_NODE_DIFFERENCE && k > 0);
    }
}

/* The nodes of the tree from the root down, a piece without what is below it; returns how many. */
static uint32_t list_nodes(const csgm_scene *scene, csg_node_id root, csg_fillet_node *room)
{
    csg_node_id first = csg_scene_first_below(scene, root);
    uint32_t count = 0;
    room[root].factor = 1;
    room[root].node_is_negated = false;
    for (size_t i = (size_t)root + 1; i-- > first;) {
        const csg_node *node = &scene->nodes[i];
        room[count++].listed = (csg_node_id)i;
        if (is_open(node, (csg_node_id)i, root))
            hand_down(scene, (csg_node_id)i, room);
        else
            i = csg_scene_first_below(scene, (csg_node_id)i);
    }
    return count;
}

static csg_fillet_kind kind_of(const csg_node *node, bool is_negated)
{
    bool is_union = (node->kind == CSG_NODE_UNION) != is_negated;
    if (csg_node_is_fillet(node))
        return is_union ? CSG_FILLET_UNITE : CSG_FILLET_MEET;
    return is_union ? CSG_FILLET_MAX : CSG_FILLET_MIN;
}

typedef struct writer {
    const csgm_scene *scene;
    const csg_vec3 *points;
    const csg_sample *samples;
    const csg_fillet_room *room;
    uint32_t terms, pieces;
} writer;

static void write_piece(writer *w, csg_node_id id)
{
    csg_sample s = w->samples[id];
    w->room->pieces[w->pieces] =
        (csg_fillet_piece){.f = s.value, .g = {s.gradient.x, s.gradient.y, s.gradient.z}};
    w->room->nodes[w->pieces].piece_is_negated = w->room->nodes[id].node_is_negated;
    w->room->terms[w->terms++] =
        (csg_fillet_term){.kind = CSG_FILLET_PIECE, .piece = w->pieces++, .size = 1};
}

static void write_wrapper(writer *w, csg_node_id id, uint32_t first_piece)
{
    const csg_node *node = &w->scene->nodes[id];
    for (uint32_t i = first_piece; i < w->pieces && node->kind != CSG_NODE_COLOR; i++) {
        csg_fillet_piece *p = &w->room->pieces[i];
        csg_sample s = {p->f, {p->g[0], p->g[1], p->g[2]}};
        s = csg_reference_wrap(w->scene, node, w->points[id], s);
        p->f = s.value;
        p->g[0] = s.gradient.x;
        p->g[1] = s.gradient.y;
        p->g[2] = s.gradient.z;
    }
}

static void write_operator(writer *w, csg_node_id id, uint32_t first_term)
{
    const csg_node *node = &w->scene->nodes[id];
    const csg_fillet_node *r = &w->room->nodes[id];
    csg_fillet_kind kind = kind_of(node, r->node_is_negated);
    bool is_fillet = csg_node_is_fillet(node);
    w->room->terms[w->terms] = (csg_fillet_term){
        .kind = (uint8_t)kind,
        .size = w->terms + 1 - first_term,
        .radius = is_fillet ? csg_scene_blend(w->scene, node).n * r->factor : 0,
    };
    w->terms++;
}

/* From the leaves up. begin: of subtrees that no operator has taken yet. */
static void write_terms(writer *w, csg_node_id root, uint32_t count)
{
    uint32_t top = 0;
    for (uint32_t i = count; i-- > 0;) {
        csg_node_id id = w->room->nodes[i].listed;
        const csg_node *node = &w->scene->nodes[id];
        bool is_piece = !is_open(node, id, root);
        uint32_t taken = is_piece ? 0 : node->child_count;
        uint32_t begin[2] = {w->terms, w->pieces};
        top -= taken;
        if (taken) {
            begin[0] = w->room->nodes[top].begin[0];
            begin[1] = w->room->nodes[top].begin[1];
        }
        if (is_piece)
            write_piece(w, id);
        else if (csg_node_is_operator(node->kind))
            write_operator(w, id, begin[0]);
        else
            write_wrapper(w, id, begin[1]);
        w->room->nodes[top].begin[0] = begin[0];
        w->room->nodes[top++].begin[1] = begin[1];
    }
}

csg_sample csg_reference_fillet(const csgm_scene *scene, csg_node_id root, const csg_vec3 *points,
                                const csg_sample *samples, const csg_fillet_room *room)
{
    writer w = {scene, points, samples, room, 0, 0};
    write_terms(&w, root, list_nodes(scene, root, room->nodes));
    for (uint32_t i = 0; i < w.pieces; i++)
        if (room->nodes[i].piece_is_negated)
            room->pieces[i] = csg_fillet_negated(room->pieces[i]);
    csg_fillet_piece made = csg_fillet_evaluate(room->terms, w.terms, room->pieces, room->bounds);
    return (csg_sample){made.f, {made.g[0], made.g[1], made.g[2]}};
}
