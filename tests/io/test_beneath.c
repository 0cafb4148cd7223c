/* SPDX-License-Identifier: MIT
 * A glTF reads files below its own folder and no others, however it names them; and takes no more
 * memory than there is, whatever its text says.
 */
#include "support.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../../src/io/beneath.c" /* both ways of opening are tried, whatever the kernel has */

static void write_file(const char *folder, const char *name, const char *text, size_t size)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(text, 1, size, file), size);
    fclose(file);
}

/* folder/in/{a.bin,below/a.bin,out -> ../a.bin,up -> ..}, folder/a.bin */
static void make_tree(char *folder, size_t size)
{
    static const char triangle[36] = {[14] = '\x80', [15] = '?', [30] = '\x80', [31] = '?'};
    char path[300];
    io_folder_make(folder, size);
    write_file(folder, "a.bin", triangle, sizeof triangle);
    snprintf(path, sizeof path, "%s/in", folder);
    assert_int_equal(mkdir(path, 0777), 0);
    write_file(path, "a.bin", triangle, sizeof triangle);
    snprintf(path, sizeof path, "%s/in/below", folder);
    assert_int_equal(mkdir(path, 0777), 0);
    write_file(path, "a.bin", triangle, sizeof triangle);
    snprintf(path, sizeof path, "%s/in/out", folder);
    assert_int_equal(symlink("../a.bin", path), 0);
    snprintf(path, sizeof path, "%s/in/up", folder);
    assert_int_equal(symlink("..", path), 0);
}

static void remove_tree(const char *folder)
{
    static const char *const inside[] = {"in/below", "in"};
    char path[300];
    for (size_t i = 0; i < 2; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, inside[i]);
        io_folder_remove(path);
    }
    io_folder_remove(folder);
}

static const struct name {
    const char *uri;
    bool is_inside;
} names[] = {{"a.bin", true},         {"below/a.bin", true},
             {"./a.bin", true},       {"below//a.bin", true},
             {"../a.bin", false},     {"below/../../a.bin", false},
             {"out", false},          {"up/a.bin", false},
             {"up/in/a.bin", false},  {"/etc/passwd", false},
             {"..", false},           {"below/../../in/a.bin", false},
             {"//etc/passwd", false}, {"/proc/self/cwd/a", false}};

static void only_what_lies_below_is_opened(void **state)
{
    (void)state;
    char folder[128], inside[160];
    make_tree(folder, sizeof folder);
    snprintf(inside, sizeof inside, "%s/in", folder);
    int at = open(inside, O_RDONLY | O_DIRECTORY);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        int files[2] = {csg_open_beneath(inside, names[i].uri), open_by_names(at, names[i].uri)};
        for (int way = 0; way < 2; way++) {
            if ((files[way] >= 0) != names[i].is_inside)
                fail_msg("%s, way %d: %d", names[i].uri, way, files[way]);
            if (files[way] >= 0)
                close(files[way]);
        }
    }
    close(at);
    remove_tree(folder);
}

static csgm_status read_document(io_context *io, const char *text, const char *path)
{
    csgm_mesh *mesh = NULL;
    io->findings = 0;
    io->context.diags.errors = 0;
    csgm_status status = csg_io_read_memory(&io->context, (const uint8_t *)text, strlen(text), path,
                                            CSGM_FORMAT_GLTF, &mesh);
    csg_mesh_destroy(mesh);
    return status;
}

static void gltf_stays_in_its_folder(void **state)
{
    (void)state;
    static const char *const encoded[] = {"%2e%2e/a.bin", "%2E%2e%2fa.bin", "..%2Fa.bin",
                                          "o%75t",        "%2fetc/passwd",  "file:///etc/passwd"};
    char folder[128], path[160], text[1024];
    io_context io;
    if (!csg_format_available(CSGM_FORMAT_GLTF, true))
        skip();
    io_context_init(&io, 0);
    make_tree(folder, sizeof folder);
    snprintf(path, sizeof path, "%s/in/a.gltf", folder);
    enum { NAMES = sizeof names / sizeof *names, ALL = NAMES + sizeof encoded / sizeof *encoded };
    for (size_t i = 0; i < ALL; i++) {
        const char *uri = i < NAMES ? names[i].uri : encoded[i - NAMES];
        bool is_inside = i < NAMES && names[i].is_inside;
        snprintf(text, sizeof text,
                 "{\"asset\":{\"version\":\"2.0\"},\"meshes\":[{\"primitives\":[{\"attributes\":"
                 "{\"POSITION\":0}}]}],\"buffers\":[{\"uri\":\"%s\",\"byteLength\":36}],"
                 "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"accessors\":[{"
                 "\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}],"
                 "\"nodes\":[{\"mesh\":0}]}",
                 uri);
        csgm_status status = read_document(&io, text, path);
        if (is_inside ? status != CSGM_OK : status != CSGM_ERR_UNSUPPORTED)
            fail_msg("%s: status %d, '%s'", uri, (int)status, io.last);
    }
    remove_tree(folder);
    io_context_check(&io);
}

/* Two bytes of text become a kilobyte of tinygltf's: it is known before. */
static void a_document_is_bounded_by_memory(void **state)
{
    (void)state;
    enum { NODES = 200000 };
    if (!csg_format_available(CSGM_FORMAT_GLTF, true))
        skip();
    char *text = malloc(3 * NODES + 200), *at = text;
    assert_non_null(text);
    at += sprintf(at, "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{}");
    for (int i = 1; i < NODES; i++)
        at += sprintf(at, ",{}");
    sprintf(at, "]}");
    io_context io;
    io_context_init(&io, 20 << 20);
    assert_int_equal(read_document(&io, text, "a.gltf"), CSGM_ERR_MEMORY);
    assert_int_equal(io.findings, 1);
    io_context_check(&io);
    io_context_init(&io, (uint64_t)2 << 30);
    assert_int_equal(read_document(&io, text, "a.gltf"), CSGM_OK);
    io_context_check(&io);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(only_what_lies_below_is_opened),
        cmocka_unit_test(gltf_stays_in_its_folder),
        cmocka_unit_test(a_document_is_bounded_by_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
