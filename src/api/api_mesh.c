/* SPDX-License-Identifier: MIT
 * Meshes of the public interface: a field in, an indexed triangle mesh out, and its inspection.
 */
#include "api/view.h"
#include "mesh/build.h"
#include "mesh/inspect.h"
#include "mesh/mesh.h"
#include "scene/reference.h"

csgm_mesh_options csgm_mesh_options_default(void)
{
    return (csgm_mesh_options){.struct_size = sizeof(csgm_mesh_options),
                               .bounds = csg_box_empty(),
                               .resolution = 128,
                               .normals = true,
                               .colors = true,
                               .prune = true};
}

csgm_status csgm_mesh_build(csgm_context *context, const csgm_field *field,
                            const csgm_mesh_options *options, csgm_mesh **out,
                            csgm_mesh_stats *stats)
{
    csgm_mesh_options defaults = csgm_mesh_options_default();
    if (!options)
        options = &defaults;
    if (!out)
        return CSGM_ERR_ARGUMENT;
    *out = NULL;
    if (!context || !field || options->struct_size != sizeof *options)
        return CSGM_ERR_ARGUMENT;
    csgm_mesh_stats ignored;
    return csg_mesh_build(context, field, options, out, stats ? stats : &ignored);
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
    return csg_mesh_inspect(context, mesh, out);
}

double csgm_mesh_max_abs_field(const csgm_scene *scene, const csgm_mesh_view *mesh)
{
    double largest = 0;
    csgm_status status = CSGM_OK;
    for (uint64_t i = 0; i < mesh->vertex_count; i++) {
        const float *p = mesh->positions + 3 * i;
        csgm_vec3 at = csg_vec3_add(mesh->origin, csg_vec3_make(p[0], p[1], p[2]));
        double value = fabs(csg_reference_eval(scene, at, &status).value);
        if (status != CSGM_OK || isnan(value))
            return NAN;
        largest = value > largest ? value : largest;
    }
    return largest;
}
