/* SPDX-License-Identifier: MIT
 * Cubes that the surface runs through; see cubes.h. What is beyond a wall is the outside: planes
 * between which the field is known are turned around for it.
 */
#include "walls/cubes.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "mesh/distance/slopes.h"
#include "walls/segment.h"

/* What floats cannot tell. */
static double slack_of(const csg_wall_cubes *c)
{
    return 6 * (double)c->side.worker->pruner.rounding;
}

/* ---- what is known of a cube -------------------------------------------------------------------
 */

static void turn_around(csg_halves *h)
{
    for (int i = 0; i < h->plane_count; i++) {
        csg_enclosure *e = &h->planes[i];
        double below = e->below;
        e->value = -e->value;
        e->below = e->above;
        e->above = below;
        for (int k = 0; k < 3; k++)
            e->slope[k] = -e->slope[k];
    }
    for (int i = 0; i < h->length; i++)
        if (h->code[i] < 0)
            h->code[i] =
                h->code[i] == CSG_HALVES_UNION ? CSG_HALVES_INTERSECTION : CSG_HALVES_UNION;
}

/* One group of all gradients. Where some may vanish, any direction may be a normal. False: out of
 * memory. */
static bool find_normals(csg_wall_cubes *c, const csg_gradients *g, csg_wall_cube *node)
{
    uint32_t count = g ? g->balls.count : 0;
    csg_wall_group *group = csg_arena_alloc(&c->arena, sizeof *group);
    csg_wall_cap *caps = csg_arena_alloc(&c->arena, count * sizeof *caps + 1);
    if (!group || !caps)
        return false;
    *group = (csg_wall_group){.normals = {.count = 0}};
    node->groups = group;
    node->group_count = 1;
    for (uint32_t i = 0; i < count; i++) {
        const double *at = g->balls.items[i].at;
        double length = csg_norm3(at), sine = g->balls.items[i].spread / length;
        caps[i].sine = sine + CSG_ENCLOSURE_ROUNDING;
        if (!(caps[i].sine < 1))
            return true;
        for (int k = 0; k < 3; k++)
            caps[i].at[k] = -c->side.turn * at[k] / length;
    }
    group->normals = (csg_wall_normals){count, caps};
    return true;
}

/* Whether two planes may both be zero somewhere in the cube: their sum and their difference, of
 * slopes of unit length, are then, too. */
static bool may_meet(const csg_enclosure *a, const csg_enclosure *b, double half)
{
    double length_a = csg_norm3(a->slope), length_b = csg_norm3(b->slope);
    double room = fmax(a->below, a->above) / length_a + fmax(b->below, b->above) / length_b;
    room += 1e-12 * (fabs(a->value) / length_a + fabs(b->value) / length_b + half);
    for (int sign = -1; sign <= 1; sign += 2) {
        double value = a->value / length_a + sign * b->value / length_b, reach = 0;
        for (int k = 0; k < 3; k++)
            reach += fabs(a->slope[k] / length_a + sign * b->slope[k] / length_b) * half;
        if (fabs(value) > reach + room)
            return false;
    }
    return true;
}

/* ---- which planes are faces ----
 * Where solids touch, or one ends in a face of another one, planes run through the cube that are no
 * part of the surface: their normals are none of it. What is thinner than floats can tell is not
 * there, neither a gap nor a wall.
 */

/* Of a plane: the first one that is the same but for rounding, or the same turned around. */
typedef struct twin {
    int of;
    bool is_turned;
} twin;

/* How far two planes are from each other, or from each other's negative, in the cube. */
static double off_by(const csg_enclosure *a, const csg_enclosure *b, double half, double sign)
{
    double off = fabs(a->value - sign * b->value);
    for (int axis = 0; axis < 3; axis++)
        off += half * fabs(a->slope[axis] - sign * b->slope[axis]);
    return off + fmax(a->below, a->above) + fmax(b->below, b->above);
}

