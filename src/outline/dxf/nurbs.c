/* SPDX-License-Identifier: MIT
 * De Boor's algorithm on homogeneous points, and halving of spans until three points in between lie
 * on the chord; see nurbs.h.
 */
#include "outline/dxf/nurbs.h"

#include "base/elementary.h"

enum { MOST_HALVINGS = 10 };

typedef struct span {
    const csg_nurbs *curve;
    size_t index; /* knots[index] <= t <= knots[index + 1] */
    csg_outline *pen;
    double tolerance;
} span;

bool csg_nurbs_is_valid(const csg_nurbs *curve)
{
    if (curve->degree < 1 || curve->degree > CSG_NURBS_MOST_DEGREE ||
        curve->point_count < (size_t)curve->degree + 1)
        return false;
    size_t knots = curve->point_count + (size_t)curve->degree + 1;
    for (size_t i = 0; i + 1 < knots; i++)
        if (!(curve->knots[i] <= curve->knots[i + 1]))
            return false;
    for (size_t i = 0; curve->weights && i < curve->point_count; i++)
        if (!(curve->weights[i] > 1e-9 && curve->weights[i] < 1e9))
            return false;
    return curve->knots[curve->degree] < curve->knots[curve->point_count];
}

static csg_vec2 evaluate(const span *s, double t)
{
    const csg_nurbs *c = s->curve;
    double x[CSG_NURBS_MOST_DEGREE + 1], y[CSG_NURBS_MOST_DEGREE + 1], w[CSG_NURBS_MOST_DEGREE + 1];
    size_t p = (size_t)c->degree, base = s->index - p;
    for (size_t i = 0; i <= p; i++) {
        w[i] = c->weights ? c->weights[base + i] : 1;
        x[i] = c->points[base + i].x * w[i];
        y[i] = c->points[base + i].y * w[i];
    }
    for (size_t round = 1; round <= p; round++)
        for (size_t i = p; i >= round; i--) {
            double low = c->knots[base + i], high = c->knots[s->index + 1 + i - round];
            double part = high > low ? (t - low) / (high - low) : 0;
            x[i] += (x[i - 1] - x[i]) * (1 - part);
            y[i] += (y[i - 1] - y[i]) * (1 - part);
            w[i] += (w[i - 1] - w[i]) * (1 - part);
        }
    return (csg_vec2){x[p] / w[p], y[p] / w[p]};
}

static double distance_to_chord(csg_vec2 p, csg_vec2 a, csg_vec2 b)
{
    double dx = b.x - a.x, dy = b.y - a.y, length = dx * dx + dy * dy;
    double part = length > 0 ? ((p.x - a.x) * dx + (p.y - a.y) * dy) / length : 0;
    part = fmin(fmax(part, 0), 1);
    return csg_hypot(p.x - a.x - part * dx, p.y - a.y - part * dy);
}

/* The piece of a span between two parameters, after its first point. Depth is bounded. */
static bool draw_piece(const span *s, double from, csg_vec2 a, double to, csg_vec2 b, int halvings)
{
    double middle = (from + to) / 2;
    csg_vec2 m = evaluate(s, middle);
    bool straight = distance_to_chord(m, a, b) <= s->tolerance &&
                    distance_to_chord(evaluate(s, (from + middle) / 2), a, b) <= s->tolerance &&
                    distance_to_chord(evaluate(s, (middle + to) / 2), a, b) <= s->tolerance;
    if (halvings == 0 || straight)
        return csg_outline_add(s->pen, b);
    return draw_piece(s, from, a, middle, m, halvings - 1) &&
           draw_piece(s, middle, m, to, b, halvings - 1);
}

bool csg_nurbs_draw(const csg_nurbs *curve, csg_outline *pen, double tolerance)
{
    span s = {curve, (size_t)curve->degree, pen, tolerance};
    for (; s.index < curve->point_count; s.index++) {
        double from = curve->knots[s.index], to = curve->knots[s.index + 1];
        if (!(to > from))
            continue;
        csg_vec2 a = evaluate(&s, from), b = evaluate(&s, to);
        if (!csg_outline_add(pen, a) || !draw_piece(&s, from, a, to, b, MOST_HALVINGS))
            return false;
    }
    return true;
}
