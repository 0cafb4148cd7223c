/* SPDX-License-Identifier: MIT
 * A scene in OpenSCAD's words: primitives, multmatrix, color, union, difference, intersection,
 * linear_extrude, rotate_extrude, offset, hull, minkowski, projection, polygon, polyhedron.
 *
 * What has no end (half-spaces, slabs, figures among solids, which stand for prisms) is said by as
 * much of it as the solid around needs. Round solids get FACETS sides. Parts and materials, which
 * change no shape, are comments. What OpenSCAD has no words for (blends, formulas, tubes, bends
 * ...) is found before the first word is written.
 */
#include "scene/tree/print_openscad.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

#include "base/elementary.h"
#include "base/scene_codes.h"
#include "scene/primitives/kinds.h"
#include "scene/primitives/primitive.h"
#include "scene/tree/print_private.h"
#include "scene/tree/texts.h"
#include "scene/warp_kinds.h"

#define FACETS "$fn = 96"

typedef struct open_call {
    csg_node_id node;
    uint32_t next_child;
    csg_box room;  /* in the children's frame: what lies outside of it changes nothing */
    bool is_solid; /* children are to be solids */
    bool braces;
} open_call;

typedef struct openscad_text {
    csg_printer out;
    open_call *open; /* the path from the root */
    size_t open_count, open_capacity;
} openscad_text;

/* ---- what cannot be said --------------------------------------------------------------- */

/* A ball around each of its points makes the field's level set: a distance, moved and turned. */
static bool grows_by_balls(const csgm_scene *scene, const csg_node *node)
{
    while (node->kind == CSG_NODE_COLOR || node->kind == CSG_NODE_TRANSFORM) {
        if (node->kind == CSG_NODE_TRANSFORM &&
            !csg_affine_is_similarity(&scene->transforms[node->payload]))
            return false;
        node = &scene->nodes[csg_scene_children(scene, node)[0]];
    }
    return node->kind == CSG_NODE_SHAPE ||
           (csg_node_is_named_primitive((csg_node_kind)node->kind) &&
            csg_primitive_has((csg_node_kind)node->kind, CSG_TRAIT_EXACT | CSG_TRAIT_BOUNDED));
}

/* NULL: put_leaf says it. */
static const char *primitive_obstacle(csg_primitive_kind kind)
{
    switch (kind) {
    case CSG_NODE_SPHERE:
    case CSG_NODE_CIRCLE:
    case CSG_NODE_BOX:
    case CSG_NODE_RECTANGLE:
    case CSG_NODE_FRUSTUM:
    case CSG_NODE_CAPSULE:
    case CSG_NODE_TORUS:
    case CSG_NODE_ELLIPSOID:
    case CSG_NODE_PLANE:
    case CSG_NODE_SLAB:
        return NULL;
    case CSG_NODE_SUPERELLIPSOID:
        return "superellipsoids";
    case CSG_NODE_QUADRATIC_TUBE:
    case CSG_NODE_CUBIC_TUBE:
        return "tubes along curves";
    default: /* one that nobody has written a translation for */
        return csg_node_kind_name((csg_node_kind)kind);
    }
}

/* NULL: it can be said. What OpenSCAD turns or narrows are figures. */
static const char *obstacle_of_warp(const csg_warp *warp, bool of_figure)
{
    switch ((csg_warp_kind)warp->kind) {
    case CSG_WARP_REVOLVE:
    case CSG_WARP_SLICE:
        return NULL;
    case CSG_WARP_TWIST:
        return of_figure ? NULL : "twisted solids";
    case CSG_WARP_TAPER:
        return of_figure ? NULL : "tapered solids";
    case CSG_WARP_ELBOW:
        return of_figure ? NULL : "bent solids";
    case CSG_WARP_BEND:
        return "bent solids";
    case CSG_WARP_COUNT:
        break;
    }
    return NULL;
}

