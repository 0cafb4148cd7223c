/* SPDX-License-Identifier: MIT
 * Area by cubes; see area.h.
 *
 * Let s be a unit vector, the same all over a cube. By the divergence theorem what of s flows out
 * of the solid through the cube's faces flows into it through its surface in the cube, and there
 * s . n is the cosine between s and the surface's inward normal n: so the surface's area is at
 * least that flow, and at most one over the least cosine times it, which is 1 + O(h^2). The flow
 * is made of how much of each face is in the solid, each known between bounds.
 *
 * Two cubes share a face, and what is not known of it takes part with the difference of their s
 * alone, which is O(h), too. So cubes tell their parent how much of their faces is in the solid,
 * and what the area is beside the flow of a vector that is theirs; the parent has a vector of its
 * own and adds the flow of the differences. In the root that is the whole.
 *
 * Where surfaces meet, s is 0, and each group of pieces (section.h) is seen along its own normal.
 */
#include "measure/area.h"

#include <math.h>
#include <string.h>

#include "measure/graph.h"
#include "measure/graph_field.h"
#include "measure/rounds.h"
#include "measure/section.h"

/* Of what a cube may leave open: a face of it that is known so closely is known. */
static const double FACE_CLOSE = 0.03;

enum {
    FACES = 6,
    UNBOUNDED_DEEPEST = 12 /* levels, where nothing bounds the area: that may be so at any size */
};

/* Of a gradient: from where on how far others are from it tells nothing of use. */
static const double STRAY_MOST = 0.9;

/* A cube: its surface's area is within [low, high] + the flow of s out of the solid in it. */
typedef struct account {
    csg_section faces[FACES]; /* in the solid; 2 * axis + (1: the side of larger coordinates) */
    double s[3], low, high;
    double size;       /* of all that was added up: what its rounding is counted from */
    bool is_unbounded; /* somewhere in it nothing bounds the area, and nothing is in `high` */
} account;

typedef struct job {
    const csg_area_selection *selection;
    double tolerance, of;
    csg_area_bounds *out;
} job;

static double face_of(double half)
{
    return 4 * half * half;
}

static account plain(double half, csg_cell_state state)
{
    account a = {.low = 0};
    double area = state == CSG_CELL_INSIDE ? face_of(half) : 0;
    for (int i = 0; i < FACES; i++)
        a.faces[i] = (csg_section){area, area};
    return a;
}

/* Nothing is known. */
static account unknown(double half)
{
    account a = {.is_unbounded = true};
    for (int i = 0; i < FACES; i++)
        a.faces[i] = (csg_section){0, face_of(half)};
    return a;
}

/* Of a vector, out of the solid through the cube's faces: at least and at most. */
static csg_section flow_of(const account *a, const double v[3])
{
    csg_section flow = {0, 0};
    for (int i = 0; i < FACES; i++) {
        double through = i & 1 ? v[i / 2] : -v[i / 2];
        flow.least += through * (through > 0 ? a->faces[i].least : a->faces[i].most);
        flow.most += through * (through > 0 ? a->faces[i].most : a->faces[i].least);
    }
    return flow;
}

/* A vector for the parent, in the middle of the children's, and the flow of what they differ by. */
static account joined(const account children[CSG_OCTANTS])
{
    account a = {.low = 0};
    int count = 0;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        const double *s = children[o].s;
        count += s[0] != 0 || s[1] != 0 || s[2] != 0;
        for (int k = 0; k < 3; k++) {
            a.s[k] += s[k];
            int face = 2 * k + (o >> k & 1);
            a.faces[face].least += children[o].faces[face].least;
            a.faces[face].most += children[o].faces[face].most;
        }
    }
    for (int k = 0; k < 3; k++)
        a.s[k] /= count ? count : 1;
    for (int o = 0; o < CSG_OCTANTS; o++) {
        const account *child = &children[o];
        const double change[3] = {child->s[0] - a.s[0], child->s[1] - a.s[1], child->s[2] - a.s[2]};
        csg_section flow = flow_of(child, change);
        a.low += child->low + flow.least;
        a.high += child->high + flow.most;
        a.is_unbounded |= child->is_unbounded;
        for (int i = 0; i < FACES; i++)
            a.size += fabs(change[i / 2]) * child->faces[i].most;
        a.size += child->size;
    }
    return a;
}

