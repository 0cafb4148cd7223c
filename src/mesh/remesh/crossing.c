/* SPDX-License-Identifier: MIT
 * Two triangles, and some against all; see crossing.h. Nearly all pairs are told apart by a plane:
 * that is looked at first.
 *
 * Most changes need no pairs at all. If all triangles that meet a box face along one direction d,
 * those in the box are the graph of a function over the plane across d: of two places on one line
 * along d, both in the box, the solid would have to begin again between them, on a triangle that
 * faces the other way, in the box too. So the triangles that go, in such a box, lie over a simple
 * polygon, once. What takes their place has the same border: if all of it faces along d and lies in
 * the box, it lies over that polygon once, and over nothing else that is there.
 */
#include "mesh/remesh/crossing.h"

#include <math.h>

#include "mesh/remesh/triangle.h"

/* ---- two triangles -----------------------------------------------------------------------------
 */

/* A triangle with its plane. */
typedef struct plate {
    const csg_vec3 *v;
    const uint32_t *ids;
    csg_vec3 normal; /* twice the area long */
    double norm;
} plate;

static plate plate_of(const csg_vec3 v[3], const uint32_t ids[3])
{
    csg_vec3 normal = csg_triangle_cross(v[0], v[1], v[2]);
    return (plate){v, ids, normal, csg_vec3_norm(normal)};
}

/* Whether the segment p q meets the triangle, or comes as near to it as `clear`. */
static bool pierces(csg_vec3 p, csg_vec3 q, const plate *t, double clear)
{
    const csg_vec3 *v = t->v;
    double a = csg_vec3_dot(t->normal, csg_vec3_sub(p, v[0]));
    double b = csg_vec3_dot(t->normal, csg_vec3_sub(q, v[0]));
    double low = a < b ? a : b, high = a < b ? b : a;
    if (!(t->norm > 0) || low > clear * t->norm || high < -clear * t->norm || a == b)
        return false;
    csg_vec3 way = csg_vec3_sub(q, p);
    csg_vec3 at = csg_vec3_add(p, csg_vec3_scale(way, fmin(1, fmax(0, a / (a - b)))));
    for (int k = 0; k < 3; k++) {
        csg_vec3 side = csg_vec3_sub(v[(k + 1) % 3], v[k]);
        double within = csg_vec3_dot(t->normal, csg_vec3_cross(side, csg_vec3_sub(at, v[k])));
        if (within < -clear * t->norm * csg_vec3_norm(side))
            return false;
    }
    return true;
}

/* Corners in common: their places in each. */
static int common_corners(const uint32_t a[3], const uint32_t b[3], int *in_a, int *in_b)
{
    int count = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            if (a[i] == b[k]) {
                *in_a = i;
                *in_b = k;
                count++;
            }
    return count;
}

/* Whether b is on one side of the plane of a, but for the corner that they share (or -1). */
static bool is_beyond(const plate *a, const csg_vec3 b[3], int shared, double clear)
{
    double low = INFINITY, high = -INFINITY;
    for (int k = 0; k < 3; k++) {
        if (k == shared)
            continue;
        double d = csg_vec3_dot(a->normal, csg_vec3_sub(b[k], a->v[0]));
        low = d < low ? d : low;
        high = d > high ? d : high;
    }
    double least = clear * a->norm;
    return low > least || high < -least;
}

/* Of two with a corner in common one side each can meet the other, that across from it: if only by
 * a touch of the other's border, then their sheets lie in one another. */
static bool cross(const plate *a, const plate *b, double clear)
{
    int i = -1, k = -1, common = common_corners(a->ids, b->ids, &i, &k);
    if (common >= 2)
        return false; /* at an edge: they would have to lie in one another */
    if (is_beyond(a, b->v, k, clear) || is_beyond(b, a->v, i, clear))
        return false;
    if (common == 1)
        return pierces(a->v[(i + 1) % 3], a->v[(i + 2) % 3], b, clear) ||
               pierces(b->v[(k + 1) % 3], b->v[(k + 2) % 3], a, clear);
    for (k = 0; k < 3; k++)
        if (pierces(a->v[k], a->v[(k + 1) % 3], b, clear) ||
            pierces(b->v[k], b->v[(k + 1) % 3], a, clear))
            return true;
    return false;
}

/* ---- the new ones ------------------------------------------------------------------------------
 */

/* Whether a fan lies over a plane without folds: all of it faces one way, and it goes around its
 * middle once. Its triangles cannot cross then. */
