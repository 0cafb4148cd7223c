/* SPDX-License-Identifier: MIT
 * Which lattice points are beads of a tip; see bead.h.
 */
#include "grid/octree/bead.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { AXES = 6, DIAGONALS = 20, MOST_POINTS = 32 };

typedef struct point_batch {
    float x[MOST_POINTS], y[MOST_POINTS], z[MOST_POINTS], f[MOST_POINTS];
} point_batch;

static void set_point(point_batch *p, int i, csg_vec3 at)
{
    p->x[i] = (float)at.x, p->y[i] = (float)at.y, p->z[i] = (float)at.z;
}

static void ask(csg_beads *b, point_batch *p, size_t count)
{
    for (size_t i = count; i % CSG_LANES; i++)
        p->x[i] = p->x[0], p->y[i] = p->y[0], p->z[i] = p->z[0];
    b->kernel->values(b->tape, p->x, p->y, p->z, count, p->f, b->scratch, b->scratch_floats);
    b->evaluations += count;
    b->left -= (int)count;
}

/* ---- signs ----------------------------------------------------------------------------------- */

/* Steps to lattice points around: the first six along axes, then those on diagonals. */
typedef struct step_table {
    int step[AXES + DIAGONALS][3];
} step_table;

static step_table steps_around(void)
{
    step_table t;
    int axis = 0, diagonal = AXES;
    for (int i = 0; i < 27; i++) {
        const int s[3] = {i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1};
        int far = abs(s[0]) + abs(s[1]) + abs(s[2]);
        if (far)
            memcpy(t.step[far == 1 ? axis++ : diagonal++], s, sizeof s);
    }
    return t;
}

static void beside(const uint32_t at[3], const int step[3], uint32_t out[3])
{
    for (int axis = 0; axis < 3; axis++)
        out[axis] = at[axis] + (uint32_t)step[axis];
}

static csg_vec3 place_of(const csg_beads *b, const uint32_t at[3])
{
    return csg_vec3_make((double)csg_lattice_coordinate(b->lattice, 0, at[0]),
                         (double)csg_lattice_coordinate(b->lattice, 1, at[1]),
                         (double)csg_lattice_coordinate(b->lattice, 2, at[2]));
}

/* The lattice's border is outside by decree. */
static bool is_inner(const csg_beads *b, const uint32_t at[3])
{
    for (int axis = 0; axis < 3; axis++)
        if (at[axis] == 0 || at[axis] >= b->lattice->cells[axis])
            return false;
    return true;
}

/* Signs of `count` points around one, bit i: inside. */
static uint32_t signs_around(csg_beads *b, const uint32_t at[3], const int (*step)[3], int count)
{
    point_batch p;
    uint32_t inner = 0, inside = 0;
    for (int i = 0; i < count; i++) {
        uint32_t to[3];
        beside(at, step[i], to);
        set_point(&p, i, place_of(b, to));
        inner |= (uint32_t)is_inner(b, to) << i;
    }
    ask(b, &p, (size_t)count);
    for (int i = 0; i < count; i++)
        inside |= (uint32_t)(p.f[i] >= 0) << i;
    return inside & inner;
}

static bool is_alone(csg_beads *b, const step_table *t, const uint32_t at[3], bool sign)
{
    return signs_around(b, at, t->step, AXES) == (sign ? 0u : (1u << AXES) - 1);
}

/* ---- what reaches it ------------------------------------------------------------------------- */

/* Whether the field keeps its sign from one lattice point to another: by steps that are too short
 * for it to change. */
static bool keeps_sign(csg_beads *b, const uint32_t from[3], const uint32_t to[3], bool sign)
{
    csg_vec3 a = place_of(b, from), way = csg_vec3_sub(place_of(b, to), a);
    double length = csg_vec3_norm(way), t = 0, least = 1e-3 * b->lattice->cell_size;
    while (t < length && b->left > 0) {
        point_batch p;
        set_point(&p, 0, csg_vec3_add(a, csg_vec3_scale(way, t / length)));
        ask(b, &p, 1);
        double step = 0.9 * (double)(sign ? p.f[0] : -p.f[0]) / (double)b->tape->lipschitz;
        if (!(step > least))
            return false;
        t += step;
    }
    return t >= length;
}

/* Whether a point of the same sign that is not alone can be reached by at most `most` diagonals. */
static bool is_reached(csg_beads *b, const step_table *t, const uint32_t at[3], bool sign, int most)
{
    uint32_t inside = signs_around(b, at, t->step + AXES, DIAGONALS);
    for (int i = 0; i < DIAGONALS && b->left > 0; i++) {
        uint32_t to[3];
        beside(at, t->step[AXES + i], to);
        if ((inside >> i & 1) == sign && is_inner(b, to) && keeps_sign(b, at, to, sign) &&
            (!is_alone(b, t, to, sign) || (most > 1 && is_reached(b, t, to, sign, most - 1))))
            return true;
    }
    return false;
}

