/* SPDX-License-Identifier: MIT
 * See clear_picture.h: both parts as a whole, and the place alone, cut out of them. Which of the
 * two is seen through, and from where they are seen, is tried out on small pictures of the place:
 * what shows the most of it that is red.
 */
#include "clear/clear_picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/interrupt.h"
#include "core/interval.h"
#include "core/options.h"
#include "render/picture_frame.h"

enum { PANEL = 640, TALL = 560, BAND = 40, FOOT = 70, SMALL = 48, AZIMUTHS = 8, ELEVATIONS = 3 };

static const uint8_t white[3] = {255, 255, 255}, ink[3] = {40, 44, 52}, paper[3] = {244, 245, 247},
                     red[3] = {176, 28, 36}, green[3] = {26, 116, 62}, amber[3] = {150, 96, 12},
                     black[3] = {0, 0, 0}, blue[3] = {84, 140, 199}, pink[3] = {255, 168, 168};

typedef struct painter {
    cli_app *app;
    const cli_cleared *cleared;
    const csgm_clear_pair *pair;
    const csgm_scene *scene;
    bool has_place;
    csgm_vec3 place, toward;
    double side; /* of what is drawn around the place */
    int solid;   /* the part that is not seen through */
    csgm_field *field;
    csgm_scene *exhibit;
    double began_s;
    cli_canvas canvas;
} painter;

/* ---- the pair ----------------------------------------------------------------------------------
 */

static bool is_worse(const cli_cleared *c, const csgm_clear_pair *p, const csgm_clear_pair *than)
{
    cli_verdict a = cli_verdict_of(c, p), b = cli_verdict_of(c, than);
    bool interferes = p->state == CSGM_CLEAR_INTERFERING;
    if (a != b)
        return a > b;
    if (interferes != (than->state == CSGM_CLEAR_INTERFERING))
        return interferes;
    if (interferes)
        return p->volume.low > than->volume.low;
    if (p->by_boxes != than->by_boxes)
        return than->by_boxes;
    return p->by_boxes ? p->gap.low < than->gap.low : p->gap.high < than->gap.high;
}

const csgm_clear_pair *cli_clear_worst(const cli_cleared *c)
{
    const csgm_clear_pair *p, *worst = NULL;
    for (size_t i = 0; (p = csgm_clearances_get(c->pairs, i)) != NULL; i++)
        if (p->poses && !isinf(p->gap.low) && (!worst || is_worse(c, p, worst)))
            worst = p;
    return worst;
}

/* ---- what is in sight --------------------------------------------------------------------------
 */

static bool should_stop(void *user)
{
    const painter *p = user;
    double limit = p->app->options->timeout;
    return cli_interrupt_is_asked() || (limit > 0 && cli_now_s() - p->began_s > limit);
}

static double longest_of(csgm_box box)
{
    return fmax(box.max.x - box.min.x, fmax(box.max.y - box.min.y, box.max.z - box.min.z));
}

static csgm_box around(csgm_vec3 at, double half)
{
    return (csgm_box){{at.x - half, at.y - half, at.z - half},
                      {at.x + half, at.y + half, at.z + half}};
}

static csgm_box hull(csgm_box a, csgm_box b)
{
    return (csgm_box){{fmin(a.min.x, b.min.x), fmin(a.min.y, b.min.y), fmin(a.min.z, b.min.z)},
                      {fmax(a.max.x, b.max.x), fmax(a.max.y, b.max.y), fmax(a.max.z, b.max.z)}};
}

static csgm_box box_of_pair(const painter *p)
{
    const csgm_scene *other = csgm_scene_get_marked(p->exhibit, CSGM_MARK_HIGHLIGHT);
    return hull(csgm_scene_get_info(p->exhibit).bounds, csgm_scene_get_info(other).bounds);
}

static void release_exhibit(painter *p)
{
    csgm_field_destroy(p->field);
    csgm_scene_destroy(p->exhibit);
    p->field = NULL;
    p->exhibit = NULL;
}

static csgm_status make_exhibit(painter *p, int solid)
{
    static const double SHARE = 0.03; /* of the place's side: balls around nearest points */
    csgm_context *context = p->app->context;
    release_exhibit(p);
    csgm_status status =
        csgm_clear_exhibit(context, p->scene, p->pair, solid, SHARE * p->side, &p->exhibit);
    return status == CSGM_OK ? csgm_field_compile(context, p->exhibit, &p->field) : status;
}

/* The place, and how much around it is drawn: some of it is more than the place itself, and less
 * than the parts. */
