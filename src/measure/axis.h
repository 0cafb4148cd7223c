/* SPDX-License-Identifier: MIT
 * Solids of revolution: whether all of a tape turns about one of its frame's axes. It is read off
 * the tape: each leaf turns about that axis, and operators look at nothing but what turns with it.
 */
#ifndef CSG_MEASURE_AXIS_H
#define CSG_MEASURE_AXIS_H

#include "field/tape.h"

enum { CSG_AXIS_NONE = -1 };

/* *axis: 0, 1 or 2, or CSG_AXIS_NONE. *tape: of the same field with the parameters in the arena
 * where there is an axis, and with as much more room (tape.h, off and turned) as its leaves leave a
 * solid that turns about the axis, twice: so what is proven in one half plane holds in all of them.
 * The same of what the scene says, which is NULL or known. False: out of memory. */
bool csg_axis_find(csg_tape *tape, size_t parameter_count, csg_tape_exact *exact, csg_arena *arena,
                   int *axis);

#endif
