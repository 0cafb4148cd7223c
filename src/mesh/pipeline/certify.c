/* SPDX-License-Identifier: MIT
 * What grid/certify/certify.h finds, in the words of the public interface: places in scene units
 * with the source line of the solid there, and a warning each.
 */
#include "mesh/pipeline/certify.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mesh_codes.h"
#include "base/trace.h"
#include "scene/reference.h"
#include "scene/tree/texts.h"

enum { WARNINGS_MOST = 4 };
/* Cells along the longest side of the scan that looks for what adaptive cells have lost. */
enum { SCANNED_CELLS = 64 };

/* Cells whose diagonal is less than this thickness: a ball of it holds a lattice point. */
static double cell_for(double thickness)
{
    return thickness / sqrt(3.0) * 0.98;
}

static void show_source(const csgm_scene *scene, csg_vec3 at, csgm_diag *diag)
{
    csgm_status status = CSGM_OK;
    csg_node_id leaf = csg_reference_deciding_leaf(scene, at, &status);
    if (leaf != CSG_NODE_NONE)
        csg_scene_show_node(scene, leaf, diag);
}

static void write_hint(const csg_mesh_input *in, const csgm_certify_place *place, char *hint,
                       size_t size)
{
    double longest = csg_box_longest_side(in->bounds);
    double resolution = place->cell_size > 0 ? ceil(longest / place->cell_size) : INFINITY;
    if (resolution <= CSG_LATTICE_MOST_CELLS)
        snprintf(hint, size, "-r %.0f or finer (-s %.3g) has it in the mesh", resolution,
                 place->cell_size);
    else
        snprintf(hint, size, "it is thinner than any lattice: make it thicker, or leave it out");
}

/* One finding with its place, its source line and what would settle it. */
static void warn_of_place(const csg_mesh_input *in, const csgm_certify_place *place)
{
    char message[320], hint[120], cells[64] = "";
    csgm_diag diag = {.message = message, .hint = hint};
    show_source(in->field->scene, place->at, &diag);
    if (place->cells > 1)
        snprintf(cells, sizeof cells, ", in %llu cells", (unsigned long long)place->cells);
    if (place->is_missed) {
        snprintf(message, sizeof message,
                 "%s about %.2g thick is not in the mesh: it lies between the lattice's points "
                 "near (%.6g, %.6g, %.6g)%s",
                 place->is_gap ? "a gap" : "a part", place->thickness, place->at.x, place->at.y,
                 place->at.z, cells);
        write_hint(in, place, hint, sizeof hint);
    } else {
        snprintf(message, sizeof message,
                 "it could not be told whether a part is missing near (%.6g, %.6g, %.6g)%s",
                 place->at.x, place->at.y, place->at.z, cells);
        snprintf(hint, sizeof hint, "the field's bounds are loose there: a higher -r helps");
    }
    csg_diag_report(&in->context->diags,
                    place->is_missed ? CSG_DIAG_THIN_PART : CSG_DIAG_NOT_CERTIFIED, diag);
}

static csgm_certify_place translate(const csg_mesh_input *in, const csg_certify_place *from)
{
    csgm_diag diag = {0};
    csgm_certify_place place = {.is_missed = from->kind == CSG_CELL_MISSED,
                                .is_gap = from->is_gap,
                                .at = from->at,
                                .cells = from->cells};
    if (place.is_missed) {
        place.thickness = from->thickness;
        place.cell_size = cell_for(from->thickness);
    }
    show_source(in->field->scene, from->at, &diag);
    place.source_name = diag.source_name;
    place.line = diag.line;
    place.column = diag.column;
    return place;
}

/* What is missed, a warning per place; what is unresolved, one for all. */
static void warn_of_places(const csg_mesh_input *in, const csgm_certify *certify)
{
    uint32_t missed = 0, unresolved = 0;
    for (uint32_t i = 0; i < certify->place_count; i++) {
        const csgm_certify_place *place = &certify->places[i];
        uint32_t before = place->is_missed ? missed++ : unresolved++;
        if (before < (place->is_missed ? WARNINGS_MOST : 1))
            warn_of_place(in, place);
    }
}

static csgm_status certify(const csg_mesh_input *in, csg_mesh_watch *watch, csg_mesh_doubts *doubts)
{
    csg_certify_report report;
    csgm_certify *out = &doubts->certify;
    double size = in->options->certify_size;
    csg_certify_options options = {.size = size > 0 ? size : in->lattice.cell_size / 64,
                                   .cancelled = csg_mesh_should_stop,
                                   .progress = csg_mesh_report_progress,
                                   .user = watch};
    csg_mesh_take(watch, CSGM_STAGE_CERTIFY, 1);
    csgm_status status = csg_certify_run(in->context, in->field, &in->lattice, &options, &report);
    if (status != CSGM_OK)
        return status == CSGM_CANCELLED ? csg_mesh_why_stopped(watch) : status;
    out->certified = report.cells[CSG_CELL_CERTIFIED];
    out->crease = report.cells[CSG_CELL_CREASE];
    out->refined = report.cells[CSG_CELL_REFINED];
    out->unresolved = doubts->unresolved_cells = report.cells[CSG_CELL_UNRESOLVED];
    out->missed = report.cells[CSG_CELL_MISSED];
    out->thickness = report.promise;
    out->places_more = report.place_more;
    for (uint32_t i = 0; i < report.place_count; i++)
        out->places[out->place_count++] = translate(in, &report.places[i]);
    warn_of_places(in, out);
    return CSGM_OK;
}

