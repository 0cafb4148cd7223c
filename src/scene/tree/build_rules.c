/* SPDX-License-Identifier: MIT
 * Building soft objects and operators by rules: ranges of influence that follow from the operands,
 * and arcs whose angles are given by points.
 */
#include "base/elementary.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"
#include "scene/operators/soft.h"
#include "scene/primitives/curve.h"
#include "scene/reference.h"
#include "scene/tree/build_private.h"
#include "scene/tree/check.h"

#include <string.h>

#define DEGREE 0.017453292519943295

enum { SEARCHED = 256 /* of the latest rules, for an equal one */ };

bool csg_rule_is_same(const csg_rule *a, const csg_rule *b)
{
    bool same = a->kind == b->kind && a->step.kind == b->step.kind &&
                a->step.parameter == b->step.parameter && a->spline.count == b->spline.count &&
                a->point_count == b->point_count && a->profile == b->profile;
    for (uint32_t i = 0; same && i < csg_rule_parameter_count(a->kind); i++)
        same = a->parameters[i] == b->parameters[i];
    size_t knots = a->spline.count * sizeof *a->spline.angle;
    return same && memcmp(a->spline.angle, b->spline.angle, knots) == 0 &&
           memcmp(a->spline.factor, b->spline.factor, knots) == 0 &&
           memcmp(a->points, b->points, a->point_count * sizeof *a->points) == 0;
}

csg_blend csg_build_rule(csg_scene_builder *builder, const csg_rule *given)
{
    const csg_blend none = CSG_SHARP;
    csgm_scene *scene = builder->scene;
    char text[160];
    if (builder->status != CSGM_OK)
        return none;
    const char *problem = csg_rule_problem(given, text, sizeof text);
    if (problem) {
        csg_check_fail(builder, CSGM_ERR_SCENE, "%s", problem);
        return none;
    }
    csg_rule rule = *given;
    if (!rule.point_count)
        csg_rule_settle(&rule);
    size_t oldest = scene->rule_count > SEARCHED ? scene->rule_count - SEARCHED : 0;
    for (size_t i = scene->rule_count; i-- > oldest;)
        if (scene->rules[i].range == rule.range && csg_rule_is_same(&scene->rules[i], &rule))
            return (csg_blend){rule.kind, (double)i, false};
    void *rules = scene->rules;
    if (!csg_memory_reserve(&builder->context->memory, &rules, &builder->rule_capacity,
                            scene->rule_count + 1, sizeof *scene->rules)) {
        csg_build_no_memory(builder);
        return none;
    }
    scene->rules = rules;
    scene->rules[scene->rule_count] = rule;
    return (csg_blend){rule.kind, (double)scene->rule_count++, false};
}

/* ---- the range of distances -------------------------------------------------------------------
 */

/* Half the longest finite side; 0 where there is none, 1 for nothing at all. */
static double radius_of(csg_scene_builder *builder, csg_node_id node)
{
    csg_box box = csg_build_box(builder, node);
    if (csg_box_is_empty(box))
        return 1;
    const double sides[3] = {box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z};
    double most = 0;
    for (int i = 0; i < 3; i++)
        if (isfinite(sides[i]))
            most = fmax(most, sides[i] / 2);
    return most;
}

static bool find_range(csg_scene_builder *builder, const csg_rule *rule,
                       const csg_node_id *operands, size_t count, double *range)
{
    bool needed = false;
    double largest = 0;
    for (size_t i = 0; i < count; i++)
        needed |= !(builder->scene->nodes[operands[i]].flags & CSG_FLAG_SOFT);
    *range = needed ? rule->range : 1;
    if (*range > 0)
        return true;
    for (size_t i = 0; i < count; i++)
        largest = fmax(largest, radius_of(builder, operands[i]));
    *range = largest / 4;
    if (!(*range > 0))
        csg_check_fail(builder, CSGM_ERR_SCENE,
                       "the operands have no size to take a range of influence from; give range =");
    return builder->status == CSGM_OK;
}

/* ---- arcs through points ----------------------------------------------------------------------
 */

/* The operands as scenes of their own, each below an operator that makes a field of it. */
typedef struct probe {
    csgm_scene *scenes[2];
    bool complement;
} probe;

static void probe_end(probe *p)
{
    for (int i = 0; i < 2; i++)
        csg_scene_destroy(p->scenes[i]);
}

