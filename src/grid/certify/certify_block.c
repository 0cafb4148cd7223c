/* SPDX-License-Identifier: MIT
 * Dividing a block until every cube of it is settled. In the order tried:
 *
 *   empty      the field's interval over the cube does not hold 0
 *   far cone   one direction climbs all over the cube and HALF_FAR to FAR cells around, where |f| is
 *              small: what hides in the cube is then the tip of a cone that holds a lattice point.
 *              Cubes down to a cell.
 *   near cone  the same around a cube within a cell, so that all that hides in it is connected with
 *              one of two places up and down that direction: one way from each of them to the
 *              lattice (certify_reach.h) answers for the cube
 *   balls      two balls, of inside and of outside, leave of the cube a layer thinner than `size`
 *   the rest is divided, down to `size`; there the sign of the centre is followed to the lattice.
 */
#include "grid/certify/certify_block.h"

#include <math.h>
#include <string.h>

#include "field/cones/cone.h"
#include "field/cones/near_slopes.h"
#include "scene/warp_kinds.h"

static const double ROOT3 = 1.7320508075688772 * (1 + 0x1p-40);
/* In cells: how far around a cube its tape is valid, and around one of several cells. A cone within
 * FAR_CUBE of these, and the balls of the band that end in it, are then where that one's tape is.
 */
static const double FAR = 2.5, WIDE_FAR = 3;
/* Where slopes of formulas are those near a cube of several cells: what is looked at around a cell
 * of it goes 2.5 cells from its centre and has balls of a cell, or 1.3 beyond it and balls of two.
 */
static const double AROUND = 4;
/* How far a cone is asked for first, and at most where formulas are in it, which heed cubes. */
static const double HALF_FAR = 1.3, HALF_FAR_CUBE = 1.1, FAR_CUBE = 2.1;
static const double LOCAL = 1.3, OWN = 2.6;     /* near cones, within a cell and of all of it */
static const double NEAR = 1.45, WIDE_NEAR = 8; /* radii of the cube */
static const double WIDER = 1.2;                /* than a smaller cone needs */

enum {
    MOST_VISITS = 20000,  /* of cubes, a cell */
    SLOW_VISIT = 8,       /* what one counts where shapes, formulas or warps are evaluated */
    SLOW_BLOCK_VISIT = 20 /* the same, of the block's, for each of them */
};

/* ---- kinds ---------------------------------------------------------------------------------- */

static void note(csg_certify_worker *w, uint32_t cell, csg_cell_kind kind)
{
    if (kind > w->kinds[cell])
        w->kinds[cell] = (uint8_t)kind;
}

/* A cell's worst finding is kept: a gap or part that is missed before what cannot be told. */
static bool find(csg_certify_worker *w, uint32_t cell, csg_cell_kind kind, int sign,
                 const csg_reach_end *end)
{
    if (kind <= w->kinds[cell])
        return true;
    note(w, cell, kind);
    size_t last = w->finding_count - 1;
    uint32_t at[3];
    for (int axis = 0; axis < 3; axis++)
        at[axis] = w->block.at[axis] * CSG_BLOCK_EDGE + (cell >> (3 * axis) & 7);
    bool again = w->finding_count && !memcmp(w->findings[last].cell, at, sizeof at);
    if (!again) {
        if (!csg_memory_reserve(&w->context->memory, (void **)&w->findings, &w->finding_capacity,
                                w->finding_count + 1, sizeof *w->findings))
            return false;
        last = w->finding_count++;
    }
    csg_certify_finding *f = &w->findings[last];
    *f = (csg_certify_finding){
        .kind = (uint8_t)kind, .is_gap = sign < 0, .thickness = end->thickness};
    memcpy(f->cell, at, sizeof at);
    memcpy(f->at, end->at, sizeof f->at);
    return true;
}

