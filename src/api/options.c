/* SPDX-License-Identifier: MIT
 * Options of older versions; see options.h. Each options struct begins with its size in bytes, is
 * aligned to eight of them, and grows behind its padding only, so a size that is no multiple of
 * eight is nobody's. A larger struct may ask for what this version does not know: it is refused.
 */
#include "api/options.h"

#include <string.h>

enum { STEP = 8 };

bool csg_options_adopt(void *own, size_t own_bytes, const void *given)
{
    uint32_t size, own_size = (uint32_t)own_bytes;
    if (!given)
        return true;
    memcpy(&size, given, sizeof size);
    if (size < 2 * STEP || size % STEP || size > own_size)
        return false;
    memcpy(own, given, size);
    memcpy(own, &own_size, sizeof own_size);
    return true;
}
