/* SPDX-License-Identifier: MIT
 * A blended union shows where one operand is above its level by at most the blend's excess and
 * another by at most its support, so it asks its operands for boxes at up to three levels, and
 * those ask theirs. Each node therefore has a short sorted list of levels, planned from the root
 * down; a box for a larger level holds the one for a smaller, so a list that grows too long loses
 * the levels next to larger ones. (Leaves answer for any level.) Boxes are then computed from the
 * leaves up, one per level ("slot").
 *
 * Two uses: each node in its own frame; or all of the tree in the root's frame, with regions, the
 * part of space in which an ancestor needs the slot at all.
 */
#include "scene/boxes/level_boxes.h"

#include <string.h>

#include "scene/boxes/field_levels.h"
#include "scene/boxes/half_spaces.h"
#include "scene/operators/combine.h"
#include "scene/primitives/kinds.h"
#include "scene/primitives/primitive_box.h"

enum {
    MOST_LEVELS = 8,          /* of a node */
    MOST_LEVELS_IN_LARGE = 2, /* of a node in a scene of more than LARGE_SCENE nodes */
    LARGE_SCENE = 200000,
    MOST_PAIRED = 64, /* operands of a union whose pairs are looked at one by one */
    MOST_PASSES = 8   /* up and down, for the root's box */
};

typedef struct slots {
    uint32_t first, count;
} slots;

typedef struct table {
    const csgm_scene *scene;
    csg_arena arena;
    slots *nodes;
    double *levels; /* per slot */
    size_t level_capacity, slot_count;
    csg_box *boxes; /* per slot */
    csg_box *work;  /* of one operator's children */
    bool whole;     /* all boxes in the root's frame, cut by regions */
    /* for the whole tree only */
    const struct table *own; /* boxes in the nodes' own frames */
    csg_box *regions;        /* per slot */
    uint32_t *frame;         /* the innermost transform around each node, or NONE */
    csg_affine *to_root;     /* per transform, from inside it to the root's frame */
} table;

/* ---- planning the levels ---------------------------------------------------------------- */

typedef struct level_list {
    double at[4 * MOST_LEVELS];
    uint32_t count;
} level_list;

/* An infinite level needs no slot, its box is all of space. */
static void add_level(level_list *list, double level)
{
    uint32_t i = list->count;
    if (!isfinite(level))
        return;
    while (i > 0 && list->at[i - 1] > level)
        i--;
    if (i > 0 && list->at[i - 1] == level)
        return;
    memmove(list->at + i + 1, list->at + i, (list->count - i) * sizeof *list->at);
    list->at[i] = level;
    list->count++;
}

/* Drops levels next to one that is larger by little, but never the smallest, which matters most. */
static void thin(level_list *list, uint32_t most)
{
    while (list->count > most) {
        uint32_t closest = 1;
        double gap = INFINITY;
        for (uint32_t i = 1; i + 1 < list->count; i++) {
            double here = (list->at[i + 1] - list->at[i]) / list->at[i + 1];
            if (here < gap)
                closest = i;
            gap = fmin(gap, here);
        }
        memmove(list->at + closest, list->at + closest + 1,
                (list->count - closest - 1) * sizeof *list->at);
        list->count--;
    }
}

static bool store_levels(table *t, csg_node_id node, level_list *list)
{
    void *levels = t->levels;
    thin(list, t->scene->node_count > LARGE_SCENE ? MOST_LEVELS_IN_LARGE : MOST_LEVELS);
    if (!csg_memory_reserve(t->arena.memory, &levels, &t->level_capacity,
                            t->slot_count + list->count, sizeof *t->levels))
        return false;
    t->levels = levels;
    t->nodes[node] = (slots){(uint32_t)t->slot_count, list->count};
    for (uint32_t i = 0; i < list->count; i++)
        t->levels[t->slot_count++] = list->at[i];
    return true;
}

/* How far below a node's level its operands matter: the largest alone, any with a larger one. */
static void union_levels(const csgm_scene *scene, const csg_node *node, double *excess,
                         double *support)
{
    if (node->kind == CSG_NODE_COMBINE) { /* by a profile */
        const csg_profile *p = &scene->formulas[node->payload].profile;
        *excess = fmax(p->value[1], 0);
        *support = p->support + *excess;
        return;
    }
    bool adds = !csg_blend_is_interior(node->blend) && !csg_node_ends_flush(node);
    *excess = adds ? csg_scene_excess(scene, node) : 0;
    *support = adds ? csg_scene_support(scene, node) : 0;
}

