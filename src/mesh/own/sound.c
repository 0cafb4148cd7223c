/* SPDX-License-Identifier: MIT
 * See sound.h. Pairs of triangles come from the tree of the polyhedron, whose places are not
 * rounded; whether they meet is told by exact signs of the rounded ones (features/exact.h). Then
 * each shell is closed and free of itself and of the others, and one triangle tells for all of a
 * shell on which side the solid is. It is asked of the polyhedron before rounding. Rounding cannot
 * have changed it: shells were farther apart than anything has moved, and each has more volume than
 * its surface has swept, so none has turned inside out.
 */
#include "mesh/own/sound.h"

#include <math.h>
#include <string.h>

#include "base/pool.h"
#include "base/trace.h"
#include "mesh/features/exact.h"
#include "shape/polyhedra/polyhedron.h"

/* Triangles of one item of work, and pairs that it may look at: where there are more, thousands of
 * needles lie side by side, and cells are quicker. */
enum { PER_ITEM = 512, MOST_PAIRS = 1 << 23, PAIRS_PER_POLL = 1 << 14 };

/* Of a polyhedron's size: what rounding may move, as the polyhedron itself has it, so that
 * triangles have few others near them. */
static const double COARSEST = 0x1p-10;

/* A stretch of one unit's places. */
typedef struct item {
    uint32_t unit, first, end;
} item;

typedef struct checking {
    const csg_own_units *units;
    const csgm_mesh *mesh;
    csg_mesh_watch *watch;
    uint32_t *shells; /* per triangle: the first one of its shell */
    bool *many;       /* per unit: whether it has several shells */
    double *moved;    /* per unit: farther than rounding moves a point of it */
    item *items;
    size_t item_count;
    atomic_bool meet;
} checking;

/* ---- pairs -------------------------------------------------------------------------------------
 */

typedef struct looking {
    checking *all;
    const csg_own_unit *unit;
    uint32_t place, triangle; /* that one */
    csg_exact_triangle own;
    bool many;
    double reach;
    uint32_t pairs; /* that were looked at */
} looking;

static csg_exact_triangle triangle_of(const csgm_mesh *mesh, uint32_t triangle)
{
    csg_exact_triangle t;
    for (int k = 0; k < 3; k++) {
        t.vertex[k] = mesh->indices[3 * (size_t)triangle + (size_t)k];
        memcpy(t.at[k], mesh->positions + 3 * (size_t)t.vertex[k], sizeof t.at[k]);
    }
    return t;
}

static uint32_t triangle_at(const csg_own_unit *unit, uint32_t place)
{
    return unit->first_triangle + csg_polyhedron_triangle_at(unit->shape, place);
}

static bool is_free(void *user, uint32_t place)
{
    looking *l = user;
    if (place <= l->place)
        return true;
    bool polls = l->pairs % PAIRS_PER_POLL == 0;
    if (l->pairs++ == MOST_PAIRS || (polls && csg_mesh_should_stop(l->all->watch)))
        return false;
    uint32_t triangle = triangle_at(l->unit, place);
    csg_exact_triangle other = triangle_of(l->all->mesh, triangle);
    if (csg_exact_meet(&l->own, &other))
        return false;
    return !l->many || l->all->shells[triangle] == l->all->shells[l->triangle] ||
           !csg_exact_nearly_meet(&l->own, &other, l->reach);
}

/* They meet, or it would take too long to tell. */
static bool tell(checking *c)
{
    atomic_store(&c->meet, true);
    return false;
}

