/* SPDX-License-Identifier: MIT
 * SVG 1.1 of layers: a group for each, which Inkscape shows as a layer and whose height stands in
 * slic3r:z, as resin printers' programs read it. The viewBox has millimetres.
 */
#include "io/layers/layers.h"

static void begin_svg(csg_page *page, const csg_layers_head *head)
{
    (void)head;
    csg_page_begin_svg(page, " xmlns:slic3r=\"http://slic3r.org/namespaces/slic3r\"");
}

static void put_loop(csg_page *page, const csg_outline *contours, size_t loop)
{
    size_t first = csg_outline_first(contours, loop);
    for (size_t i = first; i < contours->ends[loop]; i++)
        csg_page_svg_point(page,
                           i == first        ? "M"
                           : (i - first) % 8 ? "L"
                                             : "\nL",
                           contours->points[i]);
    csg_page_text(page, "Z");
}

static void put_attribute(csg_page *page, const char *name, double value)
{
    csg_page_format(page, " %s=\"", name);
    csg_page_number(page, value * page->scale, page->decimals);
    csg_page_text(page, "\"");
}

static void put_svg(csg_page *page, const csg_layers_head *head, const csg_sliced_layer *layer)
{
    (void)head;
    csg_page_format(page, "<g id=\"layer%zu\" inkscape:groupmode=\"layer\" inkscape:label=\"",
                    layer->number);
    csg_page_number(page, layer->at * page->scale, page->decimals);
    csg_page_text(page, "\"");
    put_attribute(page, "slic3r:z", layer->at);
    put_attribute(page, "slic3r:slice-height", layer->high - layer->low);
    csg_page_text(page, ">\n");
    if (layer->contours.loop_count) {
        csg_page_text(page, "<path fill-rule=\"evenodd\" d=\"");
        for (size_t loop = 0; loop < layer->contours.loop_count; loop++)
            put_loop(page, &layer->contours, loop);
        csg_page_text(page, "\"/>\n");
    }
    csg_page_text(page, "</g>\n");
}

static void end_svg(csg_page *page, const csg_layers_head *head)
{
    (void)head;
    csg_page_text(page, "</svg>\n");
}

const csg_layers_writer csg_layers_svg = {.begin = begin_svg, .layer = put_svg, .end = end_svg};
