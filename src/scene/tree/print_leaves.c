/* SPDX-License-Identifier: MIT
 * Leaves as calls of the scene language.
 */
#include "scene/tree/print_private.h"

#include <stdio.h>

#include "scene/primitives/primitive.h"
#include "shape/plane/region.h"
#include "shape/polyhedra/polyhedron.h"

/* ---- primitives --------------------------------------------------------------------------- */

static void put_primitive(const csg_printer *out, const csg_node *node)
{
    const double *v = csg_scene_parameters(out->scene, node);
    const csg_primitive *row = csg_primitive_of(node->kind);
    double last = v[row->parameter_count - 1];
    const char *text = row->call_otherwise && last != row->usual ? row->call_otherwise : row->call;
    for (; *text; text++) {
        if (*text != '$') {
            out->sink(out->user, text, 1);
            continue;
        }
        text++;
        bool twice = *text < 'a';
        csg_put_number(out, twice ? 2 * v[*text - 'A'] : v[*text - 'a']);
    }
    csg_put(out, ";\n");
}

/* ---- fields ------------------------------------------------------------------------------- */

static bool put_field(const csg_printer *out, const csg_node *node)
{
    static const csg_formula_words words = {"p", {"p.x", "p.y", "p.z"}, NULL};
    const csgm_scene *scene = out->scene;
    const csg_formula *formula = &scene->formulas[node->payload];
    csg_box domain = formula->bounds;
    csg_put(out, "field(");
    if (!csg_formula_print(&scene->context->memory, scene->steps + formula->first, formula->count,
                           &words, out->sink, out->user))
        return false;
    if (csg_box_is_finite(domain)) {
        csg_put(out, ", domain = [");
        csg_put_list(out, (double[]){domain.min.x, domain.min.y, domain.min.z}, 3);
        csg_put(out, ", ");
        csg_put_list(out, (double[]){domain.max.x, domain.max.y, domain.max.z}, 3);
        csg_put(out, "]");
    }
    csg_put_argument(out, ", ", "lipschitz", formula->lipschitz);
    csg_put(out, formula->trusted ? ", proven = true);\n" : ");\n");
    return true;
}

/* ---- shapes ------------------------------------------------------------------------------- */

static void put_index(const csg_printer *out, size_t index)
{
    char text[24];
    snprintf(text, sizeof text, "%zu", index);
    csg_put(out, text);
}

static void put_region(const csg_printer *out, const csg_shape *shape, const char *end)
{
    const csg_outline *outline = csg_region_outline(shape);
    csg_put(out, "polygon(points = [");
    for (size_t i = 0; i < outline->point_count; i++) {
        csg_put(out, i ? ", " : "");
        csg_put_list(out, (double[]){outline->points[i].x, outline->points[i].y}, 2);
    }
    csg_put(out, "]");
    for (size_t loop = 0; loop < outline->loop_count && outline->loop_count > 1; loop++) {
        csg_put(out, loop ? ", [" : ", paths = [[");
        for (size_t i = csg_outline_first(outline, loop); i < outline->ends[loop]; i++) {
            csg_put(out, i > csg_outline_first(outline, loop) ? ", " : "");
            put_index(out, i);
        }
        csg_put(out, loop + 1 < outline->loop_count ? "]" : "]]");
    }
    csg_put(out, end);
}

/* Faces run the other way round in the language. */
static void put_polyhedron(const csg_printer *out, const csg_shape *shape, const char *end)
{
    const csg_triangles *triangles = csg_polyhedron_triangles(shape);
    csg_put(out, "polyhedron(points = [");
    for (size_t i = 0; i < triangles->point_count; i++) {
        csg_vec3 p = triangles->points[i];
        csg_put(out, i ? ", " : "");
        csg_put_list(out, (double[]){p.x, p.y, p.z}, 3);
    }
    csg_put(out, "], faces = [");
    for (size_t i = 0; i < triangles->count; i++) {
        csg_put(out, i ? ", [" : "[");
        for (int k = 2; k >= 0; k--) {
            put_index(out, triangles->corners[i][k]);
            csg_put(out, k ? ", " : "]");
        }
    }
    csg_put(out, "]");
    csg_put(out, end);
}

void csg_put_shape(const csg_printer *out, const csg_shape *shape, const char *end)
{
    if (shape->kind == CSG_SHAPE_REGION)
        put_region(out, shape, end);
    else
        put_polyhedron(out, shape, end);
}

bool csg_put_leaf(const csg_printer *out, const csg_node *node)
{
    if (node->kind == CSG_NODE_FIELD)
        return put_field(out, node);
    if (node->kind == CSG_NODE_EMPTY) {
        csg_put(out, "union() {}\n");
    } else if (node->kind != CSG_NODE_SHAPE) {
        put_primitive(out, node);
    } else {
        csg_put_shape(out, out->scene->shapes[node->payload], ", clean = true);\n");
    }
    return true;
}
