/* SPDX-License-Identifier: MIT
 * Edges are matched by a table; what has no partner is border. See close.h.
 */
#include "mesh/remesh/close.h"

#include <string.h>

#include "base/geometry.h"
#include "base/table.h"

/* An edge has the number of the corner that it starts at. */
typedef struct closing {
    csg_memory *memory;
    const csgm_mesh *part;
    uint32_t corner_count;
    uint32_t *vertex; /* per corner, with the numbers of vertices that are parted */
    uint32_t
        *opposite; /* per edge; NONE: border. Of these in the end the next edge of the border */
    uint8_t *is_border; /* per edge; 2: its border is closed */
    uint32_t *original; /* per vertex */
    uint8_t *at_border; /* per vertex */
    uint32_t vertex_count, border_count, fan_count;
    size_t vertex_room;
} closing;

static uint64_t edge_key(uint32_t from, uint32_t to)
{
    return (uint64_t)from << 32 | to;
}

static uint64_t key_of(const closing *c, uint32_t edge)
{
    return edge_key(c->vertex[edge], c->vertex[csg_corner_next(edge)]);
}

static uint32_t find_edge(const closing *c, const csg_table *table, uint64_t key)
{
    size_t slot;
    uint32_t found = csg_table_first(table, csg_hash_word(CSG_HASH_START, key), &slot);
    while (found != CSG_TABLE_NONE && key_of(c, found) != key)
        found = csg_table_next(table, &slot);
    return found;
}

static bool match_edges(closing *c)
{
    csg_table table;
    csg_table_init(&table, c->memory);
    if (!csg_table_reserve(&table, (size_t)c->corner_count + 1, NULL, NULL))
        return false;
    for (uint32_t e = 0; e < c->corner_count; e++)
        csg_table_add(&table, csg_hash_word(CSG_HASH_START, key_of(c, e)), e);
    for (uint32_t e = 0; e < c->corner_count; e++) {
        c->opposite[e] =
            find_edge(c, &table, edge_key(c->vertex[csg_corner_next(e)], c->vertex[e]));
        c->is_border[e] = c->opposite[e] == CSG_TABLE_NONE;
        c->border_count += c->is_border[e];
    }
    csg_table_release(&table);
    return true;
}

/* The border's next edge: around the end of this one, through its fan of triangles. The fan's
 * corners there get the number `vertex`, unless that is NONE. */
static uint32_t walk_fan(closing *c, uint32_t edge, uint32_t vertex)
{
    uint32_t e = csg_corner_next(edge);
    for (;; e = csg_corner_next(c->opposite[e])) {
        if (vertex != CSG_CORNER_NONE)
            c->vertex[e] = vertex;
        if (c->is_border[e])
            return e;
    }
}

/* The second fan at a vertex, and those behind it, get vertices of their own. */
static void part_fans(closing *c)
{
    for (uint32_t e = 0; e < c->corner_count; e++) {
        uint32_t end = c->vertex[csg_corner_next(e)];
        if (!c->is_border[e])
            continue;
        if (c->at_border[end]) {
            c->original[c->vertex_count] = end;
            end = c->vertex_count++;
            walk_fan(c, e, end);
        }
        c->at_border[end] = 1;
    }
}

/* Edges of borders get the next one in place of the opposite one; borders are counted. */
static void link_borders(closing *c)
{
    for (uint32_t e = 0; e < c->corner_count; e++)
        if (c->is_border[e])
            c->opposite[e] = walk_fan(c, e, CSG_CORNER_NONE);
    for (uint32_t first = 0; first < c->corner_count; first++) {
        if (c->is_border[first] != 1)
            continue;
        c->fan_count++;
        for (uint32_t e = first; c->is_border[e] == 1; e = c->opposite[e])
            c->is_border[e] = 2;
    }
}

static bool take_arrays(closing *c)
{
    const csgm_mesh *part = c->part;
    c->vertex = csg_memory_alloc(c->memory, (c->corner_count + 1) * sizeof *c->vertex);
    c->opposite = csg_memory_alloc(c->memory, (c->corner_count + 1) * sizeof *c->opposite);
    c->is_border = csg_memory_alloc(c->memory, c->corner_count + 1);
    if (!c->vertex || !c->opposite || !c->is_border)
        return false;
    if (c->corner_count)
        memcpy(c->vertex, part->indices, c->corner_count * sizeof *c->vertex);
    if (!match_edges(c))
        return false;
    c->vertex_room = (size_t)part->vertex_count + 2 * (size_t)c->border_count + 1;
    c->original = csg_memory_alloc(c->memory, c->vertex_room * sizeof *c->original);
    c->at_border = csg_memory_alloc(c->memory, c->vertex_room);
    if (!c->original || !c->at_border)
        return false;
    memset(c->at_border, 0, c->vertex_room);
    for (uint32_t v = 0; v < c->vertex_count; v++)
        c->original[v] = v;
    return true;
}

