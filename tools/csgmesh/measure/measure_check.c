/* SPDX-License-Identifier: MIT
 * Conditions on measures; see measure_check.h. They are decided while they are read: first of
 * measures of which nothing is known, for mistakes, then of what was measured.
 */
#include "measure/measure_check.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/options.h"

/* What conditions call them, where they stand in cli_figures, and of which group they are. */
#define EACH_MEASURE(M)                                                                            \
    M(volume, measures.volume, 0)                                                                  \
    M(mass, measures.mass, 0)                                                                      \
    M(centroid_x, measures.centroid[0], 0)                                                         \
    M(centroid_y, measures.centroid[1], 0)                                                         \
    M(centroid_z, measures.centroid[2], 0)                                                         \
    M(inertia_xx, measures.inertia[0], 0)                                                          \
    M(inertia_yy, measures.inertia[1], 0)                                                          \
    M(inertia_zz, measures.inertia[2], 0)                                                          \
    M(inertia_xy, measures.inertia[3], 0)                                                          \
    M(inertia_xz, measures.inertia[4], 0)                                                          \
    M(inertia_yz, measures.inertia[5], 0)                                                          \
    M(moment_1, measures.moments[0], 0)                                                            \
    M(moment_2, measures.moments[1], 0)                                                            \
    M(moment_3, measures.moments[2], 0)                                                            \
    M(area, measures.area, 0)                                                                      \
    M(min_x, measures.bounds[0], 0)                                                                \
    M(min_y, measures.bounds[1], 0)                                                                \
    M(min_z, measures.bounds[2], 0)                                                                \
    M(max_x, measures.bounds[3], 0)                                                                \
    M(max_y, measures.bounds[4], 0)                                                                \
    M(max_z, measures.bounds[5], 0)                                                                \
    M(box_volume, box.volume, CLI_FIGURES_BOX)                                                     \
    M(box_1, box.edges[0], CLI_FIGURES_BOX)                                                        \
    M(box_2, box.edges[1], CLI_FIGURES_BOX)                                                        \
    M(box_3, box.edges[2], CLI_FIGURES_BOX)                                                        \
    M(overhang, faces.overhang, CLI_FIGURES_FACES)                                                 \
    M(resting, faces.resting, CLI_FIGURES_FACES)                                                   \
    M(steep, faces.steep, CLI_FIGURES_FACES)                                                       \
    M(wall, walls.wall.length, CLI_FIGURES_WALLS)                                                  \
    M(gap, walls.gap.length, CLI_FIGURES_WALLS)

static const char *const sizes[] = {"size_x", "size_y", "size_z"};

static const char *const names[] = {
#define NAME(name, field, group) #name,
    EACH_MEASURE(NAME)
#undef NAME
        "size_x",
    "size_y", "size_z", NULL};

/* What a stretch of the text means: a number between two, or a truth. */
typedef struct meaning {
    bool is_truth;
    cli_truth truth;
    csgm_interval number;
} meaning;

typedef struct reader {
    const char *text, *at;
    const cli_figures *figures; /* NULL: nothing is known */
    unsigned groups;            /* of what is named */
    const char *fault, *hint;   /* the first mistake, and at: its place */
    int depth;
    cli_checks *out; /* NULL: none is kept */
    bool out_of_memory;
} reader;

static meaning read_any(reader *r);

/* ---- intervals ---------------------------------------------------------------------------------
 * Every end is moved outward by more than it was rounded.
 */

static csgm_interval outward(double low, double high)
{
    if (!(low <= high)) /* infinity - infinity, 0 * infinity */
        return (csgm_interval){-INFINITY, INFINITY};
    return (csgm_interval){nextafter(low, -INFINITY), nextafter(high, INFINITY)};
}

static csgm_interval product(csgm_interval a, csgm_interval b)
{
    const double ends[4] = {a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high};
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < 4; i++) {
        if (isnan(ends[i]))
            return outward(-INFINITY, INFINITY);
        low = fmin(low, ends[i]);
        high = fmax(high, ends[i]);
    }
    return outward(low, high);
}

static csgm_interval quotient(csgm_interval a, csgm_interval b)
{
    if (b.low <= 0 && b.high >= 0)
        return outward(-INFINITY, INFINITY);
    return product(a, outward(1 / b.high, 1 / b.low));
}

static csgm_interval difference(csgm_interval a, csgm_interval b)
{
    return outward(a.low - b.high, a.high - b.low);
}

/* ---- reading -----------------------------------------------------------------------------------
 */

static meaning fail(reader *r, const char *at, const char *fault, const char *hint)
{
    if (!r->fault) {
        r->fault = fault;
        r->hint = hint;
        r->at = at;
    }
    return (meaning){0};
}

static void skip_spaces(reader *r)
{
    r->at += strspn(r->at, " \t\r\n");
}

