/* SPDX-License-Identifier: MIT
 * A polyhedron's faces near a place: which are plain, which normals the gradient can have there,
 * and where it jumps from one to the next.
 */
#include <string.h>

#include "base/four.h"
#include "shape/polyhedra/solid.h"

/* Threads may find it twice; they find the same. */
bool csg_polyhedron_find_plain(const csg_polyhedron *solid, uint32_t place)
{
    uint32_t first = place - place % CSG_TREE_GROUP;
    uint32_t plain = csg_tree_plain_group(&solid->tree, solid->beside, first);
    for (uint32_t i = 0; i < CSG_TREE_GROUP && first + i < solid->tree.count; i++)
        atomic_store_explicit(&solid->plain[first + i],
                              plain >> i & 1 ? CSG_PLAIN_YES : CSG_PLAIN_NO, memory_order_relaxed);
    return plain >> (place - first) & 1;
}

/* ---- normals ----------------------------------------------------------------------------------
 */

typedef struct taking {
    const csg_polyhedron *solid;
    csg_shape_take_normal *take;
    void *user;
} taking;

static bool count_triangle(void *user, uint32_t place)
{
    size_t *left = user;
    return --*left > 0;
}

static bool take_triangle(void *user, uint32_t place)
{
    taking *t = user;
    return t->take(t->user, csg_polyhedron_inward(&t->solid->tree.triangles[place])) &&
           csg_polyhedron_is_plain_beyond(t->solid, place, INFINITY);
}

/* Within the ball distances are at most that of c and its radius. Counting is quicker than taking,
 * and mostly there are few triangles or far too many. */
bool csg_polyhedron_normals(const csg_shape *shape, csg_vec3 c, double radius,
                            csg_shape_take_normal *take, void *user)
{
    enum { MOST = 256 };
    size_t left = MOST + 1;
    const csg_polyhedron *solid = csg_polyhedron_of(shape);
    csg_vec3 at = csg_triangle_frame_enter(&solid->frame, c);
    if (csg_polyhedron_is_far(at))
        return false;
    double least = sqrt(csg_tree_nearest(&solid->tree, at, 0).squared);
    double reach = (least + 2 * radius * solid->frame.scale) * (1 + 0x1p-40) + CSG_POLYHEDRON_LEAST;
    taking t = {solid, take, user};
    return csg_tree_within(&solid->tree, at, reach, count_triangle, &left) &&
           csg_tree_within(&solid->tree, at, reach, take_triangle, &t);
}

/* ---- creases ----------------------------------------------------------------------------------
 */

/* Faces and edges are held against the balls that they come near to. */
typedef struct bending {
    const csg_polyhedron *solid;
    const csg_shape_crease *crease;
    double narrow; /* frame units */
    size_t count;
    uint64_t all;                          /* a bit each */
    csg_vec3 center[CSG_SHAPE_MOST_BALLS]; /* frame units; and once more, axis by axis */
    float at[3][CSG_SHAPE_MOST_BALLS], reach[CSG_SHAPE_MOST_BALLS]; /* a little more */
    double squared[CSG_SHAPE_MOST_BALLS];                           /* radii */
    csg_box normals[CSG_SHAPE_MOST_BALLS];                          /* of what is in each ball */
    bool *may_crease;
} bending;

static csg_vec3 corner_of(const csg_tree_triangle *t, int corner)
{
    return corner == 0 ? t->a : csg_vec3_add(t->a, corner == 1 ? t->ab : t->ac);
}

float csg_polyhedron_find_turn(const csg_polyhedron *solid, uint32_t place, int edge)
{
    uint32_t other = solid->beside[place][edge];
    if (other == CSG_TREE_NONE)
        return 2;
    return (float)(1 - csg_vec3_dot(csg_polyhedron_inward(&solid->tree.triangles[place]),
                                    csg_polyhedron_inward(&solid->tree.triangles[other])));
}

/* The edge of a triangle that another one is at. */
static int edge_towards(const csg_polyhedron *solid, uint32_t place, uint32_t other)
{
    const uint32_t *beside = solid->beside[place];
    return beside[0] == other ? 0 : beside[1] == other ? 1 : 2;
}

/* An edge by which the surface turns a little. */
typedef struct blunt_edge {
    csg_vec3 from, way; /* unit */
    double turn;
} blunt_edge;

