/* SPDX-License-Identifier: MIT
 * The growing mesh of builder.h.
 */
#include "io/builder.h"

#include <math.h>
#include <string.h>

#include "io/origin.h"
#include "io/parts.h"

static const uint16_t plain_material[2] = {CSG_MATERIAL_METALLIC, CSG_MATERIAL_ROUGHNESS};

void csg_builder_init(csg_mesh_builder *b, csgm_context *context, double from_s)
{
    *b = (csg_mesh_builder){.context = context};
    memcpy(b->material, plain_material, sizeof b->material);
    csg_read_clock_start(&b->clock, context, from_s);
    csg_arena_init(&b->names, &context->memory);
}

void csg_builder_release(csg_mesh_builder *b)
{
    csg_memory *memory = &b->context->memory;
    csg_memory_release(memory, b->positions, b->position_room * 3 * sizeof(double));
    csg_memory_release(memory, b->normals, b->normal_room * 3 * sizeof(float));
    csg_memory_release(memory, b->colors, b->color_room * 4);
    csg_memory_release(memory, b->materials, b->material_room * 2 * sizeof(uint16_t));
    csg_memory_release(memory, b->indices, b->index_room * 3 * sizeof(uint32_t));
    csg_memory_release(memory, b->parts, b->part_room * sizeof *b->parts);
    csg_arena_reset(&b->names);
    csg_builder_init(b, b->context, 0);
}

/* array: where the pointer stands. */
static bool room(csg_mesh_builder *b, void *array, size_t *capacity, size_t needed, size_t bytes)
{
    if (needed <= *capacity)
        return true;
    void *data;
    memcpy(&data, array, sizeof data);
    if (b->failed || !csg_memory_reserve(&b->context->memory, &data, capacity, needed, bytes)) {
        b->failed = true;
        return false;
    }
    memcpy(array, &data, sizeof data);
    return true;
}

bool csg_builder_reserve(csg_mesh_builder *b, size_t vertices, size_t triangles)
{
    return room(b, &b->positions, &b->position_room, vertices, 3 * sizeof(double)) &&
           room(b, &b->indices, &b->index_room, triangles, 3 * sizeof(uint32_t));
}

static bool add_color(csg_mesh_builder *b, const uint8_t *color)
{
    static const uint8_t white[4] = {255, 255, 255, 255};
    if (!color && !b->colors)
        return true;
    if (!csg_builder_colors(b))
        return false;
    memcpy(b->colors + 4 * b->vertex_count, color ? color : white, 4);
    return true;
}

static bool add_material(csg_mesh_builder *b)
{
    if (!b->materials && memcmp(b->material, plain_material, sizeof plain_material) == 0)
        return true;
    if (!csg_builder_materials(b))
        return false;
    memcpy(b->materials + 2 * b->vertex_count, b->material, sizeof b->material);
    return true;
}

static bool has_time(csg_mesh_builder *b)
{
    bool has = csg_read_has_time_for_step(&b->clock);
    b->failed |= !has;
    return has;
}

bool csg_builder_vertex(csg_mesh_builder *b, const double position[3], const float *normal,
                        const uint8_t *color)
{
    if (b->vertex_count >= UINT32_MAX || !has_time(b) ||
        !room(b, &b->positions, &b->position_room, b->vertex_count + 1, 3 * sizeof(double)) ||
        !add_color(b, color) || !add_material(b)) {
        b->failed = true;
        return false;
    }
    for (int k = 0; k < 3; k++)
        b->too_far |= !csg_origin_is_near(position[k]);
    memcpy(b->positions + 3 * b->vertex_count, position, 3 * sizeof(double));
    if (!normal)
        b->lacks_normals = true;
    if (!b->lacks_normals) {
        if (!room(b, &b->normals, &b->normal_room, b->vertex_count + 1, 3 * sizeof(float)))
            return false;
        memcpy(b->normals + 3 * b->vertex_count, normal, 3 * sizeof(float));
    }
    b->vertex_count++;
    return true;
}

bool csg_builder_triangle(csg_mesh_builder *b, uint32_t i, uint32_t j, uint32_t k)
{
    if (!has_time(b) ||
        !room(b, &b->indices, &b->index_room, b->triangle_count + 1, 3 * sizeof(uint32_t)))
        return false;
    uint32_t *corner = b->indices + 3 * b->triangle_count++;
    corner[0] = i;
    corner[1] = j;
    corner[2] = k;
    return true;
}

bool csg_builder_part(csg_mesh_builder *b, const char *name)
{
    bool follows_empty =
        b->part_count && b->parts[b->part_count - 1].first_triangle == b->triangle_count;
    size_t index = b->part_count - (follows_empty ? 1 : 0);
    char *copy = name ? csg_arena_strndup(&b->names, name, strlen(name)) : NULL;
    if ((name && !copy) || !room(b, &b->parts, &b->part_room, index + 1, sizeof *b->parts)) {
        b->failed = true;
        return false;
    }
    b->parts[index] = (csgm_mesh_part){.name = copy, .first_triangle = b->triangle_count};
    b->part_count = index + 1;
    return true;
}

