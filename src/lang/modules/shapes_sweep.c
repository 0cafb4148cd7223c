/* SPDX-License-Identifier: MIT
 * tube and spline: a ball swept along a polyline, Bezier curves or a Catmull-Rom curve, its radius
 * changing with the parameter. A polyline is a union of capsules, a curve one of the scene's tubes
 * along Bezier curves (scene/primitives/curve.h), both exactly.
 */
#include <math.h>
#include <string.h>

#include "lang/modules/shapes.h"
#include "scene/primitives/curve.h"

typedef struct knot { /* of a skeleton */
    csg_vec3 at;
    double radius;
} knot;

typedef struct skeleton {
    csg_module_call *call;
    knot *knots; /* as given */
    size_t count;
    csg_node_id *parts;
    size_t part_count, part_capacity;
    knot last; /* where the next capsule begins */
    bool ok;
} skeleton;

static knot mix(knot a, knot b, double t)
{
    return (knot){csg_vec3_add(csg_vec3_scale(a.at, 1 - t), csg_vec3_scale(b.at, t)),
                  a.radius * (1 - t) + b.radius * t};
}

static void add(skeleton *s, csg_node_id node)
{
    csg_eval *e = s->call->e;
    node = csg_shape_done(s->call, node);
    s->ok = node != CSG_NODE_NONE;
    if (s->ok && !csg_memory_reserve(e->heap.memory, (void **)&s->parts, &s->part_capacity,
                                     s->part_count + 1, sizeof node)) {
        csg_eval_no_memory(e);
        s->ok = false;
    }
    if (s->ok)
        s->parts[s->part_count++] = node;
}

/* A capsule from where the last one ended. */
static void line_to(skeleton *s, knot to)
{
    csg_eval *e = s->call->e;
    csg_span where = s->call->statement->where;
    s->ok = s->ok && csg_eval_charge(e, 10, where);
    if (s->ok)
        add(s, csg_build_capsule(&e->builder, s->last.at, to.at, s->last.radius, to.radius, where));
    s->last = to;
}

/* Whether it runs straight and evenly from end to end, so that it is a capsule. */
static bool is_straight(const knot *c, int degree)
{
    double size = csg_vec3_norm(csg_vec3_sub(c[degree].at, c[0].at)) + c[0].radius;
    for (int i = 0; i + 2 <= degree; i++) {
        knot middle = mix(c[i], c[i + 2], 0.5);
        if (csg_vec3_norm(csg_vec3_sub(middle.at, c[i + 1].at)) > 1e-13 * size ||
            fabs(middle.radius - c[i + 1].radius) > 1e-13 * size)
            return false;
    }
    return true;
}

/* Control points, the first of which is where the last curve ended. */
static void curve_to(skeleton *s, const knot *c, int degree)
{
    csg_eval *e = s->call->e;
    csg_span where = s->call->statement->where;
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
    s->ok = s->ok && csg_eval_charge(e, 10, where);
    csg_node_kind kind = degree == 2 ? CSG_NODE_QUADRATIC_TUBE : CSG_NODE_CUBIC_TUBE;
    if (s->ok)
        add(s, csg_build_primitive(&e->builder, kind, v, where));
    s->last = c[degree];
}

/* ---- the kinds of curves --------------------------------------------------------------------- */

static void polyline(skeleton *s)
{
    for (size_t i = 1; i < s->count; i++)
        line_to(s, s->knots[i]);
}

static void curves(skeleton *s, int degree)
{
    for (size_t i = 0; i + (size_t)degree < s->count; i += (size_t)degree)
        curve_to(s, &s->knots[i], degree);
}

/* Catmull-Rom: through all knots, tangents parallel to the chord of the neighbours. */
static void catmull_rom(skeleton *s, bool closed)
{
    size_t n = s->count, pieces = closed ? n : n - 1;
    for (size_t i = 0; i < pieces; i++) {
        knot b = s->knots[i], c = s->knots[(i + 1) % n];
        knot a = i > 0 ? s->knots[i - 1] : closed ? s->knots[n - 1] : mix(b, c, -1);
        knot d = i + 2 < n ? s->knots[i + 2] : closed ? s->knots[(i + 2) % n] : mix(c, b, -1);
        knot after = {csg_vec3_add(b.at, csg_vec3_scale(csg_vec3_sub(c.at, a.at), 1.0 / 6)),
                      fmax(b.radius + (c.radius - a.radius) / 6, 0)};
        knot before = {csg_vec3_sub(c.at, csg_vec3_scale(csg_vec3_sub(d.at, b.at), 1.0 / 6)),
                       fmax(c.radius - (d.radius - b.radius) / 6, 0)};
        curve_to(s, (knot[]){b, after, before, c}, 3);
    }
}

/* ---- arguments ------------------------------------------------------------------------------- */

