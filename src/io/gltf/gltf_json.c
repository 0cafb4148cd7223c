/* SPDX-License-Identifier: MIT
 * Layout -> glTF 2.0 JSON by hand: the document is small and fixed in shape. Numbers are shortest
 * round-trip text; min and max are written as doubles, which are exactly the floats in the buffer.
 * Parts share the buffer views of a plain buffer; a compressed one has a view for each part.
 */
#include <stdarg.h>
#include <stdio.h>

#include "io/gltf/gltf_layout.h"

typedef csg_gltf_text json;

static bool room(json *j, size_t bytes)
{
    if (!j->failed && j->memory &&
        !csg_memory_reserve(j->memory, (void **)&j->text, &j->capacity, j->length + bytes, 1))
        j->failed = true;
    return !j->failed && j->length + bytes <= j->capacity;
}

static void put_text(json *j, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Short pieces. */
static void put_text(json *j, const char *format, ...)
{
    enum { MOST = 512 };
    if (!room(j, MOST))
        return;
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(j->text + j->length, MOST, format, arguments);
    va_end(arguments);
    if (length > 0)
        j->length += (size_t)length;
}

static void put_number(json *j, double value)
{
    if (room(j, CSG_NUMBER_MOST))
        j->length = (size_t)(csg_number_put_double(j->text + j->length, value + 0.0) - j->text);
}

static void put_numbers(json *j, const char *key, const double *values, int count)
{
    put_text(j, "\"%s\":[", key);
    for (int i = 0; i < count; i++) {
        if (i)
            put_text(j, ",");
        put_number(j, values[i]);
    }
    put_text(j, "]");
}

/* In quotes; `most` bytes of it. */
static void put_string(json *j, const char *text, size_t most)
{
    put_text(j, "\"");
    for (; *text && most-- && room(j, 8); text++) {
        unsigned char c = (unsigned char)*text;
        if (c < ' ') {
            put_text(j, "\\u%04x", c);
            continue;
        }
        if (c == '"' || c == '\\')
            j->text[j->length++] = '\\';
        j->text[j->length++] = (char)c;
    }
    put_text(j, "\"");
}

static void put_name(json *j, const char *name)
{
    if (!name || !*name)
        return;
    put_text(j, ",\"name\":");
    put_string(j, name, SIZE_MAX);
}

static void put_asset(json *j, const char *comment)
{
    put_text(j, "{\"asset\":{\"generator\":\"" CSG_WRITTEN_BY "\",\"version\":\"2.0\"");
    if (comment) {
        put_text(j, ",\"extras\":{\"comment\":");
        put_string(j, comment, 255);
        put_text(j, "}");
    }
    put_text(j, "},");
}

static bool is_identity(const double *matrix)
{
    for (int i = 0; i < 16; i++)
        if (matrix[i] != (i % 5 == 0 ? 1.0 : 0.0))
            return false;
    return true;
}

/* One part is the root; several are its children. */
static void put_scene(json *j, const csg_gltf_layout *layout)
{
    bool several = layout->part_count > 1;
    put_text(j, "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{");
    if (several)
        put_text(j, "\"children\":[");
    for (uint64_t i = 0; several && i < layout->part_count; i++)
        put_text(j, "%s%llu", i ? "," : "", (unsigned long long)i + 1);
    put_text(j, several ? "]" : "\"mesh\":0");
    if (!several)
        put_name(j, csg_gltf_part_at(layout, 0)->name);
    if (!is_identity(layout->matrix)) {
        put_text(j, ",");
        put_numbers(j, "matrix", layout->matrix, 16);
    }
    put_text(j, "}");
    for (uint64_t i = 0; several && i < layout->part_count; i++) {
        put_text(j, ",{\"mesh\":%llu", (unsigned long long)i);
        put_name(j, csg_gltf_part_at(layout, i)->name);
        put_text(j, "}");
    }
    put_text(j, "],");
}

/* A part's accessors stand in a fixed order: POSITION, NORMAL, COLOR_0, TEXCOORD_0, indices; absent
 * ones close up. */
static unsigned accessors_of(const csg_gltf_layout *layout, const csg_gltf_part *part)
{
    return 2u + (layout->normals ? 1 : 0) + (layout->colors ? 1 : 0) + (part->textured ? 1 : 0);
}

static void put_compression(json *j, const csg_gltf_layout *layout, uint64_t index)
{
    const csg_gltf_part *part = csg_gltf_part_at(layout, index);
    put_text(j,
             ",\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":%llu,"
             "\"attributes\":{\"POSITION\":%u",
             (unsigned long long)index, part->draco.position_id);
    if (layout->normals)
        put_text(j, ",\"NORMAL\":%u", part->draco.normal_id);
    if (layout->colors)
        put_text(j, ",\"COLOR_0\":%u", part->draco.color_id);
    if (part->textured)
        put_text(j, ",\"TEXCOORD_0\":%u", part->draco.coordinate_id);
    put_text(j, "}}}");
}

static void put_mesh(json *j, const csg_gltf_layout *layout, uint64_t index, uint64_t accessor)
{
    const csg_gltf_part *part = csg_gltf_part_at(layout, index);
    unsigned long long next = accessor;
    put_text(j, "%s{\"primitives\":[{\"attributes\":{\"POSITION\":%llu", index ? "," : "", next++);
    if (layout->normals)
        put_text(j, ",\"NORMAL\":%llu", next++);
    if (layout->colors)
        put_text(j, ",\"COLOR_0\":%llu", next++);
    if (part->textured)
        put_text(j, ",\"TEXCOORD_0\":%llu", next++);
    put_text(j, "},\"indices\":%llu,\"material\":%u", next, part->material_index);
    if (layout->compressed)
        put_compression(j, layout, index);
    put_text(j, "}]");
    put_name(j, part->name);
    put_text(j, "}");
}

static void put_meshes(json *j, const csg_gltf_layout *layout)
{
    uint64_t accessor = 0;
    put_text(j, "\"meshes\":[");
    for (uint64_t i = 0; i < layout->part_count; i++) {
        put_mesh(j, layout, i, accessor);
        accessor += accessors_of(layout, csg_gltf_part_at(layout, i));
    }
    put_text(j, "],");
}

static void put_material(json *j, const csg_gltf_layout *layout, const csg_gltf_part *part)
{
    put_text(j, "{\"pbrMetallicRoughness\":{");
    if (!layout->colors)
        put_text(j, "\"baseColorFactor\":[0.8,0.8,0.8,1],");
    if (part->textured) {
        put_text(j, "\"metallicRoughnessTexture\":{\"index\":0}");
    } else {
        put_text(j, "\"metallicFactor\":");
        put_number(j, part->material[0] / (double)CSG_MATERIAL_ONE);
        put_text(j, ",\"roughnessFactor\":");
        put_number(j, part->material[1] / (double)CSG_MATERIAL_ONE);
    }
    put_text(j, part->opaque ? "}}" : "},\"alphaMode\":\"BLEND\"}");
}

/* In the order of their first part. */
static void put_materials(json *j, const csg_gltf_layout *layout)
{
    uint32_t next = 0;
    put_text(j, "\"materials\":[");
    for (uint64_t i = 0; i < layout->part_count; i++) {
        const csg_gltf_part *part = csg_gltf_part_at(layout, i);
        if (part->material_index != next)
            continue;
        put_text(j, next++ ? "," : "");
        put_material(j, layout, part);
    }
    put_text(j, "],");
    if (layout->textured)
        put_text(
            j,
            "\"textures\":[{\"sampler\":0,\"source\":0}],\"samplers\":[{\"magFilter\":9729,"
            "\"minFilter\":9729,\"wrapS\":33071,\"wrapT\":33071}],\"images\":[{\"bufferView\":%llu,"
            "\"mimeType\":\"image/png\"}],",
            (unsigned long long)(layout->compressed
                                     ? layout->part_count
                                     : 3u + (layout->normals ? 1 : 0) + (layout->colors ? 1 : 0)));
}

/* at: bytes from the view's begin. view < 0: the values are in the compressed buffer. */
static void put_accessor(json *j, int view, uint64_t at, int component, uint64_t count,
                         const char *type)
{
    put_text(j, "{");
    if (view >= 0)
        put_text(j, "\"bufferView\":%d,", view);
    if (view >= 0 && at)
        put_text(j, "\"byteOffset\":%llu,", (unsigned long long)at);
    put_text(j, "\"componentType\":%d,\"count\":%llu,\"type\":\"%s\"", component,
             (unsigned long long)count, type);
}

static void put_part_accessors(json *j, const csg_gltf_layout *layout, const csg_gltf_part *part)
{
    double min[3], max[3];
    for (int k = 0; k < 3; k++) {
        min[k] = (double)part->min[k];
        max[k] = (double)part->max[k];
    }
    int view = layout->compressed ? -8 : 0; /* stays negative: no view */
    uint64_t first = part->first_vertex;
    put_accessor(j, view++, 12 * first, CSG_GLTF_FLOAT, part->vertex_count, "VEC3");
    put_text(j, ",");
    put_numbers(j, "max", max, 3);
    put_text(j, ",");
    put_numbers(j, "min", min, 3);
    put_text(j, "},");
    if (layout->normals) {
        put_accessor(j, view++, 12 * first, CSG_GLTF_FLOAT, part->vertex_count, "VEC3");
        put_text(j, "},");
    }
    if (layout->colors) {
        put_accessor(j, view++, 8 * first,
                     layout->wide_colors ? CSG_GLTF_UNSIGNED_SHORT : CSG_GLTF_UNSIGNED_BYTE,
                     part->vertex_count, "VEC4");
        put_text(j, ",\"normalized\":true},");
    }
    if (part->textured) {
        put_accessor(j, view, 4 * first, CSG_GLTF_UNSIGNED_SHORT, part->vertex_count, "VEC2");
        put_text(j, ",\"normalized\":true},");
    }
    view += layout->textured ? 1 : 0;
    put_accessor(j, view, part->first_index * (layout->short_indices ? 2 : 4),
                 layout->short_indices ? CSG_GLTF_UNSIGNED_SHORT : CSG_GLTF_UNSIGNED_INT,
                 part->index_count, "SCALAR");
    put_text(j, "}");
}

static void put_accessors(json *j, const csg_gltf_layout *layout)
{
    put_text(j, "\"accessors\":[");
    for (uint64_t i = 0; i < layout->part_count; i++) {
        put_text(j, i ? "," : "");
        put_part_accessors(j, layout, csg_gltf_part_at(layout, i));
    }
    put_text(j, "],");
}

/* stride: 0 = not said; must be where several accessors of vertices share a view. */
static void put_view(json *j, uint64_t offset, uint64_t bytes, int stride, int target)
{
    put_text(j, "{\"buffer\":0,\"byteLength\":%llu", (unsigned long long)bytes);
    if (offset)
        put_text(j, ",\"byteOffset\":%llu", (unsigned long long)offset);
    if (stride)
        put_text(j, ",\"byteStride\":%d", stride);
    if (target)
        put_text(j, ",\"target\":%d", target);
    put_text(j, "}");
}

static void put_plain_views(json *j, const csg_gltf_layout *layout)
{
    static const int strides[4] = {12, 12, 8, 4};
    const uint64_t parts[4] = {layout->position_bytes, layout->normal_bytes, layout->color_bytes,
                               layout->coordinate_bytes};
    uint64_t offset = 0;
    for (int i = 0; i < 4; offset += parts[i], i++) {
        if (!parts[i])
            continue;
        put_view(j, offset, parts[i], layout->part_count > 1 ? strides[i] : 0, CSG_GLTF_VERTICES);
        put_text(j, ",");
    }
    put_view(j, offset, layout->index_bytes, 0, CSG_GLTF_INDICES);
}

static void put_views(json *j, const csg_gltf_layout *layout)
{
    put_text(j, "\"bufferViews\":[");
    if (!layout->compressed)
        put_plain_views(j, layout);
    for (uint64_t i = 0; layout->compressed && i < layout->part_count; i++) {
        const csg_gltf_part *part = csg_gltf_part_at(layout, i);
        put_text(j, i ? "," : "");
        put_view(j, part->draco_at, part->draco.size_bytes, 0, 0);
    }
    if (layout->textured) {
        put_text(j, ",");
        put_view(j, layout->buffer_bytes - layout->image_bytes, layout->image_bytes, 0, 0);
    }
    put_text(j, "],");
}

const char csg_gltf_json_tail[] = "\"}]}";

void csg_gltf_json(const csg_gltf_layout *layout, bool embedded, csg_gltf_text *j)
{
    put_asset(j, layout->comment);
    if (!layout->index_count) {
        put_text(j, "\"scene\":0,\"scenes\":[{}]}");
        return;
    }
    if (layout->compressed)
        put_text(j, "\"extensionsUsed\":[\"KHR_draco_mesh_compression\"],"
                    "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],");
    put_scene(j, layout);
    put_meshes(j, layout);
    put_materials(j, layout);
    put_accessors(j, layout);
    put_views(j, layout);
    put_text(j, "\"buffers\":[{\"byteLength\":%llu", (unsigned long long)layout->buffer_bytes);
    put_text(j, embedded ? ",\"uri\":\"data:application/octet-stream;base64," : "}]}");
}
