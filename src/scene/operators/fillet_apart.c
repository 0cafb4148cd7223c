/* SPDX-License-Identifier: MIT
 * Solids of a fillet that do not meet; see fillet_apart.h.
 */
#include "scene/operators/fillet_apart.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "scene/operators/blend_kinds.h"
#include "scene/reference.h"

enum {
    MOST_LOOKS = 20000,    /* at one pair */
    MOST_WORK = 400000,    /* nodes asked, of one fillet */
    MOST_IN_ALL = 8000000, /* of all fillets of a scene */
    MOST_SPLITS = 96,      /* of a cube, until it is as small as rounding */
    FEW = 64               /* operands: all pairs are looked at, else those with boxes in reach */
};

/* Of the size of both: solids that are nearer touch. */
static const double SAME = 1e-9;

typedef struct pair {
    uint32_t a, b;
    bool by_boxes; /* these are apart */
} pair;

typedef struct search {
    csgm_scene *scene;
    csg_memory *memory;
    csg_reference_room room;
    /* per node: the first one below it, what it takes to ask it with those, whether its values have
     * a constant, which is in `slopes` */
    csg_node_id *firsts;
    uint64_t *costs;
    bool *is_steady;
    double *slopes;
    /* of the fillet at hand */
    const csg_node *node;
    const csg_node_id *children;
    double radius;
    pair *pairs;
    size_t pair_count, pair_capacity;
    /* of all */
    uint64_t most_work;
    uint32_t *made;
    size_t made_count, made_capacity;
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

/* Leaves those pairs that do not meet; *gap: the least between them, INFINITY where some meet. */
static void keep_apart(search *s, double *gap)
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
        s->pairs[kept++] = p;
    }
    s->pair_count = kept;
    *gap = all ? *gap : INFINITY;
}

/* ---- all fillets ------------------------------------------------------------------------------- */

/* Rows of the operands, as csg_fillet_planes has them. */
static bool write_rows(search *s, double *first)
{
    uint32_t count = s->node->child_count;
    size_t size = count + 1 + 2 * s->pair_count;
    void *made = s->made;
    if (!csg_memory_reserve(s->memory, &made, &s->made_capacity, s->made_count + size,
                            sizeof *s->made))
        return false;
    s->made = made;
    uint32_t *rows = s->made + s->made_count;
    memset(rows, 0, size * sizeof *rows);
    for (size_t i = 0; i < s->pair_count; i++) {
        rows[s->pairs[i].a]++;
        rows[s->pairs[i].b]++;
    }
    uint32_t at = count + 1;
    for (uint32_t k = 0; k <= count; k++) { /* where each row ends, for now */
        at += k < count ? rows[k] : 0;
        rows[k] = at;
    }
    for (size_t i = s->pair_count; i-- > 0;) {
        rows[--rows[s->pairs[i].a]] = s->pairs[i].b;
        rows[--rows[s->pairs[i].b]] = s->pairs[i].a;
    }
    *first = 1 + (double)s->made_count;
    s->made_count += size;
    return true;
}

static bool look_at(search *s, size_t id)
{
    const csgm_scene *scene = s->scene;
    double *v = s->scene->parameters + scene->nodes[id].payload, gap;
    s->node = &scene->nodes[id];
    s->children = csg_scene_children(scene, s->node);
    s->radius = v[CSG_FILLET_N];
    if (!find_pairs(s))
        return false;
    size_t pairs = s->pair_count;
    keep_apart(s, &gap);
    bool knows_all = s->node->kind == CSG_NODE_UNION && s->node->child_count <= FEW;
    v[CSG_FILLET_APART_BY] = knows_all && pairs == s->pair_count && isfinite(gap) ? gap : 0;
    return !s->pair_count || write_rows(s, &v[CSG_FILLET_APART]);
}

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

static bool keep(search *s)
{
    if (!s->made_count)
        return true;
    s->scene->apart = csg_arena_calloc(&s->scene->arena, s->made_count, sizeof *s->made);
    if (s->scene->apart)
        memcpy(s->scene->apart, s->made, s->made_count * sizeof *s->made);
    return s->scene->apart != NULL;
}

static bool look_at_all(search *s, uint64_t fillets)
{
    csgm_scene *scene = s->scene;
    s->most_work = MOST_IN_ALL / fillets < MOST_WORK ? MOST_IN_ALL / fillets : MOST_WORK;
    look_below(s);
    for (size_t i = 0; i < scene->node_count; i++)
        if (csg_node_is_fillet(&scene->nodes[i]) && !look_at(s, i))
            return false;
    return keep(s);
}

csgm_status csg_fillet_apart_find(csgm_scene *scene)
{
    csg_memory *memory = &scene->context->memory;
    size_t count = scene->node_count;
    uint64_t fillets = 0;
    for (size_t i = 0; i < count; i++)
        if (csg_node_is_fillet(&scene->nodes[i])) {
            double *v = scene->parameters + scene->nodes[i].payload;
            v[CSG_FILLET_APART] = v[CSG_FILLET_APART_BY] = 0;
            fillets++;
        }
    if (!fillets)
        return CSGM_OK;
    search s = {.scene = scene, .memory = memory};
    s.firsts = csg_memory_alloc(memory, count * sizeof *s.firsts);
    s.costs = csg_memory_alloc(memory, count * sizeof *s.costs);
    s.is_steady = csg_memory_alloc(memory, count * sizeof *s.is_steady);
    s.slopes = csg_memory_alloc(memory, count * sizeof *s.slopes);
    bool done =
        s.firsts && s.costs && s.is_steady && s.slopes && csg_reference_room_begin(&s.room, scene);
    if (done) {
        done = look_at_all(&s, fillets);
        csg_reference_room_end(&s.room, scene);
    }
    csg_memory_release(memory, s.firsts, count * sizeof *s.firsts);
    csg_memory_release(memory, s.costs, count * sizeof *s.costs);
    csg_memory_release(memory, s.is_steady, count * sizeof *s.is_steady);
    csg_memory_release(memory, s.slopes, count * sizeof *s.slopes);
    csg_memory_release(memory, s.pairs, s.pair_capacity * sizeof *s.pairs);
    csg_memory_release(memory, s.made, s.made_capacity * sizeof *s.made);
    return done ? CSGM_OK : CSGM_ERR_MEMORY;
}
