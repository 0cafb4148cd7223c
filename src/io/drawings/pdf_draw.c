/* SPDX-License-Identifier: MIT
 * PDF 1.6: one page of the drawing's size, a filled path for each layer, which is an optional
 * content group that viewers can switch. Not compressed, without dates and identifiers: the same
 * drawing is the same bytes.
 */
#include <math.h>
#include <string.h>

#include "base/utf8.h"
#include "io/drawings/drawings.h"

/* Objects: 1 the catalog, 2 the pages, 3 the page, 4 its content, 5 that's length, then layers. */
enum { CATALOG = 1, PAGES, PAGE, CONTENT, LENGTH, FIRST_LAYER };

static const double POINTS = 72 / 25.4; /* in a millimetre */
static const double LONGEST = 14400; /* units of a page's side; beyond, a unit is several points */

typedef struct writer {
    csg_page *page;
    size_t *starts; /* of objects, by their numbers */
    size_t count;
} writer;

static void begin_object(writer *w, size_t number)
{
    w->starts[number] = w->page->length;
    csg_page_format(w->page, "%zu 0 obj\n", number);
}

/* As UTF-16 in hexadecimal digits, which any name can be. */
static void put_name(csg_page *page, const char *text)
{
    uint32_t character;
    size_t left = strlen(text);
    csg_page_text(page, "<FEFF");
    while (left) {
        size_t length = csg_utf8_decode(text, left, &character);
        if (length == 0) {
            character = 0xFFFD;
            length = 1;
        }
        if (character > 0xFFFF)
            csg_page_format(page, "%04X%04X", 0xD800 + (unsigned)((character - 0x10000) >> 10),
                            0xDC00 + (unsigned)((character - 0x10000) & 0x3FF));
        else
            csg_page_format(page, "%04X", (unsigned)character);
        text += length;
        left -= length;
    }
    csg_page_text(page, ">");
}

static void put_references(csg_page *page, size_t count)
{
    for (size_t i = 0; i < count; i++)
        csg_page_format(page, "%s%zu 0 R", i ? " " : "", FIRST_LAYER + i);
}

static void put_catalog(writer *w, size_t layers)
{
    begin_object(w, CATALOG);
    csg_page_format(w->page, "<< /Type /Catalog /Pages %d 0 R /OCProperties << /OCGs [", PAGES);
    put_references(w->page, layers);
    csg_page_text(w->page, "] /D << /Order [");
    put_references(w->page, layers);
    csg_page_text(w->page, "] /ON [");
    put_references(w->page, layers);
    csg_page_text(w->page, "] >> >> >>\nendobj\n");
    begin_object(w, PAGES);
    csg_page_format(w->page, "<< /Type /Pages /Kids [%d 0 R] /Count 1 >>\nendobj\n", PAGE);
}

static void put_page(writer *w, size_t layers, double unit)
{
    csg_page *page = w->page;
    csg_vec3 size = csg_box_size(page->box);
    begin_object(w, PAGE);
    csg_page_format(page, "<< /Type /Page /Parent %d 0 R /MediaBox [0 0 ", PAGES);
    csg_page_number(page, size.x * POINTS / unit, 6);
    csg_page_text(page, " ");
    csg_page_number(page, size.y * POINTS / unit, 6);
    csg_page_text(page, "]");
    if (unit > 1) {
        csg_page_text(page, " /UserUnit ");
        csg_page_number(page, unit, 0);
    }
    csg_page_format(page, " /Contents %d 0 R /Resources << /Properties <<", CONTENT);
    for (size_t i = 0; i < layers; i++)
        csg_page_format(page, " /L%zu %zu 0 R", i + 1, FIRST_LAYER + i);
    csg_page_text(page, " >> >> >>\nendobj\n");
}

static void put_numbers(csg_page *page, const double *numbers, int count, int decimals,
                        const char *operator)
{
    for (int i = 0; i < count; i++) {
        csg_page_number(page, numbers[i], decimals);
        csg_page_text(page, " ");
    }
    csg_page_text(page, operator);
}

static void put_layer(csg_page *page, const csg_drawn_layer *layer, size_t number)
{
    const double grey = 0.827451; /* SVG's lightgray */
    double color[3] = {grey, grey, grey};
    const csg_outline *outline = &layer->outline;
    for (int i = 0; i < 3 && layer->has_color; i++)
        color[i] = (double)layer->color[i];
    csg_page_format(page, "/OC /L%zu BDC\n", number);
    put_numbers(page, color, 3, 6, "rg\n");
    for (size_t loop = 0; loop < outline->loop_count; loop++) {
        size_t first = csg_outline_first(outline, loop);
        for (size_t i = first; i < outline->ends[loop]; i++) {
            const double at[2] = {outline->points[i].x * page->scale - page->box.min.x,
                                  outline->points[i].y * page->scale - page->box.min.y};
            put_numbers(page, at, 2, page->decimals, i == first ? "m\n" : "l\n");
        }
        csg_page_text(page, "h\n");
    }
    csg_page_text(page, "B*\nEMC\n");
}

static void put_content(writer *w, const csg_drawing *drawing, double unit)
{
    csg_page *page = w->page;
    const double map[6] = {POINTS / unit, 0, 0, POINTS / unit, 0, 0};
    begin_object(w, CONTENT);
    csg_page_format(page, "<< /Length %d 0 R >>\nstream\n", LENGTH);
    size_t begin = page->length;
    put_numbers(page, map, 6, 9, "cm\n0.1 w\n");
    for (size_t i = 0; i < drawing->count; i++)
        put_layer(page, &drawing->layers[i], i + 1);
    size_t length = page->length - begin;
    csg_page_text(page, "endstream\nendobj\n");
    begin_object(w, LENGTH);
    csg_page_format(page, "%zu\nendobj\n", length);
}

static void put_all(writer *w, const csg_drawing *drawing)
{
    csg_page *page = w->page;
    csg_vec3 size = csg_box_size(page->box);
    double unit = fmax(ceil(fmax(size.x, size.y) * POINTS / LONGEST), 1);
    char label[8];
    csg_page_text(page, "%PDF-1.6\n%\xE2\xE3\xCF\xD3\n");
    put_catalog(w, drawing->count);
    put_page(w, drawing->count, unit);
    put_content(w, drawing, unit);
    for (size_t i = 0; i < drawing->count; i++) {
        begin_object(w, FIRST_LAYER + i);
        csg_page_text(page, "<< /Type /OCG /Name ");
        put_name(page, csg_layer_label(&drawing->layers[i], label));
        csg_page_text(page, " >>\nendobj\n");
    }
    size_t table = page->length;
    csg_page_format(page, "xref\n0 %zu\n0000000000 65535 f \n", w->count);
    for (size_t i = 1; i < w->count; i++)
        csg_page_format(page, "%010zu 00000 n \n", w->starts[i]);
    csg_page_format(page, "trailer\n<< /Size %zu /Root %d 0 R >>\nstartxref\n%zu\n%%%%EOF\n",
                    w->count, CATALOG, table);
}

void csg_draw_pdf(csg_page *page, const csg_drawing *drawing)
{
    writer w = {.page = page, .count = FIRST_LAYER + drawing->count};
    size_t bytes = w.count * sizeof *w.starts;
    w.starts = csg_memory_alloc(page->memory, bytes);
    if (w.starts)
        put_all(&w, drawing);
    else
        page->failed = true;
    csg_memory_release(page->memory, w.starts, bytes);
}
