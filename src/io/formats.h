/* SPDX-License-Identifier: MIT
 * The io layer's door: what can be asked of a format (formats.def has one row each), and writing
 * and reading of whole meshes. The csg_format_* functions are the public csgm_format_* ones.
 */
#ifndef CSG_IO_FORMATS_H
#define CSG_IO_FORMATS_H

#include "base/context.h"
#include "mesh/mesh.h"

csgm_format csg_format_from_path(const char *path); /* NULL gives AUTO */
csgm_format csg_format_from_name(const char *name);
const char *csg_format_name(csgm_format format);
const char *csg_format_title(csgm_format format);
uint32_t csg_format_traits(csgm_format format); /* csgm_format_trait */
bool csg_format_available(csgm_format format, bool for_reading);

csgm_write_options csg_write_options_default(void);

/* Every failure is reported. CSGM_ERR_ARGUMENT: options or mesh break their contract (positions
 * must be finite, indices in range). CSGM_ERR_UNSUPPORTED: unknown format, a format that cannot
 * hold the mesh, or a library this build lacks. CSGM_ERR_IO: the file. options NULL = defaults. */
csgm_status csg_io_write(csgm_context *context, const csgm_mesh_view *mesh, const char *path,
                         csgm_format format, const csgm_write_options *options);
/* name: for diagnostics and, with AUTO, for the format. The descriptor stays open. */
csgm_status csg_io_write_fd(csgm_context *context, const csgm_mesh_view *mesh, int fd,
                            const char *name, csgm_format format,
                            const csgm_write_options *options);

/* AUTO = by extension, and where that says nothing by the first bytes. */
csgm_status csg_io_read(csgm_context *context, const char *path, csgm_format format,
                        csgm_mesh **out);
/* What is in the file, as public csgm_mesh_file_inspect has it. out->struct_size stays. */
csgm_status csg_io_inspect(csgm_context *context, const char *path, csgm_format format,
                           csgm_file_figures *out);
csgm_status csg_io_read_fd(csgm_context *context, int fd, const char *name, csgm_format format,
                           csgm_mesh **out);
/* companion: as csg_input has it. */
csgm_status csg_io_read_both(csgm_context *context, int fd, const int *companion, const char *name,
                             csgm_format format, csgm_mesh **out);
/* path: for diagnostics and for the folder of files that a glTF or OBJ names. */
csgm_status csg_io_read_memory(csgm_context *context, const uint8_t *bytes, size_t size_bytes,
                               const char *path, csgm_format format, csgm_mesh **out);

/* The mesh as a file of this format gives it back: written to a file without a name, and read. */
csgm_status csg_io_as_file(csgm_context *context, const csgm_mesh_view *mesh, csgm_format format,
                           const csgm_write_options *options, csgm_mesh **out);

/* Removes the temporary files of writes in progress; async-signal-safe, for a handler that is about
 * to end the process. */
void csg_io_cleanup_pending(void);

#endif
