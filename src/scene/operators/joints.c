/* SPDX-License-Identifier: MIT
 * Boxes, then samples in double; see joints.h.
 */
#include "scene/operators/joints.h"

#include <math.h>

#include "base/elementary.h"
#include "scene/operators/seams.h"
#include "scene/reference.h"

enum {
    MOST_SOLIDS = 64,   /* of one union */
    MOST_WORK = 2000000 /* nodes evaluated, of a scene */
};

/* Of the blend's width: what swells by less is not worth a word. */
static const double LEAST_SWELLING = 0.01;
/* Of a blend's support: solids that are farther apart than so much are nowhere both near enough to
 * the surface, which comes out by less than the support itself. */
static const double APART = 4;

typedef struct look {
    const csgm_scene *scene;
    csg_reference_room room;
    csg_node_id *firsts, *parents; /* per node: the first one below it; the one above it */
    csg_node_id first, id;         /* the nodes below the union, the union */
    const csg_node *node;
    csg_blend blend;
    uint64_t *cost_before; /* per node, and the end: what all nodes before it take */
    uint64_t work;
} look;

/* A place on an axis-parallel face: the axis that it is normal to, where, and its two sides. */
typedef struct face {
    int axis;
    double at, low[3], high[3];
} face;

/* A box by axes. */
typedef struct sides {
    double low[3], high[3];
} sides;

static sides sides_of(csg_box b)
{
    return (sides){{b.min.x, b.min.y, b.min.z}, {b.max.x, b.max.y, b.max.z}};
}

static csg_box box_of(const look *l, uint32_t solid)
{
    return l->scene->bounds[csg_scene_children(l->scene, l->node)[solid]];
}

/* What two solids have in common on the other axes; false: nothing. */
static bool find_common(const look *l, uint32_t a, uint32_t b, face *f)
{
    sides one = sides_of(box_of(l, a)), other = sides_of(box_of(l, b));
    for (int k = 0; k < 3; k++) {
        f->low[k] = fmax(one.low[k], other.low[k]);
        f->high[k] = fmin(one.high[k], other.high[k]);
        if (k == f->axis)
            f->low[k] = f->high[k] = f->at;
        if (!isfinite(f->low[k]) || !isfinite(f->high[k])) /* a flat figure, along z */
            f->low[k] = f->high[k] = 0;
        if (!(f->low[k] <= f->high[k]))
            return false;
    }
    return true;
}

/* One of the grid, `beyond` the face along its axis. */
static csg_vec3 place_on(const face *f, int number, double beyond)
{
    double p[3], part[2] = {(number % CSG_JOINT_GRID + 0.5) / CSG_JOINT_GRID,
                            (number / CSG_JOINT_GRID + 0.5) / CSG_JOINT_GRID};
    for (int k = 0, n = 0; k < 3; k++)
        p[k] = k == f->axis ? f->at + beyond : f->low[k] + part[n++] * (f->high[k] - f->low[k]);
    return csg_vec3_make(p[0], p[1], p[2]);
}

/* Whether a node can be asked once more. */
static bool can_ask(look *l, csg_node_id first, csg_node_id id)
{
    uint64_t cost = l->cost_before[id + 1] - l->cost_before[first];
    l->work = l->work + cost < MOST_WORK ? l->work + cost : MOST_WORK;
    return l->work < MOST_WORK;
}

/* The union's value; those of its solids are in the room then. False: too much was asked. */
static bool ask(look *l, csg_vec3 p, double *value)
{
    if (!can_ask(l, l->first, l->id))
        return false;
    *value = csg_reference_below(&l->room, l->scene, l->first, l->id, p).value;
    return true;
}

/* Of those in the room. */
static double value_of(const look *l, uint32_t solid)
{
    return l->room.samples[csg_scene_children(l->scene, l->node)[solid]].value;
}

/* The place in the scene's frame; false: the union is cut out there, or a warp, which has no way
 * back, takes it along. */
static bool find_in_scene(const look *l, csg_vec3 *place)
{
    const csgm_scene *scene = l->scene;
    for (csg_node_id id = l->id; id != scene->root; id = l->parents[id]) {
        const csg_node *parent = &scene->nodes[l->parents[id]];
        if (parent->kind == CSG_NODE_WARP ||
            (parent->kind == CSG_NODE_DIFFERENCE && csg_scene_children(scene, parent)[0] != id))
            return false;
        if (parent->kind == CSG_NODE_TRANSFORM)
            *place = csg_affine_point(&scene->transforms[parent->payload], *place);
    }
    return true;
}