/* NULL: it can be said. */
static const char *obstacle_of(const csgm_scene *scene, const csg_node *node)
{
    const csg_node *child =
        node->child_count ? &scene->nodes[csg_scene_children(scene, node)[0]] : NULL;
    switch ((csg_node_kind)node->kind) {
    case CSG_NODE_FIELD:
    case CSG_NODE_COMBINE:
        return csg_blend_is_profile(node->blend) ? "blends" : "solids by a formula";
    case CSG_NODE_SOFT:
        return "soft solids";
    case CSG_NODE_WARP:
        return obstacle_of_warp(&scene->warps[node->payload], child->flags & CSG_FLAG_FLAT);
    case CSG_NODE_OFFSET:
        if (node->flags & CSG_FLAG_FLAT)
            return NULL;
        return scene->parameters[node->payload] > 0 && grows_by_balls(scene, child)
                   ? NULL
                   : "offsets of solids";
    case CSG_NODE_UNION:
    case CSG_NODE_INTERSECTION:
    case CSG_NODE_DIFFERENCE:
        return csg_blend_is_sharp(node->blend) || csg_node_is_plate(node) ? NULL : "blends";
    case CSG_NODE_EMPTY:
    case CSG_NODE_SHAPE:
    case CSG_NODE_TRANSFORM:
    case CSG_NODE_COLOR:
        return NULL;
    case CSG_NODE_FIRST_PRIMITIVE:
        break;
    }
    return primitive_obstacle(node->kind);
}

static csgm_status refuse(const csgm_scene *scene, csg_node_id id, const char *obstacle)
{
    char message[160];
    csgm_diag diag = {.message = message};
    if (obstacle)
        snprintf(message, sizeof message, "OpenSCAD has no %s: the scene cannot be written for it",
                 obstacle);
    else
        snprintf(message, sizeof message,
                 "the scene has no bounds: it cannot be written for OpenSCAD");
    csg_scene_show_node(scene, id, &diag);
    csg_diag_report(&scene->context->diags, CSG_DIAG_NOT_OPENSCAD, diag);
    return CSGM_ERR_UNSUPPORTED;
}

/* The first obstacle from the root down. */
static csgm_status look_for_obstacles(const csgm_scene *scene)
{
    for (size_t i = scene->node_count; i-- > 0;) {
        const char *obstacle = obstacle_of(scene, &scene->nodes[i]);
        if (obstacle)
            return refuse(scene, (csg_node_id)i, obstacle);
    }
    return CSGM_OK;
}

/* ---- words ------------------------------------------------------------------------------- */

static void put_shift(const csg_printer *out, double x, double y, double z)
{
    if (x == 0 && y == 0 && z == 0)
        return;
    csg_put(out, "translate(");
    csg_put_list(out, (double[]){x, y, z}, 3);
    csg_put(out, ") ");
}

static void put_ball(const csg_printer *out, const char *name, double r)
{
    csg_put(out, name);
    csg_put_argument(out, "(", "r", r);
    csg_put(out, ", " FACETS ");");
}

static void put_cylinder(const csg_printer *out, double h, double r1, double r2)
{
    csg_put_argument(out, "cylinder(", "h", h);
    csg_put_argument(out, ", ", "r1", r1);
    csg_put_argument(out, ", ", "r2", r2);
    csg_put(out, ", center = true, " FACETS ");");
}

static void put_cube(const csg_printer *out, const char *name, const double *size, int count)
{
    csg_put(out, name);
    csg_put(out, "(size = ");
    csg_put_list(out, size, count);
    csg_put(out, ", center = true);");
}

/* Balls at all corners. */
static void put_rounded(const csg_printer *out, const double *half, int count, double r)
{
    static const char *const axes[] = {"x", "y", "z"};
    csg_put(out, "hull() for (");
    for (int i = 0; i < count; i++) {
        csg_put(out, i ? ", " : "");
        csg_put(out, axes[i]);
        csg_put(out, " = ");
        csg_put_list(out, (double[]){r - half[i], half[i] - r}, 2);
    }
    csg_put(out, count == 2 ? ") translate([x, y]) " : ") translate([x, y, z]) ");
    put_ball(out, count == 2 ? "circle" : "sphere", r);
}

