/* SPDX-License-Identifier: MIT
 * Bounds of formulas over a box, and their Lipschitz constants: found, or tried where somebody
 * states one. The box is split where the bound of the gradient's length is largest, until that is
 * tight, or small enough for the constant, or enough parts were made.
 *
 * What refutes a constant is no derivative, which at kinks may belong to neither side, but two
 * points whose values, as intervals, lie too far apart. Where to look for them the derivatives say.
 */
#include <float.h>

#include "scene/formula/formula_bound.h"

enum {
    MOST_PARTS = 1024,
    MOST_WORK = 1 << 20, /* parts times steps */
    FEWEST_PARTS = 16,
    SAMPLES = 512, /* and at most as many as parts */
    MOST_ATTEMPTS = 16
};

/* A constant holds up to that rounding, and is refuted by more than this. */
#define ROUNDING 1e-9
#define TOO_MUCH 1e-6

typedef struct slope_part {
    csg_box box;
    double length;
} slope_part;

typedef struct slope_search {
    const csg_formula_step *steps;
    uint32_t count, most;
    csg_box box;
    slope_part *parts; /* the memory is one with that of bounds and work */
    csg_formula_bound *bounds;
    csg_formula_dual *work;
    csg_vec3 place, along; /* where the steepest slope was seen, and its direction */
    double seen, certain;  /* that slope, and what is certain there */
    uint32_t attempts;     /* to be certain */
} slope_search;

static size_t search_bytes(const slope_search *s)
{
    return s->most * sizeof *s->parts + s->count * (sizeof *s->bounds + sizeof *s->work);
}

static bool begin_search(slope_search *s, csg_memory *memory, const csg_formula_step *steps,
                         uint32_t count, csg_box box)
{
    uint32_t most = MOST_WORK / count;
    most = most > MOST_PARTS ? MOST_PARTS : most < FEWEST_PARTS ? FEWEST_PARTS : most;
    *s = (slope_search){.steps = steps, .count = count, .most = most, .box = box};
    s->parts = csg_memory_alloc(memory, search_bytes(s));
    if (!s->parts)
        return false;
    s->bounds = (csg_formula_bound *)(s->parts + most);
    s->work = (csg_formula_dual *)(s->bounds + count);
    return true;
}

static double bound_on(slope_search *s, csg_box box)
{
    return csg_formula_bound_on_box(s->steps, s->count, box, s->bounds);
}

/* Halves of a box across its longest side. */
static void halve(csg_box box, csg_box *low, csg_box *high)
{
    csg_vec3 size = csg_box_size(box), middle = csg_box_center(box);
    *low = *high = box;
    if (size.x >= size.y && size.x >= size.z)
        low->max.x = high->min.x = middle.x;
    else if (size.y >= size.z)
        low->max.y = high->min.y = middle.y;
    else
        low->max.z = high->min.z = middle.z;
}

/* The slope at a point: hardly a Lipschitz constant is less. */
static void look_at(slope_search *s, csg_vec3 p)
{
    csg_formula formula = {.count = s->count, .bounds = csg_box_all()};
    csg_vec3 gradient = csg_formula_evaluate(s->steps, &formula, p, s->work).gradient;
    double slope = csg_vec3_norm(gradient);
    if (!(slope > s->seen))
        return;
    s->seen = slope;
    s->place = p;
    s->along = csg_vec3_scale(gradient, 1 / slope);
}

/* Points spread over the box: intervals may know nothing where they lead. */
static void look_around(slope_search *s)
{
    const double steps[3] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703}; /* R3 */
    csg_vec3 size = csg_box_size(s->box);
    for (uint32_t i = 0; i < SAMPLES && i < s->most; i++) {
        double at[3];
        for (int axis = 0; axis < 3; axis++)
            at[axis] = fmod(0.5 + i * steps[axis], 1);
        look_at(s, csg_vec3_add(s->box.min,
                                csg_vec3_make(at[0] * size.x, at[1] * size.y, at[2] * size.z)));
    }
}

static csg_formula_range value_at(slope_search *s, csg_vec3 p)
{
    bound_on(s, (csg_box){p, p});
    return s->bounds[s->count - 1].value;
}

static csg_vec3 within(csg_box box, csg_vec3 p)
{
    return csg_vec3_make(fmin(fmax(p.x, box.min.x), box.max.x),
                         fmin(fmax(p.y, box.min.y), box.max.y),
                         fmin(fmax(p.z, box.min.z), box.max.z));
}

