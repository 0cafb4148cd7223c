/* SPDX-License-Identifier: MIT
 * Broken files: every reader on its own files cut at each byte, on seeded random damage, and on
 * files that lie in one place. Nothing crashes, leaks or takes much memory; a refusal is one
 * finding.
 */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include "io/adapter.h"

#include "base/random.h"
#include "io/format_table.h"

typedef struct sample {
    const char *name;
    io_shape shape;
    bool ascii, draco, meshopt, khr;
    bool lines_alone; /* each line is a statement of its own: what is cut off is not missed */
} sample;

static const sample samples[] = {
    {"a.ply", IO_CUBE, false, false, false, false, false},
    {"b.ply", IO_CUBE, true, false, false, false, false},
    {"c.stl", IO_CUBE, false, false, false, false, false},
    {"d.stl", IO_TETRAHEDRON, true, false, false, false, false},
    {"e.obj", IO_CUBE, false, false, false, false, true},
    {"f.off", IO_CUBE, false, false, false, false, false},
    {"g.glb", IO_CUBE, false, false, false, false, false},
    {"h.gltf", IO_TETRAHEDRON, false, false, false, false, false},
    {"i.drc", IO_CUBE, false, true, false, false, false},
    {"j.glb", IO_TETRAHEDRON, false, true, false, false, false},
    {"k.ply", IO_TETRAHEDRON, true, false, false, false, false},
    {"l.3mf", IO_PARTS, false, false, false, false, false},
    {"m.obj", IO_PARTS, false, false, false, false, true},
    {"n.amf", IO_TETRAHEDRON, false, false, false, false, false},
    {"o.glb", IO_CUBE, false, false, true, false, false},
    {"p.glb", IO_CUBE, false, false, true, true, false},
};

enum {
    SAMPLES = sizeof samples / sizeof *samples,
    MEMORY_LIMIT = 64 << 20,
    RSS_MOST_KIB = 200 << 10
};

/* Reads the bytes from an exactly sized block, so that a sanitizer sees a byte too many. */
static csgm_status read_bytes(io_context *io, const char *name, const uint8_t *bytes, size_t size)
{
    csgm_mesh *mesh = NULL;
    uint8_t *exact = malloc(size ? size : 1);
    assert_non_null(exact);
    memcpy(exact, bytes, size);
    io->findings = 0;
    io->context.diags.errors = 0; /* only the first twenty of a run are shown */
    csgm_status status =
        csg_io_read_memory(&io->context, exact, size, name, CSGM_FORMAT_AUTO, &mesh);
    free(exact);
    if (status) {
        assert_null(mesh);
        assert_int_equal(io->findings, 1);
        assert_true(io->last[0]);
        return status;
    }
    assert_int_equal(io->findings, 0);
    csgm_mesh_view view = csg_mesh_view(mesh);
    for (uint64_t i = 0; i < 3 * view.triangle_count; i++)
        assert_true(view.indices[i] < view.vertex_count);
    for (uint64_t i = 0; i < 3 * view.vertex_count; i++)
        assert_true(isfinite(view.positions[i]));
    csg_mesh_destroy(mesh);
    return status;
}

static uint8_t *make_sample(const sample *s, const char *folder, size_t *size)
{
    io_context io;
    char path[256];
    csgm_write_options options = csg_write_options_default();
    options.ascii = s->ascii;
    options.draco = s->draco;
    options.meshopt = s->meshopt;
    options.meshopt_khr = s->khr;
    io_context_init(&io, 0);
    csgm_mesh *mesh = io_shape_make(&io.context, s->shape);
    csgm_mesh_view view = csg_mesh_view(mesh);
    snprintf(path, sizeof path, "%s/%s", folder, s->name);
    assert_int_equal(csg_io_write(&io.context, &view, path, CSGM_FORMAT_AUTO, &options), CSGM_OK);
    csg_mesh_destroy(mesh);
    return io_file_load(path, size);
}

static bool usable(const sample *s)
{
    return csg_format_available(csg_format_from_path(s->name), true) &&
           (!s->draco || csg_format_available(CSGM_FORMAT_DRC, true)) &&
           (!s->meshopt || csg_meshopt_available());
}

/* Text may lose its last line end and still be whole; anything shorter is refused. */
static void cut_at(const sample *s, const uint8_t *bytes, size_t size)
{
    io_context io;
    io_context_init(&io, MEMORY_LIMIT);
    for (size_t cut = 0; cut < size; cut++) {
        csgm_status status = read_bytes(&io, s->name, bytes, cut);
        /* the last few bytes may be padding, a line end, or the name after endsolid */
        if (!s->lines_alone && status == CSGM_OK && cut + 9 < size)
            fail_msg("%s cut at %zu of %zu is read", s->name, cut, size);
    }
    io_context_check(&io);
}

