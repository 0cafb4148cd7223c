/* SPDX-License-Identifier: MIT
 * Part by part: mended, through OpenMesh, into the mesh that comes out. A part that encloses
 * nothing is left as it is.
 */
#include "mesh/foreign/foreign.h"

#include <stdio.h>

#include "base/mesh_codes.h"
#include "base/scene_codes.h"
#include "base/trace.h"
#include "mesh/foreign/output.h"
#include "mesh/foreign/piece.h"

typedef struct job {
    csg_mesh_watch *watch;
    csgm_mesh_view source;
    const csg_foreign_goals *goals;
    csg_foreign_output output;
    double before, share; /* of the part at hand, of all triangles */
} job;

static bool stop(void *user)
{
    return csg_mesh_should_stop(((job *)user)->watch);
}

static void tell(void *user, double fraction)
{
    const job *j = user;
    csg_mesh_report_progress(j->watch, j->before + j->share * fraction);
}

static csgm_status why_stopped(job *j)
{
    return csg_mesh_why_work_stopped(j->watch, "changing the mesh", "raise --timeout");
}

/* "part 'lid': ", or nothing where there is one part only. */
static const char *name_part(const job *j, const csgm_mesh_part *part, char *text, size_t size)
{
    text[0] = '\0';
    if (j->source.part_count > 1)
        snprintf(text, size, "part '%.80s': ", part->name ? part->name : "");
    return text;
}

static void tell_mended(job *j, const csgm_mesh_part *part, const csg_repairs *repairs)
{
    char name[100], text[256];
    if (!j->goals->tells || !csg_repairs_are_any(repairs))
        return;
    csg_repairs_describe(repairs, text, sizeof text);
    csg_diag_plain(&j->watch->context->diags, CSG_DIAG_MENDED, NULL, NULL,
                   "%sthe surface was mended: %s", name_part(j, part, name, sizeof name), text);
}

static void tell_left(job *j, const csgm_mesh_part *part)
{
    char name[100];
    if (j->goals->tells)
        csg_diag_plain(&j->watch->context->diags, CSG_DIAG_LEFT_AS_IT_IS, NULL, NULL,
                       "%sthe triangles enclose nothing and were left as they are",
                       name_part(j, part, name, sizeof name));
}

static csgm_status change(job *j, csg_foreign_piece *piece)
{
    const csg_foreign_goals *goals = j->goals;
    double scale = piece->frame.scale, share = goals->share;
    csg_halfedge_goals of_piece = {
        .within = goals->within * scale,
        .triangles = share > 0 ? (uint64_t)fmax(4, share * (double)piece->mesh.triangle_count) : 0,
        .smooth = goals->smooth,
        .improve = goals->improve * scale};
    csg_halfedge_watch watch = {j, stop, tell};
    if (!(goals->within > 0) && !(share > 0) && !goals->smooth && !(goals->improve > 0))
        return CSGM_OK;
    csgm_context *context = j->watch->context;
    if (!csg_memory_allows(&context->memory, piece->mesh.triangle_count * CSG_HALFEDGE_BYTES))
        return csg_context_no_memory(context);
    switch (csg_halfedges_reshape(&piece->mesh, &of_piece, &watch)) {
    case CSG_HALFEDGES_DONE:
        return CSGM_OK;
    case CSG_HALFEDGES_STOPPED:
        return why_stopped(j);
    case CSG_HALFEDGES_NO_MEMORY:
        return csg_context_no_memory(context);
    case CSG_HALFEDGES_REFUSED:
        break;
    }
    csg_diag_plain(&context->diags, CSG_DIAG_OPEN_MESH, NULL, "please report this with the mesh",
                   "the mended mesh is no manifold, which is a bug in csgmesh");
    return CSGM_ERR_INTERNAL;
}

static csgm_status do_part(job *j, csg_arena *arena, const csgm_mesh_part *part)
{
    csg_foreign_piece piece;
    csg_repairs repairs;
    csg_memory *memory = &j->watch->context->memory;
    csg_memory_end_when(memory, stop,
                        j); /* mending knows of no time, but takes memory in each step */
    csgm_status status = csg_foreign_piece_make(arena, &j->source, part->first_triangle,
                                                part->triangle_count, &piece, &repairs);
    bool good = true, is_late = csg_memory_has_ended(memory);
    csg_memory_end_when(memory, NULL, NULL);
    if (is_late)
        return why_stopped(j);
    if (status == CSGM_ERR_SCENE) {
        tell_left(j, part);
        good =
            csg_foreign_output_copy(&j->output, arena, part->first_triangle, part->triangle_count);
    } else if (status == CSGM_OK) {
        tell_mended(j, part, &repairs);
        status = change(j, &piece);
        if (status != CSGM_OK)
            return status;
        good = csg_foreign_output_add(&j->output, &piece);
    }
    return good && status != CSGM_ERR_MEMORY ? CSGM_OK : csg_context_no_memory(j->watch->context);
}

static csgm_status do_parts(job *j, const csgm_mesh_part *parts, size_t count, uint64_t *starts)
{
    csg_arena arena;
    csgm_status status = CSGM_OK;
    for (size_t i = 0; i < count && status == CSGM_OK; i++) {
        double all = (double)j->source.triangle_count;
        j->before = (double)parts[i].first_triangle / all;
        j->share = (double)parts[i].triangle_count / all;
        starts[i] = j->output.triangle_count;
        csg_arena_init(&arena, &j->watch->context->memory);
        status = stop(j) ? why_stopped(j) : do_part(j, &arena, &parts[i]);
        csg_arena_reset(&arena);
    }
    return status;
}

csgm_status csg_foreign_reshape(csg_mesh_watch *watch, const csgm_mesh_view *mesh,
                                const csg_foreign_goals *goals, csgm_mesh **out)
{
    csgm_context *context = watch->context;
    CSG_ZONE(context, "reshape");
    const csgm_mesh_part whole = {NULL, 0, mesh->triangle_count};
    const csgm_mesh_part *parts = mesh->parts ? mesh->parts : &whole;
    size_t count = mesh->parts ? (size_t)mesh->part_count : 1;
    job j = {.watch = watch, .source = *mesh, .goals = goals};
    uint64_t *starts = csg_memory_alloc(&context->memory, count * sizeof *starts);
    if (!starts)
        return csg_context_no_memory(context);
    csg_foreign_output_init(&j.output, context, mesh);
    csgm_status status = do_parts(&j, parts, count, starts);
    csgm_mesh *made = NULL;
    if (status == CSGM_OK)
        status = csg_foreign_output_finish(&j.output, &made);
    for (size_t i = 0; mesh->parts && i < count && status == CSGM_OK; i++)
        status = csg_mesh_add_part(made, parts[i].name, starts[i]);
    csg_foreign_output_release(&j.output);
    csg_memory_release(&context->memory, starts, count * sizeof *starts);
    if (status != CSGM_OK)
        csg_mesh_destroy(made);
    else
        *out = made;
    return status;
}
