/* SPDX-License-Identifier: MIT
 * Mesh -> Wavefront OBJ: v (with r g b in 0..1 appended, a common extension, where parts have
 * several colours), vn, "o name" and "usemtl name" before the faces of a part, and f with vertex
 * and normal of the same number. Materials stand in a file beside it (mtl.h); where none can stand
 * there, as beside a pipe, all colours follow the coordinates. Numbers are the shortest that read
 * back as the same float. Written directly: OpenMesh takes several times as long (README.md).
 */
#include "io/formats/mtl.h"
#include "io/writers.h"
#include "mesh/weld.h"

typedef struct obj {
    csg_sink *sink;
    const csgm_mesh_view *mesh;
    uint32_t *number; /* NULL, or of each vertex that of its v line */
    csg_mtl mtl;      /* looks NULL: no materials are written */
    bool has_colors;  /* v lines have */
    uint8_t *painted; /* NULL, or of each vertex whether its colour is its own; else it is white */
} obj;

/* Vertices of a mesh that is split at creases are written once per place: OBJ numbers positions and
 * normals apart. */
static void put_vertices(const obj *o)
{
    csg_sink *sink = o->sink;
    const csgm_mesh_view *mesh = o->mesh;
    const uint32_t *number = o->number;
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
        bool own = !o->painted || o->painted[i];
        for (uint64_t k = 0; o->has_colors && k < 3; k++) {
            *at++ = ' ';
            at = csg_number_put_float(at, own ? (float)mesh->colors[4 * i + k] / 255.0f : 1);
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
    if (failed) {
        csg_memory_release(memory, number, (mesh->vertex_count + 1) * sizeof *number);
        return NULL;
    }
    uint32_t next = 0;
    for (uint64_t i = 0; i < mesh->vertex_count; i++)
        number[i] = number[i] == i ? next++ : number[i - 1];
    return number;
}

static void put_material(const obj *o, uint64_t part)
{
    char name[CSG_MTL_NAME_MOST];
    if (!o->mtl.looks)
        return;
    csg_mtl_name(&o->mtl.looks[part], name);
    csg_sink_format(o->sink, "usemtl %s\n", name);
}

static void put_mesh(const obj *o)
{
    csg_sink *sink = o->sink;
    const csgm_mesh_view *mesh = o->mesh;
    put_vertices(o);
    if (mesh->normals)
        put_normals(sink, mesh);
    if (!mesh->part_count) {
        put_material(o, 0);
        put_faces(sink, mesh, o->number, 0, mesh->triangle_count);
    }
    for (uint64_t i = 0; i < mesh->part_count; i++) {
        put_part_name(sink, mesh, i);
        put_material(o, i);
        put_faces(sink, mesh, o->number, mesh->parts[i].first_triangle,
                  mesh->parts[i].triangle_count);
    }
}

/* Which vertices belong to parts of several colours, where others have one for all. */
static csgm_status mark_painted(obj *o)
{
    csg_memory *memory = &o->sink->context->memory;
    bool all = true;
    for (size_t i = 0; i < o->mtl.count; i++)
        all &= o->mtl.looks[i].each_color;
    if (all || !o->has_colors)
        return CSGM_OK;
    o->painted = csg_memory_alloc(memory, o->mesh->vertex_count + 1);
    if (!o->painted)
        return csg_context_no_memory(o->sink->context);
    memset(o->painted, 0, o->mesh->vertex_count);
    for (size_t i = 0; i < o->mtl.count; i++) {
        csg_part_stretch part = csg_part_get(o->mesh, i);
        if (o->mtl.looks[i].each_color)
            memset(o->painted + part.first_vertex, 1, part.vertex_count);
    }
    return CSGM_OK;
}

static csgm_status add_materials(obj *o, const csgm_write_options *options)
{
    csgm_status status = csg_mtl_make(o->sink->context, o->mesh, &o->mtl);
    if (status)
        return status;
    if (!o->mtl.says_more) {
        csg_mtl_release(o->sink->context, &o->mtl);
        return CSGM_OK;
    }
    o->has_colors = o->mtl.each_color;
    status = csg_mtl_write(o->sink, &o->mtl, options);
    return status ? status : mark_painted(o);
}

static csgm_status write(obj *o, const csgm_write_options *options)
{
    csgm_status status = CSGM_OK;
    const csgm_mesh_view *mesh = o->mesh;
    csg_sink_format(o->sink, "# %s\n", CSG_WRITTEN_BY);
    if (o->sink->companion && mesh->triangle_count && (mesh->colors || mesh->materials))
        status = add_materials(o, options);
    if (!status && mesh->split) {
        o->number = number_places(&o->sink->context->memory, mesh);
        status = o->number ? CSGM_OK : csg_context_no_memory(o->sink->context);
    }
    if (!status)
        put_mesh(o);
    return status;
}

csgm_status csg_obj_write(csg_sink *sink, const csgm_mesh_view *mesh,
                          const csgm_write_options *options)
{
    csg_memory *memory = &sink->context->memory;
    obj o = {.sink = sink, .mesh = mesh, .has_colors = mesh->colors != NULL};
    csgm_status status = write(&o, options);
    csg_memory_release(memory, o.number, (mesh->vertex_count + 1) * sizeof *o.number);
    csg_memory_release(memory, o.painted, mesh->vertex_count + 1);
    csg_mtl_release(sink->context, &o.mtl);
    return status;
}
