/* SPDX-License-Identifier: MIT
 * Triangles of a clean outline by cutting ears (Meisters 1975): holes are joined to the ring around
 * them (rings.h), then corners whose triangle holds no other corner are cut off one by one. Only
 * corners that are not convex can stand in the way; they lie in a grid of cells, so that an ear
 * looks at few of them and ordinary outlines take about linear time.
 *
 * Whatever the coordinates, every edge of the rings is used once and every diagonal twice, in both
 * directions. Where rounding left no ear (loops that touch along edges), the demands are
 * relaxed step by step, so it always ends.
 */
#include <string.h>

#include "shape/plane/polygons.h"
#include "shape/plane/rings.h"

typedef struct cells {
    uint32_t *first; /* per cell: a blocker, or none */
    uint32_t width, height;
    double left, bottom, per_x, per_y; /* cells a length */
} cells;

typedef struct cutter {
    csg_memory *memory;
    csg_rings rings;
    size_t corner_capacity;
    csg_ring_start *starts;
    size_t ring_count, start_capacity;
    cells cells;
    size_t cell_capacity;
    uint32_t *indices;
    size_t index_count, index_capacity;
    uint64_t work; /* corners looked at */
} cutter;

/* About two seconds. Ordinary outlines of a million corners need a tenth of it. */
static const uint64_t most_work = 600000000;

/* What an ear may be, from the best on. */
typedef enum ear_kind {
    SPIKE,     /* no angle */
    PROPER,    /* area, and nothing else in it or at its edges */
    NOT_WRONG, /* nothing inside it; may be flat */
    NOT_TURNED,
    ANY
} ear_kind;

/* Holes that lie in nothing stay rings of their own, behind the others. */
static void join_holes(cutter *c, size_t hole_count)
{
    csg_ring_start *holes = c->starts + c->ring_count;
    size_t left_over = 0;
    for (size_t i = 0; i < hole_count && c->work <= most_work; i++) {
        c->work += c->rings.corner_count;
        if (!csg_ring_join(&c->rings, holes[i].corner))
            holes[left_over++] = holes[i];
    }
    c->ring_count += left_over;
}

/* ---- cells of blockers -------------------------------------------------------------------- */

static uint32_t cell_along(double at, double low, double per_length, uint32_t count)
{
    double cell = (at - low) * per_length;
    return cell < count - 1 ? (cell > 0 ? (uint32_t)cell : 0) : count - 1;
}

static uint32_t *cell_of(const cells *g, csg_vec2 p)
{
    uint32_t x = cell_along(p.x, g->left, g->per_x, g->width);
    uint32_t y = cell_along(p.y, g->bottom, g->per_y, g->height);
    return &g->first[(size_t)y * g->width + x];
}

static int turn_at(const csg_rings *rings, uint32_t i)
{
    const csg_ring_corner *c = &rings->corners[i];
    return csg_orient_plane(csg_ring_at(rings, c->previous), csg_ring_at(rings, i),
                            csg_ring_at(rings, c->next));
}

/* Marks the ring's blockers; its box and its number of corners. */
static size_t survey(cutter *c, uint32_t start, csg_box *box, size_t *blockers)
{
    size_t count = 0;
    uint32_t i = start;
    *box = csg_box_empty();
    *blockers = 0;
    do {
        csg_vec2 p = csg_ring_at(&c->rings, i);
        csg_vec3 at = csg_vec3_make(p.x, p.y, 0);
        *box = csg_box_hull(*box, (csg_box){at, at});
        c->rings.corners[i].is_blocker = turn_at(&c->rings, i) <= 0;
        *blockers += c->rings.corners[i].is_blocker;
        count++;
        i = c->rings.corners[i].next;
    } while (i != start);
    return count;
}

/* About two cells a blocker, never more than were allocated. */
static void fill_cells(cutter *c, uint32_t start, csg_box box, size_t blockers)
{
    cells *g = &c->cells;
    double width = box.max.x - box.min.x, height = box.max.y - box.min.y;
    double most = fmin(2 * (double)blockers + 1, (double)c->cell_capacity);
    double side = sqrt(width * height / most);
    g->width = side > 0 ? (uint32_t)fmin(fmax(width / side, 1), most) : 1;
    g->height = (uint32_t)fmax(most / g->width, 1);
    g->left = box.min.x;
    g->bottom = box.min.y;
    g->per_x = width > 0 ? g->width / width : 0;
    g->per_y = height > 0 ? g->height / height : 0;
    for (size_t i = 0; i < (size_t)g->width * g->height; i++)
        g->first[i] = CSG_CORNER_NONE;
    uint32_t i = start;
    do {
        csg_ring_corner *corner = &c->rings.corners[i];
        if (corner->is_blocker) {
            uint32_t *cell = cell_of(g, csg_ring_at(&c->rings, i));
            corner->next_in_cell = *cell;
            *cell = i;
        }
        i = corner->next;
    } while (i != start);
}

