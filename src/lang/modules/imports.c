/* SPDX-License-Identifier: MIT
 * import(): flat figures from SVG and DXF, solids from files of meshes. What was left out of a file
 * or mended is told.
 */
#include "lang/modules/imports.h"

#include <stdio.h>
#include <string.h>

#include "base/scene_codes.h"
#include "lang/evaluate/files.h"
#include "lang/services.h"
#include "outline/dxf/dxf.h"
#include "outline/svg/svg.h"
#include "text/folders.h"

/* ---- finding --------------------------------------------------------------------------------- */

const char *csg_import_find(csg_module_call *call, uint32_t index)
{
    csg_eval *e = call->e;
    csg_value name = call->values[index];
    if (name.kind != CSG_VALUE_STRING || name.as.string->length == 0) {
        csg_argument_error(call, index, CSG_DIAG_BAD_TYPE, "%s must be the name of a file",
                           call->parameters[index].name);
        return NULL;
    }
    const char *found = csg_file_find(e, name.as.string->text, call->statement->where);
    if (found)
        return found;
    if (!e->stop)
        csg_eval_report(e, CSG_DIAG_IMPORT_NOT_FOUND, call->spans[index], CSG_FOLDERS_IN_WORDS,
                        "%s(): there is no file '%.200s'%s", call->name, name.as.string->text,
                        csg_eval_is_lenient(e, CSG_DIAG_IMPORT_NOT_FOUND, call->spans[index])
                            ? "; it is left out"
                            : "");
    call->failed = true;
    return NULL;
}

/* ---- figures --------------------------------------------------------------------------------- */

typedef struct drawing { /* where the arguments of a drawing stand; UINT32_MAX: nowhere */
    uint32_t file, layer, origin, scale, center, dpi, id;
} drawing;

static bool given(const csg_module_call *call, uint32_t index)
{
    return index != UINT32_MAX && csg_has_argument(call, index);
}

static const char *text_of(const csg_module_call *call, uint32_t index)
{
    return given(call, index) && call->values[index].kind == CSG_VALUE_STRING
               ? call->values[index].as.string->text
               : NULL;
}

static void tell(csg_module_call *call, uint32_t index, size_t count, const char *what,
                 const char *hint)
{
    if (count)
        csg_eval_report(call->e, CSG_DIAG_LEFT_OUT, call->spans[index], hint, "%s(): %zu %s",
                        call->name, count, what);
}

static void tell_of_svg(csg_module_call *call, uint32_t file, const csg_svg_report *report)
{
    size_t others = report->images + report->clips + report->unresolved + report->unknown;
    if (report->not_found)
        csg_eval_report(call->e, CSG_DIAG_LEFT_OUT, call->spans[file], NULL,
                        "%s(): the drawing has no element of this id or layer", call->name);
    else if (report->texts)
        tell(call, file, report->texts, "texts of the drawing are left out",
             "make them paths in the drawing program");
    else if (report->broken)
        tell(call, file, report->broken,
             "paths or transforms are broken, and drawn as far as they are right", NULL);
    else if (report->sheets)
        tell(call, file, report->sheets, "style sheets of the drawing are not looked at", NULL);
    else
        tell(call, file, others, "images, clippings or other elements are left out", NULL);
}

static csgm_status read_svg(csg_module_call *call, const drawing *d, const csg_bytes *bytes,
                            csg_outline *out, csg_problem *problem)
{
    csg_svg_report report = {0};
    double dpi = d->dpi == UINT32_MAX ? 72 : csg_argument_number(call, d->dpi, 72, CSG_POSITIVE);
    const csg_svg_request request = {.text = bytes->data,
                                     .length = bytes->size,
                                     .tolerance = 0.002,
                                     .dpi = dpi,
                                     .center = given(call, d->center) &&
                                               csg_argument_boolean(call, d->center),
                                     .id = text_of(call, d->id),
                                     .layer = text_of(call, d->layer)};
    csgm_status status = csg_svg_outline(out->memory, &request, out, &report);
    if (status == CSGM_OK)
        tell_of_svg(call, d->file, &report);
    *problem = report.problem;
    return status;
}

static uint32_t fragments(const void *user, double radius)
{
    return csg_fragments(user, radius);
}

static csgm_status read_dxf(csg_module_call *call, const drawing *d, const csg_bytes *bytes,
                            csg_outline *out, csg_problem *problem)
{
    csg_dxf_report report = {0};
    csg_vec3 origin = {0, 0, 0};
    if (given(call, d->origin))
        origin = csg_argument_vector(call, d->origin, origin, false);
    double scale =
        d->scale == UINT32_MAX ? 1 : csg_argument_number(call, d->scale, 1, CSG_POSITIVE);
    csg_facet_rule rule = csg_facet_rule_now(call->e);
    const csg_dxf_request request = {.text = bytes->data,
                                     .length = bytes->size,
                                     .tolerance = 0.002,
                                     .fragments = rule.exact ? fragments : NULL,
                                     .fragments_user = &rule,
                                     .layer = text_of(call, d->layer),
                                     .origin = {origin.x, origin.y},
                                     .scale = scale,
                                     .center = given(call, d->center) &&
                                               csg_argument_boolean(call, d->center)};
    csgm_status status = csg_dxf_outline(out->memory, &request, out, &report);
    *problem = report.problem;
    if (status != CSGM_OK)
        return status;
    if (report.not_found)
        csg_eval_report(call->e, CSG_DIAG_LEFT_OUT, call->spans[d->file], NULL,
                        "%s(): the drawing has nothing on this layer", call->name);
    else if (report.unclosed)
        tell(call, d->file, report.unclosed, "runs of lines are not closed", NULL);
    else
        tell(call, d->file, report.ignored + report.unresolved,
             "entities of the drawing make no area and are left out", report.ignored_kind);
    return status;
}

