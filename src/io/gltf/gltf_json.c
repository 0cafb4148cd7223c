/* SPDX-License-Identifier: MIT
 * Document -> glTF 2.0 JSON by hand: it is small and fixed in shape. Numbers are shortest
 * round-trip text; min and max are written as doubles, which are exactly the values in the buffer.
 */
#include <stdarg.h>
#include <stdio.h>

#include "io/color.h"
#include "io/gltf/gltf_document.h"
#include "io/metadata.h"
#include "io/units.h"

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

/* Between the members of an object or an array. */
static void put_comma(json *j, bool *follows)
{
    if (*follows)
        put_text(j, ",");
    *follows = true;
}

/* ---- the asset -------------------------------------------------------------------------------
 */

/* Our readers restore the scene's coordinates by what the extras say. */
static void put_asset(json *j, const csg_gltf_document *document)
{
    const csgm_write_options *options = document->options;
    put_text(j, "{\"asset\":{\"generator\":\"" CSG_WRITTEN_BY "\",\"version\":\"2.0\"");
    put_text(j, ",\"extras\":{\"unit\":\"%s\"", csg_unit_word(options->unit));
    if (!options->y_up)
        put_text(j, ",\"up\":\"z\"");
    if (options->comment) {
        put_text(j, ",\"comment\":");
        put_string(j, options->comment, 255);
    }
    for (size_t i = 0; i < options->metadata_count; i++) {
        csg_metadata row = csg_metadata_split(options->metadata[i]);
        if (csg_metadata_recurs(options, i))
            continue;
        put_text(j, ",\"%.*s\":", (int)row.key_length, row.key);
        put_string(j, row.value, SIZE_MAX);
    }
    put_text(j, "}},");
}

static const char *meshopt_name(const csg_gltf_document *document)
{
    return document->khr ? "KHR_meshopt_compression" : "EXT_meshopt_compression";
}

static void put_extensions(json *j, const csg_gltf_document *document)
{
    bool manifold = false, comma = false;
    for (size_t i = 0; i < document->mesh_count; i++)
        manifold |= document->meshes[i].manifold >= 0;
    const struct {
        bool used, required;
        const char *name;
    } rows[] = {{manifold, false, "EXT_mesh_manifold"},
                {document->level_count > 1, false, "MSFT_lod"},
                {document->draco, true, "KHR_draco_mesh_compression"},
                {document->quantized, true, "KHR_mesh_quantization"},
                {document->meshopt, true, meshopt_name(document)}};
    for (int required = 0; required < 2; required++) {
        comma = false;
        for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
            if (!rows[i].used || (required && !rows[i].required))
                continue;
            if (!comma)
                put_text(j, required ? "\"extensionsRequired\":[" : "\"extensionsUsed\":[");
            put_comma(j, &comma);
            put_text(j, "\"%s\"", rows[i].name);
        }
        put_text(j, comma ? "]," : "");
    }
}

/* ---- nodes -----------------------------------------------------------------------------------
 */

static bool is_identity(const double *matrix)
{
    for (int i = 0; i < 16; i++)
        if (matrix[i] != (i % 5 == 0 ? 1.0 : 0.0))
            return false;
    return true;
}

static void put_place(json *j, const csg_gltf_node *node, bool *comma)
{
    const double *t = node->translation;
    if (node->matrix && !is_identity(node->matrix)) {
        put_comma(j, comma);
        put_numbers(j, "matrix", node->matrix, 16);
    }
    if (t[0] != 0 || t[1] != 0 || t[2] != 0) {
        put_comma(j, comma);
        put_numbers(j, "translation", t, 3);
    }
    if (node->scale != 1) {
        const double scale[3] = {node->scale, node->scale, node->scale};
        put_comma(j, comma);
        put_numbers(j, "scale", scale, 3);
    }
}

static void put_children(json *j, const csg_gltf_document *document, size_t parent, bool *comma)
{
    bool follows = false;
    if (document->nodes[parent].parent >= 0)
        return; /* only roots have any */
    for (size_t i = parent + 1; i < document->node_count; i++) {
        if (document->nodes[i].parent != (int)parent)
            continue;
        if (!follows)
            put_comma(j, comma);
        put_text(j, follows ? ",%zu" : "\"children\":[%zu", i);
        follows = true;
    }
    put_text(j, follows ? "]" : "");
}

