/* SPDX-License-Identifier: MIT
 * The layout of texts: what it makes of small ones, and that it changes no scene. Arguments:
 * folders of scenes (csgm and OpenSCAD's), whose layout must be settled after one round; with
 * "dumps" first, each scene's dump must be what it was.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
/* cmocka wants the four above first */
#include <cmocka.h>
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "csgmesh/editing.h"

typedef struct text {
    char *bytes;
    size_t length;
} text;

static int folder_count;
static char **folders;

static void collect(void *user, const char *bytes, size_t length)
{
    text *to = user;
    to->bytes = realloc(to->bytes, to->length + length + 1);
    assert_non_null(to->bytes);
    memcpy(to->bytes + to->length, bytes, length);
    to->length += length;
    to->bytes[to->length] = '\0';
}

static void count_finding(void *user, const csgm_diag *diag)
{
    *(int *)user += diag->severity == CSGM_ERROR;
}

static csgm_context *open_context(int *errors)
{
    csgm_context_options options = csgm_context_options_default();
    csgm_context *context;
    options.threads = 1;
    options.on_diag = count_finding;
    options.user = errors;
    options.limits.eval_steps = 3000000; /* tests of limits need not reach them */
    assert_int_equal(csgm_context_create(&options, &context), CSGM_OK);
    return context;
}

/* NULL where it is no scene. */
static char *laid_out(csgm_context *context, const char *source)
{
    text made = {NULL, 0};
    csgm_status status =
        csgm_scene_format(context, source, strlen(source), "a.txt", collect, &made);
    assert_true(status == CSGM_OK || status == CSGM_ERR_SYNTAX);
    assert_true((made.bytes != NULL) == (status == CSGM_OK));
    return made.bytes;
}

static void check(csgm_context *context, const char *source, const char *want)
{
    char *made = laid_out(context, source);
    assert_non_null(made);
    assert_string_equal(made, want);
    char *again = laid_out(context, made);
    assert_string_equal(again, made);
    free(made);
    free(again);
}

