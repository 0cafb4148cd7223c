/* SPDX-License-Identifier: MIT
 * Formats of drawings, and what their writers share; see drawings.h.
 */
#include "io/drawings/drawings.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/elementary.h"
#include "base/trace.h"
#include "io/adapter.h"
#include "io/file.h"
#include "io/formats.h"
#include "io/sink.h"

static const struct {
    const char *name;
    csg_draw_fn *draw;
} rows[] = {
    [CSGM_DRAWING_NONE] = {"none", NULL},
#define CSG_DRAWING(ID, name, title, remarks) [CSGM_DRAWING_##ID] = {#name, csg_draw_##name},
#include "io/drawings/drawings.def"
#undef CSG_DRAWING
};

_Static_assert(sizeof rows / sizeof *rows == CSGM_DRAWING_COUNT, "a row for each format");

csgm_drawing_format csg_drawing_format_from_name(const char *name)
{
    for (int i = 1; name && i < CSGM_DRAWING_COUNT; i++)
        if (strcasecmp(rows[i].name, name) == 0)
            return (csgm_drawing_format)i;
    return CSGM_DRAWING_NONE;
}

csgm_drawing_format csg_drawing_format_from_path(const char *path)
{
    const char *dot = path ? strrchr(path, '.') : NULL;
    return dot && !strchr(dot, '/') ? csg_drawing_format_from_name(dot + 1) : CSGM_DRAWING_NONE;
}

const char *csg_drawing_format_name(csgm_drawing_format format)
{
    return (int)format > 0 && format < CSGM_DRAWING_COUNT ? rows[format].name : rows[0].name;
}

/* ---- pages ----------------------------------------------------------------------------------- */

void csg_page_bytes(csg_page *page, const void *bytes, size_t length)
{
    if (page->failed || !csg_memory_reserve(page->memory, (void **)&page->data, &page->capacity,
                                            page->length + length, 1)) {
        page->failed = true;
        return;
    }
    memcpy(page->data + page->length, bytes, length);
    page->length += length;
}

void csg_page_text(csg_page *page, const char *text)
{
    csg_page_bytes(page, text, strlen(text));
}

void csg_page_format(csg_page *page, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    csg_page_bytes(page, text, length < (int)sizeof text ? (size_t)length : sizeof text - 1);
}

void csg_page_number(csg_page *page, double value, int decimals)
{
    char text[CSG_FIXED_MOST];
    csg_page_bytes(page, text, (size_t)(csg_number_put_fixed(text, value, decimals) - text));
}

const char *csg_layer_label(const csg_drawn_layer *layer, char buffer[8])
{
    unsigned rgb[3];
    if (layer->name)
        return layer->name;
    if (!layer->has_color)
        return "outline";
    for (int i = 0; i < 3; i++)
        rgb[i] = (unsigned)lround(255 * (double)layer->color[i]) & 255;
    snprintf(buffer, 8, "#%02x%02x%02x", rgb[0], rgb[1], rgb[2]);
    return buffer;
}

static double millimetres(csgm_unit unit)
{
    switch (unit) {
    case CSGM_UNIT_CM:
        return 10;
    case CSGM_UNIT_M:
        return 1000;
    case CSGM_UNIT_IN:
        return 25.4;
    case CSGM_UNIT_MM:
    case CSGM_UNIT_NONE:
        break;
    }
    return 1;
}

static csg_page begin_page(csgm_context *context, const csg_drawing *drawing, csgm_unit unit)
{
    csg_page page = {.memory = &context->memory, .scale = millimetres(unit)};
    page.box = csg_box_empty();
    for (size_t i = 0; i < drawing->count; i++)
        page.box = csg_box_hull(page.box, csg_outline_box(&drawing->layers[i].outline));
    page.box.min = csg_vec3_scale(page.box.min, page.scale);
    page.box.max = csg_vec3_scale(page.box.max, page.scale);
    csg_vec3 size = csg_box_size(page.box);
    double digits = 9 - ceil(csg_log10(fmax(fmax(size.x, size.y), 1e-300)));
    page.decimals = (int)fmin(fmax(digits, 6), 15);
    return page;
}

/* ---- files ----------------------------------------------------------------------------------- */

csgm_status csg_io_draw_fd(csgm_context *context, const csg_drawing *drawing, int fd,
                           const char *name, csgm_drawing_format format,
                           const csgm_write_options *options)
{
    CSG_ZONE(context, "write");
    csg_sink sink;
    csg_page page = begin_page(context, drawing, options ? options->unit : CSGM_UNIT_NONE);
    rows[format].draw(&page, drawing);
    csgm_status status = page.failed ? csg_context_no_memory(context) : CSGM_OK;
    if (status == CSGM_OK)
        status = csg_sink_open(&sink, context, fd, name);
    if (status == CSGM_OK) {
        csg_sink_put(&sink, page.data, page.length);
        status = csg_sink_close(&sink);
    }
    csg_memory_release(page.memory, page.data, page.capacity);
    return status;
}

csgm_status csg_io_draw(csgm_context *context, const csg_drawing *drawing, const char *path,
                        csgm_drawing_format format, const csgm_write_options *options)
{
    csg_atomic_file file;
    csgm_status status = csg_file_create(&file, context, path);
    if (status)
        return status;
    file.sync = !options || options->sync;
    file.only_if_changed = options && options->only_if_changed;
    status = csg_io_draw_fd(context, drawing, file.fd, path, format, options);
    if (!status)
        return csg_file_commit(&file);
    csg_file_abandon(&file);
    return status;
}
