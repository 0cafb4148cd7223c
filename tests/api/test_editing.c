/* SPDX-License-Identifier: MIT
 * csgmesh/editing.h where memory fails: every allocation of a session of an editor, one at a time.
 * What is asked says so, nothing is lost, and the same questions asked again have the same answers.
 * What the answers are, tests/cli/test_lsp.py and test_format.c look at.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants the four above first */
#include <cmocka.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "counting.h"
#include "csgmesh/editing.h"

static const char main_text[] = "use <part.txt>\ninclude <sizes.txt>\nuse <none.txt>\n"
                                "// How many.\ncount = 4; // [1:9]\n"
                                "module cart(length, gap = 2) {\n"
                                "  for (i = [1 : count]) translate([i * gap, 0, 0])\n"
                                "    wheel(r = radius, width = 3) children();\n"
                                "  color(\"red\") cube([length, 1, 1]);\n}\n"
                                "function twice(x) = 2 * x;\n/* a\n b */ cart(twice(5), ";
static const char part_text[] = "// A wheel.\nmodule wheel(r, width = [1, \",\"]) {\n"
                                "  cylinder(h = width, r = r);\n}\n";
static const char sizes_text[] = "radius = 7; // of all wheels\n";
/* Long enough for its pieces to outgrow their first room. */
static const char loose_text[] = "union( ){ // open\ncube( 1 );\n/* a\n  b */ sphere(2) ;\n}\n"
                                 "a=[1 ,2,\n3 ];  // one\nbcd=[ ];// two\n";

typedef struct session {
    counting memory;
    int errors;
    char folder[40], main_path[64];
    csgm_context *context;
    csgm_workspace *workspace;
    int failures; /* calls that said that memory was out */
} session;

/* All answers as one text. */
typedef struct answers {
    char text[1 << 16];
    size_t length;
} answers;

static void note(answers *to, const char *words)
{
    size_t length = strlen(words);
    assert_true(to->length + length + 2 < sizeof to->text);
    memcpy(to->text + to->length, words, length);
    to->length += length;
    to->text[to->length++] = '\n';
    to->text[to->length] = '\0';
}

static bool take_name(void *user, const csgm_name *name)
{
    char words[1024];
    const char *slash = name->path ? strrchr(name->path, '/') : NULL;
    snprintf(words, sizeof words, "%d %s | %s | %s | %s %u %u %u", (int)name->kind, name->name,
             name->signature ? name->signature : "", name->documentation ? name->documentation : "",
             slash ? slash : "", name->begin, name->end, name->parameter_count);
    note(user, words);
    return true;
}

static bool take_color(void *user, const csgm_text_color *color)
{
    char words[100];
    snprintf(words, sizeof words, "%u %u %g", color->begin, color->end, color->red);
    note(user, words);
    return true;
}

static bool take_fold(void *user, const csgm_fold *fold)
{
    char words[100];
    snprintf(words, sizeof words, "%u %u", fold->first_line, fold->last_line);
    note(user, words);
    return true;
}

static void take_text(void *user, const char *text, size_t length)
{
    answers *to = user;
    assert_true(to->length + length < sizeof to->text);
    memcpy(to->text + to->length, text, length);
    to->length += length;
    to->text[to->length] = '\0';
}

static void count_error(void *user, const csgm_diag *diag)
{
    session *s = user;
    s->errors += diag->severity == CSGM_ERROR;
}

/* Each failure is one finding. */
static void judge(session *s, csgm_status status, int errors_before)
{
    assert_true(status == CSGM_OK || status == CSGM_ERR_MEMORY);
    assert_int_equal(s->errors - errors_before, status == CSGM_ERR_MEMORY ? 1 : 0);
    s->failures += status == CSGM_ERR_MEMORY;
}

static uint32_t place_of(const char *mark)
{
    const char *found = strstr(main_text, mark);
    assert_non_null(found);
    return (uint32_t)(found - main_text) + 1;
}

#define ASK(s, call)                                                                               \
    do {                                                                                           \
        int before = (s)->errors;                                                                  \
        judge((s), (call), before);                                                                \
    } while (0)

static void ask_all(session *s, answers *to)
{
    static const char *const marks[] = {"wheel(", "radius,", "count]", "cube(", "gap,", "width ="};
    csgm_workspace *w = s->workspace;
    const char *path = s->main_path;
    uint32_t end = (uint32_t)strlen(main_text), parameter = 0;
    bool is_complete;
    ASK(s, csgm_workspace_list(w, path, take_name, to));
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++) {
        ASK(s, csgm_workspace_find(w, path, place_of(marks[i]), take_name, to));
        ASK(s, csgm_workspace_uses(w, path, place_of(marks[i]), take_name, to));
    }
    ASK(s, csgm_workspace_complete(w, path, end, 40, take_name, to, &is_complete));
    ASK(s, csgm_workspace_complete(w, path, place_of("cube("), 400, take_name, to, &is_complete));
    ASK(s, csgm_workspace_call(w, path, place_of("width = 3"), take_name, to, &parameter));
    ASK(s, csgm_workspace_call(w, path, end, take_name, to, &parameter));
    ASK(s, csgm_workspace_colors(w, path, take_color, to));
    ASK(s, csgm_workspace_folds(w, path, take_fold, to));
    ASK(s, csgm_scene_format(s->context, loose_text, strlen(loose_text), "a.txt", take_text, to));
}

