/* SPDX-License-Identifier: MIT
 * One call a line, operands indented in braces, numbers as short as still read back exactly.
 * Where the language places a primitive otherwise than its node lies (a partial torus begins at
 * +x there and is centred on +x here) the text undoes that.
 */
#include "scene/print.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scene/formula_print.h"

enum { DEEPEST_INDENT = 40, INDENT = 2 };

typedef struct open_node {
    csg_node_id node;
    uint32_t next_child;
} open_node;

typedef struct printer {
    const csgm_scene *scene;
    csgm_text_fn *sink;
    void *user;
    open_node *open; /* the path from the root */
    size_t open_count, open_capacity;
} printer;

static void put(printer *out, const char *text)
{
    out->sink(out->user, text, strlen(text));
}

static void put_number(printer *out, double value)
{
    csg_print_number(out->sink, out->user, value);
}

static void put_float(printer *out, float value)
{
    char text[40];
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        if ((float)strtod(text, NULL) == value)
            break;
    }
    put(out, text);
}

static void put_list(printer *out, const double *values, int count)
{
    put(out, "[");
    for (int i = 0; i < count; i++) {
        put(out, i ? ", " : "");
        put_number(out, values[i]);
    }
    put(out, "]");
}

/* `separator` name = value */
static void put_argument(printer *out, const char *separator, const char *name, double value)
{
    put(out, separator);
    put(out, name);
    put(out, " = ");
    put_number(out, value);
}

static void put_indent(printer *out, size_t depth)
{
    static const char spaces[] = "                                                                "
                                 "                ";
    size_t width = (depth < DEEPEST_INDENT ? depth : DEEPEST_INDENT) * INDENT;
    out->sink(out->user, spaces, width);
}

/* ---- primitives --------------------------------------------------------------------------- */

static void put_box(printer *out, const double *v)
{
    put(out, "cube(size = ");
    put_list(out, (double[]){2 * v[0], 2 * v[1], 2 * v[2]}, 3);
    put(out, ", center = true");
    if (v[3] > 0)
        put_argument(out, ", ", "round", v[3]);
    put(out, ");\n");
}

/* The core's own sizes, since those of the outside would come back with other last bits. */
static void put_frustum(printer *out, const double *v)
{
    put_argument(out, "cylinder(", "h", 2 * v[2]);
    put_argument(out, ", ", "r1", v[0]);
    put_argument(out, ", ", "r2", v[1]);
    put(out, ", center = true");
    if (v[3] > 0) {
        put_argument(out, ", ", "round", v[3]);
        put(out, ", core = true");
    }
    put(out, ");\n");
}

static void put_capsule(printer *out, const double *v)
{
    put(out, "capsule(p1 = [0, 0, 0], p2 = ");
    put_list(out, (double[]){0, 0, v[0]}, 3);
    put_argument(out, ", ", "r1", v[1]);
    put_argument(out, ", ", "r2", v[2]);
    put(out, ");\n");
}

static void put_torus(printer *out, const double *v)
{
    if (v[2] < 180) {
        put(out, "rotate([0, 0, ");
        put_number(out, -v[2]);
        put(out, "]) ");
    }
    put_argument(out, "torus(", "r", v[0]);
    put_argument(out, ", ", "tube", v[1]);
    if (v[2] < 180)
        put_argument(out, ", ", "angle", 2 * v[2]);
    put(out, ");\n");
}

static void put_primitive(printer *out, const csg_node *node)
{
    const double *v = csg_scene_parameters(out->scene, node);
    switch ((csg_node_kind)node->kind) {
    case CSG_NODE_SPHERE:
        put_argument(out, "sphere(", "r", v[0]);
        put(out, ");\n");
        break;
    case CSG_NODE_BOX:
        put_box(out, v);
        break;
    case CSG_NODE_FRUSTUM:
        put_frustum(out, v);
        break;
    case CSG_NODE_CAPSULE:
        put_capsule(out, v);
        break;
    case CSG_NODE_TORUS:
        put_torus(out, v);
        break;
    case CSG_NODE_ELLIPSOID:
        put(out, "ellipsoid(r = ");
        put_list(out, v, 3);
        put(out, ");\n");
        break;
    case CSG_NODE_PLANE:
        put(out, "plane(normal = ");
        put_list(out, v, 3);
        put_argument(out, ", ", "d", v[3]);
        put(out, ");\n");
        break;
    default:
        put(out, "union() {}\n"); /* empty */
    }
}

