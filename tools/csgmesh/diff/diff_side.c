/* SPDX-License-Identifier: MIT
 * Operands; see diff_side.h.
 */
#include "diff/diff_side.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/options.h"
#include "core/textfile.h"
#include "mesh/outputs.h"

bool diff_path_is_nothing(const char *path)
{
    return strcmp(path, "/dev/null") == 0;
}

bool diff_path_is_scene(const char *path)
{
    return csgm_format_from_path(path) == CSGM_FORMAT_AUTO && !diff_path_is_nothing(path);
}

/* Does the file name the extension? It may stand behind a whole buffer in base64. */
static bool names(const char *path, const char *wanted)
{
    enum { CHUNK = 1 << 16, LONGEST = 64 };
    static char bytes[LONGEST + CHUNK];
    const size_t length = strlen(wanted), most = length - 1;
    FILE *file = fopen(path, "rbe");
    size_t kept = 0, got;
    bool found = false;
    while (file && !found && (got = fread(bytes + kept, 1, CHUNK, file)) > 0) {
        found = memmem(bytes, kept + got, wanted, length);
        size_t left = kept + got < most ? kept + got : most;
        memmove(bytes, bytes + kept + got - left, left);
        kept = left;
    }
    if (file)
        fclose(file);
    return found;
}

/* How a glTF file is compressed. */
static diff_compression compression_of(csgm_format format, const char *path)
{
    uint32_t traits = csgm_format_traits(format);
    if (traits & CSGM_HEEDS_DRACO && names(path, "KHR_draco_mesh_compression"))
        return DIFF_DRACO;
    if (!(traits & CSGM_HEEDS_MESHOPT))
        return DIFF_PLAIN;
    return names(path, "KHR_meshopt_compression")   ? DIFF_MESHOPT_KHR
           : names(path, "EXT_meshopt_compression") ? DIFF_MESHOPT
                                                    : DIFF_PLAIN;
}

/* Unless the command line says another way. */
static void compress_so(csgm_write_options *options, diff_compression compression)
{
    if (options->draco || options->meshopt)
        return;
    options->draco = compression == DIFF_DRACO;
    options->meshopt = compression == DIFF_MESHOPT || compression == DIFF_MESHOPT_KHR;
    options->meshopt_khr = compression == DIFF_MESHOPT_KHR;
}

/* The scene's mesh as the other file would hold it. */
static int mesh_scene(cli_app *app, diff_side *side)
{
    csgm_write_options options = cli_outputs_options(app, NULL);
    side->work.normals = side->as == CSGM_FORMAT_AUTO ? NULL : &side->normals;
    int status = cli_work_mesh(app, &side->work);
    if (status != CLI_DONE)
        return status;
    side->view = csgm_mesh_get_view(side->work.mesh);
    if (side->as == CSGM_FORMAT_AUTO || !side->view.triangle_count)
        return CLI_DONE;
    compress_so(&options, side->compression);
    csgm_status made =
        csgm_mesh_as_file(app->context, &side->view, side->as, &options, &side->mesh);
    if (made == CSGM_OK)
        side->view = csgm_mesh_get_view(side->mesh);
    return cli_exit_status(made);
}

static int open_scene(cli_app *app, diff_side *side, const char *other)
{
    int status = cli_work_load(app, &side->work, side->path);
    if (status != CLI_DONE)
        return status;
    csgm_format format = csgm_format_from_path(other);
    uint32_t traits = csgm_format_traits(format);
    bool creases = traits & CSGM_KEEPS_CREASES;
    side->as = csgm_format_available(format, false) ? format : CSGM_FORMAT_AUTO;
    side->normals = app->options->given[CLI_OPTION_normals] ? cli_outputs_normals(app->options)
                    : creases                               ? CSGM_NORMALS_CREASE
                                                            : CSGM_NORMALS_VERTEX;
    side->compression = compression_of(format, other);
    side->work.drops_looks = side->as != CSGM_FORMAT_AUTO && !cli_format_keeps_looks(side->as);
    return CLI_DONE;
}

static int mesh_again(cli_app *app, diff_side *side)
{
    csgm_mesh_destroy(side->mesh);
    csgm_mesh_destroy(side->work.mesh);
    side->mesh = side->work.mesh = NULL;
    return mesh_scene(app, side);
}

bool diff_side_mesh_otherwise(cli_app *app, diff_side *side, int *status)
{
    if (!side->work.scene || side->as == CSGM_FORMAT_AUTO || side->normals != CSGM_NORMALS_CREASE ||
        app->options->given[CLI_OPTION_normals])
        return false;
    side->normals = CSGM_NORMALS_VERTEX;
    *status = mesh_again(app, side);
    return true;
}

bool diff_side_mesh_with_looks(cli_app *app, diff_side *side, int *status)
{
    if (!side->work.scene || !side->work.drops_looks ||
        !csgm_scene_get_info(side->work.scene).has_colors)
        return false;
    side->work.drops_looks = false;
    *status = mesh_again(app, side);
    return true;
}

int diff_side_open(cli_app *app, diff_side *side, const char *path, const char *other)
{
    *side = (diff_side){.path = path, .format = csgm_format_from_path(path)};
    if (diff_path_is_nothing(path))
        return CLI_DONE;
    if (side->format != CSGM_FORMAT_AUTO) {
        csgm_status status = csgm_mesh_read(app->context, path, side->format, &side->mesh);
        if (status == CSGM_OK)
            side->view = csgm_mesh_get_view(side->mesh);
        return cli_exit_status(status);
    }
    return open_scene(app, side, other);
}