/* The half-space n . p <= d, as far as there is room. */
static void put_half_space(const csg_printer *out, const double *v, csg_box room)
{
    csg_vec3 normal = {v[0], v[1], v[2]}, center = csg_box_center(room);
    double far = v[3] - csg_vec3_dot(normal, center), size = csg_vec3_norm(csg_box_size(room));
    csg_affine place = csg_affine_z_to(normal);
    csg_vec3 foot = csg_vec3_add(center, csg_vec3_scale(normal, far));
    place.t[0] = foot.x;
    place.t[1] = foot.y;
    place.t[2] = foot.z;
    double depth = size + fabs(far);
    csg_put_matrix(out, &place);
    csg_put(out, " ");
    put_shift(out, 0, 0, -depth);
    put_cube(out, "cube", (double[]){2 * size, 2 * size, 2 * depth}, 3);
}

static void put_slab(const csg_printer *out, double h, csg_box room)
{
    csg_vec3 center = csg_box_center(room), size = csg_box_size(room);
    put_shift(out, center.x, center.y, 0);
    put_cube(out, "cube", (double[]){2 * size.x, 2 * size.y, 2 * h}, 3);
}

/* A ring, or an arc of it with balls at its ends. */
static void put_torus(const csg_printer *out, const double *v)
{
    bool arc = v[2] != 180;
    if (arc) {
        csg_put(out, "union() { for (a = ");
        csg_put_list(out, (double[]){-v[2], v[2]}, 2);
        csg_put(out, ") rotate(a) ");
        put_shift(out, v[0], 0, 0);
        put_ball(out, "sphere", v[1]);
        csg_put_argument(out, " rotate(", "a", -v[2]);
        csg_put(out, ") ");
    }
    csg_put_argument(out, "rotate_extrude(", "angle", 2 * v[2]);
    csg_put(out, ", " FACETS ") ");
    put_shift(out, v[0], 0, 0);
    put_ball(out, "circle", v[1]);
    csg_put(out, arc ? " }" : "");
}

static void put_capsule(const csg_printer *out, const double *v)
{
    const double least = 1e-6 * v[0]; /* OpenSCAD's balls have a radius */
    csg_put(out, "hull() { ");
    put_ball(out, "sphere", fmax(v[1], least));
    csg_put(out, " ");
    put_shift(out, 0, 0, v[0]);
    put_ball(out, "sphere", fmax(v[2], least));
    csg_put(out, " }");
}

static void put_frustum(const csg_printer *out, const double *v)
{
    if (v[3] > 0)
        csg_put(out, "minkowski() { ");
    put_cylinder(out, 2 * v[2], v[0], v[1]);
    if (v[3] > 0) {
        csg_put(out, " ");
        put_ball(out, "sphere", v[3]);
        csg_put(out, " }");
    }
}

static void put_primitive(const csg_printer *out, const csg_node *node, csg_box room)
{
    const double *v = csg_scene_parameters(out->scene, node);
    switch (node->kind) {
    case CSG_NODE_SPHERE:
        put_ball(out, "sphere", v[0]);
        break;
    case CSG_NODE_CIRCLE:
        put_ball(out, "circle", v[0]);
        break;
    case CSG_NODE_BOX:
        if (v[3] > 0)
            put_rounded(out, v, 3, v[3]);
        else
            put_cube(out, "cube", (double[]){2 * v[0], 2 * v[1], 2 * v[2]}, 3);
        break;
    case CSG_NODE_RECTANGLE:
        if (v[2] > 0)
            put_rounded(out, v, 2, v[2]);
        else
            put_cube(out, "square", (double[]){2 * v[0], 2 * v[1]}, 2);
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
        csg_put(out, "scale(");
        csg_put_list(out, v, 3);
        csg_put(out, ") ");
        put_ball(out, "sphere", 1);
        break;
    case CSG_NODE_PLANE:
        put_half_space(out, v, room);
        break;
    case CSG_NODE_SLAB:
        put_slab(out, v[0], room);
        break;
    default:
        assert(!"primitive_obstacle refuses the others");
    }
    csg_put(out, "\n");
}

/* ---- nodes with children ----------------------------------------------------------------- */

