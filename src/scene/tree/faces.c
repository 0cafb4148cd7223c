/* SPDX-License-Identifier: MIT
 * Faces of a fillet's operands; see faces.h.
 *
 * A box is the intersection of itself with its six half-spaces, a cylinder that of itself with its
 * side and its caps. So a fillet, which takes the members of sharp operators one by one, gives
 * every pair of faces its own: it ends flush where faces do, an edge that is hidden in another
 * operand adds nothing, and no jump of a gradient within a solid is seen. The sides of its box keep
 * a union within that of the sharp one.
 */
#include "scene/tree/faces.h"

#include <string.h>

#include "scene/operators/blend_kinds.h"
#include "scene/operators/fillet.h"
#include "scene/primitives/primitive.h"
#include "scene/tree/build_private.h"

enum { MOST_FACES = 16 };

static const double PARALLEL = 1e-9;

/* A node below a fillet that is to be looked at. */
typedef struct visit {
    csg_node_id node;
    uint32_t place; /* of the node, in its parent's children */
    bool is_below;  /* a fillet, without anything between that is no lattice */
} visit;

typedef struct search {
    csg_scene_builder *builder;
    csg_faces *faces;
    const csg_box *boxes;
    csg_node_id root;
    visit *stack;
    size_t count, capacity;
    csg_node_id made[MOST_FACES]; /* the leaf's */
    csg_vec3 normals[MOST_FACES]; /* of planes, in its frame */
    size_t made_count, normal_count;
} search;

/* ---- the faces of a leaf ---------------------------------------------------------------------- */

static bool keep_face(search *s, csg_node_id face)
{
    if (face == CSG_NODE_NONE)
        return false;
    s->made[s->made_count++] = face;
    return true;
}

/* The half-space n . p <= d, unless one with this normal is there. */
static bool add_plane(search *s, csg_vec3 n, double d, csg_span where)
{
    double length = csg_vec3_norm(n);
    if (!(length > 0) || !isfinite(d))
        return true;
    n = csg_vec3_scale(n, 1 / length);
    for (size_t i = 0; i < s->normal_count; i++)
        if (csg_vec3_norm(csg_vec3_sub(n, s->normals[i])) < PARALLEL)
            return true;
    if (s->made_count == MOST_FACES || s->normal_count == MOST_FACES)
        return true;
    s->normals[s->normal_count++] = n;
    return keep_face(s, csg_build_primitive(s->builder, CSG_NODE_PLANE,
                                            (double[]){n.x, n.y, n.z, d / length}, where));
}

static bool add_sides(search *s, const double *half, int count, csg_span where)
{
    for (int i = 0; i < 2 * count; i++) {
        double sign = i & 1 ? -1 : 1, n[3] = {0};
        n[i / 2] = sign;
        if (!add_plane(s, csg_vec3_make(n[0], n[1], n[2]), half[i / 2], where))
            return false;
    }
    return true;
}

static bool add_box(search *s, csg_box box, csg_span where)
{
    const double low[3] = {box.min.x, box.min.y, box.min.z};
    const double high[3] = {box.max.x, box.max.y, box.max.z};
    for (int i = 0; i < 3; i++) {
        double n[3] = {0};
        n[i] = 1;
        if (!add_plane(s, csg_vec3_make(n[0], n[1], n[2]), high[i], where) ||
            !add_plane(s, csg_vec3_make(-n[0], -n[1], -n[2]), -low[i], where))
            return false;
    }
    return true;
}

/* The side of a frustum goes on beyond its caps, as far as its tip. */
static bool add_slant(search *s, const double *v, csg_span where)
{
    double r1 = v[0], r2 = v[1], h = v[2];
    if (r1 == r2)
        return keep_face(
            s, csg_build_primitive(s->builder, CSG_NODE_CIRCLE, (double[]){r1 + v[3]}, where));
    double slope = (r2 - r1) / (2 * h), most = 4 * (fmax(r1, r2) + h + v[3]);
    double below = fmin(most, slope > 0 ? r1 / slope : INFINITY);
    double above = fmin(most, slope < 0 ? -r2 / slope : INFINITY);
    double made[4] = {fmax(r1 - slope * below, 0), fmax(r2 + slope * above, 0),
                      h + (below + above) / 2, v[3]};
    csg_affine shift = csg_affine_translate(csg_vec3_make(0, 0, (above - below) / 2));
    csg_node_id side = csg_build_primitive(s->builder, CSG_NODE_FRUSTUM, made, where);
    return side != CSG_NODE_NONE &&
           keep_face(s, csg_build_transform(s->builder, &shift, side, where));
}

