/* SPDX-License-Identifier: MIT
 * Supporting half-spaces of a union's operands; see fillet_planes.h. Their normals are those of
 * the axes of every leaf below and of the union's own frame: faces of boxes, caps of cylinders,
 * slabs and extrusions are among them. How far the operands reach along a normal is found from the
 * leaves up, by their support functions and by the boxes of all nodes: never too little. Sorted, so
 * that the order of the operands does not matter. Those of the faces of polyhedra and outlines that
 * have few come last.
 */
#include "scene/operators/fillet_planes.h"

#include <stdlib.h>
#include <string.h>

#include "scene/primitives/kinds.h"
#include "scene/primitives/primitive.h"
#include "shape/plane/region.h"
#include "shape/polyhedra/polyhedron.h"

enum {
    AXES = 6,             /* both sides of each */
    MOST_PLANES = 24,     /* of one union */
    MOST_AXES = 8,        /* the same */
    MOST_FACES = 16,      /* directions of a shape that is looked at: above it, it is round */
    MOST_WORK = 20000000, /* nodes times normals; above it the frame's own axes only */
};

typedef struct search {
    const csgm_scene *scene;
    csg_arena *scratch;
    csg_node_id root;  /* the union */
    csg_node_id *seen; /* it and what is looked at below it, parents before children */
    size_t seen_count;
    /* per node; filled in for those seen */
    csg_affine *to_own; /* from the union's frame */
    bool *is_placed;    /* to_own is known: no warp stands between */
    csg_vec3 *normals;
    double *reaches;
    /* those found */
    csg_vec3 *found;
    size_t found_count, found_capacity, axes_count; /* the latter: not of shapes' faces */
    csg_fillet_end axes[MOST_AXES];
    size_t axis_count;
    /* of the union at hand */
    csg_fillet_end *made;
    double *reached;
    size_t made_capacity, reached_capacity;
} search;

/* ---- normals ---------------------------------------------------------------------------------- */

static double snapped(double x)
{
    static const double ROOM = 1e-12;
    return fabs(x) < ROOM ? 0 : fabs(x - 1) < ROOM ? 1 : fabs(x + 1) < ROOM ? -1 : x;
}

static bool add_normal(search *s, csg_vec3 n)
{
    void *found = s->found;
    n = csg_vec3_normalize(n);
    if (!csg_memory_reserve(s->scratch->memory, &found, &s->found_capacity, s->found_count + 2,
                            sizeof *s->found))
        return false;
    s->found = found;
    csg_vec3 made = csg_vec3_make(snapped(n.x), snapped(n.y), snapped(n.z));
    s->found[s->found_count++] = made;
    s->found[s->found_count++] = csg_vec3_make(0 - made.x, 0 - made.y, 0 - made.z);
    return true;
}

static int compare_normals(const void *a, const void *b)
{
    const csg_vec3 *l = a, *r = b;
    if (l->x != r->x)
        return l->x < r->x ? -1 : 1;
    if (l->y != r->y)
        return l->y < r->y ? -1 : 1;
    return (l->z > r->z) - (l->z < r->z);
}

static bool is_near(csg_vec3 a, csg_vec3 b)
{
    return csg_vec3_norm(csg_vec3_sub(a, b)) < 1e-9;
}

static size_t keep_new(search *s, size_t kept, size_t from, size_t to)
{
    qsort(s->found + from, to - from, sizeof *s->found, compare_normals);
    for (size_t i = from; i < to && kept < MOST_PLANES; i++) {
        bool is_new = true;
        for (size_t k = 0; k < kept && is_new; k++)
            is_new = !is_near(s->found[k], s->found[i]);
        if (is_new)
            s->found[kept++] = s->found[i];
    }
    return kept;
}

/* The frame's own axes first, then the others in their order, those of shapes' faces last. */
static void sort_normals(search *s)
{
    size_t kept = keep_new(s, AXES, AXES, s->axes_count);
    s->found_count = keep_new(s, kept, s->axes_count, s->found_count);
}

