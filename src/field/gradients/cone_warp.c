/* SPDX-License-Identifier: MIT
 * A gradient g below a warp w is J^T g above it, J the warp's derivative. In the ball, J is within
 * `change` of what it is at the centre, row by row:
 *
 *   revolve  the row of the radius turns by asin(rho / r); at the axis it is any unit vector
 *   elbow    along the arc as revolve, along its straight ends constant; where what is nearest to
 *            one end meets what is nearest to the other, behind the axis, any unit vector
 *   slice    constant
 *   twist    rows x and y turn by rate rho, and their part along z, rate times a coordinate of the
 *            image, changes by rate times how far the image moves
 *   taper    as a twist of what was divided: on the way the rows of the quotient change by
 *            |s'| / s^2, their part along z by what the quotient moves and by |s'|^2 / s^2 of it
 *   bend     the row along the circle is radius / s times a unit vector around the line, whose
 *            derivative is 1 / s^2 in size; the row across turns by asin(rho / s)
 *
 * Of any two points in the ball J differs by no more than `bend` times their distance, row by row:
 * 1 / (r - rho) for a vector away from an axis, and else what bounds the change from the centre,
 * since that is of the whole ball.
 */
#include "field/gradients/cone_warp.h"

#include <math.h>

#include "field/kernels/functions.h"
#include "scene/warp_kinds.h"

/* The square root of the largest row sum of |M^T M|. */
double csg_cone_norm(const float *m)
{
    double most = 0;
    for (int i = 0; i < 3; i++) {
        double sum = 0;
        for (int j = 0; j < 3; j++) {
            double d = 0;
            for (int k = 0; k < 3; k++)
                d += (double)m[3 * k + i] * (double)m[3 * k + j];
            sum += fabs(d);
        }
        most = fmax(most, sum);
    }
    return sqrt(most);
}

/* More than the floats of a warp err. */
static const double ROUNDING = 1e-5;

static double length_of(double x, double y)
{
    return sqrt(x * x + y * y);
}

/* Of the map of the warp's own coordinates q: rows of J, how they change, and the image. */
typedef struct passage {
    double row[3][3], change[3], bend[3], norm, image[3], kink[3]; /* kink: what its other side
                                                                      lacks of dw / dz */
    bool is_kinked;
} passage;

static bool pass_revolve(const float *own, const double q[3], double rho, passage *p)
{
    double r = length_of(q[0], q[1]), s = r > 0 ? rho / r : 1;
    bool is_clear = s < 0.9;
    p->row[0][0] = is_clear ? q[0] / r : 0;
    p->row[0][1] = is_clear ? q[1] / r : 0;
    p->row[1][2] = 1;
    p->change[0] = is_clear ? sqrt(2 - 2 * sqrt(1 - s * s)) : 1;
    p->bend[0] = is_clear ? 1 / (r - rho) : INFINITY;
    p->image[0] = r;
    p->image[1] = q[2];
    return true;
}

static bool pass_elbow(const float *own, const double q[3], double rho, passage *p)
{
    double c = (double)own[CSG_ELBOW_COSINE], s = (double)own[CSG_ELBOW_SINE];
    double r = length_of(q[0], q[1]), part = r > 0 ? rho / r : 1, side = q[1] < 0 ? -1 : 1;
    double a = q[0] * c + fabs(q[1]) * s, b = q[0] * s - fabs(q[1]) * c;
    double behind = q[0] < 0 ? fabs(q[1]) : r; /* the way to the half-plane behind the axis */
    bool is_straight = b < -rho && behind > rho, is_clear = part < 0.9 && behind > rho;
    double by_a = b > 0 ? a / r : 1, by_b = b > 0 ? b / r : 0;
    bool is_known = is_straight || is_clear;
    p->row[0][0] = is_known ? by_a * c + by_b * s : 0;
    p->row[0][1] = is_known ? side * (by_a * s - by_b * c) : 0;
    p->row[1][2] = 1;
    p->change[0] = is_straight ? 0 : is_clear ? sqrt(2 - 2 * sqrt(1 - part * part)) : 1;
    p->bend[0] = is_straight ? 0 : is_clear ? 1 / (r - rho) : INFINITY;
    p->image[0] = b > 0 ? r : a;
    p->image[1] = q[2];
    return true;
}

static bool pass_slice(const float *own, const double q[3], double rho, passage *p)
{
    p->row[0][0] = p->row[1][1] = 1;
    p->image[0] = q[0];
    p->image[1] = q[1];
    return true;
}

