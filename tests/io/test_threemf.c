/* SPDX-License-Identifier: MIT
 * 3MF packages that others may write, made here from their XML: components, transforms, colours,
 * models in several files; and packages that lie.
 */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "io/threemf/zip_write.h"

#define CORE "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
#define MODEL                                                                                      \
    "<model xmlns=\"" CORE "\" "                                                                   \
    "xmlns:c=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\" "                   \
    "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\">"
#define RELATIONSHIPS                                                                              \
    "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"       \
    "<Relationship Id=\"t\" Target=\"/thumbnail.png\" Type=\"http://x/thumbnail\"/>"               \
    "<Relationship Id=\"m\" Target=\"/3D/My.model\" "                                              \
    "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/></Relationships>"
#define CORNERS                                                                                    \
    "<vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>"                 \
    "<vertex x=\"0\" y=\" 1e0 \" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"+1.0\"/></vertices>"
#define FACES                                                                                      \
    "<triangle v1=\"0\" v2=\"2\" v3=\"1\"/><triangle v1=\"0\" v2=\"1\" v3=\"3\"/>"                 \
    "<triangle v1=\"0\" v2=\"3\" v3=\"2\"/><triangle v1=\"1\" v2=\"2\" v3=\"3\"/>"
#define MESH "<mesh>" CORNERS "<triangles>" FACES "</triangles></mesh>"
#define ONE "<object id=\"1\" name=\"one\">" MESH "</object>"
#define END "</resources><build><item objectid=\"1\"/></build></model>"

enum { MEMORY_LIMIT = 64 << 20 };

typedef struct package {
    char path[256];
    uint8_t *bytes;
    size_t size;
} package;

/* Files of name and text, NULL behind the last. */
static package make(io_context *io, const char *const *files)
{
    package p;
    csg_sink sink;
    csg_zip *zip;
    snprintf(p.path, sizeof p.path, "/tmp/csgmesh-io-3mf-XXXXXX");
    int file = mkstemp(p.path);
    assert_true(file >= 0);
    assert_int_equal(csg_sink_open(&sink, &io->context, file, p.path), CSGM_OK);
    assert_int_equal(csg_zip_create(&sink, &zip), CSGM_OK);
    for (; *files; files += 2) {
        csg_zip_file(zip, files[0]);
        csg_zip_text(zip, files[1], strlen(files[1]));
    }
    assert_int_equal(csg_zip_finish(zip), CSGM_OK);
    csg_zip_destroy(zip);
    assert_int_equal(csg_sink_close(&sink), CSGM_OK);
    close(file);
    p.bytes = io_file_load(p.path, &p.size);
    unlink(p.path);
    return p;
}

static csgm_status read_files(io_context *io, const char *const *files, csgm_mesh **mesh)
{
    package p = make(io, files);
    io->findings = 0;
    io->context.diags.errors = 0;
    *mesh = NULL;
    csgm_status status =
        csg_io_read_memory(&io->context, p.bytes, p.size, "a.3mf", CSGM_FORMAT_AUTO, mesh);
    free(p.bytes);
    return status;
}

static csgm_status read_model(io_context *io, const char *model, csgm_mesh **mesh)
{
    const char *const files[] = {"_rels/.rels", RELATIONSHIPS, "3D/My.model", model, NULL};
    return read_files(io, files, mesh);
}

static double volume(const csgm_mesh_view *m, uint64_t part)
{
    double sum = 0;
    const csgm_mesh_part *p = &m->parts[part];
    for (uint64_t i = p->first_triangle; i < p->first_triangle + p->triangle_count; i++) {
        const float *a = m->positions + 3 * (size_t)m->indices[3 * i];
        const float *b = m->positions + 3 * (size_t)m->indices[3 * i + 1];
        const float *c = m->positions + 3 * (size_t)m->indices[3 * i + 2];
        sum += (double)(a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
                        a[2] * (b[0] * c[1] - b[1] * c[0]));
    }
    return sum / 6;
}

