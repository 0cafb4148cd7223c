/* SPDX-License-Identifier: MIT
 * Mesh -> AMF (ISO/ASTM 52915) as plain XML: an object for each part, with its name, and the
 * colours of vertices. AMF has no centimetre: lengths are then written in millimetres. Normals are
 * left out: there they would bend the triangles.
 */
#include "io/metadata.h"
#include "io/parts.h"
#include "io/units.h"
#include "io/writers.h"

enum { LINE_MOST = 512 };

static char *put_text(char *at, const char *text)
{
    size_t length = strlen(text);
    memcpy(at, text, length);
    return at + length;
}

static char *put_element(char *at, const char *name, double value, bool is_float)
{
    at = put_text(put_text(put_text(at, "<"), name), ">");
    at = is_float ? csg_number_put_float(at, (float)value) : csg_number_put_double(at, value);
    return put_text(put_text(put_text(at, "</"), name), ">");
}

static void put_vertex(csg_sink *sink, const csgm_mesh_view *mesh, uint64_t vertex, double scale)
{
    static const char *const axes[3] = {"x", "y", "z"}, *const channels[4] = {"r", "g", "b", "a"};
    bool is_float = scale == 1 && !csg_view_is_offset(mesh);
    char *at = (char *)csg_sink_room(sink, LINE_MOST);
    at = put_text(at, "<vertex><coordinates>");
    for (int k = 0; k < 3; k++)
        at = put_element(at, axes[k], scale * csg_view_coordinate(mesh, vertex, k), is_float);
    at = put_text(at, "</coordinates>");
    if (mesh->colors) {
        at = put_text(at, "<color>");
        for (int k = 0; k < 4; k++)
            at = put_element(at, channels[k],
                             (double)((float)mesh->colors[4 * vertex + (uint64_t)k] / 255), true);
        at = put_text(at, "</color>");
    }
    csg_sink_took(sink, put_text(at, "</vertex>\n"));
}

static void put_triangle(csg_sink *sink, const uint32_t *corners, uint64_t first)
{
    static const char *const before[3] = {"<triangle><v1>", "</v1><v2>", "</v2><v3>"};
    char *at = (char *)csg_sink_room(sink, LINE_MOST);
    for (int k = 0; k < 3; k++)
        at = csg_number_put_u64(put_text(at, before[k]), corners[k] - first);
    csg_sink_took(sink, put_text(at, "</v3></triangle>\n"));
}

/* XML has no way to write most control characters: they become spaces. */
static void put_escaped(csg_sink *sink, const char *text)
{
    for (; *text; text++) {
        char plain[2] = {(unsigned char)*text < ' ' ? ' ' : *text};
        csg_sink_text(sink, *text == '&'   ? "&amp;"
                            : *text == '<' ? "&lt;"
                            : *text == '>' ? "&gt;"
                                           : plain);
    }
}

/* It has no centimetres: they are written as ten millimetres. */
static const char *unit_name(csgm_unit unit)
{
    return csg_unit_name(unit == CSGM_UNIT_CM ? CSGM_UNIT_MM : unit);
}

/* The file's own, by the keys that they have; where the scene came from is nothing a printer asks.
 */
static void put_metadata(csg_sink *sink, const csgm_write_options *options)
{
    for (size_t i = 0; i < options->metadata_count; i++) {
        csg_metadata m = csg_metadata_split(options->metadata[i]);
        if (csg_metadata_is(&m, "source") || csg_metadata_recurs(options, i))
            continue;
        csg_sink_format(sink, "<metadata type=\"%.*s\">", (int)m.key_length, m.key);
        put_escaped(sink, m.value);
        csg_sink_text(sink, "</metadata>\n");
    }
}

csgm_status csg_amf_write(csg_sink *sink, const csgm_mesh_view *mesh,
                          const csgm_write_options *options)
{
    double scale = options->unit == CSGM_UNIT_CM ? 10 : 1;
    csg_sink_format(
        sink,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<amf unit=\"%s\" version=\"1.1\">\n"
        "<metadata type=\"producer\">" CSG_WRITTEN_BY "</metadata>\n",
        unit_name(options->unit));
    put_metadata(sink, options);
    for (uint64_t i = 0; i < csg_part_count(mesh); i++) {
        if (mesh->part_count && !mesh->parts[i].triangle_count)
            continue;
        csg_part_stretch part = csg_part_get(mesh, i);
        csg_sink_format(sink, "<object id=\"%llu\">\n", (unsigned long long)i);
        if (part.name && *part.name) {
            csg_sink_text(sink, "<metadata type=\"name\">");
            put_escaped(sink, part.name);
            csg_sink_text(sink, "</metadata>\n");
        }
        csg_sink_text(sink, "<mesh>\n<vertices>\n");
        for (uint64_t v = 0; v < part.vertex_count; v++)
            put_vertex(sink, mesh, part.first_vertex + v, scale);
        csg_sink_text(sink, "</vertices>\n<volume>\n");
        for (uint64_t t = 0; t < part.triangle_count; t++)
            put_triangle(sink, mesh->indices + 3 * (part.first_triangle + t), part.first_vertex);
        csg_sink_text(sink, "</volume>\n</mesh>\n</object>\n");
    }
    csg_sink_text(sink, "</amf>\n");
    return CSGM_OK;
}