static void find_place(painter *p, double longest)
{
    const csgm_clear_pair *pair = p->pair;
    double size = 0;
    if (pair->state == CSGM_CLEAR_INTERFERING) {
        p->has_place = true;
        p->place = pair->inside;
        size = 6 * cbrt(pair->volume.low);
    } else if (pair->state != CSGM_CLEAR_UNDECIDED && !pair->by_boxes && isfinite(pair->gap.high)) {
        const csgm_vec3 *at = pair->nearest;
        p->has_place = true;
        p->place =
            (csgm_vec3){(at[0].x + at[1].x) / 2, (at[0].y + at[1].y) / 2, (at[0].z + at[1].z) / 2};
        size = 6 * pair->gap.high;
    }
    p->side = fmin(fmax(size, longest / 30), longest / 3);
    if (pair->state != CSGM_CLEAR_INTERFERING && p->has_place)
        p->side = fmax(p->side, 1.4 * pair->gap.high);
}

/* ---- pictures ----------------------------------------------------------------------------------
 */

/* box: what is cut out and drawn; whole: of all that is there. */
static csgm_status draw(painter *p, const cli_frame *frame, bool is_cut, bool is_small,
                        csgm_image **out)
{
    csgm_render_options options = csgm_render_options_default();
    options.ground = false;
    options.edges = !is_small;
    options.monitor = (csgm_monitor){.cancelled = should_stop, .user = p};
    if (is_small) {
        options.samples = 1;
        options.occlusion = options.shadows = false;
    }
    if (is_cut)
        options.bounds = around(p->place, 0.5 * p->side);
    cli_frame_aim(frame, &options);
    return csgm_render_scene(p->app->context, p->field, &options, out, NULL);
}

static size_t count_red(const csgm_image *image)
{
    csgm_image_view view = csgm_image_get_view(image);
    size_t count = 0, pixels = (size_t)view.width * view.height;
    for (size_t i = 0; i < pixels; i++) {
        const uint8_t *c = view.pixels + 4 * i;
        count += 2 * c[1] < c[0] && 2 * c[2] < c[0];
    }
    return count;
}

static csgm_status try_side(painter *p, csgm_vec3 toward, size_t *seen)
{
    cli_frame frame = cli_frame_make(around(p->place, 0.5 * p->side), toward, SMALL, SMALL);
    csgm_image *image = NULL;
    csgm_status status = draw(p, &frame, true, true, &image);
    if (status == CSGM_OK)
        *seen = count_red(image);
    csgm_image_destroy(image);
    return status;
}

/* Views from above and from the usual side come first: others must show more. */
static csgm_status choose_view(painter *p)
{
    static const double elevations[ELEVATIONS] = {25, 60, -30}, weights[ELEVATIONS] = {1, 1, 0.5},
                        MORE = 1.15;
    csgm_vec3 given;
    bool is_given = cli_frame_view(p->app, &given);
    double most = -1;
    csgm_status status = CSGM_OK;
    p->toward = is_given ? given : cli_frame_toward(35, elevations[0]);
    for (int solid = 0; solid < 2 && p->has_place; solid++) {
        status = make_exhibit(p, solid);
        for (int i = 0; i < (is_given ? 1 : AZIMUTHS * ELEVATIONS) && status == CSGM_OK; i++) {
            csgm_vec3 toward = is_given ? given
                                        : cli_frame_toward(35 + 360.0 / AZIMUTHS * (i % AZIMUTHS),
                                                           elevations[i / AZIMUTHS]);
            size_t seen = 0;
            status = try_side(p, toward, &seen);
            double score = weights[i / AZIMUTHS] * (double)seen;
            if (score > MORE * most) {
                most = score;
                p->toward = toward;
                p->solid = solid;
            }
        }
        if (status != CSGM_OK)
            return status;
    }
    return make_exhibit(p, p->solid);
}

static csgm_status draw_panel(painter *p, int panel, const cli_frame *frame)
{
    csgm_image *image = NULL;
    int x, y, left = panel * PANEL;
    csgm_status status = draw(p, frame, panel > 0, false, &image);
    if (status == CSGM_OK) {
        csgm_image_view view = csgm_image_get_view(image);
        cli_canvas_image(&p->canvas, left, BAND, &view);
    }
    csgm_image_destroy(image);
    if (panel == 0 && p->has_place && cli_frame_project(frame, p->place, &x, &y)) {
        cli_canvas_ring(&p->canvas, left + x, BAND + y, 23, 5, white);
        cli_canvas_ring(&p->canvas, left + x, BAND + y, 22, 3, black);
    }
    return status;
}

