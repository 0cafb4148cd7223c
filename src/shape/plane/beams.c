/* SPDX-License-Identifier: MIT
 * Edges in beams (crossings.h). Clipper stops at each height where a point is and walks along all
 * edges that reach across it, and once more for each lowest point that it adds. Both sums come from
 * one count of edges per height, after the heights were sorted by their digits.
 */
#include "shape/plane/crossings.h"

#include <string.h>

/* So few points cannot have too many edges in beams. */
enum { ALWAYS_FEW = 10000, MANY = CSG_MOST_EDGES_IN_BEAMS / 8 };

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS };

typedef struct place {
    uint32_t height; /* shifted to be positive; then its rank */
    uint32_t point;
} place;

typedef struct beams {
    const csg_clipper_loops *loops;
    size_t count;
    bool turned;
    place *places, *sorted;
    uint32_t *ranks;  /* per point */
    int32_t *changes; /* per rank: edges that begin less edges that end there; then their sum */
} beams;

static uint32_t height_of(const beams *b, size_t i)
{
    const csg_clipper_point *p = &b->loops->points[i];
    return (uint32_t)((b->turned ? p->x : p->y) + ((int64_t)1 << 31));
}

static void sort_by_digit(const place *from, place *to, size_t count, int shift)
{
    size_t starts[DIGITS] = {0}, sum = 0;
    for (size_t i = 0; i < count; i++)
        starts[from[i].height >> shift & (DIGITS - 1)]++;
    for (size_t d = 0; d < DIGITS; d++) {
        size_t here = starts[d];
        starts[d] = sum;
        sum += here;
    }
    for (size_t i = 0; i < count; i++)
        to[starts[from[i].height >> shift & (DIGITS - 1)]++] = from[i];
}

static void rank_points(beams *b)
{
    uint32_t rank = 0;
    for (size_t i = 0; i < b->count; i++)
        b->places[i] = (place){height_of(b, i), (uint32_t)i};
    sort_by_digit(b->places, b->sorted, b->count, 0);
    sort_by_digit(b->sorted, b->places, b->count, DIGIT_BITS);
    sort_by_digit(b->places, b->sorted, b->count, 2 * DIGIT_BITS);
    for (size_t i = 0; i < b->count; i++) {
        rank += i && b->sorted[i].height != b->sorted[i - 1].height;
        b->ranks[b->sorted[i].point] = rank;
    }
}

static void count_edges(beams *b)
{
    memset(b->changes, 0, b->count * sizeof *b->changes);
    for (size_t loop = 0, i = 0; loop < b->loops->loop_count; loop++) {
        size_t end = b->loops->ends[loop], first = i;
        for (; i < end; i++) {
            uint32_t from = b->ranks[i], to = b->ranks[i + 1 < end ? i + 1 : first];
            b->changes[from] += from < to ? 1 : from > to ? -1 : 0;
            b->changes[to] += from > to ? 1 : from < to ? -1 : 0;
        }
    }
}

static double add_up(beams *b)
{
    double sum = 0;
    int32_t active = 0;
    for (size_t rank = 0; rank < b->count; rank++) {
        active += b->changes[rank];
        b->changes[rank] = active;
        sum += active;
    }
    return sum;
}

/* Edges that are passed on the way to where those of a lowest point belong. */
static double add_lowest_points(const beams *b)
{
    double sum = 0;
    for (size_t loop = 0, i = 0; loop < b->loops->loop_count; loop++) {
        size_t end = b->loops->ends[loop], first = i;
        for (; i < end; i++) {
            uint32_t before = b->ranks[i > first ? i - 1 : end - 1], here = b->ranks[i],
                     after = b->ranks[i + 1 < end ? i + 1 : first];
            if (before > here && after >= here)
                sum += b->changes[here];
        }
    }
    return sum;
}

static double edges_in_beams(beams *b, bool turned)
{
    b->turned = turned;
    rank_points(b);
    count_edges(b);
    double sum = add_up(b);
    return sum + add_lowest_points(b);
}

csgm_status csg_beams_check(csg_memory *memory, const csg_clipper_loops *loops, bool *turned)
{
    size_t count = loops->loop_count ? loops->ends[loops->loop_count - 1] : 0;
    *turned = false;
    if (count <= ALWAYS_FEW)
        return CSGM_OK;
    size_t bytes = count * (2 * sizeof(place) + sizeof(uint32_t) + sizeof(int32_t));
    place *block = csg_memory_alloc(memory, bytes);
    if (!block)
        return CSGM_ERR_MEMORY;
    beams b = {.loops = loops, .count = count, .places = block, .sorted = block + count};
    b.ranks = (uint32_t *)(block + 2 * count);
    b.changes = (int32_t *)(b.ranks + count);
    double edges = edges_in_beams(&b, false);
    if (edges > MANY) {
        double turned_edges = edges_in_beams(&b, true);
        *turned = turned_edges < edges / 4;
        edges = *turned ? turned_edges : edges;
    }
    csg_memory_release(memory, block, bytes);
    return edges > CSG_MOST_EDGES_IN_BEAMS ? CSGM_ERR_LIMIT : CSGM_OK;
}