static void find_twins(const csg_halves *h, double half, double slack, twin twins[CSG_HALVES_MOST])
{
    for (int i = 0; i < h->plane_count; i++) {
        twins[i] = (twin){i, false};
        for (int k = 0; k < i && twins[i].of == i; k++)
            for (int sign = -1; sign <= 1; sign += 2)
                if (twins[k].of == k && off_by(&h->planes[i], &h->planes[k], half, sign) <= slack)
                    twins[i] = (twin){k, sign < 0};
    }
}

/* What plane k is where plane i is zero in the cube. */
static csg_truth truth_on(const csg_enclosure *i, const csg_enclosure *k, double half)
{
    double square = 0, both = 0, reach = 0;
    for (int axis = 0; axis < 3; axis++) {
        square += i->slope[axis] * i->slope[axis];
        both += i->slope[axis] * k->slope[axis];
    }
    double share = both / square, value = k->value - share * i->value;
    for (int axis = 0; axis < 3; axis++)
        reach += half * fabs(k->slope[axis] - share * i->slope[axis]);
    reach =
        (reach + fmax(k->below, k->above) + fabs(share) * fmax(i->below, i->above)) * (1 + 1e-9) +
        1e-12 * (fabs(value) + fabs(k->value));
    return value > reach ? CSG_TRUTH_YES : value < -reach ? CSG_TRUTH_NO : CSG_TRUTH_OPEN;
}

static csg_truth evaluate(const csg_halves *h, const twin *twins, const csg_truth *first)
{
    csg_truth all[CSG_HALVES_MOST];
    for (int k = 0; k < h->plane_count; k++) {
        csg_truth truth = first[twins[k].of];
        bool turn = twins[k].is_turned;
        all[k] = !turn ? truth : truth == CSG_TRUTH_YES ? CSG_TRUTH_NO : CSG_TRUTH_YES;
    }
    return csg_halves_evaluate(h, all);
}

/* Whether the solid may change where plane i is zero, whatever the planes are there of which
 * nothing is known. */
static bool is_face(const csg_halves *h, int i, double half, const twin *twins)
{
    csg_truth first[CSG_HALVES_MOST];
    int open[CSG_HALVES_MOST], count = 0;
    for (int k = 0; k < h->plane_count; k++) {
        if (twins[k].of != k || k == i)
            continue;
        first[k] = truth_on(&h->planes[i], &h->planes[k], half);
        if (first[k] == CSG_TRUTH_OPEN)
            open[count++] = k;
    }
    for (unsigned mask = 0; mask < 1u << count; mask++) {
        for (int n = 0; n < count; n++)
            first[open[n]] = mask >> n & 1 ? CSG_TRUTH_YES : CSG_TRUTH_NO;
        first[i] = CSG_TRUTH_YES;
        csg_truth with = evaluate(h, twins, first);
        first[i] = CSG_TRUTH_NO;
        if (with != evaluate(h, twins, first))
            return true;
    }
    return false;
}

/* Planes that are faces, each once. */
static uint8_t find_faces(const csg_halves *h, double half, double slack)
{
    twin twins[CSG_HALVES_MOST];
    uint8_t faces = 0;
    find_twins(h, half, slack, twins);
    for (int i = 0; i < h->plane_count; i++)
        if (twins[i].of == i && is_face(h, i, half, twins))
            faces |= (uint8_t)(1u << i);
    return faces;
}

/* Numbers the groups of faces: those that may meet, and what may meet these, have the same. */
static int number_groups(const csg_halves *h, double half, uint8_t faces,
                         int group_of[CSG_HALVES_MOST])
{
    int count = 0, todo[CSG_HALVES_MOST];
    for (int i = 0; i < h->plane_count; i++)
        group_of[i] = -1;
    for (int i = 0; i < h->plane_count; i++) {
        int top = 0;
        if (group_of[i] >= 0 || !(faces >> i & 1))
            continue;
        group_of[i] = count;
        todo[top++] = i;
        while (top > 0) {
            int at = todo[--top];
            for (int k = 0; k < h->plane_count; k++)
                if (group_of[k] < 0 && (faces >> k & 1) &&
                    may_meet(&h->planes[at], &h->planes[k], half)) {
                    group_of[k] = count;
                    todo[top++] = k;
                }
        }
        count++;
    }
    return count;
}

