/* SPDX-License-Identifier: MIT
 * Monotonic wall clock in seconds; its zero has no meaning.
 */
#ifndef CSG_BASE_CLOCK_H
#define CSG_BASE_CLOCK_H

double csg_clock_now_s(void);

#endif
