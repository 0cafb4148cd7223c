/* SPDX-License-Identifier: MIT
 * The hull of balls, or of discs in the plane, as a node. Balls of one radius: the polyhedron
 * around their centres (or a capsule, or a thin plate), grown: exact. Balls of several radii: a
 * polyhedron with corners on the true hull.
 */
#include <math.h>

#include "scene/primitives/kinds.h"
#include "shape/plane/polygons.h"
#include "shape/polyhedra/hull.h"
#include "solid/pieces.h"

/* The radius that all balls have, or -1. */
static double common_radius(const csg_cloud *cloud)
{
    double largest = 0, smallest = INFINITY;
    for (size_t i = 0; i < cloud->count; i++) {
        largest = fmax(largest, cloud->balls[i].radius);
        smallest = fmin(smallest, cloud->balls[i].radius);
    }
    return largest - smallest <= 1e-12 * largest ? largest : -1;
}

static size_t farthest(const csg_cloud *cloud, csg_vec3 from)
{
    size_t best = 0;
    double most = -1;
    for (size_t i = 0; i < cloud->count; i++) {
        double distance = csg_vec3_norm(csg_vec3_sub(cloud->balls[i].at, from));
        if (distance > most) {
            most = distance;
            best = i;
        }
    }
    return best;
}

/* How many dimensions the centres span, and a frame for them: origin, x axis, plane's normal. */
static int span_of(const csg_cloud *cloud, csg_vec3 *origin, csg_vec3 *x, csg_vec3 *normal)
{
    const double slack = 1e-9;
    *origin = cloud->balls[farthest(cloud, cloud->balls[0].at)].at;
    csg_vec3 far = cloud->balls[farthest(cloud, *origin)].at;
    double size = csg_vec3_norm(csg_vec3_sub(far, *origin)), off_line = 0, off_plane = 0;
    *x = csg_vec3_normalize(csg_vec3_sub(far, *origin));
    *normal = csg_vec3_make(0, 0, 0);
    for (size_t i = 0; i < cloud->count; i++) {
        csg_vec3 across = csg_vec3_cross(*x, csg_vec3_sub(cloud->balls[i].at, *origin));
        if (csg_vec3_norm(across) > off_line) {
            off_line = csg_vec3_norm(across);
            *normal = csg_vec3_normalize(across);
        }
    }
    for (size_t i = 0; i < cloud->count; i++)
        off_plane =
            fmax(off_plane, fabs(csg_vec3_dot(*normal, csg_vec3_sub(cloud->balls[i].at, *origin))));
    if (size == 0)
        return 0;
    return off_line <= slack * size ? 1 : off_plane <= slack * size ? 2 : 3;
}

/* Balls of different sizes become points: those of radius 0, and in each of many directions the
 * point of the balls that lies farthest. */
static bool points_of(const csg_cloud *cloud, double tolerance, bool flat, csg_cloud *out)
{
    double radius = 0;
    bool ok = true;
    csg_cloud round;
    csg_cloud_init(&round, cloud->memory);
    for (size_t i = 0; i < cloud->count && ok; i++) {
        radius = fmax(radius, cloud->balls[i].radius);
        ok = csg_cloud_add(cloud->balls[i].radius > 0 ? &round : out, cloud->balls[i].at,
                           cloud->balls[i].radius);
    }
    ok = ok && (!round.count || csg_cloud_spread(&round, tolerance, flat, out));
    csg_cloud_release(&round);
    return ok;
}

static csgm_status hull_triangles(const csg_cloud *cloud, csg_triangles *out)
{
    csg_memory *memory = cloud->memory;
    csg_vec3 *points = csg_memory_alloc(memory, cloud->count * sizeof *points);
    if (!points)
        return CSGM_ERR_MEMORY;
    for (size_t i = 0; i < cloud->count; i++)
        points[i] = cloud->balls[i].at;
    csgm_status status = csg_hull(memory, points, cloud->count, out);
    csg_memory_release(memory, points, cloud->count * sizeof *points);
    return status;
}

/* The convex loop as a plate of this half thickness, in the frame of x, y and normal. */
static bool add_plate(csg_triangles *out, const csg_outline *loop, csg_vec3 origin,
                      const csg_vec3 frame[3], double half)
{
    uint32_t n = (uint32_t)loop->point_count;
    bool ok = true;
    for (uint32_t i = 0; i < 2 * n && ok; i++) {
        csg_vec2 p = loop->points[i % n];
        csg_vec3 at = csg_vec3_add(origin, csg_vec3_scale(frame[0], p.x));
        at = csg_vec3_add(at, csg_vec3_scale(frame[1], p.y));
        ok = csg_triangles_add_point(
            out, csg_vec3_add(at, csg_vec3_scale(frame[2], i < n ? -half : half)));
    }
    for (uint32_t i = 1; i + 1 < n && ok; i++)
        ok = csg_triangles_add(out, 0, i + 1, i) && csg_triangles_add(out, n, n + i, n + i + 1);
    for (uint32_t i = 0; i < n && ok; i++) {
        uint32_t next = (i + 1) % n;
        ok =
            csg_triangles_add(out, i, next, n + next) && csg_triangles_add(out, i, n + next, n + i);
    }
    return ok;
}

