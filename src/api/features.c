/* SPDX-License-Identifier: MIT
 * Which outside libraries this build has; meson.build writes the lines.
 */
#include "api/build_features.h"
#include "csgmesh/csgmesh.h"

const char *csgm_build_features(void)
{
    return CSG_BUILD_FEATURES;
}
