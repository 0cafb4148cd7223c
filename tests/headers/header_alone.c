/* SPDX-License-Identifier: MIT
 * The public headers, alone and first: compiled as C99, C17 and C++17 with warnings as errors.
 */
#include <csgmesh/clearance.h>
#include <csgmesh/csgmesh.h>
#include <csgmesh/editing.h>
#include <csgmesh/fabrication.h>
#include <csgmesh/figures.h>
#include <csgmesh/ranks.h>
#include <csgmesh/reshaping.h>
#include <csgmesh/slicing.h>

int header_alone(void);

int header_alone(void)
{
    csgm_mesh_options options = csgm_mesh_options_default();
    csgm_diag_fn *on_diag = 0;
    return options.resolution == 0 && options.prune && !on_diag && CSGM_OK == 0 ? CSGM_VERSION_MAJOR
                                                                                : 1;
}
