/* SPDX-License-Identifier: MIT
 * Meshes of any field; see parts.h. Of several parts each part of the field is meshed by itself on
 * one lattice for all, and their vertices and triangles are put one after the other. A part without
 * a surface is left out.
 */
#include "mesh/pipeline/parts.h"

#include <math.h>
#include <string.h>

#include "base/clock.h"
#include "base/mesh_codes.h"
#include "base/ranks.h"
#include "mesh/pipeline/own.h"
#include "mesh/pipeline/ranks.h"
#include "mesh/pipeline/stats.h"
#include "mesh/pipeline/tries.h"

/* A field without parts. */
static csgm_status build_part(csgm_context *context, const csgm_field *field,
                              const csgm_mesh_options *options, const csg_mesh_share *share,
                              csgm_mesh **out, csgm_mesh_stats *stats)
{
    csgm_mesh *own = NULL;
    csgm_status status = CSGM_OK;
    if (csg_mesh_may_be_own(options))
        status = csg_mesh_build_own(context, field, options, share, &own, stats);
    if (status != CSGM_OK || (own && !csg_mesh_reshapes_own(options, own->triangle_count))) {
        *out = own;
        return status;
    }
    return csg_mesh_is_reshaped(options)
               ? csg_mesh_build_tries(context, field, options, share, own, out, stats)
               : csg_mesh_build_field(context, field, options, share, NULL, out, stats);
}

typedef struct assembly {
    csgm_context *context;
    const csgm_field *field;
    csgm_mesh_options options; /* with bounds for all */
    csg_mesh_share share;
    csgm_mesh **meshes; /* one per part */
} assembly;

/* One lattice for all parts: around their bounds, where none are given. A part without end is left
 * to say so itself. */
static void choose_bounds(assembly *a)
{
    if (!csg_box_is_empty(a->options.bounds))
        return;
    csg_box bounds = csg_box_empty();
    for (size_t i = 0; i < a->field->part_count; i++)
        bounds = csg_box_hull(bounds, a->field->parts[i].field->bounds);
    if (csg_box_is_finite(bounds))
        a->options.bounds = bounds;
}

static void begin(assembly *a)
{
    choose_bounds(a);
    csg_box bounds = a->options.bounds;
    a->share.started_s = csg_clock_now_s();
    a->share.amount = 1.0 / (double)a->field->part_count;
    if (!csg_box_is_empty(bounds) && csg_box_is_finite(bounds))
        a->share.origin = csg_mesh_origin(csg_box_center(bounds), bounds);
    for (size_t i = 0; i < a->field->part_count; i++) {
        a->share.colors |= csg_mesh_is_colored(a->field->parts[i].field);
        a->share.materials |= a->field->parts[i].field->has_materials;
    }
}

static csgm_status build_all(assembly *a, csgm_mesh_stats *stats)
{
    csgm_status status = CSGM_OK;
    for (size_t i = 0; i < a->field->part_count && status == CSGM_OK; i++) {
        const csg_field_part *part = &a->field->parts[i];
        csgm_mesh_stats own = {0};
        a->share.name = part->name;
        a->share.before = (double)i * a->share.amount;
        status = build_part(a->context, part->field, &a->options, &a->share, &a->meshes[i], &own);
        csg_mesh_add_stats(stats, &own);
    }
    return status;
}

/* Copies a part's arrays behind what is there. */
static void append(csgm_mesh *to, const csgm_mesh *part, uint64_t vertices, uint64_t triangles)
{
    size_t count = (size_t)part->vertex_count;
    memcpy(to->positions + 3 * vertices, part->positions, count * 3 * sizeof(float));
    if (to->normals)
        memcpy(to->normals + 3 * vertices, part->normals, count * 3 * sizeof(float));
    if (to->colors)
        memcpy(to->colors + 4 * vertices, part->colors, count * 4);
    if (to->materials)
        memcpy(to->materials + 2 * vertices, part->materials, count * 2 * sizeof(uint16_t));
    for (uint64_t i = 0; i < 3 * part->triangle_count; i++)
        to->indices[3 * triangles + i] = part->indices[i] + (uint32_t)vertices;
}

/* Parts are given back as soon as they are copied. */
static csgm_status append_parts(assembly *a, csgm_mesh *mesh)
{
    uint64_t vertices = 0, triangles = 0;
    csgm_status status = CSGM_OK;
    for (size_t i = 0; i < a->field->part_count && status == CSGM_OK; i++) {
        csgm_mesh *part = a->meshes[i];
        if (!part->triangle_count)
            continue;
        append(mesh, part, vertices, triangles);
        status = csg_mesh_add_part(mesh, a->field->parts[i].name, triangles);
        vertices += part->vertex_count;
        triangles += part->triangle_count;
        csg_mesh_destroy(part);
        a->meshes[i] = NULL;
    }
    return status;
}

