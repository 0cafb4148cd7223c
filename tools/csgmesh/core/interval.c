/* SPDX-License-Identifier: MIT
 * See interval.h.
 */
#include "core/interval.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/json.h"

enum { END = 400, MOST_DECIMALS = 320 };

/* The number with so many decimals that is nearest on that side of the value. */
static void put_end(char text[END], double value, int decimals, double side)
{
    double unit = pow(10, -decimals);
    snprintf(text, END, "%.*f", decimals, value);
    if (side * (strtod(text, NULL) - value) < 0)
        snprintf(text, END, "%.*f", decimals, value + side * unit);
}

const char *cli_format_interval(char text[CLI_INTERVAL_TEXT], csgm_interval interval)
{
    double width = interval.high - interval.low;
    char low[END], high[END];
    if (!isfinite(width))
        return "not known";
    if (width > 0) { /* two digits of the width; a double has 17 */
        double size = fmax(fabs(interval.low), fabs(interval.high));
        int decimals = (int)fmin(1 - floor(log10(width)), 16 - floor(log10(size)));
        decimals = decimals < 0 ? 0 : decimals > MOST_DECIMALS ? MOST_DECIMALS : decimals;
        put_end(low, interval.low, decimals, -1);
        put_end(high, interval.high, decimals, 1);
    } else {
        cli_format_double(low, sizeof low, interval.low);
        cli_format_double(high, sizeof high, interval.high);
    }
    snprintf(text, CLI_INTERVAL_TEXT, "%s .. %s", low, high);
    return text;
}

const char *cli_format_least(char text[CLI_INTERVAL_TEXT], double value, int digits)
{
    double decimals = fmin(fmax(digits - 1 - floor(log10(value)), 0), MOST_DECIMALS);
    char least[END];
    put_end(least, value, (int)decimals, -1);
    snprintf(text, CLI_INTERVAL_TEXT, "%s", least);
    return text;
}