static bool take(reader *r, const char *token)
{
    skip_spaces(r);
    size_t length = strlen(token);
    if (r->fault || strncmp(r->at, token, length) != 0)
        return false;
    r->at += length;
    return true;
}

static csgm_interval number_of(reader *r, const char *at, meaning m)
{
    if (m.is_truth && !r->fault)
        fail(r, at, "a number is needed here, not a condition", NULL);
    return m.number;
}

static cli_truth truth_of(reader *r, const char *at, meaning m)
{
    if (!m.is_truth && !r->fault)
        fail(r, at, "a comparison is needed here, as volume < 1000", NULL);
    return m.truth;
}

static bool find_measure(const cli_figures *f, const char *name, csgm_interval *out,
                         unsigned *groups)
{
#define FIND(its_name, field, group)                                                               \
    if (strcmp(name, #its_name) == 0) {                                                            \
        *out = f->field;                                                                           \
        *groups |= group;                                                                          \
        return true;                                                                               \
    }
    EACH_MEASURE(FIND)
#undef FIND
    for (int axis = 0; axis < 3; axis++)
        if (strcmp(name, sizes[axis]) == 0) {
            *out = difference(f->measures.bounds[axis + 3], f->measures.bounds[axis]);
            return true;
        }
    return false;
}

static meaning read_name(reader *r)
{
    static const char LETTERS[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789";
    enum { LONGEST = 40 };
    const char *at = r->at;
    size_t length = strspn(at, LETTERS);
    const cli_figures unknown = cli_figures_unknown();
    char name[LONGEST];
    meaning m = {.number = {-INFINITY, INFINITY}};
    if (length >= LONGEST)
        return fail(r, at, "no measure has a name as long as that", NULL);
    memcpy(name, at, length);
    name[length] = '\0';
    if (!find_measure(r->figures ? r->figures : &unknown, name, &m.number, &r->groups)) {
        const char *near = cli_nearest(name, names);
        return fail(r, at, "no measure has that name",
                    near ? near
                         : "volume, mass, area, centroid_x, inertia_xx, inertia_xy, moment_1, "
                           "min_x, max_x, size_x, box_1, wall, gap, overhang");
    }
    if (!r->figures)
        m.number = (csgm_interval){-INFINITY, INFINITY};
    r->at += length;
    return m;
}

static meaning read_primary(reader *r)
{
    char *end;
    skip_spaces(r);
    const char *at = r->at;
    if (take(r, "(")) {
        meaning m = read_any(r);
        if (!r->fault && !take(r, ")"))
            return fail(r, r->at, "a parenthesis is not closed before here", NULL);
        return m;
    }
    if ((*at >= '0' && *at <= '9') || *at == '.') {
        double value = strtod(at, &end);
        if (end == at || !isfinite(value))
            return fail(r, at, "this is no number", NULL);
        r->at = end;
        return (meaning){.number = {value, value}};
    }
    if ((*at >= 'a' && *at <= 'z') || (*at >= 'A' && *at <= 'Z') || *at == '_')
        return read_name(r);
    return fail(
        r, at, *at ? "a number or a measure is needed here" : "the condition ends too early", NULL);
}

static meaning read_signed(reader *r)
{
    if (!take(r, "-"))
        return read_primary(r);
    const char *at = r->at;
    csgm_interval n = number_of(r, at, read_primary(r));
    return (meaning){.number = {-n.high, -n.low}};
}

static meaning read_product(reader *r)
{
    skip_spaces(r);
    const char *at = r->at;
    meaning m = read_signed(r);
    for (;;) {
        bool times = take(r, "*");
        if (!times && !take(r, "/"))
            return m;
        const char *next = r->at;
        csgm_interval a = number_of(r, at, m), b = number_of(r, next, read_signed(r));
        m = (meaning){.number = times ? product(a, b) : quotient(a, b)};
    }
}

static meaning read_sum(reader *r)
{
    skip_spaces(r);
    const char *at = r->at;
    meaning m = read_product(r);
    for (;;) {
        bool plus = take(r, "+");
        if (!plus && !take(r, "-"))
            return m;
        const char *next = r->at;
        csgm_interval a = number_of(r, at, m), b = number_of(r, next, read_product(r));
        m = (meaning){.number = plus ? outward(a.low + b.low, a.high + b.high) : difference(a, b)};
    }
}

/* a < b, or a <= b. */
static cli_truth decide(csgm_interval a, csgm_interval b, bool or_equal)
{
    if (or_equal ? a.high <= b.low : a.high < b.low)
        return CLI_HOLDS;
    return (or_equal ? a.low > b.high : a.low >= b.high) ? CLI_FAILS : CLI_UNDECIDED;
}

static meaning read_comparison(reader *r)
{
    skip_spaces(r);
    const char *at = r->at;
    meaning m = read_sum(r);
    skip_spaces(r);
    if (strncmp(r->at, "==", 2) == 0 || strncmp(r->at, "!=", 2) == 0)
        return fail(r, r->at, "what is known to an interval is never proven to be equal",
                    "two comparisons say how near it is to be: volume > 99 && volume < 101");
    bool less = take(r, "<");
    if (!less && !take(r, ">"))
        return m;
    bool or_equal = !r->fault && *r->at == '=';
    r->at += or_equal;
    const char *next = r->at;
    csgm_interval a = number_of(r, at, m), b = number_of(r, next, read_sum(r));
    skip_spaces(r);
    if (*r->at == '<' || *r->at == '>')
        return fail(r, r->at, "one comparison does not go on with another", "join them by &&");
    return (meaning){.is_truth = true,
                     .truth = less ? decide(a, b, or_equal) : decide(b, a, or_equal)};
}

static meaning read_not(reader *r)
{
    if (!take(r, "!"))
        return read_comparison(r);
    const char *at = r->at;
    cli_truth truth = truth_of(r, at, read_comparison(r));
    return (meaning){.is_truth = true, .truth = (cli_truth)(CLI_HOLDS - truth)};
}

static void forget(cli_checks *checks, size_t count)
{
    while (checks->count > count)
        free(checks->items[--checks->count].text);
}

static void keep(reader *r, const char *begin, cli_truth truth)
{
    const char *end = r->at;
    if (!r->out || r->fault || r->depth > 1)
        return;
    while (end > begin && strchr(" \t\r\n", end[-1]))
        end--;
    cli_checks *out = r->out;
    if (out->count == out->capacity) {
        size_t capacity = 2 * out->capacity + 4;
        cli_check *items = realloc(out->items, capacity * sizeof *items);
        if (!items) {
            r->out_of_memory = true;
            return;
        }
        out->items = items;
        out->capacity = capacity;
    }
    char *text = strndup(begin, (size_t)(end - begin));
    r->out_of_memory = r->out_of_memory || !text;
    if (text)
        out->items[out->count++] = (cli_check){text, truth};
}

static meaning read_and(reader *r)
{
    skip_spaces(r);
    const char *at = r->at;
    meaning m = read_not(r);
    skip_spaces(r);
    if (m.is_truth)
        keep(r, at, m.truth);
    while (take(r, "&&")) {
        skip_spaces(r);
        const char *next = r->at;
        cli_truth a = truth_of(r, at, m), b = truth_of(r, next, read_not(r));
        skip_spaces(r);
        keep(r, next, b);
        m = (meaning){.is_truth = true, .truth = a < b ? a : b};
    }
    return m;
}

/* What || joins is one condition. */
static meaning read_any(reader *r)
{
    enum { DEEPEST = 100 };
    size_t before = r->out ? r->out->count : 0;
    skip_spaces(r);
    const char *at = r->at;
    if (++r->depth > DEEPEST)
        return fail(r, at, "parentheses are too deep here", NULL);
    meaning m = read_and(r);
    bool joined = false;
    while (take(r, "||")) {
        skip_spaces(r);
        const char *next = r->at;
        cli_truth a = truth_of(r, at, m), b = truth_of(r, next, read_and(r));
        m = (meaning){.is_truth = true, .truth = a > b ? a : b};
        joined = true;
    }
    if (joined && r->out && r->depth == 1) {
        forget(r->out, before);
        keep(r, at, m.truth);
    }
    r->depth--;
    return m;
}

static void read_condition(reader *r)
{
    meaning m = read_any(r);
    skip_spaces(r);
    truth_of(r, r->text + strspn(r->text, " \t\r\n"), m);
    if (!r->fault && *r->at)
        fail(r, r->at, "the condition should end here", NULL);
}

int cli_checks_read(cli_app *app, const cli_list *texts, unsigned *groups)
{
    for (size_t i = 0; i < texts->count; i++) {
        reader r = {.text = texts->items[i], .at = texts->items[i]};
        read_condition(&r);
        *groups |= r.groups;
        if (!r.fault)
            continue;
        int column = (int)(r.at - r.text);
        cli_console_say(&app->console, CSGM_ERROR, r.hint, "--check: %s\n  %.400s\n  %*s^", r.fault,
                        r.text, column < 400 ? column : 400, "");
        return CLI_TROUBLE;
    }
    return CLI_DONE;
}

bool cli_checks_decide(cli_checks *checks, const cli_list *texts, const cli_figures *figures)
{
    for (size_t i = 0; i < texts->count; i++) {
        reader r = {
            .text = texts->items[i], .at = texts->items[i], .figures = figures, .out = checks};
        read_condition(&r);
        if (r.out_of_memory)
            return false;
    }
    return true;
}

void cli_checks_release(cli_checks *checks)
{
    forget(checks, 0);
    free(checks->items);
    *checks = (cli_checks){0};
}

const char *cli_truth_name(cli_truth truth)
{
    switch (truth) {
    case CLI_FAILS:
        return "fails";
    case CLI_UNDECIDED:
        return "undecided";
    case CLI_HOLDS:
        return "holds";
    }
    return "";
}
