/* SPDX-License-Identifier: MIT
 * Bounds, cells and lattice; see input.h.
 */
#include "mesh/pipeline/input.h"

#include <math.h>

#include "base/mesh_codes.h"

static csgm_status choose_bounds(csg_mesh_input *in)
{
    csg_diag_sink *diags = &in->context->diags;
    in->bounds = in->options->bounds;
    if (!csg_box_is_empty(in->bounds)) {
        if (csg_box_is_finite(in->bounds))
            return CSGM_OK;
        csg_diag_plain(diags, CSG_DIAG_BAD_BOUNDS, NULL, NULL, "the bounds must be finite numbers");
        return CSGM_ERR_ARGUMENT;
    }
    in->bounds = in->field->bounds;
    if (csg_box_is_empty(in->bounds) || csg_box_is_finite(in->bounds))
        return CSGM_OK;
    csg_diag_plain(diags, CSG_DIAG_UNBOUNDED, NULL,
                   "give --bounds X0,Y0,Z0,X1,Y1,Z1, or intersect the solid with a cube",
                   "the solid reaches to infinity, so there is no box to mesh");
    return CSGM_ERR_SCENE;
}

static csgm_status check_cells(csg_mesh_input *in)
{
    double size = in->options->cell_size; /* 0: as the resolution says */
    if (size >= 0 && isfinite(size))
        return CSGM_OK;
    csg_diag_plain(&in->context->diags, CSG_DIAG_BAD_BOUNDS, NULL, NULL,
                   "the cell size must be a positive number");
    return CSGM_ERR_ARGUMENT;
}

static csgm_status make_lattice(csg_mesh_input *in)
{
    const csgm_mesh_options *options = in->options;
    uint32_t cells = options->resolution ? options->resolution : CSG_MESH_DEFAULT_CELLS;
    if (csg_lattice_make(in->bounds, in->field->center, options->cell_size, cells, &in->lattice))
        return CSGM_OK;
    csg_vec3 size = csg_box_size(in->bounds);
    if (!(size.x > 0 || size.y > 0 || size.z > 0)) {
        csg_diag_plain(&in->context->diags, CSG_DIAG_BAD_BOUNDS, NULL, "give a cell size with -s",
                       "the bounds are a single point, which sets no resolution");
        return CSGM_ERR_ARGUMENT;
    }
    csg_diag_plain(&in->context->diags, CSG_DIAG_TOO_FINE, NULL, "lower -r, or raise -s",
                   "the lattice over %g x %g x %g would have more than %d cells along a side",
                   size.x, size.y, size.z, CSG_LATTICE_MOST_CELLS);
    return CSGM_ERR_LIMIT;
}

/* A solid that reaches out of the bounds is cut there: met with a box, so that it is capped. */
static csgm_status clip(csg_mesh_input *in)
{
    if (csg_box_contains_box(in->bounds, in->field->bounds))
        return CSGM_OK;
    csgm_status status = csg_field_clip(in->context, in->field, in->bounds, &in->clipped);
    if (status == CSGM_OK)
        in->field = in->clipped;
    return status;
}

csgm_status csg_mesh_input_complete(csg_mesh_input *in)
{
    csgm_status status = choose_bounds(in);
    if (status != CSGM_OK || csg_box_is_empty(in->bounds))
        return status;
    status = check_cells(in);
    if (status == CSGM_OK)
        status = clip(in);
    if (status == CSGM_OK)
        status = make_lattice(in);
    return status;
}

void csg_mesh_input_release(csg_mesh_input *in)
{
    csg_field_destroy(in->clipped);
    in->clipped = NULL;
}

/* Far from the scene's origin floats are coarse: there the mesh keeps its own. Up to 64 times the
 * size, an ulp is below 1e-5 of it. */
csg_vec3 csg_mesh_origin(csg_vec3 center, csg_box bounds)
{
    enum { FAR = 64 };
    return csg_vec3_norm(center) > FAR * csg_box_longest_side(bounds) ? center
                                                                      : csg_vec3_make(0, 0, 0);
}

/* ---- the whole build ---------------------------------------------------------------------------
 */

void csg_mesh_input_watch(const csg_mesh_input *in, double started_s, csg_mesh_watch *watch)
{
    const csg_mesh_share *share = in->share;
    csg_mesh_watch_begin(watch, in->context, &in->options->monitor,
                         share ? share->started_s : started_s);
    watch->is_part = share != NULL;
    if (share) {
        watch->part_before = share->before;
        watch->part_amount = share->amount;
    }
}

void csg_mesh_warn_of_result(const csg_mesh_input *in, const csg_mesh_fineness *fineness,
                             bool is_empty, bool is_cut)
{
    csg_diag_sink *diags = &in->context->diags;
    const csg_mesh_share *share = in->share;
    if (share && share->is_operand)
        return;
    if (is_empty && share)
        csg_diag_plain(diags, CSG_DIAG_NO_SURFACE, NULL, fineness->hints[1],
                       share->name ? "no surface of the part \"%.60s\" was found"
                                   : "no surface was found of what is in no part%s",
                       share->name ? share->name : "");
    else if (is_empty && (in->clipped || !csg_box_is_empty(in->field->bounds)))
        csg_diag_plain(diags, CSG_DIAG_NO_SURFACE, NULL, fineness->hints[0],
                       "no surface was found with %s of %g", fineness->of, fineness->size);
    else if (!is_empty && in->clipped && is_cut)
        csg_diag_plain(diags, CSG_DIAG_CUT_BY_BOUNDS, NULL, NULL,
                       "the solid reaches out of the bounds: it is cut and capped there");
}
