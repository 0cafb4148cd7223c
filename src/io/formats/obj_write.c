/* SPDX-License-Identifier: MIT
 * Mesh -> Wavefront OBJ: v (with r g b in 0..1 appended, a common extension, only when the mesh has
 * colours), vn, "o name" before the faces of a part, and f with vertex and normal of the same
 * number. Numbers are the shortest that read back as the same float. Written directly: OpenMesh
 * takes several times as long (README.md).
 */
#include "io/writers.h"
#include "mesh/weld.h"

/* Vertices of a mesh that is split at creases are written once per place: OBJ numbers positions and
 * normals apart. number[i]: the v line of vertex i, NULL where each has its own. */
static void put_vertices(csg_sink *sink, const csgm_mesh_view *mesh, const uint32_t *number)
{
    bool offset = csg_view_is_offset(mesh);
    for (uint64_t i = 0; i < mesh->vertex_count; i++) {
        if (number && i && number[i] == number[i - 1])
            continue;
        char *at = (char *)csg_sink_room(sink, 2 + 6 * (CSG_NUMBER_MOST + 1));
        *at++ = 'v';
        for (int k = 0; k < 3; k++) {
            *at++ = ' ';
            at = csg_put_coordinate(at, mesh, i, k, offset);
        }
        for (uint64_t k = 0; mesh->colors && k < 3; k++) {
            *at++ = ' ';
            at = csg_number_put_float(at, (float)mesh->colors[4 * i + k] / 255.0f);
        }
        *at++ = '\n';
        csg_sink_took(sink, at);
    }
}

static void put_normals(csg_sink *sink, const csgm_mesh_view *mesh)
{
    for (uint64_t i = 0; i < mesh->vertex_count; i++) {
        char *at = (char *)csg_sink_room(sink, 3 + 3 * (CSG_NUMBER_MOST + 1));
        *at++ = 'v';
        *at++ = 'n';
        for (uint64_t k = 0; k < 3; k++) {
            *at++ = ' ';
            at = csg_number_put_float(at, mesh->normals[3 * i + k]);
        }
        *at++ = '\n';
        csg_sink_took(sink, at);
    }
}

/* A name ends with its line; control characters become spaces. The first part needs no line where
 * it has no name. */
static void put_part_name(csg_sink *sink, const csgm_mesh_view *mesh, uint64_t index)
{
    const char *name = mesh->parts[index].name;
    if (!name || !*name) {
        if (index)
            csg_sink_format(sink, "o part%llu\n", (unsigned long long)index + 1);
        return;
    }
    csg_sink_text(sink, "o ");
    for (; *name; name++) {
        char plain = (unsigned char)*name < ' ' ? ' ' : *name;
        csg_sink_put(sink, &plain, 1);
    }
    csg_sink_text(sink, "\n");
}

static void put_faces(csg_sink *sink, const csgm_mesh_view *mesh, const uint32_t *position,
                      uint64_t first, uint64_t count)
{
    for (uint64_t i = first; i < first + count; i++) {
        char *at = (char *)csg_sink_room(sink, 2 + 6 * (CSG_NUMBER_MOST + 2));
        *at++ = 'f';
        for (uint64_t k = 0; k < 3; k++) {
            *at++ = ' ';
            uint32_t vertex = mesh->indices[3 * i + k];
            at = csg_number_put_u64(at, (uint64_t)(position ? position[vertex] : vertex) + 1);
            if (!mesh->normals)
                continue;
            *at++ = '/';
            *at++ = '/';
            at = csg_number_put_u64(at, (uint64_t)vertex + 1);
        }
        *at++ = '\n';
        csg_sink_took(sink, at);
    }
}

/* Numbers of places, in the order of their first vertices; NULL: out of memory. */
static uint32_t *number_places(csg_memory *memory, const csgm_mesh_view *mesh)
{
    uint32_t *number = csg_memory_alloc(memory, (mesh->vertex_count + 1) * sizeof *number);
    bool failed;
    if (!number)
        return NULL;
    csg_weld_map(memory, mesh, CSG_WELD_RUNS, number, &failed);
    uint32_t next = 0;
    for (uint64_t i = 0; i < mesh->vertex_count; i++)
        number[i] = number[i] == i ? next++ : number[i - 1];
    return number;
}

static void put_mesh(csg_sink *sink, const csgm_mesh_view *mesh, const uint32_t *number)
{
    csg_sink_format(sink, "# %s\n", CSG_WRITTEN_BY);
    put_vertices(sink, mesh, number);
    if (mesh->normals)
        put_normals(sink, mesh);
    if (!mesh->part_count)
        put_faces(sink, mesh, number, 0, mesh->triangle_count);
    for (uint64_t i = 0; i < mesh->part_count; i++) {
        put_part_name(sink, mesh, i);
        put_faces(sink, mesh, number, mesh->parts[i].first_triangle, mesh->parts[i].triangle_count);
    }
}

csgm_status csg_obj_write(csg_sink *sink, const csgm_mesh_view *mesh,
                          const csgm_write_options *options)
{
    (void)options; /* OBJ is text, Z up as the scene, without units */
    if (!mesh->split) {
        put_mesh(sink, mesh, NULL);
        return CSGM_OK;
    }
    csg_memory *memory = &sink->context->memory;
    uint32_t *number = number_places(memory, mesh);
    if (!number)
        return csg_context_no_memory(sink->context);
    put_mesh(sink, mesh, number);
    csg_memory_release(memory, number, (mesh->vertex_count + 1) * sizeof *number);
    return CSGM_OK;
}
