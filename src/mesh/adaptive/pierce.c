/* SPDX-License-Identifier: MIT
 * Tangents at both ends; see pierce.h.
 */
#include "mesh/adaptive/pierce.h"

#include <math.h>
#include <string.h>

enum { N = CSG_BRICK_SAMPLES, E = CSG_BRICK_EDGE, P = CSG_BRICK_POINTS };
static const unsigned STRIDE[3] = {1, N, N *N};

typedef struct points {
    float x[CSG_BRICK_POINTS_PADDED], y[CSG_BRICK_POINTS_PADDED], z[CSG_BRICK_POINTS_PADDED];
    float f[CSG_BRICK_POINTS_PADDED], g[3][CSG_BRICK_POINTS_PADDED];
} points;

/* An edge with its tangents, and where they meet. */
typedef struct candidate {
    int axis;
    unsigned edge;
    bool inside; /* at both ends */
    float at[3];
} candidate;

static void place_points(points *p, const csg_bricks *b, const csg_brick *brick)
{
    for (int i = 0; i < CSG_BRICK_POINTS_PADDED; i++) {
        uint32_t n = i < P ? (uint32_t)i : 0;
        p->x[i] = csg_brick_coordinate(b, brick, 0, n % N);
        p->y[i] = csg_brick_coordinate(b, brick, 1, n / N % N);
        p->z[i] = csg_brick_coordinate(b, brick, 2, n / (N * N));
    }
}

/* Whether a point is on the lattice's border, outside by decree. */
static bool is_at_border(const csg_bricks *b, const csg_brick *brick, unsigned i)
{
    const unsigned at[3] = {i % N, i / N % N, i / (N * N)};
    for (int axis = 0; axis < 3; axis++) {
        uint32_t index = csg_brick_point(b, brick, axis, at[axis]);
        if (index == 0 || index >= b->lattice->cells[axis])
            return true;
    }
    return false;
}

static csg_vec3 gradient_at(const points *p, unsigned i)
{
    return csg_vec3_make((double)p->g[0][i], (double)p->g[1][i], (double)p->g[2][i]);
}

/* The part of the edge, from `a` to `z`, where the tangents meet; NAN: they do not, or belong to
 * one sheet. */
static double meet_between(const points *p, int axis, unsigned a, unsigned z, double length)
{
    const double LEAST = (double)CSG_LEAST_SPAN;
    double fa = (double)p->f[a], fz = (double)p->f[z];
    double sa = (double)p->g[axis][a] * length, sz = (double)p->g[axis][z] * length;
    if (fa < 0 ? !(sa > 0 && sz < 0) : !(sa < 0 && sz > 0))
        return NAN;
    if (csg_gradients_cosine(gradient_at(p, a), gradient_at(p, z)) > CSG_LEAST_CREASE_COSINE)
        return NAN;
    double t = (fz - sz - fa) / (sa - sz), met = fa + sa * t;
    bool is_beyond = fa < 0 ? met > 0 : met < 0;
    return is_beyond && t >= LEAST && t <= 1 - LEAST ? t : NAN;
}

/* Edges of equal signs whose ends are near enough to the surface. */
static uint64_t find_near(const csg_bricks *b, const csg_brick *brick, const float *f)
{
    double length = csg_bricks_cell(b, brick->level) * b->lattice->cell_size;
    float reach = (float)(length * (double)b->field->tape.lipschitz);
    uint64_t near = 0;
    for (unsigned i = 0; i < P; i++)
        for (int axis = 0; axis < 3; axis++) {
            const unsigned low[3] = {i % N, i / N % N, i / (N * N)};
            if (low[axis] < E && fabsf(f[i]) + fabsf(f[i + STRIDE[axis]]) < reach &&
                !csg_brick_is_crossed(brick, axis, low) && !is_at_border(b, brick, i) &&
                !is_at_border(b, brick, i + STRIDE[axis]))
                near |= (uint64_t)1 << csg_brick_edge(axis, low);
        }
    return near;
}

/* Those of the edges whose tangents meet. */
static int find_candidates(const points *p, uint64_t edges, candidate *out)
{
    int count = 0;
    for (unsigned i = 0; i < P; i++)
        for (int axis = 0; axis < 3; axis++) {
            const unsigned low[3] = {i % N, i / N % N, i / (N * N)};
            if (low[axis] == E || !(edges >> csg_brick_edge(axis, low) & 1))
                continue;
            const float *line = axis == 0 ? p->x : axis == 1 ? p->y : p->z;
            double from = (double)line[i], length = (double)line[i + STRIDE[axis]] - from;
            double t = meet_between(p, axis, i, i + STRIDE[axis], length);
            if (isnan(t))
                continue;
            candidate *c = &out[count++];
            *c = (candidate){
                axis, csg_brick_edge(axis, low), p->f[i] >= 0, {p->x[i], p->y[i], p->z[i]}};
            c->at[axis] = (float)(from + t * length);
        }
    return count;
}

/* Keeps those where the field has the other sign: the tangents may be wrong, the field is not. Nor
 * is there anything where it is 0 but for rounding: that is where two coincident faces cancel. */
static void keep_pierced(csg_sheet_probe *probe, points *p, const candidate *c, int count,
                         csg_pierced *out)
{
    enum { MOST = CSG_BRICK_POINTS_PADDED };
    const float nothing = 4 * (float)probe->noise;
    for (int first = 0; first < count; first += MOST) {
        int n = count - first < MOST ? count - first : MOST;
        for (int i = 0; i < MOST; i++) {
            const float *at = c[first + (i < n ? i : 0)].at;
            p->x[i] = at[0], p->y[i] = at[1], p->z[i] = at[2];
        }
        probe->kernel->values(probe->tape, p->x, p->y, p->z, (size_t)n, p->f, probe->scratch,
                              probe->scratch_floats);
        probe->evaluations += (uint64_t)n;
        for (int i = 0; i < n; i++) {
            const candidate *one = &c[first + i];
            if (fabsf(p->f[i]) <= nothing || (p->f[i] >= 0) == one->inside)
                continue;
            out->edges |= (uint64_t)1 << one->edge;
            out->at[one->edge] = one->at[one->axis];
        }
    }
}

void csg_pierce(csg_sheet_probe *probe, const csg_bricks *b, const csg_brick *brick, const float *f,
                csg_pierced *out)
{
    points p;
    candidate found[CSG_BRICK_EDGES];
    uint64_t edges = brick->level == b->finest ? 0 : find_near(b, brick, f);
    out->edges = 0;
    if (!edges)
        return;
    place_points(&p, b, brick);
    memcpy(p.f, f, sizeof p.f);
    probe->kernel->gradients(probe->tape, p.x, p.y, p.z, P, p.g[0], p.g[1], p.g[2], probe->scratch,
                             probe->scratch_floats);
    keep_pierced(probe, &p, found, find_candidates(&p, edges, found), out);
}
