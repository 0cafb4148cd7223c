/* SPDX-License-Identifier: MIT
 * Measures as lines for people.
 */
#include <math.h>

#include "core/interval.h"
#include "measure/measure_print.h"

static void print_interval(const char *name, csgm_interval interval)
{
    char text[CLI_INTERVAL_TEXT];
    printf("  %-12s %s\n", name, cli_format_interval(text, interval));
}

static void print_axis(int n, const csgm_measures *m)
{
    static const char *const names[] = {"axis 1", "2", "3"};
    const csgm_vec3 axis = m->axes[n];
    if (m->axis_within[n] < 90)
        printf("  %-12s %.6g,%.6g,%.6g within %.2g degrees\n", names[n], axis.x, axis.y, axis.z,
               m->axis_within[n]);
    else
        printf("  %-12s unknown\n", names[n]);
}

static void print_measures(const cli_measured *measured, const csgm_measures *m)
{
    static const char *const axes[] = {"centroid x", "y", "z"};
    static const char *const products[] = {"inertia xx", "yy", "zz", "xy", "xz", "yz"};
    static const char *const moments[] = {"moment 1", "2", "3"};
    static const char *const sides[] = {"least x", "y", "z", "largest x", "y", "z"};
    print_interval("volume", m->volume);
    if (measured->density < 1 || measured->density > 1)
        print_interval("mass", m->mass);
    for (int i = 0; i < 3; i++)
        print_interval(axes[i], m->centroid[i]);
    for (int i = 0; i < 6; i++)
        print_interval(products[i], m->inertia[i]);
    for (int i = 0; i < 3; i++)
        print_interval(moments[i], m->moments[i]);
    for (int i = 0; i < 3; i++)
        print_axis(i, m);
    for (int i = 0; i < 6; i++)
        print_interval(sides[i], m->bounds[i]);
    if (isfinite(m->area.high))
        print_interval("area", m->area);
    else
        printf("  %-12s at least %.6g\n", "area", m->area.low * (1 - 5e-6)); /* rounded down */
}

void cli_measure_text(const cli_measured *measured)
{
    printf("%s: a %s", measured->path, measured->is_mesh ? "mesh" : "scene");
    if (measured->part)
        printf(", part \"%s\"", measured->part);
    putchar('\n');
    print_measures(measured, measured->measures);
    for (size_t i = 0; i < measured->part_count; i++) {
        printf("part \"%s\"%s\n", measured->parts[i].name,
               measured->parts[i].measures.is_reached ? "" : ", as far as it is proven");
        print_measures(measured, &measured->parts[i].measures);
    }
    for (size_t i = 0; i < measured->checks.count; i++)
        printf("  %-12s %s\n", cli_truth_name(measured->checks.items[i].truth),
               measured->checks.items[i].text);
}