/* Whether the normals of each plane are known. */
static bool has_normals(const csg_halves *h)
{
    for (int i = 0; i < h->plane_count; i++)
        if (!(h->planes[i].stray > 0 && h->planes[i].stray < csg_norm3(h->planes[i].slope)))
            return false;
    return h->plane_count > 0;
}

/* Of turned planes; there are none where nothing is a face. False: out of memory. */
static bool find_groups(csg_wall_cubes *c, const csg_halves *h, uint8_t faces, csg_wall_cube *node)
{
    int group_of[CSG_HALVES_MOST], count = number_groups(h, node->cube.half, faces, group_of);
    csg_wall_group *groups = csg_arena_alloc(&c->arena, (size_t)count * sizeof *groups + 1);
    csg_wall_cap *caps = csg_arena_alloc(&c->arena, (size_t)h->plane_count * sizeof *caps);
    if (!groups || !caps)
        return false;
    node->groups = groups;
    node->group_count = (uint8_t)count;
    for (int g = 0; g < count; g++) {
        uint32_t n = 0;
        groups[g] = (csg_wall_group){.has_planes = true};
        for (int i = 0; i < h->plane_count; i++) {
            const double *s = h->planes[i].slope;
            double length = csg_norm3(s);
            if (group_of[i] != g)
                continue;
            groups[g].planes[n] = (uint8_t)i;
            caps[n++] = (csg_wall_cap){{-s[0] / length, -s[1] / length, -s[2] / length},
                                       h->planes[i].stray / length};
        }
        groups[g].normals = (csg_wall_normals){n, caps};
        caps += n;
    }
    return true;
}

/* Where the field is nowhere below zero, or nowhere above, solids share a face, or have none left:
 * there is no gap between them, and no wall. */
static bool is_only_touched(const csg_wall_cubes *c, const csg_gradients *g)
{
    double slack = slack_of(c);
    return c->side.turn > 0 ? g->least >= -slack : g->most <= slack;
}

/* What contains what is beyond, and its normals. *is_empty: nothing of it is there. False: out of
 * memory. */
static bool describe(csg_wall_cubes *c, csg_halves *halves, const csg_gradients *gradients,
                     csg_wall_cube *node, bool *is_empty)
{
    *is_empty = false;
    if (!halves)
        return find_normals(c, gradients, node);
    csg_clear_pieces *pieces = csg_arena_alloc(&c->arena, sizeof *pieces);
    if (!pieces)
        return false;
    double half = node->cube.half;
    /* one plane for several faces, as of a polygon's corner, says less than their gradients do */
    bool is_coarse = halves->plane_count == 1 && gradients && gradients->balls.count > 1;
    bool knows_faces = has_normals(halves) && !is_coarse;
    uint8_t faces = knows_faces ? find_faces(halves, half, slack_of(c)) : 0;
    if (c->side.turn < 0)
        turn_around(halves);
    csg_clear_pieces_find(halves, node->cube.half, pieces);
    *is_empty = !pieces->count || (knows_faces && !faces);
    node->pieces = pieces;
    return knows_faces ? find_groups(c, halves, faces, node) : find_normals(c, gradients, node);
}

static bool is_vague(const csg_wall_cube *node)
{
    static const double CLOSELY = 0.25; /* the sine of 14 degrees */
    for (int g = 0; g < node->group_count; g++) {
        const csg_wall_normals *n = &node->groups[g].normals;
        for (uint32_t i = 0; i < n->count; i++)
            if (n->caps[i].sine > CLOSELY)
                return true;
        if (!n->count || (n->count > 1 && !node->groups[g].has_planes))
            return true;
    }
    return false;
}