/* What is known of it in any case: a convex solid's surface in a cube is no larger than the
 * cube's. */
static double most_of(const csg_section_group *g, double half)
{
    return g->is_convex ? FACES * face_of(half) * g->count : INFINITY;
}

static void add_up_to(account *a, double most)
{
    a->is_unbounded |= !isfinite(most);
    a->high += isfinite(most) ? most : 0;
}

/* A component that is `at`, of a unit vector that turns by an angle of that cosine at most. */
static csg_truth turned_within(double at, double cosine, double least, double most)
{
    static const double ROUNDING = 1e-7;
    double sine = sqrt(fmax(1 - cosine * cosine, 0)), rest = sqrt(fmax(1 - at * at, 0));
    double low = at <= -cosine ? -1 : at * cosine - rest * sine - ROUNDING;
    double high = at >= cosine ? 1 : at * cosine + rest * sine + ROUNDING;
    if (high < least || low > most)
        return CSG_TRUTH_NO;
    return low >= fmax(least, -1) && high <= fmin(most, 1) ? CSG_TRUTH_YES : CSG_TRUTH_OPEN;
}

/* Heights that the group's pieces have in the cube, along the selection's direction. */
static csg_truth is_low(const csg_area_selection *by, const csg_measure_cube *q,
                        const csg_halves *halves, const csg_section_group *g)
{
    const csg_enclosure *e = &halves->planes[g->first];
    double along = 0, rest = 0, height = 0, length = 0;
    for (int k = 0; k < 3; k++) {
        along += by->direction[k] * g->direction[k];
        height += by->direction[k] * q->c[k];
        length += e->slope[k] * g->direction[k];
    }
    for (int k = 0; k < 3; k++) {
        double across = by->direction[k] - along * g->direction[k];
        rest += across * across;
    }
    height -= along * e->value / length;
    double room =
        (fabs(along) * g->width + sqrt(rest) * csg_enclosure_radius(q->half)) * (1 + 1e-9);
    return height + room <= by->level_low   ? CSG_TRUTH_YES
           : height - room > by->level_high ? CSG_TRUTH_NO
                                            : CSG_TRUTH_OPEN;
}

static csg_truth is_selected(const job *j, const csg_measure_cube *q, const csg_halves *halves,
                             const csg_section_group *g)
{
    const csg_area_selection *by = j->selection;
    double at = 0;
    if (!by)
        return CSG_TRUTH_YES;
    for (int k = 0; k < 3; k++)
        at -= by->direction[k] * g->direction[k];
    csg_truth turned =
        g->cosine > 0 ? turned_within(at, g->cosine, by->least, by->most) : CSG_TRUTH_OPEN;
    csg_truth low = by->level_low < INFINITY ? is_low(by, q, halves, g) : CSG_TRUTH_YES;
    if (turned == CSG_TRUTH_NO || low == CSG_TRUTH_NO)
        return CSG_TRUTH_NO;
    return turned == CSG_TRUTH_YES && low == CSG_TRUTH_YES ? CSG_TRUTH_YES : CSG_TRUTH_OPEN;
}

/* One group alone can be the surface: it is a graph. excess: what its area is beside its flow, as
 * far as that is known otherwise. */
static void take_graph(const csg_section_group *g, double half, csg_truth selected,
                       csg_section excess, account *a)
{
    double most = most_of(g, half), flow = fmax(flow_of(a, g->direction).most, 0);
    double more = fmin(g->cosine > 0 ? (1 / g->cosine - 1) * flow : INFINITY, excess.most);
    if (selected == CSG_TRUTH_NO)
        return;
    if (selected == CSG_TRUTH_YES && flow + more <= most) {
        memcpy(a->s, g->direction, sizeof a->s);
        a->low += fmin(excess.least, more);
        add_up_to(a, more);
    } else {
        add_up_to(a, fmin(flow + more, most));
    }
}

/* Several may meet. */
static void take_group(const csg_halves *halves, double half, const csg_section_group *g,
                       csg_truth selected, account *a)
{
    if (selected == CSG_TRUTH_NO)
        return;
    csg_section seen = csg_section_of_group(halves, half, g);
    a->low += selected == CSG_TRUTH_YES ? seen.least : 0;
    add_up_to(a, fmin(most_of(g, half), seen.most > 0 ? seen.most / g->cosine : 0));
}

