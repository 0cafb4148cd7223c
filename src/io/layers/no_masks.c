/* SPDX-License-Identifier: MIT
 * Stands in for mask_layers.c in a build without zlib.
 */
#include "io/layers/layers.h"

const csg_layers_writer csg_layers_zip = {.has_masks = true};

bool csg_masks_available(void)
{
    return false;
}
