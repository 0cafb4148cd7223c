/* SPDX-License-Identifier: MIT
 * Field functions of soft objects, and distances as fields (operators.md 4, 9).
 */
#include <assert.h>
#include <math.h>

#include "scene/operators/soft.h"
#include "scene/operators/steps.h"

typedef struct falloff_row {
    const char *name;
    double iso, steepest;
} falloff_row;

static const falloff_row falloffs[] = {
#define CSG_FALLOFF(NAME, name, iso, steepest, steepest_at, doc) {#name, iso, steepest},
#include "scene/operators/falloffs.def"
#undef CSG_FALLOFF
};

const char *csg_falloff_name(csg_falloff falloff)
{
    assert((unsigned)falloff < CSG_FALLOFF_COUNT);
    return falloffs[falloff].name;
}

double csg_falloff_iso(csg_falloff falloff)
{
    return falloffs[falloff].iso;
}

double csg_falloff_steepest(csg_falloff falloff)
{
    return falloffs[falloff].steepest;
}

double csg_falloff_at(csg_falloff falloff, double d, double *slope)
{
    double s = d * d, rest = 1 - s;
    *slope = 0;
    if (!(d < 1)) /* NaN too */
        return 0;
    switch (falloff) {
    case CSG_FALLOFF_SEXTIC:
        *slope = d * (-44.0 / 9 + s * (68.0 / 9 - s * (8.0 / 3)));
        return rest * rest * (1 - s * (4.0 / 9)); /* the polynomial, in factors */
    case CSG_FALLOFF_CUBIC:
        *slope = -6 * d * rest * rest;
        return rest * rest * rest;
    case CSG_FALLOFF_QUARTIC:
        *slope = -4 * d * rest;
        return rest * rest;
    case CSG_FALLOFF_QUADRATIC:
        *slope = -2 * d;
        return rest;
    case CSG_FALLOFF_COUNT:
        break;
    }
    assert(!"a falloff");
    return NAN;
}

/* How fast d grows as f falls. */
static double rate_of(csg_soft soft)
{
    return (1 - csg_falloff_iso(soft.falloff)) / soft.range;
}

double csg_soft_lambda(csg_soft soft)
{
    return csg_falloff_steepest(soft.falloff) * rate_of(soft);
}

double csg_soft_at(csg_soft soft, double f, double *slope)
{
    double rate = rate_of(soft), d = csg_falloff_iso(soft.falloff) - f * rate;
    double field = csg_falloff_at(soft.falloff, fmax(d, 0), slope);
    *slope *= d > 0 ? -rate : 0;
    return field;
}

double csg_operand_field(csg_operand operand, double f, double *derivative)
{
    if (operand.soft) {
        double field = 0.5 + operand.slope * f;
        *derivative = field > 0 && field < 1 ? operand.slope : 0;
        return fmin(fmax(field, 0), 1);
    }
    double slope, field = csg_step_at((csg_step){CSG_STEP_POLY, 3}, operand.slope * f, &slope);
    *derivative = slope * operand.slope;
    return field;
}
