/* SPDX-License-Identifier: MIT
 * Files appear complete or not at all: good targets, bad targets, links, devices, interruptions.
 */
#include "support.h"

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/file.h"

typedef struct fixture {
    io_context io;
    csgm_mesh *mesh;
    csgm_mesh_view view;
    char folder[128];
    char path[256];
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    io_context_init(&f->io, 0);
    f->mesh = io_shape_make(&f->io.context, IO_SPHERE);
    f->view = csg_mesh_view(f->mesh);
    io_folder_make(f->folder, sizeof f->folder);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    csg_mesh_destroy(f->mesh);
    io_context_check(&f->io);
    io_folder_remove(f->folder);
    free(f);
    return 0;
}

static const char *in_folder(fixture *f, const char *name)
{
    snprintf(f->path, sizeof f->path, "%s/%s", f->folder, name);
    return f->path;
}

static csgm_status write_to(fixture *f, const char *path)
{
    return csg_io_write(&f->io.context, &f->view, path, CSGM_FORMAT_AUTO, NULL);
}

static void expect_refused(fixture *f, const char *path, csgm_status status, const char *text)
{
    uint32_t before = f->io.findings;
    assert_int_equal(csg_io_write(&f->io.context, &f->view, path, CSGM_FORMAT_PLY, NULL), status);
    assert_int_equal(f->io.findings, before + 1);
    if (!strstr(f->io.last, text))
        fail_msg("'%s' does not say '%s'", f->io.last, text);
}

static void new_file_honours_the_umask(void **state)
{
    fixture *f = *state;
    struct stat made;
    mode_t kept = umask(027);
    assert_int_equal(write_to(f, in_folder(f, "a.ply")), CSGM_OK);
    umask(kept);
    assert_int_equal(stat(f->path, &made), 0);
    assert_int_equal(made.st_mode & 0777, 0640);
    assert_int_equal(io_folder_count(f->folder), 1);
}

static void old_file_keeps_its_mode(void **state)
{
    fixture *f = *state;
    struct stat made;
    assert_int_equal(write_to(f, in_folder(f, "a.stl")), CSGM_OK);
    assert_int_equal(chmod(f->path, 0604), 0);
    assert_int_equal(write_to(f, f->path), CSGM_OK);
    assert_int_equal(stat(f->path, &made), 0);
    assert_int_equal(made.st_mode & 0777, 0604);
}

static void link_is_written_through(void **state)
{
    fixture *f = *state;
    char target[256];
    struct stat made;
    snprintf(target, sizeof target, "%s/target.ply", f->folder);
    assert_int_equal(symlink("target.ply", in_folder(f, "link.ply")), 0);
    for (int i = 0; i < 2; i++) { /* first it leads nowhere yet */
        assert_int_equal(write_to(f, f->path), CSGM_OK);
        assert_int_equal(lstat(f->path, &made), 0);
        assert_true(S_ISLNK(made.st_mode));
        assert_int_equal(lstat(target, &made), 0);
        assert_true(S_ISREG(made.st_mode));
        assert_true(made.st_size > 1000);
    }
    assert_int_equal(symlink("loop.ply", in_folder(f, "loop.ply")), 0);
    expect_refused(f, f->path, CSGM_ERR_IO, "symbolic links");
}

static void bad_targets_are_one_finding(void **state)
{
    fixture *f = *state;
    expect_refused(f, "/dev/full", CSGM_ERR_IO, "No space left");
    expect_refused(f, f->folder, CSGM_ERR_IO, "Is a directory");
    expect_refused(f, in_folder(f, "none/a.ply"), CSGM_ERR_IO, "No such file");
    expect_refused(f, "", CSGM_ERR_IO, "No such file");
    assert_int_equal(write_to(f, in_folder(f, "a.ply")), CSGM_OK);
    expect_refused(f, in_folder(f, "a.ply/b.ply"), CSGM_ERR_IO, "Not a directory");
    char name[512];
    snprintf(name, sizeof name, "%s/%0300d.ply", f->folder, 0);
    expect_refused(f, name, CSGM_ERR_IO, "File name too long");
    assert_int_equal(io_folder_count(f->folder), 1);
}

static void every_format_tells_a_full_disk(void **state)
{
    fixture *f = *state;
    for (int i = CSGM_FORMAT_AUTO + 1; i < CSGM_FORMAT_COUNT; i++) {
        csgm_format format = (csgm_format)i;
        if (!csg_format_available(format, false))
            continue;
        uint32_t before = f->io.findings;
        csgm_status status = csg_io_write(&f->io.context, &f->view, "/dev/full", format, NULL);
        if (status != CSGM_ERR_IO || f->io.findings != before + 1 ||
            !strstr(f->io.last, "No space left"))
            fail_msg("%s: status %d, '%s'", csg_format_name(format), (int)status, f->io.last);
    }
}

