/* SPDX-License-Identifier: MIT
 * One call per line, operands indented in braces, numbers as short as still read back exactly.
 */
#include "scene/tree/print.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/operators/rule.h"
#include "scene/tree/print_private.h"
#include "scene/warp_kinds.h"

enum { DEEPEST_INDENT = 40, INDENT = 2 };

typedef struct open_node {
    csg_node_id node;
    uint32_t next_child, child_count; /* printed children */
} open_node;

typedef struct walk {
    csg_printer out;
    open_node *open; /* the path from the root */
    size_t open_count, open_capacity;
} walk;

void csg_put(const csg_printer *out, const char *text)
{
    out->sink(out->user, text, strlen(text));
}

void csg_put_number(const csg_printer *out, double value)
{
    csg_print_number(out->sink, out->user, value);
}

static void put_float(const csg_printer *out, float value)
{
    char text[40];
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        if ((float)strtod(text, NULL) == value)
            break;
    }
    csg_put(out, text);
}

void csg_put_list(const csg_printer *out, const double *values, int count)
{
    csg_put(out, "[");
    for (int i = 0; i < count; i++) {
        csg_put(out, i ? ", " : "");
        csg_put_number(out, values[i]);
    }
    csg_put(out, "]");
}

void csg_put_argument(const csg_printer *out, const char *separator, const char *name, double value)
{
    csg_put(out, separator);
    csg_put(out, name);
    csg_put(out, " = ");
    csg_put_number(out, value);
}

void csg_put_indent(const csg_printer *out, size_t depth)
{
    static const char spaces[] = "                                                                "
                                 "                ";
    size_t width = (depth < DEEPEST_INDENT ? depth : DEEPEST_INDENT) * INDENT;
    out->sink(out->user, spaces, width);
}

/* ---- nodes with children ------------------------------------------------------------------- */

void csg_put_matrix(const csg_printer *out, const csg_affine *a)
{
    csg_put(out, "multmatrix([");
    for (int i = 0; i < 3; i++) {
        csg_put_list(out, (double[]){a->m[i][0], a->m[i][1], a->m[i][2], a->t[i]}, 4);
        csg_put(out, ", ");
    }
    csg_put(out, "[0, 0, 0, 1]])");
}

static void put_color(const csg_printer *out, csg_color color)
{
    const float channels[4] = {color.r, color.g, color.b, color.a};
    csg_put(out, "color(");
    for (int i = 0; i < 4; i++) {
        csg_put(out, i ? ", " : "[");
        put_float(out, channels[i]);
    }
    csg_put(out, "])");
}

/* Control characters as \u escapes, so that a name stays on its line. */
static void put_string(const csg_printer *out, const char *text)
{
    csg_put(out, "\"");
    for (; *text; text++) {
        char escape[16] = {*text};
        if (*text == '"' || *text == '\\')
            snprintf(escape, sizeof escape, "\\%c", *text);
        else if ((unsigned char)*text < ' ')
            snprintf(escape, sizeof escape, "\\u%04x", (unsigned char)*text);
        csg_put(out, escape);
    }
    csg_put(out, "\"");
}

static void put_look(const csg_printer *out, const csg_look *look)
{
    const char *blank = "";
    if (look->part) {
        csg_put(out, "part(");
        put_string(out, out->scene->part_names[look->part - 1]);
        csg_put(out, ")");
        blank = " ";
    }
    if (look->has_material) {
        csg_put(out, blank);
        csg_put(out, "material(metallic = ");
        put_float(out, look->metallic);
        csg_put(out, ", roughness = ");
        put_float(out, look->roughness);
        csg_put(out, ")");
        blank = " ";
    }
    if (look->has_color) {
        csg_put(out, blank);
        put_color(out, look->color);
    }
    csg_put(out, "\n");
}

static bool is_flat(const csgm_scene *scene, csg_node_id node)
{
    return scene->nodes[node].flags & CSG_FLAG_FLAT;
}

