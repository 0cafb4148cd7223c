/* SPDX-License-Identifier: MIT
 * Monotonic wall clock; its zero has no meaning. And the time a thread has had of a processor.
 */
#ifndef CSG_BASE_CLOCK_H
#define CSG_BASE_CLOCK_H

#include <stdint.h>

double csg_clock_now_s(void);
uint64_t csg_clock_now_ns(void);
/* Processor time of the calling thread. */
uint64_t csg_clock_thread_ns(void);

#endif
