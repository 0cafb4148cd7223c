/* SPDX-License-Identifier: MIT
 * Cubes are cut into eighths as long as they hold too much; see tiles.h.
 */
#include "mesh/adaptive/tiles.h"

/* The cube that a brick of some level would fill. */
typedef struct cube {
    uint32_t level, at[3];
} cube;

static csg_box box_of(const csg_bricks *b, const cube *c)
{
    double corner[2][3];
    for (int axis = 0; axis < 3; axis++)
        for (uint32_t k = 0; k < 2; k++) {
            uint32_t point = (c->at[axis] + k) * CSG_BRICK_EDGE << (b->finest - c->level);
            corner[k][axis] = (double)csg_lattice_coordinate(b->lattice, axis, point);
        }
    return (csg_box){csg_vec3_make(corner[0][0], corner[0][1], corner[0][2]),
                     csg_vec3_make(corner[1][0], corner[1][1], corner[1][2])};
}

static bool add_tile(csg_tiles *t, size_t first, size_t count, csg_box box)
{
    if (!csg_memory_reserve(t->memory, (void **)&t->items, &t->capacity, t->count + 1,
                            sizeof *t->items))
        return false;
    t->items[t->count++] = (csg_tile){first, count, box};
    return true;
}

/* The eighth of a cube that a brick of a finer level lies in. */
static cube eighth_of(const cube *c, const csg_brick *brick)
{
    cube e = {.level = c->level + 1};
    for (int axis = 0; axis < 3; axis++)
        e.at[axis] = brick->at[axis] >> (brick->level - e.level);
    return e;
}

/* Leaves from first on, all of a cube. */
static bool cut(csg_tiles *t, const csg_bricks *b, size_t first, size_t count, size_t most,
                const cube *c)
{
    if (count <= most)
        return !count || add_tile(t, first, count, box_of(b, c));
    for (size_t i = first, end; i < first + count; i = end) {
        const csg_brick *brick = &b->items[t->leaves[i]];
        end = i + 1;
        if (brick->level == c->level) {
            if (!add_tile(t, i, 1, csg_box_empty()))
                return false;
            continue;
        }
        cube e = eighth_of(c, brick);
        for (; end < first + count; end++) {
            const csg_brick *next = &b->items[t->leaves[end]];
            cube own = next->level == c->level ? *c : eighth_of(c, next);
            if (own.level != e.level || own.at[0] != e.at[0] || own.at[1] != e.at[1] ||
                own.at[2] != e.at[2])
                break;
        }
        if (!cut(t, b, i, end - i, most, &e))
            return false;
    }
    return true;
}

bool csg_tiles_make(const csg_bricks *b, size_t most, csg_tiles *out)
{
    const cube all = {0};
    *out = (csg_tiles){.memory = &b->context->memory};
    return csg_bricks_leaves(b, &out->leaves, &out->leaf_count) &&
           cut(out, b, 0, out->leaf_count, most, &all);
}

void csg_tiles_release(csg_tiles *t)
{
    csg_memory_release(t->memory, t->leaves, t->leaf_count * sizeof *t->leaves);
    csg_memory_release(t->memory, t->items, t->capacity * sizeof *t->items);
    *t = (csg_tiles){.memory = t->memory};
}
