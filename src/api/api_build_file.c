/* SPDX-License-Identifier: MIT
 * Meshes of the public interface that go into a file while they are made, where it can be filled
 * so, with or without their figures.
 */
#include "api/options.h"

#include <math.h>
#include <string.h>

#include "api/max_abs_field.h"
#include "base/mesh_codes.h"
#include "base/pool.h"
#include "base/ranks.h"
#include "csgmesh/figures.h"
#include "io/formats.h"
#include "io/stream.h"
#include "mesh/collect.h"
#include "mesh/figures/figures.h"
#include "mesh/inspect.h"
#include "mesh/mesh.h"
#include "mesh/pipeline/parts.h"
#include "mesh/view.h"

/* What is made and what is asked of it. */
typedef struct order {
    csgm_context *context;
    const csgm_scene *scene; /* for figures */
    const csgm_field *field;
    csgm_mesh_options options;
    const char *path;
    csgm_format format;
    csgm_write_options write_options;
    csg_mesh_counts counts;
    csgm_mesh_stats stats;
    csgm_mesh_figures *figures; /* NULL: they are not asked for */
} order;

csgm_mesh_figures csgm_mesh_figures_default(void)
{
    return (csgm_mesh_figures){.struct_size = sizeof(csgm_mesh_figures), .max_abs_field = NAN};
}

/* ---- into a file that is filled from all sides ---------------------------------------------- */

/* Looks at vertices that go by. */
typedef struct samples {
    csg_mesh_receiver to;
    const csgm_scene *scene;
    csgm_vec3 origin;
    uint64_t step;
    csg_max_abs *known; /* of each worker */
} samples;

static csgm_status begin_samples(void *user, const csg_mesh_counts *counts)
{
    samples *s = user;
    s->origin = counts->origin;
    s->step = csg_max_abs_step(s->scene, counts->vertex_count);
    return s->to.begin(s->to.user, counts);
}

/* Every step-th vertex; of loose triangles, which have each vertex several times, the first corner
 * of as many. */
static bool put_sampled(void *user, const csg_mesh_run *run)
{
    samples *s = user;
    bool is_loose = run->corners != NULL;
    uint64_t step = is_loose ? 2 * s->step : s->step;
    uint64_t first = is_loose ? run->first_triangle : run->first_vertex;
    uint64_t count = is_loose ? run->triangle_count : run->vertex_count;
    for (uint64_t i = (step - first % step) % step; i < count; i += step)
        csg_max_abs_look(&s->known[run->worker], s->scene, s->origin,
                         is_loose ? run->corners + 9 * i : run->positions + 3 * i);
    return s->to.put(s->to.user, run);
}

static csgm_status build_into(order *o, const csg_mesh_receiver *receiver)
{
    return csg_mesh_stream(o->context, o->field, &o->options, receiver, &o->counts, &o->stats);
}

/* The same, with figures. */
static csgm_status build_with_figures(order *o, const csg_mesh_receiver *receiver)
{
    csg_memory *memory = &o->context->memory;
    uint32_t workers = csg_pool_threads(o->context->pool);
    size_t bytes = workers * sizeof(csg_max_abs);
    samples s = {.to = *receiver, .scene = o->scene, .known = csg_memory_alloc(memory, bytes)};
    if (!s.known)
        return csg_context_no_memory(o->context);
    memset(s.known, 0, bytes);
    csg_mesh_receiver sampled = *receiver;
    sampled.user = &s;
    sampled.begin = begin_samples;
    sampled.put = put_sampled;
    csg_mesh_figures *figures;
    csgm_status status = CSGM_OK;
    if (!csg_mesh_figures_make(o->context, &sampled, workers, &figures)) {
        status = csg_context_no_memory(o->context);
    } else {
        csg_mesh_receiver looking = csg_mesh_figures_receiver(figures);
        status = build_into(o, &looking);
        if (status == CSGM_OK)
            o->figures->is_checked = csg_mesh_figures_get(figures, &o->figures->check);
        csg_mesh_figures_destroy(figures);
    }
    csg_max_abs all = {0};
    for (uint32_t i = 0; i < workers; i++)
        csg_max_abs_add(&all, &s.known[i]);
    o->figures->max_abs_field = all.largest;
    o->figures->vertices_measured = all.measured;
    csg_memory_release(memory, s.known, bytes);
    return status;
}

static csgm_status stream_file(order *o)
{
    csg_stream *stream;
    csgm_status status = csg_stream_create(o->context, o->path, o->format, &o->write_options,
                                           csg_pool_threads(o->context->pool), &stream);
    if (status != CSGM_OK)
        return status;
    csg_mesh_receiver receiver = csg_stream_receiver(stream);
    status = o->figures ? build_with_figures(o, &receiver) : build_into(o, &receiver);
    if (status == CSGM_OK && o->counts.triangle_count)
        return csg_stream_commit(stream);
    csgm_status of_stream = csg_stream_abandon(stream);
    return of_stream != CSGM_OK ? of_stream : status == CSGM_OK ? CSGM_ERR_SCENE : status;
}

/* ---- through a mesh in memory ----------------------------------------------------------------- */

/* A mesh that is gathered is made by one rank in the end: there is nothing to go on with. */
static csgm_status refuse_to_keep(csgm_context *context)
{
    if (!context->ranks || !context->ranks->folder)
        return CSGM_OK;
    if (csg_ranks_is_first(context))
        csg_diag_plain(&context->diags, CSG_DIAG_RANKS_FAILED, NULL,
                       "binary PLY, STL or GLB of equal cells, of a scene without parts and "
                       "materials, can be kept",
                       "what is finished cannot be kept: the first rank writes this mesh alone");
    return CSGM_ERR_UNSUPPORTED;
}

