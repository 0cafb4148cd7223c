/* SPDX-License-Identifier: MIT
 * A batch of triangles in loops that compilers make vectors of; see measures.h.
 */
#include "mesh/figures/measures.h"

#include <math.h>
#include <string.h>

#include "base/elementary.h"

/* Built for several instruction sets, of which the dynamic linker takes the machine's: operations
 * are rounded each for itself, so all of them find the same bits. (With sanitizers the linker would
 * ask before these are ready.) */
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) &&       \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define FOR_EACH_MACHINE __attribute__((target_clones("default", "avx2", "arch=skylake-avx512")))
#else
#define FOR_EACH_MACHINE
#endif

enum { LANES = 8 };

/* Of a batch, triangle by triangle. */
typedef struct terms {
    double cross[CSG_MEASURES_BATCH];     /* twice the area */
    double volume[CSG_MEASURES_BATCH];    /* six times that of the tetrahedron with the apex */
    double cotangent[CSG_MEASURES_BATCH]; /* the largest of an angle; flat: -infinity */
    double aspect[CSG_MEASURES_BATCH];    /* longest side over smallest altitude; flat: 0 */
} terms;

/* ---- sums ------------------------------------------------------------------------------- */

static csg_exact_sum begin_sum(double bound)
{
    int exponent;
    frexp(bound, &exponent);
    return (csg_exact_sum){.coarse = ldexp(1, exponent - 40), .fine = ldexp(1, exponent - 80)};
}

/* To the nearest multiple of step, a power of two, for |x| < 2^51 steps: the sum's last bit is
 * worth a step. */
static inline double round_to(double x, double step)
{
    double shift = 0x1.8p52 * step;
    return (x + shift) - shift;
}

/* False: a term is not finite. */
FOR_EACH_MACHINE static bool add_terms(csg_exact_sum *sum, const double *term, size_t count)
{
    double coarse[LANES] = {0}, fine[LANES] = {0};
    for (size_t i = 0; i < count; i += LANES)
        for (size_t k = 0; k < LANES; k++) {
            double most = round_to(term[i + k], sum->coarse);
            coarse[k] += most;
            fine[k] += round_to(term[i + k] - most, sum->fine);
        }
    double sums[2] = {0, 0};
    for (int k = 0; k < LANES; k++) {
        sums[0] += coarse[k];
        sums[1] += fine[k];
    }
    if (!isfinite(sums[0]) || !isfinite(sums[1]))
        return false;
    sum->steps += (csg_int128)(int64_t)(sums[0] / sum->coarse) * ((int64_t)1 << 40);
    sum->steps += (int64_t)(sums[1] / sum->fine);
    return true;
}

static double sum_of(const csg_exact_sum *sum)
{
    return (double)sum->steps * sum->fine;
}

/* ---- a batch ----------------------------------------------------------------------------- */

/* One corner's coordinate in the frame of the apex. */
#define AT(corner_axis, apex_axis) ((double)m->corner[corner_axis][i] - apex.apex_axis)

FOR_EACH_MACHINE static void find_terms(const csg_mesh_measures *m, size_t count, terms *out)
{
    const csg_vec3 apex = m->apex;
    for (size_t i = 0; i < count; i++) {
        double ax = AT(0, x), ay = AT(1, y), az = AT(2, z);
        double bx = AT(3, x), by = AT(4, y), bz = AT(5, z);
        double cx = AT(6, x), cy = AT(7, y), cz = AT(8, z);
        double ux = bx - ax, uy = by - ay, uz = bz - az; /* sides u, v, w */
        double vx = cx - bx, vy = cy - by, vz = cz - bz;
        double wx = ax - cx, wy = ay - cy, wz = az - cz;
        double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
        double cross = sqrt(nx * nx + ny * ny + nz * nz);
        out->cross[i] = cross;
        out->volume[i] = ax * nx + ay * ny + az * nz;
        double uv = ux * vx + uy * vy + uz * vz, vw = vx * wx + vy * wy + vz * wz;
        double wu = wx * ux + wy * uy + wz * uz;
        double uu = ux * ux + uy * uy + uz * uz, vv = vx * vx + vy * vy + vz * vz;
        double ww = wx * wx + wy * wy + wz * wz;
        double least = uv < vw ? uv : vw, longest = uu > vv ? uu : vv;
        least = least < wu ? least : wu;
        longest = longest > ww ? longest : ww;
        double part = 1 / cross;
        out->cotangent[i] = cross > 0 ? -least * part : -INFINITY;
        out->aspect[i] = cross > 0 ? longest * part : 0;
    }
}

