/* SPDX-License-Identifier: MIT
 * What follows from exact signs; see exact.h.
 */
#include "mesh/features/exact.h"

#include "base/orient.h"

/* ---- in one plane ------------------------------------------------------------------------------
 */

/* The axis along which a triangle shows the most area; -1: it has none. */
static int axis_of(const csg_exact_triangle *t)
{
    double most = -1;
    int best = -1;
    for (int axis = 0; axis < 3; axis++) {
        int i = (axis + 1) % 3, j = (axis + 2) % 3;
        double x = ((double)t->at[1][i] - (double)t->at[0][i]) *
                   ((double)t->at[2][j] - (double)t->at[0][j]);
        double y = ((double)t->at[1][j] - (double)t->at[0][j]) *
                   ((double)t->at[2][i] - (double)t->at[0][i]);
        if (fabs(x - y) > most && csg_orient_along(t->at[0], t->at[1], t->at[2], axis)) {
            most = fabs(x - y);
            best = axis;
        }
    }
    return best;
}

static bool is_on_segment(const float *a, const float *b, const float *p, int axis)
{
    if (csg_orient_along(a, b, p, axis))
        return false;
    for (int i = 0; i < 3; i++)
        if (i != axis && !(fminf(a[i], b[i]) <= p[i] && p[i] <= fmaxf(a[i], b[i])))
            return false;
    return true;
}

static bool segments_meet(const float *a, const float *b, const float *c, const float *d, int axis)
{
    int to_c = csg_orient_along(a, b, c, axis), to_d = csg_orient_along(a, b, d, axis);
    int to_a = csg_orient_along(c, d, a, axis), to_b = csg_orient_along(c, d, b, axis);
    return (to_c * to_d < 0 && to_a * to_b < 0) || is_on_segment(a, b, c, axis) ||
           is_on_segment(a, b, d, axis) || is_on_segment(c, d, a, axis) ||
           is_on_segment(c, d, b, axis);
}

/* Seen along an axis. */
static bool is_within(const csg_exact_triangle *t, const float *p, int axis)
{
    int least = 1, most = -1;
    for (int k = 0; k < 3; k++) {
        int turn = csg_orient_along(t->at[k], t->at[(k + 1) % 3], p, axis);
        least = turn < least ? turn : least;
        most = turn > most ? turn : most;
    }
    return least >= 0 || most <= 0;
}

static bool meets_in_plane(const csg_exact_triangle *t, const float *p, const float *q)
{
    int axis = axis_of(t);
    if (axis < 0 || is_within(t, p, axis) || is_within(t, q, axis))
        return true;
    for (int k = 0; k < 3; k++)
        if (segments_meet(p, q, t->at[k], t->at[(k + 1) % 3], axis))
            return true;
    return false;
}

/* ---- a segment and a triangle ------------------------------------------------------------------
 */

/* Ends and rims included; above, below: on which sides of the triangle p and q lie. */
static bool pierces(const float *p, const float *q, int above, int below,
                    const csg_exact_triangle *t)
{
    if (above * below > 0)
        return false;
    if (!above && !below)
        return meets_in_plane(t, p, q);
    int least = 1, most = -1;
    for (int k = 0; k < 3; k++) {
        int turn = csg_orient_space(p, q, t->at[k], t->at[k == 2 ? 0 : k + 1]);
        least = turn < least ? turn : least;
        most = turn > most ? turn : most;
    }
    return least >= 0 || most <= 0;
}

static int side_of(const csg_exact_triangle *t, const float *p)
{
    return csg_orient_space(t->at[0], t->at[1], t->at[2], p);
}

/* ---- two triangles -----------------------------------------------------------------------------
 */

