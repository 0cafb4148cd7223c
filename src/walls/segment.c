/* SPDX-License-Identifier: MIT
 * Segments across; see segment.h. `turn` times the field is positive in what is beyond: outside of
 * a wall, inside beside a gap. A segment runs where that is negative: along it the field's
 * Lipschitz constant says how far at each step. Its ends are moved into what is beyond until the
 * tape's interval proves them to be there, so that the surface is crossed between them.
 */
#include "walls/segment.h"

#include <float.h>
#include <math.h>

enum { STEPS = 12, MARCH = 160, SLIDES = 40, PUSHES = 10, HALVINGS = 40 };

/* A point on the surface, with the normal of what is beyond: into the wall, or gap. */
typedef struct foot {
    csg_vec3 at, normal;
} foot;

static double look_at(const csg_wall_side *s, csg_vec3 at, csg_vec3 *gradient)
{
    const csg_measure_walk *w = s->walk;
    float x[3][CSG_LANES], f[CSG_LANES], g[3][CSG_LANES], p[3];
    csg_vec3_to_floats(p, at);
    for (int axis = 0; axis < 3; axis++)
        for (int i = 0; i < CSG_LANES; i++)
            x[axis][i] = p[axis];
    w->kernel->values_and_gradients(&w->field->tape, x[0], x[1], x[2], 1, f, g[0], g[1], g[2],
                                    s->worker->scratch, w->scratch_floats);
    *gradient = csg_vec3_make((double)g[0][0], (double)g[1][0], (double)g[2][0]);
    return (double)f[0];
}

csg_cell_state csg_wall_state_at(csg_wall_side *s, csg_vec3 at, double radius)
{
    csg_pruner *pruner = &s->worker->pruner;
    float center[3];
    csg_vec3_to_floats(center, at);
    double moved = csg_vec3_norm(csg_vec3_sub(csg_vec3_from_floats(center), at));
    if (!csg_prune_cube(pruner, &s->walk->field->tape, center,
                        (float)((radius + moved) * (1 + 1e-6)))) {
        *s->out_of_memory = true;
        return CSG_CELL_SURFACE;
    }
    return csg_prune_state(pruner, 0);
}

static double rounding_of(const csg_wall_side *s)
{
    return (double)s->worker->pruner.rounding;
}

/* How near the surface a point has to be to be on it. */
static double closeness_of(const csg_wall_side *s)
{
    return fmax(s->tolerance / 64, 2 * rounding_of(s));
}

/* By Newton's steps. False: it does not get there. */
static bool settle(const csg_wall_side *s, csg_vec3 near, foot *out)
{
    csg_vec3 at = near, g;
    for (int step = 0; step < STEPS; step++) {
        double f = look_at(s, at, &g), steep = csg_vec3_dot(g, g);
        if (!(steep > 1e-12) || !isfinite(f))
            return false;
        if (fabs(f) <= closeness_of(s) * sqrt(steep)) {
            *out = (foot){at, csg_vec3_scale(g, -s->turn / sqrt(steep))};
            return true;
        }
        at = csg_vec3_sub(at, csg_vec3_scale(g, f / steep));
    }
    return false;
}

/* How far the segment from p along d runs until it meets the other side; INFINITY: farther than
 * `most`, or it did not leave. */
static double march(const csg_wall_side *s, csg_vec3 p, csg_vec3 d, double most)
{
    const csg_tape *tape = &s->walk->field->tape;
    double slack = rounding_of(s) * (double)tape->steepest + (double)tape->waver;
    double least = closeness_of(s), before = 0, t = 3 * least;
    csg_vec3 ignored;
    for (int step = 0; step < MARCH && t <= most; step++) {
        double f = -s->turn * look_at(s, csg_vec3_add(p, csg_vec3_scale(d, t)), &ignored);
        if (!isfinite(f) || (f <= 0 && step == 0))
            return INFINITY;
        if (f <= 0)
            break;
        before = t;
        t += fmax((f - slack) / fmax((double)tape->lipschitz, 1e-12), least);
    }
    if (!(t <= most) || !(before > 0))
        return INFINITY;
    double low = before, high = t;
    for (int i = 0; i < HALVINGS; i++) {
        double middle = 0.5 * (low + high);
        bool is_across =
            -s->turn * look_at(s, csg_vec3_add(p, csg_vec3_scale(d, middle)), &ignored) > 0;
        *(is_across ? &low : &high) = middle;
    }
    return high;
}

/* The first of ever farther points along d that is beyond for certain. */
static bool push_beyond(csg_wall_side *s, csg_vec3 at, csg_vec3 d, csg_vec3 *out)
{
    csg_cell_state beyond = s->turn > 0 ? CSG_CELL_INSIDE : CSG_CELL_OUTSIDE;
    double by = 0;
    for (int i = 0; i < PUSHES; i++) {
        *out = csg_vec3_add(at, csg_vec3_scale(d, by));
        if (csg_wall_state_at(s, *out, 0) == beyond)
            return true;
        by = by > 0 ? 2 * by : 0.25 * rounding_of(s);
        if (by > s->tolerance + 8 * rounding_of(s))
            return false;
    }
    return false;
}

/* ---- normals -----------------------------------------------------------------------------------
 */

static bool is_along(csg_vec3 normal, csg_vec3 d, csg_wall_angle angle)
{
    return csg_vec3_dot(normal, d) >= angle.cosine;
}

/* Whether the surface at the foot looks along d: by its own normal, or, where faces meet within a
 * part of the tolerance, by one between theirs. */
