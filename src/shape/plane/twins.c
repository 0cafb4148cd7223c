/* SPDX-License-Identifier: MIT
 * Loops that are drawn twice cancel out where areas alternate (EVEN_ODD): drawings that place a
 * part many times at one place have them, and Clipper takes very long for edges that lie on each
 * other. Loops are the same when their edges are, in any order and direction: a sum over the edges
 * of 128 mixed bits tells; that two others have the same sum by chance does not happen.
 */
#include "shape/plane/twins.h"

#include <stdlib.h>

typedef struct mark {
    uint64_t high, low;
    uint32_t loop, count;
} mark;

/* The finalizer of MurmurHash3 (A. Appleby). */
static uint64_t mix(uint64_t bits)
{
    bits = (bits ^ bits >> 33) * 0xFF51AFD7ED558CCDu;
    bits = (bits ^ bits >> 33) * 0xC4CEB9FE1A85EC53u;
    return bits ^ bits >> 33;
}

static uint64_t hash_of(csg_clipper_point p)
{
    return mix(mix((uint64_t)p.x + 0x9E3779B97F4A7C15u) + (uint64_t)p.y);
}

static mark mark_of(const csg_clipper_loops *loops, size_t loop, size_t first)
{
    size_t end = loops->ends[loop];
    mark m = {.loop = (uint32_t)loop, .count = (uint32_t)(end - first)};
    for (size_t i = first; i < end; i++) {
        uint64_t a = hash_of(loops->points[i]);
        uint64_t b = hash_of(loops->points[i + 1 < end ? i + 1 : first]);
        m.high += mix((a + b) ^ mix(a ^ b));
        m.low += mix((a ^ b) + 3 * mix(a + b));
    }
    return m;
}

static int compare_marks(const void *left, const void *right)
{
    const mark *a = left, *b = right;
    if (a->count != b->count)
        return (a->count > b->count) - (a->count < b->count);
    if (a->high != b->high)
        return (a->high > b->high) - (a->high < b->high);
    if (a->low != b->low)
        return (a->low > b->low) - (a->low < b->low);
    return (a->loop > b->loop) - (a->loop < b->loop);
}

static bool are_twins(const mark *a, const mark *b)
{
    return a->count == b->count && a->high == b->high && a->low == b->low;
}

/* Of each group of twins the first stays if their number is odd. */
static void choose(mark *marks, size_t count, bool *stays)
{
    qsort(marks, count, sizeof *marks, compare_marks);
    for (size_t first = 0, end; first < count; first = end) {
        for (end = first + 1; end < count && are_twins(&marks[first], &marks[end]); end++)
            stays[marks[end].loop] = false;
        stays[marks[first].loop] = (end - first) % 2 == 1;
    }
}

static size_t close_up(csg_clipper_point *points, uint32_t *ends, size_t loop_count,
                       const bool *stays)
{
    size_t kept = 0, at = 0, first = 0;
    for (size_t loop = 0; loop < loop_count; loop++) {
        size_t end = ends[loop];
        for (size_t i = first; i < end && stays[loop]; i++)
            points[at++] = points[i];
        if (stays[loop])
            ends[kept++] = (uint32_t)at;
        first = end;
    }
    return kept;
}

bool csg_twins_drop(csg_memory *memory, csg_clipper_point *points, uint32_t *ends,
                    size_t *loop_count)
{
    size_t count = *loop_count, bytes = count * (sizeof(mark) + sizeof(bool));
    if (count < 2)
        return true;
    const csg_clipper_loops loops = {points, ends, count};
    mark *marks = csg_memory_alloc(memory, bytes);
    if (!marks)
        return false;
    bool *stays = (bool *)(marks + count);
    for (size_t loop = 0; loop < count; loop++)
        marks[loop] = mark_of(&loops, loop, loop ? ends[loop - 1] : 0);
    choose(marks, count, stays);
    *loop_count = close_up(points, ends, count, stays);
    csg_memory_release(memory, marks, bytes);
    return true;
}
