/* SPDX-License-Identifier: MIT
 * soft() and superellipsoid().
 */
#include <math.h>
#include <string.h>

#include "base/scene_codes.h"
#include "lang/modules/shapes.h"
#include "scene/operators/soft.h"
#include "scene/primitives/kinds.h"

static bool read_falloff(csg_module_call *call, uint32_t index, csg_falloff *out)
{
    csg_value value = call->values[index];
    *out = CSG_FALLOFF_SEXTIC;
    if (!csg_has_argument(call, index))
        return true;
    for (int i = 0; value.kind == CSG_VALUE_STRING && i < CSG_FALLOFF_COUNT; i++)
        if (strcmp(csg_falloff_name((csg_falloff)i), value.as.string->text) == 0) {
            *out = (csg_falloff)i;
            return true;
        }
    csg_argument_error(call, index, CSG_DIAG_OUT_OF_RANGE, "there is no such field function");
    return false;
}

csg_node_id csg_module_soft(csg_module_call *call)
{
    enum { RANGE, FALLOFF };
    csg_soft soft = {.range = csg_argument_number(call, RANGE, 0, CSG_POSITIVE)};
    read_falloff(call, FALLOFF, &soft.falloff);
    csg_node_id child = csg_module_children(call);
    if (call->failed || child == CSG_NODE_NONE)
        return child;
    csg_span where = call->statement->where;
    return csg_check_node(call->e, csg_build_soft(&call->e->builder, soft, child, where), where);
}

/* q of x and y, p of z with both. */
static void read_exponents(csg_module_call *call, double out[2])
{
    enum { AXES, P, E1, E2, EXPONENTS };
    bool barr = csg_has_argument(call, E1) || csg_has_argument(call, E2);
    out[0] = out[1] = csg_argument_number(call, P, 2, CSG_POSITIVE);
    if (barr) {
        out[0] = 2 / csg_argument_number(call, E2, 1, CSG_POSITIVE);
        out[1] = 2 / csg_argument_number(call, E1, 1, CSG_POSITIVE);
    }
    if (csg_has_argument(call, EXPONENTS) && !csg_value_numbers(call->values[EXPONENTS], 2, out))
        csg_argument_error(call, EXPONENTS, CSG_DIAG_BAD_TYPE, "exponents must be [q, p]");
    for (int i = 0; i < 2 && !call->failed; i++)
        if (!(out[i] >= 1 && out[i] <= 64))
            csg_argument_error(call, barr ? (i ? E1 : E2) : P, CSG_DIAG_OUT_OF_RANGE,
                               "the exponent %g is not between 1 and 64", out[i]);
}

csg_node_id csg_module_superellipsoid(csg_module_call *call)
{
    enum { AXES };
    csg_vec3 r = csg_argument_vector(call, AXES, csg_vec3_make(1, 1, 1), true);
    double exponents[2], smallest = fmin(r.x, fmin(r.y, r.z));
    read_exponents(call, exponents);
    if (!call->failed && !(smallest > 0))
        csg_argument_error(call, AXES, CSG_DIAG_OUT_OF_RANGE,
                           "a semi-axis is %g, it must be above 0", smallest);
    if (call->failed)
        return csg_shape_empty(call);
    const double parameters[6] = {r.x, r.y, r.z, exponents[0], exponents[1], 0};
    return csg_shape_done(call, csg_build_primitive(&call->e->builder, CSG_NODE_SUPERELLIPSOID,
                                                    parameters, call->statement->where));
}
