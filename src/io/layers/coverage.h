/* SPDX-License-Identifier: MIT
 * How much of each pixel contours enclose: exactly, but for rounding.
 */
#ifndef CSG_IO_COVERAGE_H
#define CSG_IO_COVERAGE_H

#include "shape/plane/outline.h"

/* Of rows [first, end) of pixels with this edge: row 0 is the topmost, its upper left corner at
 * `corner`. sums: (width + 2) doubles a row, to be zeros. Points times scale are in the corner's
 * unit. */
void csg_coverage_add(const csg_outline *contours, double scale, csg_vec2 corner, double pixel,
                      uint32_t width, uint32_t first, uint32_t end, double *sums);
/* One row of sums as bytes: 0 nothing, 255 all of the pixel. */
void csg_coverage_bytes(const double *sums, uint32_t width, uint8_t *out);

#endif
