/* SPDX-License-Identifier: MIT
 * tube and spline: points and radii (solid/tubes.c has the rest).
 */
#include <math.h>

#include "base/scene_codes.h"
#include "lang/modules/shapes.h"
#include "solid/operations.h"

typedef struct knot_list {
    csg_knot *knots;
    size_t count;
} knot_list;

static void read_radii(csg_module_call *call, uint32_t index, knot_list *s)
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
static bool read_knots(csg_module_call *call, uint32_t points, uint32_t radii, knot_list *s)
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
        s->knots[i] = (csg_knot){csg_vec3_make(v[0], v[1], v[2]), 1};
    }
    read_radii(call, radii, s);
    return !call->failed;
}

/* Are there balls at all? Reports. */
static bool has_radius(csg_module_call *call, const knot_list *s)
{
    double largest = 0;
    for (size_t i = 0; i < s->count; i++)
        largest = fmax(largest, s->knots[i].radius);
    if (!(largest > 0))
        csg_argument_error(call, 1, CSG_DIAG_OUT_OF_RANGE, "all radii are 0");
    return largest > 0;
}

static void release_knots(csg_module_call *call, knot_list *s)
{
    csg_memory_release(call->e->heap.memory, s->knots, s->count * sizeof *s->knots);
}

csg_node_id csg_module_tube(csg_module_call *call)
{
    enum { POINTS, RADIUS, DEGREE };
    knot_list s = {0};
    csg_node_id node = CSG_NODE_NONE;
    bool known = read_knots(call, POINTS, RADIUS, &s);
    double degree = csg_argument_number(call, DEGREE, 1, CSG_POSITIVE);
    if (known && degree != 1 && degree != 2 && degree != 3)
        csg_argument_error(call, DEGREE, CSG_DIAG_OUT_OF_RANGE, "degree is %g", degree);
    if (known && !call->failed && (s.count - 1) % (size_t)degree != 0)
        csg_argument_error(call, POINTS, CSG_DIAG_BAD_POINTS,
                           "curves of degree %g share their ends: 1 + %g n points, not %zu", degree,
                           degree, s.count);
    if (known && !call->failed && has_radius(call, &s)) {
        csg_solid_job job = csg_shape_job(call);
        node = csg_shape_made(call, &job, csg_solid_tube(&job, s.knots, s.count, (int)degree));
    }
    release_knots(call, &s);
    return call->failed ? csg_shape_empty(call) : node;
}

csg_node_id csg_module_spline(csg_module_call *call)
{
    enum { POINTS, RADIUS, CLOSED };
    knot_list s = {0};
    csg_node_id node = CSG_NODE_NONE;
    if (read_knots(call, POINTS, RADIUS, &s) && has_radius(call, &s)) {
        bool closed = csg_argument_boolean(call, CLOSED);
        csg_solid_job job = csg_shape_job(call);
        node = csg_shape_made(call, &job, csg_solid_spline(&job, s.knots, s.count, closed));
    }
    release_knots(call, &s);
    return call->failed ? csg_shape_empty(call) : node;
}
