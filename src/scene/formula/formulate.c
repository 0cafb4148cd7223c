/* SPDX-License-Identifier: MIT
 * From a scene to one formula: points go down the tree, values come up, as in scene/reference.c,
 * only that they are terms.
 */
#include "scene/formula/formulate.h"

#include "scene/formula/terms.h"
#include "scene/warp_kinds.h"

#include <string.h>

#define PI 3.14159265358979323846

typedef struct point_terms {
    csg_term at[3];
} point_terms;

typedef struct work {
    const csgm_scene *scene;
    csg_terms *t;
    point_terms *points; /* per node, in its own frame */
    csg_term *values;    /* per node */
    csg_term *operands;  /* of one operator, or the steps of one formula */
} work;

/* ---- points -----------------------------------------------------------------------------------
 */

static point_terms through(csg_terms *t, const csg_affine *a, const csg_term *p)
{
    point_terms out;
    for (int i = 0; i < 3; i++) {
        csg_term sum = csg_term_mul_number(t, p[0], a->m[i][0]);
        sum = csg_term_add(t, sum, csg_term_mul_number(t, p[1], a->m[i][1]));
        sum = csg_term_add(t, sum, csg_term_mul_number(t, p[2], a->m[i][2]));
        out.at[i] = csg_term_add_number(t, sum, a->t[i]);
    }
    return out;
}

static point_terms twist_terms(csg_terms *t, const double *v, const csg_term *p)
{
    double reach = v[CSG_TWIST_REACH];
    csg_term rho = csg_term_max_number(t, csg_term_norm2(t, p[0], p[1]), reach);
    csg_term inward = csg_term_div(t, csg_term_number(t, reach), rho);
    csg_term angle = csg_term_clamp(t, p[2], v[CSG_TWIST_LOW], v[CSG_TWIST_HIGH]);
    angle = csg_term_mul_number(t, angle, -v[CSG_TWIST_RATE]);
    csg_term c = csg_term_mul(t, inward, csg_term_cos(t, angle));
    csg_term s = csg_term_mul(t, inward, csg_term_sin(t, angle));
    return (point_terms){{csg_term_sub(t, csg_term_mul(t, c, p[0]), csg_term_mul(t, s, p[1])),
                          csg_term_add(t, csg_term_mul(t, s, p[0]), csg_term_mul(t, c, p[1])),
                          p[2]}};
}

/* 1 at low, `end` at high. */
static csg_term taper_scale_terms(csg_terms *t, const double *v, csg_term z, double end)
{
    double grow = (end - 1) / (v[CSG_TAPER_HIGH] - v[CSG_TAPER_LOW]);
    return csg_term_add_number(t, csg_term_mul_number(t, z, grow), 1 - grow * v[CSG_TAPER_LOW]);
}

static point_terms taper_terms(csg_terms *t, const double *v, const csg_term *p)
{
    csg_term z = csg_term_clamp(t, p[2], v[CSG_TAPER_LOW], v[CSG_TAPER_HIGH]);
    const csg_term divided[3] = {csg_term_div(t, p[0], taper_scale_terms(t, v, z, v[CSG_TAPER_X])),
                                 csg_term_div(t, p[1], taper_scale_terms(t, v, z, v[CSG_TAPER_Y])),
                                 p[2]};
    double twist[CSG_WARP_PARAMETERS] = {0};
    twist[CSG_TWIST_RATE] = v[CSG_TAPER_RATE];
    twist[CSG_TWIST_LOW] = v[CSG_TAPER_LOW];
    twist[CSG_TWIST_HIGH] = v[CSG_TAPER_HIGH];
    twist[CSG_TWIST_REACH] = v[CSG_TAPER_REACH];
    return twist_terms(t, twist, divided);
}

/* Behind the ends the angle runs back to 0: |phi| is cut by most (180 - |phi|) / (180 - most). */
static point_terms bend_terms(csg_terms *t, const double *v, const csg_term *p)
{
    double radius = v[CSG_BEND_RADIUS], most = v[CSG_BEND_ANGLE];
    csg_term across = csg_term_number_sub(t, radius, p[2]), s = csg_term_norm2(t, p[0], across);
    csg_term phi = csg_term_mul_number(t, csg_term_atan2(t, p[0], across), PI / 180);
    csg_term bound = csg_term_mul_number(t, csg_term_number_sub(t, PI, csg_term_abs(t, phi)),
                                         most / (PI - most));
    csg_term turned = csg_term_max(t, csg_term_min(t, phi, bound), csg_term_neg(t, bound));
    csg_term shrink = csg_term_min_number(t, csg_term_mul_number(t, s, 1 / v[CSG_BEND_NEAREST]), 1);
    csg_term along = csg_term_mul_number(t, csg_term_mul(t, turned, shrink), radius);
    return (point_terms){{along, p[1], csg_term_number_sub(t, radius, s)}};
}

