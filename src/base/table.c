/* SPDX-License-Identifier: MIT
 * Room in tables of numbers; see table.h.
 */
#include "base/table.h"

#include <string.h>

enum { FEWEST_SLOTS = 64 };

void csg_table_release(csg_table *table)
{
    if (table->slots)
        csg_memory_release(table->memory, table->slots, table->size * sizeof *table->slots);
    csg_table_init(table, table->memory);
}

bool csg_table_grow(csg_table *table, size_t count, csg_table_hash *hash, const void *entries)
{
    csg_table grown = {.memory = table->memory, .size = table->size ? table->size : FEWEST_SLOTS};
    while (grown.size / 2 < count)
        grown.size *= 2;
    grown.slots = csg_memory_alloc(grown.memory, grown.size * sizeof *grown.slots);
    if (!grown.slots)
        return false;
    memset(grown.slots, 0xff, grown.size * sizeof *grown.slots); /* CSG_TABLE_NONE */
    for (size_t i = 0; i < table->size; i++)
        if (table->slots[i] != CSG_TABLE_NONE)
            csg_table_add(&grown, hash(entries, table->slots[i]), table->slots[i]);
    csg_table_release(table);
    *table = grown;
    return true;
}