/* Cells of the block whose corners differ, in a cube of cells. */
static void note_crossed(csg_certify_worker *w, const csg_certify_cube *cube, csg_cell_kind kind)
{
    int first[3], edge = (int)(2 * cube->half / w->lattice->cell_size + 0.5);
    for (int axis = 0; axis < 3; axis++) {
        double low =
            cube->c[axis] - cube->half -
            (double)csg_lattice_coordinate(w->lattice, axis, w->block.at[axis] * CSG_BLOCK_EDGE);
        first[axis] = (int)floor(low / w->lattice->cell_size + 0.5);
    }
    for (int k = first[2]; k < first[2] + edge; k++)
        for (int j = first[1]; j < first[1] + edge; j++)
            for (int i = first[0]; i < first[0] + edge; i++) {
                const uint16_t *low = w->block.inside[k] + j, *high = w->block.inside[k + 1] + j;
                unsigned pairs = 0, any = 0;
                for (int row = 0; row < 4; row++) {
                    unsigned two = ((row & 2 ? high : low)[row & 1] >> i) & 3;
                    any |= two != 0;
                    pairs += (two & 1) + (two >> 1);
                }
                if (any && pairs < 8)
                    note(w, (uint32_t)(i | j << 3 | k << 6), kind);
            }
}

/* ---- one cube ------------------------------------------------------------------------------- */

/* Follows one side of the surface in a cube to the lattice; *settled stays only if it gets there.
 */
static bool follow(csg_certify_worker *w, uint32_t cell, const double p[3], double value, int sign,
                   bool *settled)
{
    csg_reach_end end;
    if (csg_reach_slide(&w->local, p, sign * value, sign, &w->trail))
        return true;
    if (w->near)
        csg_reach_values(&w->reach, (const double(*)[3])p, 1, &value);
    csg_reach_state state = csg_reach_from(&w->reach, p, sign * value, sign, &w->trail, &end);
    if (state == CSG_REACH_SAMPLE)
        return true;
    *settled = false;
    csg_cell_kind kind = state == CSG_REACH_NONE ? CSG_CELL_MISSED : CSG_CELL_UNRESOLVED;
    return find(w, cell, kind, sign, &end);
}

/* What holds of both ends of a cube: they reach the lattice, or the cell says why not. */
static bool follow_ends(csg_certify_worker *w, const csg_certify_cube *cube, const double p[2][3],
                        const double values[2], const int signs[2], csg_cell_kind kind)
{
    bool settled = true;
    for (int side = 0; side < 2; side++)
        if (signs[side] && !follow(w, cube->cell, p[side], values[side], signs[side], &settled))
            return false;
    if (settled)
        note(w, cube->cell, kind);
    return true;
}

static void along(const csg_certify_cube *cube, const double axis[3], double t, double p[2][3])
{
    for (int k = 0; k < 3; k++) {
        p[0][k] = cube->c[k] + t * axis[k];
        p[1][k] = cube->c[k] - t * axis[k];
    }
}

static bool is_cell(const csg_certify_worker *w, const csg_certify_cube *cube)
{
    return 2 * cube->half > 0.75 * w->lattice->cell_size;
}

static csg_tape near_tape(const csg_certify_worker *w)
{
    csg_tape tape = *w->reach.tape;
    if (w->near)
        tape.parameters = w->near;
    return tape;
}

static csg_tape tape_of(const csg_certify_worker *w, const csg_certify_cube *cube)
{
    csg_tape tape = near_tape(w);
    tape.nodes = cube->nodes;
    tape.count = cube->node_count;
    return tape;
}

/* Values that are this far from zero have a ball that holds a lattice point. */
static double band_of(const csg_certify_worker *w)
{
    return 0.5 * ROOT3 * 1.01 * w->reach.lipschitz * w->lattice->cell_size;
}

/* In the ball around a point and in the cube of that half edge, within the band. */
static bool cone_around(csg_certify_worker *w, const csg_tape *tape, const csg_certify_cube *cube,
                        double radius, double half, double band, csg_cone *cone)
{
    const csg_cone_region region = {.c = {(float)cube->c[0], (float)cube->c[1], (float)cube->c[2]},
                                    .radius = radius * (1 + 0x1p-20) + (double)w->wide.rounding,
                                    .half = half * (1 + 0x1p-20) + (double)w->wide.rounding,
                                    .band = band};
    bool found = csg_cone_find_in(&w->cones, tape, &region, cone);
    w->out_of_memory |= cone->out_of_memory;
    return found;
}

