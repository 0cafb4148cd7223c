/* SPDX-License-Identifier: MIT
 * Measures; see measure.h.
 */
#include "measure/measure.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "base/mesh_codes.h"
#include "base/trace.h"
#include "measure/area.h"
#include "measure/extent.h"
#include "measure/integrate.h"
#include "measure/mesh_integrals.h"
#include "measure/profile.h"
#include "measure/properties.h"
#include "mesh/inspect.h"

/* A share of all cubes is for the bounds, which take few where they can be found at all. */
enum { SHARE_FOR_EXTENTS = 8 };

csgm_status csg_measure_refuse_empty(csgm_context *context)
{
    csg_diag_plain(&context->diags, CSG_DIAG_NOTHING_TO_MEASURE, NULL, NULL,
                   "the solid is empty: there is nothing to measure");
    return CSGM_ERR_SCENE;
}

csgm_status csg_measure_check_bounds(csgm_context *context, csg_box bounds)
{
    if (csg_box_is_empty(bounds))
        return csg_measure_refuse_empty(context);
    if (csg_box_is_finite(bounds))
        return CSGM_OK;
    csg_diag_plain(&context->diags, CSG_DIAG_UNBOUNDED, NULL, "intersect the solid with a cube",
                   "the solid reaches to infinity, so it has no measures");
    return CSGM_ERR_SCENE;
}

/* What the bounds alone say. */
static void begin_with_bounds(const csgm_field *field, double density, csgm_measures *out)
{
    const csg_box b = field->bounds;
    const double low[3] = {b.min.x, b.min.y, b.min.z}, high[3] = {b.max.x, b.max.y, b.max.z};
    csg_vec3 size = csg_box_size(b);
    double none[CSG_INTEGRALS] = {0}, all[CSG_INTEGRALS] = {size.x * size.y * size.z};
    for (int k = 0; k < 3; k++)
        out->bounds[k] = out->bounds[3 + k] = (csgm_interval){low[k], high[k]};
    out->area = (csgm_interval){0, INFINITY};
    csg_measure_derive(none, all, field->center, density, out);
}

static void take_extents(const csg_extents *extents, csg_vec3 center, csgm_measures *out)
{
    const double at[3] = {center.x, center.y, center.z};
    for (int i = 0; i < CSG_EXTENTS; i++)
        out->bounds[i] =
            csg_interval_grown(extents->low[i] + at[i % 3], extents->high[i] + at[i % 3], 0x1p-50);
}

static csgm_status take_area(csg_measure_walk *walk, const csgm_measure_options *options,
                             csgm_measures *out)
{
    csg_area_bounds area;
    csgm_status status = csg_measure_area(walk, NULL, CSG_AREA_WIDER * options->tolerance, 0,
                                          options->most_cubes / CSG_AREA_SHARE, &area);
    if (area.is_proven)
        out->area = (csgm_interval){area.low, area.high};
    out->cubes += area.cubes;
    return status;
}

static csgm_status measure(csg_measure_walk *walk, const csgm_measure_options *options,
                           csgm_measures *out)
{
    csg_extents extents;
    csg_integral_bounds integrals;
    const csgm_field *field = walk->field;
    double longest = csg_box_longest_side(field->bounds);
    csgm_status status = csg_measure_extents(walk, options->tolerance * longest,
                                             options->most_cubes / SHARE_FOR_EXTENTS, &extents);
    take_extents(&extents, field->center, out);
    out->cubes = extents.cubes;
    if (status != CSGM_OK)
        return status;
    csg_profile_measures profile = {.tolerance = options->tolerance,
                                    .area_tolerance = CSG_AREA_WIDER * options->tolerance};
    if (walk->axis != CSG_AXIS_NONE)
        status = csg_measure_profile(walk, &profile);
    out->cubes += profile.integrals.cubes;
    integrals = profile.integrals;
    if (status == CSGM_OK && !profile.is_close) {
        status = csg_measure_integrate(walk, options->tolerance, options->most_cubes, &integrals);
        out->cubes += integrals.cubes;
    }
    if (!integrals.is_proven)
        return status;
    csg_measure_derive(integrals.low, integrals.high, field->center, options->density, out);
    if (profile.is_area_close)
        out->area = profile.area;
    else if (status == CSGM_OK)
        status = take_area(walk, options, out);
    bool is_close = integrals.high[0] - integrals.low[0] <= options->tolerance * integrals.high[0];
    out->is_reached = status == CSGM_OK && extents.is_close && is_close;
    return status == CSGM_OK && !(integrals.high[0] > 0) ? csg_measure_refuse_empty(walk->context)
                                                         : status;
}

