/* SPDX-License-Identifier: MIT
 * Clearances as lines for people.
 */
#include <math.h>
#include <stdio.h>

#include "clear/clear_print.h"
#include "core/interval.h"

enum { FAR_MOST = 20 /* pairs whose boxes are far apart that have lines of their own */ };

cli_verdict cli_verdict_of(const cli_cleared *c, const csgm_clear_pair *pair)
{
    bool is_open = pair->poses_open || (c->between && pair->steps_open);
    return pair->poses_bad ? CLI_PAIR_BAD : is_open ? CLI_PAIR_OPEN : CLI_PAIR_CLEAR;
}

const char *cli_clear_state_name(csgm_clear_state state)
{
    static const char *const names[] = {"apart", "touching", "undecided", "interfering"};
    return names[state];
}

const char *cli_clear_name(const char *name, char text[96])
{
    if (!name)
        return "what is in no part";
    snprintf(text, 96, "\"%.80s\"", name);
    return text;
}

void cli_clear_pose(const cli_cleared *c, const csgm_clear_pair *pair, char *text, size_t size)
{
    char value[CLI_OVER_TEXT];
    text[0] = 0;
    if (c->over->name)
        snprintf(text, size, " at %.60s = %s", c->over->name,
                 cli_over_value(c->over, pair->pose, value));
}

void cli_clear_say_between(const cli_cleared *c, const csgm_clear_pair *p, char *text, size_t size)
{
    char before[CLI_OVER_TEXT], after[CLI_OVER_TEXT], gap[CLI_INTERVAL_TEXT];
    if (p->steps_open)
        snprintf(text, size, "%zu of %zu steps not covered, first %s .. %s", p->steps_open,
                 p->steps, cli_over_value(c->over, p->first_open - 1, before),
                 cli_over_value(c->over, p->first_open, after));
    else if (isinf(p->gap_between))
        snprintf(text, size, "one of them is empty");
    else if (p->gap_between > 0)
        snprintf(text, size, "a gap of at least %s", cli_format_least(gap, p->gap_between, 3));
    else
        snprintf(text, size, "they do not move in relation to each other");
}

void cli_clear_say(const cli_cleared *c, const csgm_clear_pair *pair, char *text, size_t size)
{
    char a[96], b[96], pose[160], gap[CLI_INTERVAL_TEXT];
    cli_clear_name(pair->names[0], a);
    cli_clear_pose(c, pair, pose, sizeof pose);
    const char *first = cli_clear_name(pair->names[0], a),
               *second = cli_clear_name(pair->names[1], b);
    if (pair->state == CSGM_CLEAR_INTERFERING)
        snprintf(text, size, "%s and %s interfere%s", first, second, pose);
    else if (cli_verdict_of(c, pair) == CLI_PAIR_BAD)
        snprintf(text, size, "%s and %s are closer than %g: %g at most%s", first, second,
                 c->min_gap, pair->gap.high, pose);
    else if (!pair->poses_open) {
        cli_clear_say_between(c, pair, gap, sizeof gap);
        snprintf(text, size, "%s and %s between poses: %s", first, second, gap);
    } else if (pair->state == CSGM_CLEAR_UNDECIDED)
        snprintf(text, size, "whether %s and %s interfere could not be told%s", first, second,
                 pose);
    else
        snprintf(text, size, "whether %s and %s are %g apart could not be told: %s%s", first,
                 second, c->min_gap, cli_format_interval(gap, pair->gap), pose);
}

static void print_point(const char *before, csgm_vec3 at)
{
    printf("%s(%.6g, %.6g, %.6g)", before, at.x, at.y, at.z);
}

static void print_interfering(const csgm_clear_pair *p)
{
    char text[CLI_INTERVAL_TEXT];
    print_point("    inside both   ", p->inside);
    printf("\n    common volume %s\n", cli_format_interval(text, p->volume));
}