static bool cone_of(csg_certify_worker *w, const csg_certify_cube *cube, double radius, double half,
                    csg_cone *cone)
{
    csg_tape tape = tape_of(w, cube);
    return cone_around(w, &tape, cube, radius, half, band_of(w), cone);
}

/* A region that a cone is asked for around a cube: its ball and its cube, in cells beyond the
 * cube's own. */
typedef struct surroundings {
    double ball, cube;
} surroundings;

/* What is inside climbs up the cone. s cells up it the field is m s at least, whose ball holds a
 * lattice point where it is as large as half a cell's diagonal; and it has not fallen on the way to
 * any point of the cell-sized cube around that place where s v . g >= (|g_x| + |g_y| + |g_z|) / 2,
 * and one of these is a lattice point. *wanted: the surroundings that have room for such an s. */
static bool climbs_far(const csg_certify_worker *w, const csg_cone *cone, const surroundings *far,
                       surroundings *wanted)
{
    static const double slack = 1e-3, more = 1.1;
    double across = 0, ball = cone->fills_cube ? INFINITY : far->ball;
    for (int k = 0; k < 3; k++)
        across = fmax(across, fabs(cone->axis[k]));
    double up = fmin(ball - 0.05, (far->cube - slack) / across), needed = 0.5 * cone->lean;
    double s = fmin(ball - 0.5 * ROOT3, (far->cube - 0.5) / across) - slack;
    *wanted =
        (surroundings){.ball = 0.5 * ROOT3 + more * needed, .cube = 0.5 + more * needed * across};
    return cone->least * up > 0.5 * ROOT3 * 1.01 * w->reach.lipschitz || s > needed * (1 + slack);
}

/* The far cone: settles all cells in the cube. Where slopes differ little a short way is enough;
 * that of formulas is as long as they ask for, since their bounds grow with it. *nearer: a smaller
 * region may have a cone; that of formulas alone is hardly larger than a near cone's. */
static bool has_far_cone(csg_certify_worker *w, const csg_certify_cube *cube, csg_cone *cone,
                         bool *nearer)
{
    double h = w->lattice->cell_size;
    const surroundings most = {FAR, w->has_formulas ? FAR_CUBE : INFINITY};
    surroundings far = {HALF_FAR, w->has_formulas ? HALF_FAR_CUBE : INFINITY}, wanted;
    for (int i = 0; i < 2; i++) {
        if (!cone_of(w, cube, ROOT3 * cube->half + far.ball * h, cube->half + far.cube * h, cone)) {
            *nearer = i > 0 || !cone->fills_cube;
            return false;
        }
        *nearer = true;
        if (climbs_far(w, cone, &far, &wanted))
            return true;
        bool fits = wanted.cube <= most.cube && (cone->fills_cube || wanted.ball <= most.ball);
        if (cone->fills_cube && !fits)
            return false;
        far = fits && w->has_formulas ? wanted : most;
    }
    return false;
}

/* Whether the balls around two points, `apart` along a line through the cube's centre, leave a
 * layer of the cube's ball thinner than the size. */
static bool balls_cover(const csg_certify_worker *w, double r, double apart, const double values[2])
{
    double layer = apart;
    for (int side = 0; side < 2; side++) {
        double value = fmin(fabs(values[side]), w->local.band);
        double radius = value / w->local.lipschitz * (1 - 0x1p-12);
        if (!(radius > r))
            return false;
        layer -= sqrt(radius * radius - r * r);
    }
    return layer <= w->size;
}

/* Whether the surface itself may have an edge in the cube: operands and faces that only take part
 * around it do not count. */
