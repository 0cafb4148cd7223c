/* SPDX-License-Identifier: MIT
 * Pictures as PNG files, by libpng; the only file that knows how they are written. 8 bits a
 * channel, with alpha only where something is transparent; no time, no text, so that the same
 * picture is the same bytes. libpng leaves by longjmp, always to the setjmp in put_image; what is
 * allocated hangs on `writer`, outside of that frame.
 */
#include <png.h>
#include <string.h>

#include "base/sized_block.h"
#include "render/image.h"

/* Measured at 1920 x 1080: level 3 takes a third of the time of 6 for a tenth more bytes. */
enum { COMPRESSION_LEVEL = 3 };

typedef struct writer {
    csg_sink *sink;
    csg_memory *memory;
    const csgm_image *image;
    png_structp png;
    png_infop info;
    uint8_t *row;
    bool is_opaque;
} writer;

static void on_error(png_structp png, png_const_charp message)
{
    (void)message;
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png, (void)message;
}

/* libpng's own memory comes from the budget too. */
static png_voidp allocate(png_structp png, png_alloc_size_t size)
{
    writer *w = png_get_mem_ptr(png);
    return csg_sized_block_alloc(w->memory, size);
}

static void deallocate(png_structp png, png_voidp pointer)
{
    writer *w = png_get_mem_ptr(png);
    csg_sized_block_release(w->memory, pointer);
}

static void write_data(png_structp png, png_bytep data, size_t count)
{
    writer *w = png_get_io_ptr(png);
    csg_sink_put(w->sink, data, count);
}

static void flush_data(png_structp png)
{
    (void)png;
}

static bool is_opaque(const csgm_image *image)
{
    size_t count = csg_image_bytes(image);
    for (size_t i = 3; i < count; i += 4)
        if (image->pixels[i] != 255)
            return false;
    return true;
}

static const uint8_t *row_of(const writer *w, uint32_t y)
{
    const uint8_t *from = w->image->pixels + (size_t)y * w->image->width * 4;
    if (!w->is_opaque)
        return from;
    for (size_t x = 0; x < w->image->width; x++)
        memcpy(w->row + 3 * x, from + 4 * x, 3);
    return w->row;
}

/* False: out of memory, the only thing that can fail here. */
static bool put_image(writer *w)
{
    if (setjmp(png_jmpbuf(w->png)))
        return false;
    png_set_write_fn(w->png, w, write_data, flush_data);
    png_set_IHDR(w->png, w->info, w->image->width, w->image->height, 8,
                 w->is_opaque ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(w->png, w->info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_set_compression_level(w->png, COMPRESSION_LEVEL);
    png_set_filter(w->png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
    png_write_info(w->png, w->info);
    for (uint32_t y = 0; y < w->image->height; y++)
        png_write_row(w->png, row_of(w, y));
    png_write_end(w->png, NULL);
    return true;
}

bool csg_png_is_available(void)
{
    return true;
}

bool csg_png_put(csg_sink *sink, const csgm_image *image)
{
    csg_memory *memory = &sink->context->memory;
    size_t row_bytes = (size_t)image->width * 3;
    writer w = {
        .sink = sink, .memory = memory, .image = image, .row = csg_memory_alloc(memory, row_bytes)};
    if (!w.row)
        return false;
    w.is_opaque = is_opaque(image);
    w.png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &w, on_error, on_warning, &w, allocate,
                                      deallocate);
    w.info = w.png ? png_create_info_struct(w.png) : NULL;
    bool done = w.info && put_image(&w);
    if (w.png)
        png_destroy_write_struct(&w.png, &w.info);
    csg_memory_release(memory, w.row, row_bytes);
    return done;
}
