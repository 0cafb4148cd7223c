/* SPDX-License-Identifier: MIT
 * Each row of formats.def tells the truth: the bytes of a file change with what the format keeps
 * and with the options that it heeds, and with nothing else. Formats of one way are refused in the
 * other.
 */
#include "support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/format_table.h"
#include "io/stream.h"

/* A mesh with everything, and how it is written. */
typedef struct sample {
    csgm_mesh_view view;
    csgm_mesh_part parts[3];
    csgm_write_options options;
} sample;

typedef struct change {
    uint32_t trait;
    const char *what;
    void (*make)(csgm_mesh *mesh, sample *s);
} change;

static void turn_normals(csgm_mesh *mesh, sample *s)
{
    (void)s;
    for (int k = 0; k < 3; k++)
        mesh->normals[k] = k == 1 ? 1.0f : 0.0f;
}

static void paint(csgm_mesh *mesh, sample *s)
{
    (void)s;
    mesh->colors[0] ^= 0x80;
}

static void make_translucent(csgm_mesh *mesh, sample *s)
{
    (void)s;
    for (uint64_t i = 0; i < mesh->vertex_count; i++)
        mesh->colors[4 * i + 3] = 100;
}

static void call_otherwise(csgm_mesh *mesh, sample *s)
{
    (void)mesh;
    s->parts[1].name = "another name";
}

static void polish(csgm_mesh *mesh, sample *s)
{
    (void)s;
    for (uint64_t i = 0; i < mesh->vertex_count; i++)
        mesh->materials[2 * i] = 5000;
}

static void move_a_little(csgm_mesh *mesh, sample *s)
{
    (void)mesh;
    s->view.origin.x += 1e-6; /* floats are 1 apart there */
}

static void ask_for_text(csgm_mesh *mesh, sample *s)
{
    (void)mesh;
    s->options.ascii = true;
}

static void leave_z_up(csgm_mesh *mesh, sample *s)
{
    (void)mesh;
    s->options.y_up = false;
}

static void measure_in_inches(csgm_mesh *mesh, sample *s)
{
    (void)mesh;
    s->options.unit = CSGM_UNIT_IN;
}

static void add_comment(csgm_mesh *mesh, sample *s)
{
    (void)mesh;
    s->options.comment = "said by nobody";
}

static void compress(csgm_mesh *mesh, sample *s)
{
    (void)mesh;
    s->options.draco = true;
}

static void compress_otherwise(csgm_mesh *mesh, sample *s)
{
    (void)mesh;
    s->options.meshopt = true;
}

static void entitle(csgm_mesh *mesh, sample *s)
{
    static const char *const texts[] = {"title=Mug"};
    (void)mesh;
    s->options.metadata = texts;
    s->options.metadata_count = 1;
}

static void project(csgm_mesh *mesh, sample *s)
{
    (void)mesh;
    s->options.uv = CSGM_UV_BOX;
}

static void repeat_as_level(csgm_mesh *mesh, sample *s)
{
    static csgm_level level;
    level = (csgm_level){.mesh = csg_mesh_view(mesh), .error = 0.5};
    s->options.levels = &level;
    s->options.level_count = 1;
}

static void round_more(csgm_mesh *mesh, sample *s)
{
    (void)mesh;
    s->options.draco_position_bits = 8;
}

static const change changes[] = {
    {CSGM_KEEPS_NORMALS, "normals", turn_normals},
    {CSGM_KEEPS_COLORS, "colours", paint},
    {CSGM_KEEPS_ALPHA | CSGM_KEEPS_PLAIN_LOOKS, "opacity", make_translucent},
    {CSGM_KEEPS_NAMES, "names", call_otherwise},
    {CSGM_KEEPS_MATERIALS | CSGM_KEEPS_PLAIN_LOOKS, "materials", polish},
    {CSGM_KEEPS_DOUBLES, "doubles", move_a_little},
    {CSGM_HEEDS_ASCII, "ascii", ask_for_text},
    {CSGM_HEEDS_UP, "up", leave_z_up},
    {CSGM_HEEDS_UNIT, "unit", measure_in_inches},
    {CSGM_HEEDS_COMMENT, "comment", add_comment},
    {CSGM_HEEDS_DRACO, "draco", compress},
    {CSGM_HEEDS_MESHOPT, "meshopt", compress_otherwise},
    {CSGM_HEEDS_UV, "uv", project},
    {CSGM_HEEDS_LEVELS, "levels", repeat_as_level},
    {CSGM_HEEDS_METADATA, "metadata", entitle},
    {CSGM_HEEDS_DRACO_BITS, "draco bits", round_more},
};

