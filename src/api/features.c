/* SPDX-License-Identifier: MIT
 * Which outside libraries this build has; meson.build writes the lines.
 */
#include "csgmesh/csgmesh.h"
#include "build_features.h"

const char *csgm_build_features(void)
{
    return CSG_BUILD_FEATURES;
}