/* An object of components, one of them mirrored, placed twice as large; and its component. */
static void components_are_placed(void **state)
{
    (void)state;
    io_context io;
    csgm_mesh *mesh;
    io_context_init(&io, MEMORY_LIMIT);
    csgm_status status = read_model(
        &io,
        MODEL "<resources>" ONE "<object id=\"7\" name=\"both\"><components>"
              "<component objectid=\"1\"/><component objectid=\"1\" "
              "transform=\"1 0 0 0 1 0 0 0 -1 10 20 30\"/></components></object></resources>"
              "<build><item objectid=\"7\" transform=\"2 0 0 0 2 0 0 0 2 1 0 0\"/>"
              "<item objectid=\"1\" transform=\"0 1 0 -1 0 0 0 0 1 0 0 5\"/></build></model>",
        &mesh);
    if (status)
        fail_msg("%s", io.last);
    csgm_mesh_view view = csg_mesh_view(mesh);
    assert_int_equal(view.part_count, 2);
    assert_string_equal(view.parts[0].name, "both");
    assert_string_equal(view.parts[1].name, "one");
    assert_int_equal(view.vertex_count, 12);
    assert_null(view.colors);
    assert_true(view.positions[0] == 1); /* moved by the item */
    const float *mirrored = view.positions + 3 * 7;
    assert_true(mirrored[0] == 21 && mirrored[1] == 40 && mirrored[2] == 58);
    const float *turned = view.positions + 3 * 9; /* x becomes y */
    assert_true(turned[0] == 0 && turned[1] == 1 && turned[2] == 5);
    assert_true(fabs(volume(&view, 0) - 2 * 8.0 / 6) < 1e-5); /* both outwards */
    assert_true(fabs(volume(&view, 1) - 1.0 / 6) < 1e-6);
    csg_mesh_destroy(mesh);
    io_context_check(&io);
}

static void expect_color(const csgm_mesh_view *view, size_t vertex, uint32_t rgba)
{
    const uint8_t *c = view->colors + 4 * vertex;
    uint32_t have = (uint32_t)c[0] << 24 | (uint32_t)c[1] << 16 | (uint32_t)c[2] << 8 | c[3];
    if (have != rgba)
        fail_msg("vertex %zu has the colour %08x, not %08x", vertex, have, rgba);
}

/* Of corners, of triangles, of the object; the first that a vertex gets stays. */
static void colors_are_read(void **state)
{
    (void)state;
    io_context io;
    csgm_mesh *mesh;
    io_context_init(&io, MEMORY_LIMIT);
    csgm_status status = read_model(
        &io,
        MODEL "<resources><basematerials id=\"5\"><base name=\"r\" "
              "displaycolor=\"#ff0000\"/></basematerials><c:colorgroup id=\"6\">"
              "<c:color color=\"#00FF0080\"/><c:color color=\"#0000FF\"/></c:colorgroup>"
              "<object id=\"1\" pid=\"5\" pindex=\"0\"><mesh>" CORNERS "<triangles>"
              "<triangle v1=\"0\" v2=\"2\" v3=\"1\" pid=\"6\" p1=\"0\" p2=\"1\" p3=\"0\"/>"
              "<triangle v1=\"0\" v2=\"1\" v3=\"3\"/></triangles></mesh></object>"
              "<object id=\"2\"><mesh>" CORNERS "<triangles>" FACES
              "</triangles></mesh></object></resources><build><item objectid=\"1\"/>"
              "<item objectid=\"2\"/></build></model>",
        &mesh);
    if (status)
        fail_msg("%s", io.last);
    csgm_mesh_view view = csg_mesh_view(mesh);
    assert_non_null(view.colors);
    expect_color(&view, 0, 0x00FF0080);
    expect_color(&view, 1, 0x00FF0080);
    expect_color(&view, 2, 0x0000FFFF);
    expect_color(&view, 3, 0xFF0000FF);
    expect_color(&view, 4, 0xFFFFFFFF);
    csg_mesh_destroy(mesh);
    io_context_check(&io);
}