static bool has_edge(csg_certify_worker *w, const csg_certify_cube *cube)
{
    const float c[3] = {(float)cube->c[0], (float)cube->c[1], (float)cube->c[2]};
    double r = ROOT3 * cube->half, thin = w->reach.noise;
    csg_tape tape = tape_of(w, cube), own;
    csg_cone cone;
    csg_arena_mark mark = csg_arena_get_mark(&w->tapes);
    bool done = csg_prune_cube(&w->plain, &tape, c, (float)(r * (1 + 0x1p-20)));
    bool is_here = done && csg_prune_state(&w->plain, 0) == CSG_CELL_SURFACE;
    if (is_here)
        done = csg_prune_shorten(&w->plain, 0, (float)thin, &w->tapes, &own);
    w->out_of_memory |= !done;
    bool has_one = is_here && done &&
                   (!cone_around(w, &own, cube, r, cube->half, thin, &cone) || cone.is_crease);
    csg_arena_release_to(&w->tapes, mark);
    return has_one;
}

static csg_cell_kind kind_of(csg_certify_worker *w, const csg_certify_cube *cube,
                             const csg_cone *around)
{
    return around->is_crease && has_edge(w, cube) ? CSG_CELL_CREASE : CSG_CELL_CERTIFIED;
}

/* Two places up and down a cone, `height` radii of the cube from its centre. */
typedef struct meeting {
    csg_cone cone;
    double height, p[2][3], values[2];
} meeting;

/* The ways to the meeting places lie within so many radii. */
static double meeting_radius(double height)
{
    return sqrt(1 + height * height);
}

/* Twice how far the field is from 0, at least, on ways from the cube to the meeting places, and by
 * how much the way across the axis may need more: from q, a along and b across the axis from the
 * centre, f climbs by m (t - a) up to the height t. From there to the middle it changes by
 * sqrt(slope^2 - m^2) b at most, and is f(p) in the end: no 0 is between where
 * m t + |f(p)| > slope r >= m a + sqrt(slope^2 - m^2) b. If f(p) has the other sign, no q has this
 * one. */
static bool is_met(csg_certify_worker *w, const csg_certify_cube *cube, meeting *m, double *needed)
{
    double r = ROOT3 * cube->half, least = INFINITY;
    double slope = fmin(w->reach.lipschitz, m->cone.most * (1 + 0x1p-12));
    along(cube, m->cone.axis, m->height * r, m->p);
    csg_reach_values(&w->local, (const double(*)[3])m->p, 2, m->values);
    for (int side = 0; side < 2; side++)
        least = fmin(least, fmin(fabs(m->values[side]), w->local.band));
    double climbed = m->cone.least * m->height * r + least * (1 - 0x1p-12);
    *needed = fmin(m->height * slope * r / climbed, m->cone.steep);
    return climbed > slope * r * (1 + 0x1p-12) || m->height > m->cone.steep * (1 + 0x1p-12);
}

/* In a wider ball than the cube's own tape is for. */
static bool has_wide_cone(csg_certify_worker *w, const csg_certify_cube *cube, double radius,
                          csg_cone *cone)
{
    csg_tape tape;
    float reach = (float)(radius * ROOT3 * (1 + 0x1p-20));
    const float c[3] = {(float)cube->c[0], (float)cube->c[1], (float)cube->c[2]};
    csg_arena_mark mark = csg_arena_get_mark(&w->tapes);
    bool done = csg_prune_cube(&w->wide, &w->local_tape, c, reach);
    bool is_here = done && csg_prune_state(&w->wide, 0) == CSG_CELL_SURFACE;
    if (is_here)
        done = csg_prune_shorten(&w->wide, 0, (float)w->local.band, &w->tapes, &tape);
    w->out_of_memory |= !done;
    bool found = done && is_here && cone_around(w, &tape, cube, radius, INFINITY, band_of(w), cone);
    csg_arena_release_to(&w->tapes, mark);
    return found;
}

/* Where slopes differ, as where a steep part meets a flat one, NEAR radii may be too few. */
static bool find_meeting(csg_certify_worker *w, const csg_certify_cube *cube, meeting *m)
{
    double r = ROOT3 * cube->half, needed;
    m->height = NEAR;
    if (!cone_of(w, cube, meeting_radius(NEAR) * r, INFINITY, &m->cone))
        return false;
    if (is_met(w, cube, m, &needed))
        return true;
    m->height = WIDER * needed;
    double radius = meeting_radius(m->height) * r, h = w->lattice->cell_size;
    if (w->has_formulas && is_cell(w, cube))
        return radius < OWN * h && cone_of(w, cube, radius, INFINITY, &m->cone) &&
               is_met(w, cube, m, &needed);
    return m->height <= WIDE_NEAR && radius < LOCAL * h &&
           has_wide_cone(w, cube, radius, &m->cone) && is_met(w, cube, m, &needed);
}

