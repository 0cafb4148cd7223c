/* SPDX-License-Identifier: MIT
 * Welding; see weld.h.
 */
#include "mesh/weld.h"

#include <math.h>
#include <string.h>

#include "base/places.h"

static bool same_place(const csgm_mesh_view *mesh, uint64_t a, uint64_t b)
{
    const float *p = mesh->positions + 3 * a, *q = mesh->positions + 3 * b;
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

void csg_weld_parts_of(const csgm_mesh_view *mesh, uint32_t *part_of)
{
    memset(part_of, 0xFF, (size_t)mesh->vertex_count * sizeof *part_of);
    for (uint64_t p = 0; p < mesh->part_count; p++) {
        const csgm_mesh_part *part = &mesh->parts[p];
        const uint32_t *corner = mesh->indices + 3 * part->first_triangle;
        for (uint64_t i = 0; i < 3 * part->triangle_count; i++)
            if (corner[i] < mesh->vertex_count)
                part_of[corner[i]] = (uint32_t)p;
    }
}

/* part_of: NULL, or of each vertex. One without a part goes with any. */
static uint64_t map_runs(const csgm_mesh_view *mesh, const uint32_t *part_of, uint32_t *to)
{
    uint64_t places = 0;
    uint32_t part = CSG_NO_PART; /* of the run at hand */
    for (uint64_t i = 0; i < mesh->vertex_count; i++) {
        uint32_t own = part_of ? part_of[i] : CSG_NO_PART;
        bool copy = i > 0 && same_place(mesh, i, i - 1) &&
                    (own == part || own == CSG_NO_PART || part == CSG_NO_PART);
        to[i] = copy ? to[i - 1] : (uint32_t)i;
        part = copy && own == CSG_NO_PART ? part : own;
        places += !copy;
    }
    return places;
}

static csg_vec3 place_of(const csgm_mesh_view *mesh, uint64_t i)
{
    return csg_vec3_from_floats(mesh->positions + 3 * i);
}

static uint64_t map_all(csg_memory *memory, const csgm_mesh_view *mesh, const uint32_t *part_of,
                        uint32_t *to, bool *failed)
{
    csg_table table;
    csg_table_init(&table, memory);
    *failed = !csg_table_reserve(&table, (size_t)mesh->vertex_count + 1, NULL, NULL);
    if (*failed)
        return 0;
    uint64_t places = 0;
    for (uint64_t i = 0; i < mesh->vertex_count; i++) {
        size_t slot;
        to[i] = csg_table_first(&table, csg_place_hash(place_of(mesh, i)), &slot);
        while (to[i] != CSG_TABLE_NONE &&
               !(same_place(mesh, i, to[i]) && (!part_of || part_of[i] == part_of[to[i]])))
            to[i] = csg_table_next(&table, &slot);
        if (to[i] != CSG_TABLE_NONE)
            continue;
        to[i] = (uint32_t)i;
        csg_table_put(&table, slot, to[i]);
        places++;
    }
    csg_table_release(&table);
    return places;
}

uint64_t csg_weld_map(csg_memory *memory, const csgm_mesh_view *mesh, csg_weld how, uint32_t *to,
                      bool *failed)
{
    bool has_parts = how != CSG_WELD_ALL && mesh->part_count > 1 && mesh->vertex_count > 0;
    size_t bytes = has_parts ? (size_t)mesh->vertex_count * sizeof(uint32_t) : 0;
    uint32_t *part_of = bytes ? csg_memory_alloc(memory, bytes) : NULL;
    uint64_t places = 0;
    *failed = bytes && !part_of;
    if (part_of)
        csg_weld_parts_of(mesh, part_of);
    if (!*failed && how == CSG_WELD_RUNS)
        places = map_runs(mesh, part_of, to);
    else if (!*failed)
        places = map_all(memory, mesh, part_of, to, failed);
    csg_memory_release(memory, part_of, bytes);
    return places;
}

/* The copies [first, end) as vertex v. */
static void join_copies(const csgm_mesh_view *mesh, uint64_t first, uint64_t end, csgm_mesh *out,
                        uint64_t v)
{
    memcpy(out->positions + 3 * v, mesh->positions + 3 * first, 3 * sizeof(float));
    float normal[3] = {0, 0, 0}, square = 0;
    uint32_t color[4] = {0, 0, 0, 0}, material[2] = {0, 0}, count = (uint32_t)(end - first);
    for (uint64_t i = first; i < end; i++) {
        for (uint64_t k = 0; mesh->normals && k < 3; k++)
            normal[k] += mesh->normals[3 * i + k];
        for (uint64_t k = 0; mesh->colors && k < 4; k++)
            color[k] += mesh->colors[4 * i + k];
        for (uint64_t k = 0; mesh->materials && k < 2; k++)
            material[k] += mesh->materials[2 * i + k];
    }
    for (int k = 0; k < 3; k++)
        square += normal[k] * normal[k];
    bool lost = count == 1 || !(square > 1e-12f); /* nothing to mix, or they cancel */
    for (uint64_t k = 0; mesh->normals && k < 3; k++)
        out->normals[3 * v + k] = lost ? mesh->normals[3 * first + k] : normal[k] / sqrtf(square);
    for (uint64_t k = 0; mesh->colors && k < 4; k++)
        out->colors[4 * v + k] = (uint8_t)((color[k] + count / 2) / count);
    for (uint64_t k = 0; mesh->materials && k < 2; k++)
        out->materials[2 * v + k] = (uint16_t)((material[k] + count / 2) / count);
}

static csgm_status copy_parts(const csgm_mesh_view *mesh, csgm_mesh *out)
{
    csgm_status status = CSGM_OK;
    for (uint64_t i = 0; i < mesh->part_count && status == CSGM_OK; i++)
        status = csg_mesh_add_part(out, mesh->parts[i].name, mesh->parts[i].first_triangle);
    return status;
}

/* numbers: in, the first vertex at each one's place; out, its number after the weld. */
static void fill(const csgm_mesh_view *mesh, uint32_t *numbers, csgm_mesh *out)
{
    uint64_t v = 0;
    for (uint64_t i = 0; i < mesh->vertex_count; v++) {
        uint64_t end = i + 1;
        while (end < mesh->vertex_count && numbers[end] == i)
            end++;
        join_copies(mesh, i, end, out, v);
        for (; i < end; i++)
            numbers[i] = (uint32_t)v;
    }
    for (uint64_t i = 0; i < 3 * mesh->triangle_count; i++)
        out->indices[i] = numbers[mesh->indices[i]];
}

csgm_status csg_weld_runs(csgm_context *context, const csgm_mesh_view *mesh, csgm_mesh **out)
{
    csg_memory *memory = &context->memory;
    size_t bytes = (size_t)(mesh->vertex_count + 1) * sizeof(uint32_t);
    uint32_t *numbers = csg_memory_alloc(memory, bytes);
    bool failed = !numbers;
    uint64_t places = failed ? 0 : csg_weld_map(memory, mesh, CSG_WELD_RUNS, numbers, &failed);
    csgm_mesh *made = NULL;
    csgm_status status = failed ? csg_context_no_memory(context) : CSGM_OK;
    if (status == CSGM_OK)
        status = csg_mesh_create(context, places, mesh->triangle_count, mesh->normals != NULL,
                                 mesh->colors != NULL, &made);
    if (status == CSGM_OK && mesh->materials)
        status = csg_mesh_add_materials(made);
    if (status == CSGM_OK) {
        made->origin = mesh->origin;
        fill(mesh, numbers, made);
        status = copy_parts(mesh, made);
    }
    csg_memory_release(memory, numbers, bytes);
    if (status == CSGM_OK)
        *out = made;
    else
        csg_mesh_destroy(made);
    return status;
}
