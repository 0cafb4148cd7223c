/* SPDX-License-Identifier: MIT
 * Triangles named by their points, in an order of their own; see match.h. A sum of hashes, which
 * does not know of order, tells most meshes apart before anything is sorted.
 */
#include "diff/match.h"

#include <stdlib.h>
#include <string.h>

#include "base/trace.h"

static csg_diff_face face_of(const csg_diff_side *side, size_t triangle)
{
    const uint32_t *p = side->chain.corners[triangle];
    uint32_t turned = p[1] < p[0] ? (p[2] < p[1] ? 2 : 1) : (p[2] < p[0] ? 2 : 0);
    return (csg_diff_face){
        {p[turned], p[(turned + 1) % 3], p[(turned + 2) % 3]}, (uint32_t)triangle, turned};
}

static uint64_t scramble(uint64_t h)
{
    h = (h ^ (h >> 31)) * 0xBF58476D1CE4E5B9u;
    h = (h ^ (h >> 29)) * 0x94D049BB133111EBu;
    return h ^ (h >> 32);
}

static uint64_t sum_of(const csg_diff_side *side)
{
    uint64_t sum = 0;
    for (size_t t = 0; t < side->chain.count; t++) {
        csg_diff_face f = face_of(side, t);
        sum += scramble(scramble((uint64_t)f.points[0] << 32 | f.points[1]) + f.points[2]);
    }
    return sum;
}

static int compare_faces(const void *left, const void *right)
{
    const csg_diff_face *a = left, *b = right;
    for (int k = 0; k < 3; k++)
        if (a->points[k] != b->points[k])
            return a->points[k] < b->points[k] ? -1 : 1;
    return (a->triangle > b->triangle) - (a->triangle < b->triangle);
}

static csg_diff_face *sorted_faces(csg_diff_pair *pair, const csg_diff_side *side)
{
    csg_diff_face *faces = csg_arena_alloc(&pair->arena, (side->chain.count + 1) * sizeof *faces);
    for (size_t t = 0; faces && t < side->chain.count; t++)
        faces[t] = face_of(side, t);
    if (faces)
        qsort(faces, side->chain.count, sizeof *faces, compare_faces);
    return faces;
}

csgm_status csg_diff_match_make(csg_diff_pair *pair, csg_diff_match *match, bool *same)
{
    CSG_ZONE(pair->context, "match");
    const csg_diff_side *a = &pair->sides[0], *b = &pair->sides[1];
    *same = false;
    *match = (csg_diff_match){.count = a->chain.count};
    if (a->chain.count != b->chain.count || sum_of(a) != sum_of(b))
        return CSGM_OK;
    for (int i = 0; i < 2; i++) {
        match->faces[i] = sorted_faces(pair, &pair->sides[i]);
        if (!match->faces[i])
            return csg_context_no_memory(pair->context);
    }
    *same = true;
    for (size_t t = 0; t < match->count && *same; t++)
        *same = memcmp(match->faces[0][t].points, match->faces[1][t].points,
                       sizeof match->faces[0][t].points) == 0;
    return CSGM_OK;
}