/* One way from each meeting place to the lattice answers for the cube; where a place has the other
 * sign there is nothing to answer for. */
static bool follow_meeting(csg_certify_worker *w, const csg_certify_cube *cube, const meeting *m)
{
    const int signs[2] = {m->values[0] > 0 ? 1 : 0, m->values[1] < 0 ? -1 : 0};
    return follow_ends(w, cube, (const double(*)[3])m->p, m->values, signs,
                       kind_of(w, cube, &m->cone));
}

/* Two balls up and down the gradient. */
static bool settle_by_balls(csg_certify_worker *w, const csg_certify_cube *cube, bool *settled)
{
    double axis[3], p[2][3], values[2], h = w->lattice->cell_size, r = ROOT3 * cube->half;
    if (!(r * r <= h * w->size)) /* balls that touch leave a layer of r^2 / t at least */
        return true;
    csg_reach_gradient(&w->local, cube->c, axis);
    double norm = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    if (!(norm > 1e-3))
        return true;
    for (int k = 0; k < 3; k++)
        axis[k] /= norm;
    for (double t = 1; t > 0.1 && r * r <= t * h * w->size; t /= 2.5) {
        along(cube, axis, t * h, p);
        csg_reach_values(&w->local, (const double(*)[3])p, 2, values);
        if (!balls_cover(w, r, 2 * t * h, values))
            continue;
        const int signs[2] = {values[0] >= 0 ? 1 : -1, values[1] >= 0 ? 1 : -1};
        *settled = w->reached_size = true;
        return follow_ends(w, cube, (const double(*)[3])p, values, signs, CSG_CELL_REFINED);
    }
    return true;
}

/* Near cone or balls; *settled tells whether the cube needs no division. */
static bool settle(csg_certify_worker *w, const csg_certify_cube *cube, bool may_meet,
                   bool *settled)
{
    meeting m;
    *settled = may_meet && find_meeting(w, cube, &m);
    return *settled ? follow_meeting(w, cube, &m) : settle_by_balls(w, cube, settled);
}

/* A cube that is not divided any more. */
static bool end_cube(csg_certify_worker *w, const csg_certify_cube *cube)
{
    double value;
    bool settled = true;
    csg_reach_values(&w->local, (const double(*)[3])cube->c, 1, &value);
    w->reached_size = true;
    if (!follow(w, cube->cell, cube->c, value, value >= 0 ? 1 : -1, &settled))
        return false;
    if (settled)
        note(w, cube->cell, CSG_CELL_REFINED);
    return true;
}

/* Whether sines or angles are needed on the way to a leaf; revolutions, slices and elbows take a
 * root. */
static bool is_slow_way(const csg_tape *tape, uint32_t warp)
{
    bool slow = false;
    for (uint32_t w = warp; w && !slow; w = tape->warps[w - 1].outer)
        slow = csg_warp_traits(tape->warps[w - 1].kind) & CSG_WARP_IS_CUT;
    return slow;
}

/* Whether a formula has more steps than a primitive. */
static bool is_long_formula(const csg_tape *tape, const csg_tape_node *node)
{
    enum { SHORT = 12 };
    return csg_tape_formula_of(tape, node)->count > SHORT;
}

/* Leaves that are slow to evaluate. */
static uint32_t slow_leaves(const csg_certify_worker *w, const csg_certify_cube *cube)
{
    const csg_tape *tape = w->reach.tape;
    uint32_t count = 0;
    for (uint32_t i = 0; i < cube->node_count; i++) {
        const csg_tape_node *node = &cube->nodes[i];
        bool is_slow = node->op == CSG_OP_SHAPE ||
                       (node->op == CSG_OP_FIELD && is_long_formula(tape, node)) ||
                       (csg_op_is_leaf(node->op) && is_slow_way(tape, node->warp));
        count += is_slow;
    }
    return count;
}