/* The roots behind the first are its lower levels of detail. */
static void put_levels(json *j, const csg_gltf_document *document, size_t index, bool *comma)
{
    const csg_gltf_node *node = &document->nodes[index];
    bool follows = false;
    if (document->level_count < 2 || node->parent >= 0)
        return;
    put_comma(j, comma);
    if (index) {
        put_text(j, "\"extras\":{\"error\":");
        put_number(j, node->level->error);
        put_text(j, ",\"measured\":");
        put_number(j, node->level->measured);
        put_text(j, ",\"proven\":%s}", node->level->is_proven ? "true" : "false");
        return;
    }
    put_text(j, "\"extensions\":{\"MSFT_lod\":{\"ids\":[");
    for (size_t i = 1; i < document->node_count; i++)
        if (document->nodes[i].parent < 0) {
            put_comma(j, &follows);
            put_text(j, "%zu", i);
        }
    put_text(j, "]}},\"extras\":{");
    put_numbers(j, "MSFT_screencoverage", document->coverage, (int)document->level_count);
    put_text(j, "}");
}

static void put_node(json *j, const csg_gltf_document *document, size_t index)
{
    const csg_gltf_node *node = &document->nodes[index];
    bool comma = false;
    put_text(j, index ? ",{" : "{");
    put_children(j, document, index, &comma);
    if (node->mesh >= 0) {
        put_comma(j, &comma);
        put_text(j, "\"mesh\":%d", node->mesh);
    }
    put_place(j, node, &comma);
    put_levels(j, document, index, &comma);
    if (node->more) {
        put_comma(j, &comma);
        put_text(j, "\"extras\":{\"more\":true}");
    }
    if (node->name && *node->name) {
        put_comma(j, &comma);
        put_text(j, "\"name\":");
        put_string(j, node->name, SIZE_MAX);
    }
    put_text(j, "}");
}

/* ---- meshes ----------------------------------------------------------------------------------
 */

static void put_attribute(json *j, const char *name, int number, bool *comma)
{
    if (number < 0)
        return;
    put_comma(j, comma);
    put_text(j, "\"%s\":%d", name, number);
}

/* The texture of mixed metallic and roughness comes second where there are coordinates for others.
 */
static void put_attributes(json *j, const csg_gltf_mesh *mesh, const int of[5])
{
    bool comma = false;
    put_text(j, "\"attributes\":{");
    put_attribute(j, "POSITION", of[0], &comma);
    put_attribute(j, "NORMAL", of[1], &comma);
    put_attribute(j, "COLOR_0", of[2], &comma);
    put_attribute(j, "TEXCOORD_0", mesh->uv >= 0 ? of[4] : of[3], &comma);
    put_attribute(j, "TEXCOORD_1", mesh->uv >= 0 ? of[3] : CSG_GLTF_NONE, &comma);
    put_text(j, "}");
}

static void put_draco(json *j, const csg_gltf_mesh *mesh)
{
    const int ids[5] = {(int)mesh->draco_position,
                        mesh->normal >= 0 ? (int)mesh->draco_normal : CSG_GLTF_NONE,
                        mesh->color >= 0 ? (int)mesh->draco_color : CSG_GLTF_NONE,
                        mesh->mixing >= 0 ? (int)mesh->draco_mixing : CSG_GLTF_NONE,
                        mesh->uv >= 0 ? (int)mesh->draco_uv : CSG_GLTF_NONE};
    put_text(j, ",\"extensions\":{\"KHR_draco_mesh_compression\":{\"bufferView\":%d,",
             mesh->draco_view);
    put_attributes(j, mesh, ids);
    put_text(j, "}}");
}

static void put_manifold(json *j, const csg_gltf_mesh *mesh)
{
    put_text(j,
             ",\"extensions\":{\"EXT_mesh_manifold\":{\"manifoldPrimitive\":{\"attributes\":{"
             "\"POSITION\":%d},\"indices\":%d},\"mergeIndices\":%d,\"mergeValues\":%d}}",
             mesh->position, mesh->manifold, mesh->merge_places, mesh->merge_values);
}