/* Whether some other solid that is united with the union is there, of the samples in the room. */
static bool is_covered(const look *l)
{
    const csgm_scene *scene = l->scene;
    for (csg_node_id id = l->id; id != scene->root; id = l->parents[id]) {
        const csg_node *parent = &scene->nodes[l->parents[id]];
        for (uint32_t k = 0; parent->kind == CSG_NODE_UNION && k < parent->child_count; k++) {
            csg_node_id other = csg_scene_children(scene, parent)[k];
            if (other != id && l->room.samples[other].value >= 0)
                return true;
        }
    }
    return false;
}

/* Whether a place in the union is in the scene, and because of it. */
static bool is_seen(look *l, csg_vec3 place)
{
    if (!find_in_scene(l, &place) || !can_ask(l, 0, l->scene->root))
        return false;
    double value = csg_reference_below(&l->room, l->scene, 0, l->scene->root, place).value;
    return value >= -CSG_JOINT_SAME * (1 + csg_vec3_norm(place)) && !is_covered(l);
}

/* ---- swelling --------------------------------------------------------------------------------- */

/* Whether both solids are on their surfaces where the union was just asked. */
static bool are_faces(const look *l, uint32_t a, uint32_t b, double rounding)
{
    return value_of(l, a) >= -rounding && value_of(l, b) >= -rounding;
}

/* The union ends in a plane where all its solids do: what is inside on that plane lies beyond it by
 * as much as its value. */
static void look_at_face(look *l, const face *f, const uint32_t pair[2], double turn,
                         double rounding, csg_joint *worst)
{
    for (int i = 0; i < CSG_JOINT_GRID * CSG_JOINT_GRID; i++) {
        double value;
        if (!ask(l, place_on(f, i, 0), &value))
            return;
        if (!(value > worst->amount) || !are_faces(l, pair[0], pair[1], rounding) ||
            !is_seen(l, place_on(f, i, 0.5 * turn * value)))
            continue;
        worst->amount = value;
        worst->axis = f->axis;
        worst->at = f->at;
    }
}

/* Of a flat figure, in its plane. */
static double extent_of(const csg_box *hull)
{
    csg_vec3 size = csg_vec3_sub(hull->max, hull->min);
    return csg_hypot(csg_hypot(size.x, size.y), isfinite(size.z) ? size.z : 0);
}

/* Where a box ends: along x at the low and at the high end, along y, along z. */
static double end_of(csg_box box, int side)
{
    sides s = sides_of(box);
    return side % 2 ? s.high[side / 2] : s.low[side / 2];
}

static void look_for_swelling(look *l, const csg_box *hull, csg_joint *worst)
{
    double extent = extent_of(hull);
    for (int side = 0; side < 6; side++) {
        face f = {.axis = side / 2, .at = end_of(*hull, side)};
        uint32_t before = UINT32_MAX; /* neighbours in the order of their writing are enough */
        for (uint32_t k = 0; k < l->node->child_count && isfinite(f.at); k++) {
            if (!(fabs(end_of(box_of(l, k), side) - f.at) <= CSG_JOINT_SAME * extent))
                continue;
            const uint32_t pair[2] = {before, k};
            if (before != UINT32_MAX && find_common(l, before, k, &f))
                look_at_face(l, &f, pair, side % 2 ? 1 : -1, CSG_JOINT_SAME * extent, worst);
            before = k;
        }
    }
}

/* ---- gaps -------------------------------------------------------------------------------------- */

/* Where two boxes are apart along one axis while they overlap along the others: the middle of the
 * gap, which is so wide. False: nowhere. */
static bool find_gap(const look *l, uint32_t a, uint32_t b, face *middle, double *gap)
{
    sides one = sides_of(box_of(l, a)), other = sides_of(box_of(l, b));
    int found = 0;
    for (int k = 0; k < 3; k++) {
        double from = fmin(one.high[k], other.high[k]), to = fmax(one.low[k], other.low[k]);
        if (!(to > from))
            continue;
        found++;
        *middle = (face){.axis = k, .at = 0.5 * (from + to)};
        *gap = to - from;
    }
    return found == 1 && find_common(l, a, b, middle);
}

/* Whether the two alone fill most of what lies between them. */
static bool fills(look *l, const face *f, uint32_t a, uint32_t b)
{
    int filled = 0;
    for (int i = 0; i < CSG_JOINT_GRID * CSG_JOINT_GRID; i++) {
        csg_vec3 p = place_on(f, i, 0);
        double partials[2], value;
        if (!ask(l, p, &value))
            return false;
        const double values[2] = {value_of(l, a), value_of(l, b)};
        filled += csg_reference_union(l->blend, values, 2, partials) >= 0 && is_seen(l, p);
    }
    return 2 * filled > CSG_JOINT_GRID * CSG_JOINT_GRID;
}

