/* SPDX-License-Identifier: MIT
 * Which operands of an operator on fields can matter in a cell: part of prune.c.
 *
 * One may be dropped where every value in its range leaves the other one as it is, bit for bit
 * (soft_formulas.h): of a sum the one that is 0, of a product the one that is 1, of two the one
 * that is too small or too large beside the other, by their ratio. All that is looked at are the
 * operands' ranges, so it holds whatever the result is needed for.
 */
#ifndef CSG_FIELD_PRUNE_FIELDS_H
#define CSG_FIELD_PRUNE_FIELDS_H

#include "field/kernels/batch.h"

/* Whether the operator gives a lone operand back as it is, bit for bit. */
bool csg_prune_is_identity(const csg_tape *tape, const csg_tape_node *op);
/* A tape's nodes over eight cubes: ranges of their values, and a bit per cube where they may be
 * left out. */
typedef struct csg_field_ranges {
    const csg_tape *tape;
    const float *low, *high; /* CSG_OCTANTS per node */
    uint8_t *dropped;        /* per node */
} csg_field_ranges;

/* Marks operands of node, which takes fields, as dropped; where anything was dropped, a bit per
 * cube. */
uint8_t csg_prune_fields(csg_field_ranges ranges, uint32_t node);
/* The values of its child that a SOFTEN node tells apart. */
void csg_soften_demand(const csg_tape *tape, const csg_tape_node *node, float *low, float *high);

#endif