static point_terms revolve_terms(csg_terms *t, const double *v, const csg_term *p)
{
    return (point_terms){{csg_term_norm2(t, p[0], p[1]), p[2], csg_term_number(t, 0)}};
}

/* hypot(max(a, 0), max(b, 0)) + min(a, 0): where b > 0, a is too. */
static point_terms elbow_terms(csg_terms *t, const double *v, const csg_term *p)
{
    double c = v[CSG_ELBOW_COSINE], s = v[CSG_ELBOW_SINE];
    csg_term y = csg_term_abs(t, p[1]), none = csg_term_number(t, 0);
    csg_term a = csg_term_add(t, csg_term_mul_number(t, p[0], c), csg_term_mul_number(t, y, s));
    csg_term b = csg_term_sub(t, csg_term_mul_number(t, p[0], s), csg_term_mul_number(t, y, c));
    csg_term d = csg_term_norm2(t, csg_term_max(t, a, none), csg_term_max(t, b, none));
    return (point_terms){{csg_term_add(t, d, csg_term_min(t, a, none)), p[2], none}};
}

static point_terms slice_terms(csg_terms *t, const double *v, const csg_term *p)
{
    return (point_terms){{p[0], p[1], csg_term_number(t, 0)}};
}

static point_terms warped(csg_terms *t, const csg_warp *warp, const csg_term *p)
{
    switch ((csg_warp_kind)warp->kind) { /* no default: a warp that is missing does not compile */
    case CSG_WARP_REVOLVE:
        return revolve_terms(t, warp->parameters, p);
    case CSG_WARP_ELBOW:
        return elbow_terms(t, warp->parameters, p);
    case CSG_WARP_SLICE:
        return slice_terms(t, warp->parameters, p);
    case CSG_WARP_TWIST:
        return twist_terms(t, warp->parameters, p);
    case CSG_WARP_TAPER:
        return taper_terms(t, warp->parameters, p);
    case CSG_WARP_BEND:
        return bend_terms(t, warp->parameters, p);
    case CSG_WARP_COUNT:
        break;
    }
    return (point_terms){{p[0], p[1], p[2]}};
}

static void place_points(work *w)
{
    const csgm_scene *scene = w->scene;
    for (uint32_t i = 0; i < 3; i++)
        w->points[scene->root].at[i] = csg_formula_apply(w->t, CSG_FORMULA_X + i, 0, 0);
    for (size_t i = scene->node_count; i-- > 0;) {
        const csg_node *node = &scene->nodes[i];
        point_terms inner = w->points[i];
        if (node->kind == CSG_NODE_TRANSFORM)
            inner = through(w->t, &scene->inverses[node->payload], inner.at);
        else if (node->kind == CSG_NODE_WARP)
            inner = warped(w->t, &scene->warps[node->payload], inner.at);
        for (uint32_t k = 0; k < node->child_count; k++)
            w->points[csg_scene_children(scene, node)[k]] = inner;
    }
}

/* ---- values -----------------------------------------------------------------------------------
 */

/* A formula of the scene at these terms: a point's, which are first taken into its bounds, or all
 * that it combines. */
static csg_term formula(work *w, const csg_formula *f, const csg_term *at)
{
    csg_terms *t = w->t;
    const csg_formula_step *steps = w->scene->steps + f->first;
    const double low[3] = {f->bounds.min.x, f->bounds.min.y, f->bounds.min.z};
    const double high[3] = {f->bounds.max.x, f->bounds.max.y, f->bounds.max.z};
    csg_term *made = w->operands, axes[3];
    for (int i = 0; i < 3; i++)
        axes[i] = isfinite(low[i]) ? csg_term_clamp(t, at[i], low[i], high[i]) : at[i];
    for (uint32_t i = 0; i < f->count; i++) {
        const csg_formula_step *step = &steps[i];
        if (step->op == CSG_FORMULA_CONSTANT)
            made[i] = csg_term_number(t, step->constant);
        else if (step->op <= CSG_FORMULA_Z)
            made[i] = step->a ? at[csg_formula_variable_of(step)] : axes[step->op - CSG_FORMULA_X];
        else
            made[i] = csg_term_of(t, step->op, made[step->a], made[step->b]);
    }
    return made[f->count - 1];
}