/* The file's bytes; NULL where this build cannot compress. free() them. */
static uint8_t *write_sample(const char *folder, csgm_format format, const change *c, size_t *size)
{
    io_context io;
    char path[256];
    io_context_init(&io, 0);
    csgm_mesh *mesh = io_shape_make(&io.context, IO_PARTS);
    sample s = {.view = csg_mesh_view(mesh), .options = csg_write_options_default()};
    memcpy(s.parts, s.view.parts, sizeof s.parts);
    s.view.parts = s.parts;
    s.view.origin = (csgm_vec3){1e5, -2e5, 3e5};
    if (c)
        c->make(mesh, &s);
    snprintf(path, sizeof path, "%s/a.%s", folder, csg_format_name(format));
    csgm_status status = csg_io_write(&io.context, &s.view, path, format, &s.options);
    bool lacks_draco = s.options.draco && !csg_format_available(CSGM_FORMAT_DRC, false);
    bool lacks_meshopt = s.options.meshopt && !csg_meshopt_available();
    assert_int_equal(status,
                     (lacks_draco && csg_format_traits(format) & CSGM_HEEDS_DRACO) ||
                             (lacks_meshopt && csg_format_traits(format) & CSGM_HEEDS_MESHOPT)
                         ? CSGM_ERR_UNSUPPORTED
                         : CSGM_OK);
    csg_mesh_destroy(mesh);
    io_context_check(&io);
    uint8_t *bytes = status == CSGM_OK ? io_file_load(path, size) : NULL;
    remove(path);
    snprintf(path, sizeof path, "%s/a.mtl", folder); /* of OBJ */
    remove(path);
    return bytes;
}

static bool is_text(const uint8_t *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++)
        if (bytes[i] < ' ' && !strchr("\t\n\r", bytes[i]))
            return false;
    return true;
}

static void check_row(const char *folder, csgm_format format)
{
    const char *name = csg_format_name(format);
    uint32_t traits = csg_format_traits(format);
    size_t size, other_size;
    uint8_t *bytes = write_sample(folder, format, NULL, &size);
    if (is_text(bytes, size) != (bool)(traits & CSGM_IS_TEXT))
        fail_msg("%s: its row and its bytes disagree about text", name);
    for (size_t i = 0; i < sizeof changes / sizeof *changes; i++) {
        uint8_t *other = write_sample(folder, format, &changes[i], &other_size);
        bool differs = !other || size != other_size || memcmp(bytes, other, size) != 0;
        if (differs != (bool)(traits & changes[i].trait))
            fail_msg("%s: its row says that it %s %s, its bytes say otherwise", name,
                     differs ? "does not keep or heed" : "keeps or heeds", changes[i].what);
        free(other);
    }
    const csg_format_row *row = csg_format_recognise(bytes, size);
    const csg_format_row *own = csg_format_find(format);
    if (*own->first_bytes && row != own)
        fail_msg("%s: its files do not begin as its row says", name);
    free(bytes);
}

static void rows_say_what_writers_do(void **state)
{
    (void)state;
    char folder[128];
    io_folder_make(folder, sizeof folder);
    for (int f = CSGM_FORMAT_AUTO + 1; f < CSGM_FORMAT_COUNT; f++)
        if (csg_format_available((csgm_format)f, false))
            check_row(folder, (csgm_format)f);
    io_folder_remove(folder);
}

static void rows_are_complete(void **state)
{
    (void)state;
    for (int f = CSGM_FORMAT_AUTO + 1; f < CSGM_FORMAT_COUNT; f++) {
        const csg_format_row *row = csg_format_find((csgm_format)f);
        assert_non_null(row);
        assert_int_equal(csg_format_from_name(row->name), row->id);
        assert_true(row->write || row->read);
        assert_true(*row->title && *row->remarks);
        csgm_write_options options = csg_write_options_default();
        assert_int_equal(csg_stream_is_possible("/none/such", row->id, 0, &options),
                         csg_format_traits(row->id) & CSGM_IS_STREAMED ? 1 : 0);
    }
}

/* Today's formats all go both ways: rows of their own. */
static void one_way_formats_are_refused(void **state)
{
    (void)state;
    io_context io;
    io_context_init(&io, 0);
    csg_format_row row = *csg_format_find(CSGM_FORMAT_OFF);
    row.title = "XYZ";
    row.read = NULL;
    assert_int_equal(csg_format_check(&io.context, "a.xyz", &row, false), CSGM_OK);
    assert_int_equal(io.findings, 0);
    assert_int_equal(csg_format_check(&io.context, "a.xyz", &row, true), CSGM_ERR_UNSUPPORTED);
    assert_string_equal(io.last, "csgmesh writes XYZ files and cannot read them");
    row.read = csg_off_read;
    row.write = NULL;
    assert_int_equal(csg_format_check(&io.context, "a.xyz", &row, false), CSGM_ERR_UNSUPPORTED);
    assert_string_equal(io.last, "csgmesh reads XYZ files and cannot write them");
    assert_int_equal(io.findings, 2);
    io_context_check(&io);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rows_say_what_writers_do),
                                       cmocka_unit_test(rows_are_complete),
                                       cmocka_unit_test(one_way_formats_are_refused)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
