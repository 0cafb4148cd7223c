/* SPDX-License-Identifier: MIT
 * Writing a mesh: arguments and mesh are checked, the format's writer fills a sink, and the file
 * takes its name only when all of it is on disk.
 */
#include <errno.h>
#include <fcntl.h>
#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/mman.h>

#include "base/geometry.h"
#include "base/mesh_codes.h"
#include "base/trace.h"
#include "io/file.h"
#include "io/format_table.h"
#include "io/formats.h"
#include "io/metadata.h"
#include "io/parts.h"
#include "io/rounding.h"
#include "mesh/view.h"
#include "mesh/weld.h"

csgm_write_options csg_write_options_default(void)
{
    return (csgm_write_options){.struct_size = sizeof(csgm_write_options),
                                .draco_position_bits = 14,
                                .draco_normal_bits = 10,
                                .draco_color_bits = 8,
                                .draco_level = 7,
                                .y_up = true,
                                .sync = true,
                                .unit = CSGM_UNIT_MM};
}

csgm_status csg_write_refuse(csg_sink *sink, const char *hint, const char *format, ...)
{
    char text[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    csg_diag_plain(&sink->context->diags, CSG_DIAG_FORMAT_LIMIT, sink->name, hint, "%s", text);
    return CSGM_ERR_UNSUPPORTED;
}

/* ---- checks ------------------------------------------------------------------------------------
 */

static csgm_status bad_option(csgm_context *context, const char *file, const char *what)
{
    csg_diag_plain(&context->diags, CSG_DIAG_BAD_WRITE_OPTION, file, NULL, "%s", what);
    return CSGM_ERR_ARGUMENT;
}

static csgm_status check_metadata(csgm_context *context, const csgm_write_options *o,
                                  const char *file)
{
    char what[160];
    if (o->metadata_count && !o->metadata)
        return CSGM_ERR_ARGUMENT;
    for (size_t i = 0; i < o->metadata_count; i++) {
        if (!o->metadata[i])
            return CSGM_ERR_ARGUMENT;
        const char *fault = csg_metadata_fault(o->metadata[i]);
        if (!fault)
            continue;
        snprintf(what, sizeof what, "the metadata '%.60s' %s", o->metadata[i], fault);
        return bad_option(context, file, what);
    }
    return CSGM_OK;
}

static csgm_status check_levels(csgm_context *context, const csgm_write_options *o,
                                const char *file)
{
    if (o->level_count > CSGM_DETAILS_MOST)
        return bad_option(context, file, "there are more than 8 further levels of detail");
    if (o->level_count && !o->levels)
        return CSGM_ERR_ARGUMENT;
    for (size_t i = 0; i < o->level_count; i++)
        if (!(o->levels[i].error >= 0) || !(o->levels[i].measured >= 0))
            return bad_option(context, file, "the error of a level of detail is no length");
    return check_metadata(context, o, file);
}

static csgm_status check_options(csgm_context *context, const csgm_write_options *o,
                                 const char *file)
{
    if (o->struct_size != sizeof *o)
        return CSGM_ERR_ARGUMENT;
    if (o->draco_position_bits < 1 || o->draco_position_bits > 30)
        return bad_option(context, file, "Draco's position bits must be from 1 to 30");
    if (o->draco_normal_bits < 2 || o->draco_normal_bits > 30)
        return bad_option(context, file, "Draco's normal bits must be from 2 to 30");
    if (o->draco_color_bits < 1 || o->draco_color_bits > 30)
        return bad_option(context, file, "Draco's color bits must be from 1 to 30");
    if (o->draco_level > 10)
        return bad_option(context, file, "Draco's level must be from 0 to 10");
    if (o->unit < CSGM_UNIT_NONE || o->unit > CSGM_UNIT_IN)
        return bad_option(context, file, "the unit is none of the known ones");
    if (o->draco && o->meshopt)
        return bad_option(context, file, "Draco and meshoptimizer exclude each other");
    if (o->meshopt && o->draco_position_bits > 16)
        return bad_option(context, file, "glTF has quantised positions of 16 bits at most");
    if (o->uv < CSGM_UV_NONE || o->uv > CSGM_UV_CYLINDER)
        return bad_option(context, file, "the projection is none of the known ones");
    if (o->uv != CSGM_UV_NONE && o->draco)
        return bad_option(context, file,
                          "texture coordinates are not written with Draco: compress "
                          "with meshoptimizer, or not");
    return check_levels(context, o, file);
}

static csgm_status check_mesh(csgm_context *context, const csgm_mesh_view *mesh, const char *file)
{
    const char *what = NULL;
    if (mesh->vertex_count > UINT32_MAX || (mesh->vertex_count && !mesh->positions) ||
        (mesh->triangle_count && !mesh->indices) || mesh->triangle_count > UINT64_MAX / 256)
        return CSGM_ERR_ARGUMENT;
    if (!csg_view_is_in_range(mesh))
        what = "a triangle of the mesh names a vertex that does not exist";
    else if (!csg_view_is_finite(mesh))
        what = "a coordinate of the mesh is infinite or not a number";
    else if (mesh->normals && !csg_all_finite(mesh->normals, 3 * mesh->vertex_count))
        what = "a normal of the mesh is infinite or not a number";
    uint16_t most = 0;
    for (uint64_t i = 0; mesh->materials && i < 2 * mesh->vertex_count; i++)
        most = mesh->materials[i] > most ? mesh->materials[i] : most;
    if (!what && most > CSG_MATERIAL_ONE)
        what = "a material of the mesh is out of range";
    uint64_t end = 0;
    for (uint64_t i = 0; i < mesh->part_count && !what; i++) {
        const csgm_mesh_part *part = &mesh->parts[i];
        if (part->first_triangle != end || part->triangle_count > mesh->triangle_count - end)
            what = "the parts of the mesh do not follow one another";
        end += part->triangle_count;
    }
    if (!what && mesh->part_count && end != mesh->triangle_count)
        what = "the parts of the mesh leave out triangles";
    if (!what)
        return CSGM_OK;
    csg_diag_plain(&context->diags, CSG_DIAG_BAD_MESH, file, NULL, "%s", what);
    return CSGM_ERR_ARGUMENT;
}

/* Everything that can be known before a file is touched. */
static csgm_status prepare(csgm_context *context, const csgm_mesh_view *mesh, const char *file,
                           csgm_format format, const csgm_write_options *options,
                           const csg_format_row **row)
{
    csgm_status status = check_options(context, options, file);
    if (status)
        return status;
    if (format == CSGM_FORMAT_AUTO)
        format = csg_format_from_path(file);
    *row = csg_format_find(format);
    if (!*row)
        return csg_format_unknown(context, file);
    status = csg_format_check(context, file, *row, false);
    if (status)
        return status;
    if (options->draco && (*row)->traits & CSGM_HEEDS_DRACO && !csg_draco_available())
        return csg_format_no_library(context, file, "Draco", "compressed glTF");
    if (options->meshopt && (*row)->traits & CSGM_HEEDS_MESHOPT && !csg_meshopt_available())
        return csg_format_no_library(context, file, "meshoptimizer", "glTF compressed by it");
    status = check_mesh(context, mesh, file);
    for (size_t i = 0; i < options->level_count && !status; i++)
        if ((*row)->traits & CSGM_HEEDS_LEVELS)
            status = check_mesh(context, &options->levels[i].mesh, file);
    return status;
}

/* ---- writing ---------------------------------------------------------------------- */

/* Where bytes go. */
typedef struct target {
    int fd;
    const char *name;
    csg_companion *companion; /* csg_sink.companion */
} target;

static csgm_status fill(csgm_context *context, const csgm_mesh_view *mesh, const target *to,
                        const csg_format_row *row, const csgm_write_options *options)
{
    CSG_ZONE(context, "write");
    csg_sink sink;
    csgm_status status = csg_sink_open(&sink, context, to->fd, to->name);
    if (status)
        return status;
    sink.companion = to->companion;
    status = row->write(&sink, mesh, options);
    if (!status)
        return csg_sink_close(&sink);
    csg_sink_discard(&sink);
    return status;
}

/* How many times its own size the mesh lies from zero, where it has an origin. */
static double distance_of(const csgm_mesh_view *mesh)
{
    float size = FLT_MIN;
    if (!csg_view_is_offset(mesh))
        return 0;
    for (uint64_t i = 0; i < 3 * mesh->vertex_count; i++)
        size = fmaxf(size, fabsf(mesh->positions[i]));
    return csg_vec3_norm(mesh->origin) / (double)size;
}

static csgm_status fill_rounded(csgm_context *context, const csgm_mesh_view *mesh, const target *to,
                                const csg_format_row *row, const csgm_write_options *options)
{
    csg_rounding rounding = {.kind = CSG_ROUND_FLOAT};
    csg_rounded rounded;
    if (row->traits & CSGM_KEEPS_DOUBLES)
        rounding.kind = CSG_ROUND_DOUBLE;
    if (!csg_format_rounds(row, distance_of(mesh)))
        return fill(context, mesh, to, row, options);
    csgm_status status = csg_round_mesh(context, mesh, &rounding, to->name, row->title, &rounded);
    if (status)
        return status;
    status = fill(context, &rounded.mesh, to, row, options);
    csg_rounded_release(context, &rounded);
    return status;
}

/* ---- parts that touch ------------------------------------------------------------------ */

static const uint32_t SEVERAL = CSG_NO_PART - 1; /* parts */

/* Places that vertices of several parts share. to: from csg_weld_map. */
static uint64_t count_touching(uint64_t vertex_count, const uint32_t *to, uint32_t *part_of)
{
    uint64_t touching = 0;
    for (uint64_t v = 0; v < vertex_count; v++) {
        uint32_t *at_place = &part_of[to[v]];
        if (part_of[v] == CSG_NO_PART || *at_place == SEVERAL || *at_place == part_of[v])
            continue;
        touching += *at_place != CSG_NO_PART;
        *at_place = *at_place == CSG_NO_PART ? part_of[v] : SEVERAL;
    }
    return touching;
}

/* Each part is closed, and their vertices are told apart by number alone: where a format has only
 * places, who reads it joins parts that touch, and edges there are used by more than two triangles.
 */
static csgm_status tell_of_touching(csgm_context *context, const csgm_mesh_view *mesh,
                                    const char *name, const csg_format_row *row)
{
    if (mesh->part_count < 2 || !mesh->vertex_count || row->traits & CSGM_KEEPS_VERTICES)
        return CSGM_OK;
    csg_memory *memory = &context->memory;
    size_t bytes = (size_t)mesh->vertex_count * sizeof(uint32_t);
    uint32_t *to = csg_memory_alloc(memory, bytes), *part_of = csg_memory_alloc(memory, bytes);
    uint64_t touching = 0;
    bool failed = !to || !part_of;
    if (!failed) {
        csg_weld_parts_of(mesh, part_of);
        csg_weld_map(memory, mesh, CSG_WELD_ALL, to, &failed);
    }
    if (!failed)
        touching = count_touching(mesh->vertex_count, to, part_of);
    csg_memory_release(memory, to, bytes);
    csg_memory_release(memory, part_of, bytes);
    if (failed)
        return csg_context_no_memory(context);
    if (touching)
        csg_diag_plain(
            &context->diags, CSG_DIAG_PARTS_TOUCH, name, "3MF, glTF and OBJ keep parts apart",
            "parts touch in %llu %s, which readers of %s join: not a manifold there",
            (unsigned long long)touching, touching == 1 ? "vertex" : "vertices", row->title);
    return CSGM_OK;
}

/* Formats that keep creases have a vertex for each sheet there, for the others they are joined. */
static csgm_status fill_joined(csgm_context *context, const csgm_mesh_view *mesh, const target *to,
                               const csg_format_row *row, const csgm_write_options *options)
{
    if (!mesh->split || row->traits & CSGM_KEEPS_CREASES)
        return fill_rounded(context, mesh, to, row, options);
    csgm_mesh *joined;
    csgm_status status = csg_weld_runs(context, mesh, &joined);
    if (status)
        return status;
    csgm_mesh_view view = csg_mesh_view(joined);
    status = fill_rounded(context, &view, to, row, options);
    csg_mesh_destroy(joined);
    return status;
}

/* Has a warning that counts as an error come since? Then nothing is written. */
static csgm_status heed_warnings(const csgm_context *context, uint32_t errors)
{
    return context->diags.warnings_as_errors && context->diags.errors != errors ? CSGM_ERR_SCENE
                                                                                : CSGM_OK;
}

/* companion: NULL, or with a nameless file. */
static csgm_status write_fd(csgm_context *context, const csgm_mesh_view *mesh, const target *to,
                            csgm_format format, const csgm_write_options *options)
{
    csgm_write_options defaults = csg_write_options_default();
    const csg_format_row *row;
    options = options ? options : &defaults;
    uint32_t errors = context->diags.errors;
    csgm_status status = prepare(context, mesh, to->name, format, options, &row);
    if (!status)
        status = fill_joined(context, mesh, to, row, options);
    return status ? status : heed_warnings(context, errors);
}

csgm_status csg_io_write_fd(csgm_context *context, const csgm_mesh_view *mesh, int fd,
                            const char *name, csgm_format format, const csgm_write_options *options)
{
    return write_fd(context, mesh, &(target){fd, name, NULL}, format, options);
}

/* Both get their names, or none; the status of the whole. */
static csgm_status commit_both(csg_atomic_file *file, csg_companion *companion, csgm_status status)
{
    if (companion->is_there && status)
        csg_file_abandon(&companion->file);
    else if (companion->is_there)
        status = csg_file_commit(&companion->file);
    if (!status)
        return csg_file_commit(file);
    csg_file_abandon(file);
    return status;
}

csgm_status csg_io_write(csgm_context *context, const csgm_mesh_view *mesh, const char *path,
                         csgm_format format, const csgm_write_options *options)
{
    csgm_write_options defaults = csg_write_options_default();
    const csg_format_row *row;
    csg_atomic_file file;
    options = options ? options : &defaults;
    csgm_status status = prepare(context, mesh, path, format, options, &row);
    if (status)
        return status;
    uint32_t errors = context->diags.errors;
    status = csg_file_create(&file, context, path);
    if (status)
        return status;
    file.sync = options->sync;
    file.only_if_changed = options->only_if_changed;
    csg_companion companion = {.is_there = false};
    csg_arena_init(&companion.names, &context->memory);
    const target to = {file.fd, path, file.target ? &companion : NULL};
    status = tell_of_touching(context, mesh, path, row);
    if (!status)
        status = fill_joined(context, mesh, &to, row, options);
    if (!status)
        status = heed_warnings(context, errors);
    status = commit_both(&file, &companion, status);
    csg_arena_reset(&companion.names);
    return status;
}

static FILE *open_nameless(csgm_context *context, const char *name)
{
    FILE *file = tmpfile();
#ifdef __linux__
    if (!file) { /* as below --root */
        int fd = memfd_create("csgmesh", MFD_CLOEXEC);
        file = fd < 0 ? NULL : fdopen(fd, "w+b");
    }
#endif
    if (file)
        fcntl(fileno(file), F_SETFD, FD_CLOEXEC);
    else
        csg_diag_plain(&context->diags, CSG_DIAG_CANNOT_WRITE, name, NULL, "cannot write: %s",
                       strerror(errno));
    return file;
}

csgm_status csg_io_as_file(csgm_context *context, const csgm_mesh_view *mesh, csgm_format format,
                           const csgm_write_options *options, csgm_mesh **out)
{
    const char *name = "a temporary file";
    FILE *file = open_nameless(context, name);
    FILE *beside = file ? open_nameless(context, name) : NULL;
    csgm_status status = beside ? CSGM_OK : CSGM_ERR_IO;
    if (!status) {
        int fd = fileno(file), fd_beside = fileno(beside);
        csg_companion companion = {.nameless = &fd_beside};
        csg_arena_init(&companion.names, &context->memory);
        status = write_fd(context, mesh, &(target){fd, name, &companion}, format, options);
        csg_arena_reset(&companion.names);
        rewind(file);
        rewind(beside);
        if (!status)
            status = csg_io_read_both(context, fd, &fd_beside, name, format, out);
    }
    if (file)
        fclose(file);
    if (beside)
        fclose(beside);
    return status;
}
