/* SPDX-License-Identifier: MIT
 * Files of floats and of Draco's grid hold the mesh that was made: no triangle collapses and
 * nothing is lost where its vertices are nearer to each other than what the file can tell apart;
 * else the file is refused.
 */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "mesh/inspect.h"
#include "mesh/weld.h"

typedef struct place {
    io_context io;
    csgm_mesh *mesh;
    csgm_mesh_view view;
    char folder[128], path[160];
} place;

/* A sphere of 2 * columns * (rows - 1) triangles, its middle so far from zero on each axis. */
static void begin(place *p, const char *name, uint32_t columns, uint32_t rows, double away)
{
    io_context_init(&p->io, 0);
    p->mesh = io_sphere_make(&p->io.context, columns, rows);
    p->mesh->origin = (csgm_vec3){away, away, away};
    p->view = csg_mesh_view(p->mesh);
    io_folder_make(p->folder, sizeof p->folder);
    snprintf(p->path, sizeof p->path, "%s/%s", p->folder, name);
}

static void end(place *p)
{
    csg_mesh_destroy(p->mesh);
    io_context_check(&p->io);
    io_folder_remove(p->folder);
}

/* The file as a reader sees it that knows places only. */
static csgm_mesh_check inspect_file(place *p, double nearness)
{
    csgm_mesh *back;
    csgm_mesh_check check;
    uint32_t to[100000];
    uint32_t indices[200000];
    bool failed;
    assert_int_equal(csg_io_read(&p->io.context, p->path, CSGM_FORMAT_AUTO, &back), CSGM_OK);
    csgm_mesh_view view = csg_mesh_view(back);
    assert_true(view.vertex_count < 100000 && 3 * view.triangle_count < 200000);
    for (uint64_t i = 0; i < 3 * view.triangle_count && nearness > 0; i++) {
        const float *read = view.positions + 3 * (uint64_t)view.indices[i];
        const float *made = p->view.positions + 3 * (uint64_t)p->view.indices[i];
        for (int k = 0; k < 3; k++)
            assert_true(fabs((&view.origin.x)[k] + (double)read[k] - (&p->view.origin.x)[k] -
                             (double)made[k]) <= nearness);
    }
    csg_weld_map(&p->io.context.memory, &view, CSG_WELD_ALL, to, &failed);
    assert_false(failed);
    for (uint64_t i = 0; i < 3 * view.triangle_count; i++)
        indices[i] = to[view.indices[i]];
    view.indices = indices;
    assert_int_equal(csg_mesh_inspect(&p->io.context, &view, 0, &check), CSGM_OK);
    csg_mesh_destroy(back);
    return check;
}

static void expect_whole(place *p, const csgm_write_options *options, double nearness)
{
    assert_int_equal(csg_io_write(&p->io.context, &p->view, p->path, CSGM_FORMAT_AUTO, options),
                     CSGM_OK);
    csgm_mesh_check check = inspect_file(p, nearness);
    assert_int_equal(check.degenerate_triangles, 0);
    assert_int_equal(check.zero_area_triangles, 0);
    assert_int_equal(check.boundary_edges, 0);
    assert_int_equal(check.nonmanifold_edges, 0);
    assert_int_equal(check.misoriented_edges, 0);
    assert_int_equal(check.nonmanifold_vertices, 0);
    assert_int_equal(check.components, 1);
    assert_int_equal(check.euler, 2);
}

/* The triangles that rounding alone would have collapsed. */
static uint64_t count_collapsed(const csgm_mesh_view *mesh)
{
    uint64_t count = 0;
    for (uint64_t t = 0; t < mesh->triangle_count; t++) {
        float at[3][3];
        for (int i = 0; i < 9; i++)
            at[i / 3][i % 3] =
                (float)((&mesh->origin.x)[i % 3] +
                        (double)mesh->positions[3 * mesh->indices[3 * t + (uint64_t)(i / 3)] +
                                                (uint32_t)(i % 3)]);
        count += memcmp(at[0], at[1], 12) == 0 || memcmp(at[1], at[2], 12) == 0 ||
                 memcmp(at[2], at[0], 12) == 0;
    }
    return count;
}

