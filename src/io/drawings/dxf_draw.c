/* SPDX-License-Identifier: MIT
 * DXF of AutoCAD R12, which every program reads: each loop a closed POLYLINE on its layer. Names of
 * layers are made of what R12 allows; colours are the nearest of its first nine.
 */
#include <stdio.h>
#include <string.h>

#include "io/drawings/drawings.h"

enum { NAME_MOST = 31 };

static void put_pair(csg_page *page, int code, const char *value)
{
    csg_page_format(page, "%d\n%s\n", code, value);
}

static void put_real(csg_page *page, int code, double value)
{
    csg_page_format(page, "%d\n", code);
    csg_page_number(page, value, page->decimals);
    csg_page_text(page, "\n");
}

/* Letters, digits, '-' and '_'; the length. '$' is kept for numbers. */
static size_t base_name(const csg_drawing *drawing, size_t index, char out[NAME_MOST + 1])
{
    static const char allowed[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
    char label[8];
    const char *text = csg_layer_label(&drawing->layers[index], label);
    size_t length = 0;
    for (; *text && length < NAME_MOST - 6; text++) {
        char c = *text >= 'a' && *text <= 'z' ? (char)(*text - 'a' + 'A') : *text;
        if (((unsigned char)c & 0xC0) != 0x80) /* one for each character */
            out[length++] = strchr(allowed, c) ? c : '_';
    }
    out[length] = '\0';
    return length;
}

/* With '$' and the layer's number where an earlier one is the same: no other can be called so. */
static void name_layer(const csg_drawing *drawing, size_t index, char out[NAME_MOST + 1])
{
    char other[NAME_MOST + 1];
    size_t length = base_name(drawing, index, out);
    for (size_t i = 0; i < index; i++) {
        base_name(drawing, i, other);
        if (strcmp(other, out) == 0) {
            snprintf(out + length, NAME_MOST + 1 - length, "$%u", (unsigned)(index + 1) % 100000);
            return;
        }
    }
}

static int nearest_color(const csg_drawn_layer *layer)
{
    static const float colors[9][3] = {{1, 0, 0}, {1, 1, 0},       {0, 1, 0},
                                       {0, 1, 1}, {0, 0, 1},       {1, 0, 1},
                                       {0, 0, 0}, {.5F, .5F, .5F}, {.75F, .75F, .75F}};
    enum { BLACK_OR_WHITE = 7 };
    int best = BLACK_OR_WHITE;
    float least = 3;
    for (int i = 0; i < 9 && layer->has_color; i++) {
        float r = layer->color[0] - colors[i][0], g = layer->color[1] - colors[i][1],
              b = layer->color[2] - colors[i][2], distance = r * r + g * g + b * b;
        if (distance < least) {
            least = distance;
            best = i + 1;
        }
    }
    return best;
}

static void put_header(csg_page *page)
{
    const csg_vec3 *ends[2] = {&page->box.min, &page->box.max};
    static const char *const names[2] = {"$EXTMIN", "$EXTMAX"};
    put_pair(page, 0, "SECTION");
    put_pair(page, 2, "HEADER");
    put_pair(page, 9, "$ACADVER");
    put_pair(page, 1, "AC1009");
    put_pair(page, 9, "$INSUNITS");
    put_pair(page, 70, "4"); /* millimetres */
    put_pair(page, 9, "$MEASUREMENT");
    put_pair(page, 70, "1"); /* metric */
    for (int i = 0; i < 2; i++) {
        put_pair(page, 9, names[i]);
        put_real(page, 10, ends[i]->x);
        put_real(page, 20, ends[i]->y);
        put_real(page, 30, 0);
    }
    put_pair(page, 0, "ENDSEC");
}

static void put_tables(csg_page *page, const csg_drawing *drawing)
{
    char name[NAME_MOST + 1];
    csg_page_text(page,
                  "0\nSECTION\n2\nTABLES\n0\nTABLE\n2\nLTYPE\n70\n1\n0\nLTYPE\n2\nCONTINUOUS\n"
                  "70\n0\n3\nSolid line\n72\n65\n73\n0\n40\n0\n0\nENDTAB\n"
                  "0\nTABLE\n2\nLAYER\n");
    csg_page_format(page, "70\n%zu\n", drawing->count);
    for (size_t i = 0; i < drawing->count; i++) {
        name_layer(drawing, i, name);
        csg_page_format(page, "0\nLAYER\n2\n%s\n70\n0\n62\n%d\n6\nCONTINUOUS\n", name,
                        nearest_color(&drawing->layers[i]));
    }
    csg_page_text(page, "0\nENDTAB\n0\nENDSEC\n");
}

static void put_loop(csg_page *page, const csg_outline *outline, size_t loop, const char *layer)
{
    csg_page_format(page, "0\nPOLYLINE\n8\n%s\n66\n1\n70\n1\n10\n0\n20\n0\n30\n0\n", layer);
    for (size_t i = csg_outline_first(outline, loop); i < outline->ends[loop]; i++) {
        csg_page_format(page, "0\nVERTEX\n8\n%s\n", layer);
        put_real(page, 10, outline->points[i].x * page->scale);
        put_real(page, 20, outline->points[i].y * page->scale);
        put_real(page, 30, 0);
    }
    csg_page_format(page, "0\nSEQEND\n8\n%s\n", layer);
}

void csg_draw_dxf(csg_page *page, const csg_drawing *drawing)
{
    char name[NAME_MOST + 1];
    put_header(page);
    put_tables(page, drawing);
    csg_page_text(page, "0\nSECTION\n2\nENTITIES\n");
    for (size_t i = 0; i < drawing->count; i++) {
        const csg_outline *outline = &drawing->layers[i].outline;
        name_layer(drawing, i, name);
        for (size_t loop = 0; loop < outline->loop_count; loop++)
            put_loop(page, outline, loop, name);
    }
    csg_page_text(page, "0\nENDSEC\n0\nEOF\n");
}