static void read_only_targets_are_refused(void **state)
{
    fixture *f = *state;
    if (geteuid() == 0)
        skip(); /* nothing is read-only to root */
    assert_int_equal(write_to(f, in_folder(f, "a.ply")), CSGM_OK);
    assert_int_equal(chmod(f->path, 0444), 0);
    expect_refused(f, f->path, CSGM_ERR_IO, "Permission denied");
    assert_int_equal(chmod(f->folder, 0555), 0);
    expect_refused(f, in_folder(f, "b.ply"), CSGM_ERR_IO, "Permission denied");
    assert_int_equal(chmod(f->folder, 0755), 0);
    assert_int_equal(io_folder_count(f->folder), 1);
}

static void refused_mesh_leaves_the_old_file(void **state)
{
    fixture *f = *state;
    size_t before, after;
    assert_int_equal(write_to(f, in_folder(f, "a.ply")), CSGM_OK);
    free(io_file_load(f->path, &before));
    float kept = f->mesh->positions[7];
    f->mesh->positions[7] = (float)NAN;
    expect_refused(f, f->path, CSGM_ERR_ARGUMENT, "not a number");
    f->mesh->positions[7] = kept;
    kept = f->mesh->normals[7];
    f->mesh->normals[7] = (float)INFINITY;
    expect_refused(f, f->path, CSGM_ERR_ARGUMENT, "a normal");
    f->mesh->normals[7] = kept;
    f->mesh->indices[5] = (uint32_t)f->mesh->vertex_count;
    expect_refused(f, f->path, CSGM_ERR_ARGUMENT, "does not exist");
    free(io_file_load(f->path, &after));
    assert_int_equal(before, after);
    assert_int_equal(io_folder_count(f->folder), 1);
}

/* A limit on file sizes stands in for a full disk: it holds for the whole process, so in a child.
 */
static void full_disk_leaves_nothing(void **state)
{
    fixture *f = *state;
    in_folder(f, "a.ply");
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        signal(SIGXFSZ, SIG_IGN);
        struct rlimit limit = {.rlim_cur = 10000, .rlim_max = 10000};
        bool limited = setrlimit(RLIMIT_FSIZE, &limit) == 0;
        bool refused = write_to(f, f->path) == CSGM_ERR_IO && strstr(f->io.last, "File too large");
        _exit(limited && refused ? 0 : 1);
    }
    int status;
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_int_equal(status, 0);
    assert_int_equal(io_folder_count(f->folder), 0);
}

static void devices_and_pipes_are_written_directly(void **state)
{
    fixture *f = *state;
    assert_int_equal(csg_io_write(&f->io.context, &f->view, "/dev/null", CSGM_FORMAT_GLB, NULL),
                     CSGM_OK);
    struct stat device;
    assert_int_equal(stat("/dev/null", &device), 0);
    assert_true(S_ISCHR(device.st_mode));
    int ends[2];
    char name[64];
    csgm_mesh *small = io_shape_make(&f->io.context, IO_TETRAHEDRON);
    csgm_mesh_view view = csg_mesh_view(small);
    uint8_t bytes[4096];
    assert_int_equal(pipe(ends), 0);
    snprintf(name, sizeof name, "/dev/fd/%d", ends[1]);
    assert_int_equal(csg_io_write(&f->io.context, &view, name, CSGM_FORMAT_STL, NULL), CSGM_OK);
    assert_int_equal(read(ends[0], bytes, sizeof bytes), 84 + 4 * 50);
    close(ends[0]);
    signal(SIGPIPE, SIG_IGN);
    expect_refused(f, name, CSGM_ERR_IO, "Broken pipe");
    assert_int_equal(csg_io_write_fd(&f->io.context, &view, ends[1], "pipe", CSGM_FORMAT_OBJ, NULL),
                     CSGM_ERR_IO);
    close(ends[1]);
    csg_mesh_destroy(small);
}

