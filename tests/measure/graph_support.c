/* SPDX-License-Identifier: MIT
 * See graph_support.h.
 */
#include "measure/graph_support.h"

#include "field/field.h"

#include <inttypes.h>

#include "measure/enclosure.h"
#include "measure/graph.h"
#include "mesh/mesh_support.h"

static double square_of(const double x[3])
{
    return x[0] * x[0] + x[1] * x[1] + x[2] * x[2];
}

double graph_polynomial_at(const csg_taylor *f, const double x[3])
{
    return csg_taylor_moved(f, x).value;
}

void graph_gradient_at(const csg_taylor *f, const double x[3], double out[3])
{
    memcpy(out, csg_taylor_moved(f, x).slope, 3 * sizeof *out);
}

double graph_room_at(const csg_taylor *f, const double x[3])
{
    return f->error + f->quartic * square_of(x) * square_of(x);
}

double graph_turn_at(const csg_taylor *f, const double x[3])
{
    return f->turned + f->thrice * square_of(x) * sqrt(square_of(x));
}

int graph_is_there(const csg_taylor_piece *piece, const double x[3])
{
    int all = !piece->is_partial;
    for (int n = 0; n < piece->condition_count; n++) {
        const csg_taylor *g = &piece->conditions[n];
        double value = graph_polynomial_at(g, x), room = graph_room_at(g, x);
        if (value < -room)
            return -1;
        all = value > room ? all : 0;
    }
    return all;
}

/* ---- parts ------------------------------------------------------------------------------------
 */

enum { SIDE = 8, PARTS = SIDE * SIDE * SIDE };

/* Of part i of side^3: its centre from the cube's. */
static void place_part(int i, int side, double small, double out[3])
{
    const int of[3] = {i % side, i / side % side, i / side / side};
    for (int k = 0; k < 3; k++)
        out[k] = small * (2 * of[k] + 1 - side);
}

static bool find_models(const graph_field *f, const double c[3], const double d[3], double half,
                        csg_taylor_pieces *out)
{
    const double at[3] = {c[0] + d[0], c[1] + d[1], c[2] + d[2]};
    return f->find(f->user, at, half, out);
}

/* Of the surface: 1, the cube is inside; -1, outside; 0, not told. */
static int side_of(const csg_taylor_pieces *models, double half)
{
    double radius = csg_enclosure_radius(half);
    bool is_inside = true, is_outside = true;
    for (int i = 0; i < models->count; i++) {
        is_inside &= csg_taylor_least(&models->of[i].f, radius) > 0;
        is_outside &= csg_taylor_most(&models->of[i].f, radius) < 0;
    }
    return is_inside ? 1 : is_outside ? -1 : 0;
}

/* ---- integrals --------------------------------------------------------------------------------
 */

static bool add_part(const graph_field *f, const double c[3], const double d[3], double half,
                     csg_graph *sum)
{
    csg_taylor_pieces models;
    csg_graph part = {.error = 0};
    double far = fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2])));
    if (!find_models(f, c, d, half, &models))
        return false;
    int side = side_of(&models, half);
    if (side < 0)
        return true;
    if (side > 0)
        csg_integrals_of_cube(half, part.integrals);
    else if (!csg_graph_find(&models, half, 0, &part))
        return false;
    csg_integrals_shift(part.integrals, d);
    for (int n = 0; n < CSG_INTEGRALS; n++)
        sum->integrals[n] += part.integrals[n];
    sum->error += part.error;
    sum->first += part.first + far * part.error;
    sum->second += part.second + far * (2 * part.first + far * part.error);
    return true;
}