static bool add_leaf_normals(search *s, const csg_node *node, const csg_affine *to_own)
{
    if (node->kind == CSG_NODE_PLANE) {
        const double *v = csg_scene_parameters(s->scene, node);
        return add_normal(s, csg_affine_covector(to_own, csg_vec3_make(v[0], v[1], v[2])));
    }
    return add_normal(s, csg_affine_covector(to_own, csg_vec3_make(1, 0, 0))) &&
           add_normal(s, csg_affine_covector(to_own, csg_vec3_make(0, 1, 0))) &&
           add_normal(s, csg_affine_covector(to_own, csg_vec3_make(0, 0, 1)));
}

/* The directions of a shape's faces or edges, if they are few. */
typedef struct faces {
    csg_vec3 normals[MOST_FACES];
    uint32_t count; /* above MOST_FACES: too many */
} faces;

static void add_face(faces *f, csg_vec3 n)
{
    double length = csg_vec3_norm(n);
    if (!(length > 0) || f->count > MOST_FACES)
        return;
    n = csg_vec3_scale(n, 1 / length);
    for (uint32_t i = 0; i < f->count; i++)
        if (is_near(f->normals[i], n))
            return;
    if (f->count < MOST_FACES)
        f->normals[f->count] = n;
    f->count++;
}

static void find_faces(const csg_shape *shape, faces *f)
{
    f->count = 0;
    if (shape->kind == CSG_SHAPE_POLYHEDRON) {
        const csg_triangles *t = csg_polyhedron_triangles(shape);
        for (size_t i = 0; i < t->count && f->count <= MOST_FACES; i++) {
            csg_vec3 a = t->points[t->corners[i][0]], b = t->points[t->corners[i][1]];
            csg_vec3 c = t->points[t->corners[i][2]];
            add_face(f, csg_vec3_cross(csg_vec3_sub(b, a), csg_vec3_sub(c, a)));
        }
        return;
    }
    const csg_outline *o = csg_region_outline(shape);
    for (size_t k = 0; k < o->loop_count; k++) {
        size_t first = csg_outline_first(o, k);
        for (size_t i = first; i < o->ends[k] && f->count <= MOST_FACES; i++) {
            size_t next = i + 1 < o->ends[k] ? i + 1 : first;
            add_face(f, csg_vec3_make(o->points[next].y - o->points[i].y,
                                      o->points[i].x - o->points[next].x, 0));
        }
    }
}

static bool add_faces(search *s, const csg_node *node, const csg_affine *to_own)
{
    faces f;
    find_faces(s->scene->shapes[node->payload], &f);
    for (uint32_t i = 0; i < f.count && f.count <= MOST_FACES; i++)
        if (!add_normal(s, csg_affine_covector(to_own, f.normals[i])))
            return false;
    return true;
}

/* A union that a blend makes larger reaches as far as its box: who asks sees no farther. */
static bool adds(const csg_node *node)
{
    return node->kind == CSG_NODE_UNION && !csg_blend_is_sharp(node->blend);
}

static void see_all(search *s)
{
    s->seen_count = 0;
    s->seen[s->seen_count++] = s->root;
    for (size_t at = 0; at < s->seen_count; at++) {
        const csg_node *node = &s->scene->nodes[s->seen[at]];
        for (uint32_t k = 0; k < node->child_count && (at == 0 || !adds(node)); k++)
            s->seen[s->seen_count++] = csg_scene_children(s->scene, node)[k];
    }
}