static bool pass_twist(const float *own, const double q[3], double rho, passage *p)
{
    double low = (double)own[CSG_TWIST_LOW], high = (double)own[CSG_TWIST_HIGH];
    double rate = (double)own[CSG_TWIST_RATE], r = length_of(q[0], q[1]) + rho;
    if (r > (double)own[CSG_TWIST_REACH])
        return false;
    double angle = -rate * fmin(fmax(q[2], low), high);
    double c = (double)wave((float)angle, 1), s = (double)wave((float)angle, 0);
    double x = c * q[0] - s * q[1], y = s * q[0] + c * q[1];
    double k = fabs(rate) * r, steep = (k + sqrt(k * k + 4)) / 2;
    bool turns = q[2] + rho > low && q[2] - rho < high;
    double turning = turns ? -rate : 0;
    const double rows[3][3] = {{c, -s, -turning * y}, {s, c, turning * x}, {0, 0, 1}};
    memcpy(p->row, rows, sizeof rows);
    p->is_kinked = turns && (q[2] - rho < low || q[2] + rho > high);
    p->kink[0] = turning * y;
    p->kink[1] = -turning * x;
    p->bend[0] = p->bend[1] = turns ? fabs(rate) * length_of(1, steep) : 0;
    p->change[0] = p->change[1] = rho * p->bend[0];
    p->norm = steep;
    p->image[0] = x;
    p->image[1] = y;
    p->image[2] = q[2];
    return true;
}

static bool pass_taper(const float *own, const double q[3], double rho, passage *p)
{
    double low = (double)own[CSG_TAPER_LOW], high = (double)own[CSG_TAPER_HIGH];
    double rate = (double)own[CSG_TAPER_RATE];
    const double grow[2] = {(double)own[CSG_TAPER_X], (double)own[CSG_TAPER_Y]};
    double z = fmin(fmax(q[2], low), high), from = fmin(fmax(q[2] - rho, low), high) - low,
           to = fmin(fmax(q[2] + rho, low), high) - low;
    double scale[2], least = INFINITY, steepest = fmax(fabs(grow[0]), fabs(grow[1]));
    for (int k = 0; k < 2; k++) {
        scale[k] = 1 + grow[k] * (z - low);
        least = fmin(least, fmin(1 + grow[k] * from, 1 + grow[k] * to));
    }
    double r = (length_of(q[0], q[1]) + rho) / least; /* of the quotients, at most */
    if (!(r <= (double)own[CSG_TAPER_REACH]))
        return false;
    double angle = -rate * z;
    double c = (double)wave((float)angle, 1), s = (double)wave((float)angle, 0);
    double u = q[0] / scale[0], w = q[1] / scale[1], x = c * u - s * w, y = s * u + c * w;
    bool turns = q[2] + rho > low && q[2] - rho < high;
    double turning = turns ? -rate : 0, less_u = turns ? u * grow[0] / scale[0] : 0,
           less_w = turns ? w * grow[1] / scale[1] : 0;
    const double rows[3][3] = {
        {c / scale[0], -s / scale[1], -turning * y - (c * less_u - s * less_w)},
        {s / scale[0], c / scale[1], turning * x - (s * less_u + c * less_w)},
        {0, 0, 1}};
    memcpy(p->row, rows, sizeof rows);
    p->is_kinked = turns && (q[2] - rho < low || q[2] + rho > high);
    p->kink[0] = -rows[0][2];
    p->kink[1] = -rows[1][2];
    double shrinking = steepest / least /* |s'| / s at most */, turn = fabs(rate);
    double along_z = turns ? r * (turn + shrinking) : 0; /* how far the image moves per length */
    double moved = 1 / least + along_z;
    if (turns) {
        double across = (turn + shrinking) / least;
        double along = turn * moved + shrinking * (moved + r * (shrinking + turn));
        p->bend[0] = p->bend[1] = length_of(across, along);
        p->change[0] = p->change[1] = rho * p->bend[0];
    }
    p->norm = csg_shear_norm(1 / least, along_z);
    p->image[0] = x;
    p->image[1] = y;
    p->image[2] = q[2];
    return true;
}

static bool pass_bend(const float *own, const double q[3], double rho, passage *p)
{
    double radius = (double)own[CSG_BEND_RADIUS], across = radius - q[2];
    double s = length_of(q[0], across), least = s - rho;
    if (!(least > (double)own[CSG_BEND_NEAREST]))
        return false;
    double phi = (double)angle_of((float)q[0], (float)across);
    if (fabs(phi) + 1.6 * rho / s > (double)own[CSG_BEND_ANGLE] - ROUNDING)
        return false;
    double sine = q[0] / s, cosine = across / s, around = radius / s;
    const double rows[3][3] = {{around * cosine, 0, around * sine}, {0, 1, 0}, {-sine, 0, cosine}};
    memcpy(p->row, rows, sizeof rows);
    p->bend[0] = radius / (least * least);
    p->bend[2] = 1 / least;
    p->change[0] = rho * p->bend[0];
    p->change[2] = rho * p->bend[2];
    p->norm = fmax(1, radius / least);
    p->image[0] = radius * phi;
    p->image[1] = q[1];
    p->image[2] = radius - s;
    return true;
}