static void cleanup_removes_a_temporary(void **state)
{
    fixture *f = *state;
    csg_atomic_file file;
    csg_temporary named;
    csg_arena names;
    csg_arena_init(&names, &f->io.context.memory);
    assert_int_equal(csg_temporary_open_named(&named, &names, in_folder(f, "a.ply")), 0);
    assert_int_equal(io_folder_count(f->folder), 1);
    csg_io_cleanup_pending();
    assert_int_equal(io_folder_count(f->folder), 0);
    csg_temporary_close(&named);
    csg_arena_reset(&names);
    assert_int_equal(csg_file_create(&file, &f->io.context, f->path), CSGM_OK);
    csg_io_cleanup_pending();
    assert_int_equal(io_folder_count(f->folder), 0);
    csg_file_abandon(&file);
    assert_int_equal(csg_file_create(&file, &f->io.context, f->path), CSGM_OK);
    assert_int_equal(csg_file_commit(&file), CSGM_OK);
    csg_io_cleanup_pending();
    assert_int_equal(io_folder_count(f->folder), 1);
}

/* Draco leaves out a triangle of two corners, which it tells while it writes. */
static void a_warning_of_writing_may_be_an_error(void **state)
{
    fixture *f = *state;
    if (!csg_format_available(CSGM_FORMAT_DRC, false))
        skip();
    f->mesh->indices[0] = f->mesh->indices[1];
    f->io.context.diags.warnings_as_errors = true;
    assert_int_equal(write_to(f, in_folder(f, "a.drc")), CSGM_ERR_SCENE);
    assert_non_null(strstr(f->io.last, "degenerate"));
    assert_int_equal(io_folder_count(f->folder), 0);
    f->io.context.diags.warnings_as_errors = false;
    assert_int_equal(write_to(f, f->path), CSGM_OK);
}

/* A limit that is over at once: no verdict depends on how fast this machine is. */
static void reading_ends_in_time(void **state)
{
    fixture *f = *state;
    for (int i = CSGM_FORMAT_AUTO + 1; i < CSGM_FORMAT_COUNT; i++) {
        csgm_format format = (csgm_format)i;
        csgm_mesh *mesh = NULL;
        if (!csg_format_available(format, false) || !csg_format_available(format, true))
            continue;
        in_folder(f, "a.mesh");
        assert_int_equal(csg_io_write(&f->io.context, &f->view, f->path, format, NULL), CSGM_OK);
        uint32_t before = f->io.findings;
        f->io.context.limits.timeout_s = 1e-9;
        csgm_status status = csg_io_read(&f->io.context, f->path, format, &mesh);
        f->io.context.limits.timeout_s = 0;
        if (status != CSGM_ERR_LIMIT || f->io.findings != before + 1 ||
            !strstr(f->io.last, "takes more than"))
            fail_msg("%s: status %d, '%s'", csg_format_name(format), (int)status, f->io.last);
        assert_int_equal(csg_io_read(&f->io.context, f->path, format, &mesh), CSGM_OK);
        csg_mesh_destroy(mesh);
    }
}

static void names_and_options_are_checked(void **state)
{
    fixture *f = *state;
    assert_int_equal(write_to(f, in_folder(f, "a.nothing")), CSGM_ERR_UNSUPPORTED);
    assert_int_equal(write_to(f, in_folder(f, "noextension")), CSGM_ERR_UNSUPPORTED);
    assert_int_equal(write_to(f, in_folder(f, "A.PLY")), CSGM_OK);
    csgm_write_options options = csg_write_options_default();
    options.draco_position_bits = 31;
    assert_int_equal(
        csg_io_write(&f->io.context, &f->view, in_folder(f, "b.glb"), CSGM_FORMAT_AUTO, &options),
        CSGM_ERR_ARGUMENT);
    assert_int_equal(io_folder_count(f->folder), 1);
    assert_int_equal(csg_format_from_path("a.b/c"), CSGM_FORMAT_AUTO);
    assert_int_equal(csg_format_from_path("c.GLB"), CSGM_FORMAT_GLB);
    assert_int_equal(csg_format_from_path(NULL), CSGM_FORMAT_AUTO);
    assert_string_equal(csg_format_name(CSGM_FORMAT_DRC), "drc");
    assert_false(csg_format_available(CSGM_FORMAT_AUTO, false));
    assert_true(csg_format_available(CSGM_FORMAT_GLB, false));
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)
    const struct CMUnitTest tests[] = {
        TEST(new_file_honours_the_umask),
        TEST(old_file_keeps_its_mode),
        TEST(link_is_written_through),
        TEST(bad_targets_are_one_finding),
        TEST(read_only_targets_are_refused),
        TEST(refused_mesh_leaves_the_old_file),
        TEST(full_disk_leaves_nothing),
        TEST(devices_and_pipes_are_written_directly),
        TEST(cleanup_removes_a_temporary),
        TEST(names_and_options_are_checked),
        TEST(every_format_tells_a_full_disk),
        TEST(reading_ends_in_time),
        TEST(a_warning_of_writing_may_be_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