static csg_term combined(work *w, const csg_node *node)
{
    const csg_formula *f = &w->scene->formulas[node->payload];
    const csg_node_id *children = csg_scene_children(w->scene, node);
    csg_term zero = csg_term_number(w->t, 0), at[CSG_FORMULA_MOST_VARIABLES] = {zero, zero, zero};
    for (uint32_t k = 0; k < node->child_count; k++)
        at[k] = w->values[children[k]];
    return csg_term_mul_number(w->t, formula(w, f, at), 1 / f->lipschitz);
}

/* Intersection is -G(-f), difference -G(-f1, f2, ...). */
static csg_term joined(work *w, const csg_node *node)
{
    const csg_node_id *children = csg_scene_children(w->scene, node);
    bool outer = node->kind != CSG_NODE_UNION;
    for (uint32_t k = 0; k < node->child_count; k++) {
        bool negated = node->kind == CSG_NODE_INTERSECTION || (outer && k == 0);
        csg_term value = w->values[children[k]];
        w->operands[k] = negated ? csg_term_neg(w->t, value) : value;
    }
    csg_term result =
        csg_formulate_union(w->t, csg_scene_blend(w->scene, node), w->operands, node->child_count);
    return outer ? csg_term_neg(w->t, result) : result;
}

/* False: nothing is known to write for it. */
static bool make_value(work *w, csg_node_id id)
{
    const csgm_scene *scene = w->scene;
    const csg_node *node = &scene->nodes[id];
    csg_term *value = &w->values[id], inner = CSG_FORMULA_NONE;
    const csg_term *p = w->points[id].at;
    if (node->child_count)
        inner = w->values[csg_scene_children(scene, node)[0]];
    if (node->kind == CSG_NODE_SOFT || csg_scene_rule(scene, node) || csg_node_is_fillet(node))
        return false;
    if (node->kind == CSG_NODE_TRANSFORM)
        *value = csg_term_mul_number(w->t, inner, scene->scales[node->payload]);
    else if (node->kind == CSG_NODE_COLOR)
        *value = inner;
    else if (node->kind == CSG_NODE_OFFSET)
        *value = csg_term_add_number(w->t, inner, csg_scene_parameters(scene, node)[0]);
    else if (node->kind == CSG_NODE_WARP)
        *value = csg_term_mul_number(w->t, inner, csg_warp_scale(&scene->warps[node->payload]));
    else if (node->kind == CSG_NODE_COMBINE)
        *value = combined(w, node);
    else if (csg_node_is_operator(node->kind))
        *value = joined(w, node);
    else if (node->kind == CSG_NODE_FIELD)
        *value = formula(w, &scene->formulas[node->payload], p);
    else if (node->kind == CSG_NODE_SHAPE)
        return csg_formulate_shape(w->t, scene->shapes[node->payload], p, value);
    else
        *value = csg_formulate_primitive(w->t, node->kind, csg_scene_parameters(scene, node), p);
    return true;
}

static csgm_status make_values(work *w, csg_node_id *obstacle)
{
    place_points(w);
    for (csg_node_id i = 0; i < w->scene->node_count; i++) {
        if (!make_value(w, i)) {
            *obstacle = i;
            return CSGM_ERR_UNSUPPORTED;
        }
        if (w->values[i] == CSG_FORMULA_NONE)
            return w->t->too_long ? CSGM_ERR_LIMIT : CSGM_ERR_MEMORY;
    }
    return CSGM_OK;
}

static size_t most_operands(const csgm_scene *scene)
{
    size_t most = 1;
    for (size_t i = 0; i < scene->node_count; i++)
        most = scene->nodes[i].child_count > most ? scene->nodes[i].child_count : most;
    for (size_t i = 0; i < scene->formula_count; i++)
        most = scene->formulas[i].count > most ? scene->formulas[i].count : most;
    return most;
}

csgm_status csg_formulate(const csgm_scene *scene, csg_terms *terms, csg_term *result,
                          csg_node_id *obstacle)
{
    csg_arena scratch;
    csgm_status status = CSGM_ERR_MEMORY;
    work w = {.scene = scene, .t = terms};
    csg_arena_init(&scratch, &scene->context->memory);
    w.points = csg_arena_calloc(&scratch, scene->node_count, sizeof *w.points);
    w.values = csg_arena_calloc(&scratch, scene->node_count, sizeof *w.values);
    w.operands = csg_arena_calloc(&scratch, most_operands(scene), sizeof *w.operands);
    if (w.points && w.values && w.operands)
        status = make_values(&w, obstacle);
    if (status == CSGM_OK)
        *result = w.values[scene->root];
    csg_arena_reset(&scratch);
    return status;
}
