/* SPDX-License-Identifier: MIT
 * What is left of files that a killed process was writing: nothing where they had no name, else
 * what the next run sweeps; and that a sweep takes nothing else.
 */
#include "support.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/file.h"

typedef struct fixture {
    io_context io;
    csg_arena names;
    char folder[128], path[256];
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    io_context_init(&f->io, 0);
    csg_arena_init(&f->names, &f->io.context.memory);
    io_folder_make(f->folder, sizeof f->folder);
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    csg_arena_reset(&f->names);
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

static void make_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

typedef int opener(csg_temporary *file, csg_arena *names, const char *target);

/* A child that has opened a file and then waits, to be killed. *hidden: the file's name in it. */
static pid_t start_writer(fixture *f, opener *open_file, char hidden[256])
{
    int ends[2];
    in_folder(f, "a.ply");
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        csg_temporary file;
        char name[256] = "";
        if (open_file(&file, &f->names, f->path) == 0 && write(file.fd, "half", 4) == 4)
            snprintf(name, sizeof name, "%s", file.is_named ? file.name : "-");
        if (write(ends[1], name, sizeof name) < 0)
            _exit(1);
        for (;;)
            pause();
    }
    close(ends[1]);
    assert_int_equal(read(ends[0], hidden, 256), 256);
    close(ends[0]);
    assert_true(hidden[0]);
    return child;
}

static void end_writer(pid_t child)
{
    int status;
    assert_int_equal(kill(child, SIGKILL), 0);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status));
}

static void a_file_without_a_name_leaves_nothing(void **state)
{
    fixture *f = *state;
    char hidden[256];
    pid_t child = start_writer(f, csg_temporary_open, hidden);
    bool is_named = hidden[0] != '-';
    if (!is_named)
        assert_int_equal(io_folder_count(f->folder), 0);
    end_writer(child);
    if (is_named)
        skip(); /* this file system has none */
    assert_int_equal(io_folder_count(f->folder), 0);
}

static void a_hidden_file_is_swept_when_its_process_is_gone(void **state)
{
    fixture *f = *state;
    char hidden[256];
    pid_t child = start_writer(f, csg_temporary_open_named, hidden);
    csg_temporary_sweep(f->folder);
    assert_int_equal(access(hidden, F_OK), 0); /* it lives */
    end_writer(child);
    assert_int_equal(access(hidden, F_OK), 0);
    csg_temporary_sweep(f->folder);
    assert_int_not_equal(access(hidden, F_OK), 0);
}

/* As the next run does by itself. */
static void writing_sweeps_its_folder(void **state)
{
    fixture *f = *state;
    char hidden[256];
    csg_atomic_file file;
    end_writer(start_writer(f, csg_temporary_open_named, hidden));
    assert_int_equal(csg_file_create(&file, &f->io.context, in_folder(f, "b.ply")), CSGM_OK);
    assert_int_equal(csg_file_commit(&file), CSGM_OK);
    assert_int_equal(io_folder_count(f->folder), 1);
}

static void strangers_stay(void **state)
{
    static const char *const strangers[] = {".csgmesh-1-2.tmp",
                                            ".csgmesh-0.tmp",
                                            ".csgmesh-cache",
                                            ".csgmesh-00000000-99999999-1-0.tmp",
                                            ".csgmesh-zzzzzzzz-1-1-0.tmp",
                                            "csgmesh.tmp"};
    enum { STRANGERS = sizeof strangers / sizeof *strangers };
    fixture *f = *state;
    char hidden[256], kept[256], link[300];
    for (int i = 0; i < STRANGERS; i++)
        make_file(in_folder(f, strangers[i]), "mine");
    end_writer(start_writer(f, csg_temporary_open_named, hidden));
    snprintf(kept, sizeof kept, "%s", hidden);
    snprintf(link, sizeof link, "%.*s-7.tmp", (int)strcspn(kept, "\n") - 6, kept);
    assert_int_equal(symlink(strangers[0], link), 0); /* of a swept name, but no file */
    int holder = open(kept, O_RDONLY);
    assert_int_equal(flock(holder, LOCK_SH), 0); /* somebody has it */
    csg_temporary_sweep(f->folder);
    assert_int_equal(io_folder_count(f->folder), STRANGERS + 2);
    close(holder);
    csg_temporary_sweep(f->folder);
    assert_int_equal(io_folder_count(f->folder), STRANGERS + 1);
    struct stat status;
    assert_int_equal(lstat(link, &status), 0);
    csg_temporary_sweep("/nowhere/at/all");
}

/* Both kinds, to a name that is free and to one that is not. */
static void they_take_their_names(void **state)
{
    fixture *f = *state;
    opener *const openers[] = {csg_temporary_open, csg_temporary_open_named};
    for (int i = 0; i < 4; i++) {
        csg_temporary file;
        struct stat status;
        bool is_new = i % 2 == 0;
        in_folder(f, i / 2 ? "b" : "a");
        assert_int_equal(openers[i / 2](&file, &f->names, f->path), 0);
        assert_int_equal(write(file.fd, "whole", 5), 5);
        assert_int_equal(csg_temporary_rename(&file, f->path, is_new), 0);
        assert_int_equal(csg_temporary_close(&file), 0);
        assert_int_equal(stat(f->path, &status), 0);
        assert_int_equal(status.st_size, 5);
        assert_int_equal(status.st_nlink, 1);
        assert_int_equal(io_folder_count(f->folder), 1 + i / 2);
    }
}

/* Somebody else has made the file meanwhile: it is replaced, as when it had been there. */
static void a_name_that_was_free_may_be_taken(void **state)
{
    fixture *f = *state;
    csg_atomic_file file;
    char text[8] = "";
    assert_int_equal(csg_file_create(&file, &f->io.context, in_folder(f, "a")), CSGM_OK);
    assert_int_equal(write(file.fd, "ours", 4), 4);
    make_file(f->path, "theirs");
    assert_int_equal(csg_file_commit(&file), CSGM_OK);
    FILE *made = fopen(f->path, "r");
    assert_non_null(made);
    assert_int_equal(fread(text, 1, sizeof text, made), 4);
    fclose(made);
    assert_string_equal(text, "ours");
    assert_int_equal(io_folder_count(f->folder), 1);
}

int main(void)
{
#define TEST(name) cmocka_unit_test_setup_teardown(name, set_up, tear_down)
    const struct CMUnitTest tests[] = {TEST(a_file_without_a_name_leaves_nothing),
                                       TEST(a_hidden_file_is_swept_when_its_process_is_gone),
                                       TEST(writing_sweeps_its_folder),
                                       TEST(strangers_stay),
                                       TEST(they_take_their_names),
                                       TEST(a_name_that_was_free_may_be_taken)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