static bool find_normals(search *s)
{
    const csgm_scene *scene = s->scene;
    const csg_affine identity = csg_affine_identity();
    s->found_count = 0;
    if (!add_leaf_normals(s, &scene->nodes[s->root], &identity))
        return false;
    s->to_own[s->root] = identity;
    s->is_placed[s->root] = true;
    for (size_t at = 0; at < s->seen_count; at++) {
        csg_node_id i = s->seen[at];
        const csg_node *node = &scene->nodes[i];
        bool is_box = at > 0 && adds(node);
        csg_affine inner = s->to_own[i];
        bool is_placed = s->is_placed[i] && node->kind != CSG_NODE_WARP;
        if (node->kind == CSG_NODE_TRANSFORM)
            inner = csg_affine_multiply(scene->inverses[node->payload], inner);
        for (uint32_t k = 0; k < node->child_count && !is_box; k++) {
            csg_node_id child = csg_scene_children(scene, node)[k];
            s->to_own[child] = inner;
            s->is_placed[child] =
                is_placed && !(node->kind == CSG_NODE_DIFFERENCE && k > 0); /* no face of it */
        }
        bool is_leaf = node->child_count == 0 && csg_node_is_primitive(node->kind);
        if ((is_leaf || is_box) && is_placed && !add_leaf_normals(s, node, &inner))
            return false;
    }
    s->axes_count = s->found_count;
    for (size_t at = 1; at < s->seen_count; at++) {
        csg_node_id i = s->seen[at];
        if (scene->nodes[i].kind == CSG_NODE_SHAPE && s->is_placed[i] &&
            !add_faces(s, &scene->nodes[i], &s->to_own[i]))
            return false;
    }
    sort_normals(s);
    return true;
}

/* ---- axes --------------------------------------------------------------------------------------
 */

static double least_positive(double x, double otherwise)
{
    return x != 0 ? x : otherwise;
}

/* The axis of a leaf in the union's frame: the same for all leaves around it. False: it has none,
 * or its frame makes it no circle. */
static bool axis_of(const search *s, size_t i, csg_fillet_end *out, double *scale)
{
    const csg_node *node = &s->scene->nodes[i];
    csg_affine place;
    if (!s->is_placed[i] || (node->kind != CSG_NODE_FRUSTUM && node->kind != CSG_NODE_CIRCLE) ||
        !csg_affine_invert(s->to_own[i], &place) || !csg_affine_is_similarity(&place))
        return false;
    csg_vec3 n = csg_vec3_make(place.m[0][2], place.m[1][2], place.m[2][2]);
    csg_vec3 foot = csg_vec3_make(place.t[0], place.t[1], place.t[2]);
    *scale = csg_vec3_norm(n);
    n = csg_vec3_normalize(n);
    n = csg_vec3_make(snapped(n.x), snapped(n.y), snapped(n.z));
    if (least_positive(n.x, least_positive(n.y, n.z)) < 0)
        n = csg_vec3_make(0 - n.x, 0 - n.y, 0 - n.z);
    foot = csg_vec3_sub(foot, csg_vec3_scale(n, csg_vec3_dot(n, foot)));
    *out = (csg_fillet_end){n, foot, true};
    return true;
}

static bool is_same_axis(const csg_fillet_end *a, const csg_fillet_end *b)
{
    return is_near(a->normal, b->normal) &&
           csg_vec3_norm(csg_vec3_sub(a->foot, b->foot)) < 1e-9 * (1 + csg_vec3_norm(a->foot));
}

static int compare_axes(const csg_fillet_end *a, const csg_fillet_end *b)
{
    int by_normal = compare_normals(&a->normal, &b->normal);
    return by_normal ? by_normal : compare_normals(&a->foot, &b->foot);
}

/* The first ones in an order that is not that of the operands. */
static void find_axes(search *s)
{
    s->axis_count = 0;
    for (size_t n = 1; n < s->seen_count; n++) {
        csg_node_id i = s->seen[n];
        csg_fillet_end made;
        double scale;
        size_t at = 0;
        if (!axis_of(s, i, &made, &scale))
            continue;
        while (at < s->axis_count && !is_same_axis(&s->axes[at], &made))
            at++;
        if (at < s->axis_count) {
            if (compare_axes(&made, &s->axes[at]) < 0)
                s->axes[at] = made;
            continue;
        }
        for (at = s->axis_count; at > 0 && compare_axes(&made, &s->axes[at - 1]) < 0; at--)
            if (at < MOST_AXES)
                s->axes[at] = s->axes[at - 1];
        if (at < MOST_AXES)
            s->axes[at] = made;
        s->axis_count += s->axis_count < MOST_AXES;
    }
}

/* ---- how far the operands reach --------------------------------------------------------------- */

static double side(double n, double low, double high)
{
    return n == 0 ? 0 : n > 0 ? n * high : n * low;
}

static double box_reach(csg_box box, csg_vec3 n)
{
    return side(n.x, box.min.x, box.max.x) + side(n.y, box.min.y, box.max.y) +
           side(n.z, box.min.z, box.max.z);
}

