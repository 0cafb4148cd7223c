/* SPDX-License-Identifier: MIT
 * Leaves as calls of the scene language.
 */
#include "scene/tree/print_private.h"

#include <stdio.h>

#include "shape/plane/region.h"
#include "shape/polyhedra/polyhedron.h"

/* ---- primitives --------------------------------------------------------------------------- */

typedef struct primitive_text {
    const char *whole;
    const char *otherwise; /* where the last parameter is one that `whole` cannot say; or NULL */
    double usual;          /* that last parameter where `whole` says all */
} primitive_text;

/* $a to $p: the parameters (primitives.def), $A to $D: twice that. A rounded frustum is printed by
 * the sizes of its core, since those of its outside would come back with other last bits. */
static const primitive_text primitives[] = {
    [CSG_NODE_SPHERE] = {"sphere(r = $a)", NULL, 0},
    [CSG_NODE_BOX] = {"cube(size = [$A, $B, $C], center = true)",
                      "cube(size = [$A, $B, $C], center = true, round = $d)", 0},
    [CSG_NODE_FRUSTUM] = {"cylinder(h = $C, r1 = $a, r2 = $b, center = true)",
                          "cylinder(h = $C, r1 = $a, r2 = $b, center = true, round = $d, core = "
                          "true)",
                          0},
    [CSG_NODE_CAPSULE] = {"capsule(p1 = [0, 0, 0], p2 = [0, 0, $a], r1 = $b, r2 = $c)", NULL, 0},
    [CSG_NODE_TORUS] = {"torus(r = $a, tube = $b)",
                        "torus(r = $a, tube = $b, angle = $C, center = true)", 180},
    [CSG_NODE_ELLIPSOID] = {"ellipsoid(r = [$a, $b, $c])", NULL, 0},
    [CSG_NODE_PLANE] = {"plane(normal = [$a, $b, $c], d = $d)", NULL, 0},
    [CSG_NODE_CIRCLE] = {"circle(r = $a)", NULL, 0},
    [CSG_NODE_RECTANGLE] = {"square(size = [$A, $B], center = true)",
                            "square(size = [$A, $B], center = true, round = $c)", 0},
    [CSG_NODE_SLAB] = {"slab(h = $a)", NULL, 0},
    [CSG_NODE_SUPERELLIPSOID] = {"superellipsoid(r = [$a, $b, $c], exponents = [$d, $e])", NULL, 0},
    [CSG_NODE_QUADRATIC_TUBE] = {"tube(points = [[$a, $b, $c], [$e, $f, $g], [$i, $j, $k]], "
                                 "r = [$d, $h, $l], degree = 2)",
                                 NULL, 0},
    [CSG_NODE_CUBIC_TUBE] = {"tube(points = [[$a, $b, $c], [$e, $f, $g], [$i, $j, $k], "
                             "[$m, $n, $o]], r = [$d, $h, $l, $p], degree = 3)",
                             NULL, 0},
};

static void put_primitive(const csg_printer *out, const csg_node *node)
{
    const double *v = csg_scene_parameters(out->scene, node);
    const primitive_text *row = &primitives[node->kind];
    double last = v[csg_primitive_parameter_count(node->kind) - 1];
    const char *text = row->otherwise && last != row->usual ? row->otherwise : row->whole;
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
    static const csg_formula_words words = {"p", {"p.x", "p.y", "p.z"}};
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
    csg_put(out, ");\n");
    return true;
}

/* ---- shapes ------------------------------------------------------------------------------- */

static void put_index(const csg_printer *out, size_t index)
{
    char text[24];
    snprintf(text, sizeof text, "%zu", index);
    csg_put(out, text);
}

static void put_region(const csg_printer *out, const csg_shape *shape)
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
    csg_put(out, ", clean = true);\n");
}

/* Faces run the other way round in the language. */
static void put_polyhedron(const csg_printer *out, const csg_shape *shape)
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
    csg_put(out, "], clean = true);\n");
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
        const csg_shape *shape = out->scene->shapes[node->payload];
        if (shape->kind == CSG_SHAPE_REGION)
            put_region(out, shape);
        else
            put_polyhedron(out, shape);
    }
    return true;
}
