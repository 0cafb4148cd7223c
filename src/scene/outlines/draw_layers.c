/* SPDX-License-Identifier: MIT
 * A flat node taken apart by its looks, each piece flattened and joined to its layer; see
 * draw_layers.h.
 */
#include "scene/outlines/draw_layers.h"

#include <math.h>
#include <string.h>

#include "base/elementary.h"
#include "scene/outlines/flatten.h"
#include "shape/plane/polygons.h"

typedef struct piece { /* of the figure, on the way down */
    csg_node_id node;
    csg_affine map;
    csg_look look; /* the outermost of each kind */
} piece;

typedef struct drawer {
    csg_scene_builder *builder;
    double tolerance;
    csg_drawing *out;
    piece *stack;
    size_t count, capacity;
} drawer;

static bool push_piece(drawer *d, piece p)
{
    if (!csg_memory_reserve(d->out->memory, (void **)&d->stack, &d->capacity, d->count + 1,
                            sizeof p))
        return false;
    d->stack[d->count++] = p;
    return true;
}

/* What stands below a node that is only a place or a look; false: the node is a piece. */
static bool look_through(const csgm_scene *scene, piece *p)
{
    const csg_node *node = &scene->nodes[p->node];
    if (node->kind == CSG_NODE_TRANSFORM) {
        p->map = csg_affine_multiply(p->map, scene->transforms[node->payload]);
    } else if (node->kind == CSG_NODE_COLOR) {
        const csg_look *look = &scene->looks[node->payload];
        if (look->has_color && !p->look.has_color) {
            p->look.color = look->color;
            p->look.has_color = true;
        }
        p->look.part = p->look.part ? p->look.part : look->part;
    } else if (node->kind != CSG_NODE_UNION || !csg_blend_is_sharp(node->blend)) {
        return false;
    }
    return true;
}

static bool is_layer_of(const csg_drawn_layer *layer, const char *name, const csg_look *look)
{
    bool same_name = name && layer->name ? strcmp(name, layer->name) == 0 : name == layer->name;
    const float color[4] = {look->color.r, look->color.g, look->color.b, look->color.a};
    bool same_color = true;
    for (int i = 0; i < 4 && look->has_color; i++)
        same_color = same_color && layer->color[i] == color[i];
    return same_name && layer->has_color == look->has_color && same_color;
}

/* NULL: out of memory. */
static csg_drawn_layer *layer_of(drawer *d, const csg_look *look)
{
    csg_drawing *out = d->out;
    const char *name = look->part ? d->builder->scene->part_names[look->part - 1] : NULL;
    for (size_t i = 0; i < out->count; i++)
        if (is_layer_of(&out->layers[i], name, look))
            return &out->layers[i];
    if (!csg_memory_reserve(out->memory, (void **)&out->layers, &out->capacity, out->count + 1,
                            sizeof *out->layers))
        return NULL;
    csg_drawn_layer *layer = &out->layers[out->count];
    *layer =
        (csg_drawn_layer){.has_color = look->has_color,
                          .color = {look->color.r, look->color.g, look->color.b, look->color.a}};
    layer->name = name ? csg_arena_strndup(&out->arena, name, strlen(name)) : NULL;
    if (name && !layer->name)
        return NULL;
    csg_outline_init(&layer->outline, out->memory);
    out->count++;
    return layer;
}

/* By how much the map makes lengths in the plane longer, at most. */
static double stretch_of(const csg_affine *map)
{
    return csg_hypot(csg_hypot(map->m[0][0], map->m[0][1]), csg_hypot(map->m[1][0], map->m[1][1]));
}

static csgm_status draw_piece(drawer *d, const piece *p)
{
    csg_outline outline, turned;
    double stretch = stretch_of(&p->map);
    csgm_status status =
        csg_flatten(d->builder, p->node, d->tolerance / (stretch > 0 ? stretch : 1), &outline);
    if (status != CSGM_OK)
        return status;
    csg_outline_transform(&outline, &p->map);
    if (p->map.m[0][0] * p->map.m[1][1] - p->map.m[0][1] * p->map.m[1][0] < 0) {
        status = csg_polygons_clean(&outline, CSG_FILL_EVEN_ODD, &turned); /* a reflection */
        csg_outline_release(&outline);
        outline = turned;
    }
    csg_drawn_layer *layer = status == CSGM_OK ? layer_of(d, &p->look) : NULL;
    if (status == CSGM_OK && (!layer || !csg_outline_append(&layer->outline, &outline)))
        status = CSGM_ERR_MEMORY;
    csg_outline_release(&outline);
    return status;
}

static csgm_status draw_pieces(drawer *d, csg_node_id root)
{
    csgm_status status = CSGM_OK;
    if (!push_piece(d, (piece){.node = root, .map = csg_affine_identity()}))
        return CSGM_ERR_MEMORY;
    while (d->count && status == CSGM_OK) {
        piece p = d->stack[--d->count];
        const csgm_scene *scene = d->builder->scene;
        const csg_node *node = &scene->nodes[p.node];
        bool is_whole = scene->look_count == 0; /* one layer: nothing to take apart */
        if (is_whole || !look_through(scene, &p)) {
            status = draw_piece(d, &p);
            continue;
        }
        for (uint32_t i = node->child_count; i-- > 0 && status == CSGM_OK;) {
            p.node = csg_scene_children(scene, node)[i];
            status = push_piece(d, p) ? CSGM_OK : CSGM_ERR_MEMORY;
        }
    }
    return status;
}

/* Pieces of one layer may overlap; layers without area go. */
static csgm_status join_layers(csg_drawing *drawing)
{
    size_t kept = 0;
    csgm_status status = CSGM_OK;
    for (size_t i = 0; i < drawing->count; i++) {
        csg_drawn_layer layer = drawing->layers[i];
        csg_outline joined;
        if (status == CSGM_OK) {
            status = csg_polygons_clean(&layer.outline, CSG_FILL_NONZERO, &joined);
            csg_outline_release(&layer.outline);
            layer.outline = joined;
        }
        if (status == CSGM_OK && layer.outline.loop_count)
            drawing->layers[kept++] = layer;
        else
            csg_outline_release(&layer.outline);
    }
    drawing->count = kept;
    return status;
}

csgm_status csg_draw_layers(csg_scene_builder *builder, csg_node_id flat, double tolerance,
                            csg_drawing **out)
{
    csg_memory *memory = &builder->context->memory;
    csg_drawing *made = csg_drawing_create(memory);
    *out = NULL;
    if (!made)
        return CSGM_ERR_MEMORY;
    drawer d = {.builder = builder, .tolerance = tolerance, .out = made};
    csgm_status status = draw_pieces(&d, flat);
    csg_memory_release(memory, d.stack, d.capacity * sizeof *d.stack);
    if (status == CSGM_OK)
        status = join_layers(made);
    if (status == CSGM_OK)
        *out = made;
    else
        csg_drawing_destroy(made);
    return status;
}