static void put_look(const csg_printer *out, const csg_look *look)
{
    if (look->part) {
        csg_put(out, "group() /* part ");
        for (const char *c = out->scene->part_names[look->part - 1]; *c; c++) {
            char text[2] = {*c};
            csg_put(out, *c == '*' || (unsigned char)*c < ' ' ? "_" : text);
        }
        csg_put(out, " */ ");
    }
    if (look->has_color) {
        csg_put(out, "color(");
        csg_put_list(out,
                     (double[]){(double)look->color.r, (double)look->color.g, (double)look->color.b,
                                (double)look->color.a},
                     4);
        csg_put(out, ")");
    }
    csg_put(out, look->has_color || look->part ? "\n" : "group()\n");
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
    put_shift(out, 0, 0, middle);
    csg_put_argument(out, "linear_extrude(", "height", 2 * csg_scene_parameters(scene, slab)[0]);
    csg_put(out, ", center = true)\n");
}

/* The end of a call: what is smooth here in as many steps as look smooth there. */
static void put_slices(const csg_printer *out, double turn)
{
    char slices[48];
    snprintf(slices, sizeof slices, ", slices = %.0f)", fmin(ceil(fabs(turn) / 3) + 1, 1e4));
    csg_put(out, slices);
}

/* A figure turned by rate * z from low to high, and as it is there beyond; what the solid is cut
 * with ends it, so that only the turned part is said. */
static void put_twist(const csg_printer *out, const double *v)
{
    double height = v[CSG_TWIST_HIGH] - v[CSG_TWIST_LOW];
    put_shift(out, 0, 0, v[CSG_TWIST_LOW]);
    csg_put_argument(out, "rotate(", "a", v[CSG_TWIST_RATE] * v[CSG_TWIST_LOW]);
    csg_put_argument(out, ") linear_extrude(", "height", height);
    csg_put_argument(out, ", ", "twist", -v[CSG_TWIST_RATE] * height);
    put_slices(out, v[CSG_TWIST_RATE] * height);
    csg_put(out, "\n");
}

/* The same, ever larger or smaller: turned first, and then scaled. */
static void put_taper(const csg_printer *out, const double *v)
{
    double height = v[CSG_TAPER_HIGH] - v[CSG_TAPER_LOW], turn = v[CSG_TAPER_RATE] * height;
    put_shift(out, 0, 0, v[CSG_TAPER_LOW]);
    csg_put_argument(out, "linear_extrude(", "height", height);
    csg_put_argument(out, ", ", "twist", -turn);
    csg_put(out, ", scale = ");
    csg_put_list(out, &v[CSG_TAPER_X], 2);
    put_slices(out, turn);
    csg_put_argument(out, " rotate(", "a", v[CSG_TAPER_RATE] * v[CSG_TAPER_LOW]);
    csg_put(out, ")\n");
}

static void put_warp(const csg_printer *out, const csg_warp *warp)
{
    switch ((csg_warp_kind)warp->kind) {
    case CSG_WARP_REVOLVE:
        csg_put(out, "rotate_extrude(" FACETS ")\n");
        break;
    case CSG_WARP_SLICE:
        csg_put(out, "projection(cut = true)\n");
        break;
    case CSG_WARP_TAPER:
        put_taper(out, warp->parameters);
        break;
    case CSG_WARP_TWIST:
        put_twist(out, warp->parameters);
        break;
    case CSG_WARP_ELBOW: /* put_elbow */
    case CSG_WARP_BEND:  /* obstacle_of_warp */
    case CSG_WARP_COUNT:
        break;
    }
}

static void put_offset(const csg_printer *out, const csg_node *node)
{
    double r = out->scene->parameters[node->payload];
    if (node->flags & CSG_FLAG_FLAT) {
        csg_put_argument(out, "offset(", "r", r);
        csg_put(out, ", " FACETS ")\n");
    } else {
        csg_put(out, "minkowski() { ");
        put_ball(out, "sphere", r);
        csg_put(out, "\n");
    }
}

