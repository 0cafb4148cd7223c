/* SPDX-License-Identifier: MIT
 * Colour between the mesh's sRGB bytes and glTF's linear values (IEC 61966-2-1), by tables so that
 * it costs nothing a vertex and is the same everywhere.
 */
#ifndef CSG_IO_COLOR_H
#define CSG_IO_COLOR_H

#include <stdbool.h>
#include <stdint.h>

typedef struct csg_color_table {
    uint16_t linear[256]; /* sRGB byte -> linear, 0..65535 */
    uint16_t alpha[256];  /* byte -> 0..65535 */
} csg_color_table;

/* bits: values are snapped to 2^bits - 1 steps, 16 = all; wide false gives 0..255. */
csg_color_table csg_color_table_make(uint32_t bits, bool wide);
double csg_color_linear(uint8_t srgb);
/* Linear 0..1 -> sRGB byte; the inverse of the 16-bit table. Anything, NaN too, gives a byte. */
uint8_t csg_color_to_srgb(float linear);
/* 0..1 -> byte, rounded. */
uint8_t csg_color_to_byte(float value);

#endif
