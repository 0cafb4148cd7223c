/* SPDX-License-Identifier: MIT
 * Sections; see section.h. A convex polygon is cut along the lines on which one of the formula's
 * half planes begins to be certain, until the formula is decided or nothing is left to cut along.
 */
#include "measure/section.h"

#include <math.h>
#include <string.h>

enum {
    SIDES = 6, /* of the cube, as further conditions */
    MOST_CONDITIONS = CSG_HALVES_MOST + SIDES,
    MOST_CORNERS = 4 + 2 * MOST_CONDITIONS,
    MOST_PIECES = 600 /* of one polygon: more would not be worth it */
};

/* Of the area of a polygon of that size, for each piece: some hundred roundings of 2^-53, and
 * strips that are no wider than CLOSE times the polygon. */
static const double ROUNDING = 0x1p-36, CLOSE = 0x1p-40;

/* It holds where its value is `below` at least, and does not where it is less than -above. */
typedef struct condition {
    double value, slope[3], below, above;
} condition;

typedef struct polygon {
    double at[MOST_CORNERS][3];
    int count;
} polygon;

typedef struct carving {
    const csg_halves *halves;
    const csg_section_group *group;        /* NULL: the formula is asked, not its boundary */
    condition conditions[MOST_CONDITIONS]; /* of the halves' planes, then of the cube's sides */
    int count, pieces;
    csg_section sum;
} carving;

static double area_of(const polygon *p)
{
    double sum[3] = {0};
    for (int i = 1; i + 1 < p->count; i++) {
        double u[3], v[3];
        for (int k = 0; k < 3; k++) {
            u[k] = p->at[i][k] - p->at[0][k];
            v[k] = p->at[i + 1][k] - p->at[0][k];
        }
        sum[0] += u[1] * v[2] - u[2] * v[1];
        sum[1] += u[2] * v[0] - u[0] * v[2];
        sum[2] += u[0] * v[1] - u[1] * v[0];
    }
    return 0.5 * csg_norm3(sum);
}

static double value_at(const condition *c, const double at[3])
{
    return c->value + csg_dot3(c->slope, at);
}

static void add_corner(polygon *p, const double at[3])
{
    if (p->count < MOST_CORNERS)
        memcpy(p->at[p->count++], at, sizeof p->at[0]);
}

/* Where the condition's value is `level` at least, and where it is less. */
static void split(const polygon *p, const condition *c, double level, polygon *over, polygon *under)
{
    over->count = under->count = 0;
    for (int i = 0; i < p->count; i++) {
        const double *from = p->at[i], *to = p->at[(i + 1) % p->count];
        double a = value_at(c, from) - level, b = value_at(c, to) - level;
        add_corner(a >= 0 ? over : under, from);
        if ((a >= 0) == (b >= 0))
            continue;
        double share = a / (a - b), x[3];
        for (int k = 0; k < 3; k++)
            x[k] = from[k] + share * (to[k] - from[k]);
        add_corner(over, x);
        add_corner(under, x);
    }
}

static csg_truth formula_with(const carving *c, const csg_truth *known, csg_truth of_group)
{
    csg_truth planes[CSG_HALVES_MOST];
    for (int i = 0; i < c->halves->plane_count; i++)
        planes[i] = c->group && c->group->planes >> i & 1 ? of_group : known[i];
    return csg_halves_evaluate(c->halves, planes);
}

static csg_truth in_cube(const carving *c, const csg_truth *known)
{
    csg_truth all = CSG_TRUTH_YES;
    for (int i = c->halves->plane_count; i < c->count; i++) {
        if (known[i] == CSG_TRUTH_NO)
            return CSG_TRUTH_NO;
        if (known[i] == CSG_TRUTH_OPEN)
            all = CSG_TRUTH_OPEN;
    }
    return all;
}

/* Is all of the polygon wanted: in the solid, or where its surface is? */
static csg_truth is_wanted(const carving *c, const csg_truth *known)
{
    if (!c->group)
        return formula_with(c, known, CSG_TRUTH_OPEN);
    csg_truth inside = in_cube(c, known);
    csg_truth a = formula_with(c, known, CSG_TRUTH_YES), b = formula_with(c, known, CSG_TRUTH_NO);
    if (inside == CSG_TRUTH_NO || (a == b && a != CSG_TRUTH_OPEN))
        return CSG_TRUTH_NO;
    bool is_certain = a == CSG_TRUTH_YES && b == CSG_TRUTH_NO && inside == CSG_TRUTH_YES;
    return is_certain ? CSG_TRUTH_YES : CSG_TRUTH_OPEN;
}