static bool is_profiled(const csg_node *node)
{
    return node->kind == CSG_NODE_COMBINE && csg_blend_is_profile(node->blend);
}

/* The operator that it is or stands for. */
static csg_node_kind acts_as(const csgm_scene *scene, const csg_node *node)
{
    return is_profiled(node) ? (csg_node_kind)scene->formulas[node->payload].joins
                             : (csg_node_kind)node->kind;
}

/* A profiled node's value is divided by its constant. */
static double own_level(const csgm_scene *scene, const csg_node *node, double level)
{
    return is_profiled(node) ? level * scene->formulas[node->payload].lipschitz : level;
}

/* One child, whose level is another. */
static bool is_scaled(uint8_t kind)
{
    return kind == CSG_NODE_TRANSFORM || kind == CSG_NODE_OFFSET || kind == CSG_NODE_WARP ||
           kind == CSG_NODE_SOFT;
}

/* A solid that is shrunk lies within what it was. */
static double inner_level(const csgm_scene *scene, const csg_node *node, double level)
{
    if (node->kind == CSG_NODE_TRANSFORM)
        return level / scene->scales[node->payload];
    if (node->kind == CSG_NODE_WARP)
        return level / csg_warp_scale(&scene->warps[node->payload]);
    if (node->kind == CSG_NODE_SOFT)
        return csg_soft_level(scene, node, level);
    return fmax(level + csg_scene_parameters(scene, node)[0], 0);
}

static bool takes_fields(const csg_node *node)
{
    return csg_node_is_operator(node->kind) && csg_blend_takes_fields(node->blend);
}

/* How far below an intersection's or a difference's level its operands can be. */
static double deficit(const csgm_scene *scene, const csg_node *node)
{
    bool interior = csg_node_is_operator(node->kind) && csg_blend_is_interior(node->blend);
    if (is_profiled(node))
        return fmax(-scene->formulas[node->payload].profile.value[0], 0);
    return interior ? csg_scene_excess(scene, node) : 0;
}

/* What a node at `level` asks of its child number `index`. */
static void ask(const csgm_scene *scene, const csg_node *node, uint32_t index, double level,
                level_list *list)
{
    double excess, support;
    level = own_level(scene, node, level);
    bool first_only = acts_as(scene, node) == CSG_NODE_DIFFERENCE;
    if (node->kind == CSG_NODE_COMBINE && !is_profiled(node)) {
        csg_combine combine;
        csg_combine_begin(&combine, scene, node);
        add_level(list, csg_combine_inner_level(&combine, level));
        csg_combine_end(&combine);
    } else if (takes_fields(node)) {
        if (!first_only || index == 0)
            add_level(list, csg_field_level(scene, node, index, level));
    } else if (is_scaled(node->kind)) {
        add_level(list, inner_level(scene, node, level));
    } else if (acts_as(scene, node) == CSG_NODE_UNION) {
        union_levels(scene, node, &excess, &support);
        if (csg_node_ends_flush(node))
            add_level(list, 0);
        add_level(list, level);
        add_level(list, level + excess);
        add_level(list, level + support);
    } else if (!first_only || index == 0) {
        add_level(list, level + deficit(scene, node));
    }
}

static bool plan(table *t, const double *own)
{
    const csgm_scene *scene = t->scene;
    level_list list = {.count = 0};
    add_level(&list, own ? own[scene->root] : 0);
    if (!store_levels(t, scene->root, &list))
        return false;
    for (size_t i = scene->node_count; i-- > 0;) {
        const csg_node *node = &scene->nodes[i];
        for (uint32_t k = 0; k < node->child_count; k++) {
            csg_node_id child = csg_scene_children(scene, node)[k];
            list.count = 0;
            for (uint32_t s = 0; s < t->nodes[i].count; s++)
                ask(scene, node, k, t->levels[t->nodes[i].first + s], &list);
            if (!t->whole) /* each node also has a level of its own */
                add_level(&list, own ? own[child] : 0);
            if (!store_levels(t, child, &list))
                return false;
        }
    }
    return true;
}

