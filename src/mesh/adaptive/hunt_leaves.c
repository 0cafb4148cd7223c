/* SPDX-License-Identifier: MIT
 * What a single leaf puts into a brick: a bump on a face, a dent, a part in a corner of it, all too
 * small for points half way between the brick's own. A leaf by itself is near to a distance, so a
 * step along its gradient ends on its surface, however small it is; a little inside and a little
 * outside of that place the whole field is asked.
 */
#include "mesh/adaptive/hunt.h"

#include <math.h>

enum {
    E = CSG_BRICK_EDGE,
    STARTS = 9,      /* the corners of the brick and its middle */
    DIRECTIONS = 14, /* the axes and the diagonals, all ways */
    FEW_LEAVES = 8,  /* of more than these only one step each is made, from the middle */
    MOST_LEAVES = 64,
    BATCH = 3 * DIRECTIONS, /* on a leaf's surface, and on either side of it */
    PADDED = (BATCH + CSG_LANES - 1) / CSG_LANES * CSG_LANES
};

/* Of the tolerance: how deep a place is asked for, and how deep it must be. All of its three points
 * have to be in the brick: with longer steps the ends of what pokes through the brick's side, a
 * tolerance wide, would be left out there and in the next brick. */
static const double STEP = 0.0625, DEPTH = 0.01;
/* Of the margin: how far a place is moved along axes on which it did not have to be; it would stay
 * beside an edge of the leaf, where a step along a gradient leads into the face beyond it. */
static const double ASIDE = 0.0625;
/* Cosine to the mean direction: a leaf that climbs in others is not plane in the brick. */
static const double PLANE = 0.9;

typedef struct batch {
    float x[PADDED], y[PADDED], z[PADDED], f[PADDED], g[3][PADDED];
} batch;

static void fill_lanes(batch *b, int count)
{
    for (int i = count; i < PADDED; i++)
        b->x[i] = b->x[0], b->y[i] = b->y[0], b->z[i] = b->z[0];
}

/* The places that steps begin at: the middle first. */
static void place_starts(const csg_bricks *b, const csg_brick *brick, batch *out)
{
    float *at[3] = {out->x, out->y, out->z};
    for (int axis = 0; axis < 3; axis++) {
        float low = csg_brick_coordinate(b, brick, axis, 0);
        float high = csg_brick_coordinate(b, brick, axis, E);
        at[axis][0] = 0.5f * (low + high);
        for (int corner = 0; corner < 8; corner++)
            at[axis][1 + corner] = corner >> axis & 1 ? high : low;
    }
}

typedef struct leaf_look {
    csg_sheet_probe *probe;
    csg_tape_node node;
    csg_tape tape; /* the leaf alone */
    bool is_plane; /* as seen from where steps began last */
    double low[3], high[3];
} leaf_look;

static leaf_look look_at(csg_sheet_probe *p, const csg_bricks *b, const csg_brick *brick)
{
    leaf_look l = {.probe = p, .tape = *p->tape};
    for (int axis = 0; axis < 3; axis++) {
        l.low[axis] = (double)csg_brick_coordinate(b, brick, axis, 0);
        l.high[axis] = (double)csg_brick_coordinate(b, brick, axis, E);
    }
    return l;
}

/* Values and gradients of the leaf. */
static void ask_leaf(leaf_look *l, batch *at, int count)
{
    csg_sheet_probe *p = l->probe;
    l->tape.nodes = &l->node;
    l->tape.count = 1;
    fill_lanes(at, count);
    p->kernel->values_and_gradients(&l->tape, at->x, at->y, at->z, (size_t)count, at->f, at->g[0],
                                    at->g[1], at->g[2], p->scratch, p->scratch_floats);
    p->evaluations += (uint64_t)count;
}

/* Where a field of constant slope would be 0, and the direction of the slope. False: there is none.
 */
static bool find_zero(const batch *at, int i, double zero[3], double way[3])
{
    const float from[3] = {at->x[i], at->y[i], at->z[i]};
    double square = 0, f = (double)at->f[i];
    for (int axis = 0; axis < 3; axis++)
        square += (double)at->g[axis][i] * (double)at->g[axis][i];
    if (!(square > 1e-12) || !(fabs(f) < INFINITY))
        return false;
    for (int axis = 0; axis < 3; axis++) {
        double g = (double)at->g[axis][i];
        zero[axis] = (double)from[axis] - f / square * g;
        way[axis] = g / sqrt(square);
    }
    return true;
}