/* A leaf's own faces. A rounded one's are where it is not rounded. */
static bool add_own(search *s, csg_node_id leaf)
{
    const csg_node node = s->builder->scene->nodes[leaf];
    double v[CSG_PRIMITIVE_MOST_PARAMETERS];
    memcpy(v, s->builder->scene->parameters + node.payload,
           csg_node_parameter_count(&node) * sizeof *v);
    if (node.kind == CSG_NODE_BOX)
        return add_sides(s, v, 3, node.where);
    if (node.kind == CSG_NODE_RECTANGLE)
        return add_sides(s, v, 2, node.where);
    if (node.kind == CSG_NODE_SHAPE)
        return add_box(s, s->builder->scene->shapes[node.payload]->box, node.where);
    if (node.kind == CSG_NODE_SLAB)
        return add_plane(s, csg_vec3_make(0, 0, 1), v[0], node.where) &&
               add_plane(s, csg_vec3_make(0, 0, -1), v[0], node.where);
    if (node.kind != CSG_NODE_FRUSTUM)
        return true;
    return add_plane(s, csg_vec3_make(0, 0, 1), v[2] + v[3], node.where) &&
           add_plane(s, csg_vec3_make(0, 0, -1), v[2] + v[3], node.where) &&
           add_slant(s, v, node.where);
}

/* An extrusion's: those of its slab, and its figure, which goes on along z. */
static bool add_extrusion(search *s, csg_node_id node)
{
    csgm_scene *scene = s->builder->scene;
    const csg_node_id *children = csg_scene_children(scene, &scene->nodes[node]);
    csg_node_id figure = children[0], slab = children[1];
    csg_span where = scene->nodes[node].where;
    double middle = 0;
    if (scene->nodes[slab].kind == CSG_NODE_TRANSFORM) {
        middle = scene->transforms[scene->nodes[slab].payload].t[2];
        slab = csg_scene_children(scene, &scene->nodes[slab])[0];
    }
    double half = scene->parameters[scene->nodes[slab].payload];
    return add_plane(s, csg_vec3_make(0, 0, 1), middle + half, where) &&
           add_plane(s, csg_vec3_make(0, 0, -1), half - middle, where) &&
           keep_face(s, csg_build_copy(s->builder, figure));
}

static bool is_extrusion(const csg_node *node)
{
    return node->kind == CSG_NODE_INTERSECTION && node->blend == CSG_BLEND_ORTHOGONAL &&
           node->child_count == 2;
}

static bool note(search *s, csg_node_id leaf, uint32_t place)
{
    csg_faces *f = s->faces;
    if (!csg_memory_reserve(&s->builder->context->memory, (void **)&f->taken, &f->capacity,
                            f->count + 2, sizeof *f->taken)) {
        csg_build_no_memory(s->builder);
        return false;
    }
    f->taken[f->count++] = leaf;
    f->taken[f->count++] = place;
    return true;
}

static bool push_visit(search *s, visit v)
{
    if (!csg_memory_reserve(&s->builder->context->memory, (void **)&s->stack, &s->capacity,
                            s->count + 1, sizeof *s->stack)) {
        csg_build_no_memory(s->builder);
        return false;
    }
    s->stack[s->count++] = v;
    return true;
}

/* Puts the intersection of a node with what was made into its place. */
static csg_node_id put_in(search *s, const visit *v)
{
    csgm_scene *scene = s->builder->scene;
    if (!csg_build_reserve_node(s->builder) ||
        !csg_build_reserve_children(s->builder, s->made_count + 1) ||
        !csg_build_reserve_parameters(s->builder, 1) || !note(s, v->node, v->place))
        return CSG_NODE_NONE;
    csg_node_id members[MOST_FACES + 1] = {v->node};
    memcpy(members + 1, s->made, s->made_count * sizeof *members);
    scene->parameters[scene->parameter_count] = 0;
    csg_node made = {.kind = CSG_NODE_INTERSECTION,
                     .blend = CSG_BLEND_SHARP,
                     .flags = CSG_FLAG_FACES,
                     .payload = (uint32_t)scene->parameter_count++,
                     .where = scene->nodes[v->node].where};
    csg_node_id wrapped = csg_build_append(s->builder, made, members, s->made_count + 1);
    if (v->place == UINT32_MAX)
        s->root = wrapped;
    else
        scene->children[v->place] = wrapped;
    return wrapped;
}

/* Wraps a piece that has faces; the figure of an extrusion is looked at as well. */
static bool wrap(search *s, const visit *v)
{
    const csg_node node = s->builder->scene->nodes[v->node];
    bool extrusion = is_extrusion(&node);
    s->made_count = s->normal_count = 0;
    if (!extrusion && node.child_count)
        return true;
    if (!(extrusion ? add_extrusion(s, v->node) : add_own(s, v->node)))
        return false;
    if (!s->made_count)
        return true;
    csg_node_id wrapped = put_in(s, v);
    if (wrapped == CSG_NODE_NONE || !extrusion)
        return wrapped != CSG_NODE_NONE;
    const csgm_scene *scene = s->builder->scene;
    uint32_t last = scene->nodes[wrapped].first_child + (uint32_t)s->made_count;
    return push_visit(s, (visit){scene->children[last], last, true});
}