static csgm_status follow_doubts(const csg_mesh_input *in, csg_octree *octree,
                                 csg_mesh_doubts *doubts)
{
    CSG_ZONE(in->context, "doubts");
    csg_certify_place place;
    csgm_status status;
    if (!csg_certify_doubts(in->context, in->field, &in->lattice, octree, NULL, NULL, &place,
                            &doubts->unresolved_cells, &status))
        return status;
    csgm_certify_place shown = translate(in, &place);
    shown.cells = 1; /* the doubts are not all of one part */
    warn_of_place(in, &shown);
    return CSGM_OK;
}

csgm_status csg_mesh_look_for_missed(const csg_mesh_input *in, csg_octree *octree,
                                     csg_mesh_watch *watch, csg_mesh_doubts *doubts)
{
    doubts->certify.is_done = in->options->certify;
    if (!octree)
        return CSGM_OK;
    return in->options->certify ? certify(in, watch, doubts) : follow_doubts(in, octree, doubts);
}

/* ---- cells that follow the shape ---------------------------------------------------------------
 */

typedef struct loss {
    const csg_bricks *bricks;
    double thinnest; /* that leaves are trusted to have whole */
} loss;

static bool is_lost(const void *user, csg_vec3 at, double thickness, bool is_gap)
{
    const loss *l = user;
    float place[3];
    csg_vec3_to_floats(place, at);
    return thickness < l->thinnest || !csg_bricks_have(l->bricks, place, !is_gap);
}

static void warn_of_lost(const csg_mesh_input *in, const csg_certify_place *place, double tolerance)
{
    char message[320], hint[120];
    csgm_diag diag = {.message = message, .hint = hint};
    show_source(in->field->scene, place->at, &diag);
    snprintf(
        message, sizeof message,
        "%s about %.2g thick is not in the mesh, or not all of it: the tolerance is %.3g; it is "
        "near (%.6g, %.6g, %.6g)",
        place->is_gap ? "a gap" : "a part", place->thickness, tolerance, place->at.x, place->at.y,
        place->at.z);
    snprintf(hint, sizeof hint, "%s %.2g makes cells that are small enough for it",
             in->options->tolerance > 0 ? "-e" : "--simplify", place->thickness);
    csg_diag_report(&in->context->diags, CSG_DIAG_THIN_PART, diag);
}

csgm_status csg_mesh_look_for_lost(const csg_mesh_input *in, const csg_bricks *bricks,
                                   double tolerance, bool raised, csg_mesh_watch *watch)
{
    CSG_ZONE(in->context, "doubts");
    const csg_octree_options options = {.prune = in->options->prune,
                                        .scan = true,
                                        .cancelled = csg_mesh_should_stop,
                                        .user = watch};
    csg_lattice lattice;
    csg_octree *octree = NULL;
    csg_certify_place place;
    uint64_t edges;
    const loss lost = {bricks, raised ? tolerance : 0};
    if (!csg_lattice_make(in->bounds, in->field->center, 0, SCANNED_CELLS, &lattice))
        return CSGM_OK;
    csgm_status status = csg_octree_create(in->context, in->field, &lattice, &options, &octree);
    if (status == CSGM_OK)
        status = csg_octree_sample(octree, 0, csg_octree_frontier_count(octree));
    if (status == CSGM_OK && csg_certify_doubts(in->context, in->field, &lattice, octree, is_lost,
                                                &lost, &place, &edges, &status))
        warn_of_lost(in, &place, tolerance);
    csg_octree_destroy(octree);
    return status == CSGM_CANCELLED ? csg_mesh_why_stopped(watch) : status;
}

void csg_mesh_add_certify(csgm_certify *sum, const csgm_certify *part)
{
    sum->is_done |= part->is_done;
    sum->certified += part->certified;
    sum->crease += part->crease;
    sum->refined += part->refined;
    sum->unresolved += part->unresolved;
    sum->missed += part->missed;
    sum->thickness = fmax(sum->thickness, part->thickness);
    sum->places_more += part->places_more;
    for (uint32_t i = 0; i < part->place_count; i++) {
        if (sum->place_count < CSGM_CERTIFY_PLACES_MOST)
            sum->places[sum->place_count++] = part->places[i];
        else
            sum->places_more++;
    }
}
