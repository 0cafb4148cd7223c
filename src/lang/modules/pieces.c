/* SPDX-License-Identifier: MIT
 * Pieces of nodes and their clouds of balls; see pieces.h.
 */
#include "lang/modules/pieces.h"

#include <math.h>

#include "scene/primitives/curve.h"
#include "shape/plane/region.h"
#include "shape/polyhedra/polyhedron.h"

void csg_pieces_init(csg_pieces *pieces, csg_memory *memory)
{
    *pieces = (csg_pieces){.memory = memory};
}

void csg_pieces_release(csg_pieces *pieces)
{
    csg_memory_release(pieces->memory, pieces->items, pieces->capacity * sizeof *pieces->items);
    csg_pieces_init(pieces, pieces->memory);
}

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

/* ---- taking apart ---------------------------------------------------------------------------- */

bool csg_pieces_add(csg_pieces *pieces, csg_piece piece)
{
    if (!csg_memory_reserve(pieces->memory, (void **)&pieces->items, &pieces->capacity,
                            pieces->count + 1, sizeof piece))
        return false;
    pieces->items[pieces->count++] = piece;
    return true;
}

/* How much longer lengths become; 0 when the map is no similarity. */
static double factor_of(const csg_affine *map)
{
    double smallest, largest;
    if (!csg_affine_is_similarity(map))
        return 0;
    csg_affine_singular_values(map, &smallest, &largest);
    return largest;
}

/* What stands below a node that is not a piece of its own: fills `inner` and returns true. */
static bool is_transparent(const csg_eval *e, const csg_piece *piece, csg_piece *inner)
{
    const csgm_scene *scene = e->builder.scene;
    const csg_node *node = &scene->nodes[piece->node];
    *inner = *piece;
    switch (node->kind) {
    case CSG_NODE_TRANSFORM:
        inner->map = csg_affine_multiply(piece->map, scene->transforms[node->payload]);
        return piece->grow == 0 || factor_of(&scene->transforms[node->payload]) > 0;
    case CSG_NODE_COLOR:
        return true;
    case CSG_NODE_OFFSET: {
        double r = scene->parameters[node->payload], factor = factor_of(&piece->map);
        inner->grow += r * factor;
        return r > 0 && factor > 0;
    }
    case CSG_NODE_UNION:
        return node->blend == CSG_BLEND_SHARP;
    default:
        return false;
    }
}

bool csg_pieces_collect(const csg_eval *e, csg_node_id root, csg_pieces *pieces)
{
    const csgm_scene *scene = e->builder.scene;
    csg_pieces work;
    csg_pieces_init(&work, pieces->memory);
    bool ok = csg_pieces_add(&work, (csg_piece){root, csg_affine_identity(), 0});
    while (ok && work.count) {
        csg_piece inner, piece = work.items[--work.count];
        const csg_node *node = &scene->nodes[piece.node];
        if (!is_transparent(e, &piece, &inner)) {
            ok = node->kind == CSG_NODE_EMPTY || csg_pieces_add(pieces, piece);
            continue;
        }
        for (uint32_t i = node->child_count; i-- > 0 && ok;) {
            inner.node = csg_scene_children(scene, node)[i];
            ok = csg_pieces_add(&work, inner);
        }
    }
    csg_pieces_release(&work);
    return ok;
}

/* ---- clouds ---------------------------------------------------------------------------------- */

typedef struct clouding {
    const csg_piece *piece;
    csg_cloud local;          /* in the piece's own frame, before its grow */
    double tolerance, factor; /* factor 0: balls become ellipsoids */
    bool ok;
} clouding;

static void add(clouding *c, double x, double y, double z, double radius)
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

/* The plane's and the map's stretch of a length across z: what a tolerance is compared with. */
static double widest(const csg_affine *map)
{
    double smallest, largest;
    csg_affine_singular_values(map, &smallest, &largest);
    return largest;
}

static void add_ring(clouding *c, double radius, double z, double ball)
{
    if (radius <= 0) {
        add(c, 0, 0, z, ball);
        return;
    }
    uint32_t count = ring_count(radius * widest(&c->piece->map), c->tolerance);
    for (uint32_t i = 0; i < count && c->ok; i++) {
        double angle = 360.0 * i / count;
        add(c, radius * csg_cosine_deg(angle), radius * csg_sine_deg(angle), z, ball);
    }
}

static void add_torus(clouding *c, const double *p)
{
    if (p[2] >= 180) {
        add_ring(c, p[0], 0, p[1]);
        return;
    }
    uint32_t count = ring_count(p[0] * widest(&c->piece->map), c->tolerance);
    for (uint32_t i = 0; i <= count && c->ok; i++) {
        double angle = p[2] * (2.0 * i / count - 1);
        add(c, p[0] * csg_cosine_deg(angle), p[0] * csg_sine_deg(angle), 0, p[1]);
    }
}