/* ---- what it looks like ---------------------------------------------------------------------- */

/* Roots along the six edges at a point, by halving. */
static void find_roots(csg_beads *b, const step_table *t, const uint32_t at[3], bool sign,
                       csg_vec3 root[AXES])
{
    enum { HALVINGS = 24 };
    csg_vec3 from[AXES], to[AXES];
    for (int i = 0; i < AXES; i++) {
        uint32_t next[3];
        beside(at, t->step[i], next);
        from[i] = place_of(b, at);
        to[i] = place_of(b, next);
    }
    for (int step = 0; step < HALVINGS; step++) {
        point_batch p;
        for (int i = 0; i < AXES; i++) {
            root[i] = csg_vec3_scale(csg_vec3_add(from[i], to[i]), 0.5);
            set_point(&p, i, root[i]);
        }
        ask(b, &p, AXES);
        for (int i = 0; i < AXES; i++)
            *((p.f[i] >= 0) == sign ? &from[i] : &to[i]) = root[i];
    }
}

static void find_normals(csg_beads *b, const csg_vec3 root[AXES], csg_vec3 normal[AXES])
{
    point_batch p;
    float g[3][CSG_LANES];
    for (int i = 0; i < CSG_LANES; i++)
        set_point(&p, i, root[i < AXES ? i : 0]);
    b->kernel->gradients(b->tape, p.x, p.y, p.z, AXES, g[0], g[1], g[2], b->scratch,
                         b->scratch_floats);
    b->evaluations += AXES;
    for (int i = 0; i < AXES; i++)
        normal[i] =
            csg_vec3_normalize(csg_vec3_make((double)g[0][i], (double)g[1][i], (double)g[2][i]));
}

/* Whether the tangent planes at the roots meet in one place, on the surface: the tip (the edge)
 * that the bead is of. Round a ball they do not. */
static bool is_of_tip(csg_beads *b, const uint32_t at[3], const csg_vec3 root[AXES])
{
    csg_vec3 n[AXES], sum = {0, 0, 0}, x = place_of(b, at);
    /* a little of the identity keeps x near where the planes leave it open: along an edge */
    csg_affine m = {.m = {{1e-6, 0, 0}, {0, 1e-6, 0}, {0, 0, 1e-6}}}, inverse;
    find_normals(b, root, n);
    for (int i = 0; i < AXES; i++) {
        const double c[3] = {n[i].x, n[i].y, n[i].z};
        for (int r = 0; r < 9; r++)
            m.m[r / 3][r % 3] += c[r / 3] * c[r % 3];
        double rest = csg_vec3_dot(n[i], csg_vec3_sub(root[i], x));
        sum = csg_vec3_add(sum, csg_vec3_scale(n[i], rest));
    }
    if (!csg_affine_invert(m, &inverse))
        return false;
    x = csg_vec3_add(x, csg_affine_vector(&inverse, sum));
    double near = 0.02 * b->lattice->cell_size, most = 0;
    for (int i = 0; i < AXES; i++)
        most = fmax(most, fabs(csg_vec3_dot(n[i], csg_vec3_sub(root[i], x))));
    point_batch p;
    set_point(&p, 0, x);
    ask(b, &p, 1);
    return most <= near && fabs((double)p.f[0]) <= near * (double)b->tape->lipschitz;
}

/* Whether the tape is quick to ask: not long, and without formulas. */
static bool is_quick(const csg_tape *tape)
{
    if (tape->count > CSG_BEAD_MOST_NODES)
        return false;
    for (uint32_t i = 0; i < tape->count; i++)
        if (tape->nodes[i].op == CSG_OP_FIELD || tape->nodes[i].op == CSG_OP_COMBINE)
            return false;
    return true;
}

bool csg_bead_is(csg_beads *b, const uint32_t at[3])
{
    enum { MOST_DIAGONALS = 3, MOST_EVALUATIONS = 4000 };
    static const int here[1][3] = {{0, 0, 0}};
    if (!is_quick(b->tape) || !is_inner(b, at))
        return false;
    step_table t = steps_around();
    b->left = MOST_EVALUATIONS;
    bool sign = signs_around(b, at, here, 1) != 0;
    csg_vec3 root[AXES];
    if (!is_alone(b, &t, at, sign) || !is_reached(b, &t, at, sign, MOST_DIAGONALS))
        return false;
    find_roots(b, &t, at, sign, root);
    return is_of_tip(b, at, root);
}
