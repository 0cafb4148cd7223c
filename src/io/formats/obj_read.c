/* SPDX-License-Identifier: MIT
 * Wavefront OBJ -> mesh: v (with r g b behind), vn, and f in the forms v, v/t, v//n, v/t/n with
 * negative numbers counting back; polygons become fans; texture coordinates are skipped. Materials
 * come from files beside it (mtl.h), and are multiplied by the colours of v lines. The vertices of
 * the file stay the vertices of the mesh: a vertex has the material of its first face, and where
 * the corners of one vertex have different normals (a crease), the mesh is read without normals
 * rather than cut apart. Does not read free-form curves and surfaces.
 */
#include <math.h>

#include "io/color.h"
#include "io/formats/mtl.h"
#include "io/text/scan.h"

typedef struct obj {
    csg_input *input;
    csg_mesh_builder *builder;
    csg_text_scan scan;
    float *normals; /* the vn lines, 3 each */
    size_t normal_count, normal_room;
    uint32_t *normal_of; /* per vertex: vn + 1 of its first corner, 0 = none yet */
    size_t normal_of_room, normal_of_count;
    bool crease; /* a vertex has two normals, or a corner has none */
    csg_mtl_library library;
    int64_t material;      /* of the faces to come; -1: none */
    uint32_t *material_of; /* per vertex: material + 1 of its first face, 0 = none yet */
    size_t material_of_room, material_of_count;
    bool has_coordinates, has_lines; /* of textures; lines and points */
} obj;

static csgm_status broken(const obj *o, const char *what)
{
    return csg_read_broken(o->input, o->scan.line, "%s", what);
}

static bool reserve(obj *o, void **array, size_t *room, size_t needed, size_t bytes)
{
    if (needed <= *room)
        return true;
    if (!csg_memory_reserve(&o->input->context->memory, array, room, needed, bytes))
        o->builder->failed = true;
    return !o->builder->failed;
}

static csgm_status read_vertex(obj *o)
{
    double values[8];
    uint8_t color[4] = {0, 0, 0, 255};
    int count = 0;
    while (count < 8 && csg_scan_number(&o->scan, &values[count]))
        count++;
    if (count < 3 || !csg_scan_at_line_end(&o->scan) || !isfinite(values[0]) ||
        !isfinite(values[1]) || !isfinite(values[2]))
        return broken(o, "expected a vertex of three finite numbers");
    for (int k = 0; k < 3 && count >= 6; k++)
        color[k] = csg_color_to_byte((float)values[3 + k]);
    csg_builder_vertex(o->builder, values, NULL, count >= 6 ? color : NULL);
    return CSGM_OK;
}

static csgm_status read_normal(obj *o)
{
    double n[3];
    for (int k = 0; k < 3; k++)
        if (!csg_scan_number(&o->scan, &n[k]))
            return broken(o, "expected a normal of three numbers");
    void *array = o->normals;
    if (!reserve(o, &array, &o->normal_room, o->normal_count + 1, 3 * sizeof(float)))
        return CSGM_OK;
    o->normals = array;
    for (size_t k = 0; k < 3; k++)
        o->normals[3 * o->normal_count + k] = (float)n[k];
    o->normal_count++;
    return CSGM_OK;
}

/* Index as written (1-based, or negative from the end) -> 0-based; false when there is none such.
 */
static bool resolve(int64_t written, size_t count, uint32_t *index)
{
    int64_t at = written > 0 ? written - 1 : (int64_t)count + written;
    if (written == 0 || at < 0 || (uint64_t)at >= count)
        return false;
    *index = (uint32_t)at;
    return true;
}

/* An optional sign and digits at *at; false when there is none. */
static bool whole(const char **at, const char *end, int64_t *value)
{
    const char *c = *at;
    bool negative = c < end && *c == '-';
    c += negative;
    const char *first = c;
    int64_t magnitude = 0;
    for (; c < end && *c >= '0' && *c <= '9' && magnitude < INT64_MAX / 100; c++)
        magnitude = 10 * magnitude + (*c - '0');
    *value = negative ? -magnitude : magnitude;
    *at = c;
    return c > first;
}

