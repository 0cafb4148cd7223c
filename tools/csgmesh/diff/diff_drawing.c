/* SPDX-License-Identifier: MIT
 * Both meshes of a comparison in one frame; see diff_drawing.h. The view is --view, or where the
 * change is best seen from (diff_view.h).
 */
#include "diff/diff_drawing.h"

#include <math.h>
#include <stdlib.h>

#include "core/options.h"
#include "diff/diff_view.h"
#include "render/picture_frame.h"

csgm_vec3 diff_drawing_vertex(const csgm_mesh_view *view, uint32_t vertex)
{
    const float *p = view->positions + 3 * (size_t)vertex;
    return (csgm_vec3){view->origin.x + (double)p[0], view->origin.y + (double)p[1],
                       view->origin.z + (double)p[2]};
}

static void add_to_box(csgm_box *box, const csgm_mesh_view *view)
{
    for (uint64_t v = 0; v < view->vertex_count; v++) {
        csgm_vec3 p = diff_drawing_vertex(view, (uint32_t)v);
        box->min = (csgm_vec3){fmin(box->min.x, p.x), fmin(box->min.y, p.y), fmin(box->min.z, p.z)};
        box->max = (csgm_vec3){fmax(box->max.x, p.x), fmax(box->max.y, p.y), fmax(box->max.z, p.z)};
    }
}

/* ---- B turned -------------------------------------------------------------------------------- */

/* As the comparison did: 1 is y up to z up, 2 the reverse. Normals turn too, but what is drawn
 * takes them from the triangles. */
static bool turn(diff_drawing *d, int how)
{
    csgm_mesh_view *view = &d->sides[1];
    if (how == 0 || view->vertex_count == 0)
        return true;
    float sign = how == 1 ? -1.0f : 1.0f;
    d->turned = malloc((size_t)view->vertex_count * 3 * sizeof(float));
    if (!d->turned)
        return false;
    for (uint64_t v = 0; v < view->vertex_count; v++) {
        const float *from = view->positions + 3 * v;
        float *to = d->turned + 3 * v;
        to[0] = from[0];
        to[1] = sign * from[2];
        to[2] = -sign * from[1];
    }
    view->positions = d->turned;
    view->normals = NULL;
    view->origin =
        (csgm_vec3){view->origin.x, (double)sign * view->origin.z, (double)-sign * view->origin.y};
    return true;
}

/* ---- large triangles ------------------------------------------------------------------------- */

/* Distances are known at vertices: both surfaces are measured once more, at more of them. */
static csgm_status measure_finely(diff_drawing *d)
{
    csgm_diff_options options = csgm_diff_options_default();
    options.tolerance = INFINITY;
    options.samples = 1;
    options.ignored = CSGM_DIFF_IGNORE_ORDER | CSGM_DIFF_IGNORE_NORMALS | CSGM_DIFF_IGNORE_COLORS |
                      CSGM_DIFF_IGNORE_NAMES | CSGM_DIFF_IGNORE_TOPOLOGY;
    csgm_status status =
        csgm_diff_meshes(d->context, &d->fine[0].view, &d->fine[1].view, &options, &d->fine_diff);
    if (status != CSGM_OK)
        return status;
    for (int i = 0; i < 2; i++) {
        d->sides[i] = d->fine[i].view;
        d->distances[i] = csgm_diff_vertex_distances(d->fine_diff, i);
    }
    return CSGM_OK;
}

static csgm_status refine(diff_drawing *d)
{
    const double edges_across = 48; /* the whole */
    const uint64_t most_new = 20000;
    csgm_vec3 size = {d->box.max.x - d->box.min.x, d->box.max.y - d->box.min.y,
                      d->box.max.z - d->box.min.z};
    double longest = sqrt(size.x * size.x + size.y * size.y + size.z * size.z) / edges_across;
    bool is_drawn = d->most > 0 && d->distances[0] && d->distances[1];
    if (!is_drawn || !(diff_fine_has_longer_edge(&d->sides[0], longest) ||
                       diff_fine_has_longer_edge(&d->sides[1], longest)))
        return CSGM_OK;
    for (int i = 0; i < 2; i++)
        if (!diff_fine_make(&d->sides[i], longest, most_new, &d->fine[i]))
            return CSGM_ERR_MEMORY;
    return measure_finely(d);
}

/* ---- from where ------------------------------------------------------------------------------ */

/* ---- all of it ------------------------------------------------------------------------------- */

