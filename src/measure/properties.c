/* SPDX-License-Identifier: MIT
 * Arithmetic of intervals; see properties.h. Every operation rounds outward by a few units in the
 * last place of what it works on.
 */
#include "measure/properties.h"

#include <math.h>

#include "measure/principal.h"

static const double ROUNDING = 0x1p-50;

csgm_interval csg_interval_grown(double low, double high, double relative)
{
    double by = relative * fmax(fabs(low), fabs(high));
    return (csgm_interval){low - by, high + by};
}

static csgm_interval grown(double low, double high)
{
    return csg_interval_grown(low, high, ROUNDING);
}

static csgm_interval add(csgm_interval a, csgm_interval b)
{
    csgm_interval sum = {a.low + b.low, a.high + b.high};
    double by = ROUNDING * (fmax(fabs(a.low), fabs(a.high)) + fmax(fabs(b.low), fabs(b.high)));
    return (csgm_interval){sum.low - by, sum.high + by};
}

static csgm_interval negated(csgm_interval a)
{
    return (csgm_interval){-a.high, -a.low};
}

static csgm_interval multiply(csgm_interval a, csgm_interval b)
{
    double p[4] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
    return grown(fmin(fmin(p[0], p[1]), fmin(p[2], p[3])),
                 fmax(fmax(p[0], p[1]), fmax(p[2], p[3])));
}

/* by > 0 */
static csgm_interval divide(csgm_interval a, csgm_interval by)
{
    return multiply(a, grown(1 / by.high, 1 / by.low));
}

static csgm_interval square(csgm_interval a)
{
    csgm_interval s = multiply(a, a);
    return (csgm_interval){fmax(s.low, a.low <= 0 && a.high >= 0 ? 0 : s.low), s.high};
}

/* Around the centroid: the integral of x_i x_k less that of x_i times that of x_k over the volume;
 * of one axis it is not negative. */
static csgm_interval central(const csgm_interval m[CSG_INTEGRALS], int second, int i, int k)
{
    csgm_interval a = m[CSG_INTEGRAL_X + i], b = m[CSG_INTEGRAL_X + k];
    csgm_interval product = i == k ? square(a) : multiply(a, b);
    csgm_interval c = add(m[second], negated(divide(product, m[CSG_INTEGRAL_ONE])));
    return i == k ? (csgm_interval){fmax(c.low, 0), c.high} : c;
}

void csg_measure_derive(const double low[CSG_INTEGRALS], const double high[CSG_INTEGRALS],
                        csg_vec3 origin, double density, csgm_measures *out)
{
    const double at[3] = {origin.x, origin.y, origin.z};
    csgm_interval m[CSG_INTEGRALS], c[6], of = {density, density};
    const csgm_interval unknown = {-INFINITY, INFINITY};
    for (int n = 0; n < CSG_INTEGRALS; n++)
        m[n] = (csgm_interval){low[n], high[n]};
    out->volume = (csgm_interval){fmax(m[0].low, 0), m[0].high};
    out->mass = multiply(out->volume, of);
    out->mass.low = fmax(out->mass.low, 0);
    for (int k = 0; k < 3; k++)
        out->centroid[k] = unknown;
    for (int k = 0; k < 6; k++)
        out->inertia[k] = unknown;
    csg_measure_principal(out);
    if (!(m[0].low > 0))
        return;
    for (int k = 0; k < 3; k++)
        out->centroid[k] = add(divide(m[CSG_INTEGRAL_X + k], m[0]), (csgm_interval){at[k], at[k]});
    for (int k = 0; k < 3; k++)
        c[k] = central(m, CSG_INTEGRAL_XX + k, k, k);
    c[3] = central(m, CSG_INTEGRAL_XY, 0, 1);
    c[4] = central(m, CSG_INTEGRAL_XZ, 0, 2);
    c[5] = central(m, CSG_INTEGRAL_YZ, 1, 2);
    for (int k = 0; k < 3; k++)
        out->inertia[k] = multiply(add(c[(k + 1) % 3], c[(k + 2) % 3]), of);
    for (int k = 3; k < 6; k++)
        out->inertia[k] = multiply(negated(c[k]), of);
    csg_measure_principal(out);
}