/* ---- ears --------------------------------------------------------------------------------- */

static bool is_same(csg_vec2 a, csg_vec2 b)
{
    return a.x == b.x && a.y == b.y;
}

/* Whether a neighbour of r, which lies on the ear's tip, leads into the ear. */
static bool leads_into(const csg_rings *rings, uint32_t r, const csg_vec2 *ear)
{
    const csg_ring_corner *c = &rings->corners[r];
    csg_vec2 ways[2] = {csg_ring_at(rings, c->previous), csg_ring_at(rings, c->next)};
    for (int k = 0; k < 2; k++) {
        if (csg_orient_plane(ear[1], ear[2], ways[k]) > 0 &&
            csg_orient_plane(ear[1], ways[k], ear[0]) > 0)
            return true;
    }
    return false;
}

static bool is_blocked_by(const csg_rings *rings, uint32_t r, const csg_vec2 *ear, ear_kind kind)
{
    csg_vec2 p = csg_ring_at(rings, r);
    if (is_same(p, ear[0]) || is_same(p, ear[2]))
        return false;
    if (is_same(p, ear[1]))
        return leads_into(rings, r, ear);
    int inside = kind == PROPER ? 0 : 1;
    return csg_orient_plane(ear[0], ear[1], p) >= inside &&
           csg_orient_plane(ear[1], ear[2], p) >= inside &&
           csg_orient_plane(ear[2], ear[0], p) >= inside;
}

static bool is_blocked(cutter *c, uint32_t tip, const csg_vec2 *ear, ear_kind kind)
{
    const cells *g = &c->cells;
    const csg_ring_corner *corners = c->rings.corners;
    double x0 = fmin(ear[0].x, fmin(ear[1].x, ear[2].x));
    double x1 = fmax(ear[0].x, fmax(ear[1].x, ear[2].x));
    double y0 = fmin(ear[0].y, fmin(ear[1].y, ear[2].y));
    double y1 = fmax(ear[0].y, fmax(ear[1].y, ear[2].y));
    uint32_t left = cell_along(x0, g->left, g->per_x, g->width),
             right = cell_along(x1, g->left, g->per_x, g->width),
             top = cell_along(y1, g->bottom, g->per_y, g->height);
    for (uint32_t y = cell_along(y0, g->bottom, g->per_y, g->height); y <= top; y++) {
        for (uint32_t x = left; x <= right; x++) {
            uint32_t r = g->first[(size_t)y * g->width + x];
            c->work++;
            for (; r != CSG_CORNER_NONE; r = corners[r].next_in_cell) {
                c->work++;
                if (corners[r].is_blocker && r != tip && r != corners[tip].previous &&
                    r != corners[tip].next && is_blocked_by(&c->rings, r, ear, kind))
                    return true;
            }
        }
    }
    return false;
}

/* A corner without an angle: what led to it leads back, or it stands where its neighbour does. Cut
 * off at once, or the two sides of such a way would become ears that cover each other. */
static bool is_spike(const csg_rings *rings, uint32_t tip)
{
    const csg_ring_corner *corner = &rings->corners[tip];
    csg_vec2 a = csg_ring_at(rings, corner->previous), b = csg_ring_at(rings, tip),
             c = csg_ring_at(rings, corner->next);
    return csg_orient_plane(a, b, c) == 0 &&
           (a.x - b.x) * (c.x - b.x) + (a.y - b.y) * (c.y - b.y) >= 0;
}

static bool is_ear(cutter *c, uint32_t tip, ear_kind kind)
{
    const csg_ring_corner *corner = &c->rings.corners[tip];
    int turn = turn_at(&c->rings, tip);
    if (kind == SPIKE)
        return is_spike(&c->rings, tip);
    if (kind == ANY)
        return true;
    if (turn < 0 || (turn == 0 && kind == PROPER))
        return false;
    if (kind == NOT_TURNED)
        return true;
    csg_vec2 ear[3] = {csg_ring_at(&c->rings, corner->previous), csg_ring_at(&c->rings, tip),
                       csg_ring_at(&c->rings, corner->next)};
    return !is_blocked(c, tip, ear, kind);
}

