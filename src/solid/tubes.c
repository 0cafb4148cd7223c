/* SPDX-License-Identifier: MIT
 * A ball swept over a flat polygon, or along a polyline, Bezier curves or a Catmull-Rom curve, its
 * radius changing with the parameter. A polyline is a union of capsules, a curve one of the scene's
 * tubes along Bezier curves (scene/primitives/curve.h), both exactly.
 */
#include <math.h>
#include <string.h>

#include "scene/primitives/curve.h"
#include "scene/primitives/kinds.h"
#include "solid/operations.h"

typedef struct skeleton {
    csg_solid_job *job;
    const csg_knot *knots; /* as given */
    size_t count;
    csg_node_id *parts;
    size_t part_count, part_capacity;
    csg_knot last; /* where the next capsule begins */
    bool ok;
} skeleton;

static csg_knot mix(csg_knot a, csg_knot b, double t)
{
    return (csg_knot){csg_vec3_add(csg_vec3_scale(a.at, 1 - t), csg_vec3_scale(b.at, t)),
                      a.radius * (1 - t) + b.radius * t};
}

static void add_part(skeleton *s, csg_node_id node)
{
    csg_solid_job *job = s->job;
    node = csg_solid_done(s->job, node);
    s->ok = node != CSG_NODE_NONE;
    if (s->ok && !csg_memory_reserve(job->memory, (void **)&s->parts, &s->part_capacity,
                                     s->part_count + 1, sizeof node)) {
        csg_solid_no_memory(job);
        s->ok = false;
    }
    if (s->ok)
        s->parts[s->part_count++] = node;
}

/* A capsule from where the last one ended. */
static void line_to(skeleton *s, csg_knot to)
{
    csg_solid_job *job = s->job;
    csg_span where = s->job->where;
    s->ok = s->ok && csg_solid_charge(job, 10);
    if (s->ok)
        add_part(s, csg_build_capsule(job->builder, s->last.at, to.at, s->last.radius, to.radius,
                                      where));
    s->last = to;
}

/* Whether it runs straight and evenly from end to end, so that it is a capsule. */
static bool is_straight(const csg_knot *c, int degree)
{
    double size = csg_vec3_norm(csg_vec3_sub(c[degree].at, c[0].at)) + c[0].radius;
    for (int i = 0; i + 2 <= degree; i++) {
        csg_knot middle = mix(c[i], c[i + 2], 0.5);
        if (csg_vec3_norm(csg_vec3_sub(middle.at, c[i + 1].at)) > 1e-13 * size ||
            fabs(middle.radius - c[i + 1].radius) > 1e-13 * size)
            return false;
    }
    return true;
}

/* Control points, the first of which is where the last curve ended. */
static void curve_to(skeleton *s, const csg_knot *c, int degree)
{
    csg_solid_job *job = s->job;
    csg_span where = s->job->where;
    double largest = 0, v[CSG_CURVE_MOST * CSG_CURVE_AXES];
    for (int i = 0; i <= degree; i++) {
        const double of[] = {c[i].at.x, c[i].at.y, c[i].at.z, c[i].radius};
        memcpy(v + CSG_CURVE_AXES * i, of, sizeof of);
        largest = fmax(largest, c[i].radius);
    }
    if (largest == 0 || is_straight(c, degree)) { /* no radius: what makes that of a line */
        line_to(s, c[degree]);
        return;
    }
    s->ok = s->ok && csg_solid_charge(job, 10);
    csg_primitive_kind kind = degree == 2 ? CSG_NODE_QUADRATIC_TUBE : CSG_NODE_CUBIC_TUBE;
    if (s->ok)
        add_part(s, csg_build_primitive(job->builder, kind, v, where));
    s->last = c[degree];
}

/* ---- the kinds of curves --------------------------------------------------------------------- */

static void add_polyline(skeleton *s)
{
    for (size_t i = 1; i < s->count; i++)
        line_to(s, s->knots[i]);
}

static void add_curves(skeleton *s, int degree)
{
    for (size_t i = 0; i + (size_t)degree < s->count; i += (size_t)degree)
        curve_to(s, &s->knots[i], degree);
}