/* An extrusion reaches as far as its figure and its height do together. */
static void hand_down(search *s, size_t i)
{
    const csgm_scene *scene = s->scene;
    const csg_node *node = &scene->nodes[i];
    csg_vec3 n = s->normals[i];
    if (node->kind == CSG_NODE_TRANSFORM)
        n = csg_affine_covector(&scene->transforms[node->payload], n);
    for (uint32_t k = 0; k < node->child_count; k++) {
        csg_node_id child = csg_scene_children(scene, node)[k];
        csg_vec3 inner = n;
        if (csg_node_is_plate(node))
            inner = scene->nodes[child].flags & CSG_FLAG_FLAT ? csg_vec3_make(n.x, n.y, 0)
                                                              : csg_vec3_make(0, 0, n.z);
        s->normals[child] = inner;
    }
}

/* Operators within all of their operands, or within the first. */
static bool is_within(const csg_node *node)
{
    return !csg_blend_is_rule(node->blend);
}

static double children_reach(const search *s, const csg_node *node)
{
    const csg_node_id *children = csg_scene_children(s->scene, node);
    bool meets = node->kind == CSG_NODE_INTERSECTION;
    double reach = s->reaches[children[0]];
    for (uint32_t k = 1; k < node->child_count && node->kind != CSG_NODE_DIFFERENCE; k++) {
        double one = s->reaches[children[k]];
        reach = csg_node_is_plate(node) ? reach + one : meets ? fmin(reach, one) : fmax(reach, one);
    }
    return reach;
}

/* To its outermost corner; of very many it is not looked for. */
static double shape_reach(const csg_shape *shape, csg_vec3 n)
{
    enum { MOST_POINTS = 1 << 16 };
    double reach = -INFINITY;
    if (shape->kind == CSG_SHAPE_POLYHEDRON) {
        const csg_triangles *t = csg_polyhedron_triangles(shape);
        for (size_t i = 0; i < t->point_count && t->point_count <= MOST_POINTS; i++)
            reach = fmax(reach, csg_vec3_dot(n, t->points[i]));
    } else {
        const csg_outline *o = csg_region_outline(shape);
        for (size_t i = 0; i < o->point_count && o->point_count <= MOST_POINTS; i++)
            reach = fmax(reach, n.x * o->points[i].x + n.y * o->points[i].y);
        if (n.z != 0)
            return INFINITY;
    }
    return isfinite(reach) ? reach : INFINITY;
}

/* Of what stands below the union: INFINITY where it is not known. */
static double node_reach(const search *s, size_t i)
{
    const csgm_scene *scene = s->scene;
    const csg_node *node = &scene->nodes[i];
    csg_vec3 n = s->normals[i];
    if (csg_node_is_named_primitive(node->kind))
        return csg_primitive_of(node->kind)->support(csg_scene_parameters(scene, node), n);
    if (node->kind == CSG_NODE_SHAPE)
        return shape_reach(scene->shapes[node->payload], n);
    if (node->kind == CSG_NODE_TRANSFORM)
        return children_reach(s, node) +
               csg_vec3_dot(n, csg_vec3_make(scene->transforms[node->payload].t[0],
                                             scene->transforms[node->payload].t[1],
                                             scene->transforms[node->payload].t[2]));
    if (node->kind == CSG_NODE_COLOR)
        return children_reach(s, node);
    if (!csg_node_is_operator(node->kind) || !is_within(node))
        return INFINITY;
    return adds(node) ? INFINITY : children_reach(s, node);
}

static void find_reaches(search *s, csg_vec3 n)
{
    s->normals[s->root] = n;
    for (size_t at = 0; at < s->seen_count; at++)
        if (at == 0 || !adds(&s->scene->nodes[s->seen[at]]))
            hand_down(s, s->seen[at]);
    for (size_t at = s->seen_count; at-- > 1;) {
        csg_node_id i = s->seen[at];
        double box = box_reach(s->scene->bounds[i], s->normals[i]);
        double reach = node_reach(s, i);
        s->reaches[i] = reach < box ? reach : box; /* a NaN is no bound */
    }
}