/* The square of how far from the line of an edge a point is. */
static double squared_away(const blunt_edge *of, csg_vec3 p)
{
    csg_vec3 away = csg_vec3_cross(csg_vec3_sub(p, of->from), of->way);
    return csg_vec3_dot(away, away);
}

/* Whether another edge leads away from one, and does not go on in its direction. */
static bool leads_away(const bending *b, const blunt_edge *of, const csg_tree_triangle *t, int edge)
{
    static const double SHARE = 0.3;
    csg_vec3 from = corner_of(t, edge), to = corner_of(t, (edge + 1) % 3);
    csg_vec3 way = csg_vec3_sub(to, from);
    double least = SHARE * SHARE * fmin(csg_vec3_dot(way, way), b->narrow * b->narrow);
    return squared_away(of, from) > least || squared_away(of, to) > least;
}

/* Whether the surface turns again, bluntly and by half as much at least (of small angles 1 - cos
 * goes with the square), before it is `narrow` away from an edge: at an edge of this triangle, to
 * which the way has led over `edge`, or of those that so many steps lead to. */
static bool turns_again(const bending *b, const blunt_edge *of, uint32_t place, int edge, int steps)
{
    const csg_tree_triangle *t = &b->solid->tree.triangles[place];
    if (!(squared_away(of, corner_of(t, (edge + 2) % 3)) < b->narrow * b->narrow))
        return false;
    for (int k = 1; k < 3; k++) {
        int next = (edge + k) % 3;
        uint32_t other = b->solid->beside[place][next];
        double turn = (double)b->solid->turn[place][next];
        bool again = turn > 0.25 * of->turn;
        if (again ? turn < b->crease->blunt && leads_away(b, of, t, next)
                  : steps &&
                        turns_again(b, of, other, edge_towards(b->solid, other, place), steps - 1))
            return true;
    }
    return false;
}

/* Blunt edges that are left out are short: a long one is a straight crease through many cells,
 * however near the next one runs. */
static bool is_crease(const bending *b, uint32_t place, int edge)
{
    enum { STEPS = 4 };
    static const double LONG = 1.5; /* narrows */
    const csg_tree_triangle *t = &b->solid->tree.triangles[place];
    uint32_t other = b->solid->beside[place][edge];
    blunt_edge of = {.turn = (double)b->solid->turn[place][edge]};
    if (!(of.turn > b->crease->least) || !(of.turn < b->crease->blunt))
        return of.turn > b->crease->least;
    of.from = corner_of(t, edge);
    of.way = csg_vec3_sub(corner_of(t, (edge + 1) % 3), of.from);
    double length = csg_vec3_norm(of.way);
    of.way = csg_vec3_scale(of.way, 1 / length);
    return length > LONG * b->narrow || !turns_again(b, &of, place, edge, STEPS) ||
           !turns_again(b, &of, other, edge_towards(b->solid, other, place), STEPS);
}

/* Which balls the box of a triangle comes near to, a bit each. In float: a few more than do. */
static uint64_t balls_at(const bending *b, const csg_tree_triangle *t)
{
    const double corner[3] = {t->a.x, t->a.y, t->a.z}, ab[3] = {t->ab.x, t->ab.y, t->ab.z},
                 ac[3] = {t->ac.x, t->ac.y, t->ac.z};
    csg_four low[3], high[3];
    uint64_t near = 0;
    for (int k = 0; k < 3; k++) {
        double least = ab[k] < ac[k] ? ab[k] : ac[k], most = ab[k] < ac[k] ? ac[k] : ab[k];
        low[k] = csg_four_all((float)(corner[k] + (least < 0 ? least : 0)));
        high[k] = csg_four_all((float)(corner[k] + (most > 0 ? most : 0)));
    }
    for (size_t i = 0; i < b->count; i += 4) {
        csg_four_mask in = ~(csg_four_mask){0};
        csg_four reach = csg_four_load(b->reach + i);
        for (int k = 0; k < 3; k++) {
            csg_four at = csg_four_load(b->at[k] + i);
            in &= (at + reach >= low[k]) & (at - reach <= high[k]);
        }
        near |= (uint64_t)csg_four_bits(in) << i;
    }
    return near & b->all;
}

