/* SPDX-License-Identifier: MIT
 * A comparison in a few lines for people: the verdict, and what is not the same.
 */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "diff/diff_result.h"

static void append(char *text, size_t size, const char *more)
{
    size_t length = strlen(text);
    snprintf(text + length, size - length, "%s%s", length ? "; " : "", more);
}

static void explain_distance(const csgm_diff_report *r, char *text, size_t size)
{
    char line[160];
    bool is_counted = r->counted.is_measured;
    double lower = is_counted ? r->counted.lower : r->hausdorff_lower;
    double upper = is_counted ? r->counted.upper : r->hausdorff_upper;
    const char *where = is_counted ? " where it counts" : "";
    if (lower > r->tolerance)
        snprintf(line, sizeof line, "%.4g apart%s, more than %.4g", lower, where, r->tolerance);
    else
        snprintf(line, sizeof line, "%.6g to %.6g apart%s, not shown to be at most %.6g", lower,
                 upper, where, r->tolerance);
    append(text, size, line);
}

static void explain_topology(const csgm_diff_report *r, char *text, size_t size)
{
    const csgm_diff_figures *a = &r->figures[0], *b = &r->figures[1];
    char line[160];
    if (a->check.components != b->check.components)
        snprintf(line, sizeof line, "%" PRIu64 " components became %" PRIu64, a->check.components,
                 b->check.components);
    else if (a->is_closed != b->is_closed)
        snprintf(line, sizeof line, "%s became %s", a->is_closed ? "closed" : "open",
                 b->is_closed ? "closed" : "open");
    else
        snprintf(line, sizeof line, "genus %" PRId64 " became %" PRId64, a->check.genus,
                 b->check.genus);
    append(text, size, line);
}

static void explain_difference(const csgm_diff_report *r, char *text, size_t size)
{
    char line[160];
    if (r->reasons & CSGM_DIFF_REASON_EMPTY)
        append(text, size, r->figures[0].triangles ? "B is empty" : "A is empty");
    if (r->reasons & CSGM_DIFF_REASON_DISTANCE)
        explain_distance(r, text, size);
    if (r->reasons & CSGM_DIFF_REASON_VOLUME) {
        snprintf(line, sizeof line, "%.3g %% of the volume differ", 100 * r->volume.ratio);
        append(text, size,
               r->volume.is_measured ? line : "volumes of open meshes cannot be compared");
    }
    if (r->reasons & CSGM_DIFF_REASON_TOPOLOGY)
        explain_topology(r, text, size);
    if (r->reasons & CSGM_DIFF_REASON_NORMALS)
        append(text, size, "normals differ");
    if (r->reasons & CSGM_DIFF_REASON_COLORS)
        append(text, size, "colours differ");
    if (r->reasons & CSGM_DIFF_REASON_NAMES)
        append(text, size, "names of parts differ");
}

void diff_explain(const diff_result *result, char *text, size_t size)
{
    const csgm_diff_report *r = &result->report;
    text[0] = '\0';
    if (result->outcome == DIFF_ONLY_A || result->outcome == DIFF_ONLY_B)
        append(text, size, result->outcome == DIFF_ONLY_A ? "only in A" : "only in B");
    else if (result->outcome == DIFF_FAILED)
        append(text, size, "could not be compared");
    else if (r->is_different)
        explain_difference(r, text, size);
    else if (r->level == CSGM_DIFF_SAME_BYTES)
        append(text, size, "the same bytes");
    else if (r->level == CSGM_DIFF_SAME_TRIANGLES)
        append(text, size, "the same triangles");
    else if (isinf(r->tolerance))
        snprintf(text, size, "volumes within the tolerance, at most %.4g apart",
                 r->hausdorff_upper);
    else
        snprintf(text, size, "at most %.4g apart, tolerance %.4g", r->hausdorff_upper,
                 r->tolerance);
}

/* ---- what is not the same -------------------------------------------------------------------- */

static bool is_other(double a, double b)
{
    return fabs(a - b) > 1e-6 * fmax(fabs(a), fabs(b));
}

static void print_sizes(const csgm_diff_report *r)
{
    csgm_vec3 size[2];
    bool is_known = r->figures[0].triangles && r->figures[1].triangles;
    for (int i = 0; i < 2; i++) {
        const csgm_box *box = &r->figures[i].check.bounds;
        size[i] =
            (csgm_vec3){box->max.x - box->min.x, box->max.y - box->min.y, box->max.z - box->min.z};
    }
    double grown = fmax(fmax(fabs(size[0].x - size[1].x), fabs(size[0].y - size[1].y)),
                        fabs(size[0].z - size[1].z));
    double most = fmax(fmax(size[0].x, size[0].y), size[0].z);
    if (is_known && grown > fmax(fmin(r->tolerance, most), 1e-6 * most))
        printf("  size      %.6g x %.6g x %.6g -> %.6g x %.6g x %.6g\n", size[0].x, size[0].y,
               size[0].z, size[1].x, size[1].y, size[1].z);
}