static bool boxes_apart(const csg_exact_triangle *s, const csg_exact_triangle *t, float reach)
{
    for (int i = 0; i < 3; i++) {
        float s_low = s->at[0][i], s_high = s_low, t_low = t->at[0][i], t_high = t_low;
        for (int k = 1; k < 3; k++) {
            s_low = s->at[k][i] < s_low ? s->at[k][i] : s_low;
            s_high = s->at[k][i] > s_high ? s->at[k][i] : s_high;
            t_low = t->at[k][i] < t_low ? t->at[k][i] : t_low;
            t_high = t->at[k][i] > t_high ? t->at[k][i] : t_high;
        }
        if (s_low - reach > t_high || t_low - reach > s_high)
            return true;
    }
    return false;
}

/* At an edge of both: folded onto one another? e, f: its ends; p, q: what is opposite. */
static bool is_folded(const float *e, const float *f, const float *p, const float *q)
{
    for (int axis = 0; axis < 3; axis++)
        if (csg_orient_along(e, f, p, axis) * csg_orient_along(e, f, q, axis) < 0)
            return false; /* apart in this view */
    return csg_orient_space(e, f, p, q) == 0;
}

/* In one plane, at a vertex of both: they meet elsewhere if one of the four rays from it along
 * their sides lies in the other's angle. *known: neither is without area in this view. */
static bool angles_meet(const csg_exact_triangle *s, int i, const csg_exact_triangle *t, int k,
                        bool *known)
{
    int axis = axis_of(t);
    const float *o = s->at[i], *p = s->at[(i + 1) % 3], *q = s->at[(i + 2) % 3];
    const float *a = t->at[(k + 1) % 3], *b = t->at[(k + 2) % 3];
    int of_s = axis < 0 ? 0 : csg_orient_along(o, p, q, axis);
    *known = of_s;
    if (!*known)
        return false;
    int of_t = csg_orient_along(o, a, b, axis);
    /* counter-clockwise, both */
    const float *first[2] = {of_s > 0 ? p : q, of_t > 0 ? a : b};
    const float *last[2] = {of_s > 0 ? q : p, of_t > 0 ? b : a};
    int ff = csg_orient_along(o, first[0], first[1], axis);
    int fl = csg_orient_along(o, first[0], last[1], axis);
    int lf = csg_orient_along(o, last[0], first[1], axis);
    int ll = csg_orient_along(o, last[0], last[1], axis);
    return (ff >= 0 && lf <= 0) || (fl >= 0 && ll <= 0) || (ff <= 0 && fl >= 0) ||
           (lf <= 0 && ll >= 0);
}

/* At a vertex of both: does what is opposite to it in one meet the other? */
static bool meet_at_vertex(const csg_exact_triangle *s, int i, const csg_exact_triangle *t, int k)
{
    const float *p = s->at[(i + 1) % 3], *q = s->at[(i + 2) % 3];
    int above = side_of(t, p), below = side_of(t, q);
    if (above * below > 0)
        return false;
    if (!above && !below) {
        bool known, meet = angles_meet(s, i, t, k, &known);
        if (known)
            return meet;
    }
    if (pierces(p, q, above, below, t))
        return true;
    p = t->at[(k + 1) % 3], q = t->at[(k + 2) % 3];
    return pierces(p, q, side_of(s, p), side_of(s, q), s);
}

static bool meet_apart(const csg_exact_triangle *s, const csg_exact_triangle *t)
{
    int of_s[3], of_t[3];
    for (int k = 0; k < 3; k++)
        of_s[k] = side_of(t, s->at[k]);
    if (of_s[0] == of_s[1] && of_s[1] == of_s[2] && of_s[0])
        return false;
    for (int k = 0; k < 3; k++)
        of_t[k] = side_of(s, t->at[k]);
    if (of_t[0] == of_t[1] && of_t[1] == of_t[2] && of_t[0])
        return false;
    for (int k = 0; k < 3; k++) {
        int next = (k + 1) % 3;
        if (pierces(s->at[k], s->at[next], of_s[k], of_s[next], t) ||
            pierces(t->at[k], t->at[next], of_t[k], of_t[next], s))
            return true;
    }
    return false;
}

