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
        const double axis[3] = {m->axes[n].x, m->axes[n].y, m->axes[n].z};
        cli_json_open(json, NULL, '{');
        put_interval(json, "moment", m->moments[n]);
        cli_json_open(json, "axis", '[');
        for (int k = 0; k < 3; k++)
            cli_json_number(json, NULL, axis[k]);
        cli_json_end(json, ']');
        cli_json_number(json, "axis_within_deg", m->axis_within[n]);
        cli_json_end(json, '}');
    }
    cli_json_end(json, ']');
}

static void put_measures(cli_json *json, const csgm_measures *m)
{
    static const char *const axes[] = {"x", "y", "z"};
    static const char *const products[] = {"xx", "yy", "zz", "xy", "xz", "yz"};
    static const char *const sides[] = {"min_x", "min_y", "min_z", "max_x", "max_y", "max_z"};
    cli_json_bool(json, "reached", m->is_reached);
    cli_json_count(json, "cubes", m->cubes);
    put_interval(json, "volume", m->volume);
    put_interval(json, "mass", m->mass);
    put_intervals(json, "centroid", axes, m->centroid, 3);
    put_intervals(json, "inertia", products, m->inertia, 6);
    put_principal(json, m);
    put_intervals(json, "bounds", sides, m->bounds, 6);
    put_interval(json, "area", m->area);
}

static void put_parts(cli_json *json, const cli_measured *measured)
{
    cli_json_open(json, "parts", '[');
    for (size_t i = 0; i < measured->part_count; i++) {
        cli_json_open(json, NULL, '{');
        cli_json_string(json, "part", measured->parts[i].name);
        put_measures(json, &measured->parts[i].measures);
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
    put_measures(&json, measured->measures);
    if (measured->part_count)
        put_parts(&json, measured);
    if (measured->checks.count)
        put_checks(&json, &measured->checks);
    cli_json_end(&json, '}');
}
