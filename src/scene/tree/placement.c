/* SPDX-License-Identifier: MIT
 * See placement.h. A leaf moves with its frame. Operators, offsets, soft and combined nodes work on
 * the values of what is below them, point by point: of their frames only the scale matters, by
 * which lengths (of a blend) are multiplied. What is below a warp moves with the warp's frame, as
 * it is, and so does the slab of an extrusion.
 */
#include "scene/tree/placement.h"

#include <math.h>
#include <string.h>

#include "base/table.h"
#include "scene/tree/print.h"
#include "shape/shape.h"

enum { MOST_FRAMES = 1 << 14 };

/* Frames whose largest singular value is more than this times the smallest are not compared: their
 * inverses would be off by more than CLOSE. */
static const double FLATTEST = 1e2, CLOSE = 1e-11;

typedef struct waiting {
    csg_node_id node;
    uint32_t frame;
    bool is_verbatim; /* below a warp: transforms are part of what it is */
} waiting;

typedef struct walk {
    csg_placement *out;
    const csgm_scene *scene;
    waiting *stack;
    csg_affine *maps; /* of the stack's items */
    size_t stack_count, stack_room, map_count, map_room;
} walk;

static void hash_text(void *user, const char *text, size_t length)
{
    csg_digest_text(user, text, length);
}

/* Of a shape its hash will do: the text of a mesh is long. */
static bool digest_node(walk *w, csg_node_id id)
{
    const csg_node *node = &w->scene->nodes[id];
    csg_digest_text(w->out->digest, (const char *)&node->child_count, sizeof node->child_count);
    if (node->kind != CSG_NODE_SHAPE)
        return csg_scene_print_node(w->scene, id, hash_text, w->out->digest);
    uint64_t hash = csg_shape_hash(w->scene->shapes[node->payload]);
    csg_digest_text(w->out->digest, (const char *)&hash, sizeof hash);
    return true;
}

static bool push_node(walk *w, csg_node_id node, uint32_t frame, bool is_verbatim)
{
    if (!csg_memory_reserve(w->out->memory, (void **)&w->stack, &w->stack_room, w->stack_count + 1,
                            sizeof *w->stack))
        return false;
    w->stack[w->stack_count++] = (waiting){node, frame, is_verbatim};
    return true;
}

static bool add_map(walk *w, csg_affine map)
{
    if (!csg_memory_reserve(w->out->memory, (void **)&w->maps, &w->map_room, w->map_count + 1,
                            sizeof *w->maps))
        return false;
    w->maps[w->map_count++] = map;
    return true;
}

static bool add_frame(walk *w, const csg_affine *map, bool is_operator)
{
    csg_placement *out = w->out;
    out->is_known = out->count < MOST_FRAMES;
    if (!out->is_known)
        return true;
    if (!csg_memory_reserve(out->memory, (void **)&out->frames, &out->room, out->count + 1,
                            sizeof *out->frames))
        return false;
    out->frames[out->count++] = (csg_placed_frame){*map, is_operator};
    return true;
}

static bool works_on_values(const csg_node *node)
{
    return (csg_node_is_operator((csg_node_kind)node->kind) && !csg_node_is_plate(node)) ||
           node->kind == CSG_NODE_OFFSET || node->kind == CSG_NODE_SOFT ||
           node->kind == CSG_NODE_COMBINE;
}

static bool visit(walk *w)
{
    waiting at = w->stack[--w->stack_count];
    const csg_node *node = &w->scene->nodes[at.node];
    bool is_transform = node->kind == CSG_NODE_TRANSFORM && !at.is_verbatim;
    bool is_told = !is_transform && node->kind != CSG_NODE_COLOR;
    if (is_transform) {
        csg_affine map =
            csg_affine_multiply(w->maps[at.frame], w->scene->transforms[node->payload]);
        at.frame = (uint32_t)w->map_count;
        if (!add_map(w, map))
            return false;
    }
    if (is_told && (!digest_node(w, at.node) ||
                    (!at.is_verbatim && !add_frame(w, &w->maps[at.frame], works_on_values(node)))))
        return false;
    /* the slab of a plate is in its text */
    uint32_t children = csg_node_is_plate(node) ? 1 : node->child_count;
    at.is_verbatim |= node->kind == CSG_NODE_WARP;
    for (uint32_t i = children; i-- > 0;)
        if (!push_node(w, csg_scene_children(w->scene, node)[i], at.frame, at.is_verbatim))
            return false;
    return true;
}