/* Figures among solids, which the language otherwise does not let stand side by side. */
static bool is_mixed(const csgm_scene *scene, const csg_node *node)
{
    const csg_node_id *children = csg_scene_children(scene, node);
    for (uint32_t i = 1; i < node->child_count; i++)
        if (is_flat(scene, children[i]) != is_flat(scene, children[0]))
            return true;
    return false;
}

static void put_operator(const csg_printer *out, const csg_node *node)
{
    csg_blend blend = csg_scene_blend(out->scene, node);
    const char *separator = "";
    csg_put(out, csg_node_kind_name(node->kind));
    csg_put(out, "(");
    const csg_rule *rule = csg_scene_rule(out->scene, node);
    if (rule && rule->kind != csg_rule_of_fields().kind) {
        bool fields = csg_blend_takes_fields(rule->kind);
        csg_put(out, "blend = ");
        csg_rule_print(rule,
                       fields ? csg_scene_parameters(out->scene, node)[CSG_OPERATOR_RANGE] : 0,
                       out->sink, out->user);
        separator = ", ";
    } else if (csg_node_is_idle(node) ||
               (csg_blend_is_round(blend.kind) && node->flags & CSG_FLAG_NUMBER)) {
        csg_put_argument(out, "", "blend", blend.n);
        separator = ", ";
    } else if (!rule && !csg_blend_is_sharp(blend.kind)) {
        bool is_radius = csg_blend_is_fillet(blend.kind) || csg_blend_is_round(blend.kind);
        csg_put(out, "blend = ");
        csg_put(out, csg_blend_name(blend.kind));
        csg_put_argument(out, "(", is_radius ? "r" : "n", blend.n);
        csg_put(out, ")");
        separator = ", ";
    }
    if (is_mixed(out->scene, node)) {
        csg_put(out, separator);
        csg_put(out, "mixed = true");
    }
    csg_put(out, ") {\n");
}

/* An orthogonal intersection is a flat child and a slab, moved or not: csg_build_plate. */
static void put_plate(const csg_printer *out, const csg_node *node)
{
    const csgm_scene *scene = out->scene;
    const csg_node *slab = &scene->nodes[csg_scene_children(scene, node)[1]];
    double middle = 0;
    if (slab->kind == CSG_NODE_TRANSFORM) {
        middle = scene->transforms[slab->payload].t[2];
        slab = &scene->nodes[csg_scene_children(scene, slab)[0]];
    }
    csg_put_argument(out, "extrude(", "half", csg_scene_parameters(scene, slab)[0]);
    csg_put_argument(out, ", ", "middle", middle);
    csg_put(out, ")\n");
}

static void put_warp(const csg_printer *out, const csg_warp *warp)
{
    csg_put(out, "warp(\"");
    csg_put(out, csg_warp_name(warp->kind));
    csg_put(out, "\", ");
    csg_put_list(out, warp->parameters, (int)csg_warp_given(warp->kind));
    csg_put(out, ")\n");
}

static bool put_profiled(const csg_printer *out, const csg_node *node)
{
    static const csg_formula_words words = {"x", {"x", "", ""}, NULL};
    const csgm_scene *scene = out->scene;
    const csg_formula *profile = &scene->formulas[node->payload + 1];
    csg_put(out, csg_node_kind_name((csg_node_kind)scene->formulas[node->payload].joins));
    csg_put(out, "(blend = profile(");
    bool done = csg_formula_print(&scene->context->memory, scene->steps + profile->first,
                                  profile->count, &words, out->sink, out->user);
    csg_put(out, is_mixed(scene, node) ? "), mixed = true) {\n" : ")) {\n");
    return done;
}

static bool put_combine(const csg_printer *out, const csg_node *node)
{
    static const char *const parameters[] = {"", "a", "a, b", "a, b, c"};
    const csgm_scene *scene = out->scene;
    const csg_formula *formula = &scene->formulas[node->payload];
    bool listed = node->child_count > 3;
    const csg_formula_words words = {
        listed ? "f" : parameters[node->child_count], {"a", "b", "c"}, listed ? "f" : NULL};
    csg_put(out, "combine(");
    bool done = csg_formula_print(&scene->context->memory, scene->steps + formula->first,
                                  formula->count, &words, out->sink, out->user);
    csg_put_argument(out, ", ", "lipschitz", formula->lipschitz);
    csg_put(out, ") {\n");
    return done;
}

