/* SPDX-License-Identifier: MIT
 * Clearances as lines for people.
 */
#include <math.h>
#include <stdio.h>

#include "clear/clear_print.h"
#include "core/interval.h"

enum { FAR_MOST = 20 /* pairs whose boxes are far apart that have lines of their own */ };

cli_verdict cli_verdict_of(const csgm_clear_pair *pair)
{
    return pair->poses_bad ? CLI_PAIR_BAD : pair->poses_open ? CLI_PAIR_OPEN : CLI_PAIR_CLEAR;
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

void cli_clear_say(const cli_cleared *c, const csgm_clear_pair *pair, char *text, size_t size)
{
    char a[96], b[96], pose[160], gap[CLI_INTERVAL_TEXT];
    cli_clear_name(pair->names[0], a);
    cli_clear_pose(c, pair, pose, sizeof pose);
    const char *first = cli_clear_name(pair->names[0], a),
               *second = cli_clear_name(pair->names[1], b);
    if (pair->state == CSGM_CLEAR_INTERFERING)
        snprintf(text, size, "%s and %s interfere%s", first, second, pose);
    else if (cli_verdict_of(pair) == CLI_PAIR_BAD)
        snprintf(text, size, "%s and %s are closer than %g: %g at most%s", first, second,
                 c->min_gap, pair->gap.high, pose);
    else if (pair->state == CSGM_CLEAR_UNDECIDED)
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
        printf("    gap           at least %.6g%s\n", p->gap.low,
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
    char a[96], b[96], pose[160];
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
}

void cli_clear_text(const cli_cleared *c)
{
    const csgm_clear_pair *p;
    char first[CLI_OVER_TEXT], last[CLI_OVER_TEXT];
    size_t far_count = 0, far_left = 0;
    double least = INFINITY;
    printf("%s: ", c->path);
    if (c->over->name)
        printf("%zu poses, %s = %s .. %s; between them nothing is claimed\n", c->poses,
               c->over->name, cli_over_value(c->over, 0, first),
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
        far_left++;
        least = fmin(least, p->gap.low);
    }
    if (far_left)
        printf("  %zu other pairs: apart, at least %.6g, by their boxes\n", far_left, least);
}