csgm_status csg_placement_take(csg_placement *out, const csg_parts *parts, size_t index)
{
    csg_memory *memory = &parts->scene->context->memory;
    walk w = {.out = out, .scene = parts->scene};
    bool done = true;
    out->memory = memory;
    out->count = 0;
    out->is_known = true;
    out->digest[0] = CSG_HASH_START;
    out->digest[1] = 0;
    for (size_t i = 0; i < parts->unit_count && done && out->is_known; i++) {
        const csg_part_unit *unit = &parts->units[i];
        const csg_part_way *way = &parts->ways[unit->way];
        if (way->look.part != parts->numbers[index])
            continue;
        w.map_count = 0;
        done = add_map(&w, way->place) && push_node(&w, unit->node, 0, false);
        while (done && w.stack_count && out->is_known)
            done = visit(&w);
        w.stack_count = 0;
    }
    csg_memory_release(memory, w.stack, w.stack_room * sizeof *w.stack);
    csg_memory_release(memory, w.maps, w.map_room * sizeof *w.maps);
    out->is_known &= done;
    return done ? CSGM_OK : CSGM_ERR_MEMORY;
}

void csg_placement_release(csg_placement *placement)
{
    if (placement->memory)
        csg_memory_release(placement->memory, placement->frames,
                           placement->room * sizeof *placement->frames);
    *placement = (csg_placement){.frames = NULL};
}

double csg_placement_reach(const csg_placement *p)
{
    double reach = 0;
    for (size_t i = 0; i < p->count; i++) {
        const double *t = p->frames[i].map.t;
        reach = fmax(reach, csg_vec3_norm(csg_vec3_make(t[0], t[1], t[2])));
    }
    return reach;
}

/* ---- two of them -------------------------------------------------------------------------------
 */

static bool motion_of(const csg_affine *from, const csg_affine *to, csg_affine *out)
{
    csg_affine back;
    double smallest, largest;
    csg_affine_singular_values(from, &smallest, &largest);
    if (!(largest <= FLATTEST * smallest) || !csg_affine_invert(*from, &back))
        return false;
    *out = csg_affine_multiply(*to, back);
    return true;
}

static bool is_rigid(const csg_affine *a)
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            double dot = 0;
            for (int n = 0; n < 3; n++)
                dot += a->m[n][i] * a->m[n][k];
            if (!(fabs(dot - (i == k)) <= CLOSE))
                return false;
        }
    return csg_affine_determinant(*a) > 0;
}

static bool is_near(const csg_affine *a, const csg_affine *b, double reach)
{
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            if (!(fabs(a->m[i][k] - b->m[i][k]) <= CLOSE))
                return false;
        if (!(fabs(a->t[i] - b->t[i]) <= CLOSE * reach))
            return false;
    }
    return true;
}

/* Lengths are multiplied by the same factor, in all directions. */
static bool has_same_scale(const csg_affine *a, const csg_affine *b)
{
    double da = fabs(csg_affine_determinant(*a)), db = fabs(csg_affine_determinant(*b));
    return csg_affine_is_similarity(a) && csg_affine_is_similarity(b) &&
           fabs(da - db) <= CLOSE * da;
}

/* Of all frames the first one of a leaf says what the motion is. */
static bool find_first(const csg_placement *from, const csg_placement *to, csg_affine *motion)
{
    for (size_t i = 0; i < from->count; i++)
        if (!from->frames[i].is_operator)
            return motion_of(&from->frames[i].map, &to->frames[i].map, motion);
    return false;
}

static bool is_same_but_for_place(const csg_placement *a, const csg_placement *b)
{
    if (!a->is_known || !b->is_known || a->count != b->count ||
        memcmp(a->digest, b->digest, sizeof a->digest) != 0)
        return false;
    for (size_t i = 0; i < a->count; i++)
        if (a->frames[i].is_operator != b->frames[i].is_operator)
            return false;
    return true;
}

bool csg_placement_is_same(const csg_placement *a, const csg_placement *b)
{
    if (!is_same_but_for_place(a, b))
        return false;
    for (size_t i = 0; i < a->count; i++)
        if (memcmp(&a->frames[i].map, &b->frames[i].map, sizeof a->frames[i].map) != 0)
            return false;
    return true;
}

bool csg_placement_motion(const csg_placement *from, const csg_placement *to, csg_affine *motion)
{
    if (!is_same_but_for_place(from, to) || !find_first(from, to, motion) || !is_rigid(motion))
        return false;
    double reach = csg_placement_reach(from) + csg_placement_reach(to);
    for (size_t i = 0; i < from->count; i++) {
        const csg_placed_frame *a = &from->frames[i], *b = &to->frames[i];
        csg_affine own;
        if (motion_of(&a->map, &b->map, &own) && is_near(&own, motion, reach))
            continue;
        if (!a->is_operator || !has_same_scale(&a->map, &b->map))
            return false;
    }
    return true;
}