static bool put_field(printer *out, const csg_node *node)
{
    const csgm_scene *scene = out->scene;
    const csg_formula *formula = &scene->formulas[node->payload];
    csg_box domain = formula->bounds;
    put(out, "field(");
    if (!csg_formula_print(&scene->context->memory, scene->steps + formula->first, formula->count,
                           out->sink, out->user))
        return false;
    if (csg_box_is_finite(domain)) {
        put(out, ", domain = [");
        put_list(out, (double[]){domain.min.x, domain.min.y, domain.min.z}, 3);
        put(out, ", ");
        put_list(out, (double[]){domain.max.x, domain.max.y, domain.max.z}, 3);
        put(out, "]");
    }
    put_argument(out, ", ", "lipschitz", formula->lipschitz);
    put(out, ");\n");
    return true;
}

/* ---- nodes with children ------------------------------------------------------------------- */

static void put_matrix(printer *out, const csg_affine *a)
{
    put(out, "multmatrix([");
    for (int i = 0; i < 3; i++) {
        put_list(out, (double[]){a->m[i][0], a->m[i][1], a->m[i][2], a->t[i]}, 4);
        put(out, ", ");
    }
    put(out, "[0, 0, 0, 1]])\n");
}

static void put_color(printer *out, csg_color color)
{
    const float channels[4] = {color.r, color.g, color.b, color.a};
    put(out, "color(");
    for (int i = 0; i < 4; i++) {
        put(out, i ? ", " : "[");
        put_float(out, channels[i]);
    }
    put(out, "])");
}

/* Control characters as \u escapes, so that a name stays on its line. */
static void put_string(printer *out, const char *text)
{
    put(out, "\"");
    for (; *text; text++) {
        char escape[16] = {*text};
        if (*text == '"' || *text == '\\')
            snprintf(escape, sizeof escape, "\\%c", *text);
        else if ((unsigned char)*text < ' ')
            snprintf(escape, sizeof escape, "\\u%04x", (unsigned char)*text);
        put(out, escape);
    }
    put(out, "\"");
}

static void put_look(printer *out, const csg_look *look)
{
    const char *blank = "";
    if (look->part) {
        put(out, "part(");
        put_string(out, out->scene->part_names[look->part - 1]);
        put(out, ")");
        blank = " ";
    }
    if (look->has_material) {
        put(out, blank);
        put(out, "material(metallic = ");
        put_float(out, look->metallic);
        put(out, ", roughness = ");
        put_float(out, look->roughness);
        put(out, ")");
        blank = " ";
    }
    if (look->has_color) {
        put(out, blank);
        put_color(out, look->color);
    }
    put(out, "\n");
}

static void put_operator(printer *out, const csg_node *node)
{
    csg_blend blend = csg_scene_blend(out->scene, node);
    put(out, csg_node_kind_name(node->kind));
    put(out, "(");
    if (blend.kind == CSG_BLEND_ROUND) { /* round() itself is also a function of numbers */
        put_argument(out, "", "blend", blend.n);
    } else if (blend.kind != CSG_BLEND_SHARP) {
        put(out, "blend = ");
        put(out, csg_blend_name(blend.kind));
        put_argument(out, "(", "n", blend.n);
        put(out, ")");
    }
    put(out, ") {\n");
}

static bool open_children(printer *out, csg_node_id id)
{
    const csgm_scene *scene = out->scene;
    const csg_node *node = &scene->nodes[id];
    void *open = out->open;
    put_indent(out, out->open_count);
    if (node->kind == CSG_NODE_TRANSFORM)
        put_matrix(out, &scene->transforms[node->payload]);
    else if (node->kind == CSG_NODE_COLOR)
        put_look(out, &scene->looks[node->payload]);
    else if (csg_node_is_operator(node->kind))
        put_operator(out, node);
    else if (node->kind != CSG_NODE_FIELD)
        put_primitive(out, node);
    else if (!put_field(out, node))
        return false;
    if (!node->child_count)
        return true;
    if (!csg_memory_reserve(&scene->context->memory, &open, &out->open_capacity,
                            out->open_count + 1, sizeof *out->open))
        return false;
    out->open = open;
    out->open[out->open_count++] = (open_node){id, 0};
    return true;
}

static csgm_status print_all(printer *out)
{
    if (!open_children(out, out->scene->root))
        return CSGM_ERR_MEMORY;
    while (out->open_count) {
        open_node *top = &out->open[out->open_count - 1];
        const csg_node *node = &out->scene->nodes[top->node];
        if (top->next_child < node->child_count) {
            csg_node_id child = csg_scene_children(out->scene, node)[top->next_child++];
            if (!open_children(out, child))
                return CSGM_ERR_MEMORY;
            continue;
        }
        out->open_count--;
        if (csg_node_is_operator(node->kind)) {
            put_indent(out, out->open_count);
            put(out, "}\n");
        }
    }
    return CSGM_OK;
}

csgm_status csg_scene_print(const csgm_scene *scene, csgm_text_fn *sink, void *user)
{
    printer out = {.scene = scene, .sink = sink, .user = user};
    csgm_status status = print_all(&out);
    csg_memory_release(&scene->context->memory, out.open, out.open_capacity * sizeof *out.open);
    return status;
}
