/* SPDX-License-Identifier: MIT
 * Mesh files of the public interface: checks the arguments and calls io, which checks the rest.
 */
#include "api/options.h"
#include "api/view.h"

#include <errno.h>
#include <stdlib.h>

#include "io/file.h"
#include "io/formats.h"

csgm_format csgm_format_from_path(const char *path)
{
    return path ? csg_format_from_path(path) : CSGM_FORMAT_AUTO;
}

csgm_format csgm_format_from_name(const char *name)
{
    return name ? csg_format_from_name(name) : CSGM_FORMAT_AUTO;
}

const char *csgm_format_name(csgm_format format)
{
    return csg_format_name(format);
}

const char *csgm_format_title(csgm_format format)
{
    return csg_format_title(format);
}

uint32_t csgm_format_traits(csgm_format format)
{
    return csg_format_traits(format);
}

bool csgm_format_available(csgm_format format, bool for_reading)
{
    return csg_format_available(format, for_reading);
}

csgm_write_options csgm_write_options_default(void)
{
    return csg_write_options_default();
}

void csgm_files_abandon(void)
{
    csg_io_cleanup_pending();
}

csgm_status csgm_files_hold(csgm_context *context)
{
    if (!context)
        return CSGM_ERR_ARGUMENT;
    csg_files_hold(context);
    return CSGM_OK;
}

csgm_status csgm_files_release(csgm_context *context, bool keep)
{
    return context ? csg_files_release(context, keep) : CSGM_ERR_ARGUMENT;
}

struct csgm_file {
    csg_atomic_file file;
    csgm_context own; /* where the caller has none */
};

csgm_status csgm_file_create(csgm_context *context, const char *path, csgm_file **out)
{
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!path)
        return CSGM_ERR_ARGUMENT;
    csgm_file *file = calloc(1, sizeof *file);
    if (!file)
        return context ? csg_context_no_memory(context) : CSGM_ERR_MEMORY;
    csg_memory_init(&file->own.memory, NULL, 0);
    csgm_status status = csg_file_create(&file->file, context ? context : &file->own, path);
    int error = errno;
    if (status == CSGM_OK)
        *out = file;
    else
        free(file);
    errno = error;
    return status;
}

int csgm_file_descriptor(const csgm_file *file)
{
    return file->file.fd;
}

csgm_status csgm_file_end(csgm_file *file, bool keep, bool sync)
{
    csgm_status status = CSGM_OK;
    if (!file)
        return CSGM_OK;
    file->file.sync = sync;
    if (keep)
        status = csg_file_commit(&file->file);
    else
        csg_file_abandon(&file->file);
    int error = errno;
    free(file);
    errno = error;
    return status;
}

void csgm_files_sweep(const char *folder)
{
    if (folder)
        csg_temporary_sweep(folder);
}

csgm_status csgm_mesh_write(csgm_context *context, const csgm_mesh_view *mesh, const char *path,
                            csgm_format format, const csgm_write_options *options)
{
    csgm_write_options own = csgm_write_options_default();
    if (!context || !csg_view_is_sound(mesh) || !path || format >= CSGM_FORMAT_COUNT ||
        !csg_options_adopt(&own, sizeof own, options))
        return CSGM_ERR_ARGUMENT;
    return csg_io_write(context, mesh, path, format, &own);
}

csgm_status csgm_mesh_write_fd(csgm_context *context, const csgm_mesh_view *mesh, int fd,
                               const char *name, csgm_format format,
                               const csgm_write_options *options)
{
    csgm_write_options own = csgm_write_options_default();
    if (!context || !csg_view_is_sound(mesh) || fd < 0 || format >= CSGM_FORMAT_COUNT ||
        !csg_options_adopt(&own, sizeof own, options))
        return CSGM_ERR_ARGUMENT;
    return csg_io_write_fd(context, mesh, fd, name, format, &own);
}

csgm_status csgm_mesh_as_file(csgm_context *context, const csgm_mesh_view *mesh, csgm_format format,
                              const csgm_write_options *options, csgm_mesh **out)
{
    csgm_write_options own = csgm_write_options_default();
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !csg_view_is_sound(mesh) || format == CSGM_FORMAT_AUTO ||
        format >= CSGM_FORMAT_COUNT || !csg_options_adopt(&own, sizeof own, options))
        return CSGM_ERR_ARGUMENT;
    return csg_io_as_file(context, mesh, format, &own, out);
}

csgm_file_figures csgm_file_figures_default(void)
{
    return (csgm_file_figures){.struct_size = sizeof(csgm_file_figures)};
}

csgm_status csgm_mesh_file_inspect(csgm_context *context, const char *path, csgm_format format,
                                   csgm_file_figures *out)
{
    csgm_file_figures found = csgm_file_figures_default();
    if (!context || !path || format >= CSGM_FORMAT_COUNT || !out ||
        !csg_struct_is_known(out, sizeof *out))
        return CSGM_ERR_ARGUMENT;
    csgm_status status = csg_io_inspect(context, path, format, &found);
    if (status == CSGM_OK)
        csg_struct_deliver(out, &found);
    return status;
}

csgm_status csgm_mesh_read(csgm_context *context, const char *path, csgm_format format,
                           csgm_mesh **out)
{
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !path || format >= CSGM_FORMAT_COUNT)
        return CSGM_ERR_ARGUMENT;
    return csg_io_read(context, path, format, out);
}
