/* SPDX-License-Identifier: MIT
 * Principal moments and axes of inertia, from its components between bounds.
 */
#ifndef CSG_MEASURE_PRINCIPAL_H
#define CSG_MEASURE_PRINCIPAL_H

#include "csgmesh/csgmesh.h"

/* Fills moments, axes and axis_within from inertia. Whatever symmetric matrix lies in these bounds,
 * its eigenvalues lie in those of the moments, and its eigenvectors about as far from the axes as
 * it is said. */
void csg_measure_principal(csgm_measures *measures);

#endif