static void add_box(clouding *c, const double *half, double ball, bool flat)
{
    for (int i = 0; i < (flat ? 4 : 8); i++)
        add(c, (i & 1 ? 1 : -1) * (half[0] - ball), (i & 2 ? 1 : -1) * (half[1] - ball),
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
        add(c, outline->points[i].x, outline->points[i].y, 0, 0);
}

/* Chords of the balls between which a tube differs from their hull by less than the tolerance. */
static void add_curve(clouding *c, csg_node_kind kind, const double *p)
{
    const double most = 4000;
    csg_curve curve = csg_curve_make(kind, p);
    double within = c->tolerance / widest(&c->piece->map);
    uint32_t chords = (uint32_t)fmin(csg_curve_chords(&curve, within), most);
    for (uint32_t i = 0; i <= chords; i++) {
        double at[CSG_CURVE_AXES];
        csg_curve_at(&curve, (double)i / chords, at);
        add(c, at[0], at[1], at[2], at[CSG_CURVE_RADIUS]);
    }
}

/* The balls of leaves; false where there is no such cloud. */
static bool add_leaf(clouding *c, const csgm_scene *scene, const csg_node *node)
{
    const double *p = scene->parameters + node->payload;
    switch (node->kind) {
    case CSG_NODE_SPHERE:
    case CSG_NODE_CIRCLE:
        add(c, 0, 0, 0, p[0]);
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
        add(c, 0, 0, 0, p[1]);
        add(c, 0, 0, p[0], p[2]);
        return true;
    case CSG_NODE_TORUS:
        add_torus(c, p);
        return true;
    case CSG_NODE_QUADRATIC_TUBE:
    case CSG_NODE_CUBIC_TUBE:
        add_curve(c, node->kind, p);
        return true;
    case CSG_NODE_ELLIPSOID:
        add(c, 0, 0, 0, 1);
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
        radius = fmax(radius, cloud->balls[i].radius * widest(m));
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

/* Of a flat piece the plane part alone is a similarity or not. */
static csg_affine plane_part(csg_affine map)
{
    double size = sqrt(fabs(map.m[0][0] * map.m[1][1] - map.m[0][1] * map.m[1][0]));
    map.m[0][2] = map.m[1][2] = map.m[2][0] = map.m[2][1] = map.t[2] = 0;
    map.m[2][2] = size > 0 ? size : 1;
    return map;
}

static csgm_status place(clouding *c, bool flat, bool ellipsoid, const double *axes, csg_cloud *out)
{
    csg_affine map = flat ? plane_part(c->piece->map) : c->piece->map;
    if (ellipsoid)
        map = csg_affine_multiply(map, csg_affine_scale(csg_vec3_make(axes[0], axes[1], axes[2])));
    double factor = factor_of(&map), grow = c->piece->grow;
    if (factor == 0 && has_balls(&c->local))
        return c->ok && spread(&c->local, &map, grow, c->tolerance, flat, out) ? CSGM_OK
                                                                               : CSGM_ERR_MEMORY;
    for (size_t i = 0; i < c->local.count && c->ok; i++)
        c->ok = csg_cloud_add(out, csg_affine_point(&map, c->local.balls[i].at),
                              c->local.balls[i].radius * factor + grow);
    return c->ok ? CSGM_OK : CSGM_ERR_MEMORY;
}

/* ---- prisms ---------------------------------------------------------------------------------- */

/* Does the map keep z apart from x and y? */
static bool keeps_z(const csg_affine *map)
{
    double size = widest(map), slack = 1e-12 * size;
    return fabs(map->m[0][2]) <= slack && fabs(map->m[1][2]) <= slack &&
           fabs(map->m[2][0]) <= slack && fabs(map->m[2][1]) <= slack;
}

static bool is_extrusion(const csg_node *node)
{
    return node->kind == CSG_NODE_INTERSECTION && node->blend == CSG_BLEND_ORTHOGONAL;
}

/* Half height and middle of an extrusion's slab. */
static void slab_of(const csgm_scene *scene, const csg_node *node, double *half, double *middle)
{
    const csg_node *slab = &scene->nodes[csg_scene_children(scene, node)[1]];
    *middle = 0;
    if (slab->kind == CSG_NODE_TRANSFORM) {
        *middle = scene->transforms[slab->payload].t[2];
        slab = &scene->nodes[csg_scene_children(scene, slab)[0]];
    }
    *half = scene->parameters[slab->payload];
}

bool csg_piece_prism(csg_eval *e, const csg_piece *piece, csg_pieces *figure, double heights[2])
{
    csg_scene_builder *builder = &e->builder;
    const csg_node node = builder->scene->nodes[piece->node];
    const double *p = builder->scene->parameters + node.payload;
    csg_node_id flat;
    double half, middle = 0;
    if (piece->grow > 0 || !keeps_z(&piece->map))
        return false;
    if (is_extrusion(&node)) {
        slab_of(builder->scene, &node, &half, &middle);
        flat = csg_scene_children(builder->scene, &node)[0];
    } else if (node.kind == CSG_NODE_BOX && p[3] == 0) {
        const double sides[3] = {p[0], p[1], 0};
        half = p[2];
        flat = csg_build_primitive(builder, CSG_NODE_RECTANGLE, sides, node.where);
    } else if (node.kind == CSG_NODE_FRUSTUM && p[0] == p[1] && p[3] == 0) {
        const double radius = p[0];
        half = p[2];
        flat = csg_build_primitive(builder, CSG_NODE_CIRCLE, &radius, node.where);
    } else {
        return false;
    }
    size_t first = figure->count;
    flat = csg_check_node(e, flat, node.where);
    if (flat == CSG_NODE_NONE || !csg_pieces_collect(e, flat, figure)) {
        csg_eval_no_memory(e);
        return false;
    }
    for (size_t i = first; i < figure->count; i++)
        figure->items[i].map = csg_affine_multiply(plane_part(piece->map), figure->items[i].map);
    double a = piece->map.m[2][2] * (middle - half) + piece->map.t[2];
    double b = piece->map.m[2][2] * (middle + half) + piece->map.t[2];
    heights[0] = fmin(a, b);
    heights[1] = fmax(a, b);
    return true;
}

/* Corners of an extrusion: those of its figure (discs as points) at both ends. */
static csgm_status extrusion_cloud(csg_module_call *call, clouding *c, const csg_node *node)
{
    csg_eval *e = call->e;
    csg_pieces figure;
    csg_cloud flat;
    double half, middle;
    csgm_status status = CSGM_OK;
    csg_pieces_init(&figure, c->local.memory);
    csg_cloud_init(&flat, c->local.memory);
    slab_of(e->builder.scene, node, &half, &middle);
    c->ok = csg_pieces_collect(e, csg_scene_children(e->builder.scene, node)[0], &figure);
    for (size_t i = 0; i < figure.count && c->ok && status == CSGM_OK; i++)
        status = csg_piece_cloud(call, &figure.items[i], c->tolerance, &flat);
    for (size_t i = 0; i < flat.count && status == CSGM_OK; i++) {
        csg_ball ball = flat.balls[i];
        uint32_t count = ball.radius > 0 ? ring_count(ball.radius, c->tolerance) : 1;
        for (uint32_t k = 0; k < 2 * count; k++) {
            double angle = 360.0 * (k / 2) / count;
            add(c, ball.at.x + ball.radius * csg_cosine_deg(angle),
                ball.at.y + ball.radius * csg_sine_deg(angle), middle + (k & 1 ? half : -half), 0);
        }
    }
    csg_pieces_release(&figure);
    csg_cloud_release(&flat);
    return !c->ok ? CSGM_ERR_MEMORY : status;
}

/* Rings of the balls of a figure that is turned all around. */
static csgm_status revolve_cloud(csg_module_call *call, clouding *c, const csg_node *node)
{
    csg_eval *e = call->e;
    csg_pieces figure;
    csg_cloud flat;
    csgm_status status = CSGM_OK;
    csg_pieces_init(&figure, c->local.memory);
    csg_cloud_init(&flat, c->local.memory);
    c->ok = csg_pieces_collect(e, csg_scene_children(e->builder.scene, node)[0], &figure);
    for (size_t i = 0; i < figure.count && c->ok && status == CSGM_OK; i++)
        status = csg_piece_cloud(call, &figure.items[i], c->tolerance, &flat);
    for (size_t i = 0; i < flat.count && status == CSGM_OK; i++)
        add_ring(c, fabs(flat.balls[i].at.x), flat.balls[i].at.y, flat.balls[i].radius);
    csg_pieces_release(&figure);
    csg_cloud_release(&flat);
    return !c->ok ? CSGM_ERR_MEMORY : status;
}

/* ---- the cloud of any piece ------------------------------------------------------------------ */

static csgm_status tessellated_cloud(csg_module_call *call, clouding *c, bool flat)
{
    csg_triangles triangles;
    csg_outline outline;
    csgm_status status;
    if (flat) {
        status = csg_flat_outline(call, c->piece->node, &outline);
        if (status != CSGM_OK)
            return status;
        for (size_t i = 0; i < outline.point_count && c->ok; i++)
            add(c, outline.points[i].x, outline.points[i].y, 0, 0);
        csg_outline_release(&outline);
    } else {
        csg_triangles_init(&triangles, c->local.memory);
        status = csg_solid_triangles(call, c->piece->node, &triangles);
        for (size_t i = 0; i < triangles.point_count && c->ok && status == CSGM_OK; i++)
            c->ok = csg_cloud_add(&c->local, triangles.points[i], 0);
        csg_triangles_release(&triangles);
    }
    return !c->ok ? CSGM_ERR_MEMORY : status;
}

csgm_status csg_piece_cloud(csg_module_call *call, const csg_piece *piece, double tolerance,
                            csg_cloud *out)
{
    csg_eval *e = call->e;
    const csgm_scene *scene = e->builder.scene;
    const csg_node node = scene->nodes[piece->node];
    bool flat = csg_build_is_flat(&e->builder, piece->node);
    clouding c = {.piece = piece, .tolerance = tolerance, .ok = true};
    csgm_status status = CSGM_OK;
    csg_cloud_init(&c.local, out->memory);
    if (is_extrusion(&node))
        status = extrusion_cloud(call, &c, &node);
    else if (node.kind == CSG_NODE_WARP && scene->warps[node.payload].kind == CSG_WARP_REVOLVE)
        status = revolve_cloud(call, &c, &node);
    else if (!add_leaf(&c, scene, &node))
        status = tessellated_cloud(call, &c, flat);
    if (!c.ok)
        status = CSGM_ERR_MEMORY;
    const double axes[3] = {1, 1, 1};
    bool ellipsoid = node.kind == CSG_NODE_ELLIPSOID;
    if (status == CSGM_OK) /* the tessellation may have moved the arrays */
        status = place(&c, flat, ellipsoid,
                       ellipsoid ? e->builder.scene->parameters + node.payload : axes, out);
    csg_cloud_release(&c.local);
    return status;
}

/* ---- looks ----------------------------------------------------------------------------------- */

static bool is_convex_region(const csg_outline *outline)
{
    size_t count = outline->point_count;
    if (outline->loop_count != 1)
        return false;
    csg_box box = csg_outline_box(outline);
    double slack = 1e-12 * (box.max.x - box.min.x) * (box.max.y - box.min.y);
    for (size_t i = 0; i < count; i++) {
        csg_vec2 a = outline->points[i], b = outline->points[(i + 1) % count],
                 c = outline->points[(i + 2) % count];
        if ((b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x) < -slack)
            return false;
    }
    return true;
}

bool csg_piece_is_convex(const csg_eval *e, const csg_piece *piece)
{
    const csgm_scene *scene = e->builder.scene;
    const csg_node *node = &scene->nodes[piece->node];
    csg_piece inner = *piece;
    csg_pieces figure;
    switch (node->kind) {
    case CSG_NODE_SPHERE:
    case CSG_NODE_CIRCLE:
    case CSG_NODE_BOX:
    case CSG_NODE_RECTANGLE:
    case CSG_NODE_FRUSTUM:
    case CSG_NODE_CAPSULE:
    case CSG_NODE_ELLIPSOID:
        return true;
    case CSG_NODE_SHAPE: {
        const csg_shape *shape = scene->shapes[node->payload];
        return shape->kind == CSG_SHAPE_POLYHEDRON ? csg_polyhedron_is_convex(shape)
                                                   : is_convex_region(csg_region_outline(shape));
    }
    default:
        if (!is_extrusion(node))
            return false;
        inner.node = csg_scene_children(scene, node)[0];
        csg_pieces_init(&figure, e->heap.memory);
        bool convex = csg_pieces_collect(e, inner.node, &figure) && figure.count == 1 &&
                      scene->nodes[figure.items[0].node].kind != CSG_NODE_INTERSECTION &&
                      csg_piece_is_convex(e, &figure.items[0]);
        csg_pieces_release(&figure);
        return convex;
    }
}

bool csg_piece_ball(const csg_eval *e, const csg_piece *piece, csg_ball *out)
{
    const csgm_scene *scene = e->builder.scene;
    const csg_node *node = &scene->nodes[piece->node];
    bool flat = node->kind == CSG_NODE_CIRCLE;
    csg_affine map = flat ? plane_part(piece->map) : piece->map;
    double factor = factor_of(&map);
    if ((node->kind != CSG_NODE_SPHERE && !flat) || factor == 0)
        return false;
    out->at = csg_affine_point(&map, csg_vec3_make(0, 0, 0));
    out->radius = scene->parameters[node->payload] * factor + piece->grow;
    return true;
}
