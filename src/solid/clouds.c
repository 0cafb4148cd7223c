/* SPDX-License-Identifier: MIT
 * Clouds of balls that have the hull of a piece; see pieces.h.
 */
#include <math.h>

#include "base/elementary.h"
#include "scene/primitives/primitive.h"
#include "scene/warp_kinds.h"
#include "shape/plane/region.h"
#include "solid/facets.h"
#include "solid/measure.h"
#include "solid/pieces.h"

void csg_cloud_init(csg_cloud *cloud, csg_memory *memory)
{
    *cloud = (csg_cloud){.memory = memory};
}

void csg_cloud_release(csg_cloud *cloud)
{
    csg_memory_release(cloud->memory, cloud->balls, cloud->capacity * sizeof *cloud->balls);
    csg_cloud_init(cloud, cloud->memory);
}

bool csg_cloud_add(csg_cloud *cloud, csg_vec3 at, double radius)
{
    if (!csg_memory_reserve(cloud->memory, (void **)&cloud->balls, &cloud->capacity,
                            cloud->count + 1, sizeof *cloud->balls))
        return false;
    cloud->balls[cloud->count++] = (csg_ball){at, radius};
    return true;
}

/* ---- clouds ---------------------------------------------------------------------------------- */

typedef struct clouding {
    const csg_solid_piece *piece;
    csg_cloud local; /* in the piece's own frame, before its grow */
    csg_vec3 axes;   /* by which the balls are stretched in it */
    double tolerance;
    bool ok;
} clouding;

static void add_ball(clouding *c, double x, double y, double z, double radius)
{
    c->ok = c->ok && csg_cloud_add(&c->local, csg_vec3_make(x, y, z), radius);
}

/* Points on a circle, a multiple of 4 so that its box is exact. */
static uint32_t ring_count(double radius, double tolerance)
{
    const double least = 3e-8; /* of the radius: 16 000 points */
    double sagitta = fmax(tolerance / radius, least);
    if (sagitta >= 0.25)
        return 8;
    return 4 * (uint32_t)ceil(csg_acos(-1) / (4 * csg_acos(1 - sagitta)) * 2);
}

static void add_ring(clouding *c, double radius, double z, double ball)
{
    if (radius <= 0) {
        add_ball(c, 0, 0, z, ball);
        return;
    }
    uint32_t count = ring_count(radius * csg_map_stretch(&c->piece->map), c->tolerance);
    for (uint32_t i = 0; i < count && c->ok; i++) {
        double angle = 360.0 * i / count;
        add_ball(c, radius * csg_cosine_deg(angle), radius * csg_sine_deg(angle), z, ball);
    }
}

/* Of what a primitive says of itself (csg_ball_sink); user: the clouding. */
static void take_ball(void *user, csg_vec3 at, double radius)
{
    add_ball(user, at.x, at.y, at.z, radius);
}

static void take_arc(void *user, double radius, double z, double half_deg, double ball)
{
    clouding *c = user;
    if (half_deg >= 180) {
        add_ring(c, radius, z, ball);
        return;
    }
    uint32_t count = ring_count(radius * csg_map_stretch(&c->piece->map), c->tolerance);
    for (uint32_t i = 0; i <= count && c->ok; i++) {
        double angle = half_deg * (2.0 * i / count - 1);
        add_ball(c, radius * csg_cosine_deg(angle), radius * csg_sine_deg(angle), z, ball);
    }
}

static void add_shape(clouding *c, const csg_shape *shape)
{
    if (shape->kind == CSG_SHAPE_POLYHEDRON) {
        const csg_triangles *triangles = csg_polyhedron_triangles(shape);
        for (size_t i = 0; i < triangles->point_count && c->ok; i++)
            c->ok = csg_cloud_add(&c->local, triangles->points[i], 0);
        return;
    }
    const csg_outline *outline = csg_region_outline(shape);
    for (size_t i = 0; i < outline->point_count && c->ok; i++)
        add_ball(c, outline->points[i].x, outline->points[i].y, 0, 0);
}

/* The balls of leaves; false where there is no such cloud. */
static bool add_leaf(clouding *c, const csgm_scene *scene, const csg_node *node)
{
    if (node->kind == CSG_NODE_SHAPE) {
        add_shape(c, scene->shapes[node->payload]);
        return true;
    }
    if (!csg_node_is_named_primitive(node->kind))
        return false;
    csg_ball_sink sink = {c, take_ball, take_arc, c->tolerance / csg_map_stretch(&c->piece->map),
                          c->axes};
    bool has = csg_primitive_of(node->kind)->balls(&sink, csg_scene_parameters(scene, node));
    c->axes = sink.axes;
    return has;
}