/* A module of its own, before all else: its child is needed three times. */
static void put_elbow_module(const csg_printer *out)
{
    const csgm_scene *scene = out->scene;
    bool any = false;
    for (size_t i = 0; i < scene->warp_count; i++)
        any |= scene->warps[i].kind == CSG_WARP_ELBOW;
    if (any)
        csg_put(out,
                "module elbow(half, reach) {\n"
                "  rotate(-half) rotate_extrude(angle = 2 * half, " FACETS ") children();\n"
                "  rotate(-half) rotate([90, 0, 0]) linear_extrude(height = reach) children();\n"
                "  rotate(half) rotate([90, 0, 0]) translate([0, 0, -reach])"
                " linear_extrude(height = reach) children();\n"
                "}\n");
}

/* Its straight ends go on as far as the room does. */
static void put_elbow(const csg_printer *out, const csg_warp *warp, csg_box room)
{
    double reach = csg_vec3_norm(csg_box_size(room));
    csg_put_argument(out, "elbow(", "half", warp->parameters[CSG_ELBOW_HALF]);
    csg_put_argument(out, ", ", "reach", reach);
    csg_put(out, ")\n");
}

static bool is_elbow(const csgm_scene *scene, const csg_node *node)
{
    return node->kind == CSG_NODE_WARP && scene->warps[node->payload].kind == CSG_WARP_ELBOW;
}

/* The line that a node with children begins with. */
static void put_call(const csg_printer *out, const csg_node *node)
{
    const csgm_scene *scene = out->scene;
    csg_affine flat;
    switch ((csg_node_kind)node->kind) {
    case CSG_NODE_TRANSFORM:
        flat = csg_affine_of_plane(scene->transforms[node->payload]);
        csg_put_matrix(out,
                       node->flags & CSG_FLAG_FLAT ? &flat : &scene->transforms[node->payload]);
        csg_put(out, " \n");
        return;
    case CSG_NODE_COLOR:
        put_look(out, &scene->looks[node->payload]);
        return;
    case CSG_NODE_WARP:
        put_warp(out, &scene->warps[node->payload]);
        return;
    case CSG_NODE_OFFSET:
        put_offset(out, node);
        return;
    case CSG_NODE_UNION:
    case CSG_NODE_INTERSECTION:
    case CSG_NODE_DIFFERENCE:
        if (csg_node_is_plate(node)) {
            put_plate(out, node);
            return;
        }
        csg_put(out, csg_node_kind_name((csg_node_kind)node->kind));
        csg_put(out, "() {\n");
        return;
    case CSG_NODE_EMPTY:
    case CSG_NODE_FIELD:
    case CSG_NODE_SHAPE:
    case CSG_NODE_COMBINE: /* obstacle_of */
    case CSG_NODE_SOFT:
    case CSG_NODE_FIRST_PRIMITIVE:
        return;
    }
}

/* ---- the walk ---------------------------------------------------------------------------- */

/* As wide again on each side, so that what is cut off there is far from the solid. */
static csg_box widen(csg_box box)
{
    return csg_box_grow(box, csg_vec3_norm(csg_box_size(box)));
}

/* Room for a node's children; call it with that for the node. */
static csg_box room_of_children(const csgm_scene *scene, const csg_node *node, csg_box room)
{
    csg_affine inverse;
    if (node->kind == CSG_NODE_TRANSFORM)
        return csg_affine_invert(scene->transforms[node->payload], &inverse)
                   ? csg_affine_box(&inverse, room)
                   : room;
    if (node->kind == CSG_NODE_OFFSET)
        return csg_box_grow(room, fabs(scene->parameters[node->payload]));
    if (node->kind != CSG_NODE_WARP)
        return room;
    double r = csg_hypot(fmax(fabs(room.min.x), fabs(room.max.x)),
                         fmax(fabs(room.min.y), fabs(room.max.y)));
    if (scene->warps[node->payload].kind == CSG_WARP_REVOLVE ||
        scene->warps[node->payload].kind == CSG_WARP_ELBOW)
        return (csg_box){{-r, room.min.z, -r}, {r, room.max.z, r}};
    if (scene->warps[node->payload].kind == CSG_WARP_SLICE)
        return (csg_box){{room.min.x, room.min.y, -r}, {room.max.x, room.max.y, r}};
    return (csg_box){{-r, -r, room.min.z}, {r, r, room.max.z}};
}