static csgm_status assemble(assembly *a, csgm_mesh **out)
{
    uint64_t vertices = 0, triangles = 0;
    csgm_mesh *mesh;
    for (size_t i = 0; i < a->field->part_count; i++) {
        vertices += a->meshes[i]->vertex_count;
        triangles += a->meshes[i]->triangle_count;
    }
    if (vertices >= UINT32_MAX) {
        csg_diag_plain(&a->context->diags, CSG_DIAG_MESH_TOO_LARGE, NULL,
                       "mesh more coarsely: --quality draft, or a lower -r",
                       "the parts have %llu vertices in all, more than 32 bits can number",
                       (unsigned long long)vertices);
        return CSGM_ERR_LIMIT;
    }
    csgm_status status =
        csg_mesh_create(a->context, vertices, triangles, a->options.normals != CSGM_NORMALS_NONE,
                        a->share.colors && a->options.colors, &mesh);
    if (status != CSGM_OK)
        return status;
    mesh->origin = a->share.origin;
    mesh->split = a->options.normals == CSGM_NORMALS_CREASE;
    if (a->share.materials && a->options.colors)
        status = csg_mesh_add_materials(mesh);
    if (status == CSGM_OK)
        status = append_parts(a, mesh);
    if (status == CSGM_OK)
        *out = mesh;
    else
        csg_mesh_destroy(mesh);
    return status;
}

static csgm_status build_parts(csgm_context *context, const csgm_field *field,
                               const csgm_mesh_options *options, csgm_mesh **out,
                               csgm_mesh_stats *stats)
{
    assembly a = {.context = context, .field = field, .options = *options};
    size_t bytes = field->part_count * sizeof *a.meshes;
    csgm_mesh_stats ignored;
    stats = stats ? stats : &ignored;
    *stats = (csgm_mesh_stats){0};
    a.meshes = csg_memory_alloc(&context->memory, bytes);
    csgm_status status =
        csg_ranks_agree(context, a.meshes ? CSGM_OK : csg_context_no_memory(context));
    if (a.meshes)
        memset(a.meshes, 0, bytes);
    begin(&a);
    if (status == CSGM_OK)
        status = build_all(&a, stats);
    if (status == CSGM_OK)
        status = assemble(&a, out);
    for (size_t i = 0; a.meshes && i < field->part_count; i++)
        csg_mesh_destroy(a.meshes[i]);
    csg_memory_release(&context->memory, a.meshes, bytes);
    return status;
}

/* What ranks must have in common to reshape one mesh, of a field without parts or a part. */
typedef struct common {
    uint64_t tape, triangles, limit_bytes; /* whether it is thinned out in tiles */
    double size[4], lipschitz;
    csg_box bounds[2];
    uint32_t ways[7];
} common;

static common common_of(const csgm_context *context, const csgm_field *field,
                        const csgm_mesh_options *o)
{
    common own;
    memset(&own, 0, sizeof own); /* between its members, too */
    own.tape = field->tape.count;
    own.triangles = o->triangles;
    own.limit_bytes = context->memory.limit_bytes;
    own.lipschitz = (double)field->tape.lipschitz;
    own.bounds[0] = field->bounds;
    own.bounds[1] = o->bounds;
    const double size[] = {o->tolerance, o->simplify_error, o->simplify_share, o->cell_size};
    const uint32_t ways[] = {o->resolution,        (uint32_t)o->quality, (uint32_t)o->features,
                             (uint32_t)o->normals, (uint32_t)o->improve, (uint32_t)o->colors,
                             (uint32_t)o->prune};
    memcpy(own.size, size, sizeof size);
    memcpy(own.ways, ways, sizeof ways);
    return own;
}

/* Ranks with another scene would wait for each other in different places. */
static csgm_status compare_ranks(csgm_context *context, const csgm_field *field,
                                 const csgm_mesh_options *options)
{
    size_t count = field->part_count ? field->part_count : 1;
    common *each = csg_memory_alloc(&context->memory, count * sizeof *each);
    for (size_t i = 0; each && i < count; i++)
        each[i] = common_of(context, field->part_count ? field->parts[i].field : field, options);
    csgm_status status = csg_ranks_agree(context, each ? CSGM_OK : csg_context_no_memory(context));
    if (status == CSGM_OK)
        status = csg_mesh_ranks_compare(context, each, count * sizeof *each);
    csg_memory_release(&context->memory, each, each ? count * sizeof *each : 0);
    return status;
}

csgm_status csg_mesh_build(csgm_context *context, const csgm_field *field,
                           const csgm_mesh_options *options, csgm_mesh **out,
                           csgm_mesh_stats *stats)
{
    csgm_status status = CSGM_OK;
    if (context->ranks && csg_mesh_is_reshaped(options))
        status = compare_ranks(context, field, options);
    if (status == CSGM_OK)
        status = field->part_count ? build_parts(context, field, options, out, stats)
                                   : build_part(context, field, options, NULL, out, stats);
    status = csg_mesh_ranks_settle(context, status, out);
    if (status == CSGM_OK)
        (*out)->equal_cells = csg_mesh_can_stream(field, options);
    return status;
}

bool csg_mesh_can_stream(const csgm_field *field, const csgm_mesh_options *options)
{
    return !field->part_count && !(field->has_materials && options->colors) &&
           !csg_mesh_is_reshaped(options);
}

double csg_mesh_distance(const csgm_field *field, const csgm_mesh_options *options)
{
    csg_box bounds = csg_box_is_empty(options->bounds) ? field->bounds : options->bounds;
    if (csg_box_is_empty(bounds) || !csg_box_is_finite(bounds))
        return 0;
    /* a field that bounds cut gets their middle for its own (csg_field_clip) */
    csg_vec3 center =
        csg_box_contains_box(bounds, field->bounds) ? field->center : csg_field_center(bounds);
    return csg_vec3_norm(csg_mesh_origin(center, bounds)) / csg_box_longest_side(bounds);
}
