/* SPDX-License-Identifier: MIT
 * Gathered from what the judge has kept; see seen.h.
 */
#include "mesh/adaptive/seen.h"

#include <string.h>

#include "mesh/adaptive/judged.h"

bool csg_seen_gather(csg_seen *seen, const csg_bricks *b, csg_memory *memory)
{
    seen->count = 0;
    for (size_t i = 0; i < b->count; i++) {
        const csg_judged *judged = b->items[i].judged;
        for (unsigned k = 0; judged && k < judged->apex_count; k++) {
            const csg_judged_apex *place = &judged->apexes[k];
            if (place->polygon != CSG_JUDGED_NO_POLYGON)
                continue;
            if (!csg_memory_reserve(memory, (void **)&seen->at, &seen->capacity, seen->count + 1,
                                    sizeof *seen->at))
                return false;
            memcpy(seen->at[seen->count++], place->at, sizeof *seen->at);
        }
    }
    return true;
}

void csg_seen_release(csg_seen *seen, csg_memory *memory)
{
    csg_memory_release(memory, seen->at, seen->capacity * sizeof *seen->at);
    *seen = (csg_seen){0};
}