static void put_mesh(json *j, const csg_gltf_mesh *mesh)
{
    const int accessors[5] = {mesh->position, mesh->normal, mesh->color, mesh->mixing, mesh->uv};
    put_text(j, "{\"primitives\":[{");
    put_attributes(j, mesh, accessors);
    put_text(j, ",\"indices\":%d,\"material\":%u", mesh->indices, (unsigned)mesh->material);
    if (mesh->draco_view >= 0)
        put_draco(j, mesh);
    put_text(j, "}]");
    if (mesh->manifold >= 0)
        put_manifold(j, mesh);
    put_name(j, mesh->name);
    put_text(j, "}");
}

/* ---- materials -------------------------------------------------------------------------------
 */

static void put_short(json *j, double value)
{
    if (room(j, CSG_FIXED_MOST))
        j->length = (size_t)(csg_number_put_fixed(j->text + j->length, value, 6) - j->text);
}

/* glTF's are linear; six decimals are enough for each byte of sRGB to come back. What has no colour
 * is light gray and says so, since a reader cannot know. */
static void put_base_color(json *j, const csg_part_look *look)
{
    if (look->is_colored && look->each_color)
        return;
    put_text(j, "\"baseColorFactor\":[");
    for (int k = 0; k < 3; k++) {
        put_short(j, look->is_colored ? csg_color_linear(look->color[k]) : 0.8);
        put_text(j, ",");
    }
    put_short(j, look->is_colored ? look->color[3] / 255.0 : 1);
    put_text(j, "],");
}

static void put_material(json *j, const csg_gltf_document *document, const csg_part_look *look)
{
    char name[CSG_LOOK_NAME_MOST];
    put_text(j, "{\"pbrMetallicRoughness\":{");
    put_base_color(j, look);
    if (look->each_material) {
        put_text(j, "\"metallicRoughnessTexture\":{\"index\":0%s}",
                 document->has_uv ? ",\"texCoord\":1" : "");
    } else {
        put_text(j, "\"metallicFactor\":");
        put_number(j, look->material[0] / (double)CSG_MATERIAL_ONE);
        put_text(j, ",\"roughnessFactor\":");
        put_number(j, look->material[1] / (double)CSG_MATERIAL_ONE);
    }
    put_text(j, look->is_opaque ? "}" : "},\"alphaMode\":\"BLEND\"");
    if (!look->is_colored)
        put_text(j, ",\"extras\":{\"uncolored\":true}");
    csg_look_name(look, name);
    put_name(j, name);
    put_text(j, "}");
}

static void put_texture(json *j, const csg_gltf_document *document)
{
    if (document->image_view < 0)
        return;
    put_text(j,
             "\"textures\":[{\"sampler\":0,\"source\":0}],\"samplers\":[{\"magFilter\":9729,"
             "\"minFilter\":9729,\"wrapS\":33071,\"wrapT\":33071}],\"images\":[{\"bufferView\":%d,"
             "\"mimeType\":\"image/png\"}],",
             document->image_view);
}

/* ---- accessors and views ---------------------------------------------------------------------
 */

static void put_sparse(json *j, const csg_gltf_document *document, const csg_gltf_accessor *a)
{
    const csg_gltf_accessor *places = &document->accessors[a->sparse_places];
    const csg_gltf_accessor *values = &document->accessors[a->sparse_values];
    put_text(j, ",\"sparse\":{\"count\":%llu,\"indices\":{\"bufferView\":%d,\"byteOffset\":%llu,",
             (unsigned long long)a->sparse_count, places->view, (unsigned long long)places->offset);
    put_text(j, "\"componentType\":%d},\"values\":{\"bufferView\":%d,\"byteOffset\":%llu}}",
             places->component, values->view, (unsigned long long)values->offset);
}

