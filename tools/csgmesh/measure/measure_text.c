/* SPDX-License-Identifier: MIT
 * Measures as lines for people.
 */
#include "core/interval.h"
#include "measure/measure_print.h"

static void print_interval(const char *name, csgm_interval interval)
{
    char text[CLI_INTERVAL_TEXT];
    printf("  %-12s %s\n", name, cli_format_interval(text, interval));
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