float *csg_builder_normals(csg_mesh_builder *b)
{
    if (!room(b, &b->normals, &b->normal_room, b->vertex_count ? b->vertex_count : 1,
              3 * sizeof(float)))
        return NULL;
    b->lacks_normals = false;
    return b->normals;
}

uint8_t *csg_builder_colors(csg_mesh_builder *b)
{
    bool first = !b->colors;
    if (!room(b, &b->colors, &b->color_room, b->vertex_count + 1, 4))
        return NULL;
    if (first)
        memset(b->colors, 255, 4 * b->vertex_count);
    return b->colors;
}

uint16_t *csg_builder_materials(csg_mesh_builder *b)
{
    bool first = !b->materials;
    if (!room(b, &b->materials, &b->material_room, b->vertex_count + 1, 2 * sizeof *b->materials))
        return NULL;
    for (size_t i = 0; first && i < b->vertex_count; i++)
        memcpy(b->materials + 2 * i, plain_material, sizeof plain_material);
    return b->materials;
}

void csg_builder_material(csg_mesh_builder *b, const uint16_t *material)
{
    memcpy(b->material, material ? material : plain_material, sizeof b->material);
}

void csg_builder_unit(csg_mesh_builder *b, csgm_unit unit)
{
    b->says_unit = true;
    b->unit = unit;
}

void csg_builder_leave_out(csg_mesh_builder *b, const char *what)
{
    b->left_out = csg_arena_strndup(&b->names, what, strlen(what));
    b->failed |= !b->left_out;
}

/* ---- the end ---------------------------------------------------------------------- */

static csgm_vec3 choose_origin(const csg_mesh_builder *b)
{
    csg_origin_choice choice = csg_origin_begin();
    for (size_t v = 0; v < b->vertex_count; v++)
        csg_origin_add(&choice, b->positions + 3 * v);
    return csg_origin_choose(&choice);
}

/* Triangles before the first part are one without a name. */
static csgm_status add_parts(const csg_mesh_builder *b, csgm_mesh *mesh)
{
    size_t count = b->part_count;
    if (count && b->parts[count - 1].first_triangle == b->triangle_count)
        count--;
    bool headless = count && b->parts[0].first_triangle > 0;
    if (!count || (count == 1 && !headless && !b->parts[0].name))
        return CSGM_OK;
    csgm_status status = headless ? csg_mesh_add_part(mesh, NULL, 0) : CSGM_OK;
    for (size_t i = 0; i < count && !status; i++)
        status = csg_mesh_add_part(mesh, b->parts[i].name, b->parts[i].first_triangle);
    return status;
}

/* What only some files have. */
static csgm_status add_rest(const csg_mesh_builder *b, csgm_mesh *mesh)
{
    mesh->says_unit = b->says_unit;
    mesh->unit = b->unit;
    if (b->left_out) {
        mesh->left_out = csg_arena_strndup(&mesh->names, b->left_out, strlen(b->left_out));
        if (!mesh->left_out)
            return csg_context_no_memory(b->context);
    }
    csgm_status status = b->materials ? csg_mesh_add_materials(mesh) : CSGM_OK;
    if (!status && b->materials && b->vertex_count)
        memcpy(mesh->materials, b->materials, b->vertex_count * 2 * sizeof *b->materials);
    return status;
}

csgm_status csg_builder_why_failed(const csg_mesh_builder *b)
{
    return b->clock.is_late ? csg_read_why_late(&b->clock) : csg_context_no_memory(b->context);
}

csgm_status csg_builder_finish(csg_mesh_builder *b, csgm_mesh **out)
{
    csgm_mesh *mesh;
    bool normals = b->vertex_count && !b->lacks_normals;
    if (b->failed)
        return csg_builder_why_failed(b);
    csgm_status status = csg_mesh_create(b->context, b->vertex_count, b->triangle_count, normals,
                                         b->colors != NULL, &mesh);
    if (status)
        return status;
    status = add_parts(b, mesh);
    if (!status)
        status = add_rest(b, mesh);
    if (status) {
        csg_mesh_destroy(mesh);
        return status;
    }
    mesh->origin = choose_origin(b);
    const double *origin = &mesh->origin.x;
    bool moved = origin[0] != 0 || origin[1] != 0 || origin[2] != 0;
    for (size_t i = 0; i < 3 * b->vertex_count; i++) /* -0 - 0 is -0: no bit is lost */
        mesh->positions[i] = (float)(moved ? b->positions[i] - origin[i % 3] : b->positions[i]);
    for (size_t i = 0; normals && i < 3 * b->vertex_count; i++)
        mesh->normals[i] = isfinite(b->normals[i]) ? b->normals[i] : 0;
    if (b->colors)
        memcpy(mesh->colors, b->colors, b->vertex_count * 4);
    if (b->triangle_count)
        memcpy(mesh->indices, b->indices, b->triangle_count * 3 * sizeof(uint32_t));
    csg_builder_release(b);
    *out = mesh;
    return CSGM_OK;
}
