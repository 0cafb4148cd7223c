/* SPDX-License-Identifier: MIT
 * Clearances as one JSON object: every interval is [low, high], null where it has no end.
 */
#include "clear/clear_print.h"
#include "core/json.h"

static void put_interval(cli_json *json, const char *key, csgm_interval interval)
{
    cli_json_open(json, key, '[');
    cli_json_number(json, NULL, interval.low);
    cli_json_number(json, NULL, interval.high);
    cli_json_end(json, ']');
}

static void put_text(cli_json *json, const char *key, const char *text)
{
    if (text)
        cli_json_string(json, key, text);
    else
        cli_json_verbatim(json, key, "null");
}

/* The pose: its number, and the parameter's value there. */
static void put_pose(cli_json *json, const cli_cleared *c, size_t pose)
{
    char value[CLI_OVER_TEXT];
    cli_json_count(json, "pose", pose);
    cli_json_verbatim(json, c->over->name, cli_over_value(c->over, pose, value));
}

static void put_steps(cli_json *json, const cli_cleared *c, const csgm_clear_pair *p)
{
    char value[CLI_OVER_TEXT];
    cli_json_count(json, "steps", p->steps);
    cli_json_count(json, "steps_not_covered", p->steps_open);
    if (p->steps_open) {
        cli_json_open(json, "first_not_covered", '[');
        for (size_t i = 0; i < 2; i++)
            cli_json_verbatim(json, NULL, cli_over_value(c->over, p->first_open - 1 + i, value));
        cli_json_end(json, ']');
    }
    cli_json_number(json, "gap_between", p->gap_between);
}

static void put_pair(cli_json *json, const cli_cleared *c, const csgm_clear_pair *p)
{
    static const char *const verdicts[] = {"clear", "undecided", "not clear"};
    cli_json_open(json, NULL, '{');
    cli_json_open(json, "parts", '[');
    put_text(json, NULL, p->names[0]);
    put_text(json, NULL, p->names[1]);
    cli_json_end(json, ']');
    cli_json_string(json, "result", verdicts[cli_verdict_of(c, p)]);
    cli_json_string(json, "state", cli_clear_state_name(p->state));
    if (c->over->name) {
        cli_json_open(json, "worst", '{');
        put_pose(json, c, p->pose);
        cli_json_end(json, '}');
        cli_json_count(json, "poses", p->poses);
        cli_json_count(json, "poses_not_clear", p->poses_bad);
        cli_json_count(json, "poses_undecided", p->poses_open);
        put_steps(json, c, p);
    }
    put_interval(json, "gap", p->gap);
    cli_json_bool(json, "by_boxes", p->by_boxes);
    if (p->state == CSGM_CLEAR_INTERFERING) {
        cli_json_vec3(json, "inside", p->inside);
        put_interval(json, "volume", p->volume);
    } else if (!p->by_boxes && p->gap.high < 1e308) {
        cli_json_open(json, "nearest", '[');
        cli_json_vec3(json, NULL, p->nearest[0]);
        cli_json_vec3(json, NULL, p->nearest[1]);
        cli_json_end(json, ']');
    }
    if (p->state == CSGM_CLEAR_UNDECIDED)
        cli_json_number(json, "size", p->size);
    cli_json_count(json, "cubes", p->pairs);
    cli_json_end(json, '}');
}

void cli_clear_json(const cli_cleared *c)
{
    const csgm_clear_pair *p;
    cli_json json = cli_json_make(stdout, true);
    cli_json_begin(&json, '{');
    cli_json_string(&json, "file", c->path);
    cli_json_number(&json, "to", csgm_clearances_tolerance(c->pairs));
    if (c->min_gap > 0)
        cli_json_number(&json, "min_gap", c->min_gap);
    if (c->over->name) {
        cli_json_open(&json, "over", '{');
        cli_json_string(&json, "parameter", c->over->name);
        cli_json_number(&json, "first", c->over->first);
        cli_json_number(&json, "step", c->over->step);
        cli_json_number(&json, "last", c->over->last);
        cli_json_end(&json, '}');
        cli_json_string(&json, "between_poses",
                        "of steps that are covered, for parts that move by screws");
    }
    cli_json_count(&json, "poses", c->poses);
    cli_json_open(&json, "pairs", '[');
    for (size_t i = 0; (p = csgm_clearances_get(c->pairs, i)) != NULL; i++)
        put_pair(&json, c, p);
    cli_json_end(&json, ']');
    cli_json_end(&json, '}');
}