/* How much of the cube's faces is in the solid. f: the field's models, or NULL; they know that
 * closer than planes do. */
static void find_faces(double half, const csg_halves *halves, const csg_taylor_pieces *f,
                       double enough, account *a)
{
    double whole = face_of(half), area, error;
    for (int i = 0; i < FACES; i++) {
        int axis = i / 2, side = i & 1 ? 1 : -1;
        csg_section *face = &a->faces[i];
        *face = (csg_section){0, whole};
        if (f && csg_graph_face(f, half, axis, side, enough, &area, &error))
            *face = (csg_section){fmax(area - error, 0), fmin(area + error, whole)};
        if (face->most - face->least <= FACE_CLOSE * enough && f)
            continue;
        csg_section planes = csg_section_of_face(halves, half, axis, side);
        face->least = fmax(face->least, planes.least);
        face->most = fmin(face->most, planes.most);
    }
}

/* The planes around all pieces of a field, whose gradients are known all over the cube. False: they
 * turn too far to be of use. */
static bool enclose_smooth(const csg_measure_cube *q, const csg_taylor_pieces *f,
                           csg_halves *halves)
{
    double radius = csg_enclosure_radius(q->half);
    csg_enclosure *e = &halves->planes[0];
    *e = (csg_enclosure){.value = 0};
    for (int i = 0; i < f->count; i++) {
        e->value += f->of[i].f.value / f->count;
        for (int k = 0; k < 3; k++)
            e->slope[k] += f->of[i].f.slope[k] / f->count;
    }
    for (int i = 0; i < f->count; i++) {
        csg_taylor rest = f->of[i].f;
        rest.value -= e->value;
        for (int k = 0; k < 3; k++)
            rest.slope[k] -= e->slope[k];
        e->below = fmax(e->below, -csg_taylor_least(&rest, radius));
        e->above = fmax(e->above, csg_taylor_most(&rest, radius));
        e->stray = fmax(e->stray, csg_norm3(rest.slope) + csg_taylor_stray(&f->of[i].f, radius));
    }
    halves->plane_count = halves->length = 1;
    halves->code[0] = 0;
    return e->stray < STRAY_MOST * csg_norm3(e->slope);
}

/* Where nothing else bounds the area: at a crease that pieces meet in at a wide angle. */
static void take_pieces(const csg_taylor_pieces *f, double half, account *a)
{
    double most = csg_graph_area_most(f, half, STRAY_MOST);
    if (!isfinite(most))
        return;
    memset(a->s, 0, sizeof a->s);
    a->low = 0;
    a->high = most;
    a->is_unbounded = false;
}

static csg_section excess_of(const csg_taylor_pieces *f, const double slope[3], double half,
                             double enough)
{
    csg_section excess;
    bool is_known = f && csg_graph_excess(f, slope, half, enough, &excess.least, &excess.most);
    return is_known ? excess : (csg_section){0, INFINITY};
}

/* turn: how far neighbours' s may be from this one's. enough: of what leaves more open nothing is
 * known, as it is divided; 0: it is not. */
static account find_account(const job *j, const csg_measure_cube *q, const csg_halves *halves,
                            const csg_taylor_pieces *f, double enough, double *turn)
{
    csg_section_group groups[CSG_HALVES_MOST];
    double half = q->half;
    int count = csg_section_find_groups(halves, half, groups);
    account a = {.low = 0};
    *turn = 1;
    if (count != 1) {
        find_faces(half, halves, NULL, enough, &a);
        for (int i = 0; i < count; i++)
            take_group(halves, half, &groups[i], is_selected(j, q, halves, &groups[i]), &a);
        return a;
    }
    double cosine = groups[0].cosine;
    csg_truth selected = is_selected(j, q, halves, &groups[0]);
    csg_section excess = excess_of(f, halves->planes[0].slope, half, enough);
    bool is_bounded = selected == CSG_TRUTH_YES && isfinite(excess.most);
    if (is_bounded && enough > 0 && excess.most - excess.least > enough)
        return unknown(half);
    if (selected == CSG_TRUTH_NO)
        *turn = 0;
    else if (selected == CSG_TRUTH_YES)
        *turn = fmin(1, sqrt(fmax(1 - cosine * cosine, 0)));
    find_faces(half, halves, f, enough, &a);
    take_graph(&groups[0], half, selected, excess, &a);
    return a;
}

