/* SPDX-License-Identifier: MIT
 * Measures as lines for people. Ends of intervals are rounded outward, to digits that tell them
 * apart.
 */
#include <math.h>
#include <stdlib.h>

#include "measure/measure_print.h"

enum { TEXT = 400, MOST_DECIMALS = 320 };

/* The number with so many decimals that is nearest on that side of the value. */
static void put_end(char text[TEXT], double value, int decimals, double side)
{
    double unit = pow(10, -decimals);
    snprintf(text, TEXT, "%.*f", decimals, value);
    if (side * (strtod(text, NULL) - value) < 0)
        snprintf(text, TEXT, "%.*f", decimals, value + side * unit);
}

static void print_interval(const char *name, csgm_interval interval)
{
    double width = interval.high - interval.low;
    char low[TEXT], high[TEXT];
    printf("  %-12s ", name);
    if (!isfinite(width)) {
        puts("not known");
        return;
    }
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
    printf("%s .. %s\n", low, high);
}

void cli_measure_text(const cli_measured *measured)
{
    const csgm_measures *m = measured->measures;
    static const char *const axes[] = {"centroid x", "y", "z"};
    static const char *const products[] = {"inertia xx", "yy", "zz", "xy", "xz", "yz"};
    static const char *const sides[] = {"least x", "y", "z", "largest x", "y", "z"};
    printf("%s: a %s", measured->path, measured->is_mesh ? "mesh" : "scene");
    if (measured->part)
        printf(", part \"%s\"", measured->part);
    putchar('\n');
    print_interval("volume", m->volume);
    if (measured->density < 1 || measured->density > 1)
        print_interval("mass", m->mass);
    for (int i = 0; i < 3; i++)
        print_interval(axes[i], m->centroid[i]);
    for (int i = 0; i < 6; i++)
        print_interval(products[i], m->inertia[i]);
    for (int i = 0; i < 6; i++)
        print_interval(sides[i], m->bounds[i]);
    for (size_t i = 0; i < measured->checks.count; i++)
        printf("  %-12s %s\n", cli_truth_name(measured->checks.items[i].truth),
               measured->checks.items[i].text);
}
