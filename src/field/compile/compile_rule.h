/* SPDX-License-Identifier: MIT
 * Soft nodes and operators with a rule on their way into the tape: their parameters in float, as
 * tape.h lays them out.
 */
#ifndef CSG_FIELD_COMPILE_RULE_H
#define CSG_FIELD_COMPILE_RULE_H

#include "field/rule_layout.h"
#include "field/tape.h"
#include "scene/operators/soft.h"

/* What the node above takes: values f, or fields F (as an operand of an operator that takes
 * fields), or their complements 1 - F. */
typedef enum csg_form { CSG_FORM_VALUE, CSG_FORM_FIELD, CSG_FORM_COMPLEMENT } csg_form;

enum { CSG_RULE_MOST_PARAMETERS = CSG_ARC_MOST_PARAMETERS };
_Static_assert((int)CSG_RULE_MOST_PARAMETERS >= (int)CSG_SMOOTH_PARAMETERS, "either kind fits");

/* Whether the operator's joins work on 1 - F (tape.h). */
/* Whether it is TURNING (turning.h). */
bool csg_blend_turns(uint32_t kind);
bool csg_rule_works_on_complements(uint32_t kind, bool is_union);

/* How a field is delivered; scale: 1 / lambda with its sign. flip: of 1 - F. */
void csg_deliver_pack(csg_form form, bool flip, double scale, double shift,
                      float values[CSG_DELIVER_PARAMETERS]);

/* A SOFTEN node by a soft() whose child's values come times `factor`; returns its curve. */
csg_tape_curve csg_soften_pack_soft(csg_soft soft, double factor,
                                    float values[CSG_SOFTEN_PARAMETERS]);
/* The same for an operand that is no field yet. */
csg_tape_curve csg_soften_pack_operand(csg_operand operand, double factor,
                                       float values[CSG_SOFTEN_PARAMETERS]);

/* An operator's parameters but for those of its delivery; returns how many. *kind: as what the tape
 * knows it. support: csg_scene_support. */
size_t csg_rule_pack(const csg_rule *rule, bool is_union, double factor, double support,
                     uint32_t *kind, float values[CSG_RULE_MOST_PARAMETERS]);

#endif