static void print_gap(const csgm_clear_pair *p)
{
    char text[CLI_INTERVAL_TEXT];
    if (isinf(p->gap.low))
        puts("    gap           one of them is empty");
    else if (isinf(p->gap.high))
        printf("    gap           at least %s%s\n",
               p->gap.low > 0 ? cli_format_least(text, p->gap.low, 6) : "0",
               p->by_boxes ? ", by their boxes" : "");
    else
        printf("    gap           %s\n", cli_format_interval(text, p->gap));
    if (isfinite(p->gap.high)) {
        print_point("    nearest       ", p->nearest[0]);
        print_point(" and ", p->nearest[1]);
        putchar('\n');
    }
}

static void print_pair(const cli_cleared *c, const csgm_clear_pair *p)
{
    char a[96], b[96], pose[160], between[160];
    const char *first = cli_clear_name(p->names[0], a), *second = cli_clear_name(p->names[1], b);
    cli_clear_pose(c, p, pose, sizeof pose);
    printf("  %s and %s: %s", first, second, cli_clear_state_name(p->state));
    if (p->state == CSGM_CLEAR_TOUCHING)
        printf(" within %.3g", csgm_clearances_tolerance(c->pairs));
    if (p->state == CSGM_CLEAR_UNDECIDED && p->size > 0)
        printf(" in cubes of %.3g", p->size);
    printf("%s\n", pose);
    if (p->state == CSGM_CLEAR_INTERFERING)
        print_interfering(p);
    else
        print_gap(p);
    if (c->over->name && p->poses_bad)
        printf("    poses         %zu of %zu %s\n", p->poses_bad, p->poses,
               c->min_gap > 0 ? "are too close" : "interfere");
    if (c->over->name && p->poses_open)
        printf("    poses         %zu of %zu could not be told\n", p->poses_open, p->poses);
    if (p->steps) {
        cli_clear_say_between(c, p, between, sizeof between);
        printf("    between poses %s\n", between);
    }
}

/* Pairs that their boxes tell apart, where these are many. */
typedef struct far_pairs {
    size_t count, open; /* open: some of whose steps are not covered */
    double least, between;
    bool has_steps;
} far_pairs;

static void add_far(far_pairs *all, const csgm_clear_pair *p)
{
    all->count++;
    all->open += p->steps_open > 0;
    all->has_steps |= p->steps > 0;
    all->least = fmin(all->least, p->gap.low);
    all->between = fmin(all->between, p->gap_between);
}

static void print_far(const far_pairs *all)
{
    char least[CLI_INTERVAL_TEXT];
    printf("  %zu other pairs: apart, at least %s, by their boxes\n", all->count,
           cli_format_least(least, all->least, 6));
    if (all->open)
        printf("    between poses steps of %zu of them are not covered\n", all->open);
    else if (all->has_steps)
        printf("    between poses a gap of at least %s\n",
               cli_format_least(least, all->between, 3));
}

void cli_clear_text(const cli_cleared *c)
{
    const csgm_clear_pair *p;
    char first[CLI_OVER_TEXT], last[CLI_OVER_TEXT];
    size_t far_count = 0;
    far_pairs others = {.least = INFINITY, .between = INFINITY};
    printf("%s: ", c->path);
    if (c->over->name)
        printf("%zu poses, %s = %s .. %s\n", c->poses, c->over->name,
               cli_over_value(c->over, 0, first),
               cli_over_value(c->over, c->poses ? c->poses - 1 : 0, last));
    else
        puts("as it stands");
    for (size_t i = 0; (p = csgm_clearances_get(c->pairs, i)) != NULL; i++)
        far_count += p->by_boxes;
    for (size_t i = 0; (p = csgm_clearances_get(c->pairs, i)) != NULL; i++) {
        if (!p->by_boxes || far_count <= FAR_MOST) {
            print_pair(c, p);
            continue;
        }
        add_far(&others, p);
    }
    if (others.count)
        print_far(&others);
}
