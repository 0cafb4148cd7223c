/* SPDX-License-Identifier: MIT
 * Solids of a blend that do not meet; see apart.h.
 */
#include "scene/operators/apart.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/operators/blend_kinds.h"
#include "scene/reference.h"

enum {
    MOST_LOOKS = 20000,    /* at one pair */
    MOST_WORK = 400000,    /* nodes asked, of one blend */
    MOST_IN_ALL = 8000000, /* of all of a scene */
    MOST_SPLITS = 96,      /* of a cube, until it is as small as rounding */
    FEW = 64               /* operands: all pairs are looked at, else those with boxes in reach */
};

/* Of the size of both: solids that are nearer touch. */
static const double SAME = 1e-9;

typedef csg_apart_pair pair;

typedef struct search {
    const csgm_scene *scene;
    csg_memory *memory;
    csg_reference_room room;
    /* per node: the first one below it, what it takes to ask it with those, whether its values have
     * a constant, which is in `slopes` */
    csg_node_id *firsts;
    uint64_t *costs;
    bool *is_steady;
    double *slopes;
    /* of the blend at hand */
    const csg_node *node;
    const csg_node_id *children;
    double radius;
    pair *pairs;
    size_t pair_count, pair_capacity;
    uint64_t most_work;
} search;

/* Intersections are unions of what is left out, and so is the first operand of a difference. */
static bool is_outside(const csg_node *node, uint32_t k)
{
    return node->kind == CSG_NODE_INTERSECTION || (node->kind == CSG_NODE_DIFFERENCE && k == 0);
}

static csg_box box_of(const search *s, uint32_t k)
{
    return s->scene->bounds[s->children[k]];
}

static double between(double low, double high, double other_low, double other_high)
{
    double gap = fmax(low - other_high, other_low - high);
    return gap > 0 ? gap : 0;
}

static double boxes_apart(csg_box a, csg_box b)
{
    csg_vec3 gap = {between(a.min.x, a.max.x, b.min.x, b.max.x),
                    between(a.min.y, a.max.y, b.min.y, b.max.y),
                    between(a.min.z, a.max.z, b.min.z, b.max.z)};
    return csg_vec3_norm(gap);
}

/* ---- pairs ------------------------------------------------------------------------------------- */

static bool add_pair(search *s, uint32_t a, uint32_t b)
{
    void *pairs = s->pairs;
    bool both = !is_outside(s->node, a) && !is_outside(s->node, b);
    double apart = both ? boxes_apart(box_of(s, a), box_of(s, b)) : 0;
    if (csg_box_is_empty(box_of(s, a)) || csg_box_is_empty(box_of(s, b)) ||
        (is_outside(s->node, a) && is_outside(s->node, b)) ||
        (s->node->child_count > FEW && apart > 2 * s->radius))
        return true;
    if (!csg_memory_reserve(s->memory, &pairs, &s->pair_capacity, s->pair_count + 1,
                            sizeof *s->pairs))
        return false;
    s->pairs = pairs;
    s->pairs[s->pair_count++] = (pair){a, b, apart > 0};
    return true;
}

/* For qsort, which hands no context on. */
typedef struct start {
    double x;
    uint32_t k;
} start;

static int compare_starts(const void *a, const void *b)
{
    const start *l = a, *r = b;
    if (l->x != r->x)
        return l->x < r->x ? -1 : 1;
    return (l->k > r->k) - (l->k < r->k);
}

/* Of many operands, those whose boxes are in reach along x. */
static bool add_near_pairs(search *s)
{
    uint32_t count = s->node->child_count;
    start *starts = csg_memory_alloc(s->memory, count * sizeof *starts);
    bool done = starts != NULL;
    for (uint32_t k = 0; done && k < count; k++)
        starts[k] = (start){is_outside(s->node, k) ? -INFINITY : box_of(s, k).min.x, k};
    if (done)
        qsort(starts, count, sizeof *starts, compare_starts);
    for (uint32_t i = 0; done && i < count; i++) {
        double end = is_outside(s->node, starts[i].k) ? INFINITY : box_of(s, starts[i].k).max.x;
        for (uint32_t k = i + 1; done && k < count && starts[k].x <= end + 2 * s->radius; k++)
            done = add_pair(s, starts[i].k, starts[k].k);
    }
    csg_memory_release(s->memory, starts, count * sizeof *starts);
    return done;
}

static bool find_pairs(search *s)
{
    s->pair_count = 0;
    if (s->node->child_count > FEW)
        return add_near_pairs(s);
    for (uint32_t a = 0; a < s->node->child_count; a++)
        for (uint32_t b = a + 1; b < s->node->child_count; b++)
            if (!add_pair(s, a, b))
                return false;
    return true;
}

/* ---- whether two meet -------------------------------------------------------------------------- */

typedef struct cell {
    csg_vec3 at, half;
} cell;

/* The value of operand k, its complement's where that is what the fillet joins. */
static double value_of(search *s, uint32_t k, csg_vec3 p)
{
    csg_node_id id = s->children[k];
    double value = csg_reference_below(&s->room, s->scene, s->firsts[id], id, p).value;
    return is_outside(s->node, k) ? -value : value;
}