static bool probe_begin(csg_scene_builder *builder, csg_node_kind kind, const csg_node_id *operands,
                        double range, probe *p)
{
    csg_rule sharp = csg_rule_standard(CSG_BLEND_FIELD_SHARP);
    csg_blend alone = csg_build_rule(builder, &sharp);
    *p = (probe){.complement = kind == CSG_NODE_DIFFERENCE};
    for (int i = 0; i < 2 && builder->status == CSGM_OK; i++) {
        csg_node_id node = csg_build_append_operator(builder, CSG_NODE_UNION, alone, range,
                                                     &operands[i], 1, (csg_span){0});
        csgm_status status = node == CSG_NODE_NONE
                                 ? builder->status
                                 : csg_build_snapshot(builder, node, &p->scenes[i]);
        if (status != CSGM_OK)
            csg_check_fail(builder, status, "%s", "");
    }
    return builder->status == CSGM_OK;
}

static bool fields_at(csg_scene_builder *builder, const probe *p, const double *point,
                      double fields[2])
{
    csgm_status status = CSGM_OK;
    for (int i = 0; i < 2; i++) {
        csg_vec3 at = csg_vec3_make(point[0], point[1], point[2]);
        const csgm_scene *scene = p->scenes[i];
        double f = csg_reference_eval(scene, at, &status).value;
        fields[i] = 0.5 + csg_scene_softness(scene, scene->root) * f;
    }
    fields[1] = p->complement ? 1 - fields[1] : fields[1];
    if (status != CSGM_OK)
        csg_check_fail(builder, status, "%s", "");
    else if (!(fields[0] > 0 || fields[1] > 0))
        csg_check_fail(builder, CSGM_ERR_SCENE,
                       "the point [%g, %g, %g] lies where neither operand's field reaches",
                       point[0], point[1], point[2]);
    return builder->status == CSGM_OK;
}

static bool find_ends(csg_scene_builder *builder, const probe *p, csg_rule *rule)
{
    double fields[2], angles[2];
    for (int i = 0; i < 2; i++) {
        if (!fields_at(builder, p, rule->points[i], fields))
            return false;
        angles[i] = csg_atan2(fields[1], fields[0]) / DEGREE;
    }
    rule->parameters[0] = fmin(angles[0], angles[1]);
    rule->parameters[1] = fmax(angles[0], angles[1]);
    if (rule->parameters[0] > 45 || rule->parameters[1] < 45)
        csg_check_fail(builder, CSGM_ERR_SCENE,
                       "one of the two points must lie nearer to the first operand's side: their "
                       "angles are %g and %g, one must be 0 to 45, one 45 to 90",
                       angles[0], angles[1]);
    return builder->status == CSGM_OK;
}

static void sort_profile(csg_spline *s)
{
    for (uint32_t i = 1; i < s->count; i++)
        for (uint32_t k = i; k > 0 && s->angle[k - 1] > s->angle[k]; k--) {
            double angle = s->angle[k], factor = s->factor[k];
            s->angle[k] = s->angle[k - 1];
            s->factor[k] = s->factor[k - 1];
            s->angle[k - 1] = angle;
            s->factor[k - 1] = factor;
        }
}

/* The factor that makes the surface pass through each further point. */
static bool find_profile(csg_scene_builder *builder, const probe *p, bool is_union, csg_rule *rule)
{
    csg_rule plain = *rule;
    double fields[2], partials[2];
    plain.spline.count = 0;
    for (uint32_t i = 2; i < rule->point_count; i++) {
        if (!fields_at(builder, p, rule->points[i], fields))
            return false;
        double value = csg_rule_apply(&plain, is_union, fields, 2, 0, partials);
        rule->spline.angle[i - 2] = csg_atan2(fields[1], fields[0]) / DEGREE;
        rule->spline.factor[i - 2] = value > 0 ? 0.5 / value : INFINITY;
    }
    rule->spline.count = rule->point_count - 2;
    sort_profile(&rule->spline);
    return true;
}

static bool resolve_points(csg_scene_builder *builder, csg_node_kind kind, csg_blend *blend,
                           const csg_node_id *operands, size_t count, double range)
{
    csg_rule rule = builder->scene->rules[(size_t)blend->n];
    probe p = {0};
    if (count != 2) {
        csg_check_fail(builder, CSGM_ERR_SCENE,
                       "an arc through points joins two solids, not %zu; give angles =", count);
        return false;
    }
    bool done = probe_begin(builder, kind, operands, range, &p) && find_ends(builder, &p, &rule) &&
                find_profile(builder, &p, kind == CSG_NODE_UNION, &rule);
    probe_end(&p);
    if (!done)
        return false;
    rule.point_count = 0;
    *blend = csg_build_rule(builder, &rule);
    return builder->status == CSGM_OK;
}