/* The node's slot for a level that was asked for, or for the next larger one that was kept. */
static uint32_t slot_at(const table *t, csg_node_id node, double level)
{
    slots s = t->nodes[node];
    uint32_t i = 0;
    while (i + 1 < s.count && t->levels[s.first + i] < level)
        i++;
    return s.first + i;
}

/* ---- boxes, from the leaves up ----------------------------------------------------------- */

static csg_affine frame_of(const table *t, size_t node)
{
    bool turned = t->whole && t->frame[node] != CSG_NODE_NONE;
    return turned ? t->to_root[t->frame[node]] : csg_affine_identity();
}

/* The node below a chain of transforms and colours. */
static const csg_node *undressed(const csgm_scene *scene, const csg_node *node)
{
    while (node->kind == CSG_NODE_TRANSFORM || node->kind == CSG_NODE_COLOR)
        node = &scene->nodes[csg_scene_children(scene, node)[0]];
    return node;
}

/* Where the node is a primitive, placed or coloured or not: its box at just this level. */
static bool is_leaf_box(const table *t, csg_node_id id, double level, csg_box *box)
{
    const csgm_scene *scene = t->scene;
    const csg_node *node = &scene->nodes[id], *leaf = undressed(scene, node);
    if (leaf->child_count)
        return false;
    csg_affine map = frame_of(t, id);
    bool placed = t->whole && t->frame[id] != CSG_NODE_NONE;
    while (node != leaf) {
        if (node->kind == CSG_NODE_TRANSFORM) {
            const csg_affine *inner = &scene->transforms[node->payload];
            map = placed ? csg_affine_multiply(map, *inner) : *inner;
            placed = true;
            level /= scene->scales[node->payload];
        }
        node = &scene->nodes[csg_scene_children(scene, node)[0]];
    }
    if (leaf->kind == CSG_NODE_SHAPE)
        *box = csg_affine_box(&map, csg_box_grow(scene->shapes[leaf->payload]->box, level));
    else
        *box = csg_primitive_box(leaf->kind, csg_scene_parameters(scene, leaf), &map, level);
    return true;
}

static csg_box box_at(const table *t, csg_node_id node, double level)
{
    csg_box box;
    if (!t->nodes[node].count || !isfinite(level))
        return csg_box_all();
    uint32_t slot = slot_at(t, node, level);
    if (t->levels[slot] == level || !is_leaf_box(t, node, level, &box))
        return t->boxes[slot];
    return t->whole ? csg_box_intersect(box, t->regions[slot]) : box;
}

/* A fillet adds nothing beyond the hull of the operands' boxes, whose sides are among its planes:
 * it is above -level where one operand is, or within the hull grown by level. */
static csg_box filleted_box(const table *t, const csg_node *node, double level)
{
    const csg_node_id *children = csg_scene_children(t->scene, node);
    csg_box box = csg_box_empty(), hull = csg_box_empty();
    for (uint32_t i = 0; i < node->child_count; i++) {
        box = csg_box_hull(box, box_at(t, children[i], level));
        hull = csg_box_hull(hull, box_at(t, children[i], 0));
    }
    return csg_box_hull(box, csg_box_grow(hull, level));
}

/* Hull of the operands at `level` and of every pair's common part, one grown by the excess, the
 * other by the support. */
static csg_box union_box(const table *t, const csg_node *node, double level)
{
    const csg_node_id *children = csg_scene_children(t->scene, node);
    uint32_t count = node->child_count;
    double excess, support;
    union_levels(t->scene, node, &excess, &support);
    csg_box box = csg_box_empty();
    bool pairs = support > 0 && count <= MOST_PAIRED;
    if (csg_node_ends_flush(node))
        return filleted_box(t, node, level);
    for (uint32_t i = 0; i < count; i++)
        box = csg_box_hull(box, box_at(t, children[i], pairs ? level : level + excess));
    if (!pairs)
        return box;
    for (uint32_t i = 0; i < count; i++)
        t->work[i] = box_at(t, children[i], level + support);
    for (uint32_t i = 0; i < count; i++) {
        csg_box one = box_at(t, children[i], level + excess);
        for (uint32_t j = 0; j < count; j++)
            if (j != i)
                box = csg_box_hull(box, csg_box_intersect(one, t->work[j]));
    }
    return box;
}