static bool find_room(const search *s, const pair *p, cell *all)
{
    csg_box box = csg_box_all();
    if (!is_outside(s->node, p->a))
        box = box_of(s, p->a);
    if (!is_outside(s->node, p->b))
        box = csg_box_intersect(box, box_of(s, p->b));
    if (!isfinite(box.min.z) && !isfinite(box.max.z)) /* a flat figure is the same along z */
        box.min.z = box.max.z = 0;
    if (!csg_box_is_finite(box))
        return false;
    *all = (cell){csg_box_center(box), csg_vec3_scale(csg_box_size(box), 0.5)};
    return true;
}

static void split(const cell *whole, cell parts[2])
{
    csg_vec3 h = whole->half, by = {0, 0, 0};
    if (h.x >= h.y && h.x >= h.z)
        by.x = h.x /= 2;
    else if (h.y >= h.z)
        by.y = h.y /= 2;
    else
        by.z = h.z /= 2;
    parts[0] = (cell){csg_vec3_sub(whole->at, by), h};
    parts[1] = (cell){csg_vec3_add(whole->at, by), h};
}

/* Proves that no point is in both; *gap: about how far they are apart then. */
static bool are_apart(search *s, const pair *p, uint64_t looks, double *gap)
{
    cell stack[MOST_SPLITS + 1];
    uint32_t top = 0;
    double most = -INFINITY;
    if (!find_room(s, p, &stack[top++]))
        return false;
    double near = SAME * (csg_vec3_norm(stack[0].at) + csg_vec3_norm(stack[0].half));
    double slope_a = s->slopes[s->children[p->a]], slope_b = s->slopes[s->children[p->b]];
    while (top) {
        cell c = stack[--top];
        double a = value_of(s, p->a, c.at), radius = csg_vec3_norm(c.half);
        if (!looks-- || !isfinite(a))
            return false;
        if (a + slope_a * radius < -near)
            continue;
        double b = value_of(s, p->b, c.at);
        if (!(fmin(a, b) < -near) || top + 2 > MOST_SPLITS || radius < near)
            return false;
        most = fmax(most, fmin(a, b));
        if (b + slope_b * radius < -near)
            continue;
        split(&c, stack + top);
        top += 2;
    }
    *gap = fmin(*gap, isfinite(most) ? -2 * most : *gap);
    return true;
}

static uint64_t cost_of(const search *s, const pair *p)
{
    return s->costs[s->children[p->a]] + s->costs[s->children[p->b]];
}

static bool can_be_told(const search *s, const pair *p)
{
    return s->is_steady[s->children[p->a]] && s->is_steady[s->children[p->b]];
}

/* Moves the pairs that do not meet to the front; returns how many. *gap: the least between them,
 * INFINITY where some meet. */
static size_t keep_apart(search *s, double *gap)
{
    uint64_t work = 0;
    size_t kept = 0, count = s->pair_count;
    for (size_t i = 0; i < count; i++)
        work +=
            s->pairs[i].by_boxes || !can_be_told(s, &s->pairs[i]) ? 0 : cost_of(s, &s->pairs[i]);
    uint64_t looks = work ? s->most_work / work : 0;
    looks = looks < MOST_LOOKS ? looks : MOST_LOOKS;
    bool all = count > 0;
    *gap = INFINITY;
    for (size_t i = 0; i < count; i++) {
        pair p = s->pairs[i];
        if (p.by_boxes)
            *gap = fmin(*gap, boxes_apart(box_of(s, p.a), box_of(s, p.b)));
        else if (!can_be_told(s, &p) || !are_apart(s, &p, looks, gap)) {
            all = false;
            continue;
        }
        s->pairs[i] = s->pairs[kept];
        s->pairs[kept++] = p;
    }
    *gap = all ? *gap : INFINITY;
    return kept;
}

/* ---- all blends -------------------------------------------------------------------------------- */

/* From the leaves up. */
static void look_below(search *s)
{
    const csgm_scene *scene = s->scene;
    csg_scene_slopes(scene, s->slopes);
    for (size_t i = 0; i < scene->node_count; i++) {
        const csg_node *node = &scene->nodes[i];
        const csg_node_id *children = csg_scene_children(scene, node);
        s->firsts[i] = node->child_count ? s->firsts[children[0]] : (csg_node_id)i;
        s->costs[i] = csg_reference_cost(scene, node);
        s->is_steady[i] = isfinite(s->slopes[i]) && !csg_reference_turns(scene, node);
        for (uint32_t k = 0; k < node->child_count; k++) {
            s->costs[i] += s->costs[children[k]];
            s->is_steady[i] = s->is_steady[i] && s->is_steady[children[k]];
        }
    }
}