int diff_side_mesh(cli_app *app, diff_side *side)
{
    return side->work.scene && !side->work.mesh ? mesh_scene(app, side) : CLI_DONE;
}

void diff_side_release(diff_side *side)
{
    csgm_mesh_destroy(side->mesh);
    cli_work_release(&side->work);
    *side = (diff_side){.path = NULL};
}

/* ---- bytes ----------------------------------------------------------------------------- */

static bool same_content(FILE *a, FILE *b)
{
    enum { CHUNK = 1 << 16 };
    static char left[CHUNK], right[CHUNK];
    size_t m, n;
    do {
        m = fread(left, 1, CHUNK, a);
        n = fread(right, 1, CHUNK, b);
    } while (m == n && m > 0 && memcmp(left, right, m) == 0);
    return m == 0 && n == 0 && !ferror(a) && !ferror(b);
}

bool diff_same_bytes(const char *a, const char *b)
{
    struct stat left, right;
    csgm_format format = csgm_format_from_path(a);
    /* files that name others beside them may differ there */
    if (format == CSGM_FORMAT_AUTO || csgm_format_traits(format) & CSGM_NAMES_FILES ||
        format != csgm_format_from_path(b) || stat(a, &left) != 0 || stat(b, &right) != 0 ||
        !S_ISREG(left.st_mode) || !S_ISREG(right.st_mode) || left.st_size != right.st_size)
        return false;
    FILE *file_a = fopen(a, "rbe"), *file_b = fopen(b, "rbe");
    bool same = file_a && file_b && same_content(file_a, file_b);
    if (file_a)
        fclose(file_a);
    if (file_b)
        fclose(file_b);
    return same;
}

static int refuse_read(cli_app *app, const char *path)
{
    cli_console_say(&app->console, CSGM_ERROR, NULL, "cannot read %s: %s", path,
                    errno ? strerror(errno) : "out of memory");
    return CLI_TROUBLE;
}

static int copy_file(cli_app *app, const char *from, const char *to)
{
    struct stat status;
    errno = 0;
    FILE *file = fopen(from, "rbe");
    if (!file || fstat(fileno(file), &status) != 0) {
        int refused = refuse_read(app, from);
        if (file)
            fclose(file);
        return refused;
    }
    size_t length = (size_t)status.st_size;
    char *bytes = malloc(length + 1);
    bool good = bytes && fread(bytes, 1, length, file) == length;
    fclose(file);
    int result = good ? cli_write_text(app, to, bytes, length) : refuse_read(app, from);
    free(bytes);
    return result;
}

/* Is it text, of a format that is text or binary as --ascii says? STL as its reader tells it. */
static bool is_ascii(const char *path)
{
    enum { TRIANGLES_AT = 80, HEAD_BYTES = 84, TRIANGLE_BYTES = 50 };
    struct stat status;
    unsigned char head[512] = {0};
    csgm_format format = csgm_format_from_path(path);
    FILE *file = csgm_format_traits(format) & CSGM_HEEDS_ASCII ? fopen(path, "rbe") : NULL;
    size_t got = file ? fread(head, 1, sizeof head - 1, file) : 0;
    bool has_size = file && fstat(fileno(file), &status) == 0;
    if (file)
        fclose(file);
    if (!has_size || format != CSGM_FORMAT_STL)
        return has_size && strstr((const char *)head, "\nformat ascii");
    const unsigned char *n = head + TRIANGLES_AT;
    uint64_t triangles = n[0] | (uint64_t)n[1] << 8 | (uint64_t)n[2] << 16 | (uint64_t)n[3] << 24;
    bool fits =
        got >= HEAD_BYTES && (uint64_t)status.st_size == HEAD_BYTES + TRIANGLE_BYTES * triangles;
    return !fits && memcmp(head, "solid", 5) == 0;
}

/* ---- accepting ------------------------------------------------------------------------- */

static void make_folders(const char *path)
{
    char folder[8192];
    for (const char *slash = strchr(path + 1, '/'); slash; slash = strchr(slash + 1, '/')) {
        snprintf(folder, sizeof folder, "%.*s", (int)(slash - path), path);
        mkdir(folder, 0777); /* what fails here fails when the file is written */
    }
}

int diff_update(cli_app *app, const char *path_a, diff_side *b, const char *path_b)
{
    csgm_format format = csgm_format_from_path(path_a);
    int status = CLI_DONE;
    if (diff_path_is_nothing(path_a) || diff_path_is_nothing(path_b))
        return cli_usage_error(app, NULL, "--update wants two files");
    make_folders(path_a);
    bool is_new = access(path_a, F_OK) != 0;
    bool ascii = is_ascii(path_a);
    if (format == csgm_format_from_path(path_b) &&
        !(csgm_format_traits(format) & CSGM_NAMES_FILES) && (is_new || ascii == is_ascii(path_b)))
        return copy_file(app, path_b, path_a);
    if (format == CSGM_FORMAT_AUTO)
        return cli_usage_error(app, NULL, "%s is a scene, which no mesh can be written to", path_a);
    if (!b->path)
        status = diff_side_open(app, b, path_b, path_a);
    if (status == CLI_DONE)
        status = diff_side_mesh(app, b);
    if (status != CLI_DONE)
        return status;
    csgm_write_options options = cli_outputs_options(app, NULL);
    options.ascii |= ascii;
    compress_so(&options, compression_of(format, path_a));
    csgm_mesh_view view = b->work.mesh ? csgm_mesh_get_view(b->work.mesh) : b->view;
    return cli_exit_status(
        csgm_mesh_write(app->context, &view, path_a, CSGM_FORMAT_AUTO, &options));
}
