/* SPDX-License-Identifier: MIT
 * Looks at the clock; see read_clock.h.
 */
#include "io/read_clock.h"

#include "base/clock.h"
#include "base/mesh_codes.h"

void csg_read_clock_start(csg_read_clock *clock, csgm_context *context, double from_s)
{
    *clock = (csg_read_clock){.context = context};
    if (context->limits.timeout_s > 0)
        clock->deadline_s = (from_s > 0 ? from_s : csg_clock_now_s()) + context->limits.timeout_s;
}

bool csg_read_has_time(csg_read_clock *clock)
{
    clock->is_cancelled |= csg_context_is_cancelled(clock->context);
    clock->is_late |=
        clock->is_cancelled || (clock->deadline_s > 0 && csg_clock_now_s() > clock->deadline_s);
    return !clock->is_late;
}

bool csg_read_has_time_for_step(csg_read_clock *clock)
{
    enum { EACH = 1 << 10 };
    return ++clock->steps % EACH == 0 ? csg_read_has_time(clock) : !clock->is_late;
}

csgm_status csg_read_why_late(const csg_read_clock *clock)
{
    if (clock->is_cancelled)
        return CSGM_CANCELLED;
    csg_diag_plain(&clock->context->diags, CSG_DIAG_TIMEOUT, NULL, "raise --timeout",
                   "reading the mesh takes more than %g s", clock->context->limits.timeout_s);
    return CSGM_ERR_LIMIT;
}
