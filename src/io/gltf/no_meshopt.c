/* SPDX-License-Identifier: MIT
 * Stands in for meshopt.c in a build without meshoptimizer: says so. The others are not reached,
 * since their callers ask first.
 */
#include "io/adapter.h"

bool csg_meshopt_available(void)
{
    return false;
}

uint32_t csg_meshopt_order(uint32_t *indices, uint64_t index_count, uint64_t vertex_count,
                           uint32_t *to)
{
    (void)indices, (void)index_count, (void)to;
    return (uint32_t)vertex_count;
}

uint64_t csg_meshopt_bound(csg_meshopt_mode mode, uint64_t count, uint64_t stride, uint64_t beyond)
{
    (void)mode, (void)count, (void)stride, (void)beyond;
    return 0;
}

uint64_t csg_meshopt_encode(csg_meshopt_mode mode, const void *data, uint64_t count,
                            uint64_t stride, uint8_t *out, uint64_t room)
{
    (void)mode, (void)data, (void)count, (void)stride, (void)out, (void)room;
    return 0;
}

void csg_meshopt_pack_normals(int8_t *out, const float *normals, uint64_t count, int bits)
{
    (void)out, (void)normals, (void)count, (void)bits;
}

bool csg_meshopt_decode(const csg_meshopt_view *view, void *out)
{
    (void)view, (void)out;
    return false;
}
