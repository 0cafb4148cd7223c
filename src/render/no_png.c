/* SPDX-License-Identifier: MIT
 * Instead of png.c where libpng is missing.
 */
#include "render/image.h"

bool csg_png_is_available(void)
{
    return false;
}

bool csg_png_put(csg_sink *sink, const csgm_image *image)
{
    (void)sink, (void)image;
    return true; /* never called: image.c asks first */
}
