/* SPDX-License-Identifier: MIT
 * A region of the plane as a field; see region.h. The distance is that to the nearest segment
 * (region_search.c); the sign is read off that segment where that is safe (region_sign.c), and is
 * the winding number's otherwise. Only exactly rounded operations: the same bits on every machine.
 */
#include "shape/plane/region.h"

#include <string.h>

#include "shape/plane/region_beside.h"
#include "shape/plane/region_sign.h"
#include "shape/plane/region_tree.h"
#include "shape/shape_kernel.h"

typedef struct region {
    csg_shape shape;
    csg_outline outline;
    csg_segment_tree tree;
    csg_segment_sides *sides; /* per segment */
    size_t side_count;
} region;

/* ---- the field ---------------------------------------------------------------------------- */

typedef struct answer {
    double value;
    csg_vec2 gradient;
} answer;

static bool is_inside(const region *r, csg_side side, double left, double x, double y)
{
    switch (side) {
    case CSG_SIDE_LEFT:
        return left >= 0;
    case CSG_SIDE_INSIDE:
        return true;
    case CSG_SIDE_OUTSIDE:
        return false;
    case CSG_SIDE_ASK:
        break;
    }
    return csg_segment_winding(&r->tree, x, y) > 0;
}

/* No point is inside of what has no segments; one that is no point (NaN) is nowhere inside. */
static bool is_nowhere(const region *r, double x, double y)
{
    return !(r->tree.segment_count && fabs(x) < 1e150 && fabs(y) < 1e150);
}

/* Farther than the list's limit another segment may be nearer, and the side of this one wrong. */
static csg_segment_hit nearest_within(const region *r, const csg_shape_near *near,
                                      csg_segment_hit hit, double x, double y)
{
    return hit.squared <= near->limit * near->limit ? hit : csg_segment_nearest(&r->tree, x, y);
}

/* Several points: in lanes where there is a list that all of them search. Lanes left over repeat
 * the last point. */
static void find_nearest(const region *r, const csg_shape_kernel *kernel,
                         const csg_shape_near *near, const double *x, const double *y, size_t count,
                         csg_segment_hit *hits)
{
    enum { LANES = CSG_SHAPE_LANES, FEWEST = 3 }; /* with fewer, lanes cost more than they save */
    if (!near) {
        for (size_t i = 0; i < count; i++)
            hits[i] = csg_segment_nearest(&r->tree, x[i], y[i]);
        return;
    }
    csg_segment_list list = {near->items, near->count};
    for (size_t from = 0; from < count; from += LANES) {
        size_t here = count - from < LANES ? count - from : LANES;
        if (!kernel || here < FEWEST) {
            for (size_t i = from; i < from + here; i++)
                hits[i] = csg_segment_nearest_of(&r->tree, list, x[i], y[i]);
        } else {
            double px[LANES], py[LANES];
            csg_segment_hit found[LANES];
            for (size_t l = 0; l < LANES; l++) {
                px[l] = x[from + (l < here ? l : here - 1)];
                py[l] = y[from + (l < here ? l : here - 1)];
            }
            kernel->nearest_segments(&r->tree, list, px, py, found);
            memcpy(hits + from, found, here * sizeof *hits);
        }
        for (size_t i = from; i < from + here; i++)
            hits[i] = nearest_within(r, near, hits[i], x[i], y[i]);
    }
}

static double value_at(const region *r, csg_segment_hit nearest, double x, double y)
{
    csg_segment_place at = csg_segment_locate(&r->tree, nearest.segment, x, y);
    const csg_segment_sides *sides = &r->sides[nearest.segment];
    csg_side side = (csg_side)(at.along < 0           ? sides->from
                               : at.along > at.length ? sides->to
                                                      : sides->along);
    double distance = sqrt(nearest.squared);
    return is_inside(r, side, at.left, x, y) ? distance : -distance;
}

/* Along the way from the nearest point, but the segment's normal wherever that is meant: there the
 * way may be too short to have a direction. */
