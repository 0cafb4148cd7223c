/* SPDX-License-Identifier: MIT
 * Heights of layers; see heights.h.
 */
#include "slice/heights.h"

#include <math.h>

#include "base/mesh_codes.h"
#include "field/field.h"
#include "slice/profile.h"

enum { MOST_LAYERS = 10000000 };

/* What is this much of a layer above the rest is rounding. */
static const double ROUNDING = 1e-6;

static csgm_status report_many(csgm_context *context, double height)
{
    csg_diag_plain(&context->diags, CSG_DIAG_TOO_FINE, NULL, NULL,
                   "more layers than %d of %g: that is the most", MOST_LAYERS, height);
    return CSGM_ERR_LIMIT;
}

static bool add_end(csg_slice_heights *h, csg_memory *memory, double z)
{
    if (!csg_memory_reserve(memory, (void **)&h->ends, &h->capacity, h->count + 2, sizeof *h->ends))
        return false;
    h->ends[++h->count] = z;
    return true;
}

/* Where a layer from z on may end: in the first stretch that it is too high for, or below it. */
static double end_of_layer(const csg_slice_profile *p, double z, const csgm_slice_options *o)
{
    double end = z + o->most_height;
    size_t i = (size_t)fmax(floor((z - p->bottom) / p->step), 0);
    for (; i < p->count && p->bottom + (double)i * p->step < end; i++) {
        double level = csg_slice_profile_at(p, i), from = p->bottom + (double)i * p->step;
        if (level > 0)
            end = fmin(end, fmax(from, z + o->cusp / level));
    }
    return fmax(end, z + o->height);
}

/* The last layer ends at the top, unless it were too low then. */
static csgm_status stack_layers(csg_slice_heights *h, csgm_context *context,
                                const csg_slice_profile *p, double top, const csgm_slice_options *o)
{
    double z = h->ends[0];
    while (z < top - ROUNDING * o->height) {
        double end = fmin(end_of_layer(p, z, o), fmax(top, z + o->height));
        if (h->count >= MOST_LAYERS)
            return report_many(context, o->height);
        if (!add_end(h, &context->memory, end))
            return csg_context_no_memory(context);
        z = end;
    }
    return CSGM_OK;
}

static csgm_status follow_surface(csg_slice_heights *h, csgm_context *context,
                                  const csgm_field *field, csg_mesh_watch *watch,
                                  const csgm_slice_options *o)
{
    static const double SHARE = 0.25; /* of the work */
    csg_slice_profile profile;
    csg_mesh_take(watch, CSGM_STAGE_WRITE, SHARE);
    csgm_status status = csg_slice_profile_find(&profile, context, field, watch, o->height,
                                                o->cusp / o->most_height, o->cusp / o->height);
    if (status == CSGM_OK)
        status = stack_layers(h, context, &profile, field->bounds.max.z, o);
    h->sampled = profile.sampled;
    h->edge = profile.edge;
    csg_slice_profile_release(&profile, &context->memory);
    return status;
}

static csgm_status repeat(csg_slice_heights *h, csgm_context *context, csg_box bounds,
                          double height)
{
    double count = ceil((bounds.max.z - bounds.min.z) / height - ROUNDING);
    if (count > MOST_LAYERS)
        return report_many(context, height);
    for (size_t i = 1; (double)i <= count; i++)
        if (!add_end(h, &context->memory, bounds.min.z + (double)i * height))
            return csg_context_no_memory(context);
    return CSGM_OK;
}

csgm_status csg_slice_heights_find(csg_slice_heights *h, csgm_context *context,
                                   const csgm_field *field, csg_mesh_watch *watch,
                                   const csgm_slice_options *o)
{
    *h = (csg_slice_heights){.lowest = INFINITY};
    if (!csg_memory_reserve(&context->memory, (void **)&h->ends, &h->capacity, 2, sizeof *h->ends))
        return csg_context_no_memory(context);
    h->ends[0] = field->bounds.min.z;
    csgm_status status = o->most_height > o->height ? follow_surface(h, context, field, watch, o)
                                                    : repeat(h, context, field->bounds, o->height);
    if (status == CSGM_OK && !h->count && !add_end(h, &context->memory, h->ends[0] + o->height))
        status = csg_context_no_memory(context);
    for (size_t i = 0; i < h->count; i++) {
        h->lowest = fmin(h->lowest, h->ends[i + 1] - h->ends[i]);
        h->highest = fmax(h->highest, h->ends[i + 1] - h->ends[i]);
    }
    return status;
}

void csg_slice_heights_release(csg_slice_heights *h, csg_memory *memory)
{
    csg_memory_release(memory, h->ends, h->capacity * sizeof *h->ends);
}