/* ---- balls under the piece's map ------------------------------------------------------------- */

/* Unit directions: an octahedron's faces divided n times, so that the axes are among them. */
static csg_vec3 direction(uint32_t n, uint32_t face, uint32_t i, uint32_t k)
{
    double x = (double)i / n, y = (double)k / n, z = 1 - x - y;
    return csg_vec3_normalize(
        csg_vec3_make(face & 1 ? -x : x, face & 2 ? -y : y, face & 4 ? -z : z));
}

/* Divisions that keep the hull of points on a ball within tolerance: the largest gap between them
 * is about 2.2 / n rad, and a gap g leaves g^2 / 6 of the radius. */
static uint32_t divisions(double radius, double tolerance)
{
    enum { MOST = 80 };
    double n = ceil(2.2 / sqrt(6 * fmax(tolerance / radius, 1e-9)));
    return n < 2 ? 2 : n > MOST ? MOST : (uint32_t)n;
}

/* The point of the cloud that is farthest along d, balls being mapped by m. */
static csg_vec3 support(const csg_cloud *cloud, const csg_affine *m, csg_vec3 d)
{
    csg_vec3 back = csg_vec3_normalize(csg_affine_covector(m, d)), best = {0, 0, 0};
    double reach = -INFINITY;
    for (size_t i = 0; i < cloud->count; i++) {
        csg_vec3 at =
            csg_vec3_add(cloud->balls[i].at, csg_vec3_scale(back, cloud->balls[i].radius));
        csg_vec3 there = csg_affine_point(m, at);
        if (csg_vec3_dot(there, d) > reach) {
            reach = csg_vec3_dot(there, d);
            best = there;
        }
    }
    return best;
}

/* Points on the images of the balls under a map that is no similarity. */
static bool spread(const csg_cloud *cloud, const csg_affine *m, double grow, double tolerance,
                   bool flat, csg_cloud *out)
{
    double radius = 0;
    bool ok = true;
    for (size_t i = 0; i < cloud->count; i++)
        radius = fmax(radius, cloud->balls[i].radius * csg_map_stretch(m));
    if (flat) {
        uint32_t count = ring_count(radius, tolerance);
        for (uint32_t i = 0; i < count && ok; i++) {
            double angle = 360.0 * i / count;
            csg_vec3 d = csg_vec3_make(csg_cosine_deg(angle), csg_sine_deg(angle), 0);
            ok = csg_cloud_add(out, support(cloud, m, d), grow);
        }
        return ok;
    }
    uint32_t n = divisions(radius, tolerance);
    for (uint32_t face = 0; face < 8 && ok; face++)
        for (uint32_t i = 0; i <= n && ok; i++)
            for (uint32_t k = 0; i + k <= n && ok; k++) {
                bool twice = (face & 1 && i == 0) || (face & 2 && k == 0) ||
                             (face & 4 && i + k == n); /* on an edge of another face */
                if (!twice)
                    ok = csg_cloud_add(out, support(cloud, m, direction(n, face, i, k)), grow);
            }
    return ok;
}

bool csg_cloud_spread(const csg_cloud *cloud, double tolerance, bool flat, csg_cloud *out)
{
    const csg_affine identity = csg_affine_identity();
    return spread(cloud, &identity, 0, tolerance, flat, out);
}

static bool has_balls(const csg_cloud *cloud)
{
    for (size_t i = 0; i < cloud->count; i++)
        if (cloud->balls[i].radius > 0)
            return true;
    return false;
}

static csgm_status place(clouding *c, bool flat, csg_cloud *out)
{
    csg_affine map = flat ? csg_map_of_plane(c->piece->map) : c->piece->map;
    if (c->axes.x != 1 || c->axes.y != 1 || c->axes.z != 1)
        map = csg_affine_multiply(map, csg_affine_scale(c->axes));
    double factor = csg_map_factor(&map), grow = c->piece->grow;
    if (factor == 0 && has_balls(&c->local))
        return c->ok && spread(&c->local, &map, grow, c->tolerance, flat, out) ? CSGM_OK
                                                                               : CSGM_ERR_MEMORY;
    for (size_t i = 0; i < c->local.count && c->ok; i++)
        c->ok = csg_cloud_add(out, csg_affine_point(&map, c->local.balls[i].at),
                              c->local.balls[i].radius * factor + grow);
    return c->ok ? CSGM_OK : CSGM_ERR_MEMORY;
}

/* ---- extrusions and revolutions -------------------------------------------------------------- */

