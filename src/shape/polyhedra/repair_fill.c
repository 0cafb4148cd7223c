/* SPDX-License-Identifier: MIT
 * One loop of points in space -> triangles. Up to 128 points: those of least area (dynamic
 * programming, Barequet and Sharir 1995). Longer loops first lose corners, always the one whose two
 * neighbours are nearest to each other: what zips a long thin crack as it should be.
 */
#include "shape/polyhedra/repair.h"

enum { EXACT_MOST = 128, EXACT_LEAST = 12, CHORDS_PER_QUESTION = 4096 };

static double distance2(const csg_triangles *triangles, uint32_t a, uint32_t b)
{
    csg_vec3 away = csg_vec3_sub(triangles->points[a], triangles->points[b]);
    return csg_vec3_dot(away, away);
}

/* Area, and a little for length so that equal areas prefer short diagonals. */
static double cost(const csg_triangles *triangles, uint32_t a, uint32_t b, uint32_t c)
{
    csg_vec3 p = triangles->points[a];
    csg_vec3 normal = csg_vec3_cross(csg_vec3_sub(triangles->points[b], p),
                                     csg_vec3_sub(triangles->points[c], p));
    return csg_vec3_norm(normal) + 1e-6 * distance2(triangles, a, c);
}

/* ---- least area -------------------------------------------------------------------------------
 */

typedef struct plan {
    double cost;
    uint32_t split;
} plan;

static void plan_span(const csg_triangles *triangles, const uint32_t *loop, plan *plans,
                      uint32_t count, uint32_t i, uint32_t j)
{
    plan best = {INFINITY, i + 1};
    for (uint32_t k = i + 1; k < j; k++) {
        double sum = plans[i * count + k].cost + plans[k * count + j].cost +
                     cost(triangles, loop[i], loop[k], loop[j]);
        if (sum < best.cost)
            best = (plan){sum, k};
    }
    plans[i * count + j] = best;
}

/* stack: room for 2 count numbers. */
static bool add_planned(csg_triangles *triangles, const uint32_t *loop, const plan *plans,
                        uint32_t count, uint32_t *stack)
{
    size_t depth = 0;
    stack[depth++] = 0;
    stack[depth++] = count - 1;
    while (depth) {
        uint32_t j = stack[--depth], i = stack[--depth];
        if (j - i < 2)
            continue;
        uint32_t k = plans[i * count + j].split;
        if (!csg_triangles_add(triangles, loop[i], loop[k], loop[j]))
            return false;
        stack[depth++] = i;
        stack[depth++] = k;
        stack[depth++] = k;
        stack[depth++] = j;
    }
    return true;
}

static bool fill_exactly(csg_arena *scratch, csg_triangles *triangles, const uint32_t *loop,
                         uint32_t count)
{
    plan *plans = csg_arena_calloc(scratch, (size_t)count * count, sizeof *plans);
    uint32_t *stack = csg_arena_alloc(scratch, 4 * (size_t)count * sizeof *stack);
    if (!plans || !stack)
        return false;
    for (uint32_t span = 2; span < count; span++)
        for (uint32_t i = 0; i + span < count; i++)
            plan_span(triangles, loop, plans, count, i, i + span);
    return add_planned(triangles, loop, plans, count, stack);
}

/* ---- shortest chords --------------------------------------------------------------------------
 */

typedef struct chord {
    double length2;
    uint32_t tip, stamp; /* the corner that it cuts off, and the tip's stamp when it was made */
} chord;

typedef struct zipper {
    const csg_triangles *triangles;
    uint32_t *loop, *next, *previous, *stamps;
    chord *heap;
    size_t count;
} zipper;

static bool is_before(chord a, chord b)
{
    return a.length2 < b.length2 || (a.length2 == b.length2 && a.tip < b.tip);
}

static void push_chord(zipper *z, uint32_t tip)
{
    chord fresh = {distance2(z->triangles, z->loop[z->previous[tip]], z->loop[z->next[tip]]), tip,
                   ++z->stamps[tip]};
    size_t at = z->count++;
    for (; at > 0 && is_before(fresh, z->heap[(at - 1) / 2]); at = (at - 1) / 2)
        z->heap[at] = z->heap[(at - 1) / 2];
    z->heap[at] = fresh;
}

static chord pop(zipper *z)
{
    chord top = z->heap[0], last = z->heap[--z->count];
    size_t at = 0;
    for (size_t child = 1; child < z->count; child = 2 * at + 1) {
        child += child + 1 < z->count && is_before(z->heap[child + 1], z->heap[child]);
        if (!is_before(z->heap[child], last))
            break;
        z->heap[at] = z->heap[child];
        at = child;
    }
    z->heap[at] = last;
    return top;
}

/* Down to `goal` corners, which are moved to the loop's front. */
static bool zip(csg_triangles *triangles, zipper *z, size_t count, size_t goal)
{
    uint32_t at = 0;
    for (size_t left = count; left > goal;) {
        chord top = pop(z);
        if (left % CHORDS_PER_QUESTION == 0 && csg_memory_has_ended(triangles->memory))
            return false;
        if (top.stamp != z->stamps[top.tip])
            continue;
        uint32_t before = z->previous[top.tip], after = z->next[top.tip];
        if (!csg_triangles_add(triangles, z->loop[before], z->loop[top.tip], z->loop[after]))
            return false;
        z->stamps[top.tip] = 0;
        z->next[before] = after;
        z->previous[after] = before;
        push_chord(z, before);
        push_chord(z, after);
        at = before < after ? before : after;
        left--;
    }
    /* the smallest place that is left, so that nothing is written before it is read */
    while (z->previous[at] < at)
        at = z->previous[at];
    for (size_t i = 0; i < goal; i++, at = z->next[at])
        z->loop[i] = z->loop[at];
    return true;
}

static bool zip_down(csg_arena *scratch, csg_triangles *triangles, uint32_t *loop, size_t count,
                     size_t goal)
{
    zipper z = {.triangles = triangles,
                .loop = loop,
                .next = csg_arena_alloc(scratch, count * sizeof *z.next),
                .previous = csg_arena_alloc(scratch, count * sizeof *z.previous),
                .stamps = csg_arena_calloc(scratch, count, sizeof *z.stamps),
                .heap = csg_arena_alloc(scratch, 3 * count * sizeof *z.heap)};
    if (!z.next || !z.previous || !z.stamps || !z.heap)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        z.next[i] = i + 1 < count ? i + 1 : 0;
        z.previous[i] = i ? i - 1 : (uint32_t)count - 1;
    }
    for (uint32_t i = 0; i < count; i++)
        push_chord(&z, i);
    return zip(triangles, &z, count, goal);
}

bool csg_repair_fill_loop(csg_arena *scratch, csg_triangles *triangles, uint32_t *loop,
                          size_t count, uint64_t *effort)
{
    csg_arena_mark mark = csg_arena_get_mark(scratch);
    uint64_t most = (uint64_t)EXACT_MOST * EXACT_MOST * EXACT_MOST / 6;
    size_t goal = *effort >= most ? EXACT_MOST : EXACT_LEAST;
    if (count > goal) {
        if (!zip_down(scratch, triangles, loop, count, goal))
            return false;
        count = goal;
    }
    uint64_t work = (uint64_t)count * count * count / 6;
    *effort -= work < *effort ? work : *effort;
    if (!fill_exactly(scratch, triangles, loop, (uint32_t)count))
        return false;
    csg_arena_release_to(scratch, mark);
    return true;
}
