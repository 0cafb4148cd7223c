/* SPDX-License-Identifier: MIT
 * See clear_over.h.
 */
#include "clear/clear_over.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char HINT[] = "as --over t=0:0.01:1, first value, step and last value";

static bool read_number(const char **at, double *out)
{
    char *end;
    *out = strtod(*at, &end);
    bool done = end > *at && isfinite(*out);
    *at = end;
    return done;
}

/* A:STEP:B, or A:B in steps of 1, as ranges of the language are. */
static bool read_range(const char *at, cli_over *out)
{
    bool done = read_number(&at, &out->first) && *at++ == ':' && read_number(&at, &out->last);
    out->step = 1;
    if (done && *at == ':') {
        at++;
        out->step = out->last;
        done = read_number(&at, &out->last);
    }
    return done && *at == 0;
}

int cli_over_read(cli_app *app, const char *text, cli_over *out)
{
    static const double NEARLY = 1e-9; /* of a step: so that 0:0.1:1 ends in 1 */
    *out = (cli_over){.count = 1};
    if (!text)
        return CLI_DONE;
    size_t length = cli_name_length(text);
    if (length == 0 || text[length] != '=' || (*text >= '0' && *text <= '9'))
        return cli_usage_error(app, HINT, "--over wants NAME=A:STEP:B, not '%.80s'", text);
    if (!read_range(text + length + 1, out))
        return cli_usage_error(app, HINT, "--over wants numbers, A:STEP:B, not '%.80s'",
                               text + length + 1);
    double steps = floor((out->last - out->first) / out->step + NEARLY);
    if (!(steps >= 0) || !(fabs(out->step) > 0))
        return cli_usage_error(app, HINT, "--over never comes from %g to %g in steps of %g",
                               out->first, out->last, out->step);
    if (!(steps < CLI_OVER_MOST))
        return cli_usage_error(app, "a larger step makes fewer", "--over has more than %d poses",
                               CLI_OVER_MOST);
    out->count = (size_t)steps + 1;
    out->name = strndup(text, length);
    return out->name ? CLI_DONE : cli_usage_error(app, NULL, "out of memory");
}

/* As a number: 0 is what is meant by what is nearly 0. */
static double value_at(const cli_over *over, size_t pose)
{
    double value = over->values ? over->values[pose] : over->first + (double)pose * over->step;
    return fabs(value) < 1e-9 * fabs(over->step) ? 0 : value;
}

int cli_over_halve(cli_app *app, cli_over *over, const bool *open)
{
    size_t count = over->count;
    for (size_t i = 1; i < over->count; i++)
        count += open[i];
    if (count > CLI_OVER_MOST)
        return cli_usage_error(app, "a smaller --refine makes fewer",
                               "--refine makes more than %d poses", CLI_OVER_MOST);
    double *values = calloc(count, sizeof *values);
    if (!values)
        return cli_usage_error(app, NULL, "out of memory");
    for (size_t i = 0, at = 0; i < over->count; i++) {
        if (i > 0 && open[i])
            values[at++] = 0.5 * (value_at(over, i - 1) + value_at(over, i));
        values[at++] = value_at(over, i);
    }
    free(over->values);
    over->values = values;
    over->count = count;
    return CLI_DONE;
}

void cli_over_release(cli_over *over)
{
    free(over->name);
    free(over->values);
}

const char *cli_over_value(const cli_over *over, size_t pose, char text[CLI_OVER_TEXT])
{
    snprintf(text, CLI_OVER_TEXT, "%.12g", value_at(over, pose));
    return text;
}