static int shared_vertices(const csg_exact_triangle *s, const csg_exact_triangle *t, int in_s[3],
                           int in_t[3])
{
    int shared = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            if (s->vertex[i] == t->vertex[k] && shared < 3) {
                in_s[shared] = i;
                in_t[shared++] = k;
            }
    return shared;
}

bool csg_exact_meet(const csg_exact_triangle *s, const csg_exact_triangle *t)
{
    int in_s[3], in_t[3];
    if (boxes_apart(s, t, 0))
        return false;
    int shared = shared_vertices(s, t, in_s, in_t);
    if (shared == 3)
        return true;
    if (shared == 2)
        return is_folded(s->at[in_s[0]], s->at[in_s[1]], s->at[3 - in_s[0] - in_s[1]],
                         t->at[3 - in_t[0] - in_t[1]]);
    return shared ? meet_at_vertex(s, in_s[0], t, in_t[0]) : meet_apart(s, t);
}

/* ---- nearly ------------------------------------------------------------------------------------
 */

/* Whether a point lies so near to a triangle. */
static bool is_near(const csg_exact_triangle *t, const float at[3], double reach)
{
    csg_vec3 v[3], p = csg_vec3_from_floats(at);
    for (int k = 0; k < 3; k++)
        v[k] = csg_vec3_from_floats(t->at[k]);
    csg_vec3 n = csg_vec3_cross(csg_vec3_sub(v[1], v[0]), csg_vec3_sub(v[2], v[0]));
    double norm = csg_vec3_norm(n);
    if (!(fabs(csg_vec3_dot(n, csg_vec3_sub(p, v[0]))) <= reach * norm))
        return false;
    for (int k = 0; k < 3; k++) {
        csg_vec3 edge = csg_vec3_sub(v[k == 2 ? 0 : k + 1], v[k]);
        double turn = csg_vec3_dot(csg_vec3_cross(edge, csg_vec3_sub(p, v[k])), n);
        if (!(turn >= -reach * norm * csg_vec3_norm(edge)))
            return false;
    }
    return true;
}

/* Whether two segments pass one another so near; parallel ones do at an end, if at all. */
static bool pass_near(const float a[3], const float b[3], const float c[3], const float d[3],
                      double reach)
{
    csg_vec3 u = csg_vec3_sub(csg_vec3_from_floats(b), csg_vec3_from_floats(a)),
             v = csg_vec3_sub(csg_vec3_from_floats(d), csg_vec3_from_floats(c));
    csg_vec3 w = csg_vec3_sub(csg_vec3_from_floats(c), csg_vec3_from_floats(a)),
             n = csg_vec3_cross(u, v);
    double square = csg_vec3_dot(n, n), apart = csg_vec3_dot(w, n);
    double parallel = 1e-12 * csg_vec3_dot(u, u) * csg_vec3_dot(v, v);
    if (!(square > parallel && apart * apart <= reach * reach * square))
        return false;
    double along_u = csg_vec3_dot(csg_vec3_cross(w, v), n);
    double along_v = csg_vec3_dot(csg_vec3_cross(w, u), n);
    return along_u >= 0 && along_u <= square && along_v >= 0 && along_v <= square;
}

bool csg_exact_nearly_meet(const csg_exact_triangle *s, const csg_exact_triangle *t, double reach)
{
    int in_s[3], in_t[3];
    if (boxes_apart(s, t, (float)reach) || shared_vertices(s, t, in_s, in_t))
        return false;
    for (int k = 0; k < 3; k++)
        if (is_near(t, s->at[k], reach) || is_near(s, t->at[k], reach))
            return true;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            if (pass_near(s->at[i], s->at[(i + 1) % 3], t->at[k], t->at[(k + 1) % 3], reach))
                return true;
    return false;
}
