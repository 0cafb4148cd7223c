/* SPDX-License-Identifier: MIT
 * Files of text -> a ZIP archive in a sink, compressed by all threads in memory that does not grow
 * with the text. No time stamps: the same text gives the same bytes, whatever the number of
 * threads.
 */
#ifndef CSG_IO_ZIP_WRITE_H
#define CSG_IO_ZIP_WRITE_H

#include "io/sink.h"

typedef struct csg_zip csg_zip;

enum { CSG_ZIP_PIECE_BYTES = 1 << 18 };

/* Reports what fails (memory only). */
csgm_status csg_zip_create(csg_sink *sink, csg_zip **out);
/* NULL is a no-op. */
void csg_zip_destroy(csg_zip *zip);

/* Begins the next file; name: ASCII, static storage. Ends the one before. */
void csg_zip_file(csg_zip *zip, const char *name);
void csg_zip_text(csg_zip *zip, const char *text, size_t length);

/* Puts the text of piece `index`, at most CSG_ZIP_PIECE_BYTES, and returns its length. Any worker.
 */
typedef size_t csg_zip_piece_fn(void *user, uint64_t index, char *text);
void csg_zip_pieces(csg_zip *zip, uint64_t count, csg_zip_piece_fn *piece, void *user);

/* Ends the archive. CSGM_ERR_UNSUPPORTED (not reported): a file or the archive of 4 GiB or more. */
csgm_status csg_zip_finish(csg_zip *zip);

#endif
