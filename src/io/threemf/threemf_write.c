/* SPDX-License-Identifier: MIT
 * Mesh -> 3MF: a ZIP of the model's XML and the two small files that say where it is. An object for
 * each part, and as many items to build. A part of one colour has a base material, which its object
 * names; where colours change, a colour group holds them and triangles name them corner by corner.
 * Metallic and roughness stand in the base material's name: lib3mf, which most programs read with,
 * refuses the elements that the material extension has for them. Text is made and compressed piece
 * by piece, by all threads. Normals are not kept: the format has none.
 */
#include "base/table.h"
#include "io/looks.h"
#include "io/metadata.h"
#include "io/reader.h"
#include "io/threemf/threemf_package.h"
#include "io/units.h"
#include "io/writers.h"

enum { PIECE = 2048 }; /* lines; the longest has less than 128 bytes */
_Static_assert(PIECE * 128 <= CSG_ZIP_PIECE_BYTES, "a piece's text fits");

enum { BASES_ID = 1, COLORS_ID = 2, FIRST_OBJECT_ID = 3 };

/* The distinct colours of vertices, and each vertex's among them. */
typedef struct palette {
    uint32_t *colors;
    uint32_t *of_vertex; /* of parts whose vertices have their own */
    csg_table table;     /* of the colours */
    size_t color_count, color_room;
} palette;

/* The distinct looks of parts of one colour, and the look of each part. */
typedef struct bases {
    csg_part_look *looks;
    uint32_t *number; /* of each part's among the looks; NO_BASE: its vertices have their own */
    size_t look_count, look_room, part_count;
} bases;

#define NO_BASE UINT32_MAX

typedef struct model {
    csg_zip *zip;
    const csgm_mesh_view *mesh;
    palette palette;
    bases bases;
    csg_part_stretch part; /* being written */
    bool is_painted;       /* it: its vertices have their own colours */
    bool offset;
} model;

/* ---- looks ------------------------------------------------------------------------------------
 */

static uint64_t hash_color(const void *colors, uint32_t number)
{
    return ((const uint32_t *)colors)[number];
}

static bool number_color(palette *p, csg_memory *memory, uint32_t color, uint32_t *number)
{
    if (!csg_table_reserve(&p->table, p->color_count + 1, hash_color, p->colors) ||
        !csg_memory_reserve(memory, (void **)&p->colors, &p->color_room, p->color_count + 1,
                            sizeof *p->colors))
        return false;
    size_t slot;
    *number = csg_table_first(&p->table, color, &slot);
    while (*number != CSG_TABLE_NONE && p->colors[*number] != color)
        *number = csg_table_next(&p->table, &slot);
    if (*number == CSG_TABLE_NONE) {
        *number = (uint32_t)p->color_count++;
        p->colors[*number] = color;
        csg_table_put(&p->table, slot, *number);
    }
    return true;
}

static bool collect_colors(palette *p, csg_memory *memory, const csgm_mesh_view *mesh,
                           const csg_part_stretch *part)
{
    if (!p->of_vertex) {
        csg_table_init(&p->table, memory);
        p->of_vertex = csg_memory_alloc(memory, mesh->vertex_count * sizeof *p->of_vertex);
    }
    for (uint64_t i = 0; p->of_vertex && i < part->vertex_count; i++) {
        uint64_t vertex = part->first_vertex + i;
        if (!number_color(p, memory, csg_load_u32(mesh->colors + 4 * vertex),
                          &p->of_vertex[vertex]))
            return false;
    }
    return p->of_vertex != NULL;
}

static bool number_look(bases *b, csg_memory *memory, const csg_part_look *look, uint32_t *number)
{
    for (*number = 0; *number < b->look_count; ++*number)
        if (csg_look_is(&b->looks[*number], look))
            return true;
    if (!csg_memory_reserve(memory, (void **)&b->looks, &b->look_room, b->look_count + 1,
                            sizeof *b->looks))
        return false;
    b->looks[b->look_count++] = *look;
    return true;
}

static bool collect_looks(model *m, csg_memory *memory)
{
    bases *b = &m->bases;
    b->part_count = (size_t)csg_part_count(m->mesh);
    b->number = csg_memory_alloc(memory, b->part_count * sizeof *b->number);
    bool good = b->number;
    for (uint64_t i = 0; good && i < b->part_count; i++) {
        csg_part_stretch part = csg_part_get(m->mesh, i);
        csg_part_look look = csg_look_of(m->mesh, &part);
        b->number[i] = NO_BASE;
        if (look.each_color)
            good = collect_colors(&m->palette, memory, m->mesh, &part);
        else
            good = number_look(b, memory, &look, &b->number[i]);
    }
    return good;
}