/* Remembers the vertex's normal, or that it has two. */
static void note_normal(obj *o, uint32_t vertex, int64_t written)
{
    uint32_t normal;
    if (o->crease)
        return;
    void *array = o->normal_of;
    if (!reserve(o, &array, &o->normal_of_room, (size_t)vertex + 1, sizeof(uint32_t)))
        return;
    o->normal_of = array;
    if (o->normal_of_room > o->normal_of_count) {
        memset(o->normal_of + o->normal_of_count, 0,
               (o->normal_of_room - o->normal_of_count) * sizeof(uint32_t));
        o->normal_of_count = o->normal_of_room;
    }
    uint32_t *known = &o->normal_of[vertex];
    if (!resolve(written, o->normal_count, &normal))
        o->crease = true;
    else if (!*known)
        *known = normal + 1;
    else if (*known != normal + 1)
        o->crease = memcmp(o->normals + 3 * (size_t)(*known - 1), o->normals + 3 * (size_t)normal,
                           3 * sizeof(float)) != 0;
}

/* False: out of memory. */
static bool note_material(obj *o, uint32_t vertex)
{
    if (o->material < 0)
        return true;
    void *array = o->material_of;
    if (!reserve(o, &array, &o->material_of_room, (size_t)vertex + 1, sizeof(uint32_t)))
        return false;
    o->material_of = array;
    if (o->material_of_room > o->material_of_count) {
        memset(o->material_of + o->material_of_count, 0,
               (o->material_of_room - o->material_of_count) * sizeof(uint32_t));
        o->material_of_count = o->material_of_room;
    }
    if (!o->material_of[vertex])
        o->material_of[vertex] = (uint32_t)o->material + 1;
    return true;
}

/* One word "v", "v/t", "v//n" or "v/t/n". */
static const char *read_corner(obj *o, const char *word, size_t length, uint32_t *vertex)
{
    const char *at = word, *end = word + length;
    int64_t v, t, n = 0;
    if (!whole(&at, end, &v))
        return "expected a face of vertex numbers";
    if (!resolve(v, o->builder->vertex_count, vertex))
        return "this face names a vertex that does not exist";
    if (at < end && *at == '/') {
        at++;
        whole(&at, end, &t);
        if (at < end && *at == '/') {
            at++;
            if (!whole(&at, end, &n))
                return "expected the number of a normal";
        }
    }
    if (at != end)
        return "expected a face of vertex numbers";
    if (n)
        note_normal(o, *vertex, n);
    else
        o->crease = true;
    return NULL;
}

static csgm_status read_face(obj *o)
{
    uint32_t fan[2] = {0, 0}, vertex;
    const char *word;
    size_t length, corners = 0;
    for (; (length = csg_scan_word(&o->scan, &word)); corners++) {
        const char *wrong = read_corner(o, word, length, &vertex);
        if (wrong)
            return broken(o, wrong);
        if (!note_material(o, vertex))
            return CSGM_OK;
        if (corners >= 2 && !csg_builder_triangle(o->builder, fan[0], fan[1], vertex))
            return CSGM_OK;
        fan[corners != 0] = vertex;
    }
    return corners < 3 ? broken(o, "a face needs three vertices at least") : CSGM_OK;
}

/* Statements that say nothing about triangles. */
static bool is_skipped(const char *word, size_t length)
{
    static const char *const known[] = {"vt",       "vp",       "s",          "l",        "p",
                                        "mg",       "lod",      "bevel",      "maplib",   "usemap",
                                        "c_interp", "d_interp", "shadow_obj", "trace_obj"};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (csg_scan_is(word, length, known[i]))
            return true;
    return false;
}

/* The rest of the line as a name: in the library's arena; NULL: out of memory, reported. */
static const char *read_name(obj *o)
{
    size_t length;
    const char *begin = csg_scan_rest(&o->scan, &length);
    const char *name = csg_arena_strndup(&o->library.names, begin, length);
    if (!name)
        csg_context_no_memory(o->input->context);
    return name;
}

/* "o name" or "g names". */
static csgm_status read_part(obj *o)
{
    const char *name = read_name(o);
    if (!name)
        return CSGM_ERR_MEMORY;
    csg_builder_part(o->builder, *name ? name : NULL);
    return CSGM_OK;
}

static csgm_status read_library(obj *o)
{
    const char *name = read_name(o);
    return !name ? CSGM_ERR_MEMORY : *name ? csg_mtl_read(o->input, name, &o->library) : CSGM_OK;
}

static csgm_status read_use(obj *o)
{
    size_t length;
    const char *name = csg_scan_rest(&o->scan, &length);
    o->material = csg_mtl_find(&o->library, name, length);
    return CSGM_OK;
}

