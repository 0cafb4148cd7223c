/* SPDX-License-Identifier: MIT
 * OFF (Geomview) -> mesh: [ST][C][N]OFF text with polygons, which become fans. Vertex colours are
 * whole numbers 0..255 or fractions 0..1, as each number is written; colours of faces are skipped.
 * Does not read the binary form, 4OFF or nOFF. Read directly, not by OpenMesh, which drops faces at
 * edges of more than two.
 */
#include <math.h>

#include "io/color.h"
#include "io/text/scan.h"

typedef struct off {
    csg_input *input;
    csg_mesh_builder *builder;
    csg_text_scan scan;
    bool texture, color, normal;
    uint64_t vertex_count, face_count;
} off;

static csgm_status broken(const off *o, const char *what)
{
    return csg_read_broken(o->input, o->scan.line, "%s", what);
}

/* [ST][C][N]OFF, then perhaps the counts on the same line. */
static csgm_status read_header(off *o)
{
    const char *word;
    csg_scan_space(&o->scan);
    size_t length = csg_scan_word(&o->scan, &word);
    const char *end = word + length;
    if (end - word >= 2 && word[0] == 'S' && word[1] == 'T') {
        o->texture = true;
        word += 2;
    }
    o->color = word < end && *word == 'C';
    word += o->color;
    o->normal = word < end && *word == 'N';
    word += o->normal;
    if (end - word == 4 && (memcmp(word, "4OFF", 4) == 0 || memcmp(word, "nOFF", 4) == 0))
        return csg_read_unsupported(o->input, "OFF files of four dimensions are not read");
    if (end - word != 3 || memcmp(word, "OFF", 3) != 0)
        return broken(o, "an OFF file begins with OFF, COFF, NOFF or CNOFF");
    csg_scan_space(&o->scan);
    if (o->scan.end - o->scan.at >= 6 && memcmp(o->scan.at, "BINARY", 6) == 0)
        return csg_read_unsupported(o->input, "binary OFF files are not read");
    int64_t counts[3];
    for (int i = 0; i < 3; i++) {
        csg_scan_space(&o->scan);
        if (!csg_scan_integer(&o->scan, &counts[i]) || counts[i] < 0)
            return broken(o, "expected the numbers of vertices, faces and edges");
    }
    /* "0 0 0\n" and "0\n" are the shortest lines */
    uint64_t left = (uint64_t)(o->scan.end - o->scan.at);
    o->vertex_count = (uint64_t)counts[0];
    o->face_count = (uint64_t)counts[1];
    if (o->vertex_count > left / 5 || o->face_count > left / 2)
        return broken(o,
                      "the file is too short for the numbers of vertices and faces that it tells");
    return CSGM_OK;
}

static bool read_color(off *o, uint8_t *color)
{
    color[3] = 255;
    for (int k = 0; k < 4; k++) {
        double value;
        csg_scan_blanks(&o->scan);
        const char *from = o->scan.at;
        if (!csg_scan_number(&o->scan, &value))
            return k == 3 && csg_scan_at_line_end(&o->scan);
        bool fraction = false;
        for (const char *c = from; c < o->scan.at; c++)
            fraction |= *c == '.' || *c == 'e' || *c == 'E';
        color[k] = csg_color_to_byte((float)(fraction ? value : value / 255));
    }
    return true;
}

static csgm_status read_vertex(off *o)
{
    double position[3];
    float normal[3];
    uint8_t color[4];
    for (int k = 0; k < (o->normal ? 6 : 3); k++) {
        double value;
        if (k == 0)
            csg_scan_space(&o->scan);
        if (!csg_scan_number(&o->scan, &value) || !isfinite(value))
            return broken(o, "expected a vertex: three finite numbers (and its normal after NOFF)");
        if (k < 3)
            position[k] = value;
        else
            normal[k - 3] = (float)value;
    }
    if (o->color && !read_color(o, color))
        return broken(o, "expected a vertex colour of three or four numbers");
    csg_scan_skip_line(&o->scan);
    csg_builder_vertex(o->builder, position, o->normal ? normal : NULL, o->color ? color : NULL);
    return CSGM_OK;
}

static csgm_status read_face(off *o)
{
    int64_t corners;
    uint32_t fan[2] = {0, 0};
    csg_scan_space(&o->scan);
    if (!csg_scan_integer(&o->scan, &corners) || corners < 0)
        return broken(o, "expected a face: its number of corners and their vertices");
    for (int64_t i = 0; i < corners; i++) {
        int64_t index;
        if (!csg_scan_integer(&o->scan, &index))
            return broken(o, "this face has fewer vertices than it tells");
        if (index < 0 || (uint64_t)index >= o->vertex_count)
            return broken(o, "this face names a vertex that does not exist");
        if (i >= 2 && !csg_builder_triangle(o->builder, fan[0], fan[1], (uint32_t)index))
            return CSGM_OK;
        fan[i != 0] = (uint32_t)index;
    }
    csg_scan_skip_line(&o->scan);
    return CSGM_OK;
}

csgm_status csg_off_read(csg_input *input, csg_mesh_builder *builder)
{
    off o = {.input = input, .builder = builder, .scan = csg_scan_start(input)};
    csgm_status status = read_header(&o);
    if (!status)
        csg_builder_reserve(builder, o.vertex_count, o.face_count);
    for (uint64_t i = 0; i < o.vertex_count && !status && !builder->failed; i++)
        status = read_vertex(&o);
    for (uint64_t i = 0; i < o.face_count && !status && !builder->failed; i++)
        status = read_face(&o);
    return status;
}
