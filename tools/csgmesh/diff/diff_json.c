/* SPDX-License-Identifier: MIT
 * Comparisons as JSON (docs/diff.md lists the members) and as JUnit XML. No times: the same bytes
 * for any number of threads.
 */
#include <stdio.h>

#include "core/facts.h"
#include "core/junit.h"
#include "core/markup.h"
#include "core/options.h"
#include "core/textfile.h"
#include "diff/diff_report.h"

static const char *const outcomes[] = {"same", "different", "only in A", "only in B", "failed"};
static const char *const levels[] = {"different", "within tolerance", "same triangles",
                                     "same bytes"};

static void put_figures(cli_json *json, const char *key, const csgm_diff_figures *f)
{
    csgm_mesh_view counts = {.vertex_count = f->vertices, .triangle_count = f->triangles};
    cli_json_open(json, key, '{');
    csgm_file_figures mesh = cli_facts_of_mesh(&counts, &f->check);
    cli_facts_mesh_json(json, &mesh);
    cli_json_bool(json, "closed", f->is_closed);
    cli_json_count(json, "parts", f->parts);
    cli_json_bool(json, "normals", f->has_normals);
    cli_json_bool(json, "colors", f->has_colors);
    cli_json_end(json, '}');
}

static void put_places(cli_json *json, const csgm_diff_distance *d)
{
    cli_json_open(json, "worst", '[');
    for (uint32_t i = 0; i < d->worst_count; i++) {
        cli_json_open(json, NULL, '{');
        cli_json_vec3(json, "at", d->worst[i].at);
        cli_json_vec3(json, "nearest", d->worst[i].nearest);
        cli_json_number(json, "distance", d->worst[i].distance);
        cli_json_end(json, '}');
    }
    cli_json_end(json, ']');
}

static void put_distance(cli_json *json, const char *key, const csgm_diff_distance *d)
{
    if (!d->is_measured)
        return;
    cli_json_open(json, key, '{');
    cli_json_number(json, "max_lower", d->lower);
    cli_json_number(json, "max_upper", d->upper);
    cli_json_bool(json, "refined", d->is_refined);
    if (d->is_sampled) {
        cli_json_number(json, "mean", d->mean);
        cli_json_number(json, "rms", d->rms);
        cli_json_number(json, "p95", d->percentile_95);
        cli_json_number(json, "p99", d->percentile_99);
    }
    put_places(json, d);
    cli_json_end(json, '}');
}

static void put_volume(cli_json *json, const csgm_diff_volume *v)
{
    if (!v->is_measured)
        return;
    cli_json_open(json, "volume", '{');
    cli_json_number(json, "only_a", v->only_a);
    cli_json_number(json, "only_b", v->only_b);
    cli_json_number(json, "both", v->both);
    cli_json_number(json, "ratio", v->ratio);
    cli_json_number(json, "accuracy", v->accuracy);
    cli_json_end(json, '}');
}

static void put_field(cli_json *json, const char *key, const csgm_diff_field *f)
{
    if (!f->is_measured)
        return;
    cli_json_open(json, key, '{');
    cli_json_number(json, "lambda", f->lipschitz);
    cli_json_number(json, "max_abs_field", f->max_abs_field);
    cli_json_vec3(json, "at", f->at);
    cli_json_number(json, "mean_abs_field", f->mean_abs_field);
    cli_json_number(json, "distance_lower", f->lower);
    cli_json_number(json, "distance_upper", f->upper);
    cli_json_count(json, "evaluations", f->evaluations);
    cli_json_end(json, '}');
}

static void put_attribute(cli_json *json, const char *key, const csgm_diff_attribute *a)
{
    if (!a->is_compared)
        return;
    cli_json_open(json, key, '{');
    cli_json_number(json, "largest", a->largest);
    cli_json_number(json, "share", a->share);
    cli_json_end(json, '}');
}

static void put_reasons(cli_json *json, uint32_t reasons)
{
    static const char *const names[] = {"distance", "volume", "topology", "normals",
                                        "colors",   "names",  "empty"};
    cli_json_open(json, "reasons", '[');
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (reasons & 1u << i)
            cli_json_string(json, NULL, names[i]);
    cli_json_end(json, ']');
}