/* False: out of memory. */
static bool add(csg_wall_cubes *c, csg_measure_cube *cube)
{
    const csg_measure_walk *w = c->side.walk;
    csg_halves halves;
    csg_gradients gradients;
    bool is_empty, is_known = csg_measure_enclose_with_strays(w, c->side.worker, cube, &halves);
    if (cube->state != CSG_CELL_SURFACE)
        return true;
    csg_wall_cube node = {.cube = *cube};
    const csg_vec3 at = csg_vec3_make(cube->c[0], cube->c[1], cube->c[2]);
    const csg_gradients_region region = {
        {at, at, at}, at, 0, csg_enclosure_radius(cube->half) / sqrt(3.0)};
    bool has_gradients = csg_gradients_find(w->kernel, &cube->tape, &region,
                                            c->side.worker->scratch, w->scratch_floats, &gradients);
    if (has_gradients && is_only_touched(c, &gradients))
        return true;
    if (!describe(c, is_known ? &halves : NULL, has_gradients ? &gradients : NULL, &node,
                  &is_empty))
        return false;
    if (is_empty)
        return true;
    if (!csg_memory_reserve(&w->context->memory, (void **)&c->nodes, &c->capacity, c->count + 1,
                            sizeof node))
        return false;
    node.is_vague = is_vague(&node);
    c->nodes[c->count++] = node;
    return true;
}

bool csg_wall_cubes_begin(csg_wall_cubes *c, const csg_wall_side *side, bool *is_there)
{
    csg_measure_cube root = csg_measure_root(side->walk);
    *c = (csg_wall_cubes){.side = *side};
    csg_arena_init(&c->arena, &side->walk->context->memory);
    bool done = add(c, &root);
    *is_there = c->count > 0;
    return done;
}

void csg_wall_cubes_release(csg_wall_cubes *c)
{
    csg_memory_release(&c->side.walk->context->memory, c->nodes, c->capacity * sizeof *c->nodes);
    csg_arena_reset(&c->arena);
}

/* ---- pairs -------------------------------------------------------------------------------------
 */

static csg_vec3 center_of(const csg_wall_cube *n)
{
    return csg_vec3_make(n->cube.c[0], n->cube.c[1], n->cube.c[2]);
}

/* Of a cube, as far as it may face another one. */
typedef struct looker {
    const csg_wall_cube *cube;
    uint8_t one, other;            /* groups that may look along the line so exactly */
    uint8_t groups;                /* those that do face something */
    uint8_t need[CSG_HALVES_MOST]; /* of each group: planes that the surface must be on there */
} looker;

typedef struct pair {
    looker a, b;
    double offset[3], bound, slack;
} pair;

/* The planes that a point of the surface must be on if it is to look along d: without their normals
 * there is none that does. */
static uint8_t needed(const csg_wall_group *g, const double d[3], csg_wall_angle angle)
{
    csg_wall_cap rest[CSG_HALVES_MOST];
    const csg_wall_normals *n = &g->normals;
    uint8_t need = 0;
    for (uint32_t i = 0; g->has_planes && i < n->count; i++) {
        const csg_wall_normals others = {n->count - 1, rest};
        for (uint32_t k = 0, to = 0; k < n->count; k++)
            if (k != i)
                rest[to++] = n->caps[k];
        if (n->count == 1 || csg_wall_is_apart(&others, d, angle))
            need |= (uint8_t)(1u << g->planes[i]);
    }
    return need;
}

/* line: NULL = it may have any direction. */
static void look(looker *l, const csg_wall_cube *cube, const csg_wall_line *line, double turn)
{
    *l = (looker){.cube = cube};
    for (int g = 0; g < cube->group_count; g++) {
        const csg_wall_group *group = &cube->groups[g];
        uint8_t bit = (uint8_t)(1u << g);
        if (!line) {
            l->one |= bit;
            l->other |= bit;
            continue;
        }
        const double d[3] = {turn * line->d[0], turn * line->d[1], turn * line->d[2]};
        if (csg_wall_is_apart(&group->normals, d, line->other))
            continue;
        l->other |= bit;
        l->one |= csg_wall_is_apart(&group->normals, d, line->one) ? 0 : bit;
        l->need[g] = needed(group, d, line->other);
    }
}