static bool looks_along(const csg_wall_side *s, const foot *p, csg_vec3 d, csg_wall_angle angle)
{
    enum { AROUND = 6 };
    csg_wall_cap caps[AROUND + 1];
    csg_wall_normals near = {.caps = caps};
    double by = 0.5 * s->tolerance;
    if (is_along(p->normal, d, angle))
        return true;
    for (int i = 0; i <= AROUND; i++) {
        foot q = *p;
        double step[3] = {0, 0, 0};
        if (i < AROUND)
            step[i / 2] = i % 2 ? by : -by;
        csg_vec3 from = csg_vec3_add(p->at, csg_vec3_make(step[0], step[1], step[2]));
        if (i < AROUND && !settle(s, from, &q))
            continue;
        if (csg_vec3_norm(csg_vec3_sub(q.at, p->at)) <= 2 * by)
            caps[near.count++] = (csg_wall_cap){{q.normal.x, q.normal.y, q.normal.z}, 0};
    }
    return csg_wall_has_near(&near, d, angle);
}

/* ---- what is shown -----------------------------------------------------------------------------
 */

/* The segment between the two, if it is shorter and all is as it should be. */
static void take(csg_wall_side *s, const foot *p, const foot *q, csg_wall_shown *best)
{
    csg_vec3 between = csg_vec3_sub(q->at, p->at), ends[2];
    double length = csg_vec3_norm(between);
    if (!(length < best->apart && length > 8 * closeness_of(s)))
        return;
    csg_vec3 d = csg_vec3_scale(between, 1 / length), back = csg_vec3_scale(d, -1);
    const csg_wall_angles *a = &s->angles;
    if (!(looks_along(s, p, d, a->one) && looks_along(s, q, back, a->other)) &&
        !(looks_along(s, p, d, a->other) && looks_along(s, q, back, a->one)))
        return;
    double reached = march(s, p->at, d, length + 4 * closeness_of(s));
    if (!(fabs(reached - length) <= 4 * closeness_of(s)))
        return;
    if (!push_beyond(s, p->at, back, &ends[0]) || !push_beyond(s, q->at, d, &ends[1]))
        return;
    double apart = csg_vec3_norm(csg_vec3_sub(ends[1], ends[0])) * (1 + 1e-12);
    if (apart < best->apart)
        *best = (csg_wall_shown){{ends[0], ends[1]}, apart};
}

/* Roughly. */
static bool is_facing(const csg_wall_side *s, const foot *p, const foot *q)
{
    csg_vec3 d = csg_vec3_normalize(csg_vec3_sub(q->at, p->at));
    return is_along(p->normal, d, s->angles.other) &&
           is_along(q->normal, csg_vec3_scale(d, -1), s->angles.other);
}

/* The part of v along the surface at p. */
static csg_vec3 along_surface(csg_vec3 v, const foot *p)
{
    return csg_vec3_sub(v, csg_vec3_scale(p->normal, csg_vec3_dot(v, p->normal)));
}

/* Both slide along the surface to where they are nearer, while they face each other, or until they
 * do. */
static void slide(const csg_wall_side *s, foot *p, foot *q)
{
    double share = 0.5;
    for (int i = 0; i < SLIDES && share > 1.0 / 256; i++) {
        csg_vec3 between = csg_vec3_sub(q->at, p->at);
        csg_vec3 to_p = along_surface(between, p), to_q = along_surface(between, q);
        foot next_p, next_q;
        if (csg_vec3_norm(to_p) + csg_vec3_norm(to_q) < closeness_of(s))
            return;
        bool better = settle(s, csg_vec3_add(p->at, csg_vec3_scale(to_p, share)), &next_p) &&
                      settle(s, csg_vec3_sub(q->at, csg_vec3_scale(to_q, share)), &next_q) &&
                      csg_vec3_norm(csg_vec3_sub(next_q.at, next_p.at)) < csg_vec3_norm(between) &&
                      (!is_facing(s, p, q) || is_facing(s, &next_p, &next_q));
        share = better ? fmin(1.5 * share, 1) : 0.5 * share;
        if (better) {
            *p = next_p;
            *q = next_q;
        }
    }
}

/* Straight across from p. */
static bool cross(csg_wall_side *s, const foot *p, csg_wall_shown *best, foot *q)
{
    double farthest = best->apart < INFINITY ? 2 * best->apart : 4 * s->walk->half;
    double length = march(s, p->at, p->normal, farthest);
    if (!(length < INFINITY) ||
        !settle(s, csg_vec3_add(p->at, csg_vec3_scale(p->normal, length)), q))
        return false;
    take(s, p, q, best);
    return true;
}

/* Where both have slid to, and straight across from there. */
static void improve(csg_wall_side *s, foot p, foot q, csg_wall_shown *best)
{
    foot ignored;
    slide(s, &p, &q);
    take(s, &p, &q, best);
    cross(s, &p, best, &ignored);
    cross(s, &q, best, &ignored);
}

void csg_wall_show_from(csg_wall_side *s, csg_vec3 near, csg_wall_shown *best)
{
    foot p, q;
    if (settle(s, near, &p) && cross(s, &p, best, &q))
        improve(s, p, q, best);
}

void csg_wall_show_between(csg_wall_side *s, csg_vec3 near, csg_vec3 other, csg_wall_shown *best)
{
    foot p, q;
    if (!settle(s, near, &p) || !settle(s, other, &q))
        return;
    take(s, &p, &q, best);
    improve(s, p, q, best);
}