/* Corners of an extrusion: those of its figure (discs as points) at both ends. */
static csgm_status extrusion_cloud(csg_solid_job *job, clouding *c, const csg_node *node)
{
    csg_solid_pieces figure;
    csg_cloud flat;
    double half, middle;
    csgm_status status = CSGM_OK;
    csg_pieces_init(&figure, c->local.memory);
    csg_cloud_init(&flat, c->local.memory);
    csg_piece_slab(job->builder->scene, node, &half, &middle);
    c->ok = csg_pieces_collect(job->builder->scene,
                               csg_scene_children(job->builder->scene, node)[0], &figure);
    for (size_t i = 0; i < figure.count && c->ok && status == CSGM_OK; i++)
        status = csg_piece_cloud(job, &figure.items[i], c->tolerance, &flat);
    for (size_t i = 0; i < flat.count && status == CSGM_OK; i++) {
        csg_ball ball = flat.balls[i];
        uint32_t count = ball.radius > 0 ? ring_count(ball.radius, c->tolerance) : 1;
        for (uint32_t k = 0; k < 2 * count; k++) {
            double angle = 360.0 * (k / 2) / count;
            add_ball(c, ball.at.x + ball.radius * csg_cosine_deg(angle),
                     ball.at.y + ball.radius * csg_sine_deg(angle), middle + (k & 1 ? half : -half),
                     0);
        }
    }
    csg_pieces_release(&figure);
    csg_cloud_release(&flat);
    return !c->ok ? CSGM_ERR_MEMORY : status;
}

/* Rings of the balls of a figure that is turned all around. */
static csgm_status revolve_cloud(csg_solid_job *job, clouding *c, const csg_node *node)
{
    csg_solid_pieces figure;
    csg_cloud flat;
    csgm_status status = CSGM_OK;
    csg_pieces_init(&figure, c->local.memory);
    csg_cloud_init(&flat, c->local.memory);
    c->ok = csg_pieces_collect(job->builder->scene,
                               csg_scene_children(job->builder->scene, node)[0], &figure);
    for (size_t i = 0; i < figure.count && c->ok && status == CSGM_OK; i++)
        status = csg_piece_cloud(job, &figure.items[i], c->tolerance, &flat);
    for (size_t i = 0; i < flat.count && status == CSGM_OK; i++)
        add_ring(c, fabs(flat.balls[i].at.x), flat.balls[i].at.y, flat.balls[i].radius);
    csg_pieces_release(&figure);
    csg_cloud_release(&flat);
    return !c->ok ? CSGM_ERR_MEMORY : status;
}

/* ---- the cloud of any piece ------------------------------------------------------------------ */

static csgm_status tessellated_cloud(csg_solid_job *job, clouding *c, bool flat)
{
    csg_triangles triangles;
    csg_outline outline;
    csgm_status status;
    if (flat) {
        status = csg_flat_outline(job, c->piece->node, &outline);
        if (status != CSGM_OK)
            return status;
        for (size_t i = 0; i < outline.point_count && c->ok; i++)
            add_ball(c, outline.points[i].x, outline.points[i].y, 0, 0);
        csg_outline_release(&outline);
    } else {
        csg_triangles_init(&triangles, c->local.memory);
        status = csg_solid_triangles(job, c->piece->node, &triangles);
        for (size_t i = 0; i < triangles.point_count && c->ok && status == CSGM_OK; i++)
            c->ok = csg_cloud_add(&c->local, triangles.points[i], 0);
        csg_triangles_release(&triangles);
    }
    return !c->ok ? CSGM_ERR_MEMORY : status;
}

csgm_status csg_piece_cloud(csg_solid_job *job, const csg_solid_piece *piece, double tolerance,
                            csg_cloud *out)
{
    const csgm_scene *scene = job->builder->scene;
    const csg_node node = scene->nodes[piece->node];
    bool flat = csg_build_is_flat(job->builder, piece->node);
    clouding c = {.piece = piece, .axes = {1, 1, 1}, .tolerance = tolerance, .ok = true};
    csgm_status status = CSGM_OK;
    csg_cloud_init(&c.local, out->memory);
    if (csg_node_is_plate(&node))
        status = extrusion_cloud(job, &c, &node);
    else if (node.kind == CSG_NODE_WARP && scene->warps[node.payload].kind == CSG_WARP_REVOLVE)
        status = revolve_cloud(job, &c, &node);
    else if (!add_leaf(&c, scene, &node))
        status = tessellated_cloud(job, &c, flat);
    if (!c.ok)
        status = CSGM_ERR_MEMORY;
    if (status == CSGM_OK)
        status = place(&c, flat, out);
    csg_cloud_release(&c.local);
    return status;
}