/* Which groups face each other. */
static void match(pair *w, const csg_wall_angles *angles)
{
    for (int g = 0; g < w->a.cube->group_count; g++)
        for (int h = 0; h < w->b.cube->group_count; h++) {
            bool looks =
                (w->a.one >> g & w->b.other >> h & 1) || (w->a.other >> g & w->b.one >> h & 1);
            if (looks && csg_wall_may_oppose(&w->a.cube->groups[g].normals,
                                             &w->b.cube->groups[h].normals, angles)) {
                w->a.groups |= (uint8_t)(1u << g);
                w->b.groups |= (uint8_t)(1u << h);
            }
        }
}

static double reach_of(const looker *l, const double d[3])
{
    const csg_wall_cube *n = l->cube;
    double all = csg_clear_reach(n->pieces, n->cube.half, d), most = -INFINITY;
    for (int g = 0; g < n->group_count; g++) {
        double of_group = all;
        if (!(l->groups >> g & 1))
            continue;
        if (l->need[g]) {
            csg_clear_pieces on = *n->pieces;
            on.count = 1;
            on.masks[0] = l->need[g];
            of_group = fmin(all, csg_clear_reach(&on, n->cube.half, d));
        }
        most = fmax(most, of_group);
    }
    return most;
}

static void look_along(pair *w, double x, double y, double z)
{
    double length = sqrt(x * x + y * y + z * z);
    const double d[3] = {x / length, y / length, z / length}, back[3] = {-d[0], -d[1], -d[2]};
    if (!(length > 0))
        return;
    double along = d[0] * w->offset[0] + d[1] * w->offset[1] + d[2] * w->offset[2];
    double apart = along - reach_of(&w->a, d) - reach_of(&w->b, back);
    w->bound = fmax(w->bound, apart - w->slack);
}

static void look_along_normals(pair *w, const looker *l, double turn)
{
    const csg_clear_pieces *pieces = l->cube->pieces;
    uint8_t used = 0;
    for (int g = 0; g < l->cube->group_count; g++)
        used |= l->groups >> g & 1 ? l->need[g] : 0;
    for (int i = 0; pieces && !used && i < pieces->count; i++)
        used |= pieces->masks[i];
    for (int i = 0; pieces && i < pieces->plane_count; i++) {
        const double *s = pieces->planes[i].slope;
        if (used >> i & 1)
            look_along(w, turn * s[0], turn * s[1], turn * s[2]);
    }
}

/* The distance of the cubes. gap: from one to the other, as far as they are apart. */
static double cubes_apart(const pair *w, double gap[3])
{
    double reach = w->a.cube->cube.half + w->b.cube->cube.half, widest = -INFINITY, square = 0;
    for (int k = 0; k < 3; k++) {
        double apart = fabs(w->offset[k]) - reach;
        widest = fmax(widest, apart);
        gap[k] = apart > 0 ? copysign(apart, w->offset[k]) : 0;
        square += apart > 0 ? apart * apart : 0;
    }
    return (widest <= 0 ? widest : sqrt(square)) - w->slack;
}

/* As far as the cubes are, or the planes say along directions that may tell more. */
static double bound(void *user, uint32_t a, uint32_t b, csg_vec3 line, double enough)
{
    csg_wall_cubes *c = user;
    const csg_wall_cube *p = &c->nodes[a], *q = &c->nodes[b];
    csg_vec3 offset = csg_vec3_sub(center_of(q), center_of(p));
    double reach = p->cube.half + q->cube.half, gap[3];
    pair w = {.a.cube = p, .b.cube = q, .offset = {offset.x, offset.y, offset.z}};
    w.slack = 4e-15 * (csg_vec3_norm(offset) + reach);
    w.bound = cubes_apart(&w, gap);
    if (w.bound >= enough)
        return w.bound;
    csg_wall_line between =
        csg_wall_line_make(offset, csg_enclosure_radius(reach), &c->side.angles);
    look(&w.a, p, between.is_known ? &between : NULL, 1);
    look(&w.b, q, between.is_known ? &between : NULL, -1);
    match(&w, &c->side.angles);
    if (!w.a.groups)
        return INFINITY;
    if ((p->is_vague || q->is_vague) &&
        csg_vec3_norm(offset) + csg_enclosure_radius(reach) < c->side.finest) {
        c->overlooks = true;
        return INFINITY;
    }
    double turn = csg_vec3_dot(line, offset) < 0 ? -1 : 1;
    look_along(&w, turn * line.x, turn * line.y, turn * line.z);
    if (w.bound < enough)
        look_along_normals(&w, &w.a, -1);
    if (w.bound < enough)
        look_along_normals(&w, &w.b, 1);
    if (w.bound < enough)
        look_along(&w, offset.x, offset.y, offset.z);
    if (w.bound < enough)
        look_along(&w, gap[0], gap[1], gap[2]);
    return w.bound;
}

