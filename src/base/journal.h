/* SPDX-License-Identifier: MIT
 * A journal: records that are appended to a file while long work goes on, and read back in their
 * order by a later process that goes on with it, up to the first that is torn or damaged. One
 * writer; nothing of it can be read on a machine with another byte order.
 */
#ifndef CSG_BASE_JOURNAL_H
#define CSG_BASE_JOURNAL_H

#include "base/memory.h"

typedef struct csg_journal {
    csg_memory *memory;
    int fd;      /* -1: not open */
    uint64_t at; /* where the next record begins; what is behind has not been read, or is nothing */
} csg_journal;

typedef struct csg_journal_piece {
    const void *bytes;
    uint64_t count;
} csg_journal_piece;

enum { CSG_JOURNAL_PIECES = 6 }; /* of a record, at most */

/* Opens or makes the file. Its first record is to be `head`: a journal that begins with another
 * one, or with none, is emptied and begun anew. 0, or errno and nothing is open. */
int csg_journal_open(csg_journal *journal, csg_memory *memory, const char *path, const void *head,
                     uint64_t head_bytes);
/* The next record, if it is whole and of this kind: of csg_memory, released by the caller. NULL,
 * and the journal stays where it is: it is not. A record has a byte or more. */
void *csg_journal_read(csg_journal *journal, uint32_t kind, uint64_t *bytes);
/* Appends a record behind those that were read or written, in place of what stands there. sync: it
 * is on the disk. 0 or errno. */
int csg_journal_write(csg_journal *journal, uint32_t kind, const csg_journal_piece *pieces,
                      int count, bool sync);
/* What is not open is closed, too. */
void csg_journal_close(csg_journal *journal);

#endif
