/* SPDX-License-Identifier: MIT
 * Meshes of the public interface: a field in, an indexed triangle mesh out, and its inspection.
 */
#include "api/options.h"
#include "api/view.h"

#include <math.h>
#include <string.h>

#include "base/mesh_codes.h"
#include "base/pool.h"
#include "base/ranks.h"
#include "io/formats.h"
#include "io/parts.h"
#include "io/stream.h"
#include "mesh/cluster.h"
#include "mesh/inspect.h"
#include "mesh/mesh.h"
#include "mesh/pipeline/adaptive.h"
#include "mesh/pipeline/parts.h"
#include "mesh/view.h"
#include "scene/reference.h"
#include "scene/tree/parts.h"

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
static bool adopt_options(csgm_mesh_options *own, const csgm_mesh_options *given)
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
    if (!context || !field || !adopt_options(&own, options) ||
        !csg_struct_is_known(stats, sizeof *stats))
        return CSGM_ERR_ARGUMENT;
    csgm_mesh_stats made = csgm_mesh_stats_default();
    csg_ranks_begin_mesh(context);
    csgm_status status = csg_mesh_build(context, field, &own, out, &made);
    csg_struct_deliver(stats, &made);
    return status;
}

/* Into a file that is filled from all sides. */
static csgm_status stream_file(csgm_context *context, const csgm_field *field,
                               const csgm_mesh_options *options, const char *path,
                               csgm_format format, const csgm_write_options *write_options,
                               csg_mesh_counts *counts, csgm_mesh_stats *stats)
{
    csg_stream *stream;
    csgm_status status = csg_stream_create(context, path, format, write_options,
                                           csg_pool_threads(context->pool), &stream);
    if (status != CSGM_OK)
        return status;
    csg_mesh_receiver receiver = csg_stream_receiver(stream);
    status = csg_mesh_stream(context, field, options, &receiver, counts, stats);
    if (status == CSGM_OK && counts->triangle_count)
        return csg_stream_commit(stream);
    csgm_status of_stream = csg_stream_abandon(stream);
    return of_stream != CSGM_OK ? of_stream : status == CSGM_OK ? CSGM_ERR_SCENE : status;
}

/* A mesh that is gathered is made by one rank in the end: there is nothing to go on with. */
static csgm_status refuse_to_keep(csgm_context *context)
{
    if (!context->ranks || !context->ranks->folder)
        return CSGM_OK;
    if (csg_ranks_is_first(context))
        csg_diag_plain(
            &context->diags, CSG_DIAG_RANKS_FAILED, NULL,
            "binary PLY, STL or GLB of equal cells, of a scene without parts and materials, can "
            "be kept",
            "what is finished cannot be kept: the first rank writes this mesh alone");
    return CSGM_ERR_UNSUPPORTED;
}

/* Through a mesh in memory. */
static csgm_status build_and_write(csgm_context *context, const csgm_field *field,
                                   const csgm_mesh_options *options, const char *path,
                                   csgm_format format, const csgm_write_options *write_options,
                                   csg_mesh_counts *counts, csgm_mesh_stats *stats)
{
    csgm_mesh *mesh;
    csgm_status status = csg_mesh_build(context, field, options, &mesh, stats);
    if (status != CSGM_OK)
        return status;
    csgm_mesh_view view = csg_mesh_view(mesh);
    counts->vertex_count = view.vertex_count;
    counts->triangle_count = view.triangle_count;
    if (csg_ranks_is_first(context)) /* the others have none of it */
        status = view.triangle_count ? csg_io_write(context, &view, path, format, write_options)
                                     : CSGM_ERR_SCENE;
    csg_mesh_destroy(mesh);
    return csg_ranks_agree(context, status);
}