csgm_status csg_measure_field(csgm_context *context, const csgm_field *field,
                              const csgm_measure_options *options, csgm_measures *out)
{
    CSG_ZONE(context, "measure");
    csg_mesh_watch watch = {0};
    csg_measure_walk walk;
    csgm_status status = csg_measure_check_bounds(context, field->bounds);
    if (status != CSGM_OK)
        return status;
    csg_mesh_watch_begin(&watch, context, &options->monitor, 0);
    begin_with_bounds(field, options->density, out);
    status = csg_measure_walk_begin(&walk, context, field, &watch);
    if (status == CSGM_OK)
        status = measure(&walk, options, out);
    csg_measure_walk_release(&walk);
    return status;
}

/* ---- meshes ------------------------------------------------------------------------------------
 */

csgm_status csg_measure_refuse_broken(csgm_context *context)
{
    csg_diag_plain(&context->diags, CSG_DIAG_BAD_MESH, NULL, NULL,
                   "the mesh has a coordinate that is not finite or an index out of range");
    return CSGM_ERR_FORMAT;
}

static csgm_status check_closed(csgm_context *context, const csgm_mesh_check *check)
{
    uint64_t open = check->boundary_edges, turned = check->misoriented_edges,
             shared = check->nonmanifold_edges;
    if (check->index_out_of_range || !isfinite(check->volume))
        return csg_measure_refuse_broken(context);
    if (!open && !turned && !shared)
        return CSGM_OK;
    csg_diag_plain(&context->diags, CSG_DIAG_NOT_CLOSED, NULL,
                   "import() in a scene repairs a mesh: csgmesh measure a scene that imports it",
                   "the mesh is not closed and has no volume: %" PRIu64 " edges of one triangle, "
                   "%" PRIu64 " of two that are turned against each other, %" PRIu64
                   " of more than two",
                   open, turned, shared);
    return CSGM_ERR_FORMAT;
}

/* Of a plain sum of so many areas, whose corners were rounded where they were moved to the middle
 * of the box: a triangle's errs by 13 * 2^-53 of the square of half the diagonal at most, and by a
 * few units in its last place. */
static csgm_interval area_of(const csgm_mesh_check *check, csg_box box, uint64_t triangles)
{
    double reach = 0.51 * csg_vec3_norm(csg_box_size(box));
    double slack = (double)triangles * (0x1p-48 * reach * reach + 0x1p-52 * check->area);
    return (csgm_interval){fmax(check->area - slack, 0), check->area + slack};
}

csgm_status csg_measure_mesh(csgm_context *context, const csgm_mesh_view *mesh,
                             const csgm_measure_options *options, csgm_measures *out)
{
    csgm_mesh_check check;
    double low[CSG_INTEGRALS], high[CSG_INTEGRALS];
    csgm_status status = csg_mesh_inspect(context, mesh, 0, &check);
    if (status == CSGM_OK && !mesh->triangle_count)
        return csg_measure_refuse_empty(context);
    if (status == CSGM_OK)
        status = check_closed(context, &check);
    if (status != CSGM_OK)
        return status;
    csg_box box = {csg_vec3_sub(check.bounds.min, mesh->origin),
                   csg_vec3_sub(check.bounds.max, mesh->origin)};
    csg_vec3 center = csg_box_center(box);
    csg_mesh_integrals(mesh, box, center, low, high);
    out->area = area_of(&check, box, mesh->triangle_count);
    if (high[0] < 0) {
        csg_diag_plain(&context->diags, CSG_DIAG_NOT_CLOSED, NULL, NULL,
                       "the mesh is inside out: its volume is %g", check.volume);
        return CSGM_ERR_FORMAT;
    }
    csg_measure_derive(low, high, csg_vec3_add(center, mesh->origin), options->density, out);
    const double from[3] = {check.bounds.min.x, check.bounds.min.y, check.bounds.min.z};
    const double to[3] = {check.bounds.max.x, check.bounds.max.y, check.bounds.max.z};
    for (int k = 0; k < 3; k++) {
        out->bounds[k] = (csgm_interval){from[k], from[k]};
        out->bounds[3 + k] = (csgm_interval){to[k], to[k]};
    }
    out->is_reached = out->volume.high - out->volume.low <= options->tolerance * out->volume.high;
    return CSGM_OK;
}
