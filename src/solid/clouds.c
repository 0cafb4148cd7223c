/* SPDX-License-Identifier: MIT
 * Clouds of balls that have the hull of a piece; see pieces.h.
 */
#include <math.h>

#include "scene/primitives/curve.h"
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
    csg_cloud local;          /* in the piece's own frame, before its grow */
    double tolerance, factor; /* factor 0: balls become ellipsoids */
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
    return 4 * (uint32_t)ceil(acos(-1) / (4 * acos(1 - sagitta)) * 2);
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

static void add_torus(clouding *c, const double *p)
{
    if (p[2] >= 180) {
        add_ring(c, p[0], 0, p[1]);
        return;
    }
    uint32_t count = ring_count(p[0] * csg_map_stretch(&c->piece->map), c->tolerance);
    for (uint32_t i = 0; i <= count && c->ok; i++) {
        double angle = p[2] * (2.0 * i / count - 1);
        add_ball(c, p[0] * csg_cosine_deg(angle), p[0] * csg_sine_deg(angle), 0, p[1]);
    }
}

static void add_box(clouding *c, const double *half, double ball, bool flat)
{
    for (int i = 0; i < (flat ? 4 : 8); i++)
        add_ball(c, (i & 1 ? 1 : -1) * (half[0] - ball), (i & 2 ? 1 : -1) * (half[1] - ball),
                 flat ? 0 : (i & 4 ? 1 : -1) * (half[2] - ball), ball);
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

/* Chords of the balls between which a tube differs from their hull by less than the tolerance. */
static void add_curve(clouding *c, csg_node_kind kind, const double *p)
{
    const double most = 4000;
    csg_curve curve = csg_curve_make(kind, p);
    double within = c->tolerance / csg_map_stretch(&c->piece->map);
    uint32_t chords = (uint32_t)fmin(csg_curve_chords(&curve, within), most);
    for (uint32_t i = 0; i <= chords; i++) {
        double at[CSG_CURVE_AXES];
        csg_curve_at(&curve, (double)i / chords, at);
        add_ball(c, at[0], at[1], at[2], at[CSG_CURVE_RADIUS]);
    }
}

/* The balls of leaves; false where there is no such cloud. */
static bool add_leaf(clouding *c, const csgm_scene *scene, const csg_node *node)
{
    const double *p = scene->parameters + node->payload;
    switch (node->kind) {
    case CSG_NODE_SPHERE:
    case CSG_NODE_CIRCLE:
        add_ball(c, 0, 0, 0, p[0]);
        return true;
    case CSG_NODE_BOX:
        add_box(c, p, p[3], false);
        return true;
    case CSG_NODE_RECTANGLE:
        add_box(c, p, p[2], true);
        return true;
    case CSG_NODE_FRUSTUM:
        add_ring(c, p[0], -p[2], p[3]);
        add_ring(c, p[1], p[2], p[3]);
        return true;
    case CSG_NODE_CAPSULE:
        add_ball(c, 0, 0, 0, p[1]);
        add_ball(c, 0, 0, p[0], p[2]);
        return true;
    case CSG_NODE_TORUS:
        add_torus(c, p);
        return true;
    case CSG_NODE_QUADRATIC_TUBE:
    case CSG_NODE_CUBIC_TUBE:
        add_curve(c, node->kind, p);
        return true;
    case CSG_NODE_ELLIPSOID:
        add_ball(c, 0, 0, 0, 1);
        return true;
    case CSG_NODE_SHAPE:
        add_shape(c, scene->shapes[node->payload]);
        return true;
    default:
        return false;
    }
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

static csgm_status place(clouding *c, bool flat, bool ellipsoid, const double *axes, csg_cloud *out)
{
    csg_affine map = flat ? csg_map_of_plane(c->piece->map) : c->piece->map;
    if (ellipsoid)
        map = csg_affine_multiply(map, csg_affine_scale(csg_vec3_make(axes[0], axes[1], axes[2])));
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
    clouding c = {.piece = piece, .tolerance = tolerance, .ok = true};
    csgm_status status = CSGM_OK;
    csg_cloud_init(&c.local, out->memory);
    if (csg_piece_is_extrusion(&node))
        status = extrusion_cloud(job, &c, &node);
    else if (node.kind == CSG_NODE_WARP && scene->warps[node.payload].kind == CSG_WARP_REVOLVE)
        status = revolve_cloud(job, &c, &node);
    else if (!add_leaf(&c, scene, &node))
        status = tessellated_cloud(job, &c, flat);
    if (!c.ok)
        status = CSGM_ERR_MEMORY;
    const double axes[3] = {1, 1, 1};
    bool ellipsoid = node.kind == CSG_NODE_ELLIPSOID;
    if (status == CSGM_OK) /* the tessellation may have moved the arrays */
        status = place(&c, flat, ellipsoid,
                       ellipsoid ? job->builder->scene->parameters + node.payload : axes, out);
    csg_cloud_release(&c.local);
    return status;
}
