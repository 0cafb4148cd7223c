/* SPDX-License-Identifier: MIT
 * diff --png: before, after and the heat map side by side, from one camera, under the verdict. The
 * heat map draws B and, where A is far from it, A too, so that what was removed shows as well.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "diff/diff_report.h"
#include "render/picture_frame.h"

enum { PANEL = 480, TALL = 400, BAND = 40, CAPTION = 30, FOOT = 44, PANELS = 3 };
enum { WIDTH = PANELS * PANEL, HEIGHT = BAND + CAPTION + TALL + FOOT };

static const uint8_t white[3] = {255, 255, 255}, ink[3] = {40, 44, 52}, paper[3] = {244, 245, 247},
                     stage[3] = {216, 220, 226}, red[3] = {176, 28, 36}, green[3] = {26, 116, 62},
                     black[3] = {0, 0, 0};

/* ---- panels ---------------------------------------------------------------------------------- */

typedef struct painter {
    cli_app *app;
    const diff_drawing *drawing;
    cli_frame frame;
    cli_canvas canvas;
} painter;

static csgm_status draw(painter *p, int panel, const csgm_mesh_view *mesh)
{
    csgm_render_options options = csgm_render_options_default();
    csgm_image *image = NULL;
    cli_canvas_fill(&p->canvas, panel * PANEL, BAND + CAPTION, PANEL, TALL, stage);
    if (mesh->triangle_count == 0)
        return CSGM_OK;
    options.ground = false; /* it would move with what was removed or added below */
    options.edges = options.flat = true;
    cli_frame_aim(&p->frame, &options);
    memcpy(options.background, stage, 3);
    csgm_status status = csgm_render_mesh(p->app->context, mesh, &options, &image, NULL);
    if (status != CSGM_OK)
        return status;
    csgm_image_view view = csgm_image_get_view(image);
    cli_canvas_image(&p->canvas, panel * PANEL, BAND + CAPTION, &view);
    csgm_image_destroy(image);
    return CSGM_OK;
}

/* One plain colour, where the mesh has none of its own. */
static csgm_status draw_side(painter *p, int side)
{
    static const uint8_t plain[2][4] = {{126, 158, 204, 255}, {222, 170, 92, 255}};
    csgm_mesh_view view = p->drawing->sides[side];
    uint8_t *colors = NULL;
    if (!view.colors && view.vertex_count) {
        colors = malloc((size_t)view.vertex_count * 4);
        if (!colors)
            return CSGM_ERR_MEMORY;
        for (uint64_t v = 0; v < view.vertex_count; v++)
            memcpy(colors + 4 * v, plain[side], 4);
        view.colors = colors;
    }
    csgm_status status = draw(p, side, &view);
    free(colors);
    return status;
}

/* Both meshes as one: vertices of B, then those of A; triangles of B, then those of A that show. */
static void join_meshes(const diff_drawing *d, float *positions, uint8_t *colors, uint32_t *indices,
                        csgm_mesh_view *out)
{
    csgm_vec3 origin = d->box.min;
    *out = (csgm_mesh_view){
        .origin = origin, .positions = positions, .colors = colors, .indices = indices};
    for (int side = 1; side >= 0; side--) {
        const csgm_mesh_view *view = &d->sides[side];
        uint32_t first = (uint32_t)out->vertex_count;
        for (uint64_t v = 0; v < view->vertex_count; v++) {
            csgm_vec3 p = diff_drawing_vertex(view, (uint32_t)v);
            float *position = positions + 3 * (first + v);
            position[0] = (float)(p.x - origin.x);
            position[1] = (float)(p.y - origin.y);
            position[2] = (float)(p.z - origin.z);
            csgm_diff_color(d->distances[side] ? (double)d->distances[side][v] : 0, d->most,
                            colors + 4 * (first + v));
            colors[4 * (first + v) + 3] = 255;
        }
        out->vertex_count += view->vertex_count;
        for (uint64_t t = 0; t < view->triangle_count; t++) {
            if (side == 0 && !diff_drawing_shows(d, t))
                continue;
            for (int k = 0; k < 3; k++)
                indices[3 * out->triangle_count + (size_t)k] =
                    first + view->indices[3 * t + (size_t)k];
            out->triangle_count++;
        }
    }
}

static csgm_status draw_heatmap(painter *p)
{
    const diff_drawing *d = p->drawing;
    size_t vertices = (size_t)(d->sides[0].vertex_count + d->sides[1].vertex_count),
           triangles = (size_t)(d->sides[0].triangle_count + d->sides[1].triangle_count);
    float *positions = malloc((vertices + 1) * 3 * sizeof *positions);
    uint8_t *colors = malloc((vertices + 1) * 4);
    uint32_t *indices = malloc((triangles + 1) * 3 * sizeof *indices);
    csgm_status status = CSGM_ERR_MEMORY;
    if (positions && colors && indices && vertices < UINT32_MAX) {
        csgm_mesh_view joined;
        join_meshes(d, positions, colors, indices, &joined);
        status = draw(p, 2, &joined);
    }
    free(positions);
    free(colors);
    free(indices);
    return status;
}