static answer answer_at(const region *r, csg_segment_hit nearest, double x, double y)
{
    answer a = {.value = value_at(r, nearest, x, y)};
    const csg_segment_end *s = &r->tree.ends[nearest.segment];
    csg_segment_leaf *leaf = &r->tree.leaves[nearest.segment / CSG_SEGMENT_LANES];
    csg_segment_place at = csg_segment_locate(&r->tree, nearest.segment, x, y);
    bool is_end = at.along < 0 || at.along > at.length;
    if (is_end && a.value != 0) {
        csg_vec2 end = at.along < 0 ? s->from : s->to;
        a.gradient = (csg_vec2){(x - end.x) / a.value, (y - end.y) / a.value};
        return a;
    }
    double sign = at.left != 0 && (at.left > 0) != (a.value > 0) ? -1 : 1;
    a.gradient.x = -sign * leaf->uy[nearest.segment % CSG_SEGMENT_LANES];
    a.gradient.y = sign * leaf->ux[nearest.segment % CSG_SEGMENT_LANES];
    return a;
}

static double sample(const csg_shape *shape, csg_vec3 p, csg_vec3 *gradient)
{
    const region *r = (const region *)shape;
    answer a = {.value = -INFINITY};
    if (!is_nowhere(r, p.x, p.y))
        a = answer_at(r, csg_segment_nearest(&r->tree, p.x, p.y), p.x, p.y);
    *gradient = csg_vec3_make(a.gradient.x, a.gradient.y, 0);
    return a.value;
}

/* Batches come from lattices, where many points differ in z only: points are told apart by the bits
 * of x and y, in a table that is at most half full. */
enum { MOST_POINTS = 256, MOST_PLACES = 2 * MOST_POINTS, NO_NUMBER = UINT16_MAX };

/* Points that differ in x or y. */
typedef struct distinct {
    size_t count;
    uint64_t key[MOST_POINTS]; /* bits of x and y */
    double x[MOST_POINTS], y[MOST_POINTS];
    csg_segment_hit nearest[MOST_POINTS];
    uint32_t of[MOST_POINTS]; /* per point of the batch: its number */
} distinct;

static uint64_t key_of(float x, float y)
{
    uint32_t bits[2];
    memcpy(&bits[0], &x, sizeof x);
    memcpy(&bits[1], &y, sizeof y);
    return (uint64_t)bits[1] << 32 | bits[0];
}

static void tell_apart(const float *x, const float *y, size_t count, distinct *d)
{
    uint16_t places[MOST_PLACES]; /* the number of who is there */
    size_t place_count = 32;
    while (place_count < 2 * count)
        place_count *= 2;
    memset(places, 0xFF, place_count * sizeof *places);
    d->count = 0;
    for (size_t i = 0; i < count; i++) {
        uint64_t key = key_of(x[i], y[i]);
        size_t at = (size_t)(key * 0x9E3779B97F4A7C15u >> 48) & (place_count - 1);
        while (places[at] != NO_NUMBER && d->key[places[at]] != key)
            at = (at + 1) & (place_count - 1);
        if (places[at] == NO_NUMBER) {
            places[at] = (uint16_t)d->count;
            d->key[d->count] = key;
            d->x[d->count] = (double)x[i];
            d->y[d->count++] = (double)y[i];
        }
        d->of[i] = places[at];
    }
}

/* count <= MOST_POINTS */
static void some_values(const region *r, const csg_shape_kernel *kernel, const csg_shape_near *near,
                        const float *x, const float *y, size_t count, float *out)
{
    distinct d;
    float values[MOST_POINTS];
    tell_apart(x, y, count, &d);
    if (r->tree.segment_count)
        find_nearest(r, kernel, near, d.x, d.y, d.count, d.nearest);
    for (size_t i = 0; i < d.count; i++)
        values[i] = is_nowhere(r, d.x[i], d.y[i])
                        ? -INFINITY
                        : (float)value_at(r, d.nearest[i], d.x[i], d.y[i]);
    for (size_t i = 0; i < count; i++)
        out[i] = values[d.of[i]];
}