static void put_accessor(json *j, const csg_gltf_document *document, const csg_gltf_accessor *a)
{
    put_text(j, "{");
    if (a->view >= 0)
        put_text(j, "\"bufferView\":%d,", a->view);
    if (a->view >= 0 && a->offset)
        put_text(j, "\"byteOffset\":%llu,", (unsigned long long)a->offset);
    put_text(j, "\"componentType\":%d,\"count\":%llu,\"type\":\"%s\"", a->component,
             (unsigned long long)a->count, a->type);
    if (a->normalized)
        put_text(j, ",\"normalized\":true");
    if (a->has_range) {
        put_text(j, ",");
        put_numbers(j, "max", a->max, 3);
        put_text(j, ",");
        put_numbers(j, "min", a->min, 3);
    }
    if (a->sparse_count)
        put_sparse(j, document, a);
    put_text(j, "}");
}

static void put_packed(json *j, const csg_gltf_document *document, const csg_gltf_view *view)
{
    put_text(j,
             ",\"extensions\":{\"%s\":{\"buffer\":0,\"byteOffset\":%llu,"
             "\"byteLength\":%llu,\"byteStride\":%u,\"count\":%llu,\"mode\":\"%s\"",
             meshopt_name(document), (unsigned long long)view->packed_offset,
             (unsigned long long)view->packed_bytes, (unsigned)view->packed_stride,
             (unsigned long long)view->packed_count, view->mode);
    if (view->filter)
        put_text(j, ",\"filter\":\"%s\"", view->filter);
    put_text(j, "}}");
}

static void put_view(json *j, const csg_gltf_document *document, const csg_gltf_view *view)
{
    put_text(j, "{\"buffer\":%d,\"byteLength\":%llu", view->mode ? 1 : 0,
             (unsigned long long)view->bytes);
    if (view->offset)
        put_text(j, ",\"byteOffset\":%llu", (unsigned long long)view->offset);
    if (view->stride)
        put_text(j, ",\"byteStride\":%u", (unsigned)view->stride);
    if (view->target)
        put_text(j, ",\"target\":%u", (unsigned)view->target);
    if (view->mode)
        put_packed(j, document, view);
    put_text(j, "}");
}

/* ---- all of it -------------------------------------------------------------------------------
 */

static void put_tables(json *j, const csg_gltf_document *document)
{
    put_text(j, "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[");
    for (size_t i = 0; i < document->node_count; i++)
        put_node(j, document, i);
    put_text(j, "],\"meshes\":[");
    for (size_t i = 0; i < document->mesh_count; i++) {
        put_text(j, i ? "," : "");
        put_mesh(j, &document->meshes[i]);
    }
    put_text(j, "],\"materials\":[");
    for (size_t i = 0; i < document->material_count; i++) {
        put_text(j, i ? "," : "");
        put_material(j, document, &document->materials[i]);
    }
    put_text(j, "],");
    put_texture(j, document);
    put_text(j, "\"accessors\":[");
    for (size_t i = 0; i < document->accessor_count; i++) {
        put_text(j, i ? "," : "");
        put_accessor(j, document, &document->accessors[i]);
    }
    put_text(j, "],\"bufferViews\":[");
    for (size_t i = 0; i < document->view_count; i++) {
        put_text(j, i ? "," : "");
        put_view(j, document, &document->views[i]);
    }
    put_text(j, "],");
}

void csg_gltf_json(const csg_gltf_document *document, bool embedded, csg_gltf_text *j)
{
    put_asset(j, document);
    if (!document->buffer_bytes) {
        put_text(j, "\"scene\":0,\"scenes\":[{}]}");
        return;
    }
    put_extensions(j, document);
    put_tables(j, document);
    put_text(j, "\"buffers\":[{\"byteLength\":%llu", (unsigned long long)document->buffer_bytes);
    if (embedded)
        put_text(j, ",\"uri\":\"data:application/octet-stream;base64,");
    else
        csg_gltf_json_tail(document, j);
}

void csg_gltf_json_tail(const csg_gltf_document *document, csg_gltf_text *j)
{
    put_text(j, "}");
    if (document->meshopt)
        put_text(j, ",{\"byteLength\":%llu,\"extensions\":{\"%s\":{\"fallback\":true}}}",
                 (unsigned long long)document->unpacked_bytes, meshopt_name(document));
    put_text(j, "]}");
}
