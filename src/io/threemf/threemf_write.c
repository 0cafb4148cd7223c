/* SPDX-License-Identifier: MIT
 * Mesh -> 3MF: a ZIP of the model's XML and the two small files that say where it is. An object for
 * each part, and as many items to build. Vertex colours become a colour group that triangles name
 * corner by corner; with materials, each colour has its metallic and roughness beside it. Text is
 * made and compressed piece by piece, by all threads. Normals are not kept: the format has none.
 */
#include "base/table.h"
#include "io/parts.h"
#include "io/reader.h"
#include "io/threemf/zip_write.h"
#include "io/writers.h"

enum { PIECE = 2048 }; /* lines; the longest has less than 128 bytes */
_Static_assert(PIECE * 128 <= CSG_ZIP_PIECE_BYTES, "a piece's text fits");

enum { COLORS_ID = 1, DISPLAY_ID = 2, FIRST_OBJECT_ID = 3 };

/* The distinct looks (colour, metallic, roughness), and each vertex's among them. */
typedef struct palette {
    uint64_t *looks;
    uint32_t *of_vertex;
    csg_table table; /* of the looks */
    size_t look_count, look_room;
} palette;

typedef struct model {
    csg_zip *zip;
    const csgm_mesh_view *mesh;
    palette palette;
    csg_part_stretch part; /* being written */
    bool offset;
} model;

/* ---- looks ------------------------------------------------------------------------------------
 */

static uint64_t look_of(const csgm_mesh_view *mesh, uint64_t vertex)
{
    static const uint8_t gray[4] = {199, 199, 204, 255};
    const uint8_t *color = mesh->colors ? mesh->colors + 4 * vertex : gray;
    uint64_t metallic = CSG_MATERIAL_METALLIC, roughness = CSG_MATERIAL_ROUGHNESS;
    if (mesh->materials) {
        metallic = mesh->materials[2 * vertex];
        roughness = mesh->materials[2 * vertex + 1];
    }
    return roughness << 48 | metallic << 32 | csg_load_u32(color);
}

static uint64_t hash_look(const void *looks, uint32_t number)
{
    return ((const uint64_t *)looks)[number];
}

static bool number_look(palette *p, csg_memory *memory, uint64_t look, uint32_t *number)
{
    if (!csg_table_reserve(&p->table, p->look_count + 1, hash_look, p->looks) ||
        !csg_memory_reserve(memory, (void **)&p->looks, &p->look_room, p->look_count + 1,
                            sizeof *p->looks))
        return false;
    size_t slot;
    *number = csg_table_first(&p->table, look, &slot);
    while (*number != CSG_TABLE_NONE && p->looks[*number] != look)
        *number = csg_table_next(&p->table, &slot);
    if (*number == CSG_TABLE_NONE) {
        *number = (uint32_t)p->look_count++;
        p->looks[*number] = look;
        csg_table_put(&p->table, slot, *number);
    }
    return true;
}

static bool collect_looks(palette *p, csg_memory *memory, const csgm_mesh_view *mesh)
{
    csg_table_init(&p->table, memory);
    p->of_vertex = csg_memory_alloc(memory, mesh->vertex_count * sizeof *p->of_vertex);
    for (uint64_t i = 0; p->of_vertex && i < mesh->vertex_count; i++)
        if (!number_look(p, memory, look_of(mesh, i), &p->of_vertex[i]))
            return false;
    return p->of_vertex != NULL;
}

static void release_palette(palette *p, csg_memory *memory, uint64_t vertex_count)
{
    csg_memory_release(memory, p->looks, p->look_room * sizeof *p->looks);
    csg_table_release(&p->table);
    csg_memory_release(memory, p->of_vertex, vertex_count * sizeof *p->of_vertex);
}

/* ---- pieces of text ---------------------------------------------------------------------------
 */

static char *put_text(char *at, const char *text)
{
    size_t length = strlen(text);
    memcpy(at, text, length);
    return at + length;
}

static char *put_number(char *at, const char *before, uint64_t value)
{
    return csg_number_put_u64(put_text(at, before), value);
}

static uint64_t end_of(uint64_t piece, uint64_t count)
{
    return (piece + 1) * PIECE < count ? (piece + 1) * PIECE : count;
}