/* As slicers write: the root model only places objects of other files. */
static void models_in_several_files(void **state)
{
    (void)state;
    static const char *const files[] = {
        "_rels/.rels",
        RELATIONSHIPS,
        "3D/My.model",
        MODEL "<resources><object id=\"2\"><components><component p:path=\"/3D/Objects/a.model\" "
              "objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 5 0 0\"/></components></object>"
              "</resources><build><item objectid=\"2\"/></build></model>",
        "3D/Objects/a.model",
        MODEL "<resources>" ONE END,
        NULL};
    io_context io;
    csgm_mesh *mesh;
    io_context_init(&io, MEMORY_LIMIT);
    if (read_files(&io, files, &mesh))
        fail_msg("%s", io.last);
    csgm_mesh_view view = csg_mesh_view(mesh);
    assert_int_equal(view.triangle_count, 4);
    assert_true(view.positions[0] == 5);
    csg_mesh_destroy(mesh);
    io_context_check(&io);
}

/* ---- packages that lie ------------------------------------------------------------------------
 */

typedef struct lie {
    const char *model, *message;
} lie;

#define OBJECT(text) MODEL "<resources><object id=\"1\">" text "</object>" END
#define TRIANGLE(text) OBJECT("<mesh>" CORNERS "<triangles>" text "</triangles></mesh>")

static const lie lies[] = {
    {TRIANGLE("<triangle v1=\"0\" v2=\"1\" v3=\"4\"/>"), "does not exist"},
    {TRIANGLE("<triangle v1=\"0\" v2=\"1\" v3=\"-1\"/>"), "does not exist"},
    {TRIANGLE("<triangle v1=\"0\" v2=\"1\" v3=\"4294967296\"/>"), "does not exist"},
    {TRIANGLE("<triangle v1=\"0\" v2=\"1\"/>"), "does not exist"},
    {OBJECT("<mesh><vertices><vertex x=\"nan\" y=\"0\" z=\"0\"/></vertices></mesh>"),
     "not a finite"},
    {OBJECT("<mesh><vertices><vertex x=\"1e999\" y=\"0\" z=\"0\"/></vertices></mesh>"),
     "not a finite"},
    {OBJECT("<mesh><vertices><vertex x=\"1\" y=\"0\"/></vertices></mesh>"), "not a finite"},
    {OBJECT("<components><component objectid=\"1\"/></components>"), "its own component"},
    {OBJECT("<components><component objectid=\"2\"/></components>") "", "no object with the id 2"},
    {OBJECT("<components><component objectid=\"1\" transform=\"1 0 0\"/></components>"),
     "twelve finite numbers"},
    {OBJECT("<object id=\"3\"/>"), "inside another"},
    {MODEL "<resources>" ONE ONE END, "two objects have the id 1"},
    {MODEL "<resources/><build><item objectid=\"9\"/></build></model>", "no object with the id 9"},
    {MODEL "<resources><vertex x=\"0\" y=\"0\" z=\"0\"/>" END, "outside of an object"},
    {MODEL "<resources><c:colorgroup id=\"2\"><c:color color=\"red\"/></c:colorgroup>" END,
     "#RRGGBB"},
    {MODEL "<resources>", "no element found"},
    {"<!DOCTYPE a [<!ENTITY b \"bbbbbbbbbb\"><!ENTITY c \"&b;&b;&b;&b;\">]><a>&c;</a>",
     "document type"},
    {"<!DOCTYPE a SYSTEM \"file:///etc/passwd\"><a/>", "document type"},
    {MODEL "<resources>" ONE "</resources><build><item objectid=\"1\" p:path=\"/no.model\"/>"
           "</build></model>",
     "no no.model"},
};

#define NEEDS(prefixes)                                                                            \
    "<model xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "                  \
    "xmlns:i=\"http://schemas.3mf.io/3dmanufacturing/implicit/2023/12\" "                          \
    "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\" "                   \
    "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" "                 \
    "requiredextensions=\"" prefixes "\"><resources>" ONE END

/* What a model requires is read, or it is refused by name. */
static void required_extensions_are_heeded(void **state)
{
    (void)state;
    static const struct {
        const char *model, *said;
    } cases[] = {{NEEDS("p m"), NULL},
                 {NEEDS(""), NULL},
                 {NEEDS("m i"), "'http://schemas.3mf.io/3dmanufacturing/implicit/2023/12'"},
                 {NEEDS("\t i "), "implicit/2023/12"},
                 {NEEDS("x"), "prefix is not declared"}};
    io_context io;
    io_context_init(&io, MEMORY_LIMIT);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        csgm_mesh *mesh;
        csgm_status status = read_model(&io, cases[i].model, &mesh);
        assert_int_equal(status == CSGM_OK, cases[i].said == NULL);
        if (cases[i].said && !strstr(io.last, cases[i].said))
            fail_msg("'%s' does not say '%s'", io.last, cases[i].said);
        csg_mesh_destroy(mesh);
    }
    io_context_check(&io);
}

