/* SPDX-License-Identifier: MIT
 * 3MF with the slice extension (version 1.0.2): a stack of slices with their heights, and an object
 * that refers to it. An object must have a mesh, which may be coarse if it says so: it is the box
 * of the solid's layers, "lowres", and the extension is one that readers must know. Outer contours
 * run counter-clockwise, holes clockwise, as the positive fill rule asks. The text goes into the
 * package (threemf/zip_write.h).
 */
#include "io/layers/layers.h"
#include "io/threemf/threemf_package.h"

enum { STACK_ID = 1, OBJECT_ID = 2 };

static void put_attribute(csg_page *page, const char *before, double value)
{
    csg_page_text(page, before);
    csg_page_number(page, value, page->decimals);
}

static void begin_model(csg_page *page, const csg_layers_head *head)
{
    csg_page_text(page, CSG_XML_HEAD
                  "<model unit=\"millimeter\" " CSG_3MF_CORE " "
                  "xmlns:s=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\" "
                  "requiredextensions=\"s\">\n" CSG_3MF_APPLICATION "<resources>\n");
    csg_page_format(page, "<s:slicestack id=\"%d\"", STACK_ID);
    put_attribute(page, " zbottom=\"", head->bottom * page->scale);
    csg_page_text(page, "\">\n");
}

static void put_vertices(csg_page *page, const csg_outline *contours)
{
    csg_page_text(page, "<s:vertices>\n");
    for (size_t i = 0; i < contours->point_count; i++) {
        put_attribute(page, "<s:vertex x=\"", contours->points[i].x * page->scale);
        put_attribute(page, "\" y=\"", contours->points[i].y * page->scale);
        csg_page_text(page, "\"/>\n");
    }
    csg_page_text(page, "</s:vertices>\n");
}

/* Closed: the last segment ends at the first vertex. */
static void put_polygon(csg_page *page, size_t first, size_t end)
{
    csg_page_format(page, "<s:polygon startv=\"%zu\">\n", first);
    for (size_t i = first + 1; i <= end; i++)
        csg_page_format(page, "<s:segment v2=\"%zu\"/>\n", i < end ? i : first);
    csg_page_text(page, "</s:polygon>\n");
}

static void put_slice(csg_page *page, const csg_layers_head *head, const csg_sliced_layer *layer)
{
    const csg_outline *contours = &layer->contours;
    (void)head;
    put_attribute(page, "<s:slice ztop=\"", layer->high * page->scale);
    if (!contours->loop_count) {
        csg_page_text(page, "\"/>\n");
        return;
    }
    csg_page_text(page, "\">\n");
    put_vertices(page, contours);
    for (size_t loop = 0; loop < contours->loop_count; loop++)
        put_polygon(page, csg_outline_first(contours, loop), contours->ends[loop]);
    csg_page_text(page, "</s:slice>\n");
}

/* Corner k has the greater x where bit 0 is set, y: bit 1, z: bit 2. */
static void put_box(csg_page *page, const csg_layers_head *head)
{
    static const int faces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6},
                                     {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                     {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    const double z[2] = {head->bottom * page->scale, head->top * page->scale};
    csg_page_text(page, "<mesh>\n<vertices>\n");
    for (int k = 0; k < 8; k++) {
        put_attribute(page, "<vertex x=\"", k & 1 ? page->box.max.x : page->box.min.x);
        put_attribute(page, "\" y=\"", k & 2 ? page->box.max.y : page->box.min.y);
        put_attribute(page, "\" z=\"", z[k >> 2]);
        csg_page_text(page, "\"/>\n");
    }
    csg_page_text(page, "</vertices>\n<triangles>\n");
    for (int i = 0; i < 12; i++)
        csg_page_format(page, "<triangle v1=\"%d\" v2=\"%d\" v3=\"%d\"/>\n", faces[i][0],
                        faces[i][1], faces[i][2]);
    csg_page_text(page, "</triangles>\n</mesh>\n");
}

static void end_model(csg_page *page, const csg_layers_head *head)
{
    csg_page_format(page,
                    "</s:slicestack>\n<object id=\"%d\" type=\"model\" s:slicestackid=\"%d\" "
                    "s:meshresolution=\"lowres\">\n",
                    OBJECT_ID, STACK_ID);
    put_box(page, head);
    csg_page_format(page,
                    "</object>\n</resources>\n<build>\n<item objectid=\"%d\"/>\n</build>\n"
                    "</model>\n",
                    OBJECT_ID);
}

const csg_layers_writer csg_layers_3mf = {begin_model, put_slice, end_model, .is_package = true,
                                          .most_bytes = CSG_LAYERS_ARCHIVE_BYTES};
