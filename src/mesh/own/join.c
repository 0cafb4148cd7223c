/* SPDX-License-Identifier: MIT
 * See join.h. Children have smaller numbers than their parents, so one loop upwards over the nodes
 * has the steps of operands before those of operators.
 */
#include "mesh/own/join.h"

#include <math.h>
#include <string.h>

#include "base/trace.h"
#include "mesh/own/borders.h"
#include "shape/polyhedra/booleans.h"
#include "shape/polyhedra/polyhedron.h"
#include "shape/polyhedra/repair.h"

static const uint32_t NO_STEP = UINT32_MAX;

typedef struct joining {
    const csg_own_units *units;
    const csgm_scene *scene;
    uint32_t *step_of;  /* per node: the step that makes it */
    uint32_t *operands; /* of all steps */
    size_t operand_count;
    csg_boolean_step *steps; /* at most one per node and unit */
    size_t count;
} joining;

typedef struct joined {
    csg_shape *shape; /* NULL: there is none */
    csg_marked_triangles marked;
} joined;

/* ---- steps -------------------------------------------------------------------------------------
 */

static uint32_t add_leaf(joining *j, const csg_own_unit *unit)
{
    j->steps[j->count] = (csg_boolean_step){.kind = CSG_BOOLEAN_LEAF,
                                            .triangles = csg_polyhedron_triangles(unit->shape),
                                            .place = unit->place,
                                            .mark = unit->look};
    return (uint32_t)j->count++;
}

static csg_boolean_kind kind_of(const csg_node *node)
{
    return node->kind == CSG_NODE_UNION          ? CSG_BOOLEAN_UNION
           : node->kind == CSG_NODE_INTERSECTION ? CSG_BOOLEAN_INTERSECTION
                                                 : CSG_BOOLEAN_DIFFERENCE;
}

/* rest: the step of operands that are one unit, or NO_STEP. The result is NO_STEP where the node is
 * a part of a unit. */
static uint32_t add_node(joining *j, const csg_node *node, uint32_t rest)
{
    const csg_node_id *children = csg_scene_children(j->scene, node);
    if (!node->child_count)
        return NO_STEP;
    if (!csg_node_is_operator(node->kind))
        return j->step_of[children[0]];
    uint32_t *operands = j->operands + j->operand_count, count = 0;
    for (uint32_t k = 0; k < node->child_count; k++)
        if (j->step_of[children[k]] != NO_STEP)
            operands[count++] = j->step_of[children[k]];
    if (rest != NO_STEP)
        operands[count++] = rest;
    if (!count)
        return NO_STEP;
    j->operand_count += count;
    j->steps[j->count] =
        (csg_boolean_step){.kind = kind_of(node), .operands = operands, .count = count};
    return (uint32_t)j->count++;
}

/* The root's step is the last. */
static void list_steps(joining *j)
{
    size_t next = 0;
    for (csg_node_id i = 0; i <= j->scene->root; i++) {
        const csg_own_unit *unit = &j->units->items[next];
        bool has_unit = next < j->units->count && unit->node == i;
        uint32_t leaf = has_unit ? add_leaf(j, unit) : NO_STEP;
        next += has_unit;
        j->step_of[i] =
            has_unit && !unit->is_operand ? leaf : add_node(j, &j->scene->nodes[i], leaf);
    }
}

/* ---- the solid ---------------------------------------------------------------------------------
 */

/* Four steps of a float at the farthest place: rounded, what is nearer would be one place or on the
 * wrong side of its neighbours. */
static double nearest_places(const csg_own_units *units)
{
    double farthest = 0;
    for (size_t i = 0; i < units->count; i++) {
        csg_box box = units->items[i].box;
        farthest = fmax(farthest, fmax(csg_vec3_norm(box.min), csg_vec3_norm(box.max)));
    }
    return 0x1p-21 * farthest;
}

/* Points in the order in which a polyhedron has them. */
static bool number_points(csg_memory *memory, csg_triangles *triangles)
{
    csg_arena scratch;
    csg_arena_init(&scratch, memory);
    bool done = csg_repair_number(&scratch, triangles);
    csg_arena_reset(&scratch);
    return done;
}

/* Whether its triangles are these, in this order, so that their marks are known. */
static bool has_triangles(const csg_shape *shape, const csg_triangles *triangles)
{
    const csg_triangles *own = csg_polyhedron_triangles(shape);
    return own->count == triangles->count &&
           memcmp(own->corners, triangles->corners, own->count * sizeof *own->corners) == 0;
}