static void damage(const sample *s, const uint8_t *bytes, size_t size)
{
    io_context io;
    io_context_init(&io, MEMORY_LIMIT);
    csg_random random = {size}; /* the seed */
    uint8_t *copy = malloc(2 * size + 64);
    assert_non_null(copy);
    const char *asked = getenv("CSGMESH_ROUNDS"); /* more, for a long run by hand */
    int rounds = asked ? atoi(asked) : 2000;
    for (int round = 0; round < rounds; round++) {
        memcpy(copy, bytes, size);
        size_t length = size;
        uint32_t edits = 1 + csg_random_below(&random, 4);
        for (uint32_t e = 0; e < edits; e++) {
            uint32_t at = csg_random_below(&random, (uint32_t)length);
            uint32_t kind = csg_random_below(&random, 5);
            if (kind == 0)
                copy[at] = (uint8_t)csg_random_next(&random);
            else if (kind == 1)
                copy[at] ^= (uint8_t)(1u << csg_random_below(&random, 8));
            else if (kind == 2)
                copy[at] = 255;
            else if (kind == 3 && copy[at] >= '0' && copy[at] <= '9')
                copy[at] = (uint8_t)('0' + csg_random_below(&random, 10));
            else if (length + 1 < 2 * size) { /* a digit or byte more */
                memmove(copy + at + 1, copy + at, length - at);
                length++;
            }
        }
        read_bytes(&io, s->name, copy, length);
    }
    free(copy);
    io_context_check(&io);
}

static void every_reader_has_a_sample(void **state)
{
    (void)state;
    for (int f = CSGM_FORMAT_AUTO + 1; f < CSGM_FORMAT_COUNT; f++) {
        const csg_format_row *row = csg_format_find((csgm_format)f);
        bool is_there = !row->read;
        for (int i = 0; i < SAMPLES && !is_there; i++)
            is_there = csg_format_from_path(samples[i].name) == row->id;
        if (!is_there)
            fail_msg("%s files are read, but no sample of them is broken here", row->title);
    }
}

static void every_reader_survives(void **state)
{
    (void)state;
    char folder[128];
    io_folder_make(folder, sizeof folder);
    for (int i = 0; i < SAMPLES; i++) {
        if (!usable(&samples[i]))
            continue;
        size_t size;
        uint8_t *bytes = make_sample(&samples[i], folder, &size);
        cut_at(&samples[i], bytes, size);
        damage(&samples[i], bytes, size);
        free(bytes);
#ifndef __SANITIZE_ADDRESS__
        struct rusage usage;
        assert_int_equal(getrusage(RUSAGE_SELF, &usage), 0);
        if (usage.ru_maxrss > RSS_MOST_KIB)
            fail_msg("%s: %ld KiB were taken", samples[i].name, usage.ru_maxrss);
#endif
    }
    io_folder_remove(folder);
}

/* ---- files that lie in one place ----------------------------------------------------------------
 */

typedef struct lie {
    const char *name, *text, *message; /* part of the finding; NULL = it is read */
    uint32_t line;
} lie;

#define PLY_HEAD                                                                                   \
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float " \
    "z\n"
#define PLY_FACE "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
#define GLTF(rest) "{\"asset\":{\"version\":\"2.0\"}," rest "}"

