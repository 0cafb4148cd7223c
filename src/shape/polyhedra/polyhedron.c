/* SPDX-License-Identifier: MIT
 * A polyhedron's field: distance by the tree, sign by the winding number. Most points need no ray.
 * Where the ball to the nearest triangle around one point of a batch holds another, no triangle is
 * between them. Beside a plain triangle (tree_plain.c) the side tells, and beside an edge of two
 * the sum of their normals (Baerentzen and Aanaes 2005). Along x only the stretch between two
 * points is searched. Winding numbers are exact, so every way gives the same. Points nearer than
 * CSG_POLYHEDRON_LEAST to a triangle are on it as far as anybody can tell; their sign is that of
 * the lattice point next to them.
 */
#include "shape/polyhedra/polyhedron.h"

#include <string.h>

#include "base/table.h"
#include "shape/polyhedra/convex.h"
#include "shape/polyhedra/packet.h"
#include "shape/polyhedra/repair.h"
#include "shape/polyhedra/solid.h"

static const csg_shape_operations OPERATIONS;

/* ---- field ------------------------------------------------------------------------------------
 */

typedef struct known_point {
    csg_vec3 at; /* frame units */
    double free; /* no triangle within */
    int winding;
    bool is_set;
} known_point;

/* Goes from point to point. */
typedef struct walker {
    const csg_polyhedron *solid;
    csg_tree_parts parts;
    double limit;          /* frame units: up to there distances are exact */
    known_point last, row; /* the last point, and the last that did not share a row with its last */
    uint32_t hint;
} walker;

typedef struct found {
    csg_vec3 at; /* frame units */
    csg_triangle_hit nearest;
    csg_vec3 foot; /* the nearest point, once it was asked for */
    csg_triangle_part part;
    bool is_located, inside;
} found;

static const uint32_t ROOT = 0;

/* Whether no triangle is between them. */
static bool is_free(const known_point *from, csg_vec3 p, double free)
{
    csg_vec3 away = csg_vec3_sub(p, from->at);
    double reach = fmax(free, from->free);
    return from->is_set && reach > 0 && csg_vec3_dot(away, away) < reach * reach;
}

static bool shares_row(const known_point *from, csg_vec3 p)
{
    return from->is_set && from->at.y == p.y && from->at.z == p.z;
}

static csg_vec3 outward(const csg_tree_triangle *t)
{
    return csg_vec3_normalize(csg_vec3_cross(t->ab, t->ac));
}

static void locate(const csg_polyhedron *solid, found *f)
{
    if (!f->is_located)
        f->foot = csg_triangle_locate(&solid->tree.triangles[f->nearest.place], f->at, &f->part);
    f->is_located = true;
}

/* The winding number at a point, from the triangle that is nearest; false: it does not tell. free:
 * no triangle within. */
static bool read_side(const csg_polyhedron *solid, found *f, double free, int *winding)
{
    /* cosines are off by less: the foot is more than CSG_POLYHEDRON_LEAST away */
    static const double UNCERTAIN = 1e-3;
    /* No corner of a convex solid is nearest to a point within. Where rounding makes a corner of a
     * foot in the face, the way there is the normal. */
    static const double ALONG = 0.9;
    uint32_t place = f->nearest.place;
    const csg_tree_triangle *t = &solid->tree.triangles[place];
    if (!csg_polyhedron_is_plain_beyond(solid, place, free))
        return false;
    locate(solid, f);
    if (f->part == CSG_PART_CORNER && !(solid->is_convex && free > CSG_POLYHEDRON_CONVEX_BEYOND))
        return false;
    if (f->part == CSG_PART_FACE) {
        *winding = csg_vec3_dot(csg_vec3_sub(f->at, t->a), csg_vec3_cross(t->ab, t->ac)) < 0;
        return true;
    }
    csg_vec3 away = csg_vec3_sub(f->at, f->foot);
    if (f->part == CSG_PART_CORNER) {
        *winding = 0;
        return csg_vec3_dot(away, outward(t)) > -ALONG * csg_vec3_norm(away);
    }
    uint32_t other = solid->beside[place][f->part];
    if (other == CSG_TREE_NONE || !csg_polyhedron_is_plain_beyond(solid, other, free))
        return false;
    csg_vec3 normal = csg_vec3_add(outward(t), outward(&solid->tree.triangles[other]));
    double along = csg_vec3_dot(away, normal);
    *winding = along < 0;
    return fabs(along) > UNCERTAIN * csg_vec3_norm(away);
}