bool csg_build_settle_rule(csg_scene_builder *builder, csg_node_kind kind, csg_blend *blend,
                           const csg_node_id *operands, size_t count, double *range)
{
    const csg_rule *rule = &builder->scene->rules[(size_t)blend->n];
    *range = 0;
    if (!csg_blend_takes_fields(rule->kind))
        return true;
    if (!find_range(builder, rule, operands, count, range))
        return false;
    if (rule->point_count && !resolve_points(builder, kind, blend, operands, count, *range))
        return false;
    const double *v = builder->scene->rules[(size_t)blend->n].parameters;
    if (blend->kind == CSG_BLEND_ARC && kind != CSG_NODE_UNION && !(v[0] >= 1 && v[1] <= 89))
        csg_check_fail(builder, CSGM_ERR_SCENE,
                       "the angles of an intersection's arc must be 1 to 89 degrees, not %g and %g",
                       v[0], v[1]);
    return builder->status == CSGM_OK;
}

/* ---- soft objects -----------------------------------------------------------------------------
 */

/* Below transforms and colours; *scale: how much longer its lengths are outside. */
static const csg_node *undressed(const csgm_scene *scene, csg_node_id id, double *scale)
{
    const csg_node *node = &scene->nodes[id];
    double largest;
    for (*scale = 1; node->kind == CSG_NODE_TRANSFORM || node->kind == CSG_NODE_COLOR;
         node = &scene->nodes[csg_scene_children(scene, node)[0]]) {
        double smallest = 1;
        if (node->kind == CSG_NODE_TRANSFORM)
            csg_affine_singular_values(&scene->transforms[node->payload], &smallest, &largest);
        *scale *= smallest;
    }
    return node;
}

/* What is grown is next to nothing thick: a polygon, at which f is the radius. */
static double height_of_sheet(const csgm_scene *scene, const csg_node *node)
{
    double scale, r = scene->parameters[node->payload];
    const csg_node *grown = undressed(scene, csg_scene_children(scene, node)[0], &scale);
    if (!csg_node_is_plate(grown))
        return 0;
    const csg_node *slab = undressed(scene, csg_scene_children(scene, grown)[1], &scale);
    double half = scale * scene->parameters[slab->payload];
    return half <= 2 * CSG_SHEET_HALF * r ? r + half : 0;
}

/* f at the skeleton; 0 where there is none with one radius. */
static double height_of(const csgm_scene *scene, csg_node_id id)
{
    double scale;
    const csg_node *node = undressed(scene, id, &scale);
    if (node->kind == CSG_NODE_OFFSET)
        return scale * height_of_sheet(scene, node);
    if (!csg_node_is_named_primitive(node->kind))
        return 0;
    return scale * csg_primitive_of(node->kind)->depth(csg_scene_parameters(scene, node));
}

/* Tubes are sharp unions of such leaves. */
static double height_of_tube(const csgm_scene *scene, csg_node_id id)
{
    double scale, height = height_of(scene, id);
    const csg_node *node = undressed(scene, id, &scale);
    if (node->kind != CSG_NODE_UNION || !csg_blend_is_sharp(node->blend))
        return height;
    for (uint32_t k = 0; k < node->child_count; k++) {
        double one = scale * height_of(scene, csg_scene_children(scene, node)[k]);
        if (k > 0 && !(fabs(one - height) <= 1e-9 * height))
            return 0;
        height = one;
    }
    return height;
}

csg_node_id csg_build_soft(csg_scene_builder *builder, csg_soft soft, csg_node_id child,
                           csg_span where)
{
    csgm_scene *scene = builder->scene;
    if (!csg_build_is_usable(builder, child))
        return CSG_NODE_NONE;
    if (scene->nodes[child].kind == CSG_NODE_EMPTY)
        return child;
    double iso = csg_falloff_iso(soft.falloff);
    if (soft.range == 0)
        soft.range = height_of_tube(scene, child) * (1 - iso) / iso;
    if (soft.range == 0)
        csg_check_fail(
            builder, CSGM_ERR_SCENE,
            "only balls, tubes, tori and sheets of one radius have a range of their own; give "
            "range =");
    else if (!(soft.range >= CSG_SMALLEST_LENGTH && soft.range <= 1e15))
        csg_check_fail(builder, CSGM_ERR_SCENE, "the range must be above 0, not %g", soft.range);
    if (builder->status != CSGM_OK || !csg_build_reserve_node(builder) ||
        !csg_build_reserve_children(builder, 1) ||
        !csg_build_reserve_parameters(builder, CSG_SOFT_PARAMETERS))
        return CSG_NODE_NONE;
    csg_node node = {
        .kind = CSG_NODE_SOFT, .payload = (uint32_t)scene->parameter_count, .where = where};
    double *parameters = scene->parameters + scene->parameter_count;
    parameters[CSG_SOFT_RANGE] = soft.range;
    parameters[CSG_SOFT_FALLOFF] = (double)soft.falloff;
    parameters[CSG_SOFT_LAMBDA] = 0;
    scene->parameter_count += CSG_SOFT_PARAMETERS;
    return csg_build_append(builder, node, &child, 1);
}