static void print_change(const char *name, double a, double b)
{
    if (is_other(a, b))
        printf("  %-9s %.6g -> %.6g (%+.3g %%)\n", name, a, b, 100 * (b / a - 1));
}

static void print_counts(const csgm_diff_report *r)
{
    const csgm_diff_figures *a = &r->figures[0], *b = &r->figures[1];
    const struct {
        const char *name;
        int64_t a, b;
        bool is_known;
    } rows[] = {
        {"triangles", (int64_t)a->triangles, (int64_t)b->triangles, true},
        {"parts", (int64_t)a->check.components, (int64_t)b->check.components, true},
        {"genus", a->check.genus, b->check.genus, a->is_closed && b->is_closed},
        {"open", (int64_t)a->check.boundary_edges, (int64_t)b->check.boundary_edges, true},
        {"pinched", (int64_t)a->check.nonmanifold_edges, (int64_t)b->check.nonmanifold_edges, true},
    };
    static const char *const units[] = {"", " components", " handles", " boundary edges",
                                        " non-manifold edges"};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].is_known && rows[i].a != rows[i].b)
            printf("  %-9s %" PRId64 " -> %" PRId64 "%s\n", rows[i].name, rows[i].a, rows[i].b,
                   units[i]);
}

static void print_distances(const csgm_diff_report *r)
{
    const csgm_diff_distance *worst = &r->distance[r->distance[1].lower > r->distance[0].lower];
    if (!isfinite(r->hausdorff_lower) || !(r->hausdorff_upper > 0))
        return;
    printf("  distance  max %.6g to %.6g", r->hausdorff_lower, r->hausdorff_upper);
    if (worst->worst_count)
        printf(" at %.6g,%.6g,%.6g", worst->worst[0].at.x, worst->worst[0].at.y,
               worst->worst[0].at.z);
    for (int i = 0; i < 2; i++)
        printf("; %s: max %.4g mean %.4g rms %.4g 95%% %.4g 99%% %.4g", i ? "B to A" : "A to B",
               r->distance[i].lower, r->distance[i].mean, r->distance[i].rms,
               r->distance[i].percentile_95, r->distance[i].percentile_99);
    putchar('\n');
}

static void print_volumes(const csgm_diff_report *r)
{
    const csgm_diff_figures *f = r->figures;
    if (!r->volume.is_measured) {
        if (f[0].triangles && f[1].triangles)
            printf("  volume    not compared: %s open\n", f[0].is_closed   ? "B is"
                                                          : f[1].is_closed ? "A is"
                                                                           : "both are");
        return;
    }
    print_change("volume", f[0].check.volume, f[1].check.volume);
    if (r->volume.only_a > 0 || r->volume.only_b > 0)
        printf("  material  only in A %.6g, only in B %.6g (+- %.2g), %.4g %% of the union\n",
               r->volume.only_a, r->volume.only_b, r->volume.accuracy, 100 * r->volume.ratio);
}

static void print_fields(const csgm_diff_report *r)
{
    for (int i = 0; i < 2; i++)
        if (r->field[i].is_measured)
            printf("  field     %s: max |f| %.6g, mean %.4g; distance of the exact surface %.6g to "
                   "%.6g (lambda %.4g)\n",
                   i ? "B to A" : "A to B", r->field[i].max_abs_field, r->field[i].mean_abs_field,
                   r->field[i].lower, r->field[i].upper, r->field[i].lipschitz);
}

void diff_print(const cli_console *console, const diff_result *result, bool with_details)
{
    static const char *const verdicts[] = {"same", "different", "different", "different", "failed"};
    char reason[512], verdict[40];
    diff_explain(result, reason, sizeof reason);
    cli_console_paint(console, verdicts[result->outcome],
                      result->outcome == DIFF_SAME ? CLI_GOOD : CLI_BAD, verdict, sizeof verdict);
    printf("%s: %s%s%s: %s%s\n", verdict, result->a ? result->a : "",
           result->a && result->b ? " " : "", result->b ? result->b : "", reason,
           result->is_updated ? "; A is now B" : "");
    const csgm_diff_report *r = &result->report;
    if (!with_details || result->outcome > DIFF_DIFFERENT || r->level == CSGM_DIFF_SAME_BYTES ||
        r->level == CSGM_DIFF_SAME_TRIANGLES)
        return;
    print_sizes(r);
    print_volumes(r);
    if (r->figures[0].triangles && r->figures[1].triangles)
        print_change("area", r->figures[0].check.area, r->figures[1].check.area);
    print_counts(r);
    print_distances(r);
    print_fields(r);
}