static void copy_vertex(const csgm_mesh *from, size_t vertex, csgm_mesh *to, size_t place)
{
    memcpy(to->positions + 3 * place, from->positions + 3 * vertex, 3 * sizeof(float));
    if (from->colors)
        memcpy(to->colors + 4 * place, from->colors + 4 * vertex, 4);
    if (from->materials)
        memcpy(to->materials + 2 * place, from->materials + 2 * vertex, 2 * sizeof(uint16_t));
}

/* The fan over the border from this edge on, around a vertex in its middle. */
static void add_fan(closing *c, uint32_t first, csgm_mesh *mesh, uint32_t *triangles)
{
    csg_vec3 sum = {0, 0, 0};
    uint32_t middle = c->vertex_count++, count = 0, e = first;
    c->original[middle] = CSG_CORNER_NONE;
    do {
        uint32_t *v = mesh->indices + 3 * (size_t)(*triangles)++;
        v[0] = c->vertex[csg_corner_next(e)];
        v[1] = c->vertex[e];
        v[2] = middle;
        sum = csg_vec3_add(sum, csg_vec3_from_floats(mesh->positions + 3 * (size_t)v[0]));
        count++;
        c->is_border[e] = 1;
        e = c->opposite[e];
    } while (e != first);
    copy_vertex(mesh, c->vertex[first], mesh, middle);
    csg_vec3_to_floats(mesh->positions + 3 * (size_t)middle, csg_vec3_scale(sum, 1.0 / count));
}

static csgm_status write_mesh(closing *c, csg_closed_mesh *out)
{
    const csgm_mesh *part = c->part;
    csgm_mesh *mesh;
    csgm_status status =
        csg_mesh_create(part->context, (uint64_t)c->vertex_count + c->fan_count,
                        part->triangle_count + c->border_count, false, part->colors != NULL, &mesh);
    if (status != CSGM_OK)
        return status;
    out->mesh = mesh;
    mesh->origin = part->origin;
    status = part->materials ? csg_mesh_add_materials(mesh) : CSGM_OK;
    if (status != CSGM_OK)
        return status;
    for (uint32_t v = 0; v < c->vertex_count; v++)
        copy_vertex(part, c->original[v], mesh, v);
    for (uint32_t e = 0; e < c->corner_count; e++)
        if (c->is_border[e] == 2)
            add_fan(c, e, mesh, &out->closing);
    if (c->corner_count)
        memcpy(mesh->indices + 3 * (size_t)out->closing, c->vertex,
               c->corner_count * sizeof *c->vertex);
    return CSGM_OK;
}

/* Arrays as long as the mesh has vertices: so who has the mesh knows their size. */
static bool keep_originals(closing *c, csg_closed_mesh *out)
{
    size_t count = c->vertex_count;
    out->original = csg_memory_alloc(c->memory, (count + 1) * sizeof *out->original);
    out->at_border = csg_memory_alloc(c->memory, count + 1);
    if (!out->original || !out->at_border)
        return false;
    memcpy(out->original, c->original, count * sizeof *out->original);
    memcpy(out->at_border, c->at_border, count);
    return true;
}

csgm_status csg_mesh_close(const csgm_mesh *part, csg_closed_mesh *out)
{
    closing c = {.memory = &part->context->memory,
                 .part = part,
                 .corner_count = 3 * (uint32_t)part->triangle_count,
                 .vertex_count = (uint32_t)part->vertex_count};
    *out = (csg_closed_mesh){0};
    csgm_status status = CSGM_ERR_MEMORY;
    if (take_arrays(&c)) {
        part_fans(&c);
        link_borders(&c);
        status = write_mesh(&c, out);
        if (status == CSGM_OK && !keep_originals(&c, out))
            status = csg_context_no_memory(part->context);
    } else {
        csg_context_no_memory(part->context);
    }
    csg_memory_release(c.memory, c.vertex, (c.corner_count + 1) * sizeof *c.vertex);
    csg_memory_release(c.memory, c.opposite, (c.corner_count + 1) * sizeof *c.opposite);
    csg_memory_release(c.memory, c.is_border, c.corner_count + 1);
    csg_memory_release(c.memory, c.original, c.vertex_room * sizeof *c.original);
    csg_memory_release(c.memory, c.at_border, c.vertex_room);
    if (status != CSGM_OK)
        csg_closed_mesh_release(out);
    return status;
}

void csg_closed_mesh_release(csg_closed_mesh *closed)
{
    if (closed->mesh) {
        csg_memory *memory = &closed->mesh->context->memory;
        size_t count = (size_t)closed->mesh->vertex_count + 1;
        csg_memory_release(memory, closed->original, count * sizeof *closed->original);
        csg_memory_release(memory, closed->at_border, count);
    }
    csg_mesh_destroy(closed->mesh);
    *closed = (csg_closed_mesh){0};
}
