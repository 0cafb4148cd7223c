/* SPDX-License-Identifier: MIT
 * Is a triangle's side clear? A closed chain may cross itself, and shells may overlap; the distance
 * is then that to triangles inside the solid too, on both sides of which the field is positive.
 * Where a triangle crosses nothing, the winding number is one all along each of its sides, so one
 * ray per side tells. What is called crossing here may be a touch, never the other way round.
 */
#include "shape/polyhedra/tree.h"

enum { STACK = 256 };

typedef struct corners {
    csg_vec3 at[3];
} corners;

static corners corners_of(const csg_tree_triangle *t)
{
    return (corners){{t->a, csg_vec3_add(t->a, t->ab), csg_vec3_add(t->a, t->ac)}}; /* exact */
}

static bool is_same(csg_vec3 a, csg_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* Six times the volume of the tetrahedron; 0 where its sign is not certain. */
static double volume(csg_vec3 a, csg_vec3 b, csg_vec3 c, csg_vec3 d)
{
    csg_vec3 u = csg_vec3_sub(b, a), v = csg_vec3_sub(c, a), w = csg_vec3_sub(d, a); /* exact */
    double x = u.x * (v.y * w.z - v.z * w.y), y = u.y * (v.z * w.x - v.x * w.z),
           z = u.z * (v.x * w.y - v.y * w.x);
    double size = fabs(u.x) * (fabs(v.y * w.z) + fabs(v.z * w.y)) +
                  fabs(u.y) * (fabs(v.z * w.x) + fabs(v.x * w.z)) +
                  fabs(u.z) * (fabs(v.x * w.y) + fabs(v.y * w.x));
    double sum = x + y + z;
    return fabs(sum) > 0x1p-49 * size ? sum : 0;
}

/* Whether the segment from p to q may meet the triangle. Not one that lies in its plane: of what
 * stands on such a segment other edges come from beside. */
static bool meets(csg_vec3 p, csg_vec3 q, const corners *t)
{
    double from = volume(t->at[0], t->at[1], t->at[2], p),
           to = volume(t->at[0], t->at[1], t->at[2], q);
    if ((from > 0 && to > 0) || (from < 0 && to < 0) || (from == 0 && to == 0))
        return false;
    double low = INFINITY, high = -INFINITY;
    for (int k = 0; k < 3; k++) {
        double side = volume(p, q, t->at[k], t->at[(k + 1) % 3]);
        low = fmin(low, side);
        high = fmax(high, side);
    }
    return low >= 0 || high <= 0;
}

/* Whether all corners of a triangle lie on one side of the plane of another, but for one that they
 * share: then they do not meet. */
static bool is_beside(const corners *a, const corners *plane, int shared_corner)
{
    double least = INFINITY, most = -INFINITY;
    for (int k = 0; k < 3; k++) {
        if (k == shared_corner)
            continue;
        double height = volume(plane->at[0], plane->at[1], plane->at[2], a->at[k]);
        least = height < least ? height : least;
        most = height > most ? height : most;
    }
    return least > 0 || most < 0;
}

/* Edges without a corner of the other triangle. Triangles that share an edge can only lie in one
 * plane, and then their normals are opposite. */
static bool edges_meet(const corners *a, const corners *b, int shared_corner)
{
    for (int k = 0; k < 3; k++)
        if (k != shared_corner && (k + 1) % 3 != shared_corner &&
            meets(a->at[k], a->at[(k + 1) % 3], b))
            return true;
    return false;
}

static bool is_crossing(const corners *a, const corners *b)
{
    int shared = 0, of_a = -1, of_b = -1;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            if (is_same(a->at[i], b->at[k])) {
                shared++;
                of_a = i;
                of_b = k;
            }
    return shared < 2 && !is_beside(b, a, of_b) && !is_beside(a, b, of_a) &&
           (edges_meet(a, b, of_a) || edges_meet(b, a, of_b));
}

static csg_box box_of(const corners *t)
{
    csg_box box = csg_box_empty();
    for (int k = 0; k < 3; k++)
        box = csg_box_hull(box, (csg_box){t->at[k], t->at[k]});
    return box;
}

static bool overlaps(const csg_tree_node *node, uint32_t i, csg_box box)
{
    return (double)node->low[0][i] <= box.max.x && (double)node->high[0][i] >= box.min.x &&
           (double)node->low[1][i] <= box.max.y && (double)node->high[1][i] >= box.min.y &&
           (double)node->low[2][i] <= box.max.z && (double)node->high[2][i] >= box.min.z;
}

bool csg_tree_in_box(const csg_tree *tree, csg_box box, csg_tree_visit *visit, void *user)
{
    uint32_t stack[STACK];
    size_t depth = 0;
    stack[depth++] = 0;
    while (depth) {
        uint32_t next = stack[--depth];
        if (next & CSG_TREE_LEAF) {
            const csg_tree_leaf *leaf = &tree->leaves[next & ~CSG_TREE_LEAF];
            for (uint32_t i = leaf->first; i < leaf->first + leaf->count; i++)
                if (!visit(user, i))
                    return false;
            continue;
        }
        for (uint32_t i = 0; i < 4; i++)
            if (overlaps(&tree->nodes[next], i, box))
                stack[depth++] = tree->nodes[next].children[i];
    }
    return true;
}

typedef struct crossing_search {
    const csg_tree *tree;
    uint32_t place;
    corners own;
    csg_box box;
} crossing_search;

/* Whether three numbers lie all below or all above a stretch. */
static inline bool is_outside(double a, double b, double c, double low, double high)
{
    return (a < low && b < low && c < low) || (a > high && b > high && c > high);
}

static bool is_apart(void *user, uint32_t place)
{
    const crossing_search *s = user;
    const csg_tree_triangle *t = &s->tree->triangles[place];
    csg_vec3 a = t->a, b = csg_vec3_add(a, t->ab), c = csg_vec3_add(a, t->ac); /* exact */
    if (is_outside(a.x, b.x, c.x, s->box.min.x, s->box.max.x) ||
        is_outside(a.y, b.y, c.y, s->box.min.y, s->box.max.y) ||
        is_outside(a.z, b.z, c.z, s->box.min.z, s->box.max.z) || place == s->place)
        return true;
    corners other = {{a, b, c}};
    return !is_crossing(&s->own, &other);
}

static bool crosses_some(const csg_tree *tree, uint32_t place)
{
    corners own = corners_of(&tree->triangles[place]);
    crossing_search s = {tree, place, own, box_of(&own)};
    return !csg_tree_in_box(tree, s.box, is_apart, &s);
}

/* Next to the middle of the triangle, 2^-30 of the frame away. */
static int winding_beside(const csg_tree *tree, const csg_tree_triangle *t, double way)
{
    csg_vec3 middle = csg_vec3_add(t->a, csg_vec3_scale(csg_vec3_add(t->ab, t->ac), 1.0 / 3));
    csg_vec3 out = csg_vec3_normalize(csg_vec3_cross(t->ab, t->ac));
    csg_vec3 at = csg_vec3_add(middle, csg_vec3_scale(out, way * 0x1p-30));
    csg_vec3 cell = csg_triangle_frame_round_point(at);
    bool inside = cell.x >= tree->box.min.x && cell.x <= tree->box.max.x &&
                  cell.y >= tree->box.min.y && cell.y <= tree->box.max.y &&
                  cell.z >= tree->box.min.z && cell.z <= tree->box.max.z;
    return inside ? csg_tree_winding(tree, cell, NULL) : 0;
}

bool csg_tree_is_clear(const csg_tree *tree, uint32_t place)
{
    const csg_tree_triangle *t = &tree->triangles[place];
    return winding_beside(tree, t, -1) == 1 && winding_beside(tree, t, 1) == 0;
}

bool csg_tree_is_plain(const csg_tree *tree, uint32_t place)
{
    return !tree->triangles[place].is_needle && csg_tree_is_clear(tree, place) &&
           !crosses_some(tree, place);
}
