/* SPDX-License-Identifier: MIT
 * Ledgers of rounds; see ledger.h.
 */
#include "measure/ledger.h"

#include <string.h>

void csg_ledger_release(csg_ledger *r, csg_memory *memory, size_t account_bytes)
{
    csg_memory_release(memory, r->opens, r->room * sizeof *r->opens);
    csg_memory_release(memory, r->accounts, r->leaf_room * account_bytes);
    *r = (csg_ledger){.is_lost = true};
}

csg_ledger csg_ledger_copy(const csg_ledger *from, csg_memory *memory, size_t account_bytes)
{
    enum { FEW = 2 };
    csg_ledger to = {.is_lost = true};
    if (from->is_lost || from->leaves < FEW ||
        !csg_memory_reserve(memory, (void **)&to.opens, &to.room, from->count, sizeof *to.opens))
        return to;
    if (!csg_memory_reserve(memory, (void **)&to.accounts, &to.leaf_room, from->leaves,
                            account_bytes)) {
        csg_ledger_release(&to, memory, account_bytes);
        return to;
    }
    memcpy(to.opens, from->opens, from->count * sizeof *to.opens);
    memcpy(to.accounts, from->accounts, from->leaves * account_bytes);
    to.count = from->count;
    to.leaves = from->leaves;
    to.is_lost = false;
    return to;
}

void csg_ledger_begin(csg_ledger *r)
{
    r->count = r->leaves = 0;
    r->is_lost = false;
}

size_t csg_ledger_bytes(const csg_ledger *r, size_t account_bytes)
{
    return r->room * sizeof *r->opens + r->leaf_room * account_bytes;
}

static bool add(csg_ledger *r, csg_memory *memory, double open)
{
    r->is_lost = r->is_lost || !csg_memory_reserve(memory, (void **)&r->opens, &r->room,
                                                   r->count + 1, sizeof *r->opens);
    if (!r->is_lost)
        r->opens[r->count++] = open;
    return !r->is_lost;
}

void csg_ledger_add_divided(csg_ledger *r, csg_memory *memory)
{
    add(r, memory, -1);
}

void csg_ledger_add_leaf(csg_ledger *r, csg_memory *memory, double open, const void *account,
                         size_t account_bytes)
{
    if (!add(r, memory, open))
        return;
    r->is_lost = !csg_memory_reserve(memory, (void **)&r->accounts, &r->leaf_room, r->leaves + 1,
                                     account_bytes);
    if (!r->is_lost)
        memcpy(r->accounts + r->leaves++ * account_bytes, account, account_bytes);
}

double csg_ledger_read(csg_ledger_reader *reader, size_t account_bytes, const void **account)
{
    double open = reader->of->opens[reader->at++];
    if (open >= 0)
        *account = reader->of->accounts + reader->leaf++ * account_bytes;
    return open;
}
