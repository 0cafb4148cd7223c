/* SPDX-License-Identifier: MIT
 * Where the lists of features stand: sides, normals and triangles of one feature behind each other,
 * each as long as its polygon needs.
 */
#include <string.h>

#include "mesh/features/features.h"

size_t csg_feature_list_bytes(const csg_feature *f)
{
    size_t bytes = f->side_count * (sizeof *f->side + sizeof *f->triangle) +
                   f->sheet_count * sizeof *f->normal;
    return (bytes + 3) & ~(size_t)3;
}

size_t csg_feature_lists_bytes(const csg_feature *features, size_t count)
{
    size_t bytes = 0;
    for (size_t i = 0; i < count; i++)
        bytes += csg_feature_list_bytes(&features[i]);
    return bytes;
}

static void lay_out(csg_feature *f, void *lists)
{
    f->side = lists;
    f->normal = (float(*)[3])(void *)(f->side + f->side_count);
    f->triangle = (uint8_t(*)[3])(void *)(f->normal + f->sheet_count);
}

void csg_features_lay_out(csg_feature *features, size_t count, void *lists)
{
    uint8_t *next = lists;
    for (size_t i = 0; i < count; i++) {
        lay_out(&features[i], next);
        next += csg_feature_list_bytes(&features[i]);
    }
}

void csg_feature_begin(csg_feature_whole *whole, const csg_feature *begun)
{
    whole->feature = *begun;
    memset(&whole->lists, 0, csg_feature_list_bytes(begun));
    lay_out(&whole->feature, &whole->lists);
}

void csg_feature_copy(csg_feature *to, const csg_feature *from)
{
    void *lists = to->side;
    *to = *from;
    memcpy(lists, from->side, csg_feature_list_bytes(from));
    lay_out(to, lists);
}

void csg_feature_keep(csg_feature_whole *to, const csg_feature *from)
{
    to->feature.side = (void *)&to->lists;
    csg_feature_copy(&to->feature, from);
}

bool csg_feature_append(csg_feature **features, size_t *count, size_t *capacity, csg_arena *lists,
                        const csg_feature *feature)
{
    void *own = csg_arena_alloc(lists, csg_feature_list_bytes(feature));
    if (!own || !csg_memory_reserve(lists->memory, (void **)features, capacity, *count + 1,
                                    sizeof **features))
        return false;
    csg_feature *to = &(*features)[(*count)++];
    to->side = own;
    csg_feature_copy(to, feature);
    return true;
}
