/* SPDX-License-Identifier: MIT
 * Rules and soft nodes as calls of the scene language, every number such that it reads back.
 */
#include <string.h>

#include "scene/formula/formula_print.h"
#include "scene/operators/rule.h"
#include "scene/operators/soft.h"
#include "scene/tree/print_private.h"

typedef struct output {
    csgm_text_fn *sink;
    void *user;
} output;

static void put(const output *out, const char *text)
{
    out->sink(out->user, text, strlen(text));
}

static void put_named(const output *out, const char *separator, const char *name, double value)
{
    put(out, separator);
    put(out, name);
    put(out, " = ");
    csg_print_number(out->sink, out->user, value);
}

/* [[15, 1.1], [40, 0.9]] */
static void put_profile(const output *out, const csg_rule *rule)
{
    const csg_spline *s = &rule->spline;
    uint32_t settled = s->settled ? 1 : 0, count = s->count - 2 * settled;
    put(out, ", profile = [");
    for (uint32_t i = 0; i < count; i++) {
        put(out, i ? ", [" : "[");
        csg_print_number(out->sink, out->user, settled ? s->degrees[i] : s->angle[i]);
        put(out, ", ");
        csg_print_number(out->sink, out->user, s->factor[i + settled]);
        put(out, "]");
    }
    put(out, "]");
}

static void put_points(const output *out, const csg_rule *rule)
{
    for (uint32_t i = 0; i < rule->point_count; i++) {
        put(out, i == 2 ? ", through = [" : i ? ", " : "");
        put(out, "[");
        for (int axis = 0; axis < 3; axis++) {
            put(out, axis ? ", " : "");
            csg_print_number(out->sink, out->user, rule->points[i][axis]);
        }
        put(out, "]");
    }
    put(out, rule->point_count > 2 ? "]" : "");
}

static void put_arc(const output *out, const csg_rule *rule)
{
    if (rule->point_count) {
        put_points(out, rule);
        return;
    }
    put(out, "angles = [");
    csg_print_number(out->sink, out->user, rule->parameters[0]);
    put(out, ", ");
    csg_print_number(out->sink, out->user, rule->parameters[1]);
    put(out, "]");
    if (rule->spline.count)
        put_profile(out, rule);
}

void csg_rule_print(const csg_rule *rule, double range,
                    void (*sink)(void *user, const char *text, size_t length), void *user)
{
    const output out = {sink, user};
    const char *separator = "";
    put(&out, csg_rule_name(rule->kind));
    put(&out, "(");
    if (rule->kind == CSG_BLEND_ARC) {
        put_arc(&out, rule);
        separator = ", ";
    }
    for (uint32_t i = 0; rule->kind != CSG_BLEND_ARC && i < csg_rule_parameter_count(rule->kind);
         i++, separator = ", ")
        put_named(&out, separator, csg_rule_parameter_of(rule->kind, i).name, rule->parameters[i]);
    if (!csg_blend_takes_fields(rule->kind)) {
        put(&out, ", step = ");
        put(&out, csg_step_name(rule->step.kind));
        put(&out, "(");
        csg_print_number(sink, user, rule->step.parameter);
        put(&out, ")");
    } else if (range > 0) {
        put_named(&out, separator, "range", range);
    }
    put(&out, ")");
}

void csg_put_soft(const csg_printer *out, const csg_node *node)
{
    csg_soft soft = csg_scene_soft(out->scene, node);
    csg_put_argument(out, "soft(", "range", soft.range);
    csg_put(out, ", falloff = \"");
    csg_put(out, csg_falloff_name(soft.falloff));
    csg_put(out, "\")\n");
}