/* Whether the child is a half-space, placed or coloured or not, and which one in the frame that
 * `map` leads to: {f >= -level}, or {-f >= -level} where it is subtracted. */
static bool is_half_space(const table *t, csg_node_id child, csg_affine map, double level,
                          bool subtracted, csg_half_space *out)
{
    const csgm_scene *scene = t->scene;
    const csg_node *node = &scene->nodes[child];
    if (undressed(scene, node)->kind != CSG_NODE_PLANE || !isfinite(level))
        return false;
    while (node->kind != CSG_NODE_PLANE) {
        if (node->kind == CSG_NODE_TRANSFORM) {
            map = csg_affine_multiply(map, scene->transforms[node->payload]);
            level /= scene->scales[node->payload];
        }
        node = &scene->nodes[csg_scene_children(scene, node)[0]];
    }
    csg_affine inverse;
    if (!isfinite(level) || !csg_affine_invert(map, &inverse))
        return false;
    const double *v = csg_scene_parameters(scene, node);
    double sign = subtracted ? -1 : 1;
    csg_half_space own = {{sign * v[0], sign * v[1], sign * v[2]}, sign * v[3] + level};
    *out = csg_half_space_map(own, &inverse);
    return true;
}

static csg_box half_space_box(const csg_half_space *h)
{
    const double v[4] = {h->normal.x, h->normal.y, h->normal.z, h->d};
    const csg_affine identity = csg_affine_identity();
    return csg_primitive_box(CSG_NODE_PLANE, v, &identity, 0);
}

/* Of a node with one child. */
static csg_box wrapped_box(const table *t, const csg_node *node, double level)
{
    const csgm_scene *scene = t->scene;
    csg_node_id child = csg_scene_children(scene, node)[0];
    csg_box box = box_at(t, child, is_scaled(node->kind) ? inner_level(scene, node, level) : level);
    if (node->kind == CSG_NODE_WARP)
        return csg_warp_box(&scene->warps[node->payload], box, level > 0);
    return node->kind == CSG_NODE_TRANSFORM && !t->whole
               ? csg_affine_box(&scene->transforms[node->payload], box)
               : box;
}

/* Hull of the children that it rises with, at the level below which it shows nothing of them. */
static csg_box combined_box(const table *t, const csg_node *node, double level)
{
    csg_combine combine;
    csg_combine_begin(&combine, t->scene, node);
    double inner = csg_combine_inner_level(&combine, level);
    csg_box box = csg_box_empty();
    for (uint32_t k = 0; k < node->child_count; k++)
        if (combine.trends[k] > 0 || !isfinite(inner))
            box = csg_box_hull(box, box_at(t, csg_scene_children(t->scene, node)[k], inner));
    csg_combine_end(&combine);
    return box;
}

/* A union's hull, an intersection's common part, the first of a difference, of boxes at the levels
 * that its fields ask for. */
static csg_box fields_box(const table *t, const csg_node *node, double level)
{
    const csg_node_id *children = csg_scene_children(t->scene, node);
    csg_box box = box_at(t, children[0], csg_field_level(t->scene, node, 0, level));
    for (uint32_t k = 1; k < node->child_count && node->kind != CSG_NODE_DIFFERENCE; k++) {
        csg_box one = box_at(t, children[k], csg_field_level(t->scene, node, k, level));
        box = node->kind == CSG_NODE_UNION ? csg_box_hull(box, one) : csg_box_intersect(box, one);
    }
    return box;
}

/* Nodes whose box is not better known in the root's frame than in their own: warps, which have no
 * affine way there, extrusions, whose operands are infinite along axes that may be turned, and
 * fillets, which end at the sides of a box in their own. */
static bool is_opaque(const csg_node *node)
{
    return node->kind == CSG_NODE_WARP || csg_node_ends_flush(node) ||
           (csg_node_is_operator(node->kind) && csg_blend_is_orthogonal(node->blend));
}

