/* SPDX-License-Identifier: MIT
 * The sRGB transfer curve; see color.h.
 */
#include "io/color.h"

#include <math.h>

#include "base/elementary.h"

static double srgb_to_linear(double s)
{
    return s <= 0.04045 ? s / 12.92 : csg_pow((s + 0.055) / 1.055, 2.4);
}

double csg_color_linear(uint8_t srgb)
{
    return srgb_to_linear(srgb / 255.0);
}

static uint16_t snap(double value, uint32_t bits, bool wide)
{
    double steps = bits < 16 ? (double)((1u << bits) - 1) : 65535.0;
    double snapped = floor(value * steps + 0.5) / steps;
    return (uint16_t)floor(snapped * (wide ? 65535.0 : 255.0) + 0.5);
}

csg_color_table csg_color_table_make(uint32_t bits, bool wide)
{
    csg_color_table table;
    for (int i = 0; i < 256; i++) {
        table.linear[i] = snap(srgb_to_linear(i / 255.0), bits, wide);
        table.alpha[i] = snap(i / 255.0, bits, wide);
    }
    return table;
}

uint8_t csg_color_to_byte(float value)
{
    if (!(value > 0))
        return 0;
    return (uint8_t)(value >= 1 ? 255.0f : value * 255.0f + 0.5f);
}

uint8_t csg_color_to_srgb(float linear)
{
    if (!(linear > 0))
        return 0;
    if (linear >= 1)
        return 255;
    double l = (double)linear;
    return csg_color_to_byte(
        (float)(l <= 0.0031308 ? 12.92 * l : 1.055 * csg_pow(l, 1 / 2.4) - 0.055));
}
