/* SPDX-License-Identifier: MIT
 * Boxes say where two solids of a union share a face, and where on it a blend above may act; the
 * field says whether it does. Ends of boxes are sorted, so that as many pairs are looked at as meet
 * in one plane and overlap along one more axis. See seams.h.
 */
#include "scene/operators/seams.h"

#include <math.h>
#include <stdlib.h>

enum {
    HALVINGS = 40,       /* to the place at which the other operands are so far away */
    MOST_ANCESTORS = 64, /* between a seam and a blend */
    MOST_OTHERS = 256    /* boxes of what else a blend has */
};

/* A seam in the frame of its union, and the way from there to one operator above it. */
typedef struct seam {
    csg_seam_search *search;
    int axis;          /* normal to the face */
    csg_box face;      /* the part that both have, without thickness */
    double sign;       /* 1: both sides of the seam are inside of the operand on the way; -1 */
    csg_node_id below; /* the operand on the way to the operator */
    csg_node_id above; /* the operator */
    double support;
    csg_affine up, down; /* from the union's frame to the operator's, and back */
} seam;

static double low_of(const csg_box *b, int axis)
{
    return axis == 0 ? b->min.x : axis == 1 ? b->min.y : b->min.z;
}

static double high_of(const csg_box *b, int axis)
{
    return axis == 0 ? b->max.x : axis == 1 ? b->max.y : b->max.z;
}

static csg_vec3 along(int axis, double length)
{
    return csg_vec3_make(axis == 0 ? length : 0, axis == 1 ? length : 0, axis == 2 ? length : 0);
}

/* ---- whether it is one ------------------------------------------------------------------------ */

static bool can_ask(csg_seam_search *s, csg_node_id id)
{
    s->work += s->cost_before[id + 1] - s->cost_before[s->firsts[id]];
    return s->work < s->most_work;
}

/* The value of a node at p in its own frame; those of its operands are in the room then. */
static bool find_value(csg_seam_search *s, csg_node_id id, csg_vec3 p, double *value)
{
    if (!can_ask(s, id))
        return false;
    *value = csg_reference_below(s->room, s->scene, s->firsts[id], id, p).value;
    return true;
}

/* How deep the place is in what the operator keeps of its other operands, as the last answer has
 * them: of an intersection the least of them, negated ones of a difference. With the sign of the
 * seam: what is positive blends with it. */
static double depth_of_others(const seam *m)
{
    const csgm_scene *scene = m->search->scene;
    const csg_node *node = &scene->nodes[m->above];
    const csg_node_id *children = csg_scene_children(scene, node);
    double least = INFINITY;
    for (uint32_t k = 0; k < node->child_count; k++) {
        double value = m->search->room->samples[children[k]].value;
        bool is_negated = node->kind == CSG_NODE_UNION || (node->kind == CSG_NODE_DIFFERENCE && k);
        if (children[k] != m->below)
            least = fmin(least, is_negated ? -value : value);
    }
    return least;
}

static bool find_depth(const seam *m, csg_vec3 p, double *depth)
{
    double value;
    if (!find_value(m->search, m->above, csg_affine_point(&m->up, p), &value))
        return false;
    *depth = depth_of_others(m);
    return true;
}

/* The operator's value at p in the union's frame, and that of the operand on the way; both with
 * the sign that makes the inside of the seam positive. */
static bool find_values(const seam *m, csg_vec3 p, double *operand, double *result)
{
    if (!find_value(m->search, m->above, csg_affine_point(&m->up, p), result))
        return false;
    *operand = m->sign * m->search->room->samples[m->below].value;
    *result *= m->sign;
    return true;
}

/* The place in the scene's frame; false: a warp, which has no way back, takes it along. */
static bool find_in_scene(const seam *m, csg_vec3 *p)
{
    const csgm_scene *scene = m->search->scene;
    *p = csg_affine_point(&m->up, *p);
    for (csg_node_id id = m->above; id != scene->root; id = m->search->parents[id]) {
        const csg_node *parent = &scene->nodes[m->search->parents[id]];
        if (parent->kind == CSG_NODE_WARP)
            return false;
        if (parent->kind == CSG_NODE_TRANSFORM)
            *p = csg_affine_point(&scene->transforms[parent->payload], *p);
    }
    return true;
}

/* Whether the scene has a surface between the place and both of its neighbours. */
static bool is_seen(const seam *m, csg_vec3 place, const csg_vec3 neighbours[2])
{
    csg_node_id root = m->search->scene->root;
    double value, beside;
    if (!find_in_scene(m, &place) || !find_value(m->search, root, place, &value) || value == 0)
        return false;
    for (int i = 0; i < 2; i++) {
        csg_vec3 p = neighbours[i];
        if (!find_in_scene(m, &p) || !find_value(m->search, root, p, &beside) ||
            !(beside * value < 0))
            return false;
    }
    return true;
}