bool graph_try_integrals(const graph_field *f, const double c[3], double half)
{
    static const double AT_CENTRE[3] = {0, 0, 0};
    csg_graph whole = {.error = 0}, sum = {.error = 0};
    if (!add_part(f, c, AT_CENTRE, half, &whole))
        return false;
    for (int i = 0; i < PARTS; i++) {
        double d[3];
        place_part(i, SIDE, half / SIDE, d);
        if (!add_part(f, c, d, half / SIDE, &sum))
            return false;
    }
    for (int n = 0; n < CSG_INTEGRALS; n++) {
        bool is_first = n >= CSG_INTEGRAL_X, is_second = n >= CSG_INTEGRAL_XX;
        double scale = half * half * half * (is_second ? half * half : is_first ? half : 1);
        double room = is_second  ? whole.second + sum.second
                      : is_first ? whole.first + sum.first
                                 : whole.error + sum.error;
        double off = fabs(whole.integrals[n] - sum.integrals[n]);
        if (off > room + 1e-12 * scale)
            fail_msg("seed %" PRIu64 ": integral %d of a cube of half %g at (%.9g, %.9g, %.9g) is "
                     "%g off that of its parts, %g promised",
                     f->seed, n, half, c[0], c[1], c[2], off, room);
    }
    return true;
}

/* ---- areas ------------------------------------------------------------------------------------
 */

/* Of the solid through the cube's faces along this normal; *off: as much. */
static bool find_flow(const csg_taylor_pieces *models, const double normal[3], double half,
                      double *flow, double *off)
{
    *flow = *off = 0;
    for (int i = 0; i < 6; i++) {
        double area, error, share = normal[i / 2];
        if (!csg_graph_face(models, half, i / 2, i & 1 ? 1 : -1, 0, &area, &error))
            return false;
        *flow += (i & 1 ? share : -share) * area;
        *off += fabs(share) * error;
    }
    return true;
}

/* Between these the surface's area in the cube is; by side^3 parts of it. */
static bool find_area(const graph_field *f, const double c[3], double half, int side,
                      double between[2])
{
    between[0] = between[1] = 0;
    for (int i = 0; i < side * side * side; i++) {
        double small = half / side, d[3], slope[3] = {0}, flow, off, least, most;
        csg_taylor_pieces models;
        place_part(i, side, small, d);
        if (!find_models(f, c, d, small, &models))
            return false;
        if (side_of(&models, small))
            continue;
        for (int n = 0; n < models.count; n++)
            for (int k = 0; k < 3; k++)
                slope[k] += models.of[n].f.slope[k];
        if (!csg_graph_excess(&models, slope, small, 0, &least, &most))
            return false;
        double length = csg_norm3(slope);
        for (int k = 0; k < 3; k++)
            slope[k] /= length;
        if (!find_flow(&models, slope, small, &flow, &off))
            return false;
        between[0] += flow - off + least;
        between[1] += flow + off + most;
    }
    return true;
}

bool graph_try_area(const graph_field *f, const double c[3], double half)
{
    double whole[2], parts[2], room = 1e-12 * half * half;
    csg_taylor_pieces models;
    if (!find_area(f, c, half, 1, whole) || !find_area(f, c, half, SIDE, parts))
        return false;
    double most = f->find(f->user, c, half, &models) ? csg_graph_area_most(&models, half, 0.9) : 0;
    if (parts[0] > most + room)
        fail_msg("seed %" PRIu64
                 ": the area in a cube of half %g at (%.9g, %.9g, %.9g) is %.12g at "
                 "most, by its parts %.12g at least",
                 f->seed, half, c[0], c[1], c[2], most, parts[0]);
    if (whole[0] > parts[1] + room || parts[0] > whole[1] + room)
        fail_msg("seed %" PRIu64 ": the area in a cube of half %g at (%.9g, %.9g, %.9g) is between "
                 "%.12g and %.12g, by its parts between %.12g and %.12g",
                 f->seed, half, c[0], c[1], c[2], whole[0], whole[1], parts[0], parts[1]);
    return true;
}

void graph_take_numbers(mesh_case *m)
{
    static uint32_t calls;
    csg_tape_exact *exact = csg_arena_alloc(&m->field->arena, sizeof *exact);
    assert_non_null(exact);
    if (calls++ & 1)
        return;
    assert_true(csg_field_exact(&m->context, m->field, &m->field->arena, exact));
    assert_non_null(exact->parameters);
    m->field->tape.exact = exact;
}