/* f->at is in the box. free: no triangle within. is_known: f->nearest is the nearest of all; nearer
 * ones may be left out of the list. */
static int find_winding(walker *w, found *f, double free, bool is_known)
{
    int winding;
    csg_vec3 p = f->at;
    if (is_free(&w->last, p, free))
        return w->last.winding;
    if (is_free(&w->row, p, free))
        return w->row.winding;
    if (free > 0 && is_known && read_side(w->solid, f, free, &winding))
        return winding;
    const csg_tree *tree = &w->solid->tree;
    if (shares_row(&w->last, p))
        return w->last.winding + csg_tree_winding_step(tree, csg_triangle_frame_round_point(p),
                                                       csg_triangle_frame_round_point(w->last.at));
    return csg_tree_winding(tree, csg_triangle_frame_round_point(p), NULL);
}

/* Member by member: a copy by vectors would wait for what was just written. */
static void keep_point(known_point *known, csg_vec3 p, double free, int winding)
{
    known->at.x = p.x;
    known->at.y = p.y;
    known->at.z = p.z;
    known->free = free;
    known->winding = winding;
    known->is_set = true;
}

static bool is_inside(walker *w, found *f, double distance)
{
    csg_vec3 p = f->at;
    if (!csg_box_holds(w->solid->tree.box, p))
        return false;
    double free = fmin(distance, w->limit) * (1 - 0x1p-30) - CSG_POLYHEDRON_LEAST;
    int winding = find_winding(w, f, free, distance < w->limit);
    if (!shares_row(&w->last, p))
        keep_point(&w->row, p, free, winding);
    keep_point(&w->last, p, free, winding);
    return winding >= 1;
}

/* p is in frame units, within 2^60. */
static csg_triangle_hit find_nearest(walker *w, csg_vec3 p)
{
    csg_triangle_hit hit = csg_tree_nearest_of(&w->solid->tree, &w->parts, p, w->hint);
    w->hint = hit.place;
    return hit;
}

/* Not returned: a copy by vectors would wait for what was just written. */
static void look_up(walker *w, csg_vec3 p, csg_triangle_hit nearest, found *f)
{
    f->at = p;
    f->nearest = nearest;
    f->is_located = false;
    f->inside = is_inside(w, f, sqrt(nearest.squared));
}

static walker begin_walk(const csg_polyhedron *solid, const csg_shape_near *near)
{
    walker w = {
        .solid = solid, .parts = {&ROOT, 1, INFINITY}, .limit = INFINITY, .hint = CSG_TREE_NONE};
    if (near) {
        w.parts = (csg_tree_parts){near->items, near->count, INFINITY};
        w.limit = near->limit * solid->frame.scale;
    }
    return w;
}

static double far_value(const csg_polyhedron *solid, csg_vec3 p, csg_vec3 *gradient)
{
    double largest = fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z)));
    csg_vec3 part = csg_vec3_scale(p, 1 / largest);
    if (!isfinite(largest) || isnan(csg_vec3_dot(part, part))) {
        *gradient = csg_vec3_make(0, 0, 0);
        return -INFINITY;
    }
    *gradient = csg_vec3_scale(csg_vec3_normalize(part), -1);
    return -csg_vec3_norm(part) * largest * solid->frame.unscale;
}

static double signed_distance(const csg_polyhedron *solid, const found *f)
{
    double distance = sqrt(f->nearest.squared) * solid->frame.unscale;
    return f->inside || distance == 0 ? distance : -distance;
}

/* Of a face: its normal, which is exact however near the point is. Of edges and corners: away from
 * the foot. On the surface: into the solid. */
static csg_vec3 gradient_of(const csg_polyhedron *solid, found *f)
{
    const csg_tree_triangle *t = &solid->tree.triangles[f->nearest.place];
    locate(solid, f);
    csg_vec3 away = csg_vec3_sub(f->at, f->foot);
    csg_vec3 inward = csg_polyhedron_inward(t);
    if (f->nearest.squared < CSG_POLYHEDRON_LEAST * CSG_POLYHEDRON_LEAST)
        return inward;
    double sign = f->inside ? 1 : -1;
    if (f->part == CSG_PART_FACE)
        return csg_vec3_scale(inward, sign * csg_vec3_dot(away, inward) < 0 ? -1 : 1);
    return csg_vec3_scale(csg_vec3_normalize(away), sign);
}