static void look_for_filled_gaps(look *l, double least, csg_joint *worst)
{
    double reach = 2 * csg_blend_excess(l->blend, 2);
    for (uint32_t a = 0; a < l->node->child_count; a++)
        for (uint32_t b = 0; b < a; b++) {
            double gap = 0;
            face f = {.axis = 0};
            if (!find_gap(l, a, b, &f, &gap) || !(gap < reach && gap > least) ||
                !(gap > worst->amount) || !fills(l, &f, a, b))
                continue;
            worst->amount = gap;
            worst->axis = f.axis;
            worst->at = f.at;
        }
}

/* ---- one union --------------------------------------------------------------------------------- */

/* The nearest places of two boxes, finite where they have any. */
static void find_nearest(csg_box a, csg_box b, double from[3], double to[3])
{
    sides one = sides_of(a), other = sides_of(b);
    for (int k = 0; k < 3; k++) {
        double low = fmax(one.low[k], other.low[k]), high = fmin(one.high[k], other.high[k]);
        double end = isfinite(low) ? low : isfinite(high) ? high : 0;
        double middle = isfinite(low) && isfinite(high) ? 0.5 * (low + high) : end;
        from[k] = fmin(fmax(middle, one.low[k]), one.high[k]);
        to[k] = fmin(fmax(middle, other.low[k]), other.high[k]);
    }
}

static double distance_of(csg_box a, csg_box b)
{
    double from[3], to[3];
    find_nearest(a, b, from, to);
    return csg_hypot(csg_hypot(to[0] - from[0], to[1] - from[1]), to[2] - from[2]);
}

/* The sharp operator's value, of the samples in the room. */
static double sharp_value(const look *l)
{
    csg_node_kind kind = l->node->kind;
    double best = value_of(l, 0);
    for (uint32_t k = 1; k < l->node->child_count; k++) {
        double value = value_of(l, k);
        best = kind == CSG_NODE_UNION ? fmax(best, value)
                                      : fmin(best, kind == CSG_NODE_DIFFERENCE ? -value : value);
    }
    return best;
}

/* Whether the blend of an intersection, or of a difference, acts at a place, and that near to the
 * surface: between two that are far from each other it acts within the solid. */
static bool cuts_here(const look *l, double value)
{
    return value != sharp_value(l) && value < csg_blend_support(l->blend);
}

/* Whether the blend changes anything on the way between two solids: at its ends, or by filling it.
 * Values of stretched solids are much less than distances. */
static bool acts_between(look *l, uint32_t a, uint32_t b)
{
    enum { STEPS = 16 };
    double from[3], to[3];
    find_nearest(box_of(l, a), box_of(l, b), from, to);
    for (int i = 0; i <= STEPS; i++) {
        double p[3], value;
        for (int k = 0; k < 3; k++)
            p[k] = from[k] + (to[k] - from[k]) * i / STEPS;
        if (!ask(l, csg_vec3_make(p[0], p[1], p[2]), &value))
            return true;
        if (l->node->kind != CSG_NODE_UNION) {
            if (cuts_here(l, value))
                return true;
            continue;
        }
        double most = fmax(value_of(l, a), value_of(l, b));
        bool at_end = i == 0 || i == STEPS;
        if ((value >= 0 && most < 0) || (at_end && value > most + CSG_JOINT_SAME * fabs(most)))
            return true;
    }
    return false;
}

/* The distance between the two that are nearest; 0 where the blend may act. */
static double find_distance(look *l, double support)
{
    double least = INFINITY;
    for (uint32_t a = 0; a < l->node->child_count; a++)
        for (uint32_t b = 0; b < a; b++)
            least = fmin(least, distance_of(box_of(l, a), box_of(l, b)));
    for (uint32_t a = 0; a < l->node->child_count && least > APART * support; a++)
        for (uint32_t b = 0; b < a && least > 0; b++)
            least = acts_between(l, a, b) ? 0 : least;
    return least;
}

/* ---- differences and intersections ------------------------------------------------------------- */

/* How deep a solid's box lies within another solid, at least: no field rises faster than its
 * distance. Below 0: nothing is known. */