static void lies_are_told(void **state)
{
    (void)state;
    io_context io;
    csgm_mesh *mesh;
    io_context_init(&io, MEMORY_LIMIT);
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        csgm_status status = read_model(&io, lies[i].model, &mesh);
        if (status != CSGM_ERR_FORMAT || io.findings != 1 || !strstr(io.last, lies[i].message))
            fail_msg("lie %zu: status %d: '%s'", i, (int)status, io.last);
    }
    static const char *const missing[] = {"3D/My.model", MODEL, NULL};
    assert_int_equal(read_files(&io, missing, &mesh), CSGM_ERR_FORMAT);
    assert_non_null(strstr(io.last, "_rels/.rels"));
    static const char *const pointless[] = {"_rels/.rels", "<a xmlns=\"b\"/>", NULL};
    assert_int_equal(read_files(&io, pointless, &mesh), CSGM_ERR_FORMAT);
    assert_non_null(strstr(io.last, "no 3-D model"));
    io_context_check(&io);
}

/* head, then `unit` many times, then tail. */
static char *repeat(const char *head, const char *unit, size_t count, const char *tail)
{
    size_t length = strlen(unit), at = strlen(head);
    char *text = malloc(at + count * length + strlen(tail) + 1);
    assert_non_null(text);
    memcpy(text, head, at);
    for (size_t i = 0; i < count; i++, at += length)
        memcpy(text + at, unit, length);
    strcpy(text + at, tail);
    return text;
}

static void expect_bomb(char *model, const char *message)
{
    io_context io;
    csgm_mesh *mesh;
    io_context_init(&io, MEMORY_LIMIT);
    csgm_status status = read_model(&io, model, &mesh);
    if (status == CSGM_OK || io.findings != 1 || !strstr(io.last, message))
        fail_msg("status %d: '%s'", (int)status, io.last);
    io_context_check(&io);
    free(model);
}

/* Objects of two components each, the depth of the ladder. */
static char *doubling(int depth)
{
    char *text = malloc(300 * (size_t)depth + 2000), *at = text;
    if (!text)
        abort();
    at += sprintf(at, MODEL "<resources><object id=\"1\"><components/></object>");
    for (int i = 2; i <= depth; i++)
        at += sprintf(at,
                      "<object id=\"%d\"><components><component objectid=\"%d\"/>"
                      "<component objectid=\"%d\"/></components></object>",
                      i, i - 1, i - 1);
    sprintf(at, "</resources><build><item objectid=\"%d\"/></build></model>", depth);
    return text;
}

static void bombs_do_not_go_off(void **state)
{
    (void)state;
    expect_bomb(repeat(MODEL "<resources>", "                ", 40 << 16, END), "unpacks to more");
    expect_bomb(
        repeat(MODEL "<resources><object id=\"1\" name=\"", "0123456789abcdef", 100000, "\"/>" END),
        "tag of more than");
    expect_bomb(repeat(MODEL, "<a>", 100000, ""), "nested too deeply");
    expect_bomb(doubling(28), "objects in all");
    expect_bomb(doubling(40), "nested too deeply");
    expect_bomb(repeat(MODEL "<resources><object id=\"1\"><mesh><vertices>",
                       "<vertex x=\"1\" y=\"2\" z=\"3\"/>", 1500000,
                       "</vertices></mesh></object>" END),
                "unpacks to more");
}

int main(void)
{
    if (!csg_format_available(CSGM_FORMAT_3MF, true))
        return 77; /* skipped: the build has no libzip or expat */
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(components_are_placed),   cmocka_unit_test(colors_are_read),
        cmocka_unit_test(models_in_several_files), cmocka_unit_test(required_extensions_are_heeded),
        cmocka_unit_test(lies_are_told),           cmocka_unit_test(bombs_do_not_go_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