/* What segments have at a share of their way is in a cube: where that is wholly on the wrong side,
 * none is a wall, or a gap. */
static bool may_see(void *user, uint32_t a, uint32_t b)
{
    static const double SHARES[] = {0.5, 0.25, 0.75};
    csg_wall_cubes *c = user;
    const csg_wall_cube *p = &c->nodes[a], *q = &c->nodes[b];
    csg_vec3 offset = csg_vec3_sub(center_of(q), center_of(p));
    csg_cell_state wrong = c->side.turn > 0 ? CSG_CELL_INSIDE : CSG_CELL_OUTSIDE;
    if (csg_vec3_norm(offset) <= 2 * csg_enclosure_radius(p->cube.half + q->cube.half))
        return true;
    for (size_t i = 0; i < sizeof SHARES / sizeof *SHARES; i++) {
        double half = (1 - SHARES[i]) * p->cube.half + SHARES[i] * q->cube.half;
        csg_vec3 at = csg_vec3_add(center_of(p), csg_vec3_scale(offset, SHARES[i]));
        csg_cell_state state = csg_wall_state_at(&c->side, at, csg_enclosure_radius(half));
        if (state == wrong)
            return false;
    }
    return true;
}

static int choose(void *user, uint32_t a, uint32_t b)
{
    const csg_wall_cubes *c = user;
    const csg_measure_cube *p = &c->nodes[a].cube, *q = &c->nodes[b].cube;
    bool may_a = p->level < CSG_MEASURE_DEEPEST, may_b = q->level < CSG_MEASURE_DEEPEST;
    if (may_a && may_b)
        return p->half >= q->half ? 0 : 1;
    return may_a ? 0 : may_b ? 1 : -1;
}

/* Nodes may move. False: out of memory. */
static bool divide(void *user, uint32_t node, uint32_t *first, uint32_t *count)
{
    csg_wall_cubes *c = user;
    csg_measure_cube children[CSG_OCTANTS];
    if (!c->nodes[node].is_divided) {
        bool done = csg_measure_divide(c->side.walk, c->side.worker, &c->nodes[node].cube,
                                       &c->arena, children);
        uint32_t from = (uint32_t)c->count;
        for (int o = 0; o < CSG_OCTANTS && done; o++)
            if (children[o].state == CSG_CELL_SURFACE)
                done = add(c, &children[o]);
        if (!done) {
            *c->side.out_of_memory = true;
            return false;
        }
        c->nodes[node].first_child = from;
        c->nodes[node].child_count = (uint8_t)(c->count - from);
        c->nodes[node].is_divided = true;
    }
    *first = c->nodes[node].first_child;
    *count = c->nodes[node].child_count;
    return true;
}

static void show(void *user, uint32_t a, uint32_t b, csg_wall_shown *best)
{
    csg_wall_cubes *c = user;
    csg_wall_show_from(&c->side, center_of(&c->nodes[a]), best);
    if (a != b)
        csg_wall_show_from(&c->side, center_of(&c->nodes[b]), best);
    if (a != b)
        csg_wall_show_between(&c->side, center_of(&c->nodes[a]), center_of(&c->nodes[b]), best);
}

csg_wall_source csg_wall_cubes_source(csg_wall_cubes *c)
{
    return (csg_wall_source){.user = c,
                             .bound = bound,
                             .may_see = may_see,
                             .choose = choose,
                             .divide = divide,
                             .show = show};
}
