/* SPDX-License-Identifier: MIT
 * Copies of a node side by side, united.
 */
#include "solid/operations.h"

static csg_node_id unite_copies(csg_solid_job *job, csg_node_id node, csg_vec3 cell,
                                const uint32_t counts[3], csg_node_id *made)
{
    size_t count = 0;
    for (uint32_t z = 0; z < counts[2]; z++)
        for (uint32_t y = 0; y < counts[1]; y++)
            for (uint32_t x = 0; x < counts[0]; x++) {
                csg_affine by =
                    csg_affine_translate(csg_vec3_make(x * cell.x, y * cell.y, z * cell.z));
                bool last = x + 1 == counts[0] && y + 1 == counts[1] && z + 1 == counts[2];
                if (!csg_solid_charge(job, 1))
                    return CSG_NODE_NONE;
                csg_node_id copy =
                    last ? node : csg_solid_done(job, csg_build_copy(job->builder, node));
                made[count] = csg_solid_moved(job, copy, &by);
                if (made[count++] == CSG_NODE_NONE)
                    return CSG_NODE_NONE;
            }
    return csg_solid_union(job, made, count);
}

csg_node_id csg_solid_repeat(csg_solid_job *job, csg_node_id node, csg_vec3 cell,
                             const uint32_t counts[3])
{
    size_t bytes = (size_t)counts[0] * counts[1] * counts[2] * sizeof(csg_node_id);
    csg_node_id *made = csg_memory_alloc(job->memory, bytes);
    if (!made) {
        csg_solid_no_memory(job);
        return CSG_NODE_NONE;
    }
    csg_node_id result = unite_copies(job, node, cell, counts, made);
    csg_memory_release(job->memory, made, bytes);
    return result;
}