/* Equal balls with centres in a plane: a thin plate around their hull, grown. */
static csg_node_id hull_in_plane(csg_solid_job *job, const csg_cloud *cloud, csg_vec3 origin,
                                 csg_vec3 x, csg_vec3 normal, double radius)
{
    const double thin = 1e-6;
    csg_memory *memory = job->memory;
    const csg_vec3 frame[3] = {x, csg_vec3_cross(normal, x), normal};
    csg_outline points, hull;
    csg_triangles plate;
    bool ok = true;
    csg_outline_init(&points, memory);
    for (size_t i = 0; i < cloud->count && ok; i++) {
        csg_vec3 p = csg_vec3_sub(cloud->balls[i].at, origin);
        ok = csg_outline_add(&points,
                             (csg_vec2){csg_vec3_dot(p, frame[0]), csg_vec3_dot(p, frame[1])});
    }
    csgm_status status =
        ok && csg_outline_close(&points) ? csg_polygons_hull(&points, &hull) : CSGM_ERR_MEMORY;
    csg_outline_release(&points);
    if (status != CSGM_OK)
        return csg_solid_failed(job, status, "make this hull");
    csg_triangles_init(&plate, memory);
    ok = add_plate(&plate, &hull, origin, frame, thin * radius);
    csg_outline_release(&hull);
    if (ok)
        return csg_solid_grown(job, csg_solid_of_triangles(job, &plate, NULL), radius * (1 - thin));
    csg_triangles_release(&plate);
    return csg_solid_failed(job, CSGM_ERR_MEMORY, "");
}

static csg_node_id hull_of_points(csg_solid_job *job, const csg_cloud *cloud, double radius)
{
    csg_triangles triangles;
    csg_triangles_init(&triangles, job->memory);
    csgm_status status = hull_triangles(cloud, &triangles);
    if (status != CSGM_OK) {
        csg_triangles_release(&triangles);
        return csg_solid_failed(job, status,
                                status == CSGM_ERR_SCENE
                                    ? "make this hull: its points lie in a plane"
                                    : "make this hull");
    }
    return csg_solid_grown(job, csg_solid_of_triangles(job, &triangles, NULL), radius);
}

csg_node_id csg_cloud_hull(csg_solid_job *job, const csg_cloud *cloud, double tolerance)
{
    csg_vec3 origin, x, normal;
    csg_span where = job->where;
    if (!cloud->count)
        return csg_solid_empty(job);
    if (!csg_solid_charge(job, cloud->count))
        return CSG_NODE_NONE;
    double radius = common_radius(cloud);
    int dimensions = span_of(cloud, &origin, &x, &normal);
    if (cloud->count == 2 && (cloud->balls[0].radius > 0 || cloud->balls[1].radius > 0))
        return csg_solid_done(job, csg_build_capsule(job->builder, cloud->balls[0].at,
                                                     cloud->balls[1].at, cloud->balls[0].radius,
                                                     cloud->balls[1].radius, where));
    if (radius > 0 && dimensions < 2) {
        csg_vec3 far = cloud->balls[farthest(cloud, origin)].at;
        return csg_solid_done(job,
                              csg_build_capsule(job->builder, origin, far, radius, radius, where));
    }
    if (radius > 0 && dimensions == 2)
        return hull_in_plane(job, cloud, origin, x, normal, radius);
    if (radius >= 0)
        return hull_of_points(job, cloud, radius);
    csg_cloud points;
    csg_cloud_init(&points, job->memory);
    csg_node_id node = CSG_NODE_NONE;
    if (points_of(cloud, tolerance, false, &points))
        node = hull_of_points(job, &points, 0);
    else
        csg_solid_no_memory(job);
    csg_cloud_release(&points);
    return node;
}

/* Discs of one radius on a line: a rectangle with round ends. */
static csg_node_id stadium(csg_solid_job *job, const csg_cloud *cloud, csg_vec3 origin, csg_vec3 x,
                           double radius)
{
    csg_vec3 far = cloud->balls[farthest(cloud, origin)].at;
    double length = csg_vec3_norm(csg_vec3_sub(far, origin));
    const double sizes[3] = {length / 2 + radius, radius, radius};
    csg_node_id node = csg_solid_done(
        job, length > 0 ? csg_build_primitive(job->builder, CSG_NODE_RECTANGLE, sizes, job->where)
                        : csg_build_primitive(job->builder, CSG_NODE_CIRCLE, &radius, job->where));
    csg_affine place = csg_affine_identity();
    if (length > 0) {
        place.m[0][0] = place.m[1][1] = x.x;
        place.m[1][0] = x.y;
        place.m[0][1] = -x.y;
    }
    place.t[0] = (origin.x + far.x) / 2;
    place.t[1] = (origin.y + far.y) / 2;
    return csg_solid_moved(job, node, &place);
}

csg_node_id csg_cloud_hull_flat(csg_solid_job *job, const csg_cloud *cloud, double tolerance)
{
    csg_vec3 origin, x, normal;
    if (!cloud->count)
        return csg_solid_empty(job);
    if (!csg_solid_charge(job, cloud->count))
        return CSG_NODE_NONE;
    double radius = common_radius(cloud);
    if (radius > 0 && span_of(cloud, &origin, &x, &normal) < 2)
        return stadium(job, cloud, origin, x, radius);
    csg_cloud points;
    csg_outline outline, hull;
    csg_cloud_init(&points, job->memory);
    csg_outline_init(&outline, job->memory);
    const csg_cloud *corners = radius >= 0 ? cloud : &points;
    bool ok = radius >= 0 || points_of(cloud, tolerance, true, &points);
    for (size_t i = 0; i < corners->count && ok; i++)
        ok = csg_outline_add(&outline, (csg_vec2){corners->balls[i].at.x, corners->balls[i].at.y});
    csgm_status status =
        ok && csg_outline_close(&outline) ? csg_polygons_hull(&outline, &hull) : CSGM_ERR_MEMORY;
    csg_cloud_release(&points);
    csg_outline_release(&outline);
    if (status != CSGM_OK)
        return csg_solid_failed(job, status, "make this hull");
    return csg_solid_grown(job, csg_solid_region(job, &hull), fmax(radius, 0));
}
