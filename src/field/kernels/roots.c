/* SPDX-License-Identifier: MIT
 * The Illinois variant of regula falsi (Dowell and Jarratt 1971) on many edges at once. The end
 * that was kept twice has its value halved; lanes that are done stay as they are.
 */
#include "field/kernels/roots.h"

#include <math.h>

/* Every fourth step halves the bracket: where the field has a kink close to one end, the secant
 * alone creeps. Hardly an edge gets that far. */
enum { MOST_STEPS = 32, BISECTION_EVERY = 4 };

static size_t padded(uint32_t count)
{
    return (count + CSG_LANES - 1) / CSG_LANES * CSG_LANES;
}

/* Copies the first edge into the unused lanes, so that they hold numbers. */
static void pad(csg_edges *e)
{
    for (size_t i = e->count; i < padded(e->count); i++) {
        e->ax[i] = e->ax[0], e->ay[i] = e->ay[0], e->az[i] = e->az[0];
        e->dx[i] = e->dx[0], e->dy[i] = e->dy[0], e->dz[i] = e->dz[0];
    }
}

static void place(csg_edges *e)
{
    size_t n = padded(e->count);
    for (size_t i = 0; i < n; i++) {
        e->x[i] = e->ax[i] + e->t[i] * e->dx[i];
        e->y[i] = e->ay[i] + e->t[i] * e->dy[i];
        e->z[i] = e->az[i] + e->t[i] * e->dz[i];
    }
}

static void evaluate(csg_edges *e, const csg_tape *tape, float *out, float *scratch,
                     size_t scratch_floats)
{
    place(e);
    CSG_THIS_KERNEL.values(tape, e->x, e->y, e->z, e->count, out, scratch, scratch_floats);
}

/* Whether the edge's root is still looked for. */
static bool is_live(const csg_edges *e, size_t i)
{
    return fabsf(e->f[i]) > e->tolerance[i];
}

static size_t count_live(const csg_edges *e)
{
    uint32_t live = 0;
    for (size_t i = 0; i < e->count; i++)
        live += is_live(e, i);
    return live;
}

/* The values of live edges; where few are left these alone are asked, and the others' stay what
 * they are. Returns how many were asked. */
static size_t evaluate_live(csg_edges *e, const csg_tape *tape, float *scratch,
                            size_t scratch_floats)
{
    uint16_t which[CSG_BLOCK_MOST_EDGES];
    float f[CSG_BLOCK_MOST_EDGES];
    size_t n = 0;
    if (count_live(e) > e->count / 2) {
        evaluate(e, tape, e->f, scratch, scratch_floats);
        return e->count;
    }
    place(e);
    for (size_t i = 0; i < e->count; i++) {
        e->x[n] = e->x[i], e->y[n] = e->y[i], e->z[n] = e->z[i];
        which[n] = (uint16_t)i;
        n += is_live(e, i);
    }
    for (size_t i = n; i % CSG_LANES; i++)
        e->x[i] = e->x[0], e->y[i] = e->y[0], e->z[i] = e->z[0];
    CSG_THIS_KERNEL.values(tape, e->x, e->y, e->z, n, f, scratch, scratch_floats);
    for (size_t i = 0; i < n; i++)
        e->f[which[i]] = f[i];
    return n;
}

static void set_all(float *array, size_t count, float value)
{
    for (size_t i = 0; i < count; i++)
        array[i] = value;
}

static uint64_t evaluate_ends(csg_edges *e, const csg_tape *tape, float *scratch,
                              size_t scratch_floats)
{
    size_t n = padded(e->count);
    set_all(e->t, n, 0);
    evaluate(e, tape, e->fa, scratch, scratch_floats);
    set_all(e->t, n, 1);
    evaluate(e, tape, e->fb, scratch, scratch_floats);
    return 2 * (uint64_t)e->count;
}

/* A value is small against the field's change along the edge, whatever its slope: the place is then
 * known to 2^-14 of the edge, which nobody sees. Below the noise of rounding nothing is gained. */
static void set_tolerances(csg_edges *e, float noise)
{
    size_t n = padded(e->count);
    for (size_t i = 0; i < n; i++) {
        float small = 0x1p-14f * fabsf(e->fb[i] - e->fa[i]);
        e->tolerance[i] = small > noise ? small : noise;
    }
}

/* The secant's zero, or the middle where rounding has put it outside the bracket. */
static void propose(csg_edges *e, bool bisect)
{
    size_t n = padded(e->count);
    for (size_t i = 0; i < n; i++) {
        float width = e->tb[i] - e->ta[i];
        float secant = e->ta[i] + width * (e->fa[i] / (e->fa[i] - e->fb[i]));
        bool within = !bisect & (secant > e->ta[i]) & (secant < e->tb[i]);
        float t = within ? secant : e->ta[i] + 0.5f * width;
        e->t[i] = fabsf(e->f[i]) > e->tolerance[i] ? t : e->t[i];
    }
}

/* Shrinks the brackets around the new value; returns whether some lane is not done. */
static bool shrink(csg_edges *e)
{
    size_t n = padded(e->count);
    float open = 0;
    for (size_t i = 0; i < n; i++) {
        bool live = fabsf(e->f[i]) > e->tolerance[i];
        bool with_a = (e->f[i] >= 0) == (e->fa[i] >= 0);
        bool move_a = live & with_a, move_b = live & !with_a;
        bool halve_a = move_b & (e->moved[i] > 0), halve_b = move_a & (e->moved[i] < 0);
        float fa = halve_a ? 0.5f * e->fa[i] : e->fa[i];
        float fb = halve_b ? 0.5f * e->fb[i] : e->fb[i];
        e->fa[i] = move_a ? e->f[i] : fa;
        e->fb[i] = move_b ? e->f[i] : fb;
        e->ta[i] = move_a ? e->t[i] : e->ta[i];
        e->tb[i] = move_b ? e->t[i] : e->tb[i];
        e->moved[i] = move_a ? -1.0f : move_b ? 1.0f : e->moved[i];
        open = live ? 1.0f : open;
    }
    return open > 0;
}

uint64_t CSG_THIS_ROOTS(const csg_tape *tape, csg_edges *e, float noise, float *scratch,
                        size_t scratch_floats)
{
    if (!e->count)
        return 0;
    size_t n = padded(e->count);
    uint64_t evaluations = 0;
    pad(e);
    set_all(e->ta, n, 0);
    set_all(e->tb, n, 1);
    if (!e->has_ends)
        evaluations += evaluate_ends(e, tape, scratch, scratch_floats);
    for (size_t i = e->count; i < n; i++)
        e->fa[i] = e->fa[0], e->fb[i] = e->fb[0];
    set_tolerances(e, noise);
    set_all(e->moved, n, 0);
    set_all(e->f, n, INFINITY); /* no lane is done */
    for (int step = 0; step < MOST_STEPS; step++) {
        propose(e, step % BISECTION_EVERY == BISECTION_EVERY - 1);
        evaluations += evaluate_live(e, tape, scratch, scratch_floats);
        for (size_t i = e->count; i < n; i++)
            e->f[i] = 0;
        if (!shrink(e))
            break;
    }
    for (size_t i = 0; i < n; i++) {
        float t = e->t[i];
        t = t > e->end_distance ? t : e->end_distance;
        e->t[i] = t < 1 - e->end_distance ? t : 1 - e->end_distance;
    }
    place(e);
    return evaluations;
}
