/* SPDX-License-Identifier: MIT
 * Layout -> glTF 2.0 JSON by hand: the document is small and fixed in shape. Numbers are shortest
 * round-trip text; min and max are written as doubles, which are exactly the floats in the buffer.
 */
#include <stdarg.h>
#include <stdio.h>

#include "io/gltf_layout.h"

typedef struct json {
    char *text;
    size_t length;
} json;

static void put(json *j, const char *format, ...) __attribute__((format(printf, 2, 3)));

static void put(json *j, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(j->text + j->length, CSG_GLTF_JSON_MOST - j->length, format, arguments);
    va_end(arguments);
    if (length > 0)
        j->length += (size_t)length;
}

static void put_numbers(json *j, const char *key, const double *values, int count)
{
    put(j, "\"%s\":[", key);
    for (int i = 0; i < count; i++) {
        char *at = j->text + j->length;
        if (i)
            *at++ = ',';
        j->length = (size_t)(csg_number_put_double(at, values[i] + 0.0) - j->text);
    }
    put(j, "]");
}

static bool is_identity(const double *matrix)
{
    for (int i = 0; i < 16; i++)
        if (matrix[i] != (i % 5 == 0 ? 1.0 : 0.0))
            return false;
    return true;
}

static void put_scene(json *j, const csg_gltf_layout *layout)
{
    put(j, "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0");
    if (!is_identity(layout->matrix)) {
        put(j, ",");
        put_numbers(j, "matrix", layout->matrix, 16);
    }
    put(j, "}],");
}

/* Accessors stand in a fixed order: POSITION, NORMAL, COLOR_0, indices; absent ones close up. */
static void put_mesh(json *j, const csg_gltf_layout *layout)
{
    const csg_draco_encoded *draco = layout->draco;
    int next = 1;
    put(j, "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0");
    if (layout->normals)
        put(j, ",\"NORMAL\":%d", next++);
    if (layout->colors)
        put(j, ",\"COLOR_0\":%d", next++);
    put(j, "},\"indices\":%d,\"material\":0", next);
    if (draco) {
        put(j,
            ",\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":0,"
            "\"attributes\":{\"POSITION\":%u",
            draco->position_id);
        if (layout->normals)
            put(j, ",\"NORMAL\":%u", draco->normal_id);
        if (layout->colors)
            put(j, ",\"COLOR_0\":%u", draco->color_id);
        put(j, "}}}");
    }
    put(j, "}]}],");
}

static void put_material(json *j, const csg_gltf_layout *layout)
{
    put(j,
        "\"materials\":[{\"pbrMetallicRoughness\":{%s\"metallicFactor\":0,"
        "\"roughnessFactor\":0.6}%s}],",
        layout->colors ? "" : "\"baseColorFactor\":[0.8,0.8,0.8,1],",
        layout->opaque ? "" : ",\"alphaMode\":\"BLEND\"");
}

/* view < 0: the values are in the compressed buffer. */
static void put_accessor(json *j, int view, int component, uint64_t count, const char *type,
                         const char *more)
{
    put(j, "{");
    if (view >= 0)
        put(j, "\"bufferView\":%d,", view);
    put(j, "\"componentType\":%d,\"count\":%llu,\"type\":\"%s\"%s", component,
        (unsigned long long)count, type, more);
}

static void put_accessors(json *j, const csg_gltf_layout *layout)
{
    double min[3], max[3];
    for (int k = 0; k < 3; k++) {
        min[k] = (double)layout->min[k];
        max[k] = (double)layout->max[k];
    }
    int view = layout->draco ? -4 : 0; /* stays negative: no view */
    put(j, "\"accessors\":[");
    put_accessor(j, view++, CSG_GLTF_FLOAT, layout->vertex_count, "VEC3", ",");
    put_numbers(j, "max", max, 3);
    put(j, ",");
    put_numbers(j, "min", min, 3);
    put(j, "},");
    if (layout->normals) {
        put_accessor(j, view++, CSG_GLTF_FLOAT, layout->vertex_count, "VEC3", "},");
    }
    if (layout->colors)
        put_accessor(j, view++,
                     layout->wide_colors ? CSG_GLTF_UNSIGNED_SHORT : CSG_GLTF_UNSIGNED_BYTE,
                     layout->vertex_count, "VEC4", ",\"normalized\":true},");
    put_accessor(j, view, layout->short_indices ? CSG_GLTF_UNSIGNED_SHORT : CSG_GLTF_UNSIGNED_INT,
                 layout->index_count, "SCALAR", "}],");
}

static void put_view(json *j, uint64_t offset, uint64_t bytes, int target)
{
    put(j, "{\"buffer\":0,\"byteLength\":%llu", (unsigned long long)bytes);
    if (offset)
        put(j, ",\"byteOffset\":%llu", (unsigned long long)offset);
    if (target)
        put(j, ",\"target\":%d", target);
    put(j, "}");
}

static void put_views(json *j, const csg_gltf_layout *layout)
{
    put(j, "\"bufferViews\":[");
    if (layout->draco) {
        put_view(j, 0, layout->draco->size_bytes, 0);
    } else {
        const uint64_t parts[3] = {layout->position_bytes, layout->normal_bytes,
                                   layout->color_bytes};
        uint64_t offset = 0;
        for (int i = 0; i < 3; offset += parts[i], i++) {
            if (!parts[i])
                continue;
            put_view(j, offset, parts[i], CSG_GLTF_VERTICES);
            put(j, ",");
        }
        put_view(j, offset, layout->index_bytes, CSG_GLTF_INDICES);
    }
    put(j, "],");
}

const char csg_gltf_json_tail[] = "\"}]}";

size_t csg_gltf_json(const csg_gltf_layout *layout, bool embedded, char text[CSG_GLTF_JSON_MOST])
{
    json j = {text, 0};
    put(&j, "{\"asset\":{\"generator\":\"" CSG_WRITTEN_BY "\",\"version\":\"2.0\"},");
    if (!layout->index_count) {
        put(&j, "\"scene\":0,\"scenes\":[{}]}");
        return j.length;
    }
    if (layout->draco)
        put(&j, "\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],"
                "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],");
    put_scene(&j, layout);
    put_mesh(&j, layout);
    put_material(&j, layout);
    put_accessors(&j, layout);
    put_views(&j, layout);
    put(&j, "\"buffers\":[{\"byteLength\":%llu", (unsigned long long)layout->buffer_bytes);
    put(&j, embedded ? ",\"uri\":\"data:application/octet-stream;base64," : "}]}");
    return j.length;
}