/* ---- how far they lie off an axis --------------------------------------------------------------
 */

/* Of a box in a node's own frame: its farthest corner. */
static double corner_off(const search *s, size_t i, const csg_fillet_end *axis)
{
    csg_box box = s->scene->bounds[i];
    csg_affine place;
    csg_vec3 away;
    double most = 0;
    if (!s->is_placed[i] || !csg_box_is_finite(box) || !csg_affine_invert(s->to_own[i], &place))
        return INFINITY;
    for (int k = 0; k < 8; k++) {
        csg_vec3 corner = {k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y,
                           k & 4 ? box.max.z : box.min.z};
        most = fmax(most, csg_fillet_towards(axis, csg_affine_point(&place, corner), &away));
    }
    return most;
}

static double node_off(const search *s, size_t i, const csg_fillet_end *axis)
{
    const csg_node *node = &s->scene->nodes[i];
    csg_fillet_end own;
    double scale;
    if (axis_of(s, i, &own, &scale) && is_same_axis(&own, axis)) {
        const double *v = csg_scene_parameters(s->scene, node);
        return scale * (node->kind == CSG_NODE_CIRCLE ? v[0] : fmax(v[0], v[1]) + v[3]);
    }
    if (node->kind == CSG_NODE_TRANSFORM || node->kind == CSG_NODE_COLOR)
        return children_reach(s, node);
    if (!csg_node_is_operator(node->kind) || !is_within(node) || csg_node_is_plate(node))
        return csg_node_is_plate(node) ? fmin(s->reaches[csg_scene_children(s->scene, node)[0]],
                                              s->reaches[csg_scene_children(s->scene, node)[1]])
                                       : INFINITY;
    return adds(node) ? INFINITY : children_reach(s, node);
}

static void find_off(search *s, const csg_fillet_end *axis)
{
    for (size_t at = s->seen_count; at-- > 1;) {
        csg_node_id i = s->seen[at];
        s->reaches[i] = fmin(corner_off(s, i, axis), node_off(s, i, axis));
    }
}

/* ---- all of them ------------------------------------------------------------------------------ */

/* The ends of the union; *found: how many. */
static bool find_ends(search *s, size_t *found)
{
    const csg_node *node = &s->scene->nodes[s->root];
    const csg_node_id *children = csg_scene_children(s->scene, node);
    see_all(s);
    if (!find_normals(s))
        return false;
    size_t nodes = s->seen_count;
    if (nodes * s->found_count > MOST_WORK)
        s->found_count = AXES;
    find_axes(s);
    if (nodes * s->axis_count > MOST_WORK)
        s->axis_count = 0;
    size_t count = *found = s->found_count + s->axis_count;
    void *made = s->made, *reached = s->reached;
    if (!csg_memory_reserve(s->scratch->memory, &made, &s->made_capacity, count, sizeof *s->made))
        return false;
    s->made = made;
    if (!csg_memory_reserve(s->scratch->memory, &reached, &s->reached_capacity,
                            count * node->child_count, sizeof *s->reached))
        return false;
    s->reached = reached;
    for (size_t i = 0; i < count; i++) {
        bool is_round = i >= s->found_count;
        if (is_round) {
            s->made[i] = s->axes[i - s->found_count];
            find_off(s, &s->axes[i - s->found_count]);
        } else {
            s->made[i] = (csg_fillet_end){.normal = s->found[i]};
            find_reaches(s, s->found[i]);
        }
        for (uint32_t k = 0; k < node->child_count; k++)
            s->reached[k * count + i] = s->reaches[children[k]];
    }
    return true;
}

/* Nothing, where no union is wanted. */
static bool make_room(search *s, bool (*is_wanted)(const csg_node *node))
{
    size_t nodes = s->scene->node_count, wanted = 0;
    for (size_t i = 0; i < nodes; i++)
        wanted += s->scene->nodes[i].kind == CSG_NODE_UNION && is_wanted(&s->scene->nodes[i]);
    if (!wanted)
        return true;
    s->seen = csg_arena_calloc(s->scratch, nodes, sizeof *s->seen);
    s->to_own = csg_arena_calloc(s->scratch, nodes, sizeof *s->to_own);
    s->is_placed = csg_arena_calloc(s->scratch, nodes, sizeof *s->is_placed);
    s->normals = csg_arena_calloc(s->scratch, nodes, sizeof *s->normals);
    s->reaches = csg_arena_calloc(s->scratch, nodes, sizeof *s->reaches);
    return s->seen && s->to_own && s->is_placed && s->normals && s->reaches;
}