static bool is_within_budget(csg_certify_worker *w, const csg_certify_cube *cube)
{
    uint32_t slow = slow_leaves(w, cube);
    w->cubes++;
    w->block_visits += slow ? slow * SLOW_BLOCK_VISIT : 1;
    w->visits[cube->cell] += slow ? SLOW_VISIT : 1;
    return w->visits[cube->cell] <= MOST_VISITS && w->block_visits <= w->most_block_visits;
}

/* Whether a slide from c, or from beyond the surface as the gradient there has it, leads to the
 * lattice: where nothing hides it mostly does. */
static bool slides_from(csg_certify_worker *w, const double c[3], double value, int sign)
{
    double p[1][3], g[3], h = w->lattice->cell_size;
    memcpy(p[0], c, sizeof p[0]);
    if (sign * value < 0) {
        csg_reach_gradient(&w->local, c, g);
        double norm = sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
        double step = norm > 1e-3 ? fabs(value) / norm + h / 8 : 0;
        for (int axis = 0; axis < 3; axis++)
            p[0][axis] += norm > 1e-3 ? sign * step * g[axis] / norm : 0;
        if (step > h)
            return false;
        csg_reach_values(&w->local, (const double(*)[3])p, 1, &value);
    }
    return sign * value > 0 && csg_reach_slide(&w->local, p[0], sign * value, sign, &w->trail);
}

/* The quick way to what hides in a cell: up and down from its centre. What is found in another cell
 * is that one's. */
static bool look_for_missed(csg_certify_worker *w, uint32_t cell)
{
    double c[1][3], value, h = w->lattice->cell_size;
    csg_reach_end end;
    if (w->looked[cell])
        return true;
    w->looked[cell] = true;
    for (int axis = 0; axis < 3; axis++)
        c[0][axis] =
            (double)csg_lattice_coordinate(
                w->lattice, axis, w->block.at[axis] * CSG_BLOCK_EDGE + (cell >> (3 * axis) & 7)) +
            h / 2;
    csg_reach_values(&w->local, (const double(*)[3])c, 1, &value);
    for (int sign = -1; sign <= 1; sign += 2) {
        if (slides_from(w, c[0], value, sign) ||
            csg_reach_from(&w->local, c[0], sign * value, sign, &w->trail, &end) !=
                CSG_REACH_NONE ||
            !(end.thickness > 0))
            continue;
        bool here = true;
        for (int axis = 0; axis < 3; axis++)
            here = here && fabs(end.at[axis] - c[0][axis]) <= 0.75 * h;
        if (here && !find(w, cell, CSG_CELL_MISSED, sign, &end))
            return false;
    }
    return true;
}

/* Where values are slow to find, this may be the time to look for what hides. */
static bool give_up(csg_certify_worker *w, const csg_certify_cube *cube)
{
    csg_reach_end end = {{cube->c[0], cube->c[1], cube->c[2]}, 0};
    return find(w, cube->cell, CSG_CELL_UNRESOLVED, 1, &end) && look_for_missed(w, cube->cell);
}

/* All that is looked at in a cell as a whole is within reach of its own tape. */
static void use_own_tape(csg_certify_worker *w, const csg_certify_cube *cube)
{
    double h = w->lattice->cell_size;
    w->trail.count = 0;
    w->local = w->reach;
    w->local_tape = tape_of(w, cube);
    w->local.tape = &w->local_tape;
    w->local.band = w->reach.lipschitz * h;
    for (int axis = 0; axis < 3; axis++) {
        w->local.low[axis] = cube->c[axis] - FAR * h;
        w->local.high[axis] = cube->c[axis] + FAR * h;
    }
}