static void cut_ear(cutter *c, uint32_t tip)
{
    csg_ring_corner *corners = c->rings.corners;
    uint32_t before = corners[tip].previous, after = corners[tip].next;
    uint32_t i = corners[before].point, j = corners[tip].point, k = corners[after].point;
    if (i != j && j != k && k != i) { /* else its edges would cancel out */
        c->indices[c->index_count++] = i;
        c->indices[c->index_count++] = j;
        c->indices[c->index_count++] = k;
    }
    corners[before].next = after;
    corners[after].previous = before;
    corners[tip].is_blocker = false;
    /* what was convex stays so */
    corners[before].is_blocker &= turn_at(&c->rings, before) <= 0;
    corners[after].is_blocker &= turn_at(&c->rings, after) <= 0;
}

static void cut_ring(cutter *c, uint32_t start)
{
    csg_box box;
    size_t blockers, left = survey(c, start, &box, &blockers), misses = 0;
    ear_kind kind = SPIKE;
    fill_cells(c, start, box, blockers);
    for (uint32_t i = start; left >= 3 && c->work <= most_work;) {
        uint32_t before = c->rings.corners[i].previous, next = c->rings.corners[i].next;
        if (is_ear(c, i, kind)) {
            cut_ear(c, i);
            left--;
            misses = 0;
            bool is_before = is_spike(&c->rings, before), is_next = is_spike(&c->rings, next);
            kind = kind == SPIKE || is_before || is_next ? SPIKE : PROPER;
            i = is_before ? before
                : is_next ? next
                          : c->rings.corners[next].next; /* not the neighbour: no fans */
            continue;
        }
        i = next;
        if (++misses >= left) {
            misses = 0;
            kind += kind < ANY;
        }
    }
}

/* ---- all ---------------------------------------------------------------------------------- */

static bool allocate(cutter *c)
{
    const csg_outline *outline = c->rings.outline;
    size_t points = csg_outline_first(outline, outline->loop_count);
    if (points >= UINT32_MAX / 8)
        return false;
    c->start_capacity = points;
    c->corner_capacity = points + 2 * (points / 3); /* a hole has three corners or more */
    c->cell_capacity = 2 * c->corner_capacity;
    c->index_capacity = 3 * c->corner_capacity;
    c->rings.corners = csg_memory_alloc(c->memory, c->corner_capacity * sizeof *c->rings.corners);
    c->starts = csg_memory_alloc(c->memory, c->start_capacity * sizeof *c->starts);
    c->cells.first = csg_memory_alloc(c->memory, c->cell_capacity * sizeof *c->cells.first);
    c->indices = csg_memory_alloc(c->memory, c->index_capacity * sizeof *c->indices);
    return c->rings.corners && c->starts && c->cells.first && c->indices;
}

static void release(cutter *c)
{
    csg_memory_release(c->memory, c->rings.corners, c->corner_capacity * sizeof *c->rings.corners);
    csg_memory_release(c->memory, c->starts, c->start_capacity * sizeof *c->starts);
    csg_memory_release(c->memory, c->cells.first, c->cell_capacity * sizeof *c->cells.first);
    csg_memory_release(c->memory, c->indices, c->index_capacity * sizeof *c->indices);
}

static void cut_rings(cutter *c)
{
    size_t holes;
    csg_rings_link(&c->rings, c->starts, &c->ring_count, &holes);
    join_holes(c, holes);
    for (size_t i = 0; i < c->ring_count; i++)
        cut_ring(c, c->starts[i].corner);
}

csgm_status csg_polygons_triangulate(const csg_outline *in, csg_memory *memory, uint32_t **indices,
                                     size_t *index_count)
{
    cutter c = {.memory = memory, .rings = {.outline = in}};
    *indices = NULL;
    *index_count = 0;
    if (!in->loop_count)
        return CSGM_OK;
    bool is_room = allocate(&c);
    if (is_room)
        cut_rings(&c);
    if (c.work > most_work) {
        release(&c);
        return CSGM_ERR_LIMIT;
    }
    if (is_room && c.index_count) {
        size_t bytes = c.index_count * sizeof **indices;
        *indices = csg_memory_alloc(memory, bytes);
        is_room = *indices != NULL;
        if (is_room) {
            memcpy(*indices, c.indices, bytes);
            *index_count = c.index_count;
        }
    }
    release(&c);
    return is_room ? CSGM_OK : CSGM_ERR_MEMORY;
}