static double sample_polyhedron(const csg_shape *shape, csg_vec3 p, csg_vec3 *gradient)
{
    const csg_polyhedron *solid = csg_polyhedron_of(shape);
    csg_vec3 at = csg_triangle_frame_enter(&solid->frame, p), ignored;
    if (csg_polyhedron_is_far(at))
        return far_value(solid, at, gradient ? gradient : &ignored);
    walker w = begin_walk(solid, NULL);
    found f;
    look_up(&w, at, find_nearest(&w, at), &f);
    if (gradient)
        *gradient = gradient_of(solid, &f);
    return signed_distance(solid, &f);
}

static csg_vec3 enter_float(const csg_polyhedron *solid, float x, float y, float z)
{
    return csg_triangle_frame_enter(&solid->frame, csg_vec3_make((double)x, (double)y, (double)z));
}

/* Points that are searched together, in frame units. */
enum { PACKET = CSG_PACKET_MOST };

typedef struct packet {
    csg_vec3 at[PACKET];
    csg_triangle_hit nearest[PACKET];
    size_t count;
} packet;

/* False: some point is far away. */
static bool enter_packet(const csg_polyhedron *solid, const float *x, const float *y,
                         const float *z, packet *k)
{
    bool is_near = true;
    for (size_t i = 0; i < k->count; i++) {
        k->at[i] = enter_float(solid, x[i], y[i], z[i]);
        is_near &= !csg_polyhedron_is_far(k->at[i]);
    }
    return is_near;
}

/* Here and below gradients may be NULL. */
static void sample_far(const csg_polyhedron *solid, const packet *k, float *out,
                       csg_vec3 *gradients)
{
    walker w = begin_walk(solid, NULL);
    for (size_t i = 0; i < k->count; i++) {
        csg_vec3 ignored, *gradient = gradients ? &gradients[i] : &ignored;
        if (csg_polyhedron_is_far(k->at[i])) {
            out[i] = (float)far_value(solid, k->at[i], gradient);
            continue;
        }
        found f;
        look_up(&w, k->at[i], find_nearest(&w, k->at[i]), &f);
        out[i] = (float)signed_distance(solid, &f);
        *gradient = gradient_of(solid, &f);
    }
}

/* Samples of a part of a block and more, where most points are so far away that no more than the
 * sign matters. */
enum { MANY = 100 };

/* Where many values are asked for, what is beyond the limit is not looked for. */
static void sample_near(const csg_polyhedron *solid, const csg_shape_kernel *kernel,
                        const csg_shape_near *near, packet *k, float *out, csg_vec3 *gradients)
{
    walker w = begin_walk(solid, near);
    if (near && !gradients && k->count >= MANY) {
        double most = w.limit * (1 + 0x1p-20);
        w.parts.most = most * most;
    }
    csg_packet_search(&w.solid->tree, kernel, &w.parts, k->at, k->count, k->nearest);
    for (size_t i = 0; i < k->count; i++) {
        found f;
        look_up(&w, k->at[i], k->nearest[i], &f);
        out[i] = (float)signed_distance(solid, &f);
        if (gradients)
            gradients[i] = gradient_of(solid, &f);
    }
}

/* At most as many points as fit; how many there were. */
static size_t sample_packet(const csg_polyhedron *solid, const csg_shape_kernel *kernel,
                            const csg_shape_near *near, const float *x, const float *y,
                            const float *z, size_t count, float *out, csg_vec3 *gradients)
{
    packet k;
    k.count = count < PACKET ? count : PACKET;
    if (enter_packet(solid, x, y, z, &k))
        sample_near(solid, kernel, near, &k, out, gradients);
    else
        sample_far(solid, &k, out, gradients);
    return k.count;
}

static void polyhedron_values(const csg_shape *shape, const struct csg_shape_kernel *kernel,
                              const csg_shape_near *near, const float *x, const float *y,
                              const float *z, size_t count, float *out)
{
    const csg_polyhedron *solid = csg_polyhedron_of(shape);
    for (size_t i = 0; i < count;)
        i += sample_packet(solid, kernel, near, x + i, y + i, z + i, count - i, out + i, NULL);
}

