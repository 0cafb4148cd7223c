/* SPDX-License-Identifier: MIT
 * Journals: what was written comes back, up to what is torn or damaged, and goes on from there.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/journal.h"
#include "base/random.h"

static char path[] = "/tmp/csgmesh-journal-XXXXXX";
static csg_memory memory;
static const char HEAD[] = "scene 7";

static csg_journal open_with(const char *head)
{
    csg_journal journal;
    assert_int_equal(csg_journal_open(&journal, &memory, path, head, strlen(head)), 0);
    return journal;
}

static void add_record(csg_journal *journal, uint32_t kind, const char *text)
{
    size_t half = strlen(text) / 2;
    const csg_journal_piece pieces[] = {{text, half}, {text + half, strlen(text) - half}};
    assert_int_equal(csg_journal_write(journal, kind, pieces, 2, true), 0);
}

/* NULL: there is no such record. */
static void expect(csg_journal *journal, uint32_t kind, const char *text)
{
    uint64_t bytes = 0;
    void *record = csg_journal_read(journal, kind, &bytes);
    if (!text) {
        assert_null(record);
        return;
    }
    assert_non_null(record);
    assert_int_equal(bytes, strlen(text));
    assert_memory_equal(record, text, bytes);
    csg_memory_release(&memory, record, bytes);
}

static void write_three(void)
{
    unlink(path);
    csg_journal journal = open_with(HEAD);
    add_record(&journal, 1, "first");
    add_record(&journal, 1, "second one");
    add_record(&journal, 2, "third");
    csg_journal_close(&journal);
}

static void test_comes_back(void **state)
{
    write_three();
    csg_journal journal = open_with(HEAD);
    expect(&journal, 2, NULL); /* of another kind: it stays where it is */
    expect(&journal, 1, "first");
    expect(&journal, 1, "second one");
    expect(&journal, 1, NULL);
    expect(&journal, 2, "third");
    expect(&journal, 2, NULL);
    csg_journal_close(&journal);
}

static void test_goes_on(void **state)
{
    write_three();
    csg_journal journal = open_with(HEAD);
    expect(&journal, 1, "first");
    add_record(&journal, 1, "other"); /* in place of what stood behind */
    expect(&journal, 1, NULL);
    csg_journal_close(&journal);
    journal = open_with(HEAD);
    expect(&journal, 1, "first");
    expect(&journal, 1, "other");
    expect(&journal, 2, NULL);
    csg_journal_close(&journal);
}

static void test_other_head(void **state)
{
    write_three();
    csg_journal journal = open_with("scene 8");
    expect(&journal, 1, NULL);
    csg_journal_close(&journal);
    journal = open_with(HEAD); /* and what was of the first is gone */
    expect(&journal, 1, NULL);
    csg_journal_close(&journal);
}

/* Cut at any byte, or with any byte changed: records before it come back, none of another text. */
static void test_damage(void **state)
{
    static const char *const texts[] = {"first", "second one", "third"};
    static const uint32_t kinds[] = {1, 1, 2};
    struct stat whole;
    write_three();
    assert_int_equal(stat(path, &whole), 0);
    csg_random random = {11};
    for (off_t at = 0; at < whole.st_size; at++)
        for (int cut = 0; cut < 2; cut++) {
            write_three();
            if (cut) {
                assert_int_equal(truncate(path, at), 0);
            } else {
                FILE *file = fopen(path, "r+b");
                assert_non_null(file);
                fseek(file, at, SEEK_SET);
                int byte = fgetc(file);
                fseek(file, at, SEEK_SET);
                fputc(byte ^ (1 + (int)csg_random_below(&random, 255)), file);
                fclose(file);
            }
            csg_journal journal = open_with(HEAD);
            int found = 0;
            for (; found < 3; found++) {
                uint64_t bytes;
                void *record = csg_journal_read(&journal, kinds[found], &bytes);
                if (!record)
                    break;
                assert_int_equal(bytes, strlen(texts[found]));
                assert_memory_equal(record, texts[found], bytes);
                csg_memory_release(&memory, record, bytes);
            }
            assert_true(found < 3);
            csg_journal_close(&journal);
        }
    assert_int_equal(atomic_load(&memory.used_bytes), 0);
}

static void test_cannot(void **state)
{
    csg_journal journal;
    assert_int_not_equal(csg_journal_open(&journal, &memory, "/nowhere/at/all", HEAD, sizeof HEAD),
                         0);
    csg_journal_close(&journal);
}

int main(void)
{
    csg_memory_init(&memory, NULL, 0);
    int fd = mkstemp(path);
    if (fd < 0)
        return 1;
    close(fd);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_comes_back), cmocka_unit_test(test_goes_on),
        cmocka_unit_test(test_other_head), cmocka_unit_test(test_damage),
        cmocka_unit_test(test_cannot),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    unlink(path);
    return failed;
}