/* The first operand, or all of an intersection, cut by all half-spaces among the operands. */
static csg_box cut_box(const table *t, size_t index, double level)
{
    const csg_node *node = &t->scene->nodes[index];
    const csg_node_id *children = csg_scene_children(t->scene, node);
    csg_half_space planes[CSG_MOST_HALF_SPACES];
    size_t plane_count = 0;
    csg_affine frame = frame_of(t, index);
    csg_box box = csg_box_all();
    level += deficit(t->scene, node);
    for (uint32_t k = 0; k < node->child_count; k++) {
        bool subtracted = acts_as(t->scene, node) == CSG_NODE_DIFFERENCE && k > 0;
        csg_half_space h;
        if (!subtracted)
            box = csg_box_intersect(box, box_at(t, children[k], level));
        if (!is_half_space(t, children[k], frame, level, subtracted, &h))
            continue;
        box = csg_box_intersect(box, half_space_box(&h));
        if (plane_count < CSG_MOST_HALF_SPACES) /* leaving some out is safe */
            planes[plane_count++] = h;
    }
    return plane_count ? csg_half_spaces_box(planes, plane_count, box) : box;
}

static csg_box node_box(const table *t, size_t index, double level)
{
    const csg_node *node = &t->scene->nodes[index];
    csg_box box;
    if (is_leaf_box(t, (csg_node_id)index, level, &box))
        return box;
    if (t->own && is_opaque(node)) {
        csg_affine frame = frame_of(t, index);
        return csg_affine_box(&frame, box_at(t->own, (csg_node_id)index, level));
    }
    if (is_profiled(node))
        return acts_as(t->scene, node) == CSG_NODE_UNION
                   ? union_box(t, node, own_level(t->scene, node, level))
                   : cut_box(t, index, own_level(t->scene, node, level));
    if (node->kind == CSG_NODE_COMBINE)
        return combined_box(t, node, level);
    if (!csg_node_is_operator(node->kind))
        return wrapped_box(t, node, level);
    if (takes_fields(node))
        return fields_box(t, node, level);
    return node->kind == CSG_NODE_UNION ? union_box(t, node, level) : cut_box(t, index, level);
}

static void compute_upward(table *t)
{
    for (size_t i = 0; i < t->scene->node_count; i++) {
        for (uint32_t k = 0; k < t->nodes[i].count; k++) {
            uint32_t slot = t->nodes[i].first + k;
            csg_box box = node_box(t, i, t->levels[slot]);
            t->boxes[slot] = t->whole ? csg_box_intersect(box, t->regions[slot]) : box;
        }
    }
}

/* ---- regions, from the root down --------------------------------------------------------- */

static void widen_region(table *t, csg_node_id child, double level, csg_box by)
{
    if (!t->nodes[child].count || !isfinite(level))
        return;
    uint32_t slot = slot_at(t, child, level);
    t->regions[slot] = csg_box_hull(t->regions[slot], by);
}

/* A child's slot matters where the slots that ask for it have their boxes. */
static void compute_downward(table *t)
{
    const csgm_scene *scene = t->scene;
    for (size_t slot = 1; slot < t->slot_count; slot++)
        t->regions[slot] = csg_box_empty();
    level_list asked;
    for (size_t i = scene->node_count; i-- > 0;) {
        const csg_node *node = &scene->nodes[i];
        for (uint32_t s = 0; s < t->nodes[i].count; s++) {
            uint32_t slot = t->nodes[i].first + s;
            for (uint32_t k = 0; k < node->child_count; k++) {
                asked.count = 0;
                ask(scene, node, k, t->levels[slot], &asked);
                for (uint32_t a = 0; a < asked.count; a++)
                    widen_region(t, csg_scene_children(scene, node)[k], asked.at[a],
                                 t->boxes[slot]);
            }
        }
    }
}

static void place_frames(table *t)
{
    const csgm_scene *scene = t->scene;
    t->frame[scene->root] = CSG_NODE_NONE;
    for (size_t i = scene->node_count; i-- > 0;) {
        const csg_node *node = &scene->nodes[i];
        uint32_t inner = t->frame[i];
        if (node->kind == CSG_NODE_TRANSFORM) {
            inner = node->payload;
            t->to_root[inner] =
                csg_affine_multiply(frame_of(t, i), scene->transforms[node->payload]);
        }
        for (uint32_t k = 0; k < node->child_count; k++)
            t->frame[csg_scene_children(scene, node)[k]] = inner;
    }
}

