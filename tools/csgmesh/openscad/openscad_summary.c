/* SPDX-License-Identifier: MIT
 * --summary and --summary-file: what OpenSCAD says of the geometry, from the file that was written.
 */
#include <math.h>
#include <stdio.h>

#include "core/textfile.h"
#include "openscad/openscad_parts.h"

static void put_vector(cli_json *json, const char *name, double x, double y, double z)
{
    cli_json_open(json, name, '[');
    cli_json_number(json, NULL, x);
    cli_json_number(json, NULL, y);
    cli_json_number(json, NULL, z);
    cli_json_end(json, ']');
}

static void put_json(FILE *out, const csgm_mesh_view *view, const csgm_mesh_check *check,
                     double seconds)
{
    cli_json json = cli_json_make(out, true);
    csgm_box box = check->bounds;
    cli_json_begin(&json, '{');
    cli_json_open(&json, "geometry", '{');
    cli_json_open(&json, "bounding_box", '{');
    put_vector(&json, "max", box.max.x, box.max.y, box.max.z);
    put_vector(&json, "min", box.min.x, box.min.y, box.min.z);
    put_vector(&json, "size", box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z);
    cli_json_end(&json, '}');
    cli_json_integer(&json, "dimensions", 3);
    cli_json_count(&json, "facets", view->triangle_count);
    cli_json_count(&json, "vertices", view->vertex_count);
    cli_json_number(&json, "area", check->area);
    cli_json_number(&json, "volume", check->volume);
    cli_json_end(&json, '}');
    cli_json_open(&json, "time", '{');
    cli_json_integer(&json, "total", (int64_t)ceil(1000 * seconds)); /* milliseconds, as there */
    cli_json_end(&json, '}');
    cli_json_end(&json, '}');
}

static void put_text(FILE *out, unsigned parts, const csgm_mesh_view *view,
                     const csgm_mesh_check *check, double seconds)
{
    csgm_box box = check->bounds;
    if (parts & OPENSCAD_SUMMARY_TIME)
        fprintf(out, "Total rendering time: %d:%02d:%06.3f\n", (int)(seconds / 3600),
                (int)fmod(seconds / 60, 60), fmod(seconds, 60));
    if (parts & OPENSCAD_SUMMARY_GEOMETRY)
        fprintf(out,
                "   Top level object is a 3D object:\n   Facets:   %9llu\n   Vertices: %9llu\n",
                (unsigned long long)view->triangle_count, (unsigned long long)view->vertex_count);
    if (parts & OPENSCAD_SUMMARY_BOX)
        fprintf(out,
                "Bounding box:\n   Min:  %.2f, %.2f, %.2f\n   Max:  %.2f, %.2f, %.2f\n"
                "   Size: %.2f, %.2f, %.2f\n",
                box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z,
                box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z);
    if (parts & OPENSCAD_SUMMARY_AREA)
        fprintf(out, "Measurements:\n   Area: %.2f\n", check->area);
}

int openscad_summarize(cli_app *app, const openscad_line *line, const char *path,
                       const char *format, double seconds)
{
    csgm_mesh *mesh = NULL;
    csgm_mesh_check check;
    csgm_format kind = format ? csgm_format_from_name(format) : CSGM_FORMAT_AUTO;
    csgm_status status = csgm_mesh_read(app->context, path, kind, &mesh);
    csgm_mesh_view view = {0};
    if (status == CSGM_OK) {
        view = csgm_mesh_get_view(mesh);
        status = csgm_mesh_inspect(app->context, &view, &check);
    }
    int done = cli_exit_status(status);
    if (done == CLI_DONE)
        put_text(app->console.out, line->summary, &view, &check, seconds);
    if (done == CLI_DONE && line->summary_file) {
        cli_text text;
        if (cli_text_open(&text))
            put_json(text.out, &view, &check, seconds);
        done = cli_text_write(app, &text, line->summary_file);
    }
    csgm_mesh_destroy(mesh);
    return done;
}
