/* SPDX-License-Identifier: MIT
 * Options of older versions; see options.h. Each options struct begins with its size in bytes, is
 * aligned as a pointer at least, and grows behind its padding only, so a size that is no multiple
 * of a pointer's is nobody's. A larger struct may ask for what this version does not know: it is
 * refused.
 */
#include "api/options.h"

#include <string.h>

#include "field/field.h"

enum { STEP = sizeof(void *) };

bool csg_struct_is_known(const void *given, size_t own_bytes)
{
    uint32_t size;
    if (!given)
        return true;
    memcpy(&size, given, sizeof size);
    return size >= 2 * STEP && size % STEP == 0 && size <= own_bytes;
}

void csg_struct_deliver(void *given, const void *own)
{
    uint32_t size;
    if (!given)
        return;
    memcpy(&size, given, sizeof size);
    memcpy((char *)given + sizeof size, (const char *)own + sizeof size, size - sizeof size);
}

bool csg_options_adopt(void *own, size_t own_bytes, const void *given)
{
    uint32_t size, own_size = (uint32_t)own_bytes;
    if (!csg_struct_is_known(given, own_bytes))
        return false;
    if (!given)
        return true;
    memcpy(&size, given, sizeof size);
    memcpy(own, given, size);
    memcpy(own, &own_size, sizeof own_size);
    return true;
}

bool csg_option_is_name(const char *name, const char *wanted)
{
    return name && strcmp(name, wanted) == 0;
}

const csgm_field *csg_option_part(const csgm_field *field, const char *part)
{
    if (!part)
        return field;
    for (size_t i = 0; i < field->part_count; i++)
        if (csg_option_is_name(field->parts[i].name, part))
            return field->parts[i].field;
    return NULL;
}