static bool has_braces(const csg_node *node)
{
    return node->kind == CSG_NODE_COMBINE ||
           (csg_node_is_operator(node->kind) && !csg_node_is_plate(node));
}

/* The line that a node begins with. */
static bool put_node(const csg_printer *out, const csg_node *node)
{
    const csgm_scene *scene = out->scene;
    switch ((csg_node_kind)node->kind) {
    case CSG_NODE_TRANSFORM:
        csg_put_matrix(out, &scene->transforms[node->payload]);
        csg_put(out, "\n");
        return true;
    case CSG_NODE_COLOR:
        put_look(out, &scene->looks[node->payload]);
        return true;
    case CSG_NODE_OFFSET:
        csg_put_argument(out, "offset3d(", "r", scene->parameters[node->payload]);
        csg_put(out, ")\n");
        return true;
    case CSG_NODE_WARP:
        put_warp(out, &scene->warps[node->payload]);
        return true;
    case CSG_NODE_SOFT:
        csg_put_soft(out, node);
        return true;
    case CSG_NODE_COMBINE:
        return csg_blend_is_profile(node->blend) ? put_profiled(out, node) : put_combine(out, node);
    case CSG_NODE_UNION:
    case CSG_NODE_INTERSECTION:
    case CSG_NODE_DIFFERENCE:
        if (csg_node_is_plate(node))
            put_plate(out, node);
        else
            put_operator(out, node);
        return true;
    case CSG_NODE_EMPTY:
    case CSG_NODE_FIELD:
    case CSG_NODE_SHAPE:
    case CSG_NODE_FIRST_PRIMITIVE:
        break;
    }
    return csg_put_leaf(out, node);
}

static bool open_children(walk *w, csg_node_id id)
{
    const csgm_scene *scene = w->out.scene;
    const csg_node *node = &scene->nodes[id];
    void *open = w->open;
    if (node->flags & CSG_FLAG_ENDED) /* the number of the union says so */
        return open_children(w, csg_scene_children(scene, node)[0]);
    csg_put_indent(&w->out, w->open_count);
    if (!put_node(&w->out, node))
        return false;
    if (!node->child_count)
        return true;
    if (!csg_memory_reserve(&scene->context->memory, &open, &w->open_capacity, w->open_count + 1,
                            sizeof *w->open))
        return false;
    w->open = open;
    w->open[w->open_count++] = (open_node){id, 0, csg_node_is_plate(node) ? 1 : node->child_count};
    return true;
}

static csgm_status print_all(walk *w)
{
    const csgm_scene *scene = w->out.scene;
    if (!open_children(w, scene->root))
        return CSGM_ERR_MEMORY;
    while (w->open_count) {
        open_node *top = &w->open[w->open_count - 1];
        const csg_node *node = &scene->nodes[top->node];
        if (top->next_child < top->child_count) {
            csg_node_id child = csg_scene_children(scene, node)[top->next_child++];
            if (!open_children(w, child))
                return CSGM_ERR_MEMORY;
            continue;
        }
        w->open_count--;
        if (has_braces(node)) {
            csg_put_indent(&w->out, w->open_count);
            csg_put(&w->out, "}\n");
        }
    }
    return CSGM_OK;
}

csgm_status csg_scene_print(const csgm_scene *scene, csgm_text_fn *sink, void *user)
{
    walk w = {.out = {scene, sink, user}};
    csgm_status status = print_all(&w);
    csg_memory_release(&scene->context->memory, w.open, w.open_capacity * sizeof *w.open);
    return status;
}

bool csg_scene_print_node(const csgm_scene *scene, csg_node_id node, csgm_text_fn *sink, void *user)
{
    const csg_printer out = {scene, sink, user};
    return put_node(&out, &scene->nodes[node]);
}