/* What the cube leaves open of the area, about. */
static double open_of(const account *a, double turn)
{
    double strips = 0;
    for (int i = 0; i < FACES; i++)
        strips += a->faces[i].most - a->faces[i].least;
    return a->high - a->low + strips * turn;
}

static void settle_plain(const void *user, const csg_measure_cube *q, void *out)
{
    *(account *)out = plain(q->half, q->state);
}

static void leave_open(const void *user, const csg_measure_cube *q, void *out)
{
    *(account *)out = unknown(q->half);
}

static double settle(const void *user, const csg_measure_walk *walk, csg_measure_worker *worker,
                     csg_measure_cube *q, void *out)
{
    csg_halves halves;
    csg_taylor_pieces f; /* not filled: they are large */
    double turn = 1;
    account *a = out;
    bool has_pieces = csg_graph_field_pieces(&q->tape, q->c, q->half, &f);
    bool is_smooth = has_pieces && enclose_smooth(q, &f, &halves);
    if (is_smooth)
        csg_measure_take_state(q, &halves);
    if (!is_smooth && !csg_measure_enclose_with_strays(walk, worker, q, &halves))
        *a = unknown(q->half);
    else if (q->state != CSG_CELL_SURFACE)
        *a = plain(q->half, q->state);
    else
        *a = find_account(user, q, &halves, is_smooth ? &f : NULL, worker->enough, &turn);
    if (a->is_unbounded && has_pieces)
        take_pieces(&f, q->half, a);
    return a->is_unbounded && q->level < UNBOUNDED_DEEPEST ? INFINITY : open_of(a, turn);
}

static void turn(const csg_symmetry *by, const void *of, void *out)
{
    const account *from = of;
    account *to = out;
    *to = *from;
    csg_symmetry_map(by, from->s, to->s);
    for (int i = 0; i < FACES; i++) {
        int side = by->sign[i / 2] > 0 ? i & 1 : 1 - (i & 1);
        to->faces[i] = from->faces[2 * by->axes[i / 2] + side];
    }
}

static bool is_kept(const void *user, const csg_symmetry *by)
{
    const job *j = user;
    return !j->selection || csg_symmetry_keeps(by, j->selection->direction);
}

static void combine(const void *user, const void *octants, void *out)
{
    *(account *)out = joined(octants);
}

/* With room for all rounding: a sum of n terms is off by at most n units in the last place of the
 * sum of their sizes (Higham 2002, 4.2), and a term has a few of its own. What nothing bounds is
 * not waited for. */
static double conclude(void *user, const void *of, const csg_rounds_counts *counts)
{
    const job *j = user;
    const account *root = of;
    csg_area_bounds *out = j->out;
    csg_section flow = flow_of(root, root->s);
    double low = root->low + flow.least, high = root->high + flow.most;
    double terms = 64 * ((double)counts->longest + 16);
    double slack = terms * 0x1p-52 * (root->size + fabs(low) + fabs(high));
    out->low = fmax(low - slack, out->low);
    out->high = fmin(root->is_unbounded ? INFINITY : high + slack, out->high);
    out->is_proven = true;
    out->cubes = counts->cubes;
    double open = high + 2 * slack - low;
    return j->tolerance * (j->of > 0 ? j->of : out->low + open) / open;
}

csgm_status csg_measure_area(csg_measure_walk *walk, const csg_area_selection *selection,
                             double tolerance, double of, uint64_t most_cubes, csg_area_bounds *out)
{
    job j = {.selection = selection, .tolerance = tolerance, .of = of, .out = out};
    const csg_rounds_job rounds = {.account_bytes = sizeof(account),
                                   .share = FACES * face_of(walk->half) * 0x1p-12,
                                   .user = &j,
                                   .settle_plain = settle_plain,
                                   .leave_open = leave_open,
                                   .settle = settle,
                                   .turn = turn,
                                   .is_kept = is_kept,
                                   .combine = combine,
                                   .conclude = conclude};
    *out = (csg_area_bounds){.high = INFINITY};
    return csg_measure_rounds(walk, &rounds, most_cubes);
}
