/* SPDX-License-Identifier: MIT
 * The time limit and the caller's wish while a file is read, from when its first byte is asked for.
 */
#ifndef CSG_IO_READ_CLOCK_H
#define CSG_IO_READ_CLOCK_H

#include "base/context.h"

typedef struct csg_read_clock {
    csgm_context *context;
    double deadline_s; /* by csg_clock_now_s, from the limits; 0 = none */
    uint32_t steps;    /* the clock is looked at now and then */
    bool is_late;      /* it is time: sticky */
    bool is_cancelled; /* and why */
} csg_read_clock;

/* from_s: when the reading began, by csg_clock_now_s; 0 = now. */
void csg_read_clock_start(csg_read_clock *clock, csgm_context *context, double from_s);
/* Looks at the clock. */
bool csg_read_has_time(csg_read_clock *clock);
/* The same for what is done once for each vertex or triangle: looks each 1024th time. */
bool csg_read_has_time_for_step(csg_read_clock *clock);
/* Once it is late: reports the limit, and is what the reading ends with. */
csgm_status csg_read_why_late(const csg_read_clock *clock);

#endif