/* ---- words ----------------------------------------------------------------------------------- */

static void write_verdict(painter *p, const diff_result *result)
{
    char reason[512], line[600];
    bool is_same = result->outcome == DIFF_SAME;
    diff_explain(result, reason, sizeof reason);
    snprintf(line, sizeof line, "%s: %s", is_same ? "same" : "different", reason);
    cli_canvas_fill(&p->canvas, 0, 0, WIDTH, BAND, is_same ? green : red);
    int size = cli_canvas_text_width(2, line) < WIDTH - 24 ? 2 : 1;
    cli_canvas_text(&p->canvas, 14, (BAND - 7 * size) / 2, size, white, line);
}

static void write_scale(painter *p, int x, int y)
{
    char text[64];
    enum { BAR = 200 };
    for (int i = 0; i < BAR; i++) {
        uint8_t color[3];
        csgm_diff_color(i, BAR - 1, color);
        cli_canvas_fill(&p->canvas, x + 24 + i, y, 1, 14, color);
    }
    cli_canvas_text(&p->canvas, x, y, 2, ink, "0");
    snprintf(text, sizeof text, "%.4g", p->drawing->most);
    cli_canvas_text(&p->canvas, x + 32 + BAR, y, 2, ink, text);
}

static void write_side(painter *p, const csgm_diff_report *r, int side)
{
    const csgm_diff_figures *f = &r->figures[side];
    double before = r->figures[0].check.volume, now = r->figures[1].check.volume;
    char text[128] = "empty";
    bool has_volume = r->figures[0].is_closed && r->figures[1].is_closed && before > 0;
    if (f->triangles && has_volume && side == 1)
        snprintf(text, sizeof text, "volume %.6g (%+.2f %%)", now, 100 * (now / before - 1));
    else if (f->triangles && f->is_closed)
        snprintf(text, sizeof text, "volume %.6g", f->check.volume);
    else if (f->triangles)
        snprintf(text, sizeof text, "area %.6g, open", f->check.area);
    cli_canvas_text(&p->canvas, side * PANEL + 14, HEIGHT - FOOT + 15, 2, ink, text);
}

static void write_words(painter *p, const diff_result *result)
{
    static const char *const captions[PANELS] = {"A: before", "B: after", "distance"};
    const csgm_diff_report *r = &result->report;
    const csgm_diff_place *worst =
        p->drawing->most > 0 ? diff_drawing_worst_seen(p->drawing, r, p->frame.eye) : NULL;
    int x, y;
    write_verdict(p, result);
    for (int i = 0; i < PANELS; i++)
        cli_canvas_text(&p->canvas, i * PANEL + 14, BAND + 9, 2, ink, captions[i]);
    for (int i = 1; i < PANELS; i++)
        cli_canvas_fill(&p->canvas, i * PANEL, BAND, 1, HEIGHT - BAND, white);
    write_side(p, r, 0);
    write_side(p, r, 1);
    if (p->drawing->most > 0)
        write_scale(p, 2 * PANEL + 14, HEIGHT - FOOT + 15);
    if (worst && cli_frame_project(&p->frame, worst->at, &x, &y))
        for (int i = 0; i < PANELS; i++) {
            cli_canvas_ring(&p->canvas, i * PANEL + x, BAND + CAPTION + y, 15, 4, white);
            cli_canvas_ring(&p->canvas, i * PANEL + x, BAND + CAPTION + y, 14, 2, black);
        }
}

/* ---- the file -------------------------------------------------------------------------------- */

static csgm_status paint(painter *p, const diff_result *result)
{
    cli_canvas_fill(&p->canvas, 0, 0, WIDTH, HEIGHT, paper);
    csgm_status status = draw_side(p, 0);
    if (status == CSGM_OK)
        status = draw_side(p, 1);
    if (status == CSGM_OK)
        status = draw_heatmap(p);
    if (status == CSGM_OK)
        write_words(p, result);
    return status;
}

int diff_write_picture(cli_app *app, const diff_drawing *drawing, const diff_result *result,
                       const char *path)
{
    painter p = {.app = app,
                 .drawing = drawing,
                 .frame = cli_frame_make(drawing->box, drawing->toward, PANEL, TALL),
                 .canvas = {WIDTH, HEIGHT, malloc((size_t)WIDTH * HEIGHT * 4)}};
    csgm_status status = p.canvas.pixels ? paint(&p, result) : CSGM_ERR_MEMORY;
    if (status == CSGM_ERR_MEMORY)
        cli_console_say(&app->console, CSGM_ERROR, NULL, "out of memory");
    if (status == CSGM_OK)
        status = cli_canvas_write(app, &p.canvas, path);
    free(p.canvas.pixels);
    return status == CSGM_OK ? CLI_DONE : CLI_TROUBLE;
}