static const lie lies[] = {
    {"a.ply", PLY_HEAD PLY_FACE "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", NULL, 0},
    {"a.ply", PLY_HEAD PLY_FACE "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "does not exist", 13},
    {"a.ply", PLY_HEAD PLY_FACE "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "does not exist", 13},
    {"a.ply", PLY_HEAD PLY_FACE "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", "not finite", 10},
    {"a.ply",
     "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\n"
     "property float z\nend_header\n0 0 0\n",
     "too short", 8},
    {"a.ply",
     "ply\nformat binary_little_endian 1.0\nelement vertex 99999999999999\nproperty uchar q\n"
     "end_header\n",
     "too short", 0},
    {"a.ply", "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n",
     "no x, y and z", 6},
    {"a.ply", "ply\nelement vertex 0\nend_header\n", "no 'format'", 3},
    {"a.ply", "ply\nformat ascii 1.0\nproperty float x\nend_header\n", "before any element", 3},
    {"a.ply",
     "ply\nformat ascii 1.0\nelement tristrips 1\nproperty list int int vertex_indices\n"
     "end_header\n1 0\n",
     "strips", 0},
    {"a.ply", "obj\n", "begins with 'ply'", 1},
    {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3/1/1 -2//1 -1\n", NULL, 0},
    {"a.obj", "v 0 0 0\nf 1 2 3\n", "does not exist", 2},
    {"a.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n", "three vertices", 3},
    {"a.obj", "v 0 0\n", "three finite numbers", 1},
    {"a.obj", "v 0 0 1e999\n", "three finite numbers", 1},
    {"a.obj", "hello\n", "no statement", 1},
    {"a.obj", "v 0 0 0\nf 99999999999999999999 1 1\n", "", 2},
    {"a.amf", "<amf/>", NULL, 0},
    {"a.amf", "<model/>", "does not begin with <amf>", 0},
    {"a.amf", "<amf><object/></amf>", "no good id", 0},
    {"a.amf", "<amf><object id='1'><mesh><vertices><vertex/></vertices></mesh></object></amf>",
     "lacks coordinates", 0},
    {"a.amf",
     "<amf><object id='1'><mesh><vertices><vertex><coordinates><x>1e999</x></coordinates></vertex>"
     "</vertices></mesh></object></amf>",
     "no finite number", 0},
    {"a.amf",
     "<amf><object id='1'><mesh><volume><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle>"
     "</volume></mesh></object></amf>",
     "does not exist", 0},
    {"a.amf",
     "<amf><object id='1'><mesh><volume><triangle><v1>-1</v1></triangle></volume></mesh></object>"
     "</amf>",
     "no number of a vertex", 0},
    {"a.amf", "<amf><constellation><instance objectid='4'/></constellation></amf>",
     "which is no object", 0},
    {"a.amf", "<!DOCTYPE amf [<!ENTITY a 'b'>]><amf/>", "document type declaration", 0},
    {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", NULL, 0},
    {"a.off", "OFF 3 1 0\n# a comment\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "does not exist", 6},
    {"a.off", "OFF\n4000000000 1 0\n0 0 0\n", "too short", 2},
    {"a.off", "OFF BINARY\n", "binary OFF", 0},
    {"a.off", "4OFF\n", "four dimensions", 0},
    {"a.stl",
     "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
     "endfacet\nendsolid a\n",
     NULL, 0},
    {"a.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 inf\n", "facet",
     5},
    {"a.stl", "solid a\nfacet normal 0 0 1\n", "facet", 3},
    {"a.stl", "soli", "begins with 'solid'", 0},
    {"a.gltf", GLTF("\"scenes\":[{}]"), NULL, 0},
    {"a.gltf",
     GLTF("\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"children\":[1]},{\"children\":[0]}]"),
     "own ancestor", 0},
    {"a.gltf", GLTF("\"scenes\":[{\"nodes\":[7]}]"), "no node 7", 0},
    {"a.gltf", GLTF("\"nodes\":[{\"mesh\":3}]"), "no mesh 3", 0},
    {"a.gltf", GLTF("\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":5}}]}]"),
     "no accessor 5", 0},
    {"a.gltf",
     GLTF("\"accessors\":[{\"componentType\":5126,\"count\":4000000000,\"type\":\"VEC3\","
          "\"bufferView\":0}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":12}],\"buffers\":"
          "[{\"byteLength\":12,\"uri\":\"data:application/octet-stream;base64,AAAAAAAAAAAAAAAA\"}],"
          "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]"),
     "beyond the end of its bufferView", 0},
    {"a.gltf", GLTF("\"buffers\":[{\"byteLength\":12,\"uri\":\"../../../../no/such/file.bin\"}]"),
     "not a file beside it", 0},
    {"a.gltf", GLTF("\"buffers\":[{\"byteLength\":12,\"uri\":\"http://127.0.0.1/a.bin\"}]"),
     "not a file", 0},
    {"a.gltf", GLTF("\"extensionsRequired\":[\"EXT_mesh_of_tomorrow\"]"), "EXT_mesh_of_tomorrow",
     0},
    {"a.gltf", "{\"asset\":{\"version\":\"1.0\"}}", "version 1.0", 0},
    {"a.gltf", "{\"asset\":", "JSON is broken", 0},
    {"a.gltf", "[]", "JSON object", 0},
    {"a.xyz", "nothing that is known", "no mesh format", 0},
    {"", "", "no mesh format", 0},
};