/* Whether at a place on the seam the blend leaves nothing where it leaves both sides. */
static bool is_groove(const seam *m, csg_vec3 p)
{
    double operand, result, rounding = CSG_JOINT_SAME * (m->support + csg_vec3_norm(p));
    if (!find_values(m, p, &operand, &result) || fabs(operand) > rounding || !(result < -rounding))
        return false;
    for (double step = m->support / 64; step <= 4 * m->support; step *= 2) {
        const csg_vec3 sides[2] = {csg_vec3_add(p, along(m->axis, step)),
                                   csg_vec3_add(p, along(m->axis, -step))};
        bool are_left = true;
        for (int i = 0; i < 2 && are_left; i++)
            are_left =
                find_values(m, sides[i], &operand, &result) && operand > 0 && result > rounding;
        if (are_left)
            return is_seen(m, p, sides);
    }
    return false;
}

/* Between a place where the other operands end and one within them: where they are so deep. */
static bool try_between(const seam *m, csg_vec3 outer, csg_vec3 inner, double depth,
                        csg_vec3 *place)
{
    double here;
    for (int i = 0; i < HALVINGS; i++) {
        csg_vec3 middle = csg_vec3_scale(csg_vec3_add(outer, inner), 0.5);
        if (!find_depth(m, middle, &here))
            return false;
        if (here < depth)
            outer = middle;
        else
            inner = middle;
    }
    *place = inner;
    return is_groove(m, inner);
}

/* Of the support: how deep grooves are looked for, the deepest first. */
static const double DEPTHS[] = {0.9, 0.5, 0.2};
enum { DEPTH_COUNT = sizeof DEPTHS / sizeof *DEPTHS };

static bool try_pair(const seam *m, const csg_vec3 places[2], const double depths[2],
                     csg_joint *joint)
{
    int inner = depths[1] > depths[0];
    for (int k = 0; k < DEPTH_COUNT; k++) {
        double depth = DEPTHS[k] * m->support;
        if (depths[!inner] > 0 || !(depths[inner] > depth))
            continue;
        if (!try_between(m, places[!inner], places[inner], depth, &joint->place))
            continue;
        joint->amount = depth;
        return true;
    }
    return false;
}

/* In a part of the face: between neighbours of a grid of which one is outside of the others. */
static bool look_within(const seam *m, const csg_box *part, csg_joint *joint)
{
    csg_vec3 places[CSG_JOINT_GRID * CSG_JOINT_GRID];
    double depths[CSG_JOINT_GRID * CSG_JOINT_GRID];
    int u = (m->axis + 1) % 3, v = (m->axis + 2) % 3;
    double by_u = high_of(part, u) - low_of(part, u), by_v = high_of(part, v) - low_of(part, v);
    for (int i = 0; i < CSG_JOINT_GRID * CSG_JOINT_GRID; i++) {
        places[i] =
            csg_vec3_add(part->min, along(u, by_u * (i % CSG_JOINT_GRID + 0.5) / CSG_JOINT_GRID));
        places[i] =
            csg_vec3_add(places[i], along(v, by_v * (i / CSG_JOINT_GRID + 0.5) / CSG_JOINT_GRID));
        if (!find_depth(m, places[i], &depths[i]))
            return false;
    }
    for (int i = 0; i < CSG_JOINT_GRID * CSG_JOINT_GRID; i++)
        for (int step = 1; step <= CSG_JOINT_GRID; step += CSG_JOINT_GRID - 1) {
            int k = i + step;
            if (k >= CSG_JOINT_GRID * CSG_JOINT_GRID ||
                (step == 1 && i % CSG_JOINT_GRID == CSG_JOINT_GRID - 1))
                continue;
            if (try_pair(m, (csg_vec3[2]){places[i], places[k]}, (double[2]){depths[i], depths[k]},
                         joint))
                return true;
        }
    return false;
}

/* ---- where on the face ------------------------------------------------------------------------ */

/* What is not made of several solids side by side: a box of its own for each. */
static bool is_several(const csg_node *node)
{
    return node->kind == CSG_NODE_UNION || node->kind == CSG_NODE_TRANSFORM ||
           node->kind == CSG_NODE_COLOR;
}