static double depth_in(look *l, uint32_t solid, uint32_t other)
{
    csg_box b = box_of(l, solid);
    double value;
    if (!csg_box_is_finite(b) || !ask(l, csg_vec3_scale(csg_vec3_add(b.min, b.max), 0.5), &value))
        return -1;
    return value_of(l, other) - 0.5 * csg_vec3_norm(csg_vec3_sub(b.max, b.min));
}

/* Whether the blend changes nothing along lines from the middle of one solid's box through the
 * sides of another's: where values are much less than distances it would. */
static bool is_idle_along(look *l, uint32_t solid, uint32_t other)
{
    enum { STEPS = 32 };
    csg_box b = box_of(l, solid), outer = box_of(l, other);
    csg_vec3 c = csg_vec3_scale(csg_vec3_add(b.min, b.max), 0.5);
    for (int side = 0; side < 6; side++) {
        const double middle[3] = {c.x, c.y, c.z};
        double end = end_of(outer, side), p[3] = {c.x, c.y, c.z}, value;
        int axis = side / 2;
        for (int i = 0; i <= STEPS && isfinite(end); i++) {
            p[axis] = middle[axis] + (end - middle[axis]) * i / STEPS;
            if (!ask(l, csg_vec3_make(p[0], p[1], p[2]), &value) || cuts_here(l, value))
                return false;
        }
    }
    return true;
}

/* How far the surfaces of two solids are apart at least: their boxes, or one deep in the other. 0:
 * the blend may act between them. */
static double surfaces_apart(look *l, uint32_t a, uint32_t b, double least)
{
    double outside = distance_of(box_of(l, a), box_of(l, b));
    if (outside > least)
        return acts_between(l, a, b) ? 0 : outside;
    double within = depth_in(l, b, a), around = depth_in(l, a, b);
    if (within > least)
        return is_idle_along(l, b, a) ? within : 0;
    return around > least && is_idle_along(l, a, b) ? around : 0;
}

/* The surfaces that are nearest: those of what is taken away blend with each other, too. */
static double find_clearance(look *l, double support)
{
    double least = INFINITY;
    for (uint32_t a = 0; a < l->node->child_count && least > 0; a++)
        for (uint32_t b = a + 1; b < l->node->child_count && least > 0; b++)
            least = fmin(least, surfaces_apart(l, a, b, APART * support));
    return least;
}

static void look_at_cut(look *l, csg_joint_take *take, void *user)
{
    csg_joint joint = {.kind = CSG_JOINT_MISSES, .node = l->node};
    double support = csg_blend_support(l->blend);
    for (uint32_t k = 0; k < l->node->child_count; k++)
        if (csg_box_is_empty(box_of(l, k)))
            return;
    if (!(support > 0) || !isfinite(support))
        return;
    joint.amount = find_clearance(l, support);
    if (joint.amount > APART * support)
        take(user, &joint);
}

/* False: nothing to be told of it. */
static bool find_hull(const look *l, csg_box *hull)
{
    *hull = csg_box_empty();
    for (uint32_t k = 0; k < l->node->child_count; k++) {
        if (csg_box_is_empty(box_of(l, k)))
            return false;
        *hull = csg_box_hull(*hull, box_of(l, k));
    }
    return isfinite(hull->min.x) && isfinite(hull->min.y) && isfinite(hull->max.x) &&
           isfinite(hull->max.y);
}

static bool is_looked_at(const csg_node *node)
{
    return csg_node_is_operator(node->kind) && node->child_count > 1 &&
           node->child_count <= MOST_SOLIDS && !(node->flags & CSG_FLAG_SOFT) &&
           !csg_blend_is_sharp(node->blend) && !csg_blend_is_orthogonal(node->blend) &&
           !csg_blend_is_rule(node->blend);
}

static void look_at_union(look *l, csg_joint_take *take, void *user)
{
    csg_box hull;
    double support = csg_blend_support(l->blend);
    if (!find_hull(l, &hull) || !(support > 0))
        return;
    csg_joint joint = {.kind = CSG_JOINT_MISSES, .node = l->node};
    double apart = csg_blend_is_fillet(l->blend.kind) /* not, if no two of its solids meet */
                       ? csg_scene_parameters(l->scene, l->node)[CSG_FILLET_APART_BY]
                       : 0;
    joint.amount = apart > 0 ? apart : find_distance(l, support);
    if (apart > 0 || joint.amount > APART * support) {
        take(user, &joint);
        return;
    }
    const double least = LEAST_SWELLING * support;
    joint = (csg_joint){.kind = CSG_JOINT_SWELLS, .node = l->node, .amount = least};
    look_for_swelling(l, &hull, &joint);
    if (joint.amount > least)
        take(user, &joint);
    joint = (csg_joint){.kind = CSG_JOINT_FILLS, .node = l->node};
    if (!csg_blend_is_fillet(l->blend.kind)) /* it keeps them (fillet.h) */
        look_for_filled_gaps(l, least, &joint);
    if (joint.amount > 0)
        take(user, &joint);
}

