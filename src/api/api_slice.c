/* SPDX-License-Identifier: MIT
 * Layers of the public interface.
 */
#include <math.h>

#include "api/options.h"
#include "csgmesh/slicing.h"
#include "slice/slice.h"

csgm_layers_format csgm_layers_format_from_path(const char *path)
{
    return csg_layers_format_from_path(path);
}

csgm_layers_format csgm_layers_format_from_name(const char *name)
{
    return csg_layers_format_from_name(name);
}

const char *csgm_layers_format_name(csgm_layers_format format)
{
    return csg_layers_format_name(format);
}

bool csgm_layers_format_available(csgm_layers_format format)
{
    return csg_layers_format_available(format);
}

csgm_slice_options csgm_slice_options_default(void)
{
    return (csgm_slice_options){.struct_size = sizeof(csgm_slice_options),
                                .unit = CSGM_UNIT_MM,
                                .pixel = 0.05,
                                .sync = true};
}

csgm_slice_stats csgm_slice_stats_default(void)
{
    return (csgm_slice_stats){.struct_size = sizeof(csgm_slice_stats)};
}

/* The same height for all layers, or a larger one and a cusp. */
static bool is_range(const csgm_slice_options *o)
{
    bool is_one = !(o->most_height < 0 || o->most_height > 0) && !(o->cusp < 0 || o->cusp > 0);
    return isfinite(o->most_height) && isfinite(o->cusp) &&
           (is_one || (o->most_height > o->height && o->cusp > 0));
}

static bool adopt(csgm_slice_options *own, const csgm_slice_options *given,
                  csgm_layers_format format, const csgm_slice_stats *stats)
{
    *own = csgm_slice_options_default();
    return csg_options_adopt(own, sizeof *own, given) && own->height > 0 && isfinite(own->height) &&
           is_range(own) && own->tolerance >= 0 && isfinite(own->tolerance) &&
           (int)own->unit >= 0 && own->unit <= CSGM_UNIT_IN && own->pixel > 0 &&
           isfinite(own->pixel) && (int)format > CSGM_LAYERS_NONE && format < CSGM_LAYERS_COUNT &&
           csg_struct_is_known(stats, sizeof *stats);
}

csgm_status csgm_slice_field(csgm_context *context, const csgm_field *field, const char *path,
                             csgm_layers_format format, const csgm_slice_options *options,
                             csgm_slice_stats *stats)
{
    csgm_slice_options own;
    csgm_slice_stats made = csgm_slice_stats_default();
    if (!context || !field || !path || !adopt(&own, options, format, stats))
        return CSGM_ERR_ARGUMENT;
    const csgm_field *of = csg_option_part(field, own.part);
    if (!of)
        return CSGM_ERR_ARGUMENT;
    if (!csg_layers_format_available(format))
        return CSGM_ERR_UNSUPPORTED;
    csgm_status status = csg_slice_file(context, of, path, format, &own, &made);
    if (status == CSGM_OK)
        csg_struct_deliver(stats, &made);
    return status;
}

csgm_status csgm_slice_field_fd(csgm_context *context, const csgm_field *field, int fd,
                                const char *name, csgm_layers_format format,
                                const csgm_slice_options *options, csgm_slice_stats *stats)
{
    csgm_slice_options own;
    csgm_slice_stats made = csgm_slice_stats_default();
    if (!context || !field || fd < 0 || !adopt(&own, options, format, stats))
        return CSGM_ERR_ARGUMENT;
    const csgm_field *of = csg_option_part(field, own.part);
    if (!of)
        return CSGM_ERR_ARGUMENT;
    if (!csg_layers_format_available(format))
        return CSGM_ERR_UNSUPPORTED;
    csgm_status status = csg_slice_fd(context, of, fd, name, format, &own, &made);
    if (status == CSGM_OK)
        csg_struct_deliver(stats, &made);
    return status;
}