csgm_status csg_union_ends_find(const csgm_scene *scene, bool (*is_wanted)(const csg_node *node),
                                csg_union_ends_take *take, void *user)
{
    csg_arena scratch;
    csg_memory *memory = &scene->context->memory;
    csg_arena_init(&scratch, memory);
    search s = {.scene = scene, .scratch = &scratch};
    bool done = make_room(&s, is_wanted);
    for (size_t i = 0; done && i < scene->node_count; i++) {
        if (scene->nodes[i].kind != CSG_NODE_UNION || !is_wanted(&scene->nodes[i]))
            continue;
        size_t count = 0;
        s.root = (csg_node_id)i;
        done = find_ends(&s, &count) &&
               take(user, s.root, &(csg_fillet_planes){s.made, s.reached, count, NULL});
    }
    csg_memory_release(memory, s.found, s.found_capacity * sizeof *s.found);
    csg_memory_release(memory, s.made, s.made_capacity * sizeof *s.made);
    csg_memory_release(memory, s.reached, s.reached_capacity * sizeof *s.reached);
    csg_arena_reset(&scratch);
    return done ? CSGM_OK : CSGM_ERR_MEMORY;
}

/* ---- those of fillets -------------------------------------------------------------------------- */

typedef struct kept {
    csgm_scene *scene;
    csg_fillet_end *ends;
    double *reaches;
    size_t count, capacity, reach_count, reach_capacity;
} kept;

/* Behind those found before. */
static bool keep(void *user, csg_node_id id, const csg_fillet_planes *found)
{
    kept *k = user;
    const csg_node *node = &k->scene->nodes[id];
    csg_memory *memory = &k->scene->context->memory;
    size_t reaches = found->count * node->child_count;
    void *ends = k->ends, *reached = k->reaches;
    if (!csg_memory_reserve(memory, &ends, &k->capacity, k->count + found->count, sizeof *k->ends))
        return false;
    k->ends = ends;
    if (!csg_memory_reserve(memory, &reached, &k->reach_capacity, k->reach_count + reaches,
                            sizeof *k->reaches))
        return false;
    k->reaches = reached;
    if (found->count) {
        memcpy(k->ends + k->count, found->ends, found->count * sizeof *k->ends);
        memcpy(k->reaches + k->reach_count, found->reaches, reaches * sizeof *k->reaches);
    }
    double *v = k->scene->parameters + node->payload;
    v[CSG_FILLET_FIRST_NORMAL] = (double)k->count;
    v[CSG_FILLET_FIRST_REACH] = (double)k->reach_count;
    v[CSG_FILLET_PLANES] = (double)found->count;
    k->count += found->count;
    k->reach_count += reaches;
    return true;
}

csgm_status csg_fillet_planes_find(csgm_scene *scene)
{
    kept k = {.scene = scene};
    csgm_status status = csg_union_ends_find(scene, csg_node_is_fillet, keep, &k);
    if (status == CSGM_OK && k.count) {
        scene->ends = csg_arena_calloc(&scene->arena, k.count, sizeof *k.ends);
        scene->reaches = csg_arena_calloc(&scene->arena, k.reach_count, sizeof *k.reaches);
        status = scene->ends && scene->reaches ? CSGM_OK : CSGM_ERR_MEMORY;
    }
    if (status == CSGM_OK && k.count) {
        memcpy(scene->ends, k.ends, k.count * sizeof *k.ends);
        memcpy(scene->reaches, k.reaches, k.reach_count * sizeof *k.reaches);
    }
    csg_memory_release(&scene->context->memory, k.ends, k.capacity * sizeof *k.ends);
    csg_memory_release(&scene->context->memory, k.reaches, k.reach_capacity * sizeof *k.reaches);
    return status;
}