static bool is_unfolded(const csg_crossing_change *c, const plate *plates)
{
    static const double LEAST_COS = 0.05;
    csg_vec3 sum = {0, 0, 0}, x, y;
    for (size_t i = 0; i < c->count; i++)
        sum = csg_vec3_add(sum, plates[i].normal);
    csg_vec3 axis = csg_vec3_normalize(sum);
    for (size_t i = 0; i < c->count; i++)
        if (!(csg_vec3_dot(axis, plates[i].normal) > LEAST_COS * plates[i].norm))
            return false;
    x = csg_vec3_cross(axis, fabs(axis.x) < 0.6 ? csg_vec3_make(1, 0, 0) : csg_vec3_make(0, 1, 0));
    y = csg_vec3_cross(axis, x);
    int turns = 0; /* sides that pass the half line along x */
    for (size_t i = 0; i < c->count; i++) {
        csg_vec3 p = csg_vec3_sub(c->at[i][1], c->at[i][0]);
        csg_vec3 q = csg_vec3_sub(c->at[i][2], c->at[i][0]);
        double p_y = csg_vec3_dot(p, y), q_y = csg_vec3_dot(q, y);
        if ((p_y < 0) == (q_y < 0))
            continue;
        double p_x = csg_vec3_dot(p, x), q_x = csg_vec3_dot(q, x);
        double across = p_x * (q_y - p_y) - p_y * (q_x - p_x);
        turns += (across > 0) == (q_y > p_y);
    }
    return turns == 1;
}

/* ---- all of them -------------------------------------------------------------------------------
 */

static bool stays(const csg_triangle_tree *t, const csg_crossing_change *c, uint32_t triangle)
{
    if (!csg_corners_is_live(t->corners, triangle) || triangle == c->triangles[0] ||
        triangle == c->triangles[1])
        return false;
    const uint32_t *v = t->corners->vertex + 3 * (size_t)triangle;
    for (int k = 0; k < 3; k++)
        if (v[k] == c->vertices[0] || v[k] == c->vertices[1])
            return false;
    return true;
}

typedef struct range {
    double min, max;
} range;

static range range_of(double a, double b, double c)
{
    range r = a < b ? (range){a, b} : (range){b, a};
    return (range){c < r.min ? c : r.min, c > r.max ? c : r.max};
}

static bool are_apart(range a, range b)
{
    return a.min > b.max || b.min > a.max;
}

/* A box of exact places. */
typedef struct extent {
    range x, y, z;
} extent;

static extent extent_of(const csg_vec3 v[3])
{
    return (extent){range_of(v[0].x, v[1].x, v[2].x), range_of(v[0].y, v[1].y, v[2].y),
                    range_of(v[0].z, v[1].z, v[2].z)};
}

/* The new triangles, with what is known of each, and the box around all. */
typedef struct newcomers {
    plate plates[CSG_CROSSING_MOST];
    extent extents[CSG_CROSSING_MOST];
    csg_triangle_box all;
} newcomers;

static bool crosses_triangle(const csg_triangle_tree *t, const newcomers *n, size_t count,
                             uint32_t triangle)
{
    const uint32_t *ids = t->corners->vertex + 3 * (size_t)triangle;
    const csg_vec3 v[3] = {t->at[ids[0]], t->at[ids[1]], t->at[ids[2]]};
    const csg_triangle_box *all = &n->all;
    extent e;
    e.x = range_of(v[0].x, v[1].x, v[2].x);
    if (are_apart(e.x, (range){(double)all->min[0], (double)all->max[0]}))
        return false;
    e.y = range_of(v[0].y, v[1].y, v[2].y);
    if (are_apart(e.y, (range){(double)all->min[1], (double)all->max[1]}))
        return false;
    e.z = range_of(v[0].z, v[1].z, v[2].z);
    if (are_apart(e.z, (range){(double)all->min[2], (double)all->max[2]}))
        return false;
    plate other = plate_of(v, ids);
    for (size_t i = 0; i < count; i++) {
        const extent *own = &n->extents[i];
        if (!are_apart(own->x, e.x) && !are_apart(own->y, e.y) && !are_apart(own->z, e.z) &&
            cross(&n->plates[i], &other, t->noise))
            return true;
    }
    return false;
}

static bool crosses_rest(const csg_triangle_tree *t, const csg_crossing_change *c,
                         const newcomers *n)
{
    size_t stack[CSG_TRIANGLE_TREE_STACK], top = 0;
    stack[top++] = 1;
    while (top) {
        size_t i = stack[--top];
        if (!csg_triangle_boxes_overlap(&n->all, &t->nodes[i]))
            continue;
        if (i < t->leaf_count) {
            stack[top++] = 2 * i + 1;
            stack[top++] = 2 * i;
            continue;
        }
        i -= t->leaf_count;
        for (size_t k = i * CSG_TRIANGLES_A_LEAF, end = csg_triangle_tree_end(t, i); k < end; k++) {
            uint32_t triangle = csg_triangle_tree_item(t, k);
            if (stays(t, c, triangle) && crosses_triangle(t, n, c->count, triangle))
                return true;
        }
    }
    return false;
}

/* ---- one sheet ---------------------------------------------------------------------------------
 */

static void include_triangle(csg_triangle_box *all, const csg_triangle_tree *t, uint32_t triangle)
{
    csg_vec3 v[3];
    csg_triangle_tree_corners(t, triangle, v);
    csg_triangle_box box = csg_triangle_box_of(v);
    *all = csg_triangle_box_around(all, &box);
}