static csg_node_id failed_import(csg_module_call *call, uint32_t file, csgm_status status,
                                 const char *path, const char *problem)
{
    if (status == CSGM_ERR_MEMORY) {
        csg_eval_no_memory(call->e);
        return CSG_NODE_NONE;
    }
    if (!call->failed)
        csg_argument_error(call, file, CSG_DIAG_BAD_IMPORT, "'%.120s': %s", path,
                           problem[0]                       ? problem
                           : status == CSGM_ERR_UNSUPPORTED ? "this build has no library for it"
                                                            : "it cannot be read");
    return csg_shape_empty(call);
}

/* The figure of a drawing; NONE and not stopped: it is none by its name. */
static csg_node_id import_drawing(csg_module_call *call, const drawing *d, const char *path)
{
    csg_memory *memory = call->e->heap.memory;
    char extension[8];
    csg_bytes bytes;
    csg_outline outline;
    csg_problem problem = {""};
    csg_file_extension(path, extension);
    bool svg = strcmp(extension, "svg") == 0;
    if (!svg && strcmp(extension, "dxf") != 0)
        return CSG_NODE_NONE;
    csg_outline_init(&outline, memory);
    csgm_status status = csg_bytes_read(memory, path, &bytes, &problem);
    if (status == CSGM_OK) {
        status = svg ? read_svg(call, d, &bytes, &outline, &problem)
                     : read_dxf(call, d, &bytes, &outline, &problem);
        csg_bytes_release(&bytes);
    }
    if (status == CSGM_OK)
        return csg_shape_area(call, &outline, false);
    csg_outline_release(&outline);
    return failed_import(call, d->file, status, path, problem.text);
}

csg_node_id csg_import_figure(csg_module_call *call, uint32_t file, uint32_t layer, uint32_t origin)
{
    const drawing d = {file, layer, origin, UINT32_MAX, UINT32_MAX, UINT32_MAX, UINT32_MAX};
    const char *path = csg_import_find(call, file);
    if (!path)
        return csg_shape_empty(call);
    csg_node_id node = import_drawing(call, &d, path);
    if (node != CSG_NODE_NONE || call->e->stop)
        return node;
    return failed_import(call, file, CSGM_ERR_FORMAT, path, "a figure comes from .svg or .dxf");
}

/* ---- solids ---------------------------------------------------------------------------------- */

static csg_node_id import_mesh(csg_module_call *call, uint32_t file, const char *path)
{
    csg_eval *e = call->e;
    const csg_services *services = e->program->services;
    csg_triangles triangles;
    char problem[240] = "";
    csg_triangles_init(&triangles, e->heap.memory);
    csgm_status status =
        services ? services->read_mesh(e->context, path, &triangles, problem, sizeof problem)
                 : CSGM_ERR_UNSUPPORTED;
    if (status == CSGM_OK)
        return csg_shape_solid(call, &triangles, true);
    csg_triangles_release(&triangles);
    return failed_import(call, file, status, path, problem);
}

static csg_node_id centered(csg_module_call *call, csg_node_id node)
{
    csg_box box;
    if (node == CSG_NODE_NONE || csg_eval_is_empty(call->e, node))
        return node;
    if (!csg_shape_box(call, node, &box))
        return csg_shape_empty(call);
    csg_affine by = csg_affine_translate(csg_vec3_scale(csg_box_center(box), -1));
    return csg_shape_moved(call, node, &by);
}

csg_node_id csg_module_import(csg_module_call *call)
{
    enum {
        FILE_NAME,
        LAYER,
        CONVEXITY,
        ORIGIN,
        SCALE,
        CENTER,
        DPI,
        ID,
        TIMESTAMP,
        BOUNDS,
        LIPSCHITZ
    };
    const drawing d = {FILE_NAME, LAYER, ORIGIN, SCALE, CENTER, DPI, ID};
    char extension[8];
    const char *path = csg_import_find(call, FILE_NAME);
    if (!path)
        return csg_shape_empty(call);
    csg_node_id node = import_drawing(call, &d, path);
    if (node != CSG_NODE_NONE || call->e->stop)
        return node;
    csg_file_extension(path, extension);
    node = strcmp(extension, "vm") == 0 ? csg_import_tape(call, path, FILE_NAME, BOUNDS, LIPSCHITZ)
                                        : import_mesh(call, FILE_NAME, path);
    return csg_argument_boolean(call, CENTER) ? centered(call, node) : node;
}
