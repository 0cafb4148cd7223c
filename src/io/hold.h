/* SPDX-License-Identifier: MIT
 * Files that appear together or not at all: while a context holds them, those that are complete
 * wait for their names. Pipes and devices do not wait.
 */
#ifndef CSG_IO_HOLD_H
#define CSG_IO_HOLD_H

#include "io/file.h"

/* Takes a complete file over; reports CSGM_ERR_MEMORY and abandons it. */
csgm_status csg_hold_add(csg_atomic_file *file);

/* From now on files are held. */
void csg_hold_begin(csgm_context *context);
/* keep: they get their names, in the order in which they were written, or from the first on that
 * cannot have its name (reported) they are removed. Else all are removed. */
csgm_status csg_hold_end(csgm_context *context, bool keep);

#endif