static csgm_status read_line(obj *o)
{
    const char *word;
    size_t length = csg_scan_word(&o->scan, &word);
    if (length == 1 && *word == 'v')
        return read_vertex(o);
    if (length == 2 && memcmp(word, "vn", 2) == 0)
        return read_normal(o);
    if (length == 1 && *word == 'f')
        return read_face(o);
    if (length == 1 && (*word == 'o' || *word == 'g'))
        return read_part(o);
    if (csg_scan_is(word, length, "usemtl"))
        return read_use(o);
    if (csg_scan_is(word, length, "mtllib"))
        return read_library(o);
    o->has_coordinates |= csg_scan_is(word, length, "vt");
    o->has_lines |= length == 1 && (*word == 'l' || *word == 'p');
    if (is_skipped(word, length))
        return CSGM_OK;
    if (csg_scan_is(word, length, "cstype") || csg_scan_is(word, length, "curv") ||
        csg_scan_is(word, length, "surf"))
        return csg_read_unsupported(o->input, "free-form surfaces of OBJ are not read");
    return broken(o, "this is no statement of an OBJ file");
}

/* A vertex that no face uses takes the normal of its own number, as csgmesh writes them. */
static void set_normals(obj *o)
{
    size_t count = o->builder->vertex_count;
    if (o->crease || !o->normal_count || o->builder->failed)
        return;
    bool paired = o->normal_count == count;
    for (size_t i = 0; i < count; i++)
        if (!paired && (i >= o->normal_of_count || !o->normal_of[i]))
            return;
    float *normals = csg_builder_normals(o->builder);
    for (size_t i = 0; normals && i < count; i++) {
        uint32_t known = i < o->normal_of_count ? o->normal_of[i] : 0;
        memcpy(normals + 3 * i, o->normals + 3 * (known ? (size_t)known - 1 : i),
               3 * sizeof(float));
    }
}

/* Which of these the materials of some vertices say: a colour, metallic and roughness. */
static void look_at_materials(const obj *o, bool *has_color, bool *has_finish)
{
    *has_color = *has_finish = false;
    for (size_t i = 0; i < o->material_of_count && i < o->builder->vertex_count; i++) {
        if (!o->material_of[i])
            continue;
        *has_color |= o->library.materials[o->material_of[i] - 1].has_color;
        *has_finish |= o->library.materials[o->material_of[i] - 1].has_finish;
    }
}

static void set_looks(obj *o)
{
    bool has_color, has_finish;
    look_at_materials(o, &has_color, &has_finish);
    uint8_t *colors = has_color ? csg_builder_colors(o->builder) : NULL;
    uint16_t *finishes = has_finish ? csg_builder_materials(o->builder) : NULL;
    for (size_t i = 0; i < o->material_of_count && i < o->builder->vertex_count; i++) {
        if (!o->material_of[i])
            continue;
        const csg_mtl_material *material = &o->library.materials[o->material_of[i] - 1];
        for (size_t k = 0; colors && k < 4; k++)
            colors[4 * i + k] = (uint8_t)((colors[4 * i + k] * material->color[k] + 127) / 255);
        if (finishes)
            memcpy(finishes + 2 * i, material->finish, sizeof material->finish);
    }
}

static void tell_what_is_left_out(const obj *o)
{
    const char *const facts[] = {o->library.is_missing ? "materials (their file is not there)"
                                                       : NULL,
                                 o->library.has_pictures ? "textures" : NULL,
                                 o->has_coordinates ? "texture coordinates" : NULL,
                                 o->has_lines ? "points and lines" : NULL};
    char text[128] = "", *at = text;
    for (size_t i = 0; i < sizeof facts / sizeof *facts; i++)
        if (facts[i])
            at = stpcpy(stpcpy(at, at == text ? "" : ", "), facts[i]);
    if (*text)
        csg_builder_leave_out(o->builder, text);
}

static void release(obj *o)
{
    csg_memory *memory = &o->input->context->memory;
    csg_memory_release(memory, o->normals, o->normal_room * 3 * sizeof(float));
    csg_memory_release(memory, o->normal_of, o->normal_of_room * sizeof(uint32_t));
    csg_memory_release(memory, o->material_of, o->material_of_room * sizeof(uint32_t));
    csg_mtl_library_release(&o->library);
}

csgm_status csg_obj_read(csg_input *input, csg_mesh_builder *builder)
{
    obj o = {.input = input, .builder = builder, .scan = csg_scan_start(input), .material = -1};
    csgm_status status = CSGM_OK;
    csg_mtl_library_init(&o.library, input->context);
    for (;;) {
        csg_scan_space(&o.scan);
        if (o.scan.at == o.scan.end || status || builder->failed)
            break;
        status = read_line(&o);
        if (!status)
            csg_scan_skip_line(&o.scan);
    }
    if (!status && !builder->failed) {
        set_normals(&o);
        set_looks(&o);
        tell_what_is_left_out(&o);
    }
    release(&o);
    return status;
}