/* Catmull-Rom: through all knots, tangents parallel to the chord of the neighbours. */
static void add_catmull_rom(skeleton *s, bool closed)
{
    size_t n = s->count, pieces = closed ? n : n - 1;
    for (size_t i = 0; i < pieces; i++) {
        csg_knot b = s->knots[i], c = s->knots[(i + 1) % n];
        csg_knot a = i > 0 ? s->knots[i - 1] : closed ? s->knots[n - 1] : mix(b, c, -1);
        csg_knot d = i + 2 < n ? s->knots[i + 2] : closed ? s->knots[(i + 2) % n] : mix(c, b, -1);
        csg_knot after = {csg_vec3_add(b.at, csg_vec3_scale(csg_vec3_sub(c.at, a.at), 1.0 / 6)),
                          fmax(b.radius + (c.radius - a.radius) / 6, 0)};
        csg_knot before = {csg_vec3_sub(c.at, csg_vec3_scale(csg_vec3_sub(d.at, b.at), 1.0 / 6)),
                           fmax(c.radius - (d.radius - b.radius) / 6, 0)};
        curve_to(s, (csg_knot[]){b, after, before, c}, 3);
    }
}

/* ---- tubes ----------------------------------------------------------------------------------- */

static csg_node_id unite_parts(skeleton *s)
{
    csg_solid_job *job = s->job;
    csg_node_id node =
        s->ok && !job->stop ? csg_solid_union(job, s->parts, s->part_count) : CSG_NODE_NONE;
    csg_memory_release(job->memory, s->parts, s->part_capacity * sizeof *s->parts);
    return node;
}

csg_node_id csg_solid_tube(csg_solid_job *job, const csg_knot *knots, size_t count, int degree)
{
    skeleton s = {.job = job, .knots = knots, .count = count, .last = knots[0], .ok = true};
    if (degree == 1)
        add_polyline(&s);
    else
        add_curves(&s, degree);
    return unite_parts(&s);
}

csg_node_id csg_solid_spline(csg_solid_job *job, const csg_knot *knots, size_t count, bool closed)
{
    skeleton s = {.job = job, .knots = knots, .count = count, .last = knots[0], .ok = true};
    add_catmull_rom(&s, closed);
    return unite_parts(&s);
}

csg_node_id csg_solid_capsules(csg_solid_job *job, csg_primitive_kind kind,
                               const double *parameters)
{
    const double tolerance = 1e-4, most = 1e5; /* of the largest radius */
    csg_curve curve = csg_curve_make(kind, parameters);
    double largest = 0, at[CSG_CURVE_AXES];
    for (int i = 0; i <= curve.degree; i++)
        largest = fmax(largest, curve.at[i][CSG_CURVE_RADIUS]);
    uint32_t chords = (uint32_t)fmin(csg_curve_chords(&curve, tolerance * largest), most);
    skeleton s = {.job = job, .ok = true};
    for (uint32_t i = 0; i <= chords && s.ok; i++) {
        csg_curve_at(&curve, (double)i / chords, at);
        csg_knot to = {csg_vec3_make(at[0], at[1], at[2]), at[CSG_CURVE_RADIUS]};
        if (i == 0)
            s.last = to;
        else
            line_to(&s, to);
    }
    return unite_parts(&s);
}

/* An extrusion by next to nothing is the distance from the polygon; grown by r it is the skeletal
 * primitive of operators.md 1.1, but for that thickness at the rim. */
csg_node_id csg_solid_sheet(csg_solid_job *job, csg_outline *outline, const csg_affine *frame,
                            double r)
{
    double half = CSG_SHEET_HALF * r;
    csg_node_id node = csg_solid_area(job, outline, true);
    if (node == CSG_NODE_NONE || job->stop)
        return CSG_NODE_NONE;
    node = csg_solid_done(job, csg_build_extrude(job->builder, node, -half, half, job->where));
    if (node != CSG_NODE_NONE)
        node = csg_solid_grown(job, node, r - half);
    return csg_solid_moved(job, node, frame);
}
