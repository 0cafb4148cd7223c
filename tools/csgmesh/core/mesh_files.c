/* SPDX-License-Identifier: MIT
 * Which files are meshes; see mesh_files.h. The library reads a mesh of any name by its first
 * bytes; here is told whether a file is to be given to it.
 */
#include "core/mesh_files.h"

#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static bool begins(const char *text, size_t length, const char *with)
{
    return length >= strlen(with) && memcmp(text, with, strlen(with)) == 0;
}

/* Scenes are text, and none begins with a line of these; "solid" and "{" alone could begin one. */
bool cli_text_is_mesh(const char *text, size_t length)
{
    static const char *const heads[] = {"glTF",  "PK\3\4", "DRACO",  "ply\n",  "ply\r",
                                        "OFF\n", "COFF\n", "NOFF\n", "CNOFF\n"};
    enum { STL_TRIANGLES_AT = 80, STL_HEAD = 84, STL_TRIANGLE = 50, LOOKED_AT = 1024 };
    for (size_t i = 0; i < sizeof heads / sizeof *heads; i++)
        if (begins(text, length, heads[i]))
            return true;
    size_t near = length < LOOKED_AT ? length : LOOKED_AT;
    if (begins(text, length, "solid") && memmem(text, near, "facet normal", 12))
        return true;
    if (begins(text, length, "{") && memmem(text, near, "\"asset\"", 7))
        return true;
    if (length < STL_HEAD)
        return false;
    const unsigned char *n = (const unsigned char *)text + STL_TRIANGLES_AT;
    uint64_t triangles = n[0] | (uint64_t)n[1] << 8 | (uint64_t)n[2] << 16 | (uint64_t)n[3] << 24;
    return memchr(text, 0, STL_HEAD) && length == STL_HEAD + STL_TRIANGLE * triangles;
}

/* What a pipe or a device gives it gives once: only files are looked into. */
static size_t read_head(const char *path, char *bytes, size_t size)
{
    struct stat status;
    size_t length = 0;
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd >= 0 && fstat(fd, &status) == 0 && S_ISREG(status.st_mode))
        for (ssize_t got = 1; got > 0 && length<size; length += got> 0 ? (size_t)got : 0)
            got = read(fd, bytes + length, size - length);
    if (fd >= 0)
        close(fd);
    return length;
}

bool cli_path_is_mesh(const char *path)
{
    enum { HEAD = 1 << 16 };
    static _Thread_local char bytes[HEAD];
    if (strcmp(path, "-") == 0 || csgm_drawing_format_from_path(path) != CSGM_DRAWING_NONE)
        return false;
    if (csgm_format_from_path(path) != CSGM_FORMAT_AUTO)
        return true;
    return cli_text_is_mesh(bytes, read_head(path, bytes, HEAD));
}

int cli_refuse_mesh(cli_app *app, const char *path)
{
    bool is_stdin = strcmp(path, "-") == 0;
    char hint[320];
    snprintf(hint, sizeof hint,
             is_stdin ? "give the file's name: csgmesh convert part.glb -o part.stl"
                      : "import(\"%.120s\") in a scene makes a solid of it; csgmesh convert writes "
                        "it in another format, "
                        "csgmesh info tells what is in it",
             path);
    cli_console_say(&app->console, CSGM_ERROR, hint, "%s is a mesh, not a scene",
                    is_stdin ? "standard input" : path);
    return CLI_INPUT_AT_FAULT;
}
