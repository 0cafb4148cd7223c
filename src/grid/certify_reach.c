/* SPDX-License-Identifier: MIT
 * Ways from points to the lattice; see certify_reach.h.
 */
#include "grid/certify_reach.h"

#include <math.h>
#include <string.h>

void csg_reach_values(const csg_reach *reach, const double (*points)[3], size_t count,
                      double *values)
{
    float p[3][CSG_REACH_POINTS] = {{0}}, f[CSG_REACH_POINTS];
    size_t padded = (count + CSG_LANES - 1) / CSG_LANES * CSG_LANES;
    for (int axis = 0; axis < 3; axis++)
        for (size_t i = 0; i < padded; i++)
            p[axis][i] = (float)points[i < count ? i : 0][axis];
    reach->kernel->values(reach->tape, p[0], p[1], p[2], count, f, reach->scratch,
                          reach->scratch_floats);
    for (size_t i = 0; i < count; i++)
        values[i] = (double)f[i];
}

static void lattice_point(const csg_lattice *lattice, const int64_t index[3], double p[3])
{
    const double origin[3] = {lattice->origin.x, lattice->origin.y, lattice->origin.z};
    for (int axis = 0; axis < 3; axis++)
        p[axis] = origin[axis] + (double)index[axis] * lattice->cell_size;
}

static double distance(const double a[3], const double b[3])
{
    double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return sqrt(x * x + y * y + z * z);
}

/* The lattice point nearest to p. False: it is one of the outermost, which are outside by decree.
 */
static bool nearest_point(const csg_lattice *lattice, const double p[3], int64_t index[3])
{
    const double origin[3] = {lattice->origin.x, lattice->origin.y, lattice->origin.z};
    bool inner = true;
    for (int axis = 0; axis < 3; axis++) {
        double at = floor((p[axis] - origin[axis]) / lattice->cell_size + 0.5);
        inner = inner && at >= 1 && at <= (double)lattice->cells[axis] - 1;
        index[axis] = (int64_t)fmin(fmax(at, -4), 4e6);
    }
    return inner;
}

/* Whether the ball of radius value / lipschitz around p holds a lattice point of that sign. */
static bool holds_sample(const csg_reach *reach, const double p[3], double value, int sign)
{
    int64_t index[3];
    double at[3];
    if (!nearest_point(reach->lattice, p, index))
        return sign < 0; /* outside of the lattice all is outside */
    lattice_point(reach->lattice, index, at);
    /* a little less than the ball: the value and the coordinates are rounded */
    return distance(p, at) <= fmin(value, reach->band) / reach->lipschitz * (1 - 0x1p-10);
}

/* ---- climbing ------------------------------------------------------------------------------- */

/* The 26 neighbours of p at distance `step`. */
static void around(const double p[3], double step, double (*points)[3])
{
    int count = 0;
    for (int k = -1; k <= 1; k++)
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++) {
                int square = i * i + j * j + k * k;
                if (!square)
                    continue;
                double s = step / sqrt((double)square);
                points[count][0] = p[0] + i * s;
                points[count][1] = p[1] + j * s;
                points[count++][2] = p[2] + k * s;
            }
}

static bool is_within(const csg_reach *reach, const double p[3])
{
    for (int axis = 0; axis < 3; axis++)
        if (!(p[axis] >= reach->low[axis] && p[axis] <= reach->high[axis]))
            return false;
    return true;
}

/* Moves to the best of the points around, where it is better by a part of the step. */
static bool climb(const csg_reach *reach, double p[3], double *value, int sign, double step)
{
    enum { WAYS = 26 };
    const double least = 0.05; /* of what the Lipschitz constant allows */
    double points[WAYS][3], values[WAYS];
    int best = -1;
    double most = *value + least * step * reach->lipschitz;
    around(p, step, points);
    csg_reach_values(reach, (const double(*)[3])points, WAYS, values);
    for (int i = 0; i < WAYS; i++)
        if (sign * values[i] > most) {
            most = sign * values[i];
            best = i;
        }
    if (best < 0 || !is_within(reach, points[best]))
        return false;
    memcpy(p, points[best], 3 * sizeof *p);
    *value = most;
    return true;
}

/* ---- straight ways -------------------------------------------------------------------------- */

/* From p to a lattice point: -1 a change of sign, 0 none seen, 1 balls of this sign cover it. */
static int way_to(const csg_reach *reach, const double p[3], const double to[3], int sign)
{
    enum { STEPS = 32 };
    double points[STEPS + 1][3], values[STEPS + 1], step = distance(p, to) / STEPS;
    for (int i = 0; i <= STEPS; i++)
        for (int axis = 0; axis < 3; axis++)
            points[i][axis] = p[axis] + (to[axis] - p[axis]) * i / STEPS;
    csg_reach_values(reach, (const double(*)[3])points, STEPS + 1, values);
    bool covered = true;
    for (int i = 0; i <= STEPS; i++) {
        if (sign * values[i] < 0)
            return -1;
        covered = covered && (i == 0 || fmin(sign * values[i], reach->band) +
                                                fmin(sign * values[i - 1], reach->band) >=
                                            step * reach->lipschitz * (1 + 0x1p-10));
    }
    return covered;
}

/* Straight ways to the 4^3 lattice points around p. */
static csg_reach_state look_around(const csg_reach *reach, const double p[3], int sign)
{
    enum { POINTS = 64 };
    double points[POINTS][3], values[POINTS];
    int64_t index[POINTS][3], base[3];
    const double origin[3] = {reach->lattice->origin.x, reach->lattice->origin.y,
                              reach->lattice->origin.z};
    for (int axis = 0; axis < 3; axis++)
        base[axis] = (int64_t)floor((p[axis] - origin[axis]) / reach->lattice->cell_size) - 1;
    for (int i = 0; i < POINTS; i++) {
        const int64_t at[3] = {base[0] + i % 4, base[1] + i / 4 % 4, base[2] + i / 16};
        memcpy(index[i], at, sizeof at);
        lattice_point(reach->lattice, at, points[i]);
    }
    csg_reach_values(reach, (const double(*)[3])points, POINTS, values);
    csg_reach_state state = CSG_REACH_NONE;
    for (int i = 0; i < POINTS; i++) {
        int64_t same[3];
        bool inner = nearest_point(reach->lattice, points[i], same);
        bool is_same = inner ? (sign > 0) == (values[i] >= 0) : sign < 0;
        if (!is_same)
            continue;
        int way = way_to(reach, p, points[i], sign);
        if (way > 0)
            return CSG_REACH_SAMPLE;
        if (way == 0)
            state = CSG_REACH_UNPROVEN;
    }
    return state;
}

csg_reach_state csg_reach_from(const csg_reach *reach, const double from[3], double value, int sign,
                               csg_reach_end *end)
{
    enum { MOST_CLIMBS = 48, SHORTEST = 256 };
    double p[3], h = reach->lattice->cell_size, step = h / 2;
    memcpy(p, from, sizeof p);
    bool found = holds_sample(reach, p, value, sign);
    for (int i = 0; i < MOST_CLIMBS && !found && step * SHORTEST >= h; i++) {
        if (!climb(reach, p, &value, sign, step))
            step /= 2;
        else
            found = holds_sample(reach, p, value, sign);
    }
    memcpy(end->at, p, sizeof p);
    end->thickness = 2 * value / reach->lipschitz;
    return found ? CSG_REACH_SAMPLE : look_around(reach, p, sign);
}
