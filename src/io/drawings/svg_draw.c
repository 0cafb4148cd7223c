/* SPDX-License-Identifier: MIT
 * SVG 1.1: a group for each layer (Inkscape shows them as layers), one path in it. y points down
 * there, so it changes its sign; width and height are in mm and the viewBox has the same numbers.
 */
#include <string.h>

#include "io/drawings/drawings.h"

/* As text between tags or in quotes; what XML cannot hold is a question mark. */
static void put_escaped(csg_page *page, const char *text)
{
    for (char one[2] = ""; *text; text++) {
        if (strncmp(text, "\xEF\xBF\xBE", 3) == 0 || strncmp(text, "\xEF\xBF\xBF", 3) == 0) {
            csg_page_text(page, "?"); /* U+FFFE and U+FFFF */
            text += 2;
            continue;
        }
        one[0] = (unsigned char)*text < 0x20 ? '?' : *text;
        csg_page_text(page, *text == '&'   ? "&amp;"
                            : *text == '<' ? "&lt;"
                            : *text == '>' ? "&gt;"
                            : *text == '"' ? "&quot;"
                                           : one);
    }
}

void csg_page_svg_point(csg_page *page, const char *letter, csg_vec2 p)
{
    csg_page_text(page, letter);
    csg_page_number(page, p.x * page->scale, page->decimals);
    csg_page_text(page, " ");
    csg_page_number(page, -p.y * page->scale, page->decimals);
}

static void put_path(csg_page *page, const csg_outline *outline)
{
    csg_page_text(page, "<path fill-rule=\"evenodd\" d=\"");
    for (size_t loop = 0; loop < outline->loop_count; loop++) {
        size_t first = csg_outline_first(outline, loop);
        for (size_t i = first; i < outline->ends[loop]; i++)
            csg_page_svg_point(page, i == first ? "M" : i % 8 ? "L" : "\nL", outline->points[i]);
        csg_page_text(page, "Z");
    }
    csg_page_text(page, "\"/>\n");
}

static void put_layer(csg_page *page, const csg_drawn_layer *layer, size_t number)
{
    char label[8], color[8] = "#d3d3d3";
    csg_drawn_layer plain = *layer;
    plain.name = NULL;
    csg_page_format(page, "<g id=\"layer%zu\" inkscape:groupmode=\"layer\" inkscape:label=\"",
                    number);
    put_escaped(page, csg_layer_label(layer, label));
    if (layer->has_color)
        csg_layer_label(&plain, color);
    csg_page_format(page, "\" fill=\"%s\"", color);
    if (layer->has_color && layer->color[3] < 1) {
        csg_page_text(page, " fill-opacity=\"");
        csg_page_number(page, (double)layer->color[3], 4);
        csg_page_text(page, "\"");
    }
    csg_page_text(page, " stroke=\"#000000\" stroke-width=\"0.1\">\n");
    put_path(page, &layer->outline);
    csg_page_text(page, "</g>\n");
}

void csg_page_begin_svg(csg_page *page, const char *namespaces)
{
    csg_vec3 size = csg_box_size(page->box);
    const double view[4] = {page->box.min.x, -page->box.max.y, size.x, size.y};
    csg_page_format(page,
                    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                    "<svg xmlns=\"http://www.w3.org/2000/svg\" "
                    "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\"%s "
                    "version=\"1.1\" width=\"",
                    namespaces);
    csg_page_number(page, size.x, page->decimals);
    csg_page_text(page, "mm\" height=\"");
    csg_page_number(page, size.y, page->decimals);
    csg_page_text(page, "mm\" viewBox=\"");
    for (int i = 0; i < 4; i++) {
        csg_page_text(page, i ? " " : "");
        csg_page_number(page, view[i], page->decimals);
    }
    csg_page_text(page, "\">\n");
}

void csg_draw_svg(csg_page *page, const csg_drawing *drawing)
{
    csg_page_begin_svg(page, "");
    for (size_t i = 0; i < drawing->count; i++)
        put_layer(page, &drawing->layers[i], i + 1);
    csg_page_text(page, "</svg>\n");
}
