/* SPDX-License-Identifier: MIT
 * Splitting loops where they touch themselves (simple_loops.h): the points walked so far stand on a
 * stack. Where one comes again, what was walked since is a loop of its own.
 */
#include "shape/plane/simple_loops.h"

#include <stdlib.h>

typedef struct visit {
    csg_clipper_point at;
    uint32_t number; /* in the loop */
    uint32_t first;  /* number of the first visit there */
    uint32_t depth;  /* of the point in the stack + 1; 0: not there. Kept at the first visit */
} visit;

static int compare_places(const void *left, const void *right)
{
    const visit *a = left, *b = right;
    if (a->at.x != b->at.x)
        return (a->at.x > b->at.x) - (a->at.x < b->at.x);
    if (a->at.y != b->at.y)
        return (a->at.y > b->at.y) - (a->at.y < b->at.y);
    return (a->number > b->number) - (a->number < b->number);
}

static int compare_numbers(const void *left, const void *right)
{
    const visit *a = left, *b = right;
    return (a->number > b->number) - (a->number < b->number);
}

/* Fills first; whether all places differ. */
static bool mark_first_visits(visit *visits, size_t count)
{
    bool are_all_first = true;
    qsort(visits, count, sizeof *visits, compare_places);
    for (size_t i = 0; i < count; i++) {
        bool is_again =
            i > 0 && visits[i].at.x == visits[i - 1].at.x && visits[i].at.y == visits[i - 1].at.y;
        visits[i].first = is_again ? visits[i - 1].first : visits[i].number;
        are_all_first = are_all_first && !is_again;
    }
    qsort(visits, count, sizeof *visits, compare_numbers);
    return are_all_first;
}

/* stack[i] of stack_visits[i]: the same points, as `take` wants them and as they were visited. */
static bool walk(visit *visits, size_t count, csg_clipper_point *stack, uint32_t *stack_visits,
                 csg_clipper_take *take, void *user)
{
    size_t depth = 0;
    for (size_t i = 0; i < count; i++) {
        visit *first = &visits[visits[i].first];
        if (first->depth) {
            size_t begin = first->depth - 1;
            if (depth - begin >= 3 && !take(user, stack + begin, depth - begin))
                return false;
            while (depth > begin)
                visits[stack_visits[--depth]].depth = 0;
        }
        stack[depth] = visits[i].at;
        stack_visits[depth] = visits[i].first;
        first->depth = (uint32_t)++depth;
    }
    return depth < 3 || take(user, stack, depth);
}

bool csg_simple_loops(csg_memory *memory, const csg_clipper_point *points, size_t count,
                      csg_clipper_take *take, void *user)
{
    if (count < 3)
        return true;
    size_t each = sizeof(visit) + sizeof *points + sizeof(uint32_t);
    visit *visits = csg_memory_alloc(memory, count * each);
    if (!visits)
        return false;
    csg_clipper_point *stack = (csg_clipper_point *)(visits + count);
    for (size_t i = 0; i < count; i++)
        visits[i] = (visit){.at = points[i], .number = (uint32_t)i};
    bool is_done = mark_first_visits(visits, count)
                       ? take(user, points, count)
                       : walk(visits, count, stack, (uint32_t *)(stack + count), take, user);
    csg_memory_release(memory, visits, count * each);
    return is_done;
}