static double squared_to_segment(csg_vec3 p, csg_vec3 from, csg_vec3 to)
{
    csg_vec3 way = csg_vec3_sub(to, from), v = csg_vec3_sub(p, from);
    double t = csg_vec3_dot(v, way) / csg_vec3_dot(way, way);
    v = csg_vec3_sub(v, csg_vec3_scale(way, t > 0 ? t < 1 ? t : 1 : 0));
    return csg_vec3_dot(v, v);
}

static void add_edge(bending *b, uint32_t place, int edge, uint64_t near)
{
    const csg_tree_triangle *t = &b->solid->tree.triangles[place];
    csg_vec3 from = corner_of(t, edge), to = corner_of(t, (edge + 1) % 3);
    for (; near; near &= near - 1) {
        int i = __builtin_ctzll(near);
        b->may_crease[i] |= squared_to_segment(b->center[i], from, to) <= b->squared[i];
    }
}

/* Normals that differ by an angle are 2 sin of its half apart. */
static bool is_bent(const csg_box *normals, double most_turn)
{
    csg_vec3 apart = csg_vec3_sub(normals->max, normals->min);
    return csg_vec3_dot(apart, apart) > 2 * most_turn;
}

/* A face in a ball changes nothing there if its normal is among those of others. */
static void add_face(bending *b, uint32_t place, uint64_t near)
{
    const csg_tree_triangle *t = &b->solid->tree.triangles[place];
    bool is_plain = csg_polyhedron_is_plain_beyond(b->solid, place, INFINITY);
    csg_vec3 inward = csg_polyhedron_inward(t);
    for (; near; near &= near - 1) {
        int i = __builtin_ctzll(near);
        csg_box *normals = &b->normals[i];
        if (b->may_crease[i] || (is_plain && csg_box_holds(*normals, inward)) ||
            !(csg_triangle_squared(t, b->center[i]) <= b->squared[i]))
            continue;
        csg_box_extend(normals, inward);
        b->may_crease[i] = !is_plain || is_bent(normals, b->crease->most_turn);
    }
}

static bool add_triangle(void *user, uint32_t place)
{
    bending *b = user;
    const csg_tree_triangle *t = &b->solid->tree.triangles[place];
    uint64_t near = balls_at(b, t);
    for (int k = 0; k < 3 && near; k++)
        if (b->solid->beside[place][k] > place && is_crease(b, place, k))
            add_edge(b, place, k, near);
    if (near)
        add_face(b, place, near);
    return true;
}

/* Fills in the balls, in frame units; returns the box around all of them. */
static csg_box enter_balls(bending *b, csg_shape_balls *balls)
{
    const csg_triangle_frame *frame = &b->solid->frame;
    csg_box box = csg_box_empty();
    b->count = balls->count;
    b->all = 0;
    b->may_crease = balls->may_crease;
    memset(b->at, 0, sizeof b->at);
    memset(b->reach, 0, sizeof b->reach);
    for (size_t i = 0; i < b->count; i++) {
        csg_vec3 at = b->center[i] = csg_triangle_frame_enter(frame, balls->center[i]);
        double radius = balls->radius[i] * frame->scale + CSG_POLYHEDRON_LEAST;
        b->at[0][i] = (float)at.x, b->at[1][i] = (float)at.y, b->at[2][i] = (float)at.z;
        b->reach[i] = (float)radius + 8 * CSG_TREE_PAD;
        b->squared[i] = radius * radius;
        b->all |= (uint64_t)1 << i;
        b->normals[i] = csg_box_empty();
        b->may_crease[i] = csg_polyhedron_is_far(at);
        box = csg_box_hull(box, csg_box_grow((csg_box){at, at}, radius));
    }
    return box;
}

/* ---- all balls at once ------------------------------------------------------------------------
 *
 * Mostly only few edges are creases, and the faces whose boxes come near to a ball turn so little
 * that those in it cannot be bent: then no face is held against it.
 */

enum { MOST_FACES = 512, MOST_SHARP = 128 };

typedef struct bend_survey {
    bending *bending;
    float low[3], high[3]; /* of all balls, a little more */
    csg_box normals;
    uint32_t count, sharp_count;
    uint32_t faces[MOST_FACES], sharp[MOST_SHARP]; /* places */
    csg_vec3 inward[MOST_FACES];
    uint8_t edges[MOST_SHARP]; /* creases of the sharp ones */
} bend_survey;

