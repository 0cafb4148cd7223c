/* SPDX-License-Identifier: MIT
 * Random parts of rules: unit steps and profiles, within ranges that the test names.
 */
#ifndef TEST_RANDOM_RULE_H
#define TEST_RANDOM_RULE_H

#include "base/random.h"
#include "scene/operators/rule.h"

typedef struct test_step_ranges {
    double least_sigmoid;             /* the largest is 40 */
    uint32_t most_bspline, most_rest; /* orders from 1 */
} test_step_ranges;

static inline csg_step test_random_step(csg_random *random, test_step_ranges ranges)
{
    csg_step step = {(csg_step_kind)csg_random_below(random, CSG_STEP_COUNT), 0};
    step.parameter =
        step.kind == CSG_STEP_SIGMOID   ? csg_random_uniform(random, ranges.least_sigmoid, 40)
        : step.kind <= CSG_STEP_BSPLINE ? 1 + csg_random_below(random, ranges.most_bspline)
                                        : 1 + csg_random_below(random, ranges.most_rest);
    return step;
}

/* Of an arc blend whose angles are set; factors from `least` to `most`. */
static inline void test_random_profile(csg_random *random, csg_rule *rule, double least,
                                       double most)
{
    double at = rule->parameters[0], step = (rule->parameters[1] - at) / 5;
    rule->spline.count = csg_random_below(random, 4);
    for (uint32_t i = 0; i < rule->spline.count; i++) {
        at += step * csg_random_uniform(random, 0.4, 1.2);
        rule->spline.angle[i] = at;
        rule->spline.factor[i] = csg_random_uniform(random, least, most);
    }
}

#endif
