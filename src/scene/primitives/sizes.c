/* SPDX-License-Identifier: MIT
 * What a scene's numbers may be; see sizes.h. NaN fails every comparison, so ranges are written
 * such that it is refused.
 */
#include "scene/primitives/sizes.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

bool csg_refuse(csg_refusal *refusal, const char *format, ...)
{
    if (refusal->is_set)
        return false;
    refusal->is_set = true;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(refusal->text, sizeof refusal->text, format, arguments);
    va_end(arguments);
    return false;
}

bool csg_check_range(csg_refusal *refusal, double value, const char *what)
{
    if (!isfinite(value))
        return csg_refuse(refusal, "%s is not a finite number", what);
    if (fabs(value) > CSG_LARGEST_LENGTH)
        return csg_refuse(refusal, "%s is larger than %g", what, CSG_LARGEST_LENGTH);
    return true;
}

bool csg_check_positive(csg_refusal *refusal, double value, const char *what)
{
    if (!csg_check_range(refusal, value, what))
        return false;
    if (value <= 0)
        return csg_refuse(refusal, "%s must be positive", what);
    if (value < CSG_SMALLEST_LENGTH)
        return csg_refuse(refusal, "%s is smaller than %g", what, CSG_SMALLEST_LENGTH);
    return true;
}

bool csg_check_not_negative(csg_refusal *refusal, double value, const char *what)
{
    if (!csg_check_range(refusal, value, what))
        return false;
    return value >= 0 || csg_refuse(refusal, "%s must not be negative", what);
}

bool csg_check_radii(csg_refusal *refusal, double r1, double r2)
{
    if (!csg_check_not_negative(refusal, r1, "the radius") ||
        !csg_check_not_negative(refusal, r2, "the radius"))
        return false;
    return fmax(r1, r2) >= CSG_SMALLEST_LENGTH ||
           csg_refuse(refusal, "one of the two radii must be positive");
}

bool csg_check_rounding(csg_refusal *refusal, double round, double smallest)
{
    if (!csg_check_not_negative(refusal, round, "the rounding radius"))
        return false;
    return round <= smallest ||
           csg_refuse(refusal, "the rounding radius is more than half the smallest side");
}