/* Of equal cells, the figures of runs on their way into memory: as a rule nothing else has to look
 * at the mesh. */
static csgm_status collect_mesh(order *o, csgm_mesh **out)
{
    csg_mesh_collector collector = {.context = o->context};
    csg_mesh_receiver receiver = csg_mesh_collector_receiver(&collector);
    csgm_status status = build_with_figures(o, &receiver);
    if (status == CSGM_OK)
        *out = collector.mesh;
    else
        csg_mesh_destroy(collector.mesh);
    return status;
}

/* What is not known yet. Without the memory for it, too, the file can be written. */
static csgm_status find_figures(order *o, const csgm_mesh_view *view)
{
    csgm_mesh_figures *f = o->figures;
    if (f->is_checked)
        return CSGM_OK;
    csgm_status status = csg_mesh_inspect(o->context, view, 0, &f->check);
    f->is_checked = status == CSGM_OK;
    f->max_abs_field = csgm_mesh_max_abs_field(o->scene, view, &f->vertices_measured);
    return status == CSGM_ERR_MEMORY ? CSGM_OK : status;
}

static csgm_status build_and_write(order *o)
{
    csgm_mesh *mesh;
    bool is_looked_at = o->figures && csg_mesh_can_stream(o->field, &o->options);
    csgm_status status = is_looked_at
                             ? collect_mesh(o, &mesh)
                             : csg_mesh_build(o->context, o->field, &o->options, &mesh, &o->stats);
    if (status != CSGM_OK)
        return status;
    csgm_mesh_view view = csg_mesh_view(mesh);
    o->counts.vertex_count = view.vertex_count;
    o->counts.triangle_count = view.triangle_count;
    if (csg_ranks_is_first(o->context)) /* the others have none of it */
        status = view.triangle_count
                     ? csg_io_write(o->context, &view, o->path, o->format, &o->write_options)
                     : CSGM_ERR_SCENE;
    if (status == CSGM_OK && o->figures)
        status = find_figures(o, &view);
    csg_mesh_destroy(mesh);
    return csg_ranks_agree(o->context, status);
}

/* ---- either ------------------------------------------------------------------------------------- */

static csgm_status build_file(order *o)
{
    csgm_context *context = o->context;
    csgm_mesh_options *options = &o->options;
    uint32_t traits = csg_format_traits(
        o->format == CSGM_FORMAT_AUTO ? csg_format_from_path(o->path) : o->format);
    if (options->normals == CSGM_NORMALS_CREASE && !(traits & CSGM_KEEPS_CREASES))
        options->normals = CSGM_NORMALS_VERTEX;
    options->colors = options->colors && (traits & (CSGM_KEEPS_COLORS | CSGM_KEEPS_MATERIALS)) != 0;
    bool streams = csg_mesh_can_stream(o->field, options) &&
                   csg_stream_is_possible(o->path, o->format, csg_mesh_distance(o->field, options),
                                          &o->write_options);
    csg_ranks_begin_mesh(context);
    csgm_status status = csg_ranks_follow(context, CSGM_OK, &streams);
    if (status == CSGM_OK && !streams)
        status = refuse_to_keep(context);
    if (status != CSGM_OK)
        return status;
    return streams ? stream_file(o) : build_and_write(o);
}

static bool adopt_order(order *o, const csgm_mesh_options *options,
                        const csgm_write_options *write_options, const csgm_mesh_stats *stats)
{
    o->options = csgm_mesh_options_default();
    o->write_options = csgm_write_options_default();
    o->stats = csgm_mesh_stats_default();
    return o->context && o->field && o->path && o->format < CSGM_FORMAT_COUNT &&
           csg_mesh_options_adopt(&o->options, options) &&
           csg_options_adopt(&o->write_options, sizeof o->write_options, write_options) &&
           csg_struct_is_known(stats, sizeof *stats);
}

static csgm_status deliver(order *o, uint64_t counts[2], csgm_mesh_stats *stats)
{
    csgm_status status = build_file(o);
    csg_struct_deliver(stats, &o->stats);
    if (counts) {
        counts[0] = o->counts.vertex_count;
        counts[1] = o->counts.triangle_count;
    }
    return status;
}

csgm_status csgm_mesh_build_file(csgm_context *context, const csgm_field *field,
                                 const csgm_mesh_options *options, const char *path,
                                 csgm_format format, const csgm_write_options *write_options,
                                 uint64_t counts[2], csgm_mesh_stats *stats)
{
    order o = {.context = context, .field = field, .path = path, .format = format};
    return adopt_order(&o, options, write_options, stats) ? deliver(&o, counts, stats)
                                                          : CSGM_ERR_ARGUMENT;
}

csgm_status csgm_mesh_build_file_figures(csgm_context *context, const csgm_scene *scene,
                                         const csgm_field *field, const csgm_mesh_options *options,
                                         const char *path, csgm_format format,
                                         const csgm_write_options *write_options,
                                         uint64_t counts[2], csgm_mesh_stats *stats,
                                         csgm_mesh_figures *figures)
{
    csgm_mesh_figures found = csgm_mesh_figures_default();
    order o = {.context = context,
               .scene = scene,
               .field = field,
               .path = path,
               .format = format,
               .figures = &found};
    if (!scene || !figures || !csg_struct_is_known(figures, sizeof *figures) ||
        !adopt_order(&o, options, write_options, stats) || context->ranks)
        return CSGM_ERR_ARGUMENT;
    csgm_status status = deliver(&o, counts, stats);
    if (status == CSGM_OK)
        csg_struct_deliver(figures, &found);
    return status;
}
