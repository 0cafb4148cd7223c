/* SPDX-License-Identifier: MIT
 * Is a triangle's side clear? A closed chain may cross itself, and shells may overlap; the distance
 * is then that to triangles inside the solid too, on both sides of which the field is positive.
 * Where a triangle crosses nothing, the winding number is one all along each of its sides, and
 * along those of its neighbours that cross nothing either: so one ray per side tells for all of
 * them. What is called crossing here may be a touch, never the other way round.
 */
#include "base/four.h"
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
        csg_box_extend(&box, t->at[k]);
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

static bool is_apart(void *user, uint32_t place)
{
    const crossing_search *s = user;
    const csg_tree_triangle *t = &s->tree->triangles[place];
    csg_vec3 a = t->a, b = csg_vec3_add(a, t->ab), c = csg_vec3_add(a, t->ac); /* exact */
    if (place == s->place || csg_tree_is_outside(a.x, b.x, c.x, s->box.min.x, s->box.max.x) ||
        csg_tree_is_outside(a.y, b.y, c.y, s->box.min.y, s->box.max.y) ||
        csg_tree_is_outside(a.z, b.z, c.z, s->box.min.z, s->box.max.z))
        return true;
    corners other = {{a, b, c}};
    return !is_crossing(&s->own, &other);
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

/* ---- groups ------------------------------------------------------------------------------------
 */

enum { MOST_AROUND = 16 * CSG_TREE_GROUP };

/* A box in float, wider by CSG_TREE_PAD. */
typedef struct wide_box {
    float low[3], high[3];
} wide_box;

/* All that the triangles of a group can cross, if it is not too much: places, and their boxes and
 * corners by fours. */
typedef struct surroundings {
    const csg_tree *tree;
    uint32_t places[MOST_AROUND], count;
    float low[3][MOST_AROUND], high[3][MOST_AROUND];
    wide_box box;    /* of the group */
    csg_vec3 origin; /* of the corners */
    float corner[3][3][MOST_AROUND], largest;
    bool are_all;
} surroundings;

static inline wide_box wide_box_of(const csg_tree_triangle *t)
{
    const double a[3] = {t->a.x, t->a.y, t->a.z}, ab[3] = {t->ab.x, t->ab.y, t->ab.z},
                 ac[3] = {t->ac.x, t->ac.y, t->ac.z};
    wide_box box;
    for (int k = 0; k < 3; k++) {
        double low = ab[k] < ac[k] ? ab[k] : ac[k], high = ab[k] < ac[k] ? ac[k] : ab[k];
        box.low[k] = (float)(a[k] + (low < 0 ? low : 0)) - CSG_TREE_PAD;
        box.high[k] = (float)(a[k] + (high > 0 ? high : 0)) + CSG_TREE_PAD;
    }
    return box;
}

static void take_corners(surroundings *around, uint32_t i, const csg_tree_triangle *t)
{
    const corners c = corners_of(t);
    for (int k = 0; k < 3; k++) {
        csg_vec3 p = csg_vec3_sub(c.at[k], around->origin);
        const float at[3] = {(float)p.x, (float)p.y, (float)p.z};
        for (int axis = 0; axis < 3; axis++) {
            float size = fabsf(at[axis]);
            around->corner[k][axis][i] = at[axis];
            around->largest = size > around->largest ? size : around->largest;
        }
    }
}

static bool list_place(void *user, uint32_t place)
{
    surroundings *around = user;
    const csg_tree_triangle *t = &around->tree->triangles[place];
    const wide_box box = wide_box_of(t);
    uint32_t i = around->count;
    bool is_apart = false;
    for (int k = 0; k < 3; k++)
        is_apart = is_apart || box.low[k] > around->box.high[k] || box.high[k] < around->box.low[k];
    if (is_apart)
        return true;
    around->are_all = i < MOST_AROUND;
    if (!around->are_all)
        return false;
    for (int k = 0; k < 3; k++) {
        around->low[k][i] = box.low[k];
        around->high[k][i] = box.high[k];
    }
    take_corners(around, i, t);
    around->places[around->count++] = place;
    return true;
}

static void look_around(const csg_tree *tree, uint32_t first, uint32_t count, surroundings *around)
{
    wide_box *whole = &around->box;
    *whole = wide_box_of(&tree->triangles[first]);
    for (uint32_t i = 1; i < count; i++) {
        const wide_box box = wide_box_of(&tree->triangles[first + i]);
        for (int k = 0; k < 3; k++) {
            whole->low[k] = box.low[k] < whole->low[k] ? box.low[k] : whole->low[k];
            whole->high[k] = box.high[k] > whole->high[k] ? box.high[k] : whole->high[k];
        }
    }
    around->tree = tree;
    around->count = 0;
    around->origin = tree->triangles[first].a;
    around->largest = 0;
    around->are_all = true;
    csg_box box = {csg_vec3_from_floats(whole->low), csg_vec3_from_floats(whole->high)};
    csg_tree_in_box(tree, box, list_place, around);
    for (uint32_t i = around->count; i % 4; i++) { /* the first again: once more does no harm */
        around->places[i] = around->places[0];
        take_corners(around, i, &tree->triangles[around->places[0]]);
        for (int k = 0; k < 3; k++) {
            around->low[k][i] = around->low[k][0];
            around->high[k][i] = around->high[k][0];
        }
    }
}

/* Of four places from `i` on those whose boxes meet a box, a bit each. */
static inline unsigned near_of_four(const surroundings *around, uint32_t i, const wide_box *box)
{
    csg_four_mask near = csg_four_load(around->low[0] + i) <= csg_four_all(box->high[0]);
    near &= csg_four_load(around->high[0] + i) >= csg_four_all(box->low[0]);
    for (int k = 1; k < 3; k++) {
        near &= csg_four_load(around->low[k] + i) <= csg_four_all(box->high[k]);
        near &= csg_four_load(around->high[k] + i) >= csg_four_all(box->low[k]);
    }
    return csg_four_bits(near);
}

/* The plane of a triangle, and more than heights above it are off in float: some twelve roundings,
 * each by 2^-24 of at most three times the largest coordinate. */
typedef struct plane {
    float normal[3], at, error;
} plane;

static plane plane_of(const surroundings *around, const corners *t)
{
    csg_vec3 normal = csg_vec3_normalize(
        csg_vec3_cross(csg_vec3_sub(t->at[1], t->at[0]), csg_vec3_sub(t->at[2], t->at[0])));
    plane p = {{(float)normal.x, (float)normal.y, (float)normal.z},
               (float)csg_vec3_dot(normal, csg_vec3_sub(t->at[0], around->origin)),
               0x1p-18f * around->largest};
    return p;
}

/* Of four places from `i` on, a bit each: those certainly beside a plane (is_beside), but for a
 * corner that they must share with its triangle: alone[k] where that is corner k. */
static inline unsigned beside_of_four(const surroundings *around, uint32_t i, const plane *of,
                                      unsigned alone[3])
{
    csg_four_mask above[3], below[3];
    csg_four error = csg_four_all(of->error);
    for (int k = 0; k < 3; k++) {
        csg_four height = csg_four_load(around->corner[k][0] + i) * csg_four_all(of->normal[0]) +
                          csg_four_load(around->corner[k][1] + i) * csg_four_all(of->normal[1]) +
                          csg_four_load(around->corner[k][2] + i) * csg_four_all(of->normal[2]) -
                          csg_four_all(of->at);
        above[k] = height > error;
        below[k] = height < -error;
    }
    for (int k = 0; k < 3; k++) {
        int m = (k + 1) % 3, n = (k + 2) % 3;
        alone[k] = csg_four_bits((above[m] & above[n]) | (below[m] & below[n]));
    }
    return csg_four_bits((above[0] & above[1] & above[2]) | (below[0] & below[1] & below[2]));
}

/* Of four places from `i` on those that may meet a triangle, a bit each. Those across its edges
 * share two corners with it, so they do not. */
static unsigned doubtful_of_four(const surroundings *around, uint32_t i, const corners *own,
                                 const wide_box *box, const plane *of, const uint32_t beside[3])
{
    unsigned near = near_of_four(around, i, box), alone[3];
    for (unsigned rest = near; rest; rest &= rest - 1) {
        uint32_t n = (uint32_t)__builtin_ctz(rest), place = around->places[i + n];
        if (place == beside[0] || place == beside[1] || place == beside[2])
            near &= ~(1u << n);
    }
    if (!near)
        return 0;
    near &= ~beside_of_four(around, i, of, alone);
    for (int k = 0; k < 3; k++)
        for (unsigned rest = near & alone[k]; rest; rest &= rest - 1) {
            uint32_t n = (uint32_t)__builtin_ctz(rest);
            const csg_tree_triangle *t = &around->tree->triangles[around->places[i + n]];
            csg_vec3 p = k == 0 ? t->a : csg_vec3_add(t->a, k == 1 ? t->ab : t->ac);
            if (is_same(p, own->at[0]) || is_same(p, own->at[1]) || is_same(p, own->at[2]))
                near &= ~(1u << n);
        }
    return near;
}

static bool crosses_some(const csg_tree *tree, uint32_t place, const uint32_t beside[3],
                         const surroundings *around)
{
    corners own = corners_of(&tree->triangles[place]);
    crossing_search s = {tree, place, own, box_of(&own)};
    if (!around->are_all)
        return !csg_tree_in_box(tree, s.box, is_apart, &s);
    const wide_box box = wide_box_of(&tree->triangles[place]);
    const plane of = plane_of(around, &own);
    for (uint32_t i = 0; i < around->count; i += 4)
        for (unsigned near = doubtful_of_four(around, i, &own, &box, &of, beside); near;
             near &= near - 1)
            if (!is_apart(&s, around->places[i + (uint32_t)__builtin_ctz(near)]))
                return true;
    return false;
}

static csg_vec3 normal_of(const csg_tree_triangle *t)
{
    return csg_vec3_cross(t->ab, t->ac);
}

/* Adds to `of` those of a group that hang together with its first by edges of two triangles, none
 * of which is folded over. */
static uint32_t spread(const csg_tree *tree, uint32_t (*beside)[3], uint32_t first, uint32_t among,
                       uint32_t of)
{
    uint32_t fresh = of;
    while (fresh) {
        uint32_t i = (uint32_t)__builtin_ctz(fresh);
        csg_vec3 normal = normal_of(&tree->triangles[first + i]);
        fresh &= fresh - 1;
        for (int k = 0; k < 3; k++) {
            uint32_t next = beside[first + i][k] - first; /* large where it is before, or none */
            if (next >= CSG_TREE_GROUP || !((among & ~of) >> next & 1) ||
                !(csg_vec3_dot(normal, normal_of(&tree->triangles[first + next])) > 0))
                continue;
            of |= 1u << next;
            fresh |= 1u << next;
        }
    }
    return of;
}

uint32_t csg_tree_plain_group(const csg_tree *tree, uint32_t (*beside)[3], uint32_t first)
{
    uint32_t left = (uint32_t)tree->count - first, apart = 0, plain = 0;
    uint32_t count = left < CSG_TREE_GROUP ? left : CSG_TREE_GROUP;
    surroundings around;
    look_around(tree, first, count, &around);
    for (uint32_t i = 0; i < count; i++)
        if (!tree->triangles[first + i].is_needle &&
            !crosses_some(tree, first + i, beside[first + i], &around))
            apart |= 1u << i;
    while (apart) {
        uint32_t one = apart & -apart;
        uint32_t alike = spread(tree, beside, first, apart, one);
        plain |= csg_tree_is_clear(tree, first + (uint32_t)__builtin_ctz(one)) ? alike : 0;
        apart &= ~alike;
    }
    return plain;
}
