/* SPDX-License-Identifier: MIT
 * Seeded random formulas for property tests: every operation, in places where it has a value.
 */
#ifndef TEST_RANDOM_FORMULA_H
#define TEST_RANDOM_FORMULA_H

#include "base/random.h"
#include "scene/tree/build.h"

enum { TEST_MOST_STEPS = 512 };

/* Steps of a formula of about `size` random operations; continuous: without mod and floor. Its
 * values and slopes are moderate for coordinates within [-2, 2]. Returns their count. */
uint32_t test_random_formula(csg_memory *memory, csg_random *random, unsigned size, bool continuous,
                             csg_formula_step *out);

#endif
