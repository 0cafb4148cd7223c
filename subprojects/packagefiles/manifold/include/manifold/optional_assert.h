/* SPDX-License-Identifier: MIT
 * In place of Manifold's own: as released, memory that is not there is looked at in its debugging
 * builds only, and else written to. Assertions for debugging alone stay out.
 */
#pragma once

#include <stdexcept>

using logicErr = std::logic_error;

#define DEBUG_ASSERT(condition, EX, msg)
#define ASSERT(condition, EX)                                                                      \
    do {                                                                                           \
        if (!(condition))                                                                          \
            throw EX;                                                                              \
    } while (false)
