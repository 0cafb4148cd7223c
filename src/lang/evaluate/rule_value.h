/* SPDX-License-Identifier: MIT
 * The value that a rule is.
 */
#ifndef CSG_LANG_RULE_VALUE_H
#define CSG_LANG_RULE_VALUE_H

#include "lang/evaluate/value.h"
#include "scene/operators/rule.h"

struct csg_rule_value {
    csg_object object;
    csg_rule rule;          /* checked, not settled */
    csg_function *function; /* of profile(), else NULL */
};

#endif