static bool is_asked(const carving *c, int i)
{
    return !c->group || i >= c->halves->plane_count || !(c->group->planes >> i & 1);
}

static void carve(carving *c, const polygon *p, const csg_truth known[MOST_CONDITIONS])
{
    csg_truth here[MOST_CONDITIONS];
    int cut = -1;
    bool is_upper = false, is_one = false; /* the level from which on the condition holds; both */
    memcpy(here, known, sizeof here);
    for (int i = 0; i < c->count; i++) {
        const condition *of = &c->conditions[i];
        double low = INFINITY, high = -INFINITY;
        if (here[i] != CSG_TRUTH_OPEN || !is_asked(c, i))
            continue;
        for (int k = 0; k < p->count; k++) {
            double value = value_at(of, p->at[k]);
            low = fmin(low, value);
            high = fmax(high, value);
        }
        double room = CLOSE * (high - low);
        here[i] = low >= of->below - room   ? CSG_TRUTH_YES
                  : high < room - of->above ? CSG_TRUTH_NO
                                            : CSG_TRUTH_OPEN;
        if (here[i] != CSG_TRUTH_OPEN || cut >= 0)
            continue;
        is_upper = low + room < of->below && of->below < high - room;
        is_one = of->below + of->above <= room;
        if (is_upper || (low + room < -of->above && -of->above < high - room))
            cut = i;
    }
    csg_truth wanted = is_wanted(c, here);
    if (wanted == CSG_TRUTH_NO)
        return;
    double area = area_of(p);
    if (wanted == CSG_TRUTH_YES || cut < 0 || ++c->pieces > MOST_PIECES) {
        c->sum.least += wanted == CSG_TRUTH_YES ? area : 0;
        c->sum.most += area * (wanted == CSG_TRUTH_YES || !c->group ? 1 : c->group->count);
        return;
    }
    polygon over, under;
    const condition *by = &c->conditions[cut];
    split(p, by, is_upper ? by->below : -by->above, &over, &under);
    here[cut] = is_upper || is_one ? CSG_TRUTH_YES : CSG_TRUTH_OPEN;
    carve(c, &over, here);
    here[cut] = is_upper && !is_one ? CSG_TRUTH_OPEN : CSG_TRUTH_NO;
    carve(c, &under, here);
}

static csg_section carve_all(carving *c, const polygon *p)
{
    csg_truth known[MOST_CONDITIONS];
    for (int i = 0; i < MOST_CONDITIONS; i++)
        known[i] = CSG_TRUTH_OPEN;
    carve(c, p, known);
    double slack = ROUNDING * (1 + c->pieces) * area_of(p);
    return (csg_section){fmax(c->sum.least - slack, 0), c->sum.most + slack};
}

static void put_planes(carving *c, double along, const double direction[3])
{
    for (int i = 0; i < c->halves->plane_count; i++) {
        const csg_enclosure *e = &c->halves->planes[i];
        double room = fabs(csg_dot3(e->slope, direction)) * along;
        condition *of = &c->conditions[c->count++];
        *of = (condition){.value = e->value, .below = e->below + room, .above = e->above + room};
        memcpy(of->slope, e->slope, sizeof of->slope);
    }
}