static void polyhedron_gradients(const csg_shape *shape, const struct csg_shape_kernel *kernel,
                                 const csg_shape_near *near, const float *x, const float *y,
                                 const float *z, size_t count, float *out, float *gx, float *gy,
                                 float *gz)
{
    const csg_polyhedron *solid = csg_polyhedron_of(shape);
    csg_vec3 gradients[PACKET];
    size_t done;
    for (size_t i = 0; i < count; i += done) {
        done =
            sample_packet(solid, kernel, near, x + i, y + i, z + i, count - i, out + i, gradients);
        for (size_t j = 0; j < done; j++) {
            gx[i + j] = (float)gradients[j].x;
            gy[i + j] = (float)gradients[j].y;
            gz[i + j] = (float)gradients[j].z;
        }
    }
}

/* ---- cells ------------------------------------------------------------------------------------
 */

static uint32_t narrow_polyhedron(const csg_shape *shape, const csg_shape_near *among,
                                  const csg_shape_cell *cell, uint32_t *items)
{
    const csg_polyhedron *solid = csg_polyhedron_of(shape);
    csg_vec3 center = csg_triangle_frame_enter(&solid->frame, cell->center);
    csg_vec3 half = csg_vec3_scale(cell->half, solid->frame.scale);
    double reach = cell->reach * solid->frame.scale + CSG_POLYHEDRON_LEAST;
    if (csg_polyhedron_is_far(center) || !(reach < 0x1p60))
        return 0;
    return csg_tree_narrow(&solid->tree, among ? among->items : NULL, among ? among->count : 0,
                           center, half, reach, items, CSG_SHAPE_MOST_NEAR);
}

/* ---- making it --------------------------------------------------------------------------------
 */

static size_t turn_pieces(csg_polyhedron *solid, csg_chain *chain, const bool *turned)
{
    size_t count = 0;
    for (size_t place = 0; place < solid->tree.count; place++) {
        uint32_t t = solid->tree.triangles[place].index;
        if (!turned[chain->pieces[t]])
            continue;
        csg_tree_turn(&solid->tree, place);
        uint32_t *corners = chain->triangles.corners[t], corner = corners[1];
        corners[1] = corners[2];
        corners[2] = corner;
        count++;
    }
    return count;
}

/* A place in the tree with a triangle of each piece. */
static uint32_t *find_places(csg_arena *scratch, const csg_polyhedron *solid,
                             const csg_chain *chain)
{
    uint32_t *places = csg_arena_alloc(scratch, chain->piece_count * sizeof *places);
    for (size_t i = 0; places && i < solid->tree.count; i++)
        places[chain->pieces[solid->tree.triangles[i].index]] = (uint32_t)i;
    return places;
}

/* Pieces with negative volume as keys, the largest first. */
static size_t list_inverted(const csg_chain *chain, uint64_t *keys)
{
    size_t count = 0;
    for (uint32_t i = 0; i < chain->piece_count; i++) {
        if (chain->volumes[i] >= 0)
            continue;
        float size = (float)-chain->volumes[i];
        uint32_t bits;
        memcpy(&bits, &size, sizeof bits);
        keys[count++] = (uint64_t)(UINT32_MAX - bits) << 32 | i;
    }
    csg_sort_keys(keys, count);
    return count;
}

/* A piece that runs inwards is the hole in one around it; where there is none it is a mistake. */
static bool turn_inverted_pieces(csg_arena *scratch, csg_polyhedron *solid, csg_chain *chain,
                                 csg_repairs *repairs)
{
    enum { MOST = 20000 }; /* rays */
    uint64_t *keys = csg_arena_alloc(scratch, chain->piece_count * sizeof *keys);
    bool *turned = csg_arena_calloc(scratch, chain->piece_count, sizeof *turned);
    uint32_t *places = find_places(scratch, solid, chain);
    if (!keys || !turned || !places)
        return false;
    size_t count = list_inverted(chain, keys);
    for (size_t i = 0; i < count && i < MOST; i++) {
        if (csg_memory_has_ended(scratch->memory))
            return false;
        uint32_t piece = (uint32_t)keys[i];
        csg_tree_filter others = {chain->pieces, turned, piece};
        csg_vec3 p = solid->tree.triangles[places[piece]].a;
        turned[piece] = csg_tree_winding(&solid->tree, p, &others) < 1;
    }
    if (count)
        repairs->flipped += turn_pieces(solid, chain, turned);
    return true;
}