static void release_looks(model *m, csg_memory *memory)
{
    palette *p = &m->palette;
    bases *b = &m->bases;
    csg_memory_release(memory, p->colors, p->color_room * sizeof *p->colors);
    if (p->of_vertex)
        csg_table_release(&p->table);
    csg_memory_release(memory, p->of_vertex, m->mesh->vertex_count * sizeof *p->of_vertex);
    csg_memory_release(memory, b->looks, b->look_room * sizeof *b->looks);
    csg_memory_release(memory, b->number, b->part_count * sizeof *b->number);
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

/* "#RRGGBBAA" */
static char *put_color(char *at, uint32_t color)
{
    static const char digits[] = "0123456789ABCDEF";
    *at++ = '#';
    for (int k = 0; k < 4; k++) {
        *at++ = digits[color >> (8 * k + 4) & 15];
        *at++ = digits[color >> 8 * k & 15];
    }
    return at;
}

static size_t color_piece(void *user, uint64_t piece, char *text)
{
    const palette *p = &((model *)user)->palette;
    char *at = text;
    for (uint64_t i = piece * PIECE; i < end_of(piece, p->color_count); i++) {
        at = put_color(put_text(at, "<m:color color=\""), p->colors[i]);
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
    const uint32_t *looks = m->is_painted ? m->palette.of_vertex : NULL;
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

/* What has no colour is light gray. */
static void put_looks(model *m)
{
    static const uint8_t gray[4] = {199, 199, 204, 255};
    char text[CSG_LOOK_NAME_MOST];
    if (m->bases.look_count)
        put_id(m, "<basematerials id=\"", BASES_ID, "\">\n");
    for (size_t i = 0; i < m->bases.look_count; i++) {
        const csg_part_look *look = &m->bases.looks[i];
        csg_look_name(look, text);
        put_xml(m, "<base name=\"");
        put_xml(m, text);
        put_xml(m, "\" displaycolor=\"");
        *put_color(text, csg_load_u32(look->is_colored ? look->color : gray)) = '\0';
        put_xml(m, text);
        put_xml(m, "\"/>\n");
    }
    if (m->bases.look_count)
        put_xml(m, "</basematerials>\n");
    if (!m->palette.color_count)
        return;
    put_id(m, "<m:colorgroup id=\"", COLORS_ID, "\">\n");
    put_pieces(m, m->palette.color_count, color_piece);
    put_xml(m, "</m:colorgroup>\n");
}

/* By the names that 3MF knows; it takes no others without a namespace of their own. */
static void put_metadata(model *m, const csgm_write_options *options)
{
    static const char *const names[][2] = {
        {"title", "Title"},         {"author", "Designer"},      {"description", "Description"},
        {"copyright", "Copyright"}, {"license", "LicenseTerms"}, {"rating", "Rating"}};
    for (size_t i = 0; i < options->metadata_count; i++) {
        csg_metadata data = csg_metadata_split(options->metadata[i]);
        for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
            if (!csg_metadata_is(&data, names[k][0]) || csg_metadata_recurs(options, i))
                continue;
            put_xml(m, "<metadata name=\"");
            put_xml(m, names[k][1]);
            put_xml(m, "\">");
            put_escaped(m, data.value);
            put_xml(m, "</metadata>\n");
        }
    }
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
    m->is_painted = false;
    if (m->bases.number) {
        uint32_t base = m->bases.number[index];
        m->is_painted = base == NO_BASE;
        put_id(m, " pid=\"", m->is_painted ? COLORS_ID : BASES_ID, "\"");
        put_id(m, " pindex=\"", m->is_painted ? 0 : base, "\"");
    }
    put_xml(m, ">\n<mesh>\n<vertices>\n");
    put_pieces(m, m->part.vertex_count, vertex_piece);
    put_xml(m, "</vertices>\n<triangles>\n");
    put_pieces(m, m->part.triangle_count, triangle_piece);
    put_xml(m, "</triangles>\n</mesh>\n</object>\n");
}

static void put_model(model *m, const csgm_write_options *options)
{
    uint64_t count = m->mesh->triangle_count ? csg_part_count(m->mesh) : 0;
    put_xml(m, CSG_XML_HEAD "<model unit=\"");
    put_xml(m, csg_unit_name(options->unit));
    put_xml(m, "\" " CSG_3MF_CORE " "
               "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/"
               "02\">\n" CSG_3MF_APPLICATION);
    put_metadata(m, options);
    put_xml(m, "<resources>\n");
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

csgm_status csg_3mf_write(csg_sink *sink, const csgm_mesh_view *mesh,
                          const csgm_write_options *options)
{
    csg_memory *memory = &sink->context->memory;
    model m = {.mesh = mesh, .offset = csg_view_is_offset(mesh)};
    csgm_status status = CSGM_OK;
    bool looks = mesh->vertex_count && (mesh->colors || mesh->materials);
    if (looks && !collect_looks(&m, memory))
        status = csg_context_no_memory(sink->context);
    if (!status)
        status = csg_zip_create(sink, &m.zip);
    if (!status) {
        csg_3mf_begin(m.zip);
        put_model(&m, options);
        status = csg_zip_finish(m.zip);
        if (status)
            csg_write_refuse(sink, "write PLY instead, which has no such limit",
                             "the model is larger than the 4 GiB that 3MF files may hold here");
    }
    csg_zip_destroy(m.zip);
    release_looks(&m, memory);
    return status;
}