/* What a ball fills lies in the hull of the operands, and in the box of that. */
static bool wrap_fillet(search *s, const visit *v)
{
    const csg_node node = s->builder->scene->nodes[v->node];
    s->made_count = s->normal_count = 0;
    if (node.kind != CSG_NODE_UNION || csg_box_is_empty(s->boxes[v->node]))
        return true;
    if (!add_box(s, s->boxes[v->node], node.where))
        return false;
    return !s->made_count || put_in(s, v) != CSG_NODE_NONE;
}

/* ---- all of them ------------------------------------------------------------------------------ */

static bool visit_children(search *s, const visit *v)
{
    const csgm_scene *scene = s->builder->scene;
    const csg_node node = scene->nodes[v->node];
    visit inner = {.is_below =
                       csg_node_is_fillet(&node) || (v->is_below && csg_node_is_lattice(&node))};
    for (uint32_t k = 0; k < node.child_count; k++) {
        inner.place = node.first_child + k;
        inner.node = scene->children[inner.place];
        if (!push_visit(s, inner))
            return false;
    }
    return true;
}

bool csg_faces_are_needed(const csgm_scene *scene)
{
    for (size_t i = 0; i < scene->node_count; i++)
        if (csg_node_is_fillet(&scene->nodes[i]))
            return true;
    return false;
}

static bool visit_one(search *s, const visit *v)
{
    const csg_node node = s->builder->scene->nodes[v->node];
    bool is_piece = v->is_below && !csg_node_is_lattice(&node);
    if (node.flags & CSG_FLAG_FACES)
        return true;
    if (is_piece && !wrap(s, v))
        return false;
    if (csg_node_is_fillet(&node) && !wrap_fillet(s, v))
        return false;
    return (is_piece && is_extrusion(&node)) || visit_children(s, v);
}

csgm_status csg_faces_add(csg_scene_builder *builder, csg_node_id *root, const csg_box *boxes,
                          csg_faces *faces)
{
    search s = {.builder = builder, .faces = faces, .boxes = boxes, .root = *root};
    *faces = (csg_faces){.node_count = builder->scene->node_count};
    bool done = push_visit(&s, (visit){.node = *root, .place = UINT32_MAX});
    while (done && s.count) {
        visit v = s.stack[--s.count];
        done = visit_one(&s, &v);
    }
    csg_memory_release(&builder->context->memory, s.stack, s.capacity * sizeof *s.stack);
    *root = s.root;
    return builder->status;
}

void csg_faces_remove(csg_scene_builder *builder, csg_faces *faces)
{
    csgm_scene *scene = builder->scene;
    for (size_t i = 0; i < faces->count; i += 2)
        if (faces->taken[i + 1] != UINT32_MAX)
            scene->children[faces->taken[i + 1]] = faces->taken[i];
    if (faces->count)
        scene->node_count = faces->node_count;
    csg_memory_release(&builder->context->memory, faces->taken,
                       faces->capacity * sizeof *faces->taken);
    *faces = (csg_faces){0};
}

/* ---- marks in a sealed scene ------------------------------------------------------------------ */

static void mark_children(csgm_scene *scene, csg_node_id id, uint8_t *depths)
{
    csg_node *node = &scene->nodes[id];
    bool is_fillet = csg_node_is_fillet(node), is_held = node->flags & CSG_FLAG_HELD;
    bool counts = csg_node_is_operator(node->kind);
    bool is_deep = counts && depths[id] >= CSG_FILLET_DEEPEST;
    bool hands_up = is_held && csg_node_is_lattice(node) && !is_deep;
    if (is_held && !hands_up)
        node->flags |= CSG_FLAG_PIECE;
    for (uint32_t k = 0; k < node->child_count && (hands_up || is_fillet); k++) {
        csg_node_id child = csg_scene_children(scene, node)[k];
        scene->nodes[child].flags |= CSG_FLAG_HELD;
        depths[child] = (uint8_t)(hands_up ? depths[id] + counts : 1);
    }
}

csgm_status csg_faces_mark(csgm_scene *scene)
{
    csg_memory *memory = &scene->context->memory;
    if (!csg_faces_are_needed(scene))
        return CSGM_OK;
    uint8_t *depths = csg_memory_alloc(memory, scene->node_count);
    if (!depths)
        return CSGM_ERR_MEMORY;
    memset(depths, 0, scene->node_count);
    for (size_t i = scene->node_count; i-- > 0;)
        mark_children(scene, (csg_node_id)i, depths);
    csg_memory_release(memory, depths, scene->node_count);
    return CSGM_OK;
}
