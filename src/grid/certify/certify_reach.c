/* SPDX-License-Identifier: MIT
 * Ways from points to the lattice; see certify_reach.h.
 */
#include "grid/certify/certify_reach.h"

#include "field/cones/cone.h"

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

/* count <= CSG_REACH_POINTS */
static void find_gradients(const csg_reach *reach, const double (*points)[3], size_t count,
                           double (*gradients)[3])
{
    float p[3][CSG_REACH_POINTS] = {{0}}, g[3][CSG_REACH_POINTS];
    for (int axis = 0; axis < 3; axis++)
        for (size_t i = 0; i < count; i++)
            p[axis][i] = (float)points[i][axis];
    reach->kernel->gradients(reach->tape, p[0], p[1], p[2], count, g[0], g[1], g[2], reach->scratch,
                             reach->scratch_floats);
    for (size_t i = 0; i < count; i++)
        for (int axis = 0; axis < 3; axis++)
            gradients[i][axis] = (double)g[axis][i];
}

void csg_reach_gradient(const csg_reach *reach, const double p[3], double gradient[3])
{
    double points[1][3], gradients[1][3];
    memcpy(points[0], p, sizeof points[0]);
    find_gradients(reach, (const double(*)[3])points, 1, gradients);
    memcpy(gradient, gradients[0], sizeof gradients[0]);
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

/* The points around p, and two more up the slope that they show: in a wedge that points between the
 * ways of the lattice only these lead on. */
enum { WAYS = 26, CANDIDATES = WAYS + 2 };

static void look_up(const csg_reach *reach, const double p[3], double value, int sign, double step,
                    double (*points)[3], double *values)
{
    double slope[3] = {0, 0, 0};
    around(p, step, points);
    csg_reach_values(reach, (const double(*)[3])points, WAYS, values);
    for (int i = 0; i < WAYS; i++)
        for (int axis = 0; axis < 3; axis++)
            slope[axis] += (sign * values[i] - value) * (points[i][axis] - p[axis]);
    double norm = sqrt(slope[0] * slope[0] + slope[1] * slope[1] + slope[2] * slope[2]);
    for (int k = 0; k < 2; k++)
        for (int axis = 0; axis < 3; axis++)
            points[WAYS + k][axis] = p[axis] + (norm > 0 ? (k + 1) * step * slope[axis] / norm : 0);
    csg_reach_values(reach, (const double(*)[3])points + WAYS, 2, values + WAYS);
}

/* Balls of one sign around points with these values, `apart` from each other, touch. Where no point
 * of that sign was found yet, any step may lead to one. */
static bool are_connected(const csg_reach *reach, double apart, double one, double other)
{
    return one < 0 || apart * reach->lipschitz * (1 + 0x1p-10) <=
                          fmin(one, reach->band) + fmin(other, reach->band);
}

/* Whether p may go to `to`, better by a part of the step. */
static bool is_better(const csg_reach *reach, const double p[3], const double to[3], double step,
                      double value, double risen)
{
    const double least = 0.05; /* of what the Lipschitz constant allows */
    return risen > value + least * step * reach->lipschitz &&
           are_connected(reach, distance(p, to), value, risen) && is_within(reach, to);
}

/* Moves to the best of the points around, where it is better. */
static bool climb(const csg_reach *reach, double p[3], double *value, int sign, double step)
{
    double points[CANDIDATES][3], values[CANDIDATES];
    int best = -1;
    look_up(reach, p, *value, sign, step, points, values);
    for (int i = 0; i < CANDIDATES; i++)
        if ((best < 0 || sign * values[i] > sign * values[best]) &&
            is_better(reach, p, points[i], step, *value, sign * values[i]))
            best = i;
    if (best < 0)
        return false;
    memcpy(p, points[best], 3 * sizeof *p);
    *value = sign * values[best];
    return true;
}

/* Where several surfaces meet, the way up may lie between all directions that were tried: it is
 * the one that climbs along all the gradients around (gradient sampling: Burke, Lewis and Overton
 * 2005). */
static bool climb_ridge(const csg_reach *reach, double p[3], double *value, int sign, double step)
{
    double points[WAYS][3], gradients[WAYS][3], to[2][3], risen[2];
    csg_cone_balls balls = {.count = WAYS};
    csg_cone cone;
    around(p, step / 2, points);
    find_gradients(reach, (const double(*)[3])points, WAYS, gradients);
    for (int i = 0; i < WAYS; i++)
        for (int axis = 0; axis < 3; axis++)
            balls.items[i].at[axis] = sign * gradients[i][axis];
    if (!csg_cone_find_axis(&balls, &cone))
        return false;
    for (int k = 0; k < 2; k++)
        for (int axis = 0; axis < 3; axis++)
            to[k][axis] = p[axis] + step / (k + 1) * cone.axis[axis];
    csg_reach_values(reach, (const double(*)[3])to, 2, risen);
    for (int k = 0; k < 2; k++)
        if (is_better(reach, p, to[k], step / (k + 1), *value, sign * risen[k])) {
            memcpy(p, to[k], 3 * sizeof *p);
            *value = sign * risen[k];
            return true;
        }
    return false;
}

static void add_to_trail(const csg_reach *reach, csg_reach_trail *trail, const double p[3],
                         double value, int sign)
{
    uint32_t place = trail->count++ % CSG_REACH_TRAIL;
    memcpy(trail->at[place], p, sizeof trail->at[place]);
    trail->value[place] = fmin(value, reach->band);
    trail->sign[place] = (int8_t)sign;
}

static bool touches_trail(const csg_reach *reach, const double p[3], double value, int sign,
                          const csg_reach_trail *trail)
{
    uint32_t count = trail->count < CSG_REACH_TRAIL ? trail->count : CSG_REACH_TRAIL;
    for (uint32_t i = 0; i < count; i++)
        if (trail->sign[i] == sign &&
            are_connected(reach, distance(p, trail->at[i]), value, trail->value[i]))
            return true;
    return false;
}

/* The furthest of a few points up the gradient whose ball touches that of p. */
static bool slide_on(const csg_reach *reach, double p[3], double *value, int sign, double step)
{
    enum { REACHES = 4 }; /* of as many lanes as kernels work on anyway */
    double g[3], next[REACHES][3], risen[REACHES], far[REACHES], h = reach->lattice->cell_size;
    csg_reach_gradient(reach, p, g);
    double norm = sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    if (!(norm > 1e-3))
        return false;
    for (int i = 0; i < REACHES; i++) {
        far[i] = fmin(0.7 * h, (double)(1 << i) * step);
        for (int axis = 0; axis < 3; axis++)
            next[i][axis] = p[axis] + sign * far[i] * g[axis] / norm;
    }
    csg_reach_values(reach, (const double(*)[3])next, REACHES, risen);
    for (int i = REACHES - 1; i >= 0; i--) {
        double up = sign * risen[i];
        if (up > *value && are_connected(reach, far[i], *value, up) && is_within(reach, next[i])) {
            memcpy(p, next[i], sizeof next[i]);
            *value = up;
            return true;
        }
    }
    return false;
}

bool csg_reach_slide(const csg_reach *reach, const double from[3], double value, int sign,
                     csg_reach_trail *trail)
{
    enum { STEPS = 12 };
    double way[STEPS][3], values[STEPS], p[3], h = reach->lattice->cell_size;
    memcpy(p, from, sizeof p);
    for (int i = 0; i < STEPS && value >= 0; i++) {
        memcpy(way[i], p, sizeof p);
        values[i] = value;
        if (touches_trail(reach, p, value, sign, trail) || holds_sample(reach, p, value, sign)) {
            for (int k = 0; k <= i; k++)
                add_to_trail(reach, trail, way[k], values[k], sign);
            return true;
        }
        if (!slide_on(reach, p, &value, sign, fmax(value / reach->lipschitz, h / 256)))
            return false;
    }
    return false;
}

/* ---- where no ball holds a lattice point ----------------------------------------------------- */

/* Whether no point of the straight way shows the other sign. */
static bool is_clear(const csg_reach *reach, const double p[3], const double to[3], int sign)
{
    enum { STEPS = 32 };
    double points[STEPS + 1][3], values[STEPS + 1];
    for (int i = 0; i <= STEPS; i++)
        for (int axis = 0; axis < 3; axis++)
            points[i][axis] = p[axis] + (to[axis] - p[axis]) * i / STEPS;
    csg_reach_values(reach, (const double(*)[3])points, STEPS + 1, values);
    for (int i = 0; i <= STEPS; i++)
        if (sign > 0 ? values[i] < 0 : values[i] >= 0)
            return false;
    return true;
}

/* A straight way to a lattice point no further than the middle of a cell is from its corners: in a
 * wall of a cell's thickness every point of its middle has one. */
static bool has_way(const csg_reach *reach, const double p[3], int sign)
{
    enum { POINTS = 64 };
    int64_t base[3];
    double h = reach->lattice->cell_size;
    const double origin[3] = {reach->lattice->origin.x, reach->lattice->origin.y,
                              reach->lattice->origin.z};
    for (int axis = 0; axis < 3; axis++)
        base[axis] = (int64_t)floor((p[axis] - origin[axis]) / h) - 1;
    for (int i = 0; i < POINTS; i++) {
        const int64_t at[3] = {base[0] + i % 4, base[1] + i / 4 % 4, base[2] + i / 16};
        int64_t same[3];
        double to[3];
        lattice_point(reach->lattice, at, to);
        if (distance(p, to) <= 0.88 * h && nearest_point(reach->lattice, to, same) &&
            is_clear(reach, p, to, sign))
            return true;
    }
    return false;
}

/* Distance at which the other sign is seen in one of 26 directions, from the radius of the ball
 * that is free of it up to a cell's half diagonal; 0: it is not. */
static double distance_to_other(const csg_reach *reach, const double p[3], double free, int sign)
{
    double h = reach->lattice->cell_size, points[WAYS][3], values[WAYS];
    for (double t = fmax(free, h / 1024); t < 0.88 * h; t *= 1.2) {
        around(p, t, points);
        csg_reach_values(reach, (const double(*)[3])points, WAYS, values);
        for (int i = 0; i < WAYS; i++)
            if (sign > 0 ? values[i] < 0 : values[i] >= 0)
                return t;
    }
    return 0;
}

/* The points of a way from the first of its own sign on, each ball touching the one before. */
typedef struct climbed_way {
    double at[CSG_REACH_TRAIL][3], value[CSG_REACH_TRAIL];
    uint32_t count;
} climbed_way;

static void add_to_way(climbed_way *way, const double p[3], double value)
{
    if (value < 0 || way->count == CSG_REACH_TRAIL)
        return;
    memcpy(way->at[way->count], p, sizeof way->at[0]);
    way->value[way->count++] = value;
}

static bool is_there(const csg_reach *reach, const double p[3], double value, int sign,
                     const csg_reach_trail *trail)
{
    return holds_sample(reach, p, value, sign) ||
           (trail && value >= 0 && touches_trail(reach, p, value, sign, trail));
}

/* From p up to the part's thickest place. True: a place on the way is at the lattice, or touches
 * the trail. */
static bool climb_up(const csg_reach *reach, double p[3], double *value, int sign,
                     const csg_reach_trail *trail, climbed_way *way)
{
    enum { MOST_CLIMBS = 64, SHORTEST = 256 };
    double h = reach->lattice->cell_size, least = reach->noise / reach->lipschitz;
    double step = *value < 0 ? h / 2 : fmin(h / 2, fmax(2 * *value / reach->lipschitz, least));
    add_to_way(way, p, *value);
    bool found = is_there(reach, p, *value, sign, trail);
    for (int i = 0; i < MOST_CLIMBS && !found && step >= least; i++) {
        if (step < h / SHORTEST && (*value < 0 || step < *value / (4 * reach->lipschitz)))
            break;
        if (!climb(reach, p, value, sign, step) &&
            (16 * step > h || !climb_ridge(reach, p, value, sign, step))) {
            step /= 2;
        } else {
            add_to_way(way, p, *value);
            found = is_there(reach, p, *value, sign, trail);
            step = fmin(h / 2, 2 * step);
        }
    }
    return found;
}

csg_reach_state csg_reach_from(const csg_reach *reach, const double from[3], double value, int sign,
                               csg_reach_trail *trail, csg_reach_end *end)
{
    double p[3];
    climbed_way way = {.count = 0};
    memcpy(p, from, sizeof p);
    bool found = climb_up(reach, p, &value, sign, trail, &way);
    memcpy(end->at, p, sizeof p);
    end->thickness = 2 * value / reach->lipschitz;
    if (!found && fabs(value) <= reach->noise)
        return CSG_REACH_SAMPLE;
    if (found || (value >= 0 && has_way(reach, p, sign))) {
        for (uint32_t i = 0; trail && i < way.count; i++)
            add_to_trail(reach, trail, way.at[i], way.value[i], sign);
        return CSG_REACH_SAMPLE;
    }
    double other = distance_to_other(reach, p, value / reach->lipschitz, sign);
    end->thickness = fmax(end->thickness, value >= 0 ? 2 / 1.2 * other : 0);
    return other > 0 ? CSG_REACH_NONE : CSG_REACH_UNPROVEN;
}