static bool pass(const csg_tape_warp *warp, const double q[3], double rho, passage *p)
{
    *p = (passage){.norm = 1};
    switch (warp->kind) {
#define CSG_WARP(NAME, name, ...)                                                                  \
    case CSG_WARP_##NAME:                                                                          \
        return pass_##name(warp->own, q, rho, p);
#include "scene/primitives/warps.def"
    }
    return false;
}

/* out = m^T J^T */
static void transpose_product(const float *m, double row[3][3], double out[3][3])
{
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++) {
            out[k][i] = 0;
            for (int j = 0; j < 3; j++)
                out[k][i] += (double)m[3 * j + k] * row[i][j];
        }
}

static bool send(const csg_tape_warp *warp, double c[3], double *radius, csg_cone_turn *turn)
{
    const float *m = warp->frame;
    double q[3], norm = csg_cone_norm(m);
    for (int i = 0; i < 3; i++)
        q[i] = (double)m[9 + i] + (double)m[3 * i] * c[0] + (double)m[3 * i + 1] * c[1] +
               (double)m[3 * i + 2] * c[2];
    passage p;
    if (!pass(warp, q, *radius * norm, &p))
        return false;
    transpose_product(m, p.row, turn->back);
    for (int i = 0; i < 3; i++) {
        turn->change[i] = (p.change[i] + ROUNDING) * norm;
        turn->bend[i] = p.is_kinked ? INFINITY : p.bend[i] * norm * norm;
        p.row[i][2] += p.kink[i];
        c[i] = p.image[i];
    }
    transpose_product(m, p.row, turn->other);
    turn->is_kinked = p.is_kinked;
    turn->norm = p.norm * norm;
    *radius *= turn->norm * (1 + ROUNDING);
    return true;
}

bool csg_cone_warp(const csg_tape *tape, uint32_t warp, double c[3], double *radius,
                   csg_cone_way *way)
{
    const csg_tape_warp *chain[CSG_MOST_WARPS];
    way->count = 0;
    for (uint32_t w = warp; w; w = tape->warps[w - 1].outer)
        chain[way->count++] = &tape->warps[w - 1];
    for (uint32_t i = 0; i < way->count; i++) /* the outermost first */
        if (!send(chain[way->count - 1 - i], c, radius, &way->turns[i]))
            return false;
    return true;
}

static void turn_ball(const csg_cone_turn *turn, double matrix[3][3], csg_cone_ball *ball)
{
    double at[3], spread = turn->norm * ball->spread;
    for (int k = 0; k < 3; k++) {
        at[k] =
            matrix[k][0] * ball->at[0] + matrix[k][1] * ball->at[1] + matrix[k][2] * ball->at[2];
        spread += turn->change[k] * (fabs(ball->at[k]) + ball->spread);
    }
    memcpy(ball->at, at, sizeof at);
    ball->spread = spread;
}

/* Of J^T g, each changes on the way from one point to another. */
static double turn_bend(const csg_cone_turn *turn, const csg_cone_balls *balls, uint32_t first)
{
    double bend = turn->norm * turn->norm * balls->bend;
    for (int k = 0; k < 3; k++) {
        double most = 0;
        for (uint32_t i = first; i < balls->count; i++)
            most = fmax(most, fabs(balls->items[i].at[k]) + balls->items[i].spread);
        bend += most > 0 ? turn->bend[k] * most : 0;
    }
    return bend * (1 + ROUNDING);
}

bool csg_cone_unwarp(const csg_cone_way *way, csg_cone_balls *balls, uint32_t first)
{
    for (uint32_t i = way->count; i > 0; i--) {
        csg_cone_turn turn = way->turns[i - 1];
        uint32_t end = balls->count;
        balls->bend = turn_bend(&turn, balls, first);
        for (uint32_t k = first; k < end; k++) {
            if (turn.is_kinked && balls->count >= CSG_CONE_MOST)
                return false;
            if (turn.is_kinked) {
                csg_cone_ball *other = &balls->items[balls->count++];
                *other = balls->items[k];
                turn_ball(&turn, turn.other, other);
            }
            turn_ball(&turn, turn.back, &balls->items[k]);
        }
        balls->has_edges |= turn.is_kinked;
        balls->corner *= turn.norm * (1 + ROUNDING);
    }
    return true;
}