static bool check_item(void *user, uint32_t worker, size_t index)
{
    checking *c = user;
    const item *it = &c->items[index];
    const csg_own_unit *unit = &c->units->items[it->unit];
    double least, most;
    if (csg_mesh_should_stop(c->watch))
        return false;
    csg_affine_singular_values(&unit->place, &least, &most);
    /* two triangles may have come nearer to each other by twice what a point moves */
    looking l = {
        .all = c, .unit = unit, .many = c->many[it->unit], .reach = 4 * c->moved[it->unit]};
    csg_vec3 size = csg_box_size(unit->shape->box);
    if (!(l.reach < COARSEST * least * csg_vec3_norm(size)))
        return tell(c);
    for (l.place = it->first; l.place < it->end; l.place++) {
        l.triangle = triangle_at(unit, l.place);
        l.own = triangle_of(c->mesh, l.triangle);
        if (!csg_polyhedron_near(unit->shape, l.place, 2 * l.reach / least, is_free, &l))
            return !csg_mesh_should_stop(c->watch) && tell(c);
    }
    return true;
}

static void poll_progress(void *user, size_t done, size_t count)
{
    checking *c = user;
    csg_mesh_report_progress(c->watch, (double)done / (double)count);
}

static bool list_items(checking *c)
{
    size_t count = 0, i = 0;
    for (size_t u = 0; u < c->units->count; u++)
        count += csg_polyhedron_triangles(c->units->items[u].shape)->count / PER_ITEM + 1;
    c->items = csg_memory_alloc(c->units->memory, count * sizeof *c->items);
    c->item_count = c->items ? count : 0;
    for (uint32_t u = 0; c->items && u < c->units->count; u++) {
        uint32_t end = (uint32_t)csg_polyhedron_triangles(c->units->items[u].shape)->count;
        for (uint32_t first = 0; first <= end; first += PER_ITEM)
            c->items[i++] = (item){u, first, end - first < PER_ITEM ? end : first + PER_ITEM};
    }
    return c->items != NULL;
}

/* ---- shells ------------------------------------------------------------------------------------
 */

/* stack: room for a corner of each triangle. */
static void find_shells(checking *c, const csg_corners *corners, uint32_t *stack)
{
    for (uint32_t t = 0; t < corners->triangle_count; t++)
        c->shells[t] = CSG_CORNER_NONE;
    for (uint32_t t = 0; t < corners->triangle_count; t++) {
        size_t depth = 0;
        if (c->shells[t] == CSG_CORNER_NONE) {
            c->shells[t] = t;
            stack[depth++] = t;
        }
        while (depth) {
            uint32_t at = stack[--depth];
            for (uint32_t k = 0; k < 3; k++) {
                uint32_t next = corners->across[3 * at + k] / 3;
                if (c->shells[next] == CSG_CORNER_NONE) {
                    c->shells[next] = t;
                    stack[depth++] = next;
                }
            }
        }
    }
}

/* What is known of a shell, at its first triangle. */
typedef struct shell {
    double volume, area; /* of the rounded mesh */
    double largest;      /* twice the area of its largest triangle */
    uint32_t place;      /* of that one */
} shell;

static void measure(const checking *c, shell *shells)
{
    for (size_t u = 0; u < c->units->count; u++) {
        const csg_own_unit *unit = &c->units->items[u];
        uint32_t count = (uint32_t)csg_polyhedron_triangles(unit->shape)->count;
        for (uint32_t place = 0; place < count; place++) {
            uint32_t t = triangle_at(unit, place), first = c->shells[t];
            csg_exact_triangle triangle = triangle_of(c->mesh, t),
                               begin = triangle_of(c->mesh, first);
            csg_vec3 origin = csg_vec3_from_floats(begin.at[0]), v[3];
            for (int k = 0; k < 3; k++)
                v[k] = csg_vec3_sub(csg_vec3_from_floats(triangle.at[k]), origin);
            double twice =
                csg_vec3_norm(csg_vec3_cross(csg_vec3_sub(v[1], v[0]), csg_vec3_sub(v[2], v[0])));
            shell *s = &shells[first];
            s->volume += csg_vec3_dot(v[0], csg_vec3_cross(v[1], v[2])) / 6;
            s->area += twice / 2;
            if (twice > s->largest) {
                s->largest = twice;
                s->place = place;
            }
        }
    }
}

