/* SPDX-License-Identifier: MIT
 * Every file of scenes/bad says in its first lines which findings it must give:
 *   //! expect error E0107        that one, and every error found must be expected
 *   //! expect warning W0390
 *   //! expect message "part of the text"
 */
#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "lang/support.h"

static bench b;

enum { MOST_EXPECTED = 8 };

typedef struct expected {
    int codes[MOST_EXPECTED];
    int count;
    char message[200];
} expected;

static void read_expected(const char *path, expected *out)
{
    char line[512], word[16];
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    memset(out, 0, sizeof *out);
    while (fgets(line, sizeof line, file) && strncmp(line, "//!", 3) == 0) {
        int code;
        if (sscanf(line, "//! expect %15s %*[EW]%d", word, &code) == 2 &&
            out->count < MOST_EXPECTED)
            out->codes[out->count++] = strcmp(word, "error") == 0 ? code : -code;
        else
            assert_int_equal(sscanf(line, "//! expect message \"%199[^\n]", out->message), 1);
    }
    fclose(file);
    char *quote = strrchr(out->message, '"');
    if (quote)
        *quote = '\0';
}

static bool is_expected(const expected *e, int code)
{
    for (int i = 0; i < e->count; i++)
        if (e->codes[i] == code)
            return true;
    return false;
}

static bool check_file(const char *path)
{
    expected e;
    bool fails = false, good = true;
    read_expected(path, &e);
    csgm_status status = bench_load(&b, path, NULL);
    for (int i = 0; i < e.count; i++) {
        good = good && bench_has(&b, e.codes[i]);
        fails = fails || e.codes[i] > 0;
    }
    for (int i = 0; i < b.code_count; i++)
        good = good && is_expected(&e, b.codes[i]);
    good = good && e.count > 0 && e.message[0] && strstr(b.text, e.message);
    good = good && (status == CSGM_OK) == !fails;
    if (!good)
        print_error("%s: status %s, found\n%s\n", path, fails ? "(should fail)" : "", b.text);
    return good;
}

static void every_bad_scene_says_what_is_wrong(void **state)
{
    (void)state;
    int count = 0, wrong = 0;
    DIR *folder = opendir(SCENE_DIR "/bad");
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));) {
        char path[1024];
        size_t length = strlen(entry->d_name);
        if (length < 4 || strcmp(entry->d_name + length - 4, ".txt") != 0)
            continue;
        snprintf(path, sizeof path, "%s/bad/%s", SCENE_DIR, entry->d_name);
        wrong += !check_file(path);
        count++;
    }
    closedir(folder);
    assert_int_equal(wrong, 0);
    assert_true(count >= 105);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_bad_scene_says_what_is_wrong)};
    bench_open(&b, NULL);
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    bench_close(&b);
    return failed;
}