csgm_status csgm_mesh_build_file(csgm_context *context, const csgm_field *field,
                                 const csgm_mesh_options *options, const char *path,
                                 csgm_format format, const csgm_write_options *write_options,
                                 uint64_t counts[2], csgm_mesh_stats *stats)
{
    csgm_mesh_options joined = csgm_mesh_options_default();
    csgm_write_options own = csgm_write_options_default();
    if (!context || !field || !path || format >= CSGM_FORMAT_COUNT ||
        !adopt_options(&joined, options) || !csg_options_adopt(&own, sizeof own, write_options) ||
        !csg_struct_is_known(stats, sizeof *stats))
        return CSGM_ERR_ARGUMENT;
    csgm_mesh_stats found = csgm_mesh_stats_default();
    csg_mesh_counts made = {0};
    uint32_t traits =
        csg_format_traits(format == CSGM_FORMAT_AUTO ? csg_format_from_path(path) : format);
    if (joined.normals == CSGM_NORMALS_CREASE && !(traits & CSGM_KEEPS_CREASES))
        joined.normals = CSGM_NORMALS_VERTEX;
    joined.colors = joined.colors && (traits & (CSGM_KEEPS_COLORS | CSGM_KEEPS_MATERIALS)) != 0;
    options = &joined;
    write_options = &own;
    bool streams =
        csg_mesh_can_stream(field, options) &&
        csg_stream_is_possible(path, format, csg_mesh_distance(field, options), write_options);
    csg_ranks_begin_mesh(context);
    csgm_status status = csg_ranks_follow(context, CSGM_OK, &streams);
    if (status == CSGM_OK && !streams)
        status = refuse_to_keep(context);
    if (status != CSGM_OK)
        return status;
    status = (streams ? stream_file : build_and_write)(context, field, options, path, format,
                                                       write_options, &made, &found);
    csg_struct_deliver(stats, &found);
    if (counts) {
        counts[0] = made.vertex_count;
        counts[1] = made.triangle_count;
    }
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

/* Vertices of [first, end), every step-th. */
static double max_abs_field(const csgm_scene *scene, const csgm_mesh_view *mesh, uint64_t first,
                            uint64_t end, uint64_t step, uint64_t *count)
{
    double largest = 0;
    csgm_status status = CSGM_OK;
    for (uint64_t i = first; i < end; i += step, ++*count) {
        const float *p = mesh->positions + 3 * i;
        csgm_vec3 at = csg_vec3_add(mesh->origin, csg_vec3_from_floats(p));
        double value = fabs(csg_reference_eval(scene, at, &status).value);
        if (status != CSGM_OK || isnan(value))
            return NAN;
        largest = value > largest ? value : largest;
    }
    return largest;
}

/* Each part of the mesh against the part of the scene with its name: where parts touch, the scene's
 * own field knows no surface. NaN when there is none of that name or memory runs out. */
static double max_abs_of_part(const csg_parts *parts, const csgm_mesh_view *mesh, uint64_t index,
                              uint64_t step, uint64_t *count)
{
    csg_part_stretch part = csg_part_get(mesh, index);
    size_t i;
    csgm_scene *scene;
    if (!csg_parts_index(parts, part.name, &i) || csg_parts_scene(parts, i, &scene) != CSGM_OK)
        return NAN;
    double value = max_abs_field(scene, mesh, part.first_vertex,
                                 part.first_vertex + part.vertex_count, step, count);
    csg_scene_destroy(scene);
    return value;
}

double csgm_mesh_max_abs_field(const csgm_scene *scene, const csgm_mesh_view *mesh,
                               uint64_t *measured)
{
    static const uint64_t MOST_NODES = 50000000; /* evaluated in all: some seconds */
    uint64_t affordable = MOST_NODES / (scene->node_count + 1) + 1;
    uint64_t step = mesh->vertex_count / affordable + 1, count = 0;
    csg_parts parts = {.scene = scene};
    double largest = csg_parts_find(&parts, scene) == CSGM_OK ? 0 : NAN;
    if (!parts.count || !mesh->part_count)
        largest += max_abs_field(scene, mesh, 0, mesh->vertex_count, step, &count);
    for (uint64_t i = 0; parts.count && i < mesh->part_count; i++) {
        double value = max_abs_of_part(&parts, mesh, i, step, &count);
        largest = isnan(value) || value > largest ? value : largest;
    }
    csg_parts_reset(&parts);
    if (measured)
        *measured = count;
    return largest;
}
