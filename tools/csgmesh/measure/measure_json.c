/* SPDX-License-Identifier: MIT
 * Measures as one JSON object: every interval is [low, high], null where it has no end.
 */
#include <math.h>

#include "measure/measure_print.h"

static void put_interval(cli_json *json, const char *key, csgm_interval interval)
{
    cli_json_open(json, key, '[');
    cli_json_number(json, NULL, interval.low);
    cli_json_number(json, NULL, interval.high);
    cli_json_end(json, ']');
}

static void put_intervals(cli_json *json, const char *key, const char *const *names,
                          const csgm_interval *intervals, int count)
{
    cli_json_open(json, key, '{');
    for (int i = 0; i < count; i++)
        put_interval(json, names[i], intervals[i]);
    cli_json_end(json, '}');
}

static void put_vector(cli_json *json, const char *key, csgm_vec3 v)
{
    const double at[3] = {v.x, v.y, v.z};
    cli_json_open(json, key, '[');
    for (int k = 0; k < 3; k++)
        cli_json_number(json, NULL, at[k]);
    cli_json_end(json, ']');
}

static void put_checks(cli_json *json, const cli_checks *checks)
{
    cli_json_open(json, "checks", '[');
    for (size_t i = 0; i < checks->count; i++) {
        cli_json_open(json, NULL, '{');
        cli_json_string(json, "check", checks->items[i].text);
        cli_json_string(json, "result", cli_truth_name(checks->items[i].truth));
        cli_json_end(json, '}');
    }
    cli_json_end(json, ']');
}

static void put_principal(cli_json *json, const csgm_measures *m)
{
    cli_json_open(json, "principal", '[');
    for (int n = 0; n < 3; n++) {
        cli_json_open(json, NULL, '{');
        put_interval(json, "moment", m->moments[n]);
        put_vector(json, "axis", m->axes[n]);
        cli_json_number(json, "axis_within_deg", m->axis_within[n]);
        cli_json_end(json, '}');
    }
    cli_json_end(json, ']');
}

static void put_box(cli_json *json, const csgm_oriented_box *box)
{
    cli_json_open(json, "oriented_box", '{');
    cli_json_bool(json, "reached", box->is_reached);
    put_interval(json, "volume", box->volume);
    cli_json_open(json, "edges", '[');
    for (int k = 0; k < 3; k++) {
        cli_json_open(json, NULL, '{');
        put_interval(json, "length", box->edges[k]);
        put_vector(json, "axis", box->axes[k]);
        put_interval(json, "least", box->ends[k]);
        put_interval(json, "largest", box->ends[3 + k]);
        cli_json_end(json, '}');
    }
    cli_json_end(json, ']');
    cli_json_end(json, '}');
}

static void put_faces(cli_json *json, const csgm_faces *faces)
{
    cli_json_open(json, "faces", '{');
    put_interval(json, "overhang", faces->overhang);
    put_interval(json, "resting", faces->resting);
    put_interval(json, "steep", faces->steep);
    cli_json_count(json, "overhang_triangles", faces->overhang_triangles);
    cli_json_count(json, "steep_triangles", faces->steep_triangles);
    cli_json_end(json, '}');
}

/* "at" is there where points are known; of what there is none both ends are null. */
static void put_span(cli_json *json, const char *key, const csgm_span *span)
{
    cli_json_open(json, key, '{');
    put_interval(json, "length", span->length);
    cli_json_bool(json, "none", span->length.low >= INFINITY);
    cli_json_number(json, "overlooked", span->overlooked);
    if (span->is_shown) {
        cli_json_open(json, "at", '[');
        put_vector(json, NULL, span->at[0]);
        put_vector(json, NULL, span->at[1]);
        cli_json_end(json, ']');
    }
    cli_json_end(json, '}');
}

static void put_figures(cli_json *json, const cli_figures *f)
{
    static const char *const axes[] = {"x", "y", "z"};
    static const char *const products[] = {"xx", "yy", "zz", "xy", "xz", "yz"};
    static const char *const sides[] = {"min_x", "min_y", "min_z", "max_x", "max_y", "max_z"};
    const csgm_measures *m = &f->measures;
    cli_json_bool(json, "reached", cli_figures_are_reached(f));
    cli_json_count(json, "cubes", m->cubes);
    put_interval(json, "volume", m->volume);
    put_interval(json, "mass", m->mass);
    put_intervals(json, "centroid", axes, m->centroid, 3);
    put_intervals(json, "inertia", products, m->inertia, 6);
    put_principal(json, m);
    put_intervals(json, "bounds", sides, m->bounds, 6);
    put_interval(json, "area", m->area);
    if (f->groups & CLI_FIGURES_BOX)
        put_box(json, &f->box);
    if (f->groups & CLI_FIGURES_FACES)
        put_faces(json, &f->faces);
    if (f->groups & CLI_FIGURES_WALLS) {
        put_span(json, "wall", &f->walls.wall);
        put_span(json, "gap", &f->walls.gap);
    }
}

static void put_parts(cli_json *json, const cli_measured *measured)
{
    cli_json_open(json, "parts", '[');
    for (size_t i = 0; i < measured->part_count; i++) {
        cli_json_open(json, NULL, '{');
        cli_json_string(json, "part", measured->parts[i].name);
        put_figures(json, &measured->parts[i].figures);
        cli_json_end(json, '}');
    }
    cli_json_end(json, ']');
}

void cli_measure_json(const cli_measured *measured)
{
    cli_json json = cli_json_make(stdout, true);
    cli_json_begin(&json, '{');
    cli_json_string(&json, "file", measured->path);
    if (measured->part)
        cli_json_string(&json, "part", measured->part);
    cli_json_string(&json, "kind", measured->is_mesh ? "mesh" : "scene");
    cli_json_number(&json, "to", measured->to);
    cli_json_number(&json, "density", measured->density);
    put_figures(&json, measured->figures);
    if (measured->part_count)
        put_parts(&json, measured);
    if (measured->checks.count)
        put_checks(&json, &measured->checks);
    cli_json_end(&json, '}');
}
