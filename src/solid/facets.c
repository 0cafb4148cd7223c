/* SPDX-License-Identifier: MIT
 * $fn, $fa and $fs: circles, frusta and balls as the polygons and polyhedra that OpenSCAD makes of
 * them. A circle's first corner lies at angle 0; a ball's rings lie at half steps between its
 * poles.
 */
#include <math.h>

#include "base/elementary.h"

#include "solid/facets.h"

uint32_t csg_fragments(const csg_facet_rule *rule, double radius)
{
    const double smallest_circle = 1.0 / 1024 / 1024, least = 0.01, most = 1e6;
    if (fabs(radius) < smallest_circle)
        return 3;
    if (rule->fn > 0)
        return (uint32_t)fmin(fmax(rule->fn, 3), most);
    double by_angle = 360 / fmax(rule->fa, least);
    double by_length = 2 * csg_acos(-1) * fabs(radius) / fmax(rule->fs, least);
    return (uint32_t)fmin(ceil(fmax(fmin(by_angle, by_length), 5)), most);
}

uint32_t csg_facets(const csg_facet_rule *rule, double radius)
{
    bool few = rule->fn >= 3 && rule->fn <= 16;
    return few || rule->exact ? csg_fragments(rule, radius) : 0;
}

double csg_cosine_deg(double degrees)
{
    return csg_affine_rotate(degrees, csg_vec3_make(0, 0, 1)).m[0][0];
}

double csg_sine_deg(double degrees)
{
    return csg_affine_rotate(degrees, csg_vec3_make(0, 0, 1)).m[1][0];
}

static csg_outline polygon(csg_solid_job *job, double radius, uint32_t count)
{
    csg_outline outline;
    csg_outline_init(&outline, job->memory);
    bool ok = csg_solid_charge(job, count);
    for (uint32_t i = 0; i < count && ok; i++) {
        double angle = 360.0 * i / count;
        ok = csg_outline_add(
            &outline, (csg_vec2){radius * csg_cosine_deg(angle), radius * csg_sine_deg(angle)});
    }
    if (!ok || !csg_outline_close(&outline))
        csg_solid_no_memory(job);
    return outline;
}

csg_node_id csg_faceted_circle(csg_solid_job *job, double radius, uint32_t count)
{
    csg_outline outline = polygon(job, radius, count);
    return csg_solid_region(job, &outline);
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

csg_node_id csg_faceted_frustum(csg_solid_job *job, const double radii[2], double half,
                                uint32_t count)
{
    if (radii[0] == radii[1]) {
        csg_node_id base = csg_faceted_circle(job, radii[0], count);
        return base == CSG_NODE_NONE
                   ? base
                   : csg_solid_done(job,
                                    csg_build_extrude(job->builder, base, -half, half, job->where));
    }
    csg_triangles triangles;
    csg_triangles_init(&triangles, job->memory);
    bool ok = csg_solid_charge(job, count);
    uint32_t below = add_ring(&triangles, radii[0], -half, count, &ok);
    uint32_t above = add_ring(&triangles, radii[1], half, count, &ok);
    add_belt(&triangles, below, radii[0] == 0, above, radii[1] == 0, count, &ok);
    if (radii[0] > 0)
        add_lid(&triangles, below, count, false, &ok);
    if (radii[1] > 0)
        add_lid(&triangles, above, count, true, &ok);
    if (!ok)
        csg_solid_no_memory(job);
    return csg_solid_of_triangles(job, &triangles, NULL);
}

csg_node_id csg_faceted_sphere(csg_solid_job *job, double radius, uint32_t count)
{
    uint32_t rings = (count + 1) / 2, last = 0;
    csg_triangles triangles;
    csg_triangles_init(&triangles, job->memory);
    bool ok = csg_solid_charge(job, (uint64_t)count * rings);
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
        csg_solid_no_memory(job);
    return csg_solid_of_triangles(job, &triangles, NULL);
}
