/* SPDX-License-Identifier: MIT
 * Files that a file names: only those below a folder, whatever `..`, absolute paths and links say.
 */
#ifndef CSG_IO_BENEATH_H
#define CSG_IO_BENEATH_H

#include "base/context.h"

/* Opens the file for reading, relative to the folder ("" = the current one). -1 with errno set;
 * EXDEV or ELOOP: it lies elsewhere. */
int csg_open_beneath(const char *folder, const char *name);
/* The same, relative to the folder in which the file of that path stands; the context is told. */
int csg_open_beside(const csgm_context *context, const char *path, const char *name);

#endif
