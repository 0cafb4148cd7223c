/* SPDX-License-Identifier: MIT
 * Welding: which point, of those that are there, lies at a place. -0 and 0 are one coordinate; a
 * NaN lies nowhere, not even where it is itself.
 */
#ifndef CSG_BASE_PLACES_H
#define CSG_BASE_PLACES_H

#include <string.h>

#include "base/geometry.h"
#include "base/table.h"

static inline uint64_t csg_place_hash(csg_vec3 p)
{
    const double at[3] = {p.x + 0.0, p.y + 0.0, p.z + 0.0}; /* no -0 */
    uint64_t bits[3], hash = 0;
    memcpy(bits, at, sizeof bits);
    for (int k = 0; k < 3; k++)
        hash = csg_hash_word(hash, bits[k]);
    return hash;
}

/* A csg_table_hash of an array of csg_vec3. */
static inline uint64_t csg_place_hash_of(const void *points, uint32_t number)
{
    return csg_place_hash(((const csg_vec3 *)points)[number]);
}

static inline bool csg_place_is_same(csg_vec3 a, csg_vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* The number of the point at p; CSG_TABLE_NONE: there is none, and *slot is where to put its
 * number. The table has room for one more. */
static inline uint32_t csg_place_find(const csg_table *table, const csg_vec3 *points, csg_vec3 p,
                                      size_t *slot)
{
    uint32_t found = csg_table_first(table, csg_place_hash(p), slot);
    while (found != CSG_TABLE_NONE && !csg_place_is_same(points[found], p))
        found = csg_table_next(table, slot);
    return found;
}

#endif