/* Whether a triangle's box is apart from that of all balls. */
static bool is_off(const bend_survey *s, const csg_tree_triangle *t)
{
    const double a[3] = {t->a.x, t->a.y, t->a.z}, ab[3] = {t->ab.x, t->ab.y, t->ab.z},
                 ac[3] = {t->ac.x, t->ac.y, t->ac.z};
    for (int k = 0; k < 3; k++)
        if (csg_tree_is_outside(a[k], a[k] + ab[k], a[k] + ac[k], (double)s->low[k],
                                (double)s->high[k]))
            return true;
    return false;
}

/* False: there are too many, or some that are not plain. */
static bool survey_triangle(void *user, uint32_t place)
{
    bend_survey *s = user;
    const csg_polyhedron *solid = s->bending->solid;
    const csg_tree_triangle *t = &solid->tree.triangles[place];
    if (is_off(s, t))
        return true;
    for (uint8_t k = 0; k < 3; k++) {
        if (solid->beside[place][k] <= place || !is_crease(s->bending, place, k))
            continue;
        if (s->sharp_count == MOST_SHARP)
            return false;
        s->sharp[s->sharp_count] = place;
        s->edges[s->sharp_count++] = k;
    }
    if (s->count == MOST_FACES || !csg_polyhedron_is_plain_beyond(solid, place, INFINITY))
        return false;
    csg_vec3 inward = csg_polyhedron_inward(t);
    csg_box_extend(&s->normals, inward);
    s->faces[s->count] = place;
    s->inward[s->count++] = inward;
    return true;
}

/* Adds faces where those whose boxes come near to a ball are bent. */
static void add_bent_faces(bend_survey *s)
{
    bending *b = s->bending;
    const csg_tree_triangle *triangles = b->solid->tree.triangles;
    csg_box normals[CSG_SHAPE_MOST_BALLS];
    uint64_t near[MOST_FACES], doubtful = 0;
    for (size_t i = 0; i < b->count; i++)
        normals[i] = csg_box_empty();
    for (uint32_t i = 0; i < s->count; i++) {
        near[i] = balls_at(b, &triangles[s->faces[i]]);
        for (uint64_t rest = near[i]; rest; rest &= rest - 1)
            csg_box_extend(&normals[__builtin_ctzll(rest)], s->inward[i]);
    }
    for (size_t i = 0; i < b->count; i++)
        doubtful |= (uint64_t)is_bent(&normals[i], b->crease->most_turn) << i;
    for (uint32_t i = 0; i < s->count && doubtful; i++)
        if (near[i] & doubtful)
            add_face(b, s->faces[i], near[i] & doubtful);
}

/* Fills in the balls; false: the survey is not worth it, each ball has to be held against each
 * triangle. */
static bool survey_balls(bending *b, csg_box box)
{
    bend_survey s;
    const double low[3] = {box.min.x, box.min.y, box.min.z},
                 high[3] = {box.max.x, box.max.y, box.max.z};
    s.bending = b;
    s.count = s.sharp_count = 0;
    s.normals = csg_box_empty();
    for (int k = 0; k < 3; k++) {
        s.low[k] = (float)low[k] - 16 * CSG_TREE_PAD;
        s.high[k] = (float)high[k] + 16 * CSG_TREE_PAD;
    }
    if (!csg_tree_in_box(&b->solid->tree, box, survey_triangle, &s))
        return false;
    for (uint32_t i = 0; i < s.sharp_count; i++)
        add_edge(b, s.sharp[i], s.edges[i], balls_at(b, &b->solid->tree.triangles[s.sharp[i]]));
    if (is_bent(&s.normals, b->crease->most_turn))
        add_bent_faces(&s);
    return true;
}

/* ---- the whole -------------------------------------------------------------------------------- */

static bool are_fewer(const csg_tree *tree, csg_box box, size_t fewest)
{
    return fewest && csg_tree_in_box(tree, box, count_triangle, &fewest);
}

void csg_polyhedron_creases(const csg_shape *shape, const csg_shape_crease *crease,
                            csg_shape_balls *balls)
{
    bending b;
    b.solid = csg_polyhedron_of(shape);
    b.crease = crease;
    b.narrow = crease->narrow * b.solid->frame.scale;
    csg_box box = enter_balls(&b, balls);
    if (are_fewer(&b.solid->tree, box, balls->fewest))
        memset(balls->may_crease, true, sizeof balls->may_crease);
    else if (!survey_balls(&b, box))
        csg_tree_in_box(&b.solid->tree, box, add_triangle, &b);
}