static size_t color_piece(void *user, uint64_t piece, char *text)
{
    static const char digits[] = "0123456789ABCDEF";
    const palette *p = &((model *)user)->palette;
    char *at = text;
    for (uint64_t i = piece * PIECE; i < end_of(piece, p->look_count); i++) {
        at = put_text(at, "<m:color color=\"#");
        for (int k = 0; k < 4; k++) {
            *at++ = digits[p->looks[i] >> (8 * k + 4) & 15];
            *at++ = digits[p->looks[i] >> 8 * k & 15];
        }
        at = put_text(at, "\"/>\n");
    }
    return (size_t)(at - text);
}

static size_t display_piece(void *user, uint64_t piece, char *text)
{
    const palette *p = &((model *)user)->palette;
    char *at = text;
    for (uint64_t i = piece * PIECE; i < end_of(piece, p->look_count); i++) {
        at = put_number(at, "<m:pbmetallic name=\"", i);
        at = put_text(at, "\" metallicness=\"");
        at =
            csg_number_put_float(at, (float)(p->looks[i] >> 32 & 0xFFFF) / (float)CSG_MATERIAL_ONE);
        at = put_text(at, "\" roughness=\"");
        at = csg_number_put_float(at, (float)(p->looks[i] >> 48) / (float)CSG_MATERIAL_ONE);
        at = put_text(at, "\"/>\n");
    }
    return (size_t)(at - text);
}

static size_t vertex_piece(void *user, uint64_t piece, char *text)
{
    static const char *const before[3] = {"<vertex x=\"", "\" y=\"", "\" z=\""};
    const model *m = user;
    char *at = text;
    for (uint64_t i = piece * PIECE; i < end_of(piece, m->part.vertex_count); i++) {
        for (int k = 0; k < 3; k++)
            at = csg_put_coordinate(put_text(at, before[k]), m->mesh, m->part.first_vertex + i, k,
                                    m->offset);
        at = put_text(at, "\"/>\n");
    }
    return (size_t)(at - text);
}

/* Corners of one look need it once. */
static size_t triangle_piece(void *user, uint64_t piece, char *text)
{
    static const char *const vertex[3] = {"<triangle v1=\"", "\" v2=\"", "\" v3=\""};
    static const char *const look[3] = {"\" p1=\"", "\" p2=\"", "\" p3=\""};
    const model *m = user;
    const uint32_t *looks = m->palette.of_vertex;
    char *at = text;
    for (uint64_t i = piece * PIECE; i < end_of(piece, m->part.triangle_count); i++) {
        const uint32_t *corner = m->mesh->indices + 3 * (m->part.first_triangle + i);
        for (int k = 0; k < 3; k++)
            at = put_number(at, vertex[k], corner[k] - m->part.first_vertex);
        if (looks) {
            uint32_t first = looks[corner[0]];
            bool same = looks[corner[1]] == first && looks[corner[2]] == first;
            for (int k = 0; k < (same ? 1 : 3); k++)
                at = put_number(at, look[k], looks[corner[k]]);
        }
        at = put_text(at, "\"/>\n");
    }
    return (size_t)(at - text);
}

static void put_pieces(model *m, uint64_t lines, csg_zip_piece_fn *piece)
{
    csg_zip_pieces(m->zip, (lines + PIECE - 1) / PIECE, piece, m);
}

/* ---- the model --------------------------------------------------------------------------------
 */

static void put_xml(model *m, const char *text)
{
    csg_zip_text(m->zip, text, strlen(text));
}

static void put_id(model *m, const char *before, uint64_t id, const char *after)
{
    char text[CSG_NUMBER_MOST];
    put_xml(m, before);
    csg_zip_text(m->zip, text, (size_t)(csg_number_put_u64(text, id) - text));
    put_xml(m, after);
}

/* XML has no way to write most control characters: they become spaces. */
static void put_escaped(model *m, const char *text)
{
    for (; *text; text++) {
        const char *escape = *text == '&'   ? "&amp;"
                             : *text == '<' ? "&lt;"
                             : *text == '>' ? "&gt;"
                             : *text == '"' ? "&quot;"
                                            : NULL;
        char plain = (unsigned char)*text < ' ' ? ' ' : *text;
        if (escape)
            put_xml(m, escape);
        else
            csg_zip_text(m->zip, &plain, 1);
    }
}