static void take_idle(const csg_node *node, csg_joint_take *take, void *user)
{
    take(user, &(csg_joint){.kind = CSG_JOINT_MISSES, .node = node});
}

static void walk(look *l, csg_joint_take *take, void *user)
{
    const csgm_scene *scene = l->scene;
    l->cost_before[0] = 0;
    for (size_t i = 0; i < scene->node_count; i++) {
        const csg_node *node = &scene->nodes[i];
        const csg_node_id *children = csg_scene_children(scene, node);
        l->firsts[i] = node->child_count ? l->firsts[children[0]] : (csg_node_id)i;
        l->cost_before[i + 1] = l->cost_before[i] + csg_reference_cost(scene, node);
        for (uint32_t k = 0; k < node->child_count; k++)
            l->parents[children[k]] = (csg_node_id)i;
    }
    for (size_t i = 0; i < scene->node_count && l->work < MOST_WORK; i++) {
        if (csg_node_is_idle(&scene->nodes[i]))
            take_idle(&scene->nodes[i], take, user);
        if (!is_looked_at(&scene->nodes[i]))
            continue;
        l->first = l->firsts[i];
        l->id = (csg_node_id)i;
        l->node = &scene->nodes[i];
        l->blend = csg_scene_blend(scene, l->node);
        if (CSG_JOINT_LEAST_LOOKS * (l->cost_before[i + 1] - l->cost_before[l->first]) < MOST_WORK)
            (l->node->kind == CSG_NODE_UNION ? look_at_union : look_at_cut)(l, take, user);
    }
}

/* Of any operator. */
static bool has_blends(const csgm_scene *scene)
{
    bool any = false;
    for (size_t i = 0; i < scene->node_count; i++) {
        const csg_node *node = &scene->nodes[i];
        if (csg_node_is_operator(node->kind))
            any = any || !csg_blend_is_sharp(csg_scene_blend(scene, node).kind) ||
                  csg_node_is_idle(node);
    }
    return any;
}

static bool look_for_seams(look *l, csg_joint_take *take, void *user)
{
    const csgm_scene *scene = l->scene;
    csg_memory *memory = &scene->context->memory;
    uint32_t most = 0;
    for (size_t i = 0; i < scene->node_count; i++)
        most = scene->nodes[i].child_count > most ? scene->nodes[i].child_count : most;
    size_t told = scene->node_count * sizeof(bool), order = 2 * most * sizeof(csg_seam_end);
    csg_seam_search search = {.scene = scene,
                              .room = &l->room,
                              .firsts = l->firsts,
                              .parents = l->parents,
                              .cost_before = l->cost_before,
                              .most_work = MOST_WORK,
                              .order = csg_memory_alloc(memory, order),
                              .is_told = csg_memory_alloc(memory, told)};
    bool begun = (search.order || !order) && search.is_told;
    for (size_t i = 0; i < scene->node_count && begun; i++)
        search.is_told[i] = false;
    if (begun)
        csg_seams_find(&search, take, user);
    csg_memory_release(memory, search.order, order);
    csg_memory_release(memory, search.is_told, told);
    return begun;
}

csgm_status csg_joints_find(const csgm_scene *scene, csg_joint_take *take, void *user)
{
    csg_memory *memory = &scene->context->memory;
    size_t count = scene->node_count, bytes = count * sizeof(csg_node_id);
    look l = {.scene = scene};
    if (!has_blends(scene)) /* nothing blends */
        return CSGM_OK;
    l.firsts = csg_memory_alloc(memory, bytes);
    l.parents = csg_memory_alloc(memory, bytes);
    l.cost_before = csg_memory_alloc(memory, (count + 1) * sizeof *l.cost_before);
    bool begun = l.firsts && l.parents && l.cost_before && csg_reference_room_begin(&l.room, scene);
    if (begun) {
        walk(&l, take, user);
        begun = look_for_seams(&l, take, user);
        csg_reference_room_end(&l.room, scene);
    }
    csg_memory_release(memory, l.firsts, bytes);
    csg_memory_release(memory, l.parents, bytes);
    csg_memory_release(memory, l.cost_before, (count + 1) * sizeof *l.cost_before);
    return begun ? CSGM_OK : CSGM_ERR_MEMORY;
}
