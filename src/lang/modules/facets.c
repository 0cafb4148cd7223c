/* SPDX-License-Identifier: MIT
 * $fn, $fa and $fs: circles, frusta and balls as the polygons and polyhedra that OpenSCAD makes of
 * them. A circle's first corner lies at angle 0; a ball's rings lie at half steps between its
 * poles.
 */
#include <math.h>
#include <string.h>

#include "lang/modules/shapes.h"

double csg_special_number(const csg_eval *e, const char *name, double otherwise)
{
    csg_symbol symbol = csg_symbol_intern(&e->program->symbols, name, strlen(name));
    csg_value value = csg_eval_dynamic(e, symbol);
    return value.kind == CSG_VALUE_NUMBER && isfinite(value.as.number) ? value.as.number
                                                                       : otherwise;
}

bool csg_facets_are_exact(const csg_eval *e)
{
    return e->program->exact_facets;
}

uint32_t csg_fragments(const csg_eval *e, double radius)
{
    const double smallest_circle = 1.0 / 1024 / 1024, least = 0.01, most = 1e6;
    double fn = csg_special_number(e, "$fn", 0);
    if (fabs(radius) < smallest_circle)
        return 3;
    if (fn > 0)
        return (uint32_t)fmin(fmax(fn, 3), most);
    double by_angle = 360 / fmax(csg_special_number(e, "$fa", 12), least);
    double by_length = 2 * acos(-1) * fabs(radius) / fmax(csg_special_number(e, "$fs", 2), least);
    return (uint32_t)fmin(ceil(fmax(fmin(by_angle, by_length), 5)), most);
}

uint32_t csg_facets(const csg_eval *e, double radius)
{
    double fn = csg_special_number(e, "$fn", 0);
    bool few = fn >= 3 && fn <= 16;
    return few || csg_facets_are_exact(e) ? csg_fragments(e, radius) : 0;
}

double csg_cosine_deg(double degrees)
{
    return csg_affine_rotate(degrees, csg_vec3_make(0, 0, 1)).m[0][0];
}

double csg_sine_deg(double degrees)
{
    return csg_affine_rotate(degrees, csg_vec3_make(0, 0, 1)).m[1][0];
}

static csg_outline polygon(csg_module_call *call, double radius, uint32_t count)
{
    csg_outline outline;
    csg_outline_init(&outline, call->e->heap.memory);
    bool ok = csg_eval_charge(call->e, count, call->statement->where);
    for (uint32_t i = 0; i < count && ok; i++) {
        double angle = 360.0 * i / count;
        ok = csg_outline_add(
            &outline, (csg_vec2){radius * csg_cosine_deg(angle), radius * csg_sine_deg(angle)});
    }
    if (!ok || !csg_outline_close(&outline))
        csg_eval_no_memory(call->e);
    return outline;
}

csg_node_id csg_faceted_circle(csg_module_call *call, double radius, uint32_t count)
{
    csg_outline outline = polygon(call, radius, count);
    return csg_shape_region(call, &outline);
}

/* ---- rings around the z axis ----------------------------------------------------------------- */

/* A ring of `count` points, or its centre where it has no width. Its first point. */
static uint32_t add_ring(csg_triangles *triangles, double radius, double z, uint32_t count,
                         bool *ok)
{
    uint32_t first = (uint32_t)triangles->point_count;
    for (uint32_t i = 0; i < (radius > 0 ? count : 1) && *ok; i++) {
        double angle = 360.0 * i / count;
        *ok = csg_triangles_add_point(triangles, csg_vec3_make(radius * csg_cosine_deg(angle),
                                                               radius * csg_sine_deg(angle), z));
    }
    return first;
}

/* The belt between a ring and the one above it; either may be a point. */
static void add_belt(csg_triangles *triangles, uint32_t below, bool below_is_point, uint32_t above,
                     bool above_is_point, uint32_t count, bool *ok)
{
    for (uint32_t i = 0; i < count && *ok; i++) {
        uint32_t next = (i + 1) % count;
        uint32_t a = below_is_point ? below : below + i, b = below_is_point ? below : below + next;
        uint32_t c = above_is_point ? above : above + next, d = above_is_point ? above : above + i;
        *ok = (below_is_point || csg_triangles_add(triangles, a, b, c)) &&
              (above_is_point || csg_triangles_add(triangles, a, c, d));
    }
}

static void add_lid(csg_triangles *triangles, uint32_t ring, uint32_t count, bool up, bool *ok)
{
    for (uint32_t i = 1; i + 1 < count && *ok; i++)
        *ok = csg_triangles_add(triangles, ring, ring + (up ? i : i + 1), ring + (up ? i + 1 : i));
}

csg_node_id csg_faceted_frustum(csg_module_call *call, const double radii[2], double half,
                                uint32_t count)
{
    csg_eval *e = call->e;
    if (radii[0] == radii[1]) {
        csg_node_id base = csg_faceted_circle(call, radii[0], count);
        return base == CSG_NODE_NONE
                   ? base
                   : csg_shape_done(call, csg_build_extrude(&e->builder, base, -half, half,
                                                            call->statement->where));
    }
    csg_triangles triangles;
    csg_triangles_init(&triangles, e->heap.memory);
    bool ok = csg_eval_charge(e, count, call->statement->where);
    uint32_t below = add_ring(&triangles, radii[0], -half, count, &ok);
    uint32_t above = add_ring(&triangles, radii[1], half, count, &ok);
    add_belt(&triangles, below, radii[0] == 0, above, radii[1] == 0, count, &ok);
    if (radii[0] > 0)
        add_lid(&triangles, below, count, false, &ok);
    if (radii[1] > 0)
        add_lid(&triangles, above, count, true, &ok);
    if (!ok)
        csg_eval_no_memory(e);
    return csg_shape_solid(call, &triangles, false);
}

csg_node_id csg_faceted_sphere(csg_module_call *call, double radius, uint32_t count)
{
    csg_eval *e = call->e;
    uint32_t rings = (count + 1) / 2, last = 0;
    csg_triangles triangles;
    csg_triangles_init(&triangles, e->heap.memory);
    bool ok = csg_eval_charge(e, (uint64_t)count * rings, call->statement->where);
    for (uint32_t i = 0; i < rings && ok; i++) {
        double angle = 180 * (rings - 1 - i + 0.5) / rings; /* from the lowest ring up */
        uint32_t ring = add_ring(&triangles, radius * csg_sine_deg(angle),
                                 radius * csg_cosine_deg(angle), count, &ok);
        if (i == 0)
            add_lid(&triangles, ring, count, false, &ok);
        else
            add_belt(&triangles, last, false, ring, false, count, &ok);
        last = ring;
    }
    if (ok)
        add_lid(&triangles, last, count, true, &ok);
    if (!ok)
        csg_eval_no_memory(e);
    return csg_shape_solid(call, &triangles, false);
}