/* Looks at both sides of some triangles: 1 within and 0 without, or solids overlap. */
static bool is_overlapping(const csg_polyhedron *solid)
{
    enum { SAMPLES = 512 };
    size_t step = solid->tree.count / SAMPLES + 1;
    for (size_t i = 0; i < solid->tree.count; i += step) {
        const csg_tree_triangle *t = &solid->tree.triangles[i];
        csg_vec3 middle = csg_vec3_add(t->a, csg_vec3_scale(csg_vec3_add(t->ab, t->ac), 1.0 / 3));
        csg_vec3 out = csg_vec3_scale(csg_vec3_normalize(csg_vec3_cross(t->ab, t->ac)), 0x1p-30);
        csg_vec3 at[2] = {csg_vec3_sub(middle, out), csg_vec3_add(middle, out)};
        for (int k = 0; k < 2; k++) {
            csg_vec3 cell = csg_triangle_frame_round_point(at[k]);
            if (csg_box_holds(solid->tree.box, cell) &&
                csg_tree_winding(&solid->tree, cell, NULL) >= 2 - k)
                return true;
        }
    }
    return false;
}

static uint64_t hash_triangles(const csg_triangles *triangles)
{
    uint64_t hash = CSG_HASH_START;
    for (size_t i = 0; i < triangles->point_count; i++)
        hash = csg_hash_bytes(hash, &triangles->points[i], sizeof *triangles->points);
    return csg_hash_bytes(hash, triangles->corners, triangles->count * sizeof *triangles->corners);
}

/* Takes the chain's triangles, back in the units of the file. */
static void take_triangles(csg_polyhedron *solid, csg_triangles *triangles)
{
    csg_box box = csg_box_empty();
    for (size_t i = 0; i < triangles->point_count; i++)
        triangles->points[i] = csg_triangle_frame_leave(&solid->frame, triangles->points[i]);
    for (size_t t = 0; t < triangles->count; t++)
        for (int k = 0; k < 3; k++)
            csg_box_extend(&box, triangles->points[triangles->corners[t][k]]);
    solid->mended = *triangles;
    solid->shape.box = box;
    solid->hash = hash_triangles(&solid->mended);
}

/* What is known of each triangle of the tree. Edge k of a triangle of the chain is edge k of the
 * same triangle in the tree. */
static bool make_beside(csg_arena *scratch, csg_polyhedron *solid, const csg_triangles *chain,
                        const csg_triangle_edges *edges)
{
    size_t count = solid->tree.count;
    uint32_t *places = csg_arena_alloc(scratch, count * sizeof *places);
    solid->plain = csg_memory_alloc(solid->shape.memory, count * sizeof *solid->plain);
    solid->beside = csg_memory_alloc(solid->shape.memory, count * sizeof *solid->beside);
    solid->turn = csg_memory_alloc(solid->shape.memory, count * sizeof *solid->turn);
    if (!places || !solid->plain || !solid->beside || !solid->turn)
        return false;
    for (size_t i = 0; i < count; i++) {
        places[solid->tree.triangles[i].index] = (uint32_t)i;
        atomic_init(&solid->plain[i], CSG_PLAIN_UNKNOWN);
    }
    for (uint32_t half = 0; half < 3 * chain->count; half++) {
        const csg_edge *edge = &edges->edges[edges->of_half[half]];
        const uint32_t *halves = edges->halves + edge->first;
        uint32_t other = halves[halves[0] == half];
        solid->beside[places[half / 3]][half % 3] =
            edge->count == 2 ? places[other / 3] : CSG_TREE_NONE;
    }
    for (uint32_t i = 0; i < count; i++)
        for (int edge = 0; edge < 3; edge++)
            solid->turn[i][edge] = csg_polyhedron_find_turn(solid, i, edge);
    return true;
}

static void release_solid(csg_polyhedron *solid)
{
    csg_memory *memory = solid->shape.memory;
    csg_memory_release(memory, solid->plain, solid->tree.count * sizeof *solid->plain);
    csg_memory_release(memory, solid->beside, solid->tree.count * sizeof *solid->beside);
    csg_memory_release(memory, solid->turn, solid->tree.count * sizeof *solid->turn);
    csg_tree_release(&solid->tree);
}