/* Moves those points whose step would end beyond or close to a side of the brick to a place within
 * that side, and on away from it, so that the next step ends elsewhere. Others stay: on the surface
 * itself a gradient may be none. */
static void step_closer(const leaf_look *l, batch *at, int count, double margin)
{
    for (int i = 0; i < count; i++) {
        double zero[3], way[3];
        float *place[3] = {&at->x[i], &at->y[i], &at->z[i]};
        if (!find_zero(at, i, zero, way))
            continue;
        bool leaves = false;
        for (int axis = 0; axis < 3; axis++)
            leaves =
                leaves || zero[axis] < l->low[axis] + margin || zero[axis] > l->high[axis] - margin;
        for (int axis = 0; axis < 3 && leaves; axis++) {
            double within = fmin(fmax(zero[axis], l->low[axis] + margin), l->high[axis] - margin);
            double middle = 0.5 * (l->low[axis] + l->high[axis]);
            double away = within != zero[axis] ? margin : ASIDE * margin;
            *place[axis] = (float)(within + fmin(fmax(middle - within, -away), away));
        }
    }
}

/* Below, on and above the leaf's surface. */
enum { BELOW, ON, ABOVE, SIDES };

/* Whether the leaf climbs in one direction: it is plane in the brick. */
static bool is_plane_at(const batch *at, int count)
{
    csg_vec3 climb = {0, 0, 0}, directions[DIRECTIONS];
    int found = 0;
    for (int i = 0; i < count; i++) {
        double zero[3], way[3];
        if (!find_zero(at, i, zero, way))
            continue;
        directions[found] = csg_vec3_make(way[0], way[1], way[2]);
        climb = csg_vec3_add(climb, directions[found++]);
    }
    bool is_plane = true;
    for (int i = 0; i < found; i++)
        is_plane = is_plane && csg_gradients_cosine(directions[i], climb) > PLANE;
    return is_plane;
}

/* Such places by threes, all in the brick; how many there are. */
static int find_places(leaf_look *l, batch *starts, int count, double step, batch *out)
{
    int found = 0;
    double edge = l->high[0] - l->low[0];
    ask_leaf(l, starts, count);
    l->is_plane = is_plane_at(starts, count);
    step_closer(l, starts, count, fmin(3 * step, 0.25 * edge));
    ask_leaf(l, starts, count);
    for (int i = 0; i < count; i++) {
        double zero[3], way[3];
        if (!find_zero(starts, i, zero, way))
            continue;
        bool is_within = true;
        for (int side = BELOW; side < SIDES; side++) {
            float *to[3] = {&out->x[found + side], &out->y[found + side], &out->z[found + side]};
            for (int axis = 0; axis < 3; axis++) {
                double place = zero[axis] + (side - ON) * step * way[axis];
                is_within = is_within && place >= l->low[axis] && place <= l->high[axis];
                *to[axis] = (float)place;
            }
        }
        found += is_within ? SIDES : 0;
    }
    return found;
}

/* Places all around what a leaf has in the brick: the points of its surface that are nearest to
 * them are its ends, which those nearest to the corners of the brick need not be. starts: where the
 * surface was found from. False: it was not. */