static const char *unit_name(csgm_unit unit)
{
    switch (unit) {
    case CSGM_UNIT_CM:
        return "centimeter";
    case CSGM_UNIT_M:
        return "meter";
    case CSGM_UNIT_IN:
        return "inch";
    case CSGM_UNIT_NONE:
    case CSGM_UNIT_MM:
        break;
    }
    return "millimeter";
}

static void put_looks(model *m)
{
    if (m->mesh->materials) {
        put_id(m, "<m:pbmetallicdisplayproperties id=\"", DISPLAY_ID, "\">\n");
        put_pieces(m, m->palette.look_count, display_piece);
        put_xml(m, "</m:pbmetallicdisplayproperties>\n");
    }
    put_id(m, "<m:colorgroup id=\"", COLORS_ID, "\"");
    if (m->mesh->materials)
        put_id(m, " displaypropertiesid=\"", DISPLAY_ID, "\"");
    put_xml(m, ">\n");
    put_pieces(m, m->palette.look_count, color_piece);
    put_xml(m, "</m:colorgroup>\n");
}

static void put_object(model *m, uint64_t index)
{
    m->part = csg_part_get(m->mesh, index);
    put_id(m, "<object id=\"", FIRST_OBJECT_ID + index, "\" type=\"model\"");
    if (m->part.name && *m->part.name) {
        put_xml(m, " name=\"");
        put_escaped(m, m->part.name);
        put_xml(m, "\"");
    }
    if (m->palette.of_vertex)
        put_id(m, " pid=\"", COLORS_ID, "\" pindex=\"0\"");
    put_xml(m, ">\n<mesh>\n<vertices>\n");
    put_pieces(m, m->part.vertex_count, vertex_piece);
    put_xml(m, "</vertices>\n<triangles>\n");
    put_pieces(m, m->part.triangle_count, triangle_piece);
    put_xml(m, "</triangles>\n</mesh>\n</object>\n");
}

static void put_model(model *m, csgm_unit unit)
{
    uint64_t count = m->mesh->triangle_count ? csg_part_count(m->mesh) : 0;
    put_xml(m, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"");
    put_xml(m, unit_name(unit));
    put_xml(m, "\" xml:lang=\"en-US\" "
               "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
               "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\">\n"
               "<metadata name=\"Application\">" CSG_WRITTEN_BY "</metadata>\n<resources>\n");
    if (m->palette.of_vertex)
        put_looks(m);
    for (uint64_t i = 0; i < count; i++)
        if (!m->mesh->part_count || m->mesh->parts[i].triangle_count)
            put_object(m, i);
    put_xml(m, "</resources>\n<build>\n");
    for (uint64_t i = 0; i < count; i++)
        if (!m->mesh->part_count || m->mesh->parts[i].triangle_count)
            put_id(m, "<item objectid=\"", FIRST_OBJECT_ID + i, "\"/>\n");
    put_xml(m, "</build>\n</model>\n");
}

static void put_small_files(model *m)
{
    csg_zip_file(m->zip, "[Content_Types].xml");
    put_xml(m,
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\n"
            "<Default Extension=\"rels\" "
            "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\n"
            "<Default Extension=\"model\" "
            "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>\n</Types>\n");
    csg_zip_file(m->zip, "_rels/.rels");
    put_xml(
        m,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\n"
        "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
        "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>\n"
        "</Relationships>\n");
}

csgm_status csg_3mf_write(csg_sink *sink, const csgm_mesh_view *mesh,
                          const csgm_write_options *options)
{
    csg_memory *memory = &sink->context->memory;
    model m = {.mesh = mesh, .offset = csg_view_is_offset(mesh)};
    csgm_status status = CSGM_OK;
    bool looks = mesh->vertex_count && (mesh->colors || mesh->materials);
    if (looks && !collect_looks(&m.palette, memory, mesh))
        status = csg_context_no_memory(sink->context);
    if (!status)
        status = csg_zip_create(sink, &m.zip);
    if (!status) {
        put_small_files(&m);
        csg_zip_file(m.zip, "3D/3dmodel.model");
        put_model(&m, options->unit);
        status = csg_zip_finish(m.zip);
        if (status)
            csg_write_refuse(sink, "write PLY instead, which has no such limit",
                             "the model is larger than the 4 GiB that 3MF files may hold here");
    }
    csg_zip_destroy(m.zip);
    release_palette(&m.palette, memory, mesh->vertex_count);
    return status;
}
