/* SPDX-License-Identifier: MIT
 * Common Layer Interface 2.0, ASCII: closed polylines of each layer with their turn, as machines
 * for powder and resin read them. Heights are those of the layers' tops. All numbers but the box
 * are whole ones of a unit that the head names in millimetres: the least digit of the page.
 */
#include <math.h>

#include "io/layers/layers.h"

enum { ONE_PART = 1, HOLE = 0, OUTER = 1 };

/* How many units a millimetre has. */
static double units_of(const csg_page *page)
{
    double units = 1;
    for (int i = 0; i < page->decimals; i++)
        units *= 10;
    return units;
}

static void begin_cli(csg_page *page, const csg_layers_head *head)
{
    const double box[6] = {page->box.min.x, page->box.min.y, page->box.min.z,
                           page->box.max.x, page->box.max.y, page->box.max.z};
    csg_page_text(page, "$$HEADERSTART\n$$ASCII\n$$UNITS/");
    csg_page_number(page, 1 / units_of(page), page->decimals);
    csg_page_text(page, "\n$$VERSION/200\n$$LABEL/1,solid\n$$DIMENSION/");
    for (int i = 0; i < 6; i++) {
        csg_page_text(page, i ? "," : "");
        csg_page_number(page, box[i], page->decimals);
    }
    csg_page_format(page, "\n$$LAYERS/%zu\n$$HEADEREND\n$$GEOMETRYSTART\n", head->count);
}

static double loop_turn(const csg_outline *contours, size_t loop)
{
    size_t first = csg_outline_first(contours, loop), end = contours->ends[loop];
    csg_vec2 from = contours->points[first];
    double twice = 0;
    for (size_t i = first + 1; i + 1 < end; i++) {
        csg_vec2 a = contours->points[i], b = contours->points[i + 1];
        twice += (a.x - from.x) * (b.y - from.y) - (a.y - from.y) * (b.x - from.x);
    }
    return twice;
}

/* The first point comes again at the end. */
static void put_polyline(csg_page *page, const csg_outline *contours, size_t loop, double units)
{
    size_t first = csg_outline_first(contours, loop), count = contours->ends[loop] - first;
    csg_page_format(page, "$$POLYLINE/%d,%d,%zu", ONE_PART,
                    loop_turn(contours, loop) < 0 ? HOLE : OUTER, count + 1);
    for (size_t i = 0; i <= count; i++) {
        csg_vec2 p = contours->points[first + i % count];
        csg_page_text(page, ",");
        csg_page_number(page, floor(p.x * page->scale * units + 0.5), 0);
        csg_page_text(page, ",");
        csg_page_number(page, floor(p.y * page->scale * units + 0.5), 0);
    }
    csg_page_text(page, "\n");
}

static void put_cli(csg_page *page, const csg_layers_head *head, const csg_sliced_layer *layer)
{
    double units = units_of(page);
    (void)head;
    csg_page_text(page, "$$LAYER/");
    csg_page_number(page, floor(layer->high * page->scale * units + 0.5), 0);
    csg_page_text(page, "\n");
    for (size_t loop = 0; loop < layer->contours.loop_count; loop++)
        put_polyline(page, &layer->contours, loop, units);
}

static void end_cli(csg_page *page, const csg_layers_head *head)
{
    (void)head;
    csg_page_text(page, "$$GEOMETRYEND\n");
}

const csg_layers_writer csg_layers_cli = {.begin = begin_cli, .layer = put_cli, .end = end_cli};