/* The boxes of an operand's parts in the frame of the seam's union: how many there are now. */
static int take_boxes(const seam *m, csg_node_id operand, csg_box *boxes, int count)
{
    struct {
        csg_node_id id;
        csg_affine up;
    } open[MOST_ANCESTORS] = {{operand, m->down}};
    const csgm_scene *scene = m->search->scene;
    for (int opened = 1; opened > 0 && count < MOST_OTHERS;) {
        csg_node_id id = open[--opened].id;
        csg_affine up = open[opened].up;
        const csg_node *node = &scene->nodes[id];
        uint32_t below = is_several(node) ? node->child_count : 0;
        if (below == 0 || opened + (int)below > MOST_ANCESTORS) {
            boxes[count++] = csg_affine_box(&up, scene->bounds[id]);
            continue;
        }
        if (node->kind == CSG_NODE_TRANSFORM)
            up = csg_affine_multiply(up, scene->transforms[node->payload]);
        for (uint32_t k = 0; k < below; k++, opened++) {
            open[opened].id = csg_scene_children(scene, node)[k];
            open[opened].up = up;
        }
    }
    return count;
}

/* Where a flat figure is looked at: in the middle of what it becomes. */
static double height_of(const seam *m)
{
    const csgm_scene *scene = m->search->scene;
    for (csg_node_id id = m->above; id != scene->root; id = m->search->parents[id]) {
        csg_node_id parent = m->search->parents[id];
        const csg_box *box = &scene->bounds[parent];
        double middle = 0.5 * (box->min.z + box->max.z);
        if (csg_node_is_plate(&scene->nodes[parent]))
            return isfinite(middle) ? middle : 0;
    }
    return 0;
}

static bool look_at_blend(const seam *m, csg_joint *joint)
{
    const csgm_scene *scene = m->search->scene;
    const csg_node *node = &scene->nodes[m->above];
    csg_box others[MOST_OTHERS];
    csg_box whole = csg_affine_box(&m->down, scene->bounds[m->below]);
    int count = 0;
    for (uint32_t k = 0; k < node->child_count; k++) {
        csg_node_id child = csg_scene_children(scene, node)[k];
        if (child != m->below)
            count = take_boxes(m, child, others, count);
    }
    for (int i = 0; i < count; i++) {
        csg_box part = csg_box_intersect(csg_box_grow(others[i], 2 * m->support), m->face);
        part = m->sign > 0 ? csg_box_intersect(part, whole) : part;
        if (!isfinite(part.min.z) && !isfinite(part.max.z))
            part.min.z = part.max.z = height_of(m);
        if (!csg_box_is_empty(part) && csg_box_is_finite(part) && look_within(m, &part, joint))
            return true;
    }
    return false;
}

/* ---- the way up -------------------------------------------------------------------------------- */

/* Whether an operator rounds what is on the way: it keeps the least, or the largest, of its
 * operands, blended within a finite distance. */
static bool rounds(const csgm_scene *scene, const csg_node *node, double sign)
{
    if (!csg_node_is_operator(node->kind) || (node->flags & CSG_FLAG_SOFT) ||
        (node->kind == CSG_NODE_UNION) == (sign > 0))
        return false;
    csg_blend blend = csg_scene_blend(scene, node);
    return !csg_blend_is_sharp(blend.kind) && !csg_blend_is_orthogonal(blend.kind) &&
           !csg_blend_is_rule(blend.kind) && isfinite(csg_blend_support(blend));
}

/* Takes the seam one node up; false: it ends there. */
static bool go_up(seam *m)
{
    csg_seam_search *s = m->search;
    csg_node_id parent = s->parents[m->below];
    const csg_node *node = &s->scene->nodes[parent];
    if (node->kind == CSG_NODE_TRANSFORM)
        m->up = csg_affine_multiply(s->scene->transforms[node->payload], m->up);
    else if (node->kind == CSG_NODE_DIFFERENCE)
        m->sign *= csg_scene_children(s->scene, node)[0] == m->below ? 1 : -1;
    else if (node->kind != CSG_NODE_COLOR && !csg_node_is_operator(node->kind))
        return false;
    m->below = parent;
    return csg_affine_invert(m->up, &m->down);
}

/* What blends the seam first: only one is told of, since the next one rounds what that left. */
static bool look_above(seam *m, csg_joint *joint)
{
    csg_seam_search *s = m->search;
    for (int i = 0; i < MOST_ANCESTORS && m->below != s->scene->root; i++) {
        m->above = s->parents[m->below];
        const csg_node *node = &s->scene->nodes[m->above];
        bool is_first = csg_scene_children(s->scene, node)[0] == m->below;
        double turned = node->kind == CSG_NODE_DIFFERENCE && !is_first ? -1 : 1;
        uint64_t cost = s->cost_before[m->above + 1] - s->cost_before[s->firsts[m->above]];
        if (!s->is_told[m->above] && turned > 0 && rounds(s->scene, node, m->sign) &&
            CSG_JOINT_LEAST_LOOKS * cost < s->most_work) {
            m->support = csg_blend_support(csg_scene_blend(s->scene, node));
            joint->node = node;
            if (look_at_blend(m, joint))
                return true;
        }
        if (!go_up(m))
            return false;
    }
    return false;
}