void diff_put_report(cli_json *json, const csgm_diff_report *r)
{
    cli_json_string(json, "level", levels[r->level]);
    if (r->level == CSGM_DIFF_SAME_BYTES)
        return;
    put_reasons(json, r->reasons);
    cli_json_number(json, "tolerance", r->tolerance);
    cli_json_number(json, "precision", r->precision);
    cli_json_bool(json, "turned", r->is_turned);
    put_figures(json, "a", &r->figures[0]);
    put_figures(json, "b", &r->figures[1]);
    cli_json_open(json, "hausdorff", '[');
    cli_json_number(json, NULL, r->hausdorff_lower);
    cli_json_number(json, NULL, r->hausdorff_upper);
    cli_json_end(json, ']');
    put_distance(json, "a_to_b", &r->distance[0]);
    put_distance(json, "b_to_a", &r->distance[1]);
    put_distance(json, "counted", &r->counted);
    put_volume(json, &r->volume);
    put_field(json, "a_to_field_of_b", &r->field[0]);
    put_field(json, "b_to_field_of_a", &r->field[1]);
    put_attribute(json, "normals", &r->normals);
    put_attribute(json, "colors", &r->colors);
    put_attribute(json, "names", &r->names);
}

static void put_result(cli_json *json, const diff_result *result)
{
    if (result->a)
        cli_json_string(json, "file_a", result->a);
    if (result->b)
        cli_json_string(json, "file_b", result->b);
    cli_json_string(json, "verdict", outcomes[result->outcome]);
    cli_json_bool(json, "updated", result->is_updated);
    if (result->outcome <= DIFF_DIFFERENT)
        diff_put_report(json, &result->report);
}

static void put_json(FILE *out, const diff_results *results)
{
    cli_json json = cli_json_make(out, true);
    cli_json_begin(&json, '{');
    cli_json_string(&json, "csgmesh", csgm_version());
    if (!results->of_folders) {
        put_result(&json, &results->items[0]);
        cli_json_end(&json, '}');
        return;
    }
    cli_json_open(&json, "pairs", '[');
    for (size_t i = 0; i < results->count; i++) {
        cli_json_break(&json);
        cli_json_open(&json, NULL, '{');
        put_result(&json, &results->items[i]);
        cli_json_end(&json, '}');
    }
    cli_json_end(&json, ']');
    cli_json_end(&json, '}');
}

/* ---- JUnit ----------------------------------------------------------------------------- */

static void put_case(FILE *out, const diff_result *result)
{
    char reason[512];
    diff_explain(result, reason, sizeof reason);
    fputs("  <testcase classname=\"csgmesh diff\" name=\"", out);
    cli_put_markup(out, result->a ? result->a : result->b, CLI_XML);
    fputs("\">", out);
    if (result->outcome != DIFF_SAME && !result->is_updated) {
        const char *kind = result->outcome == DIFF_FAILED ? "error" : "failure";
        fprintf(out, "<%s message=\"", kind);
        cli_put_markup(out, reason, CLI_XML);
        fprintf(out, "\"/>");
    }
    fputs("</testcase>\n", out);
}

static void put_junit(FILE *out, const diff_results *results)
{
    size_t failures = 0, errors = 0;
    for (size_t i = 0; i < results->count; i++) {
        const diff_result *r = &results->items[i];
        errors += r->outcome == DIFF_FAILED;
        failures += r->outcome != DIFF_SAME && r->outcome != DIFF_FAILED && !r->is_updated;
    }
    cli_junit_open(out, "diff", &(cli_junit_counts){results->count, failures, errors, 0, -1});
    for (size_t i = 0; i < results->count; i++)
        put_case(out, &results->items[i]);
    cli_junit_close(out);
}

static int write_with(cli_app *app, const char *path, const diff_results *results,
                      void (*put)(FILE *out, const diff_results *results))
{
    cli_text text;
    if (cli_text_open(&text))
        put(text.out, results);
    return cli_text_write(app, &text, path);
}

int diff_write_json(cli_app *app, const diff_results *results)
{
    return write_with(app, app->options->diff_json, results, put_json);
}

int diff_write_junit(cli_app *app, const diff_results *results)
{
    return write_with(app, app->options->diff_junit, results, put_junit);
}