/* False: without memory there is no context, or no workspace with the text. */
static bool begin(session *s)
{
    csgm_context_options options = csgm_context_options_default();
    options.allocator = (csgm_allocator){counting_alloc, counting_release, &s->memory};
    options.threads = 1;
    options.on_diag = count_error;
    options.user = s;
    s->context = NULL;
    s->workspace = NULL;
    csgm_status status = csgm_context_create(&options, &s->context);
    if (status == CSGM_OK)
        status = csgm_workspace_create(s->context, NULL, &s->workspace);
    if (status == CSGM_OK)
        status = csgm_workspace_open(s->workspace, s->main_path, main_text, strlen(main_text));
    assert_true(status == CSGM_OK || status == CSGM_ERR_MEMORY);
    s->failures += status == CSGM_ERR_MEMORY;
    return status == CSGM_OK;
}

static void end(session *s)
{
    csgm_workspace_destroy(s->workspace);
    csgm_context_destroy(s->context);
    assert_int_equal(s->memory.bytes, 0);
    assert_int_equal(s->memory.blocks, 0);
}

static void write_file(const session *s, const char *name, const char *text)
{
    char path[96];
    snprintf(path, sizeof path, "%s/%s", s->folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static int set_up(void **state)
{
    static session s;
    strcpy(s.folder, "/tmp/csgmesh-edit-XXXXXX");
    assert_non_null(mkdtemp(s.folder));
    snprintf(s.main_path, sizeof s.main_path, "%s/main.txt", s.folder);
    write_file(&s, "part.txt", part_text);
    write_file(&s, "sizes.txt", sizes_text);
    *state = &s;
    return 0;
}

static int tear_down(void **state)
{
    const session *s = *state;
    static const char *const names[] = {"part.txt", "sizes.txt"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[96];
        snprintf(path, sizeof path, "%s/%s", s->folder, names[i]);
        remove(path);
    }
    return rmdir(s->folder);
}

static void test_any_allocation_may_fail(void **state)
{
    static answers want, broken, again;
    session *s = *state;
    want.length = 0;
    s->memory = (counting){0};
    assert_true(begin(s));
    ask_all(s, &want);
    assert_int_equal(s->failures, 0);
    end(s);
    static const char *const parts[] = {"module wheel(r, width = [1, \",\"]) | A wheel.",
                                        "radius = 7",
                                        "module cube(",
                                        "count = 4",
                                        "cylinder",
                                        "a = [1, 2,"};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        assert_non_null(strstr(want.text, parts[i]));
    int64_t calls = s->memory.calls;
    assert_true(calls > 100);
    for (int64_t fail_at = 1; fail_at <= calls; fail_at++) {
        s->memory = (counting){.fail_at = fail_at};
        s->failures = s->errors = 0;
        broken.length = again.length = 0;
        if (begin(s)) {
            ask_all(s, &broken);
            assert_int_equal(s->failures, 1);
            ask_all(s, &again);
            assert_int_equal(s->failures, 1);
            assert_string_equal(again.text, want.text);
        }
        assert_int_equal(s->failures, 1);
        end(s);
    }
}

/* A file of the disk may not have been read when memory came back. */
static void test_text_that_was_not_taken(void **state)
{
    static answers want, got;
    session *s = *state;
    want.length = got.length = 0;
    s->memory = (counting){0};
    s->failures = 0;
    assert_true(begin(s));
    ask_all(s, &want);
    for (int64_t at = 1;; at++) {
        s->memory.fail_at = s->memory.calls + at;
        csgm_status status = csgm_workspace_open(s->workspace, s->main_path, "x = 1;\n", 7);
        s->memory.fail_at = 0;
        assert_int_equal(
            csgm_workspace_open(s->workspace, s->main_path, main_text, strlen(main_text)), CSGM_OK);
        got.length = 0;
        ask_all(s, &got);
        assert_string_equal(got.text, want.text);
        if (status == CSGM_OK)
            break;
        assert_int_equal(status, CSGM_ERR_MEMORY);
    }
    end(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_allocation_may_fail),
        cmocka_unit_test(test_text_that_was_not_taken),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