static void put_leaf(const csg_printer *out, const csg_node *node, csg_box room)
{
    if (node->kind == CSG_NODE_EMPTY)
        csg_put(out, "group();\n");
    else if (node->kind == CSG_NODE_SHAPE)
        csg_put_shape(out, out->scene->shapes[node->payload], ");\n");
    else
        put_primitive(out, node, room);
}

/* Do its children stand in figures' places, or in solids'? */
static bool wants_solids(const csgm_scene *scene, const csg_node *node, bool is_solid)
{
    if (node->kind != CSG_NODE_WARP)
        return is_solid && !csg_node_is_plate(node);
    return scene->warps[node->payload].kind == CSG_WARP_SLICE;
}

static bool open_node(openscad_text *w, csg_node_id id, csg_box room, bool is_solid)
{
    const csgm_scene *scene = w->out.scene;
    const csg_node *node = &scene->nodes[id];
    void *open = w->open;
    if (node->flags & CSG_FLAG_ENDED) /* without its blend the union ends there by itself */
        return open_node(w, csg_scene_children(scene, node)[0], room, is_solid);
    csg_put_indent(&w->out, w->open_count);
    if (is_solid && node->flags & CSG_FLAG_FLAT) {
        put_shift(&w->out, 0, 0, csg_box_center(room).z);
        csg_put_argument(&w->out, "linear_extrude(", "height", csg_box_size(room).z);
        csg_put(&w->out, ", center = true) ");
        is_solid = false;
    }
    if (!node->child_count) {
        put_leaf(&w->out, node, room);
        return true;
    }
    if (is_elbow(scene, node))
        put_elbow(&w->out, &scene->warps[node->payload], room);
    else
        put_call(&w->out, node);
    if (!csg_memory_reserve(&scene->context->memory, &open, &w->open_capacity, w->open_count + 1,
                            sizeof *w->open))
        return false;
    w->open = open;
    bool braces = (csg_node_is_operator((csg_node_kind)node->kind) && !csg_node_is_plate(node)) ||
                  (node->kind == CSG_NODE_OFFSET && !(node->flags & CSG_FLAG_FLAT));
    w->open[w->open_count++] = (open_call){id, 0, room_of_children(scene, node, room),
                                           wants_solids(scene, node, is_solid), braces};
    return true;
}

static csgm_status write_all(openscad_text *w, csg_box room)
{
    const csgm_scene *scene = w->out.scene;
    bool flat = scene->nodes[scene->root].flags & CSG_FLAG_FLAT;
    if (!open_node(w, scene->root, room, !flat))
        return CSGM_ERR_MEMORY;
    while (w->open_count) {
        open_call *top = &w->open[w->open_count - 1];
        const csg_node *node = &scene->nodes[top->node];
        if (top->next_child < (csg_node_is_plate(node) ? 1 : node->child_count)) {
            csg_node_id child = csg_scene_children(scene, node)[top->next_child++];
            if (!open_node(w, child, top->room, top->is_solid))
                return CSGM_ERR_MEMORY;
            continue;
        }
        bool braces = top->braces;
        w->open_count--;
        if (braces) {
            csg_put_indent(&w->out, w->open_count);
            csg_put(&w->out, "}\n");
        }
    }
    return CSGM_OK;
}

csgm_status csg_scene_print_openscad(const csgm_scene *scene, csgm_text_fn *sink, void *user)
{
    openscad_text w = {.out = {scene, sink, user}};
    csg_box room = scene->bounds[scene->root];
    csgm_status status = look_for_obstacles(scene);
    if (scene->nodes[scene->root].flags & CSG_FLAG_FLAT) {
        room.min.z = -1;
        room.max.z = 1;
    }
    if (csg_box_is_empty(room))
        room = (csg_box){{-1, -1, -1}, {1, 1, 1}};
    if (status == CSGM_OK && !csg_box_is_finite(room))
        status = refuse(scene, scene->root, NULL);
    if (status == CSGM_OK) {
        put_elbow_module(&w.out);
        status = write_all(&w, widen(room));
    }
    csg_memory_release(&scene->context->memory, w.open, w.open_capacity * sizeof *w.open);
    return status == CSGM_ERR_MEMORY ? csg_context_no_memory(scene->context) : status;
}