csg_section csg_section_of_face(const csg_halves *halves, double half, int axis, int side)
{
    static const double NOWHERE[3] = {0};
    static const int CORNERS[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    carving c = {.halves = halves};
    polygon face = {.count = 4};
    put_planes(&c, 0, NOWHERE);
    for (int i = 0; i < 4; i++) {
        face.at[i][axis] = side * half;
        face.at[i][(axis + 1) % 3] = CORNERS[i][0] * half;
        face.at[i][(axis + 2) % 3] = CORNERS[i][1] * half;
    }
    csg_section found = carve_all(&c, &face);
    return (csg_section){found.least, fmin(found.most, 4 * half * half)};
}

/* ---- groups ------------------------------------------------------------------------------------
 */

/* How far from the first one's plane, along its normal, the zeros of another can be in the cube,
 * which is within `reach` of its centre. INFINITY: anywhere. */
static double width_of(const csg_enclosure *first, const csg_enclosure *e, double reach)
{
    double length = csg_norm3(first->slope), climb = csg_dot3(first->slope, e->slope) / length,
           d[3];
    if (!(length > 0) || !(climb > 0.9 * csg_norm3(e->slope)))
        return INFINITY;
    /* where the first one's plane is, this one's has this value but for what its slope is across */
    for (int k = 0; k < 3; k++)
        d[k] = e->slope[k] - climb / length * first->slope[k];
    double value = e->value - climb / length * first->value;
    return (fabs(value) + csg_norm3(d) * reach + fmax(e->below, e->above)) / climb * (1 + 1e-9);
}

/* No gradient is farther from the slope than one of this sine, nor the slope from the direction
 * than it is: the cosine of the sum of both angles. */
static double cosine_of(const csg_enclosure *e, const double direction[3])
{
    static const double ROUNDING_OF_ANGLES = 1e-7, LEAST = 0.05;
    double length = csg_norm3(e->slope), sine = e->stray / length;
    double between = fmin(csg_dot3(e->slope, direction) / length, 1);
    if (!(e->stray > 0 && sine < 1 && between > 0))
        return 0;
    double cosine = sqrt(1 - sine * sine) * between - sine * sqrt(1 - between * between);
    return cosine - ROUNDING_OF_ANGLES > LEAST ? cosine - ROUNDING_OF_ANGLES : 0;
}

static void add_to_group(csg_section_group *g, const csg_halves *h, int i, double width)
{
    g->planes |= 1u << i;
    g->count++;
    g->width = fmax(g->width, width);
    g->cosine = fmin(g->cosine, cosine_of(&h->planes[i], g->direction));
    g->is_convex = g->is_convex && h->planes[i].is_convex;
}

int csg_section_find_groups(const csg_halves *h, double half,
                            csg_section_group groups[CSG_HALVES_MOST])
{
    static const double BESIDE = 0.01; /* of the half edge, or some times their own rooms */
    double reach = csg_enclosure_radius(half);
    int count = 0;
    for (int i = 0; i < h->plane_count; i++) {
        const csg_enclosure *e = &h->planes[i];
        double length = csg_norm3(e->slope);
        double own = length > 0 ? fmax(e->below, e->above) / length : INFINITY;
        bool is_taken = false;
        if (csg_halves_state_of_plane(e, half) != CSG_TRUTH_OPEN)
            continue;
        for (int n = 0; n < count && !is_taken; n++) {
            const csg_enclosure *first = &h->planes[groups[n].first];
            double width = width_of(first, e, reach);
            is_taken = width <= fmax(BESIDE * half, 2 * (own + groups[n].width));
            if (is_taken)
                add_to_group(&groups[n], h, i, width);
        }
        if (is_taken)
            continue;
        csg_section_group *g = &groups[count++];
        *g = (csg_section_group){.first = i, .cosine = 1, .is_convex = true};
        for (int k = 0; k < 3; k++)
            g->direction[k] = length > 0 ? e->slope[k] / length : k == 0;
        add_to_group(g, h, i, own * (1 + 1e-9));
    }
    return count;
}

csg_section csg_section_of_group(const csg_halves *h, double half, const csg_section_group *g)
{
    carving c = {.halves = h, .group = g};
    const csg_enclosure *e = &h->planes[g->first];
    polygon p = {.count = 4};
    double square = csg_dot3(e->slope, e->slope), reach = csg_enclosure_radius(half) + g->width;
    double across[2][3] = {{0}};
    int least = 0;
    if (!(square > 0) || !isfinite(g->width))
        return (csg_section){0, INFINITY};
    put_planes(&c, g->width, g->direction);
    for (int axis = 0; axis < 3; axis++)
        for (int side = -1; side <= 1; side += 2) {
            double room = fabs(g->direction[axis]) * g->width;
            condition *of = &c.conditions[c.count++];
            *of = (condition){.value = half, .below = room, .above = room};
            of->slope[axis] = -side;
        }
    for (int k = 1; k < 3; k++)
        least = fabs(g->direction[k]) < fabs(g->direction[least]) ? k : least;
    double axis[3] = {0}, length;
    axis[least] = 1;
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        across[0][k] = g->direction[i] * axis[j] - g->direction[j] * axis[i];
    }
    length = csg_norm3(across[0]);
    for (int k = 0; k < 3; k++)
        across[0][k] /= length;
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        across[1][k] = g->direction[i] * across[0][j] - g->direction[j] * across[0][i];
    }
    for (int n = 0; n < 4; n++)
        for (int k = 0; k < 3; k++)
            p.at[n][k] = -e->value / square * e->slope[k] +
                         reach * ((n == 1 || n == 2 ? 1 : -1) * across[0][k] +
                                  (n >= 2 ? 1 : -1) * across[1][k]);
    return carve_all(&c, &p);
}