static void read_radii(csg_module_call *call, uint32_t index, skeleton *s)
{
    csg_value value = call->values[index];
    if (value.kind != CSG_VALUE_VECTOR) {
        double r = csg_argument_number(call, index, 1, CSG_POSITIVE);
        for (size_t i = 0; i < s->count; i++)
            s->knots[i].radius = r;
        return;
    }
    if (value.as.vector->count != s->count) {
        csg_argument_error(call, index, CSG_DIAG_BAD_POINTS, "%u radii for %zu points",
                           value.as.vector->count, s->count);
        return;
    }
    for (uint32_t i = 0; i < s->count; i++) {
        csg_value r = value.as.vector->items[i];
        bool sound = r.kind == CSG_VALUE_NUMBER && isfinite(r.as.number) && r.as.number >= 0;
        if (!sound)
            csg_argument_error(call, index, CSG_DIAG_BAD_POINTS, "r[%u] is not a number above 0",
                               i);
        s->knots[i].radius = sound ? r.as.number : 1;
    }
}

/* Points and radii; false after a report, or when memory ran out. */
static bool read_knots(csg_module_call *call, uint32_t points, uint32_t radii, skeleton *s)
{
    csg_value value = call->values[points];
    if (value.kind != CSG_VALUE_VECTOR || value.as.vector->count < 2) {
        csg_argument_error(call, points, CSG_DIAG_BAD_TYPE,
                           "points must be a list of at least two [x, y, z]");
        return false;
    }
    size_t count = value.as.vector->count;
    s->knots = csg_memory_alloc(call->e->heap.memory, count * sizeof *s->knots);
    if (!s->knots) {
        csg_eval_no_memory(call->e);
        return false;
    }
    s->count = count;
    for (uint32_t i = 0; i < count; i++) {
        double v[3] = {0, 0, 0};
        bool known = csg_value_numbers(value.as.vector->items[i], 3, v) ||
                     csg_value_numbers(value.as.vector->items[i], 2, v);
        if (!known || !isfinite(v[0]) || !isfinite(v[1]) || !isfinite(v[2]))
            csg_argument_error(call, points, CSG_DIAG_BAD_POINTS, "points[%u] is not [x, y, z]", i);
        s->knots[i] = (knot){csg_vec3_make(v[0], v[1], v[2]), 1};
    }
    read_radii(call, radii, s);
    return !call->failed;
}

static void begin(skeleton *s)
{
    double largest = 0;
    for (size_t i = 0; i < s->count; i++)
        largest = fmax(largest, s->knots[i].radius);
    s->last = s->knots[0];
    s->ok = largest > 0;
    if (!s->ok)
        csg_argument_error(s->call, 1, CSG_DIAG_OUT_OF_RANGE, "all radii are 0");
}

static csg_node_id finish(skeleton *s)
{
    csg_eval *e = s->call->e;
    csg_node_id node = CSG_NODE_NONE;
    if (s->call->failed)
        node = csg_shape_empty(s->call);
    else if (s->ok && !e->stop)
        node =
            csg_shape_done(s->call, csg_build_operator(&e->builder, CSG_NODE_UNION,
                                                       (csg_blend){CSG_BLEND_SHARP, 0}, s->parts,
                                                       s->part_count, s->call->statement->where));
    csg_memory_release(e->heap.memory, s->knots, s->count * sizeof *s->knots);
    csg_memory_release(e->heap.memory, s->parts, s->part_capacity * sizeof *s->parts);
    return node;
}

csg_node_id csg_module_tube(csg_module_call *call)
{
    enum { POINTS, RADIUS, DEGREE };
    skeleton s = {.call = call};
    bool known = read_knots(call, POINTS, RADIUS, &s);
    double degree = csg_argument_number(call, DEGREE, 1, CSG_POSITIVE);
    if (known && degree != 1 && degree != 2 && degree != 3)
        csg_argument_error(call, DEGREE, CSG_DIAG_OUT_OF_RANGE, "degree is %g", degree);
    if (known && !call->failed && (s.count - 1) % (size_t)degree != 0)
        csg_argument_error(call, POINTS, CSG_DIAG_BAD_POINTS,
                           "curves of degree %g share their ends: 1 + %g n points, not %zu", degree,
                           degree, s.count);
    if (!known || call->failed)
        return finish(&s);
    begin(&s);
    if (degree == 1)
        polyline(&s);
    else
        curves(&s, (int)degree);
    return finish(&s);
}

csg_node_id csg_module_spline(csg_module_call *call)
{
    enum { POINTS, RADIUS, CLOSED };
    skeleton s = {.call = call};
    if (!read_knots(call, POINTS, RADIUS, &s))
        return finish(&s);
    begin(&s);
    if (s.ok)
        catmull_rom(&s, csg_argument_boolean(call, CLOSED));
    return finish(&s);
}

csg_node_id csg_shape_capsules(csg_module_call *call, csg_node_kind kind, const double *parameters)
{
    const double tolerance = 1e-4, most = 1e5; /* of the largest radius */
    csg_curve curve = csg_curve_make(kind, parameters);
    double largest = 0, at[CSG_CURVE_AXES];
    for (int i = 0; i <= curve.degree; i++)
        largest = fmax(largest, curve.at[i][CSG_CURVE_RADIUS]);
    uint32_t chords = (uint32_t)fmin(csg_curve_chords(&curve, tolerance * largest), most);
    skeleton s = {.call = call, .ok = true};
    for (uint32_t i = 0; i <= chords && s.ok; i++) {
        csg_curve_at(&curve, (double)i / chords, at);
        knot to = {csg_vec3_make(at[0], at[1], at[2]), at[CSG_CURVE_RADIUS]};
        if (i == 0)
            s.last = to;
        else
            line_to(&s, to);
    }
    return finish(&s);
}
