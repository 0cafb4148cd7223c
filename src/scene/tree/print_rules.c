/* SPDX-License-Identifier: MIT
 * Rules and soft nodes as calls of the scene language, every number such that it reads back.
 */
#include <string.h>

#include "scene/formula/formula_print.h"
#include "scene/operators/blend_kinds.h"
#include "scene/operators/rule.h"
#include "scene/operators/soft.h"
#include "scene/tree/print_private.h"

typedef struct output {
    csgm_text_fn *sink;
    void *user;
} output;

static void put_text(const output *out, const char *text)
{
    out->sink(out->user, text, strlen(text));
}

static void put_named(const output *out, const char *separator, const char *name, double value)
{
    put_text(out, separator);
    put_text(out, name);
    put_text(out, " = ");
    csg_print_number(out->sink, out->user, value);
}

/* [[15, 1.1], [40, 0.9]] */
static void put_profile(const output *out, const csg_rule *rule)
{
    const csg_spline *s = &rule->spline;
    uint32_t settled = s->settled ? 1 : 0, count = s->count - 2 * settled;
    put_text(out, ", profile = [");
    for (uint32_t i = 0; i < count; i++) {
        put_text(out, i ? ", [" : "[");
        csg_print_number(out->sink, out->user, settled ? s->degrees[i] : s->angle[i]);
        put_text(out, ", ");
        csg_print_number(out->sink, out->user, s->factor[i + settled]);
        put_text(out, "]");
    }
    put_text(out, "]");
}

static void put_points(const output *out, const csg_rule *rule)
{
    for (uint32_t i = 0; i < rule->point_count; i++) {
        put_text(out, i == 2 ? ", through = [" : i ? ", " : "");
        put_text(out, "[");
        for (int axis = 0; axis < 3; axis++) {
            put_text(out, axis ? ", " : "");
            csg_print_number(out->sink, out->user, rule->points[i][axis]);
        }
        put_text(out, "]");
    }
    put_text(out, rule->point_count > 2 ? "]" : "");
}

static void put_arc(const output *out, const csg_rule *rule)
{
    if (rule->point_count) {
        put_points(out, rule);
        return;
    }
    put_text(out, "angles = [");
    csg_print_number(out->sink, out->user, rule->parameters[0]);
    put_text(out, ", ");
    csg_print_number(out->sink, out->user, rule->parameters[1]);
    put_text(out, "]");
    if (rule->spline.count)
        put_profile(out, rule);
}

void csg_rule_print(const csg_rule *rule, double range,
                    void (*sink)(void *user, const char *text, size_t length), void *user)
{
    const output out = {sink, user};
    const char *separator = "";
    put_text(&out, csg_rule_name(rule->kind));
    put_text(&out, "(");
    if (rule->kind == CSG_BLEND_ARC) {
        put_arc(&out, rule);
        separator = ", ";
    }
    for (uint32_t i = 0; rule->kind != CSG_BLEND_ARC && i < csg_rule_parameter_count(rule->kind);
         i++, separator = ", ")
        put_named(&out, separator, csg_rule_parameter_of(rule->kind, i).name, rule->parameters[i]);
    if (!csg_blend_takes_fields(rule->kind)) {
        put_text(&out, ", step = ");
        put_text(&out, csg_step_name(rule->step.kind));
        put_text(&out, "(");
        csg_print_number(sink, user, rule->step.parameter);
        put_text(&out, ")");
    } else if (range > 0) {
        put_named(&out, separator, "range", range);
    }
    put_text(&out, ")");
}

void csg_put_soft(const csg_printer *out, const csg_node *node)
{
    csg_soft soft = csg_scene_soft(out->scene, node);
    csg_put_argument(out, "soft(", "range", soft.range);
    csg_put(out, ", falloff = \"");
    csg_put(out, csg_falloff_name(soft.falloff));
    csg_put(out, "\")\n");
}