static void some_gradients(const region *r, const csg_shape_kernel *kernel,
                           const csg_shape_near *near, const float *x, const float *y, size_t count,
                           float *out, float *gx, float *gy)
{
    distinct d;
    answer answers[MOST_POINTS];
    tell_apart(x, y, count, &d);
    if (r->tree.segment_count)
        find_nearest(r, kernel, near, d.x, d.y, d.count, d.nearest);
    for (size_t i = 0; i < d.count; i++) {
        answers[i] = (answer){.value = -INFINITY};
        if (!is_nowhere(r, d.x[i], d.y[i]))
            answers[i] = answer_at(r, d.nearest[i], d.x[i], d.y[i]);
    }
    for (size_t i = 0; i < count; i++) {
        answer a = answers[d.of[i]];
        out[i] = (float)a.value;
        gx[i] = (float)a.gradient.x;
        gy[i] = (float)a.gradient.y;
    }
}

static void values(const csg_shape *shape, const csg_shape_kernel *kernel,
                   const csg_shape_near *near, const float *x, const float *y, const float *z,
                   size_t count, float *out)
{
    const region *r = (const region *)shape;
    for (size_t i = 0; i < count; i += MOST_POINTS)
        some_values(r, kernel, near, x + i, y + i,
                    count - i < MOST_POINTS ? count - i : MOST_POINTS, out + i);
}

static void gradients(const csg_shape *shape, const csg_shape_kernel *kernel,
                      const csg_shape_near *near, const float *x, const float *y, const float *z,
                      size_t count, float *out, float *gx, float *gy, float *gz)
{
    const region *r = (const region *)shape;
    for (size_t i = 0; i < count; i += MOST_POINTS)
        some_gradients(r, kernel, near, x + i, y + i,
                       count - i < MOST_POINTS ? count - i : MOST_POINTS, out + i, gx + i, gy + i);
    for (size_t i = 0; i < count; i++)
        gz[i] = 0;
}

/* ---- the shape ---------------------------------------------------------------------------- */

/* FNV-1a, a word at a time, with more mixing. */
static uint64_t hash_word(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * 0x100000001B3u;
    return hash ^ hash >> 29;
}

static uint64_t hash_coordinate(uint64_t hash, double value)
{
    uint64_t bits;
    value += 0; /* one zero only */
    memcpy(&bits, &value, sizeof bits);
    return hash_word(hash, bits);
}

uint64_t csg_region_hash(const csg_outline *outline)
{
    uint64_t h = 0xCBF29CE484222325u;
    for (size_t i = 0; i < outline->point_count; i++)
        h = hash_coordinate(hash_coordinate(h, outline->points[i].x), outline->points[i].y);
    for (size_t loop = 0; loop < outline->loop_count; loop++)
        h = hash_word(h, outline->ends[loop]);
    return h;
}

static uint64_t hash(const csg_shape *shape)
{
    return csg_region_hash(&((const region *)shape)->outline);
}

static void destroy(csg_shape *shape)
{
    region *r = (region *)shape;
    csg_memory *memory = shape->memory;
    csg_outline_release(&r->outline);
    csg_segment_tree_release(&r->tree);
    csg_memory_release(memory, r->sides, r->side_count * sizeof *r->sides);
    csg_memory_release(memory, r, sizeof *r);
}

/* ---- normals ------------------------------------------------------------------------------ */

typedef struct taking {
    const csg_segment_tree *tree;
    csg_shape_take_normal *take;
    void *user;
    uint32_t count;
} taking;

static bool take_segment(void *user, uint32_t segment)
{
    enum { MOST = 256 };
    taking *t = user;
    const csg_segment_leaf *leaf = &t->tree->leaves[segment / CSG_SEGMENT_LANES];
    uint32_t k = segment % CSG_SEGMENT_LANES;
    return ++t->count <= MOST && t->take(t->user, csg_vec3_make(-leaf->uy[k], leaf->ux[k], 0));
}

