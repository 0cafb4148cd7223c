/* SPDX-License-Identifier: MIT
 * Tetrahedra between the triangles and one point; see mesh_integrals.h.
 */
#include "measure/mesh_integrals.h"

#include <math.h>
#include <string.h>

#include "measure/cut.h"

enum { RUN = 1024 /* triangles that are summed by themselves, so that rounding stays small */ };

void csg_mesh_integrals(const csgm_mesh_view *mesh, csg_box box, csg_vec3 center,
                        double low[CSG_INTEGRALS], double high[CSG_INTEGRALS])
{
    static const double TERMS = RUN + 64;
    static const double ORIGIN[3] = {0, 0, 0};
    const double at[3] = {center.x, center.y, center.z};
    double sum[CSG_INTEGRALS] = {0}, sizes = 0, reach = 0.51 * csg_vec3_norm(csg_box_size(box));
    for (uint64_t first = 0; first < mesh->triangle_count; first += RUN) {
        double run[CSG_INTEGRALS] = {0};
        for (uint64_t t = first; t < mesh->triangle_count && t < first + RUN; t++) {
            double corner[3][3], before = run[0];
            for (int i = 0; i < 3; i++)
                for (int k = 0; k < 3; k++)
                    corner[i][k] =
                        (double)mesh
                            ->positions[3 * (size_t)mesh->indices[3 * t + (size_t)i] + (size_t)k] -
                        at[k];
            csg_integrals_add_tetrahedron(run, ORIGIN, corner[0], corner[1], corner[2]);
            sizes += fabs(run[0] - before) + 0x1p-50 * reach * reach * reach;
        }
        for (int n = 0; n < CSG_INTEGRALS; n++)
            sum[n] += run[n];
    }
    double runs = (double)(mesh->triangle_count / RUN + 1);
    double slack = (TERMS + runs) * 0x1p-52 * sizes;
    slack += (double)mesh->triangle_count * 0x1p-50 * reach * reach * reach;
    for (int n = 0; n < CSG_INTEGRALS; n++) {
        double size = n == 0 ? 1 : n < CSG_INTEGRAL_XX ? reach : reach * reach;
        low[n] = sum[n] - slack * size;
        high[n] = sum[n] + slack * size;
    }
}
