/* SPDX-License-Identifier: MIT
 * Places that are too far; see far.h.
 */
#include "mesh/reshape/far.h"

#include <math.h>

bool csg_far_places_add(csg_far_places *places, csg_memory *memory, csg_vec3 at)
{
    if (!csg_memory_reserve(memory, (void **)&places->at, &places->capacity, places->count + 1,
                            sizeof *places->at))
        return false;
    places->at[places->count++] = at;
    return true;
}

void csg_far_places_release(csg_far_places *places, csg_memory *memory)
{
    csg_memory_release(memory, places->at, places->capacity * sizeof *places->at);
    *places = (csg_far_places){0};
}

double csg_far_places_distance(const csg_far_places *places, const csg_triangle_tree *tree,
                               double most)
{
    double farthest = 0;
    for (size_t i = 0; i < places->count; i++)
        farthest =
            fmax(farthest, fmin(most, csg_triangle_tree_nearest(tree, places->at[i], most, NULL)));
    return farthest;
}
