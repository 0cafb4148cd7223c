/* SPDX-License-Identifier: MIT
 * The fixture of tests that fill one outline: empty before each test, all memory back after it.
 */
#ifndef CSG_TESTS_OUTLINE_FIXTURE_H
#define CSG_TESTS_OUTLINE_FIXTURE_H

#include "outline_support.h"

static csg_memory memory;
static csg_outline outline;

static int begin(void **state)
{
    csg_memory_init(&memory, NULL, 0);
    csg_outline_init(&outline, &memory);
    return 0;
}

static int end(void **state)
{
    csg_outline_release(&outline);
    assert_int_equal(memory.used_bytes, 0);
    return 0;
}

#endif
