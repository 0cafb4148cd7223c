/* SPDX-License-Identifier: MIT
 * What a round (rounds.h) has found of the cubes in one cube of the frontier, in the order in which
 * they are walked, so that the next round looks only at those that it divides further.
 */
#ifndef CSG_MEASURE_LEDGER_H
#define CSG_MEASURE_LEDGER_H

#include "base/memory.h"

typedef struct csg_ledger {
    double *opens;  /* what each cube leaves open; less than 0: it is divided */
    char *accounts; /* of those that are not */
    size_t count, room, leaves, leaf_room;
    bool is_lost; /* there was no memory for it: nothing is known */
} csg_ledger;

/* In no more memory than it needs; of few cubes, which are soon looked at again, none is kept. */
csg_ledger csg_ledger_copy(const csg_ledger *from, csg_memory *memory, size_t account_bytes);
void csg_ledger_release(csg_ledger *r, csg_memory *memory, size_t account_bytes);
size_t csg_ledger_bytes(const csg_ledger *r, size_t account_bytes);

/* Empty, in the memory that it has. */
void csg_ledger_begin(csg_ledger *r);
void csg_ledger_add_divided(csg_ledger *r, csg_memory *memory);
void csg_ledger_add_leaf(csg_ledger *r, csg_memory *memory, double open, const void *account,
                         size_t account_bytes);

/* A place in a ledger. */
typedef struct csg_ledger_reader {
    const csg_ledger *of; /* NULL: nothing is known of what is walked */
    size_t at, leaf;
} csg_ledger_reader;

/* The next cube: what it leaves open and its account; less than 0: it is divided. */
double csg_ledger_read(csg_ledger_reader *reader, size_t account_bytes, const void **account);

#endif
