/* SPDX-License-Identifier: MIT
 * csgm_mesh_build_file keeps the context's limits, and whatever ends it closes what it opened,
 * gives back its memory and leaves no file. Its statistics fit structs of other versions; held
 * files appear together or not at all.
 */
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "counting.h"
#include "csgmesh/csgmesh.h"

/* Filled as a stream, and from a mesh in memory. */
static const char *const names[] = {"a.ply", "a.obj"};
enum { NAMES = sizeof names / sizeof *names };

/* ---- what is there ---------------------------------------------------------------------- */

static size_t count_entries(const char *folder)
{
    size_t count = 0;
    const struct dirent *entry;
    DIR *directory = opendir(folder);
    assert_non_null(directory);
    while ((entry = readdir(directory)))
        count += entry->d_name[0] != '.' || strlen(entry->d_name) > 2;
    closedir(directory);
    return count;
}

typedef struct fixture {
    char folder[64], path[128];
    csgm_context *context;
    csgm_scene *scene;
    csgm_field *field;
    counting memory;
    size_t descriptors;
} fixture;

static void begin(fixture *f, uint64_t memory_bytes)
{
    static const char text[] = "union(blend = 0.3) { sphere(1); translate([1, 0, 0]) cube(1); }";
    csgm_context_options options = csgm_context_options_default();
    *f = (fixture){.folder = "/tmp/csg-build-XXXXXX"};
    assert_non_null(mkdtemp(f->folder));
    options.threads = 2;
    options.limits.memory_bytes = memory_bytes;
    options.allocator =
        (csgm_allocator){.alloc = counting_alloc, .release = counting_release, .user = &f->memory};
    assert_int_equal(csgm_context_create(&options, &f->context), CSGM_OK);
    assert_int_equal(csgm_scene_parse(f->context, text, sizeof text - 1, "test", NULL, &f->scene),
                     CSGM_OK);
    assert_int_equal(csgm_field_compile(f->context, f->scene, &f->field), CSGM_OK);
    f->descriptors = count_entries("/proc/self/fd");
}

static void end(fixture *f)
{
    csgm_field_destroy(f->field);
    csgm_scene_destroy(f->scene);
    csgm_context_destroy(f->context);
    assert_int_equal(count_entries("/proc/self/fd"), f->descriptors);
    assert_int_equal(f->memory.blocks, 0);
    assert_int_equal(count_entries(f->folder), 0);
    assert_int_equal(rmdir(f->folder), 0);
}

static csgm_status build(fixture *f, const char *name, uint32_t cells, csgm_mesh_stats *stats)
{
    csgm_mesh_options mesh = csgm_mesh_options_default();
    csgm_write_options options = csgm_write_options_default();
    mesh.resolution = cells;
    options.sync = false;
    snprintf(f->path, sizeof f->path, "%s/%s", f->folder, name);
    return csgm_mesh_build_file(f->context, f->field, &mesh, f->path, CSGM_FORMAT_AUTO, &options,
                                NULL, stats);
}

/* ---- the tests -------------------------------------------------------------------------- */

static void test_memory_limit(void **state)
{
    (void)state;
    for (size_t i = 0; i < NAMES; i++) {
        fixture f;
        uint64_t peak;
        begin(&f, 2 << 20);
        assert_int_equal(build(&f, names[i], 400, NULL), CSGM_ERR_MEMORY);
        csgm_context_memory(f.context, &peak);
        assert_true(peak <= 2 << 20);
        end(&f);
    }
}

static void test_any_allocation_may_fail(void **state)
{
    (void)state;
    for (size_t i = 0; i < NAMES; i++) {
        csgm_status status = CSGM_ERR_MEMORY;
        for (int64_t at = 1; status == CSGM_ERR_MEMORY; at++) {
            fixture f;
            begin(&f, 0);
            f.memory.fail_at = f.memory.calls + at;
            status = build(&f, names[i], 12, NULL);
            if (status)
                assert_int_equal(status, CSGM_ERR_MEMORY);
            if (status == CSGM_OK)
                assert_int_equal(unlink(f.path), 0);
            f.memory.fail_at = 0;
            end(&f);
        }
    }
}

static void test_statistics_of_other_versions(void **state)
{
    (void)state;
    fixture f;
    csgm_mesh_stats stats = csgm_mesh_stats_default(), whole = stats;
    const uint32_t own = stats.struct_size;
    const uint32_t refused[] = {0, 8, own - 1, own + 8, UINT32_MAX};
    begin(&f, 0);
    for (size_t i = 0; i < sizeof refused / sizeof *refused; i++) {
        stats.struct_size = refused[i];
        assert_int_equal(build(&f, names[0], 12, &stats), CSGM_ERR_ARGUMENT);
        csgm_mesh *mesh;
        assert_int_equal(csgm_mesh_build(f.context, f.field, NULL, &mesh, &stats),
                         CSGM_ERR_ARGUMENT);
        assert_null(mesh);
    }
    assert_int_equal(build(&f, names[0], 12, &whole), CSGM_OK);
    assert_int_equal(whole.struct_size, own);
    assert_true(whole.cell_size > 0 && whole.cells[0] > 0);
    memset(&stats, 0x77, sizeof stats);
    stats.struct_size = offsetof(csgm_mesh_stats, feature_vertices);
    assert_int_equal(build(&f, names[0], 12, &stats), CSGM_OK);
    assert_true(stats.cell_size == whole.cell_size && stats.leaf_blocks == whole.leaf_blocks);
    const unsigned char *bytes = (const unsigned char *)&stats;
    for (size_t i = stats.struct_size; i < sizeof stats; i++)
        assert_int_equal(bytes[i], 0x77); /* behind the caller's struct nothing is written */
    assert_int_equal(unlink(f.path), 0);
    end(&f);
}

static void test_held_files(void **state)
{
    (void)state;
    fixture f;
    begin(&f, 0);
    for (int keep = 0; keep < 2; keep++) {
        assert_int_equal(csgm_files_hold(f.context), CSGM_OK);
        for (size_t i = 0; i < NAMES; i++) {
            assert_int_equal(build(&f, names[i], 12, NULL), CSGM_OK);
            assert_int_not_equal(access(f.path, F_OK), 0);
        }
        assert_int_equal(csgm_files_release(f.context, keep), CSGM_OK);
        assert_int_equal(count_entries(f.folder), keep ? NAMES : 0);
    }
    assert_int_equal(csgm_files_hold(f.context), CSGM_OK); /* what is not released is removed */
    assert_int_equal(build(&f, "b.ply", 12, NULL), CSGM_OK);
    for (size_t i = 0; i < NAMES; i++) {
        snprintf(f.path, sizeof f.path, "%s/%s", f.folder, names[i]);
        assert_int_equal(unlink(f.path), 0);
    }
    end(&f);
    assert_int_equal(csgm_files_hold(NULL), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_files_release(NULL, true), CSGM_ERR_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_memory_limit), cmocka_unit_test(test_any_allocation_may_fail),
        cmocka_unit_test(test_statistics_of_other_versions), cmocka_unit_test(test_held_files)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