/* ---- pairs of solids ---------------------------------------------------------------------------- */

static int compare_ends(const void *a, const void *b)
{
    const csg_seam_end *one = a, *other = b;
    if (one->at != other->at)
        return one->at < other->at ? -1 : 1;
    return (one->id > other->id) - (one->id < other->id);
}

/* The face that one solid ends in where the other begins; false: they have none in common. */
static bool find_face(const csgm_scene *scene, int axis, csg_node_id before, csg_node_id after,
                      csg_box *face)
{
    const csg_box *one = &scene->bounds[before], *other = &scene->bounds[after];
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = fmax(low_of(one, k), low_of(other, k));
        high[k] = fmin(high_of(one, k), high_of(other, k));
        if (k == axis)
            low[k] = high[k] = high_of(one, k);
        else if (!(high[k] > low[k] + (isfinite(low[k]) ? CSG_JOINT_SAME * (1 + fabs(low[k])) : 0)))
            return false;
    }
    face->min = csg_vec3_make(low[0], low[1], low[2]);
    face->max = csg_vec3_make(high[0], high[1], high[2]);
    return true;
}

static void look_at_pair(csg_seam_search *s, csg_node_id id, int axis, const csg_node_id pair[2],
                         csg_joint_take *take, void *user)
{
    seam m = {.search = s, .axis = axis, .sign = 1, .below = id};
    csg_joint joint = {.kind = CSG_JOINT_GROOVES, .axis = axis};
    m.sign = s->scene->nodes[id].kind == CSG_NODE_UNION ? 1 : -1;
    m.up = m.down = csg_affine_identity();
    if (!find_face(s->scene, axis, pair[0], pair[1], &m.face) || !look_above(&m, &joint))
        return;
    s->is_told[joint.node - s->scene->nodes] = true;
    joint.at = high_of(&m.face, axis);
    joint.is_fin = m.sign < 0;
    if (find_in_scene(&m, &joint.place))
        take(user, &joint);
}

/* The children that end along an axis where others begin. */
static void look_along(csg_seam_search *s, csg_node_id id, int axis, uint32_t first,
                       csg_joint_take *take, void *user)
{
    const csg_node *node = &s->scene->nodes[id];
    const csg_node_id *children = csg_scene_children(s->scene, node) + first;
    uint32_t count = node->child_count - first, begin = 0;
    csg_seam_end *by_high = s->order, *by_low = s->order + node->child_count;
    for (uint32_t k = 0; k < count; k++) {
        const csg_box *b = &s->scene->bounds[children[k]];
        by_high[k] = (csg_seam_end){high_of(b, axis), children[k]};
        by_low[k] = (csg_seam_end){low_of(b, axis), children[k]};
    }
    qsort(by_high, count, sizeof *by_high, compare_ends);
    qsort(by_low, count, sizeof *by_low, compare_ends);
    for (uint32_t k = 0; k < count; k++) {
        double at = by_high[k].at, slack = CSG_JOINT_SAME * (1 + fabs(at));
        for (; begin < count && by_low[begin].at < at - slack; begin++) {
        }
        for (uint32_t i = begin; i < count && by_low[i].at <= at + slack; i++) {
            if (++s->work >= s->most_work)
                return;
            if (isfinite(at) && by_low[i].id != by_high[k].id)
                look_at_pair(s, id, axis, (csg_node_id[2]){by_high[k].id, by_low[i].id}, take,
                             user);
        }
    }
}

/* Whether the seam between two of the node's solids stays in its field. */
static bool keeps_seams(const csgm_scene *scene, const csg_node *node)
{
    bool is_union = node->kind == CSG_NODE_UNION && node->child_count > 1;
    bool is_difference = node->kind == CSG_NODE_DIFFERENCE && node->child_count > 2;
    csg_blend blend;
    if ((!is_union && !is_difference) || (node->flags & CSG_FLAG_SOFT))
        return false;
    blend = csg_scene_blend(scene, node);
    return csg_blend_is_sharp(blend.kind) || (is_union && csg_blend_is_fillet(blend.kind));
}

void csg_seams_find(csg_seam_search *s, csg_joint_take *take, void *user)
{
    const csgm_scene *scene = s->scene;
    for (size_t i = 0; i < scene->node_count && s->work < s->most_work; i++)
        for (int axis = 0; axis < 3 && keeps_seams(scene, &scene->nodes[i]); axis++)
            look_along(s, (csg_node_id)i, axis, scene->nodes[i].kind == CSG_NODE_DIFFERENCE, take,
                       user);
}
