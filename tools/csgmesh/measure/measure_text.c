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

static void print_area(const char *name, csgm_interval area)
{
    static const double DOWN = 1 - 5e-6; /* what six digits are rounded by */
    if (isfinite(area.high))
        print_interval(name, area);
    else
        printf("  %-12s at least %.6g\n", name, area.low * DOWN);
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

static void print_box(const csgm_oriented_box *box)
{
    static const char *const names[] = {"box edge 1", "2", "3"};
    char text[CLI_INTERVAL_TEXT];
    print_interval("box volume", box->volume);
    for (int k = 0; k < 3; k++)
        printf("  %-12s %s along %.6g,%.6g,%.6g\n", names[k],
               cli_format_interval(text, box->edges[k]), box->axes[k].x, box->axes[k].y,
               box->axes[k].z);
}

static void print_faces(const csgm_faces *faces)
{
    print_area("overhang", faces->overhang);
    print_area("  resting", faces->resting);
    print_area("steep", faces->steep);
}

static void print_span(const char *name, const csgm_span *span)
{
    char text[CLI_INTERVAL_TEXT];
    const csgm_vec3 *at = span->at;
    if (span->length.low >= INFINITY)
        printf("  %-12s none", name);
    else if (!span->is_shown)
        printf("  %-12s %.6g or more", name, span->length.low);
    else
        printf("  %-12s %s from %.6g,%.6g,%.6g to %.6g,%.6g,%.6g", name,
               cli_format_interval(text, span->length), at[0].x, at[0].y, at[0].z, at[1].x, at[1].y,
               at[1].z);
    if (span->overlooked > 0)
        printf(", below %.4g not looked for everywhere", span->overlooked);
    putchar('\n');
}

static void print_figures(const cli_measured *measured, const cli_figures *f)
{
    static const char *const axes[] = {"centroid x", "y", "z"};
    static const char *const products[] = {"inertia xx", "yy", "zz", "xy", "xz", "yz"};
    static const char *const moments[] = {"moment 1", "2", "3"};
    static const char *const sides[] = {"least x", "y", "z", "largest x", "y", "z"};
    const csgm_measures *m = &f->measures;
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
    print_area("area", m->area);
    if (f->groups & CLI_FIGURES_BOX)
        print_box(&f->box);
    if (f->groups & CLI_FIGURES_FACES)
        print_faces(&f->faces);
    if (f->groups & CLI_FIGURES_WALLS) {
        print_span("wall", &f->walls.wall);
        print_span("gap", &f->walls.gap);
    }
}

void cli_measure_text(const cli_measured *measured)
{
    printf("%s: a %s", measured->path, measured->is_mesh ? "mesh" : "scene");
    if (measured->part)
        printf(", part \"%s\"", measured->part);
    putchar('\n');
    print_figures(measured, measured->figures);
    for (size_t i = 0; i < measured->part_count; i++) {
        printf("part \"%s\"%s\n", measured->parts[i].name,
               cli_figures_are_reached(&measured->parts[i].figures) ? ""
                                                                    : ", as far as it is proven");
        print_figures(measured, &measured->parts[i].figures);
    }
    for (size_t i = 0; i < measured->checks.count; i++)
        printf("  %-12s %s\n", cli_truth_name(measured->checks.items[i].truth),
               measured->checks.items[i].text);
}
