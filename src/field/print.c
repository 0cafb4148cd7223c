/* SPDX-License-Identifier: MIT
 * The tape as text, one node per line, in evaluation order.
 */
#include <stdarg.h>
#include <stdio.h>

#include "field/compile/compile_rule.h"
#include "field/field.h"
#include "field/rule_layout.h"
#include "scene/warp_kinds.h"

static const char *const op_names[CSG_OP_FIRST_PRIMITIVE] = {
    [CSG_OP_FIELD] = "field",
    [CSG_OP_SHAPE] = "shape",
    [CSG_OP_UNION] = "union",
    [CSG_OP_INTERSECTION] = "intersection",
    [CSG_OP_ROUND_UNION] = "round_union",
    [CSG_OP_ROUND_INTERSECTION] = "round_intersection",
    [CSG_OP_FILLET_UNION] = "fillet_union",
    [CSG_OP_FILLET_INTERSECTION] = "fillet_intersection",
    [CSG_OP_COMBINE] = "combine",
    [CSG_OP_SOFTEN] = "soften",
    [CSG_OP_RULE_UNION] = "rule_union",
    [CSG_OP_RULE_INTERSECTION] = "rule_intersection",
    [CSG_OP_EMPTY] = "empty",
};

static const char *op_name(uint8_t op)
{
    return csg_op_is_primitive(op) ? csg_node_kind_name(csg_op_node_kind(op)) : op_names[op];
}

static const char *const curve_names[] = {
#define CSG_FALLOFF(NAME, name, iso, steepest, steepest_at, doc) [CSG_CURVE_##NAME] = #name,
#include "scene/operators/falloffs.def"
#undef CSG_FALLOFF
    [CSG_CURVE_STEP] = "step",
    [CSG_CURVE_CLAMP] = "clamp",
};

typedef struct printer {
    csgm_text_fn *sink;
    void *user;
} printer;

__attribute__((format(printf, 2, 3))) static void print(printer *out, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (length > 0)
        out->sink(out->user, text, (size_t)length < sizeof text ? (size_t)length : sizeof text - 1);
}

static void print_leaf(printer *out, const csg_tape *tape, const csg_tape_node *node)
{
    const float *p = tape->parameters + node->parameters;
    print(out, " sigma %.9g", (double)p[CSG_LEAF_SIGMA]);
    if (node->op == CSG_OP_EMPTY)
        return;
    int frame = node->frame == CSG_FRAME_OFFSET ? 3 : 12;
    print(out, node->frame == CSG_FRAME_OFFSET ? " offset" : " affine");
    for (int i = 0; i < frame; i++)
        print(out, " %.9g", (double)p[CSG_LEAF_FRAME + i]);
    print(out, " color %.0f", (double)p[CSG_LEAF_COLOR]);
    if (p[CSG_LEAF_RAISE] != 0)
        print(out, " raise %.9g", (double)p[CSG_LEAF_RAISE]);
    for (uint32_t w = node->warp; w; w = tape->warps[w - 1].outer)
        print(out, " in %s", csg_warp_name((csg_warp_kind)tape->warps[w - 1].kind));
}

static const char *blend_name(uint8_t blend)
{
    return csg_blend_turns(blend) ? "turning scale_set" : csg_blend_name(blend);
}

static void print_operator(printer *out, const csg_tape *tape, const csg_tape_node *node)
{
    const float *p = tape->parameters + node->parameters;
    print(out, " of %u", node->arity);
    if (node->op == CSG_OP_COMBINE)
        return;
    const float *delivery = node->op == CSG_OP_SOFTEN ? p : p + CSG_RULE_DELIVER;
    if (node->op == CSG_OP_SOFTEN)
        print(out, ", %s rate %.9g", curve_names[node->blend], (double)p[CSG_SOFTEN_RATE]);
    else
        print(out, ", blend %s n %.9g support %.9g", blend_name(node->blend),
              (double)p[CSG_OPERATOR_N], (double)p[CSG_OPERATOR_SUPPORT]);
    if (csg_op_delivers(node->op))
        print(out, ", gives %.9g (F - %.9g) + %.9g%s", (double)delivery[CSG_DELIVER_SCALE],
              (double)delivery[CSG_DELIVER_LEVEL], (double)delivery[CSG_DELIVER_SHIFT],
              delivery[CSG_DELIVER_LOW] == 0 ? " in 0..1" : "");
}

csgm_status csg_field_print_tape(const csgm_field *field, csgm_text_fn *sink, void *user)
{
    printer out = {sink, user};
    print(&out, "tape %u nodes, %u slots, center %.17g %.17g %.17g\n", field->tape.count,
          field->depth, field->center.x, field->center.y, field->center.z);
    for (uint32_t i = 0; i < field->tape.count; i++) {
        const csg_tape_node *node = &field->tape.nodes[i];
        print(&out, "%u %s", i, op_name(node->op));
        if (csg_op_is_leaf(node->op))
            print_leaf(&out, &field->tape, node);
        else
            print_operator(&out, &field->tape, node);
        if (node->join)
            print(&out, ", joins by %s %s", node->join == CSG_JOIN_UNION ? "union" : "intersection",
                  blend_name(node->join_blend));
        print(&out, "\n");
    }
    return CSGM_OK;
}