static range range_around(range a, range b)
{
    return (range){a.min < b.min ? a.min : b.min, a.max > b.max ? a.max : b.max};
}

static csg_triangle_box box_of_extents(const extent *extents, size_t count)
{
    static const range NONE = {INFINITY, -INFINITY};
    extent e = {NONE, NONE, NONE};
    for (size_t i = 0; i < count; i++) {
        e.x = range_around(e.x, extents[i].x);
        e.y = range_around(e.y, extents[i].y);
        e.z = range_around(e.z, extents[i].z);
    }
    const csg_vec3 ends[3] = {
        {e.x.min, e.y.min, e.z.min}, {e.x.max, e.y.max, e.z.max}, {e.x.max, e.y.max, e.z.max}};
    return csg_triangle_box_of(ends);
}

static void include_place(csg_triangle_box *all, csg_vec3 p)
{
    const csg_vec3 v[3] = {p, p, p};
    csg_triangle_box box = csg_triangle_box_of(v);
    *all = csg_triangle_box_around(all, &box);
}

/* The box around what goes and what comes. The neighbours of vertices that go are corners of what
 * comes, or of a triangle that goes. */
static csg_triangle_box box_of_change(const csg_triangle_tree *t, const csg_crossing_change *c,
                                      const csg_triangle_box *new)
{
    csg_triangle_box all = *new;
    for (int i = 0; i < 2; i++) {
        if (c->triangles[i] != CSG_CORNER_NONE)
            include_triangle(&all, t, c->triangles[i]);
        if (c->vertices[i] != CSG_CORNER_NONE)
            include_place(&all, t->at[c->vertices[i]]);
    }
    return all;
}

static int count_bits(uint32_t word)
{
    int count = 0;
    for (; word; word &= word - 1)
        count++;
    return count;
}

static bool is_apart(const csg_triangle_box *box, int axis, double a, double b, double c)
{
    range own = range_of(a, b, c);
    return own.min > (double)box->max[axis] || own.max < (double)box->min[axis];
}

static uint32_t facing_of_leaf(const csg_triangle_tree *t, size_t leaf, const csg_triangle_box *box)
{
    uint32_t facing = CSG_FACING_ALL;
    for (size_t i = leaf * CSG_TRIANGLES_A_LEAF, end = csg_triangle_tree_end(t, leaf); i < end;
         i++) {
        csg_vec3 v[3];
        uint32_t triangle = csg_triangle_tree_item(t, i);
        if (!csg_corners_is_live(t->corners, triangle))
            continue;
        csg_triangle_tree_corners(t, triangle, v);
        if (!is_apart(box, 0, v[0].x, v[1].x, v[2].x) &&
            !is_apart(box, 1, v[0].y, v[1].y, v[2].y) && !is_apart(box, 2, v[0].z, v[1].z, v[2].z))
            facing &= csg_triangle_facing(csg_triangle_cross(v[0], v[1], v[2]));
    }
    return facing;
}

/* Whether all that meets the box faces along one of these directions. Large parts of the mesh are
 * taken as one while they leave several. */
static bool is_one_sheet(const csg_triangle_tree *t, const csg_triangle_box *box, uint32_t facing)
{
    enum { SEVERAL = 4 };
    size_t stack[CSG_TRIANGLE_TREE_STACK], top = 0;
    stack[top++] = 1;
    while (top && facing) {
        size_t i = stack[--top];
        if (!csg_triangle_boxes_overlap(box, &t->nodes[i]))
            continue;
        uint32_t left = facing & t->facing[i];
        if (left == facing)
            continue;
        if (count_bits(left) >= SEVERAL) {
            facing = left;
            continue;
        }
        if (i >= t->leaf_count) {
            facing &= facing_of_leaf(t, i - t->leaf_count, box);
            continue;
        }
        stack[top++] = 2 * i + 1;
        stack[top++] = 2 * i;
    }
    return facing;
}

bool csg_crossing_is_made(const csg_triangle_tree *t, const csg_crossing_change *c, bool *one_sheet)
{
    newcomers n; /* not filled: it is large */
    uint32_t facing = CSG_FACING_ALL;
    for (size_t i = 0; i < c->count; i++) {
        n.plates[i] = plate_of(c->at[i], c->vertex[i]);
        n.extents[i] = extent_of(c->at[i]);
        facing &= csg_triangle_facing(n.plates[i].normal);
    }
    n.all = box_of_extents(n.extents, c->count);
    csg_triangle_box box = box_of_change(t, c, &n.all);
    bool sheet = is_one_sheet(t, &box, facing);
    if (one_sheet)
        *one_sheet = sheet;
    if (sheet)
        return false;
    if (!c->is_fan || !is_unfolded(c, n.plates))
        for (size_t i = 0; i < c->count; i++)
            for (size_t k = i + 1; k < c->count; k++)
                if (cross(&n.plates[i], &n.plates[k], t->noise))
                    return true;
    return crosses_rest(t, c, &n);
}