/* The largest slope between two points beside the place that is certain; 0: none is. */
static double certain_slope(slope_search *s)
{
    double width = csg_box_longest_side(s->box), most = 0;
    for (int i = 0; i < 12; i++, width /= 8) {
        csg_vec3 half = csg_vec3_scale(s->along, width / 16);
        csg_vec3 p = within(s->box, csg_vec3_sub(s->place, half));
        csg_vec3 q = within(s->box, csg_vec3_add(s->place, half));
        csg_formula_range a = value_at(s, p), b = value_at(s, q);
        double apart = csg_vec3_norm(csg_vec3_sub(q, p)) * (1 + 8 * DBL_EPSILON);
        double slope = fmax(b.low - a.high, a.low - b.high) / apart; /* NaN where one is unknown */
        most = fmax(most, isfinite(slope) ? slope * (1 - 8 * DBL_EPSILON) : 0);
    }
    return most;
}

static uint32_t worst_part(const slope_search *s, uint32_t used)
{
    uint32_t worst = 0;
    for (uint32_t i = 1; i < used; i++)
        if (s->parts[i].length > s->parts[worst].length)
            worst = i;
    return worst;
}

/* Do two points near the steepest slope that was seen refute the constant for certain? */
static bool is_refuted(slope_search *s, double limit)
{
    if (!(s->seen > limit) || s->attempts == MOST_ATTEMPTS)
        return false;
    s->attempts++;
    s->certain = certain_slope(s);
    if (!(s->certain > limit))
        s->seen = 0; /* a kink, or hardly more than the limit: another place may show more */
    return s->certain > limit;
}

/* Splits the part with the largest bound, again and again, until that is at most `enough` or slopes
 * beyond `limit` are certain. 0 for enough: until the bound is tight. */
static double refine(slope_search *s, double enough, double limit)
{
    const double tight = 1.02;
    s->parts[0] = (slope_part){s->box, bound_on(s, s->box)};
    for (uint32_t used = 1;; used++) {
        uint32_t worst = worst_part(s, used);
        csg_box box = s->parts[worst].box;
        double length = s->parts[worst].length;
        if (length <= enough || !csg_box_is_finite(box))
            return length;
        look_at(s, csg_box_center(box));
        bool done = enough > 0 ? is_refuted(s, limit) : length <= tight * s->seen;
        if (used == s->most || done)
            return length;
        halve(box, &s->parts[worst].box, &s->parts[used].box);
        s->parts[worst].length = bound_on(s, s->parts[worst].box);
        s->parts[used].length = bound_on(s, s->parts[used].box);
    }
}

double csg_formula_lipschitz(csg_memory *memory, const csg_formula_step *steps, uint32_t count,
                             csg_box box)
{
    slope_search s;
    if (!begin_search(&s, memory, steps, count, box))
        return NAN;
    double length = refine(&s, 0, INFINITY);
    csg_memory_release(memory, s.parts, search_bytes(&s));
    return length;
}

static csg_slope_trial try_constant(slope_search *s, double stated)
{
    const double enough = stated * (1 + ROUNDING), limit = stated * (1 + TOO_MUCH);
    csg_slope_trial trial = {.bound = INFINITY, .verdict = CSG_SLOPE_REFUTED};
    if (csg_box_is_finite(s->box))
        look_around(s);
    if (!is_refuted(s, limit)) {
        trial.bound = refine(s, enough, limit);
        if (trial.bound <= enough)
            trial.verdict = CSG_SLOPE_PROVEN;
        else if (!(s->certain > limit))
            trial.verdict = CSG_SLOPE_UNDECIDED;
    }
    trial.place = s->place;
    trial.slope = s->certain;
    return trial;
}

csg_slope_trial csg_formula_try_lipschitz(csg_memory *memory, const csg_formula_step *steps,
                                          uint32_t count, csg_box box, double stated)
{
    slope_search s;
    if (!begin_search(&s, memory, steps, count, box))
        return (csg_slope_trial){.verdict = CSG_SLOPE_UNDECIDED, .bound = NAN};
    csg_slope_trial trial = try_constant(&s, stated);
    csg_memory_release(memory, s.parts, search_bytes(&s));
    return trial;
}

/* Parts of equal shape, so many halvings deep; one where the box has no end. */
static void widen(slope_search *s, csg_box box, int depth, double values[2])
{
    csg_box low, high;
    if (depth == 0 || !csg_box_is_finite(box)) {
        bound_on(s, box);
        csg_formula_range range = s->bounds[s->count - 1].value;
        bool known = !isnan(range.low) && !isnan(range.high);
        values[0] = known ? fmin(values[0], range.low) : -INFINITY;
        values[1] = known ? fmax(values[1], range.high) : INFINITY;
        return;
    }
    halve(box, &low, &high);
    widen(s, low, depth - 1, values);
    widen(s, high, depth - 1, values);
}

bool csg_formula_values(csg_memory *memory, const csg_formula_step *steps, uint32_t count,
                        csg_box box, double values[2])
{
    slope_search s;
    int depth = 0;
    if (!begin_search(&s, memory, steps, count, box))
        return false;
    while (2u << depth <= s.most)
        depth++;
    values[0] = INFINITY;
    values[1] = -INFINITY;
    widen(&s, box, depth, values);
    csg_memory_release(memory, s.parts, search_bytes(&s));
    return true;
}
