/* SPDX-License-Identifier: MIT
 * The ten integrals over what a closed mesh bounds, by the divergence theorem.
 */
#ifndef CSG_MEASURE_MESH_INTEGRALS_H
#define CSG_MEASURE_MESH_INTEGRALS_H

#include "base/geometry.h"
#include "measure/integrals.h"

/* Around `center`, which is in the mesh's own coordinates, those of its positions. Exact but for
 * rounding, which is in the bounds. Indices are in range. */
void csg_mesh_integrals(const csgm_mesh_view *mesh, csg_box box, csg_vec3 center,
                        double low[CSG_INTEGRALS], double high[CSG_INTEGRALS]);

#endif