static void stl_far_from_zero_is_whole(void **state)
{
    (void)state;
    for (double away = 2e5; away < 5e5; away *= 2) { /* floats in steps of 1/64 and 1/32 */
        place p;
        begin(&p, "a.stl", 400, 60, away);
        assert_true(count_collapsed(&p.view) > 0);
        expect_whole(&p, NULL, 3 * ldexp(1, ilogb(away) - 23));
        csgm_write_options options = csg_write_options_default();
        options.ascii = true;
        expect_whole(&p, &options, 0);
        end(&p);
    }
}

static void draco_on_a_coarse_grid_is_whole(void **state)
{
    (void)state;
    for (uint32_t bits = 8; bits < 12; bits++) {
        place p;
        begin(&p, "a.drc", 120, 60, bits % 2 ? 0 : 1e5);
        csgm_write_options options = csg_write_options_default();
        options.draco_position_bits = bits;
        options.draco = true;
        if (!csg_format_available(CSGM_FORMAT_DRC, false)) {
            end(&p);
            skip();
        }
        expect_whole(&p, &options, 0);
        if (csg_format_available(CSGM_FORMAT_GLB, true)) {
            snprintf(p.path, sizeof p.path, "%s/a.glb", p.folder);
            expect_whole(&p, &options, 0);
        }
        end(&p);
    }
}

static void much_that_moves_is_told(void **state)
{
    (void)state;
    place p;
    begin(&p, "a.stl", 200, 60, 1e6);
    expect_whole(&p, NULL, 0);
    assert_int_equal(p.io.findings, 1);
    assert_non_null(strstr(p.io.last, "STL has floats in steps of 0.0625 there"));
    end(&p);
}

static void what_cannot_be_told_apart_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *name, *said;
        double away;
    } cases[] = {{"a.stl", "STL has floats in steps of 1.02e+03", 1e10},
                 {"a.ply", "PLY has doubles in steps of 2", 1e16},
                 {"a.obj", "OBJ has doubles in steps of 2", 1e16}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        place p;
        begin(&p, cases[i].name, 60, 30, cases[i].away);
        assert_int_equal(csg_io_write(&p.io.context, &p.view, p.path, CSGM_FORMAT_AUTO, NULL),
                         CSGM_ERR_UNSUPPORTED);
        if (!strstr(p.io.last, cases[i].said))
            fail_msg("'%s' does not say '%s'", p.io.last, cases[i].said);
        assert_int_equal(io_folder_count(p.folder), 0);
        end(&p);
    }
}

/* A corner of a triangle half way between the mesh's ends in x, and at none of those in y and z. */
static uint64_t corner_in_the_middle(const csgm_mesh_view *mesh)
{
    for (uint64_t i = 0; i < 3 * mesh->triangle_count; i++) {
        const float *at = mesh->positions + 3 * (uint64_t)mesh->indices[i];
        if (fabsf(at[0]) < 1e-5f && fabsf(at[1]) < 8 && fabsf(at[2]) < 8)
            return i;
    }
    fail();
    return 0;
}

/* Zero is half way between two numbers of the grid. In floats the larger one of two places a little
 * below it is rounded up, in doubles it is not: looked at in one way and written in the
 * other, they would meet. */
static void halves_of_a_step_stay_apart(void **state)
{
    (void)state;
    place p;
    begin(&p, "a.glb", 24, 12, 0);
    uint64_t i = corner_in_the_middle(&p.view);
    uint64_t upper = p.view.indices[i], lower = p.view.indices[i / 3 * 3 + (i + 1) % 3];
    memcpy(p.mesh->positions + 3 * lower, p.mesh->positions + 3 * upper, 12);
    p.mesh->positions[3 * upper] = -2e-7f;
    p.mesh->positions[3 * lower] = -3e-6f;
    csgm_write_options options = csg_write_options_default();
    options.meshopt = true;
    expect_whole(&p, &options, 0);
    end(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stl_far_from_zero_is_whole),
        cmocka_unit_test(draco_on_a_coarse_grid_is_whole),
        cmocka_unit_test(much_that_moves_is_told),
        cmocka_unit_test(what_cannot_be_told_apart_is_refused),
        cmocka_unit_test(halves_of_a_step_stay_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