static bool place_around(const leaf_look *l, batch *starts, int count)
{
    csg_vec3 mean = {0, 0, 0};
    int found = 0;
    for (int i = 0; i < count; i++) {
        double zero[3], way[3];
        if (!find_zero(starts, i, zero, way))
            continue;
        mean = csg_vec3_add(mean, csg_vec3_make(zero[0], zero[1], zero[2]));
        found++;
    }
    if (!found)
        return false;
    double reach = l->high[0] - l->low[0];
    for (int i = 0; i < DIRECTIONS; i++) {
        csg_vec3 way = {0, 0, 0};
        if (i < 8)
            way = csg_vec3_make(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        else
            *(i < 10 ? &way.x : i < 12 ? &way.y : &way.z) = i % 2 ? 1 : -1;
        csg_vec3 at = csg_vec3_add(csg_vec3_scale(mean, 1.0 / found), csg_vec3_scale(way, reach));
        starts->x[i] = (float)at.x, starts->y[i] = (float)at.y, starts->z[i] = (float)at.z;
    }
    return true;
}

static void find_cell(const csg_bricks *b, const csg_brick *brick, const float at[3],
                      unsigned cell[3])
{
    for (int axis = 0; axis < 3; axis++) {
        cell[axis] = 0;
        while (cell[axis] + 1 < E &&
               at[axis] > csg_brick_coordinate(b, brick, axis, cell[axis] + 1))
            cell[axis]++;
    }
}

/* Whether a place has another sign than all corners of its cell, and none of the cell's edges is
 * pierced. */
static bool is_hidden(const csg_brick *brick, const unsigned cell[3], bool sign)
{
    const unsigned end[3] = {cell[0] + 1, cell[1] + 1, cell[2] + 1};
    return csg_brick_pattern(brick, cell[0], cell[1], cell[2]) == (sign ? 0u : 0xFFu) &&
           !csg_brick_is_pierced(brick, cell, end);
}

/* The cells that hide what three places show; where the surface goes through between the outer two,
 * the middle one is put into `out`: there the sign is enough, since at an edge or a corner of the
 * leaf these may hardly be off its faces. noise: of values. */
static uint8_t judge_places(const csg_bricks *b, const csg_brick *brick, const batch *at, int first,
                            double least, double noise, csg_hunted *out)
{
    bool is_deep[SIDES], is_sure[SIDES];
    unsigned cell[3], cells = 0;
    for (int side = BELOW; side < SIDES; side++) {
        int k = first + side;
        const float place[3] = {at->x[k], at->y[k], at->z[k]};
        is_deep[side] = fabs((double)at->f[k]) > least;
        is_sure[side] = fabs((double)at->f[k]) > noise;
        find_cell(b, brick, place, cell);
        if (is_deep[side] && is_hidden(brick, cell, at->f[k] >= 0))
            cells |= 1u << csg_brick_cell(cell[0], cell[1], cell[2]);
    }
    int on = first + ON;
    if (cells || is_deep[ON] || !is_sure[BELOW] || !is_sure[ABOVE] ||
        out->count == CSG_HUNT_LEAF_POINTS ||
        (at->f[first + BELOW] >= 0) == (at->f[first + ABOVE] >= 0))
        return (uint8_t)cells;
    const float place[3] = {at->x[on], at->y[on], at->z[on]};
    find_cell(b, brick, place, cell);
    out->at[out->count] = csg_vec3_from_floats(place);
    out->cell[out->count++] = (uint8_t)csg_brick_cell(cell[0], cell[1], cell[2]);
    return 0;
}

/* The cells that hide what steps from the starts to the leaf's surface show. */
static uint8_t look_from(leaf_look *l, const csg_bricks *b, const csg_brick *brick, batch *starts,
                         int count, double tolerance, csg_hunted *out)
{
    csg_sheet_probe *p = l->probe;
    batch at;
    double noise = 4 * p->noise, least = DEPTH * tolerance * (double)l->tape.lipschitz + noise;
    unsigned cells = 0;
    int places = find_places(l, starts, count, STEP * tolerance, &at);
    if (!places)
        return 0;
    fill_lanes(&at, places);
    p->kernel->values(p->tape, at.x, at.y, at.z, (size_t)places, at.f, p->scratch,
                      p->scratch_floats);
    p->evaluations += (uint64_t)places;
    for (int k = 0; k < places; k += SIDES)
        cells |= judge_places(b, brick, &at, k, least, noise, out);
    return (uint8_t)cells;
}

uint8_t csg_hunt_leaves(csg_sheet_probe *p, const csg_bricks *b, const csg_brick *brick,
                        double tolerance, uint8_t cells, csg_hunted *out)
{
    csg_tape tape = csg_bricks_short_tape(b, brick);
    uint32_t leaves = csg_tape_leaf_count(&tape);
    bool few = leaves <= FEW_LEAVES;
    if (leaves < 2 || leaves > MOST_LEAVES)
        return 0; /* one alone is what all other looks are for */
    leaf_look look = look_at(p, b, brick);
    unsigned hidden = 0;
    for (uint32_t i = 0; i < tape.count && cells & ~hidden; i++) {
        const csg_tape_node *leaf = &tape.nodes[i];
        batch starts;
        if (!csg_op_is_leaf(leaf->op) || leaf->op == CSG_OP_EMPTY)
            continue;
        look.node = *leaf;
        look.node.join = CSG_JOIN_NONE;
        place_starts(b, brick, &starts);
        int count = few ? STARTS : 1;
        hidden |= look_from(&look, b, brick, &starts, count, tolerance, out);
        if (few && !look.is_plane && place_around(&look, &starts, count))
            hidden |= look_from(&look, b, brick, &starts, DIRECTIONS, tolerance, out);
    }
    return (uint8_t)(hidden & cells);
}