/* Within the ball distances are at most that of c and its radius. */
static bool normals(const csg_shape *shape, csg_vec3 c, double radius, csg_shape_take_normal *take,
                    void *user)
{
    const region *r = (const region *)shape;
    if (is_nowhere(r, c.x, c.y))
        return false;
    double least = sqrt(csg_segment_nearest(&r->tree, c.x, c.y).squared);
    taking t = {&r->tree, take, user, 0};
    return csg_segment_within(&r->tree, c.x, c.y, (least + 2 * radius) * (1 + 0x1p-40),
                              take_segment, &t);
}

/* ---- beside the outline ------------------------------------------------------------------- */

static csg_beside beside(const csg_shape *shape, const csg_vec3 triangle[3], double turn,
                         double at[3])
{
    const region *r = (const region *)shape;
    csg_vec2 corners[3], c = {0, 0};
    for (int k = 0; k < 3; k++) {
        corners[k] = (csg_vec2){triangle[k].x, triangle[k].y};
        c.x += corners[k].x / 3;
        c.y += corners[k].y / 3;
    }
    if (is_nowhere(r, c.x, c.y))
        return CSG_BESIDE_UNKNOWN;
    csg_segment_hit hit = csg_segment_nearest(&r->tree, c.x, c.y);
    return csg_region_beside(&r->tree, r->sides, corners, c, hit.segment,
                             value_at(r, hit, c.x, c.y), turn, at);
}

static uint32_t narrow(const csg_shape *shape, const csg_shape_near *among,
                       const csg_shape_cell *cell, uint32_t *items)
{
    const region *r = (const region *)shape;
    csg_vec3 c = cell->center, h = cell->half;
    if (is_nowhere(r, c.x, c.y) || !(h.x < 1e150 && h.y < 1e150))
        return 0;
    csg_segment_list list = {among ? among->items : NULL, among ? among->count : 0};
    return csg_segment_narrow(&r->tree, list, (csg_vec2){c.x, c.y}, (csg_vec2){h.x, h.y},
                              cell->reach, items, CSG_SHAPE_MOST_NEAR);
}

static const csg_shape_operations operations = {.destroy = destroy,
                                                .sample = sample,
                                                .values = values,
                                                .gradients = gradients,
                                                .narrow = narrow,
                                                .hash = hash,
                                                .normals = normals,
                                                .creases = NULL,
                                                .beside = beside};

/* Below that squares do not overflow. */
static bool is_in_range(const csg_outline *outline)
{
    for (size_t i = 0; i < outline->point_count; i++) {
        if (!(fabs(outline->points[i].x) < 1e150 && fabs(outline->points[i].y) < 1e150))
            return false;
    }
    return true;
}

static bool fill(region *r, const csg_outline *outline)
{
    csg_memory *memory = r->shape.memory;
    if (!csg_outline_append(&r->outline, outline) ||
        !csg_segment_tree_init(&r->tree, memory, &r->outline))
        return false;
    r->side_count = r->tree.segment_count;
    if (!r->side_count)
        return true;
    r->sides = csg_memory_alloc(memory, r->side_count * sizeof *r->sides);
    if (!r->sides)
        return false;
    csg_region_sides(&r->tree, r->sides);
    r->shape.box = r->tree.box;
    r->shape.box.min.z = -INFINITY;
    r->shape.box.max.z = INFINITY;
    return true;
}

csgm_status csg_region_create(csg_memory *memory, const csg_outline *outline, csg_shape **out)
{
    if (!is_in_range(outline))
        return CSGM_ERR_SCENE;
    region *r = csg_memory_alloc(memory, sizeof *r);
    if (!r)
        return CSGM_ERR_MEMORY;
    *r = (region){.shape = {.kind = CSG_SHAPE_REGION,
                            .operations = &operations,
                            .memory = memory,
                            .references = 1,
                            .box = csg_box_empty()}};
    csg_outline_init(&r->outline, memory);
    r->tree.memory = memory;
    if (!fill(r, outline)) {
        destroy(&r->shape);
        return CSGM_ERR_MEMORY;
    }
    *out = &r->shape;
    return CSGM_OK;
}

const csg_outline *csg_region_outline(const csg_shape *shape)
{
    return &((const region *)shape)->outline;
}
