/* SPDX-License-Identifier: MIT
 * Which ends a union may have: the normals of the axes of every leaf and warp below and of the
 * union's own frame (faces of boxes, caps of cylinders, slabs and extrusions are among them) and of
 * the faces of polyhedra and outlines that have few, and the axes of what is round. Sorted, so that
 * the order of the operands does not matter.
 */
#include <stdlib.h>

#include "scene/operators/union_ends_private.h"
#include "scene/primitives/kinds.h"
#include "scene/primitives/primitive.h"
#include "scene/warp_kinds.h"
#include "shape/plane/region.h"
#include "shape/polyhedra/polyhedron.h"

enum {
    MOST_PLANES = 24, /* of one union */
    MOST_FACES = 16,  /* directions of a shape that is looked at: above it, it is round */
};

/* ---- normals ---------------------------------------------------------------------------------- */

static double snapped(double x)
{
    static const double ROOM = 1e-12;
    return fabs(x) < ROOM ? 0 : fabs(x - 1) < ROOM ? 1 : fabs(x + 1) < ROOM ? -1 : x;
}

static bool add_normal(csg_end_search *s, csg_vec3 n)
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
    return csg_vec3_norm(csg_vec3_sub(a, b)) < CSG_AT_END;
}

static size_t keep_new(csg_end_search *s, size_t kept, size_t from, size_t to)
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
static void sort_normals(csg_end_search *s)
{
    size_t kept = keep_new(s, CSG_END_SIDES, CSG_END_SIDES, s->axes_count);
    s->found_count = keep_new(s, kept, s->axes_count, s->found_count);
}

static bool add_leaf_normals(csg_end_search *s, const csg_node *node, const csg_affine *to_own)
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

static bool add_faces(csg_end_search *s, const csg_node *node, const csg_affine *to_own)
{
    faces f;
    find_faces(s->scene->shapes[node->payload], &f);
    for (uint32_t i = 0; i < f.count && f.count <= MOST_FACES; i++)
        if (!add_normal(s, csg_affine_covector(to_own, f.normals[i])))
            return false;
    return true;
}

bool csg_end_find_normals(csg_end_search *s)
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
        bool is_box = at > 0 && csg_union_adds(node);
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
        bool has_axes = (is_leaf && is_placed) || is_box || node->kind == CSG_NODE_WARP;
        if (has_axes && s->is_placed[i] && !add_leaf_normals(s, node, &inner))
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

static bool is_turned(const csgm_scene *scene, const csg_node *node)
{
    return csg_primitive_has(node->kind, CSG_TRAIT_TURNED) ||
           (node->kind == CSG_NODE_WARP && scene->warps[node->payload].kind == CSG_WARP_REVOLVE);
}

/* Where its z axis lies in the union's frame. False: it is not turned, or no circle there. */
static bool find_axis(const csg_end_search *s, size_t i, csg_vec3 *n, csg_vec3 *foot, double *scale)
{
    csg_affine place;
    if (!s->is_placed[i] || !is_turned(s->scene, &s->scene->nodes[i]) ||
        !csg_affine_invert(s->to_own[i], &place) || !csg_affine_is_similarity(&place))
        return false;
    *n = csg_vec3_make(place.m[0][2], place.m[1][2], place.m[2][2]);
    *foot = csg_vec3_make(place.t[0], place.t[1], place.t[2]);
    *scale = csg_vec3_norm(*n);
    *n = csg_vec3_normalize(*n);
    return true;
}

bool csg_end_is_about(const csg_end_search *s, size_t i, const csg_fillet_end *axis, double *scale)
{
    csg_vec3 n, at, away;
    if (!find_axis(s, i, &n, &at, scale))
        return false;
    bool is_along = csg_primitive_has(s->scene->nodes[i].kind, CSG_TRAIT_BALL) ||
                    is_near(n, axis->normal) || is_near(csg_vec3_scale(n, -1), axis->normal);
    return is_along &&
           csg_fillet_towards(axis, at, &away) < csg_near_end(csg_vec3_norm(axis->foot));
}

bool csg_end_has_side(const csg_node *node)
{
    return node->kind == CSG_NODE_FRUSTUM || node->kind == CSG_NODE_CIRCLE;
}

/* The same for all nodes around it. */
static bool axis_of(const csg_end_search *s, size_t i, csg_fillet_end *out)
{
    const csg_node *node = &s->scene->nodes[i];
    csg_vec3 n, foot;
    double scale;
    if ((!csg_end_has_side(node) && node->kind != CSG_NODE_WARP) ||
        !find_axis(s, i, &n, &foot, &scale))
        return false;
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
           csg_vec3_norm(csg_vec3_sub(a->foot, b->foot)) < csg_near_end(csg_vec3_norm(a->foot));
}

static int compare_axes(const csg_fillet_end *a, const csg_fillet_end *b)
{
    int by_normal = compare_normals(&a->normal, &b->normal);
    return by_normal ? by_normal : compare_normals(&a->foot, &b->foot);
}

/* The first ones in an order that is not that of the operands. */
void csg_end_find_axes(csg_end_search *s)
{
    s->axis_count = 0;
    for (size_t n = 1; n < s->seen_count; n++) {
        csg_node_id i = s->seen[n];
        csg_fillet_end made;
        size_t at = 0;
        if (!axis_of(s, i, &made))
            continue;
        while (at < s->axis_count && !is_same_axis(&s->axes[at], &made))
            at++;
        if (at < s->axis_count) {
            if (compare_axes(&made, &s->axes[at]) < 0)
                s->axes[at] = made;
            continue;
        }
        for (at = s->axis_count; at > 0 && compare_axes(&made, &s->axes[at - 1]) < 0; at--)
            if (at < CSG_END_MOST_AXES)
                s->axes[at] = s->axes[at - 1];
        if (at < CSG_END_MOST_AXES)
            s->axes[at] = made;
        s->axis_count += s->axis_count < CSG_END_MOST_AXES;
    }
}
