/* SPDX-License-Identifier: MIT
 * The fixture of tests that use one bench and files in a folder of their own: made before them,
 * gone after them.
 */
#ifndef TESTS_LANG_BENCH_FOLDER_H
#define TESTS_LANG_BENCH_FOLDER_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lang/bench_fixture.h"

static char folder[64] = "/tmp/csgmesh-lang-XXXXXX";

/* Good for three calls more. */
static inline const char *path_of(const char *name)
{
    static char paths[4][256];
    static int next;
    char *path = paths[next++ & 3];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

/* Returns its path. */
static inline const char *write_file(const char *name, const char *text, size_t length)
{
    const char *path = path_of(name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, length, file), length);
    assert_int_equal(fclose(file), 0);
    return path;
}

static inline const char *write_text(const char *name, const char *text)
{
    return write_file(name, text, strlen(text));
}

static int make_folder(void **state)
{
    return open_bench(state) == 0 && mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    char command[128];
    close_bench(state);
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

#endif