/* Fills a shape whose tree is made. */
static csgm_status fill_solid(csg_arena *scratch, csg_polyhedron *solid, csg_chain *chain,
                              csg_repairs *repairs)
{
    csg_triangle_edges edges;
    if (!turn_inverted_pieces(scratch, solid, chain, repairs) ||
        !csg_edges_make(scratch, &chain->triangles, &edges))
        return CSGM_ERR_MEMORY;
    repairs->overlapping = is_overlapping(solid);
    solid->is_convex = chain->piece_count == 1 && !repairs->overlapping && !repairs->holes &&
                       csg_chain_is_convex(&chain->triangles, &edges);
    if (!make_beside(scratch, solid, &chain->triangles, &edges) ||
        !csg_repair_number(scratch, &chain->triangles))
        return CSGM_ERR_MEMORY;
    take_triangles(solid, &chain->triangles);
    return CSGM_OK;
}

static csgm_status create(csg_memory *memory, csg_arena *scratch, const csg_triangles *triangles,
                          csg_repairs *repairs, csg_polyhedron *solid)
{
    csg_chain chain;
    csgm_status status = csg_repair(memory, scratch, triangles, &chain, repairs);
    if (status != CSGM_OK)
        return status;
    *solid = (csg_polyhedron){
        .shape = {.kind = CSG_SHAPE_POLYHEDRON, .operations = &OPERATIONS, .memory = memory},
        .frame = chain.frame};
    atomic_init(&solid->shape.references, 1);
    status = CSGM_ERR_MEMORY;
    if (csg_tree_make(memory, scratch, &chain.triangles, &solid->tree)) {
        status = fill_solid(scratch, solid, &chain, repairs);
        if (status != CSGM_OK)
            release_solid(solid);
    }
    if (status != CSGM_OK)
        csg_triangles_release(&chain.triangles);
    return status;
}

csgm_status csg_polyhedron_create(csg_memory *memory, const csg_triangles *triangles,
                                  csg_repairs *repairs, csg_shape **out)
{
    csg_repairs ignored;
    csg_arena scratch;
    csg_polyhedron *solid = csg_memory_alloc(memory, sizeof *solid);
    if (!solid)
        return CSGM_ERR_MEMORY;
    csg_arena_init(&scratch, memory);
    csgm_status status = create(memory, &scratch, triangles, repairs ? repairs : &ignored, solid);
    csg_arena_reset(&scratch);
    if (status == CSGM_OK)
        *out = &solid->shape;
    else
        csg_memory_release(memory, solid, sizeof *solid);
    return status;
}

static void destroy_polyhedron(csg_shape *shape)
{
    csg_polyhedron *solid = (csg_polyhedron *)shape;
    release_solid(solid);
    csg_triangles_release(&solid->mended);
    csg_memory_release(shape->memory, solid, sizeof *solid);
}

static uint64_t hash_polyhedron(const csg_shape *shape)
{
    return csg_polyhedron_of(shape)->hash;
}

static const csg_shape_operations OPERATIONS = {.destroy = destroy_polyhedron,
                                                .sample = sample_polyhedron,
                                                .values = polyhedron_values,
                                                .gradients = polyhedron_gradients,
                                                .narrow = narrow_polyhedron,
                                                .hash = hash_polyhedron,
                                                .normals = csg_polyhedron_normals,
                                                .creases = csg_polyhedron_creases};

const csg_triangles *csg_polyhedron_triangles(const csg_shape *shape)
{
    return &csg_polyhedron_of(shape)->mended;
}

uint32_t csg_polyhedron_triangle_at(const csg_shape *shape, uint32_t place)
{
    return csg_polyhedron_of(shape)->tree.triangles[place].index;
}

bool csg_polyhedron_near(const csg_shape *shape, uint32_t place, double reach,
                         csg_polyhedron_visit *visit, void *user)
{
    const csg_polyhedron *solid = csg_polyhedron_of(shape);
    const csg_tree_triangle *t = &solid->tree.triangles[place];
    csg_vec3 b = csg_vec3_add(t->a, t->ab), c = csg_vec3_add(t->a, t->ac);
    csg_box box =
        csg_box_hull((csg_box){t->a, t->a}, csg_box_hull((csg_box){b, b}, (csg_box){c, c}));
    return csg_tree_in_box(&solid->tree,
                           csg_box_grow(box, reach * solid->frame.scale + CSG_POLYHEDRON_LEAST),
                           visit, user);
}

bool csg_polyhedron_is_clear(const csg_shape *shape, uint32_t place)
{
    return csg_tree_is_clear(&csg_polyhedron_of(shape)->tree, place);
}

bool csg_polyhedron_is_convex(const csg_shape *shape)
{
    return csg_polyhedron_of(shape)->is_convex;
}