/* Of all shells; a hole has a negative volume. */
static bool are_clear(const checking *c, const shell *shells)
{
    for (size_t u = 0; u < c->units->count; u++) {
        const csg_own_unit *unit = &c->units->items[u];
        uint32_t count = (uint32_t)csg_polyhedron_triangles(unit->shape)->count;
        for (uint32_t t = unit->first_triangle; t < unit->first_triangle + count; t++)
            if (c->shells[t] == t &&
                (!(fabs(shells[t].volume) > 2 * c->moved[u] * shells[t].area) ||
                 !csg_polyhedron_is_clear(unit->shape, shells[t].place)))
                return false;
    }
    return true;
}

static bool check_shells(const checking *c, bool *sound)
{
    size_t bytes = (size_t)c->mesh->triangle_count * sizeof(shell);
    shell *shells = csg_memory_alloc(c->units->memory, bytes);
    if (!shells)
        return false;
    memset(shells, 0, bytes);
    measure(c, shells);
    *sound = are_clear(c, shells);
    csg_memory_release(c->units->memory, shells, bytes);
    return true;
}

/* ---- all of it ---------------------------------------------------------------------------------
 */

/* By half a step of the largest coordinate along each axis, and what the frame's own steps and the
 * offset of csg_polyhedron_is_clear come to. */
static void measure_units(checking *c)
{
    csg_vec3 origin = c->mesh->origin;
    for (size_t u = 0; u < c->units->count; u++) {
        const csg_own_unit *unit = &c->units->items[u];
        csg_vec3 low = csg_vec3_sub(unit->box.min, origin),
                 high = csg_vec3_sub(unit->box.max, origin);
        double farthest = fmax(csg_vec3_norm(low), csg_vec3_norm(high));
        uint32_t first = unit->first_triangle;
        uint32_t count = (uint32_t)csg_polyhedron_triangles(unit->shape)->count;
        c->moved[u] = 0x1p-23 * farthest + 0x1p-28 * csg_vec3_norm(csg_box_size(unit->box));
        c->many[u] = false;
        for (uint32_t t = first; t < first + count; t++)
            c->many[u] |= c->shells[t] != c->shells[first];
    }
}

static csgm_status check(checking *c, const csg_corners *corners, bool *sound)
{
    csg_memory *memory = c->units->memory;
    size_t bytes = (size_t)corners->triangle_count * sizeof(uint32_t);
    uint32_t *stack = csg_memory_alloc(memory, bytes);
    if (!stack || !c->shells || !c->many || !c->moved || !list_items(c)) {
        csg_memory_release(memory, stack, bytes);
        return csg_context_no_memory(c->watch->context);
    }
    find_shells(c, corners, stack);
    csg_memory_release(memory, stack, bytes);
    measure_units(c);
    bool done = csg_pool_run(c->watch->context->pool, c->item_count, check_item, poll_progress, c);
    *sound = done;
    if (!done)
        return atomic_load(&c->meet) ? CSGM_OK : csg_mesh_why_stopped(c->watch);
    return check_shells(c, sound) ? CSGM_OK : csg_context_no_memory(c->watch->context);
}

csgm_status csg_own_is_sound(const csg_own_units *units, const csgm_mesh *mesh,
                             const csg_corners *corners, csg_mesh_watch *watch, bool *sound)
{
    CSG_ZONE(watch->context, "own triangles: check");
    csg_memory *memory = units->memory;
    size_t bytes = (size_t)mesh->triangle_count * sizeof(uint32_t);
    checking c = {.units = units, .mesh = mesh, .watch = watch};
    c.shells = csg_memory_alloc(memory, bytes);
    c.many = csg_memory_alloc(memory, units->count * sizeof *c.many);
    c.moved = csg_memory_alloc(memory, units->count * sizeof *c.moved);
    *sound = false;
    csgm_status status = check(&c, corners, sound);
    csg_memory_release(memory, c.shells, bytes);
    csg_memory_release(memory, c.many, units->count * sizeof *c.many);
    csg_memory_release(memory, c.moved, units->count * sizeof *c.moved);
    csg_memory_release(memory, c.items, c.item_count * sizeof *c.items);
    return status;
}