static bool look_at(search *s, csg_node_id id, csg_apart_take *take, void *user)
{
    const csgm_scene *scene = s->scene;
    s->node = &scene->nodes[id];
    s->children = csg_scene_children(scene, s->node);
    s->radius = csg_scene_blend(scene, s->node).n;
    if (!find_pairs(s))
        return false;
    csg_apart found = {.id = id, .count = s->pair_count};
    found.apart = keep_apart(s, &found.gap);
    found.pairs = s->pairs;
    if (s->node->child_count > FEW) /* others may be nearer than the pairs looked at */
        found.gap = INFINITY;
    return take(user, &found);
}

static bool look_at_all(search *s, uint64_t blends, bool (*is_wanted)(const csg_node *node),
                        csg_apart_take *take, void *user)
{
    s->most_work = MOST_IN_ALL / blends < MOST_WORK ? MOST_IN_ALL / blends : MOST_WORK;
    look_below(s);
    for (size_t i = 0; i < s->scene->node_count; i++)
        if (is_wanted(&s->scene->nodes[i]) && !look_at(s, (csg_node_id)i, take, user))
            return false;
    return true;
}

csgm_status csg_apart_find(const csgm_scene *scene, bool (*is_wanted)(const csg_node *node),
                           csg_apart_take *take, void *user)
{
    csg_memory *memory = &scene->context->memory;
    size_t count = scene->node_count;
    uint64_t blends = 0;
    for (size_t i = 0; i < count; i++)
        blends += is_wanted(&scene->nodes[i]);
    if (!blends)
        return CSGM_OK;
    search s = {.scene = scene, .memory = memory};
    s.firsts = csg_memory_alloc(memory, count * sizeof *s.firsts);
    s.costs = csg_memory_alloc(memory, count * sizeof *s.costs);
    s.is_steady = csg_memory_alloc(memory, count * sizeof *s.is_steady);
    s.slopes = csg_memory_alloc(memory, count * sizeof *s.slopes);
    bool done =
        s.firsts && s.costs && s.is_steady && s.slopes && csg_reference_room_begin(&s.room, scene);
    if (done) {
        done = look_at_all(&s, blends, is_wanted, take, user);
        csg_reference_room_end(&s.room, scene);
    }
    csg_memory_release(memory, s.firsts, count * sizeof *s.firsts);
    csg_memory_release(memory, s.costs, count * sizeof *s.costs);
    csg_memory_release(memory, s.is_steady, count * sizeof *s.is_steady);
    csg_memory_release(memory, s.slopes, count * sizeof *s.slopes);
    csg_memory_release(memory, s.pairs, s.pair_capacity * sizeof *s.pairs);
    return done ? CSGM_OK : CSGM_ERR_MEMORY;
}

/* ---- fillets ----------------------------------------------------------------------------------- */

typedef struct rows {
    csgm_scene *scene;
    uint32_t *made;
    size_t count, capacity;
} rows;

/* Rows of the operands, as csg_fillet_planes has them. */
static bool write_rows(rows *r, const csg_apart *found, double *first)
{
    uint32_t count = r->scene->nodes[found->id].child_count;
    size_t size = count + 1 + 2 * found->apart;
    void *made = r->made;
    if (!csg_memory_reserve(&r->scene->context->memory, &made, &r->capacity, r->count + size,
                            sizeof *r->made))
        return false;
    r->made = made;
    uint32_t *row = r->made + r->count;
    memset(row, 0, size * sizeof *row);
    for (size_t i = 0; i < found->apart; i++) {
        row[found->pairs[i].a]++;
        row[found->pairs[i].b]++;
    }
    uint32_t at = count + 1;
    for (uint32_t k = 0; k <= count; k++) { /* where each row ends, for now */
        at += k < count ? row[k] : 0;
        row[k] = at;
    }
    for (size_t i = found->apart; i-- > 0;) {
        row[--row[found->pairs[i].a]] = found->pairs[i].b;
        row[--row[found->pairs[i].b]] = found->pairs[i].a;
    }
    *first = 1 + (double)r->count;
    r->count += size;
    return true;
}

static bool take_fillet(void *user, const csg_apart *found)
{
    rows *r = user;
    const csg_node *node = &r->scene->nodes[found->id];
    double *v = r->scene->parameters + node->payload;
    bool all = node->kind == CSG_NODE_UNION && found->apart == found->count;
    v[CSG_FILLET_APART] = 0;
    v[CSG_FILLET_APART_BY] = all && isfinite(found->gap) ? found->gap : 0;
    return !found->apart || write_rows(r, found, &v[CSG_FILLET_APART]);
}

csgm_status csg_fillet_apart_find(csgm_scene *scene)
{
    rows r = {.scene = scene};
    csgm_status status = csg_apart_find(scene, csg_node_is_fillet, take_fillet, &r);
    if (status == CSGM_OK && r.count) {
        scene->apart = csg_arena_calloc(&scene->arena, r.count, sizeof *r.made);
        status = scene->apart ? CSGM_OK : CSGM_ERR_MEMORY;
    }
    if (status == CSGM_OK && r.count)
        memcpy(scene->apart, r.made, r.count * sizeof *r.made);
    csg_memory_release(&scene->context->memory, r.made, r.capacity * sizeof *r.made);
    return status;
}