static csgm_status draw_panels(painter *p)
{
    cli_frame whole = cli_frame_make(box_of_pair(p), p->toward, PANEL, TALL);
    csgm_status status = draw_panel(p, 0, &whole);
    if (status != CSGM_OK || !p->has_place)
        return status;
    cli_frame close = cli_frame_make(around(p->place, 0.5 * p->side), p->toward, PANEL, TALL);
    status = draw_panel(p, 1, &close);
    cli_canvas_fill(&p->canvas, PANEL, BAND, 1, TALL, ink);
    return status;
}

/* ---- words ------------------------------------------------------------------------------------ */

/* Returns x of what comes next. */
static int write_name(painter *p, int x, int y, const uint8_t color[3], const char *name)
{
    char text[96];
    cli_canvas_fill(&p->canvas, x, y, 14, 14, color);
    return 24 + cli_canvas_text(&p->canvas, x + 22, y, 2, ink, cli_clear_name(name, text));
}

static void write_words(painter *p)
{
    const csgm_clear_pair *pair = p->pair;
    char a[96], b[96], pose[160], line[800], interval[CLI_INTERVAL_TEXT];
    bool interferes = pair->state == CSGM_CLEAR_INTERFERING;
    int width = (int)p->canvas.width, y = BAND + TALL + 14;
    cli_verdict verdict = cli_verdict_of(p->cleared, pair);
    cli_clear_pose(p->cleared, pair, pose, sizeof pose);
    snprintf(line, sizeof line, "%s and %s: %s%s", cli_clear_name(pair->names[0], a),
             cli_clear_name(pair->names[1], b), cli_clear_state_name(pair->state), pose);
    cli_canvas_fill(&p->canvas, 0, 0, width, BAND,
                    verdict == CLI_PAIR_BAD    ? red
                    : verdict == CLI_PAIR_OPEN ? amber
                                               : green);
    int size = cli_canvas_text_width(2, line) < width - 24 ? 2 : 1;
    cli_canvas_text(&p->canvas, 14, (BAND - 7 * size) / 2, size, white, line);
    int x = write_name(p, 14, y, blue, pair->names[p->solid]);
    write_name(p, x, y, pink, pair->names[1 - p->solid]);
    if (interferes || isfinite(pair->gap.high))
        snprintf(line, sizeof line, "%s %s", interferes ? "common volume" : "gap",
                 cli_format_interval(interval, interferes ? pair->volume : pair->gap));
    else
        snprintf(line, sizeof line, "gap at least %.6g", pair->gap.low);
    cli_canvas_text(&p->canvas, 14, y + 28, 2, ink, line);
    if (p->has_place) {
        snprintf(line, sizeof line, "cut out: %.4g on each side", p->side);
        cli_canvas_text(&p->canvas, PANEL + 14, y + 28, 2, ink, line);
    }
}

static csgm_status paint(painter *p)
{
    csgm_status status = make_exhibit(p, 0);
    if (status != CSGM_OK)
        return status;
    find_place(p, longest_of(box_of_pair(p)));
    p->canvas =
        (cli_canvas){(uint32_t)(p->has_place ? 2 * PANEL : PANEL), BAND + TALL + FOOT, NULL};
    p->canvas.pixels = malloc((size_t)p->canvas.width * p->canvas.height * 4);
    if (!p->canvas.pixels)
        return CSGM_ERR_MEMORY;
    cli_canvas_fill(&p->canvas, 0, 0, (int)p->canvas.width, (int)p->canvas.height, paper);
    status = choose_view(p);
    if (status == CSGM_OK)
        status = draw_panels(p);
    if (status == CSGM_OK)
        write_words(p);
    return status;
}

int cli_clear_picture(cli_app *app, const cli_cleared *cleared, const csgm_clear_pair *pair,
                      const csgm_scene *scene, const char *path)
{
    painter p = {
        .app = app, .cleared = cleared, .pair = pair, .scene = scene, .began_s = cli_now_s()};
    csgm_status status = paint(&p);
    if (status == CSGM_ERR_MEMORY && !p.canvas.pixels)
        cli_console_say(&app->console, CSGM_ERROR, NULL, "out of memory");
    if (status == CSGM_CANCELLED)
        cli_console_say(&app->console, CSGM_ERROR, NULL, "%s is not drawn: %s", path,
                        cli_interrupt_is_asked() ? "interrupted"
                                                 : "it takes longer than --timeout");
    if (status == CSGM_OK)
        status = cli_canvas_write(app, &p.canvas, path);
    release_exhibit(&p);
    free(p.canvas.pixels);
    return status == CSGM_OK ? CLI_DONE : CLI_TROUBLE;
}