/* ---- the two uses ------------------------------------------------------------------------ */

static csgm_status table_begin(table *t, const csgm_scene *scene, const double *own, bool whole)
{
    *t = (table){.scene = scene, .whole = whole};
    csg_arena_init(&t->arena, &scene->context->memory);
    t->nodes = csg_arena_calloc(&t->arena, scene->node_count, sizeof *t->nodes);
    t->work = csg_arena_calloc(&t->arena, MOST_PAIRED, sizeof *t->work);
    if (!t->nodes || !t->work || !plan(t, own))
        return CSGM_ERR_MEMORY;
    t->boxes = csg_arena_calloc(&t->arena, t->slot_count, sizeof *t->boxes);
    if (!t->boxes || !whole)
        return t->boxes ? CSGM_OK : CSGM_ERR_MEMORY;
    t->regions = csg_arena_calloc(&t->arena, t->slot_count, sizeof *t->regions);
    t->frame = csg_arena_calloc(&t->arena, scene->node_count, sizeof *t->frame);
    t->to_root = csg_arena_calloc(&t->arena, scene->transform_count, sizeof *t->to_root);
    if (!t->regions || !t->frame || !t->to_root)
        return CSGM_ERR_MEMORY;
    place_frames(t);
    return CSGM_OK;
}

static void table_end(table *t)
{
    csg_memory_release(t->arena.memory, t->levels, t->level_capacity * sizeof *t->levels);
    csg_arena_reset(&t->arena);
}

csgm_status csg_level_boxes(const csgm_scene *scene, const double *levels, csg_box *out)
{
    table t;
    csgm_status status = table_begin(&t, scene, levels, false);
    if (status == CSGM_OK) {
        compute_upward(&t);
        for (size_t i = 0; i < scene->node_count; i++)
            out[i] = box_at(&t, (csg_node_id)i, levels ? levels[i] : 0);
    }
    table_end(&t);
    return status;
}

static bool is_same_box(csg_box a, csg_box b)
{
    return (csg_box_is_empty(a) && csg_box_is_empty(b)) ||
           (csg_box_contains_box(a, b) && csg_box_contains_box(b, a));
}

static bool has_opaque_nodes(const csgm_scene *scene)
{
    for (size_t i = 0; i < scene->node_count; i++)
        if (is_opaque(&scene->nodes[i]))
            return true;
    return false;
}

/* Nothing but leaves that are moved and united sharply: no operand's box is cut by another's, so
 * the first way up is the last. */
static bool is_plain_union(const csgm_scene *scene)
{
    for (size_t i = 0; i < scene->node_count; i++) {
        const csg_node *node = &scene->nodes[i];
        bool joins = node->kind == CSG_NODE_UNION && csg_blend_is_sharp(node->blend);
        if (node->child_count && !joins && node->kind != CSG_NODE_TRANSFORM &&
            node->kind != CSG_NODE_COLOR)
            return false;
    }
    return true;
}

/* Up and down until nothing changes. */
static void settle(table *t, csg_box *out)
{
    const int passes = is_plain_union(t->scene) ? 1 : MOST_PASSES;
    for (size_t slot = 0; slot < t->slot_count; slot++)
        t->regions[slot] = csg_box_all();
    csg_box last = csg_box_all();
    for (int pass = 0; pass < passes; pass++) {
        compute_upward(t);
        *out = box_at(t, t->scene->root, 0);
        if (is_same_box(*out, last) && pass > 1)
            break;
        last = *out;
        t->regions[0] = *out;
        compute_downward(t);
    }
}

csgm_status csg_level_box_of_root(const csgm_scene *scene, csg_box *out)
{
    table t, own = {.arena.memory = &scene->context->memory};
    csgm_status status = CSGM_OK;
    bool opaque = has_opaque_nodes(scene);
    if (opaque)
        status = table_begin(&own, scene, NULL, false);
    if (status == CSGM_OK && opaque)
        compute_upward(&own);
    if (status == CSGM_OK) {
        status = table_begin(&t, scene, NULL, true);
        t.own = opaque ? &own : NULL;
        if (status == CSGM_OK)
            settle(&t, out);
        table_end(&t);
    }
    table_end(&own);
    return status;
}