static void test_spaces(void **state)
{
    static const struct {
        const char *source, *want;
    } cases[] = {
        {"", ""},
        {"\n\n", ""},
        {"x=1;y = -  2 ;", "x = 1; y = -2;\n"},
        {"cube( [1,2 ,3],center=true ) ;", "cube([1, 2, 3], center = true);\n"},
        {"a=b?-c:!d&&e[ 0 ] . x;", "a = b ? -c : !d && e[0].x;\n"},
        {"a=[1:2:9];b=[for(i=a)if(i>2)(i)];",
         "a = [1 : 2 : 9]; b = [for (i = a) if (i > 2) (i)];\n"},
        {"f=function(x)x^2;g=f (3)(4);h=2-  -1;",
         "f = function (x) x ^ 2; g = f(3)(4); h = 2 - -1;\n"},
        {"let(a=1)assert(a)echo(a)cube(a);", "let (a = 1) assert(a) echo(a) cube(a);\n"},
        {"! # % * sphere(1);translate([1,0,0])* cube(2);",
         "!#%*sphere(1); translate([1, 0, 0]) *cube(2);\n"},
        {"include<a.txt>\nuse <b.txt>;", "include <a.txt>\nuse <b.txt>;\n"},
        {"module m ( a,b=2 ){cube(a);}", "module m(a, b = 2) { cube(a); }\n"},
        {"union(){}", "union() {}\n"},
        {"x=[1 , 2 ,];y=\"a  b\";", "x = [1, 2,]; y = \"a  b\";\n"},
        {"\xEF\xBB\xBFx=1;\r\ny=2;", "x = 1;\r\ny = 2;\r\n"},
        {"a = 1e3 .x;", "a = 1e3 .x;\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        check(*state, cases[i].source, cases[i].want);
}

static void test_lines(void **state)
{
    static const struct {
        const char *source, *want;
    } cases[] = {
        {"union(){\ncube(1);\n\n\n\nsphere(2);}", "union() {\n  cube(1);\n\n  sphere(2);\n}\n"},
        {"module a()\n{\n\ncube(1);\n\n}\n", "module a() {\n  cube(1);\n}\n"},
        {"if(a){\nb();\n}\nelse\n{\nc();\n}", "if (a) {\n  b();\n} else {\n  c();\n}\n"},
        {"if(a)\n    b();\nelse if(c)\n    d();\nelse\n    e();",
         "if (a)\n  b();\nelse if (c)\n  d();\nelse\n  e();\n"},
        {"for(i=a)\n\ttranslate(i)\n\t\tcube(1);", "for (i = a)\n  translate(i)\n    cube(1);\n"},
        {"color(c)\ndifference(){\na();\n}", "color(c)\ndifference() {\n  a();\n}\n"},
        {"p=[\n\t[0,0],\n\t[1,0]\n\t];", "p = [\n  [0, 0],\n  [1, 0]\n];\n"},
        {"f( a,\n   b );", "f(a,\n  b);\n"},
        {"f (a,\n   b);", "f(a,\n  b);\n"},
        {"x = a\n+ b;", "x = a\n  + b;\n"},
        {"function f(x)=\nx>0?1\n:2;", "function f(x) =\n  x > 0 ? 1\n  : 2;\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        check(*state, cases[i].source, cases[i].want);
}

static void test_comments(void **state)
{
    static const struct {
        const char *source, *want;
    } cases[] = {
        {"//  a \nx=1;//b", "//  a\nx = 1; //b\n"},
        {"x=1;    // one\nyy=2;   // two\n\nz=3; // three",
         "x = 1;    // one\nyy = 2;   // two\n\nz = 3; // three\n"},
        {"{ // open\ncube(1); // in\n/* a\n   b */ }",
         "{ // open\n  cube(1); // in\n  /* a\n     b */\n}\n"},
        {"f(/*a*/1,/* b */ 2 /* c */);", "f(/*a*/ 1, /* b */ 2 /* c */);\n"},
        {"union()// why\n{\ncube(1);\n}", "union() // why\n{\n  cube(1);\n}\n"},
        {"a=1; /* [0:10] */\n// next\nb=2;", "a = 1; /* [0:10] */\n// next\nb = 2;\n"},
        {"if (a) b();\n// what else\nelse c();", "if (a) b();\n// what else\nelse c();\n"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        check(*state, cases[i].source, cases[i].want);
}

static void test_tables(void **state)
{
    const char *table = "f([ 0,  1], 2);\nf([10, 11],   2);\n\nx =  1;\n";
    check(*state, table, "f([ 0,  1], 2);\nf([10, 11], 2);\n\nx = 1;\n");
    check(*state, "a(1)       c(3);\nb(2) translate(0) c(4);\n",
          "a(1) c(3);\nb(2) translate(0) c(4);\n");
    check(*state, "a(1)              c(3);\nb(2) translate(0) c(4);\n",
          "a(1)              c(3);\nb(2) translate(0) c(4);\n");
}

static void test_broken(void **state)
{
    static const char *const broken[] = {"cube(1", "x += 1;",      "sphere(2));", "a = [1, 2;",
                                         "\x01",   "union() { (}", "/* never",    "\"never",
                                         "}",      "x = 3 +;",     "cube(1)[2)"};
    int errors = 0;
    csgm_context *context = open_context(&errors);
    for (size_t i = 0; i < sizeof broken / sizeof *broken; i++) {
        int before = errors;
        assert_null(laid_out(context, broken[i]));
        assert_true(errors > before);
    }
    assert_int_equal(csgm_scene_format(context, "x", 1, NULL, NULL, NULL), CSGM_ERR_ARGUMENT);
    assert_int_equal(csgm_scene_format(NULL, "x", 1, NULL, collect, NULL), CSGM_ERR_ARGUMENT);
    csgm_context_destroy(context);
    (void)state;
}

/* Nesting without end must not make a text of its square, nor take for ever. */
static void test_hostile(void **state)
{
    enum { COUNT = 9000 };
    size_t room = 4 * COUNT + 2;
    char *source = malloc(room);
    assert_non_null(source);
    for (size_t i = 0; i < COUNT; i++)
        memcpy(source + 4 * i, "a()\n", 4);
    memcpy(source + 4 * COUNT, ";", 2);
    char *made = laid_out(*state, source);
    if (made)
        assert_true(strlen(made) < room * 60);
    free(made);
    for (size_t i = 0; i < COUNT; i++) /* blanks in lines that line up with nothing for long */
        memcpy(source + 4 * i, i % 97 ? "x   " : "x;\n ", 4);
    for (size_t i = 0; i < 4 * COUNT; i++)
        source[i] = source[i] == 'x' ? ';' : source[i];
    made = laid_out(*state, source);
    assert_non_null(made);
    char *again = laid_out(*state, made);
    assert_string_equal(again, made);
    free(made);
    free(again);
    free(source);
}

/* ---- whole folders ----------------------------------------------------------------------- */

static char *read_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    text bytes = {NULL, 0};
    char some[4096];
    collect(&bytes, "", 0);
    for (size_t got; (got = fread(some, 1, sizeof some, file)) > 0;)
        collect(&bytes, some, got);
    fclose(file);
    return bytes.bytes;
}

/* The dump, or the status as a text. */
static char *dump_of(csgm_context *context, const char *path, const char *source)
{
    csgm_scene_options options = csgm_scene_options_default();
    csgm_scene *scene;
    text dump = {NULL, 0};
    options.leniency = CSGM_LENIENT_BY_FILE;
    csgm_status status = csgm_scene_parse(context, source, strlen(source), path, &options, &scene);
    collect(&dump, csgm_status_name(status), strlen(csgm_status_name(status)));
    if (status == CSGM_OK)
        csgm_scene_dump(context, scene, CSGM_DUMP_SCENE, collect, &dump);
    csgm_scene_destroy(scene);
    return dump.bytes;
}

/* The same text with other white space where there is a blank in its code. */
static char *shaken(const char *source, uint32_t *random)
{
    static const char *const spaces[] = {" ",       " ",  " ",      "  ",    "\n",
                                         "\n\n   ", "\t", "      ", "\n\t\t"};
    text out = {NULL, 0};
    char in = ' ';      /* a string, or a comment that ends with a line or with a star */
    bool reads = false; /* include and use want their file on the same line */
    collect(&out, "", 0);
    for (const char *c = source; *c; c++) {
        if (in == ' ' && *c == '"')
            in = '"';
        else if (in == ' ' && *c == '/' && (c[1] == '/' || c[1] == '*'))
            in = c[1];
        else if ((in == '"' && *c == '"' && c[-1] != '\\') || (in == '/' && *c == '\n') ||
                 (in == '*' && *c == '/' && c[-1] == '*'))
            in = ' ';
        if (*c == '\n')
            reads = false;
        if (in == ' ' && (strncmp(c, "include", 7) == 0 || strncmp(c, "use", 3) == 0))
            reads = true;
        *random = *random * 1664525 + 1013904223;
        const char *space = spaces[(*random >> 16) % (sizeof spaces / sizeof *spaces)];
        if (in == ' ' && *c == ' ' && !reads)
            collect(&out, space, strlen(space));
        else
            collect(&out, c, 1);
    }
    return out.bytes;
}

static void check_shaken(csgm_context *context, const char *path, const char *source)
{
    uint32_t random = 1;
    for (int i = 0; i < 4; i++) {
        char *loose = shaken(source, &random), *made = laid_out(context, loose);
        char *again = made ? laid_out(context, made) : NULL;
        if (made && (!again || strcmp(again, made) != 0))
            fail_msg("%s, shaken %d times: laying out twice is not laying out once", path, i + 1);
        free(loose);
        free(made);
        free(again);
    }
}

static void check_file(csgm_context *context, const char *path, int *formatted)
{
    char *source = read_file(path);
    char *made = laid_out(context, source);
    if (made) {
        char *again = laid_out(context, made);
        if (!again || strcmp(again, made) != 0)
            fail_msg("%s: laying out twice is not laying out once", path);
        free(again);
        check_shaken(context, path, source);
        *formatted += 1;
    }
    if (made) {
        char *before = dump_of(context, path, source), *after = dump_of(context, path, made);
        if (strcmp(before, after) != 0)
            fail_msg("%s: another scene", path);
        free(before);
        free(after);
    }
    free(made);
    free(source);
}

static void check_folder(csgm_context *context, const char *path, int *formatted)
{
    char inner[1024];
    DIR *folder = opendir(path);
    assert_non_null(folder);
    for (struct dirent *entry; (entry = readdir(folder));) {
        struct stat info;
        const char *dot = strrchr(entry->d_name, '.');
        snprintf(inner, sizeof inner, "%s/%s", path, entry->d_name);
        if (entry->d_name[0] == '.' || stat(inner, &info) != 0)
            continue;
        if (S_ISDIR(info.st_mode))
            check_folder(context, inner, formatted);
        else if (dot && (strcmp(dot, ".txt") == 0 || strcmp(dot, ".scad") == 0 ||
                         strcmp(dot, ".csg") == 0))
            check_file(context, inner, formatted);
    }
    closedir(folder);
}

static void test_folders(void **state)
{
    int formatted = 0;
    for (int i = 0; i < folder_count; i++)
        check_folder(*state, folders[i], &formatted);
    if (folder_count > 1)
        assert_true(formatted > 500);
}

static int set_up(void **state)
{
    static int errors;
    *state = open_context(&errors);
    return 0;
}

static int tear_down(void **state)
{
    csgm_context_destroy(*state);
    return 0;
}

int main(int argc, char **argv)
{
    folders = argv + 1;
    folder_count = argc - 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_spaces),   cmocka_unit_test(test_lines),
        cmocka_unit_test(test_comments), cmocka_unit_test(test_tables),
        cmocka_unit_test(test_broken),   cmocka_unit_test(test_hostile),
        cmocka_unit_test(test_folders),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
