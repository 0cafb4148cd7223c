/* SPDX-License-Identifier: MIT
 * Welding; see weld.h.
 */
#include "mesh/weld.h"

#include <math.h>
#include <string.h>

static bool same_place(const csgm_mesh_view *mesh, uint64_t a, uint64_t b)
{
    const float *p = mesh->positions + 3 * a, *q = mesh->positions + 3 * b;
    return p[0] == q[0] && p[1] == q[1] && p[2] == q[2];
}

static uint64_t map_runs(const csgm_mesh_view *mesh, uint32_t *to)
{
    uint64_t places = 0;
    for (uint64_t i = 0; i < mesh->vertex_count; i++) {
        bool copy = i > 0 && same_place(mesh, i, i - 1);
        to[i] = copy ? to[i - 1] : (uint32_t)i;
        places += !copy;
    }
    return places;
}

static size_t home_slot(const float *p, size_t slot_count)
{
    uint64_t key = 0;
    for (int k = 0; k < 3; k++) {
        float c = p[k] + 0.0f; /* no -0 */
        uint32_t bits;
        memcpy(&bits, &c, sizeof bits);
        key = (key ^ bits) * 0x9E3779B97F4A7C15u; /* Fibonacci hashing */
        key ^= key >> 29;
    }
    return (size_t)key & (slot_count - 1);
}

static uint64_t map_all(csg_memory *memory, const csgm_mesh_view *mesh, uint32_t *to, bool *failed)
{
    size_t slot_count = 16;
    while (slot_count < 2 * mesh->vertex_count)
        slot_count *= 2;
    uint32_t *slots = csg_memory_alloc(memory, slot_count * sizeof *slots);
    *failed = !slots;
    if (!slots)
        return 0;
    memset(slots, 0, slot_count * sizeof *slots);
    uint64_t places = 0;
    for (uint64_t i = 0; i < mesh->vertex_count; i++) {
        size_t slot = home_slot(mesh->positions + 3 * i, slot_count);
        while (slots[slot] && !same_place(mesh, i, slots[slot] - 1))
            slot = (slot + 1) & (slot_count - 1);
        places += !slots[slot];
        if (!slots[slot])
            slots[slot] = (uint32_t)i + 1;
        to[i] = slots[slot] - 1;
    }
    csg_memory_release(memory, slots, slot_count * sizeof *slots);
    return places;
}

uint64_t csg_weld_map(csg_memory *memory, const csgm_mesh_view *mesh, csg_weld how, uint32_t *to,
                      bool *failed)
{
    *failed = false;
    return how == CSG_WELD_RUNS ? map_runs(mesh, to) : map_all(memory, mesh, to, failed);
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

/* numbers[i]: vertex i after the weld. */
static void fill(const csgm_mesh_view *mesh, uint32_t *numbers, csgm_mesh *out)
{
    uint64_t v = 0;
    for (uint64_t i = 0; i < mesh->vertex_count; v++) {
        uint64_t end = i + 1;
        while (end < mesh->vertex_count && same_place(mesh, i, end))
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
    if (!numbers)
        return csg_context_no_memory(context);
    csgm_mesh *made = NULL;
    csgm_status status = csg_mesh_create(context, map_runs(mesh, numbers), mesh->triangle_count,
                                         mesh->normals != NULL, mesh->colors != NULL, &made);
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
