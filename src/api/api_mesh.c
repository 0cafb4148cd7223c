/* SPDX-License-Identifier: MIT
 * Meshes of the public interface: a field in, an indexed triangle mesh out, and its inspection.
 */
#include "api/options.h"
#include "api/view.h"

#include <math.h>
#include <string.h>

#include "base/mesh_codes.h"
#include "base/ranks.h"
#include "mesh/cluster.h"
#include "mesh/inspect.h"
#include "mesh/mesh.h"
#include "mesh/pipeline/adaptive.h"
#include "mesh/pipeline/parts.h"
#include "mesh/view.h"

csgm_mesh_options csgm_mesh_options_default(void)
{
    return (csgm_mesh_options){.struct_size = sizeof(csgm_mesh_options),
                               .bounds = csg_box_empty(),
                               .normals = CSGM_NORMALS_VERTEX,
                               .features = CSGM_FEATURES_SHARP,
                               .colors = true,
                               .prune = true};
}

csgm_mesh_stats csgm_mesh_stats_default(void)
{
    return (csgm_mesh_stats){.struct_size = sizeof(csgm_mesh_stats)};
}

double csgm_quality_tolerance(csgm_quality quality, csgm_box bounds)
{
    return quality <= CSGM_QUALITY_FINE ? csg_mesh_quality_tolerance(quality, bounds) : 0;
}

/* At most one goal of thinning out. */
bool csg_mesh_options_adopt(csgm_mesh_options *own, const csgm_mesh_options *given)
{
    if (!csg_options_adopt(own, sizeof *own, given))
        return false;
    int goals = (own->tolerance > 0) + (own->simplify_error > 0) + (own->simplify_share > 0);
    return goals <= 1;
}

csgm_status csgm_mesh_build(csgm_context *context, const csgm_field *field,
                            const csgm_mesh_options *options, csgm_mesh **out,
                            csgm_mesh_stats *stats)
{
    csgm_mesh_options own = csgm_mesh_options_default();
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !field || !csg_mesh_options_adopt(&own, options) ||
        !csg_struct_is_known(stats, sizeof *stats))
        return CSGM_ERR_ARGUMENT;
    csgm_mesh_stats made = csgm_mesh_stats_default();
    csg_ranks_begin_mesh(context);
    csgm_status status = csg_mesh_build(context, field, &own, out, &made);
    csg_struct_deliver(stats, &made);
    return status;
}

void csgm_mesh_destroy(csgm_mesh *mesh)
{
    csg_mesh_destroy(mesh);
}

csgm_mesh_view csgm_mesh_get_view(const csgm_mesh *mesh)
{
    return csg_mesh_view(mesh);
}

csgm_status csgm_mesh_inspect(csgm_context *context, const csgm_mesh_view *mesh,
                              csgm_mesh_check *out)
{
    if (!context || !out || !csg_view_is_sound(mesh))
        return CSGM_ERR_ARGUMENT;
    return csg_mesh_inspect(context, mesh, 0, out);
}

csgm_status csgm_mesh_cluster(csgm_context *context, const csgm_mesh_view *mesh, csgm_box frame,
                              uint64_t most_triangles, uint32_t *cluster_of,
                              uint32_t *cluster_count, double *cell_size)
{
    if (!context || !csg_view_is_sound(mesh) || (mesh->vertex_count && !cluster_of) ||
        !cluster_count || !cell_size || !csg_view_is_in_range(mesh))
        return CSGM_ERR_ARGUMENT;
    return csg_mesh_cluster(context, mesh, frame, most_triangles, cluster_of, cluster_count,
                            cell_size);
}
