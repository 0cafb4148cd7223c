/* SPDX-License-Identifier: MIT
 * Walls and gaps of the public interface.
 */
#include <math.h>

#include "api/measured.h"
#include "api/options.h"
#include "walls/walls.h"

csgm_wall_options csgm_wall_options_default(void)
{
    return (csgm_wall_options){
        .struct_size = sizeof(csgm_wall_options), .angle_deg = 30, .most_pairs = 1 << 21};
}

csgm_walls csgm_walls_default(void)
{
    return (csgm_walls){.struct_size = sizeof(csgm_walls)};
}

static bool adopt(csgm_wall_options *own, const csgm_wall_options *given)
{
    static const double MOST_DEG = 40;
    *own = csgm_wall_options_default();
    return csg_options_adopt(own, sizeof *own, given) && own->tolerance >= 0 &&
           isfinite(own->tolerance) && own->finest >= 0 && isfinite(own->finest) &&
           own->angle_deg > 0 && own->angle_deg <= MOST_DEG && own->most_pairs > 0;
}

csgm_status csgm_walls_of_field(csgm_context *context, const csgm_field *field,
                                const csgm_wall_options *options, csgm_walls *out)
{
    csgm_wall_options own;
    csgm_walls made = csgm_walls_default();
    if (!context || !field || !out || !csg_struct_is_known(out, sizeof *out) ||
        !adopt(&own, options))
        return CSGM_ERR_ARGUMENT;
    const csgm_field *of = csg_option_part(field, own.part);
    if (!of)
        return CSGM_ERR_ARGUMENT;
    csgm_status status = csg_walls_of_field(context, of, &own, &made);
    if (csg_measured_so_far(status))
        csg_struct_deliver(out, &made);
    return status;
}