/* *made NULL: it is none, or others. The polyhedron knows of no time, but takes memory in each
 * step. */
static csgm_status make_polyhedron(csg_memory *memory, csg_triangles *triangles,
                                   csg_mesh_watch *watch, csg_shape **made)
{
    csgm_status status = CSGM_ERR_MEMORY;
    csg_memory_end_when(memory, csg_mesh_should_stop, watch);
    if (number_points(memory, triangles))
        status = csg_polyhedron_create(memory, triangles, NULL, made);
    bool is_late = csg_memory_has_ended(memory);
    csg_memory_end_when(memory, NULL, NULL);
    if (status == CSGM_OK && !has_triangles(*made, triangles)) {
        csg_shape_release(*made);
        *made = NULL;
    }
    return is_late && status == CSGM_ERR_MEMORY ? CSGM_CANCELLED : status;
}

/* Not where looks of faces that coincide are mixed. */
static csgm_status check_borders(const csg_own_units *units, joined *out)
{
    bool clear = true;
    if (units->look_count > 1 && !csg_own_borders_are_clear(units, &out->marked, &clear))
        return CSGM_ERR_MEMORY;
    if (!clear) {
        csg_shape_release(out->shape);
        out->shape = NULL;
    }
    return CSGM_OK;
}

/* Where memory is short cells may do with less. */
static csgm_status make_joined(joining *j, csg_mesh_watch *watch, joined *out)
{
    csg_memory *memory = j->units->memory;
    const csg_boolean_watch asked = {csg_mesh_should_stop, watch};
    list_steps(j);
    csgm_status status =
        csg_booleans(memory, j->steps, j->count, nearest_places(j->units), &asked, &out->marked);
    if (status == CSGM_OK && out->marked.triangles.count)
        status = make_polyhedron(memory, &out->marked.triangles, watch, &out->shape);
    if (status == CSGM_OK && out->shape)
        status = check_borders(j->units, out);
    if (status != CSGM_OK) {
        csg_shape_release(out->shape); /* NULL is a no-op */
        out->shape = NULL;
    }
    return status == CSGM_CANCELLED ? csg_mesh_why_stopped(watch) : CSGM_OK;
}

static csgm_status join_in_rooms(csg_own_units *units, const csgm_scene *scene,
                                 csg_mesh_watch *watch, joined *out)
{
    csg_memory *memory = units->memory;
    size_t nodes = scene->node_count, operands = scene->child_count + units->count;
    size_t steps = nodes + units->count;
    joining j = {.units = units, .scene = scene};
    csgm_status status = CSGM_OK;
    j.step_of = csg_memory_alloc(memory, nodes * sizeof *j.step_of);
    j.operands = csg_memory_alloc(memory, operands * sizeof *j.operands);
    j.steps = csg_memory_alloc(memory, steps * sizeof *j.steps);
    if (j.step_of && j.operands && j.steps)
        status = make_joined(&j, watch, out);
    csg_memory_release(memory, j.step_of, nodes * sizeof *j.step_of);
    csg_memory_release(memory, j.operands, operands * sizeof *j.operands);
    csg_memory_release(memory, j.steps, steps * sizeof *j.steps);
    return status;
}

/* A rest may have come to nothing. */
static bool have_shapes(const csg_own_units *units)
{
    for (size_t i = 0; i < units->count; i++)
        if (!units->items[i].shape)
            return false;
    return true;
}

csgm_status csg_own_join(csg_own_units *units, const csgm_scene *scene, csg_mesh_watch *watch)
{
    if (!units->count || units->are_apart)
        return CSGM_OK;
    CSG_ZONE(watch->context, "own triangles: join");
    joined out = {0};
    csgm_status status = CSGM_OK;
    csg_triangles_init(&out.marked.triangles, units->memory);
    if (have_shapes(units))
        status = join_in_rooms(units, scene, watch, &out);
    if (out.shape) {
        csg_own_units_replace(units, out.shape, out.marked.marks, out.marked.mark_room);
        out.marked.marks = NULL;
        out.marked.mark_room = 0;
    } else
        csg_own_units_reset(units);
    csg_marked_triangles_release(&out.marked);
    return status;
}