/* A cube of a cell or less that is not empty. */
static bool look_at_small(csg_certify_worker *w, const csg_certify_cube *cube, bool *divide)
{
    csg_cone cone;
    bool settled = false, may_meet = true, is_whole = is_cell(w, cube);
    *divide = false;
    if (is_whole)
        use_own_tape(w, cube);
    if (w->kinds[cube->cell] == CSG_CELL_MISSED)
        return true;
    if (!is_whole && !is_within_budget(w, cube))
        return give_up(w, cube);
    if (is_whole && has_far_cone(w, cube, &cone, &may_meet)) {
        note_crossed(w, cube, kind_of(w, cube, &cone));
        return true;
    }
    if (!settle(w, cube, may_meet, &settled))
        return false;
    if (settled)
        return true;
    if (is_whole && !slow_leaves(w, cube) && !look_for_missed(w, cube->cell))
        return false;
    if (w->kinds[cube->cell] == CSG_CELL_MISSED)
        return true;
    if (is_whole && !is_within_budget(w, cube))
        return give_up(w, cube);
    *divide = 2 * cube->half > w->size * (1 + 1e-9);
    return *divide || end_cube(w, cube);
}

/* ---- the block ------------------------------------------------------------------------------ */

static bool stack_cube(csg_certify_worker *w, const csg_certify_cube *cube)
{
    if (!csg_memory_reserve(&w->context->memory, (void **)&w->stack, &w->stack_capacity,
                            w->stack_count + 1, sizeof *w->stack))
        return false;
    w->stack[w->stack_count++] = *cube;
    return true;
}

/* The tape for all that is looked at within a cell, up to LOCAL cells away from it; ways to the
 * lattice lead further. */
static bool localize(csg_certify_worker *w, const csg_certify_cube *cube)
{
    double h = w->lattice->cell_size, reach = cube->half + LOCAL * h;
    const float c[3] = {(float)cube->c[0], (float)cube->c[1], (float)cube->c[2]};
    w->local = w->reach;
    w->local.tape = &w->local_tape;
    for (int axis = 0; axis < 3; axis++) {
        w->local.low[axis] = cube->c[axis] - 0.99 * reach;
        w->local.high[axis] = cube->c[axis] + 0.99 * reach;
    }
    const csg_tape tape = near_tape(w);
    return csg_prune_cube(&w->plain, &tape, c, (float)(reach * ROOT3 * (1 + 0x1p-20))) &&
           csg_prune_shorten(&w->plain, 0, (float)w->reach.band, &w->tapes, &w->local_tape);
}

/* The eighths of a cube that are not empty, with tapes for what their cones need. */
static bool divide(csg_certify_worker *w, const csg_certify_cube *cube)
{
    if (2 * cube->half < 1.5 * w->lattice->cell_size &&
        2 * cube->half > 0.75 * w->lattice->cell_size && !localize(w, cube))
        return false;
    csg_tape tape = tape_of(w, cube), shorter;
    double h = w->lattice->cell_size, half = cube->half / 2, r = ROOT3 * half;
    bool is_small = 2 * half < 1.5 * h;
    double reach = is_small && !(2 * half > 0.75 * h)
                       ? meeting_radius(NEAR) * r
                       : half + (half > 1.5 * h ? WIDE_FAR : FAR) * h;
    float c[3][CSG_OCTANTS];
    for (int o = 0; o < CSG_OCTANTS; o++)
        for (int axis = 0; axis < 3; axis++)
            c[axis][o] = (float)(cube->c[axis] + (o >> axis & 1 ? half : -half));
    if (!csg_prune_octants(&w->plain, &tape, c[0], c[1], c[2], (float)(r * (1 + 0x1p-20))) ||
        !csg_prune_octants(&w->wide, &tape, c[0], c[1], c[2],
                           (float)(reach * ROOT3 * (1 + 0x1p-20))))
        return false;
    size_t first = w->stack_count;
    for (int o = CSG_OCTANTS - 1; o >= 0; o--) {
        if (csg_prune_state(&w->plain, o) != CSG_CELL_SURFACE)
            continue;
        if (!csg_prune_shorten(&w->wide, o, (float)(w->reach.lipschitz * h), &w->tapes, &shorter))
            return false;
        csg_certify_cube child = {
            .half = half, .nodes = shorter.nodes, .node_count = shorter.count, .cell = cube->cell};
        for (int axis = 0; axis < 3; axis++)
            child.c[axis] = (double)c[axis][o];
        if (is_small && cube->cell == CSG_CELLS_PER_BLOCK) {
            child.cell = 0;
            for (int axis = 0; axis < 3; axis++) {
                double from = (double)csg_lattice_coordinate(w->lattice, axis,
                                                             w->block.at[axis] * CSG_BLOCK_EDGE);
                child.cell |= (uint32_t)floor((child.c[axis] - from) / h) << (3 * axis);
            }
        }
        if (!stack_cube(w, &child))
            return false;
    }
    for (size_t i = first; i < w->stack_count; i++)
        w->stack[i].mark = csg_arena_get_mark(&w->tapes);
    return true;
}

