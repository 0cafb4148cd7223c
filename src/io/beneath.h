/* SPDX-License-Identifier: MIT
 * Files that a file names: only those below a folder, whatever `..`, absolute paths and links say.
 */
#ifndef CSG_IO_BENEATH_H
#define CSG_IO_BENEATH_H

/* Opens the file for reading, relative to the folder ("" = the current one). -1 with errno set;
 * EXDEV or ELOOP: it lies elsewhere. */
int csg_open_beneath(const char *folder, const char *name);

#endif