static void lies_are_told_apart(void **state)
{
    (void)state;
    io_context io;
    io_context_init(&io, MEMORY_LIMIT);
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        const lie *l = &lies[i];
        csgm_format format = csg_format_from_path(l->name);
        if (format != CSGM_FORMAT_AUTO && !csg_format_available(format, true))
            continue;
        csgm_status status = read_bytes(&io, l->name, (const uint8_t *)l->text, strlen(l->text));
        if (!l->message != (status == CSGM_OK) || (l->message && !strstr(io.last, l->message)) ||
            (l->line && l->line != io.last_line))
            fail_msg("%s: status %d, line %u: '%s' for %s", l->name, (int)status, io.last_line,
                     status ? io.last : "", l->text);
    }
    io_context_check(&io);
}

/* A document nested so deep that walking it would overflow the stack. */
static void deep_json_is_refused(void **state)
{
    (void)state;
    if (!csg_format_available(CSGM_FORMAT_GLTF, true))
        skip();
    enum { DEEP = 400000 };
    static const char head[] = "{\"asset\":{\"version\":\"2.0\",\"extras\":";
    io_context io;
    io_context_init(&io, MEMORY_LIMIT);
    char *text = malloc(sizeof head + 2 * DEEP + 2);
    assert_non_null(text);
    memcpy(text, head, sizeof head - 1);
    memset(text + sizeof head - 1, '[', DEEP);
    memset(text + sizeof head - 1 + DEEP, ']', DEEP);
    memcpy(text + sizeof head - 1 + 2 * DEEP, "}}", 2);
    assert_int_equal(read_bytes(&io, "a.gltf", (uint8_t *)text, sizeof head + 2 * DEEP + 1),
                     CSGM_ERR_FORMAT);
    free(text);
    io_context_check(&io);
}

/* Headers of tiny files that tell of hundreds of millions of faces: sequential and edgebreaker. */
static void draco_counts_are_not_believed(void **state)
{
    (void)state;
    if (!csg_format_available(CSGM_FORMAT_DRC, true))
        skip();
    static const uint8_t heads[][11] = {{'D', 'R', 'A', 'C', 'O', 2, 2, 1, 0, 0, 0},
                                        {'D', 'R', 'A', 'C', 'O', 2, 2, 1, 1, 0, 0}};
    io_context io;
    io_context_init(&io, MEMORY_LIMIT);
    for (size_t h = 0; h < 2; h++)
        for (uint32_t first = 0; first < 3; first++)
            for (uint8_t fill = 0; fill < 4; fill++) {
                uint8_t bytes[64] = {0};
                memcpy(bytes, heads[h], sizeof *heads);
                size_t at = sizeof *heads;
                bytes[at] = (uint8_t)first; /* edgebreaker: the traversal's kind */
                at += h;
                for (int count = 0; count < 3; count++) {
                    memset(bytes + at, 0xFF, 4); /* 2^28 - 1 as a variable-length number */
                    bytes[at + 3] = 0x7F;
                    at += 4;
                }
                memset(bytes + at, fill, sizeof bytes - at);
                assert_int_not_equal(read_bytes(&io, "a.drc", bytes, sizeof bytes), CSGM_OK);
            }
#ifndef __SANITIZE_ADDRESS__
    struct rusage usage;
    assert_int_equal(getrusage(RUSAGE_SELF, &usage), 0);
    if (usage.ru_maxrss > RSS_MOST_KIB)
        fail_msg("%ld KiB were taken", usage.ru_maxrss);
#endif
    io_context_check(&io);
}

/* Every allocation of a read fails once. */
static void memory_may_run_out(void **state)
{
    (void)state;
    char folder[128];
    io_folder_make(folder, sizeof folder);
    for (int i = 0; i < SAMPLES; i++) {
        if (!usable(&samples[i]))
            continue;
        size_t size;
        uint8_t *bytes = make_sample(&samples[i], folder, &size);
        bool read = false;
        for (uint64_t limit = 64; limit < 1 << 20 && !read; limit += limit / 16) {
            io_context io;
            io_context_init(&io, limit);
            csgm_status status = read_bytes(&io, samples[i].name, bytes, size);
            read = status == CSGM_OK;
            if (!read)
                assert_int_equal(status, CSGM_ERR_MEMORY);
            io_context_check(&io);
        }
        assert_true(read);
        free(bytes);
    }
    io_folder_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_reader_has_a_sample),     cmocka_unit_test(every_reader_survives),
        cmocka_unit_test(lies_are_told_apart),           cmocka_unit_test(deep_json_is_refused),
        cmocka_unit_test(draco_counts_are_not_believed), cmocka_unit_test(memory_may_run_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