/* For cubes within this one, and what they look at around. */
static void use_near_slopes(csg_certify_worker *w, const csg_certify_cube *cube)
{
    const float c[3] = {(float)cube->c[0], (float)cube->c[1], (float)cube->c[2]};
    csg_tape_set_near_slopes(w->reach.tape, c, cube->half + AROUND * w->lattice->cell_size,
                             w->near);
}

static bool look_at(csg_certify_worker *w, const csg_certify_cube *cube)
{
    csg_cone cone;
    if (w->near && cube->half > 1.5 * w->lattice->cell_size)
        use_near_slopes(w, cube);
    bool goes_on = true, nearer;
    if (cube->cell < CSG_CELLS_PER_BLOCK) {
        if (!look_at_small(w, cube, &goes_on))
            return false;
    } else if (has_far_cone(w, cube, &cone, &nearer) && !cone.is_crease) {
        note_crossed(w, cube, CSG_CELL_CERTIFIED);
        goes_on = false;
    }
    return !goes_on || divide(w, cube);
}

static void place_reach(csg_certify_worker *w, const csg_tape *tape)
{
    double h = w->lattice->cell_size;
    w->reach.tape = tape;
    w->local = w->reach;
    for (int axis = 0; axis < 3; axis++) {
        double from =
            (double)csg_lattice_coordinate(w->lattice, axis, w->block.at[axis] * CSG_BLOCK_EDGE);
        w->reach.low[axis] = from - (CSG_CERTIFY_MARGIN - 2) * h;
        w->reach.high[axis] = from + (CSG_BLOCK_EDGE + CSG_CERTIFY_MARGIN - 2) * h;
    }
}

static bool should_stop(csg_certify_worker *w)
{
    w->is_stopped = w->is_stopped || (w->cancelled && w->cancelled(w->user));
    return w->is_stopped;
}

bool csg_certify_block(csg_certify_worker *w, const uint32_t at[3], const csg_tape *tape)
{
    double h = w->lattice->cell_size;
    memcpy(w->block.at, at, sizeof w->block.at);
    w->block.parts = NULL;
    w->samples->scan = NULL;
    csg_block_sample(&w->block, w->reach.kernel, tape, w->lattice, at, NULL, w->samples,
                     w->reach.scratch, w->reach.scratch_floats);
    memset(w->kinds, 0, sizeof w->kinds);
    memset(w->visits, 0, sizeof w->visits);
    memset(w->looked, 0, sizeof w->looked);
    w->block_visits = 0;
    place_reach(w, tape);
    csg_certify_cube root = {.half = CSG_BLOCK_EDGE * h / 2,
                             .nodes = tape->nodes,
                             .node_count = tape->count,
                             .mark = csg_arena_get_mark(&w->tapes),
                             .cell = CSG_CELLS_PER_BLOCK};
    for (int axis = 0; axis < 3; axis++)
        root.c[axis] = (double)csg_lattice_coordinate(
            w->lattice, axis, at[axis] * CSG_BLOCK_EDGE + CSG_BLOCK_EDGE / 2);
    w->stack_count = 0;
    bool done = stack_cube(w, &root);
    while (done && w->stack_count && !should_stop(w)) {
        csg_certify_cube cube = w->stack[--w->stack_count];
        csg_arena_release_to(&w->tapes, cube.mark); /* what its elder siblings' parts needed */
        done = look_at(w, &cube);
    }
    csg_arena_release_to(&w->tapes, root.mark);
    for (int i = 0; i < CSG_CELLS_PER_BLOCK; i++)
        if (w->kinds[i])
            w->cells[w->kinds[i]]++;
    return done && !w->out_of_memory && !w->is_stopped;
}