static double largest_of(const double *values, size_t count, double largest)
{
    double lanes[LANES];
    for (int k = 0; k < LANES; k++)
        lanes[k] = largest;
    for (size_t i = 0; i < count; i += LANES)
        for (size_t k = 0; k < LANES; k++)
            lanes[k] = values[i + k] > lanes[k] ? values[i + k] : lanes[k];
    for (int k = 0; k < LANES; k++)
        largest = lanes[k] > largest ? lanes[k] : largest;
    return largest;
}

void csg_mesh_measures_flush(csg_mesh_measures *m)
{
    terms t;
    size_t count = m->waiting, padded = (count + LANES - 1) / LANES * LANES;
    if (!count)
        return;
    for (size_t i = count; i < padded; i++) /* triangles without area, which are not counted */
        for (int c = 0; c < 9; c++)
            m->corner[c][i] = 0;
    find_terms(m, padded, &t);
    for (size_t i = 0; i < count; i++)
        m->flat += t.cross[i] > 0 ? 0 : 1;
    bool is_whole = add_terms(&m->area, t.cross, padded);
    is_whole = add_terms(&m->volume, t.volume, padded) && is_whole;
    m->is_broken |= !is_whole;
    m->cotangent = largest_of(t.cotangent, padded, m->cotangent);
    m->aspect = largest_of(t.aspect, padded, m->aspect);
    m->triangles += count;
    m->waiting = 0;
}

/* ---- all of them -------------------------------------------------------------------------- */

csg_mesh_measures csg_mesh_measures_begin(csg_box box)
{
    bool empty = !(box.min.x <= box.max.x);
    double diagonal = empty ? 0 : csg_vec3_norm(csg_vec3_sub(box.max, box.min));
    double bound = diagonal > 0 && isfinite(diagonal) ? diagonal : 1;
    csg_mesh_measures m = {.apex = empty ? csg_vec3_make(0, 0, 0) : csg_box_center(box),
                           .area = begin_sum(bound * bound),
                           .volume = begin_sum(bound * bound * bound),
                           .cotangent = -INFINITY};
    return m;
}

void csg_mesh_measures_add(csg_mesh_measures *m, csg_mesh_measures *other)
{
    csg_mesh_measures_flush(other);
    m->area.steps += other->area.steps;
    m->volume.steps += other->volume.steps;
    m->cotangent = fmax(m->cotangent, other->cotangent);
    m->aspect = fmax(m->aspect, other->aspect);
    m->triangles += other->triangles;
    m->flat += other->flat;
    m->is_broken |= other->is_broken;
}

void csg_mesh_measures_end(csg_mesh_measures *m, csg_box box, csgm_vec3 origin,
                           csgm_mesh_check *check)
{
    csg_mesh_measures_flush(m);
    bool flat = m->flat > 0 || m->triangles == 0;
    check->area = m->is_broken ? NAN : sum_of(&m->area) / 2;
    check->volume = m->is_broken ? NAN : sum_of(&m->volume) / 6;
    check->zero_area_triangles = m->flat;
    check->min_angle_deg = flat ? 0 : csg_atan2(1, m->cotangent) * 180 / csg_acos(-1);
    check->max_aspect = m->flat ? INFINITY : m->aspect;
    check->bounds = box;
    if (m->triangles)
        check->bounds = (csg_box){csg_vec3_add(box.min, origin), csg_vec3_add(box.max, origin)};
}
