/* SPDX-License-Identifier: MIT
 * The report of --certify; see certify.h.
 */
#include "mesh/certify.h"

#include <inttypes.h>

static void tell_promise(FILE *out, const csgm_certify *certify)
{
    const char *but = certify->missed || certify->unresolved ? ", but for" : "";
    if (certify->thickness > 0)
        fprintf(out, "every part of the surface thicker than %.3g is in the mesh%s",
                certify->thickness, but);
    else
        fprintf(out, "every part of the surface is in the mesh%s", but);
    if (certify->missed)
        fprintf(out, " what is missed in %" PRIu64 " cells", certify->missed);
    if (certify->unresolved)
        fprintf(out, "%s %" PRIu64 " cells where it could not be told",
                certify->missed ? " and" : "", certify->unresolved);
    fputc('\n', out);
}

static void tell_place(FILE *out, const csgm_certify_place *place)
{
    fputs("  ", out);
    if (place->source_name)
        fprintf(out, "%s:%u:%u: ", place->source_name, place->line, place->column);
    if (place->is_missed)
        fprintf(out, "%s %.3g thick, missed", place->is_gap ? "a gap" : "a part", place->thickness);
    else
        fputs("unresolved", out);
    fprintf(out, ": %" PRIu64 " cells near (%.6g, %.6g, %.6g)", place->cells, place->at.x,
            place->at.y, place->at.z);
    if (place->is_missed)
        fprintf(out, ", settled by -s %.3g", place->cell_size);
    fputc('\n', out);
}

void cli_certify_tell(cli_app *app, const csgm_certify *certify)
{
    FILE *out = app->console.out;
    if (!certify->is_done || app->console.quiet || app->console.json)
        return;
    fputs("certify: ", out);
    tell_promise(out, certify);
    fprintf(out,
            "  cells of the surface: %" PRIu64 " certified, %" PRIu64 " with creases, %" PRIu64
            " refined, %" PRIu64 " unresolved, %" PRIu64 " missed\n",
            certify->certified, certify->crease, certify->refined, certify->unresolved,
            certify->missed);
    for (uint32_t i = 0; i < certify->place_count; i++)
        tell_place(out, &certify->places[i]);
    if (certify->places_more)
        fprintf(out, "  and %" PRIu64 " more cells elsewhere\n", certify->places_more);
}

void cli_certify_json(cli_json *json, const csgm_certify *certify)
{
    if (!certify->is_done)
        return;
    cli_json_open(json, "certify", '{');
    cli_json_number(json, "thickness", certify->thickness);
    cli_json_count(json, "certified", certify->certified);
    cli_json_count(json, "crease", certify->crease);
    cli_json_count(json, "refined", certify->refined);
    cli_json_count(json, "unresolved", certify->unresolved);
    cli_json_count(json, "missed", certify->missed);
    cli_json_open(json, "places", '[');
    for (uint32_t i = 0; i < certify->place_count; i++) {
        const csgm_certify_place *place = &certify->places[i];
        cli_json_open(json, NULL, '{');
        cli_json_string(json, "kind", place->is_missed ? "missed" : "unresolved");
        cli_json_bool(json, "gap", place->is_gap);
        cli_json_vec3(json, "at", place->at);
        cli_json_number(json, "thickness", place->thickness);
        cli_json_number(json, "cell_size", place->cell_size);
        cli_json_count(json, "cells", place->cells);
        if (place->source_name) {
            cli_json_string(json, "file", place->source_name);
            cli_json_count(json, "line", place->line);
            cli_json_count(json, "column", place->column);
        }
        cli_json_end(json, '}');
    }
    cli_json_end(json, ']');
    cli_json_count(json, "places_more", certify->places_more);
    cli_json_end(json, '}');
}