static bool no_memory(cli_app *app)
{
    cli_console_say(&app->console, CSGM_ERROR, NULL, "out of memory");
    return false;
}

bool diff_drawing_make(cli_app *app, const csgm_diff *diff, const diff_side sides[2],
                       diff_drawing *out)
{
    const csgm_diff_report *report = csgm_diff_get_report(diff);
    *out =
        (diff_drawing){.box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}}};
    out->context = app->context;
    for (int i = 0; i < 2; i++) {
        out->sides[i] = sides[i].view;
        out->distances[i] = csgm_diff_vertex_distances(diff, i);
    }
    if (!turn(out, report->turn))
        return no_memory(app);
    add_to_box(&out->box, &out->sides[0]);
    add_to_box(&out->box, &out->sides[1]);
    if (!(out->box.min.x <= out->box.max.x))
        out->box = (csgm_box){{0, 0, 0}, {1, 1, 1}};
    if (isfinite(report->hausdorff_lower) && report->hausdorff_lower > report->precision)
        out->most = report->hausdorff_lower;
    csgm_status status = refine(out);
    if (status == CSGM_OK && !cli_frame_view(app, &out->toward))
        status = diff_view_find(out, &out->toward);
    if (status == CSGM_OK)
        return true;
    diff_drawing_release(out);
    return status == CSGM_ERR_MEMORY && no_memory(app);
}

void diff_drawing_release(diff_drawing *drawing)
{
    csgm_diff_destroy(drawing->fine_diff);
    drawing->fine_diff = NULL;
    for (int i = 0; i < 2; i++)
        diff_fine_release(&drawing->fine[i]);
    free(drawing->turned);
    drawing->turned = NULL;
}

bool diff_drawing_shows(const diff_drawing *drawing, uint64_t triangle_of_a)
{
    const uint32_t *index = drawing->sides[0].indices + 3 * triangle_of_a;
    const float *distances = drawing->distances[0];
    if (!distances || !(drawing->most > 0))
        return false;
    float largest = fmaxf(distances[index[0]], fmaxf(distances[index[1]], distances[index[2]]));
    return (double)largest > 0.05 * drawing->most;
}

/* ---- what is in sight ------------------------------------------------------------------------ */

static csgm_vec3 minus(csgm_vec3 a, csgm_vec3 b)
{
    return (csgm_vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}

static csgm_vec3 cross(csgm_vec3 a, csgm_vec3 b)
{
    return (csgm_vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double dot(csgm_vec3 a, csgm_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/* Moeller and Trumbore 1997; `from` itself lies on a triangle, which does not count. */
static bool is_between(const csgm_mesh_view *view, uint64_t triangle, csgm_vec3 from, csgm_vec3 way,
                       double least)
{
    const uint32_t *index = view->indices + 3 * triangle;
    csgm_vec3 a = diff_drawing_vertex(view, index[0]);
    csgm_vec3 u = minus(diff_drawing_vertex(view, index[1]), a),
              v = minus(diff_drawing_vertex(view, index[2]), a), s = minus(from, a);
    csgm_vec3 p = cross(way, v), q = cross(s, u);
    double scale = dot(u, p), first = dot(s, p) / scale, second = dot(way, q) / scale;
    return scale != 0 && first >= 0 && second >= 0 && first + second <= 1 &&
           dot(v, q) / scale > least;
}

static bool is_seen(const diff_drawing *d, csgm_vec3 place, csgm_vec3 eye)
{
    csgm_vec3 way = minus(eye, place), size = minus(d->box.max, d->box.min);
    double least = 0.004 * sqrt(dot(size, size) / dot(way, way));
    for (int side = 0; side < 2; side++)
        for (uint64_t t = 0; t < d->sides[side].triangle_count; t++)
            if ((side == 1 || diff_drawing_shows(d, t)) &&
                is_between(&d->sides[side], t, place, way, least))
                return false;
    return true;
}

const csgm_diff_place *diff_drawing_worst_seen(const diff_drawing *drawing,
                                               const csgm_diff_report *report, csgm_vec3 eye)
{
    const csgm_diff_place *best = NULL;
    for (int i = 0; i < 2; i++)
        for (uint32_t k = 0; k < report->distance[i].worst_count; k++) {
            const csgm_diff_place *place = &report->distance[i].worst[k];
            if (place->distance >= (best ? best->distance * 1.000001 : drawing->most / 2) &&
                is_seen(drawing, place->at, eye))
                best = place;
        }
    return best;
}
