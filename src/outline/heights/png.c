/* SPDX-License-Identifier: MIT
 * PNG images as heights, by libpng; the only file that knows it. The image is read line by line
 * into the heights, so that little more memory is needed than for them; an interlaced one is kept
 * whole. libpng leaves by longjmp, always to the setjmp in read_image, which owns nothing itself:
 * what is allocated hangs on `image`, outside of the frame.
 */
#include <png.h>
#include <string.h>

#include "base/sized_block.h"
#include "outline/heights/heights.h"

enum { MOST_SIDE = 1 << 20 }; /* pixels */

typedef struct image {
    csg_memory *memory;
    csg_problem *problem;
    png_structp png;
    png_infop info;
    const uint8_t *data;
    size_t size, at;
    size_t columns, rows, channels;
    uint8_t *pixels; /* one line, or all when interlaced; 16 bits each, the high byte first */
    size_t pixel_bytes;
    double *values;
    bool invert;
    csgm_status status; /* why it failed, when it is not the file's fault */
} image;

static void on_error(png_structp png, png_const_charp message)
{
    image *im = png_get_error_ptr(png);
    if (im->status == CSGM_ERR_FORMAT)
        csg_problem_set(im->problem, im->status, "the PNG image is broken: %s", message);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png, (void)message;
}

static void read_data(png_structp png, png_bytep to, size_t count)
{
    image *im = png_get_io_ptr(png);
    if (count > im->size - im->at)
        png_error(png, "it ends too early");
    memcpy(to, im->data + im->at, count);
    im->at += count;
}

/* libpng's own memory comes from the budget too. */
static png_voidp allocate(png_structp png, png_alloc_size_t size)
{
    image *im = png_get_mem_ptr(png);
    void *block = csg_sized_block_alloc(im->memory, size);
    if (!block)
        im->status = CSGM_ERR_MEMORY;
    return block;
}

static void deallocate(png_structp png, png_voidp pointer)
{
    image *im = png_get_mem_ptr(png);
    csg_sized_block_release(im->memory, pointer);
}

/* Gray or RGB of 16 bits a channel, with or without alpha, whatever the file has. */
static void set_transformations(image *im)
{
    png_set_expand_16(im->png);
    if (png_get_color_type(im->png, im->info) == PNG_COLOR_TYPE_PALETTE)
        png_set_palette_to_rgb(im->png);
    png_set_strip_alpha(im->png);
    png_set_interlace_handling(im->png);
    png_read_update_info(im->png, im->info);
    im->channels = png_get_channels(im->png, im->info);
}

static bool make_room(image *im)
{
    size_t count = im->columns * im->rows;
    bool interlaced = png_get_interlace_type(im->png, im->info) != PNG_INTERLACE_NONE;
    im->pixel_bytes = png_get_rowbytes(im->png, im->info) * (interlaced ? im->rows : 1);
    im->pixels = csg_memory_alloc(im->memory, im->pixel_bytes);
    im->values = csg_memory_alloc(im->memory, count * sizeof(double));
    if (!im->pixels || !im->values) {
        im->status = CSGM_ERR_MEMORY;
        return false;
    }
    memset(im->pixels, 0, im->pixel_bytes);
    return true;
}

static double channel(const uint8_t *pixel, size_t index)
{
    return (double)(pixel[2 * index] << 8 | pixel[2 * index + 1]) / 65535;
}

static void convert_line(image *im, const uint8_t *pixels, size_t line)
{
    double *values = im->values + (im->rows - 1 - line) * im->columns;
    for (size_t x = 0; x < im->columns; x++) {
        const uint8_t *pixel = pixels + x * im->channels * 2;
        double gray = im->channels < 3 ? channel(pixel, 0)
                                       : 0.2126 * channel(pixel, 0) + 0.7152 * channel(pixel, 1) +
                                             0.0722 * channel(pixel, 2);
        values[x] = im->invert ? 100.0 / 255 - 100 * gray : 100 * gray;
    }
}

static void read_lines(image *im)
{
    int passes = png_get_interlace_type(im->png, im->info) == PNG_INTERLACE_NONE ? 1 : 7;
    size_t line_bytes = png_get_rowbytes(im->png, im->info);
    size_t step = passes == 1 ? 0 : line_bytes;
    for (int pass = 0; pass < passes; pass++)
        for (size_t y = 0; y < im->rows; y++) {
            png_read_row(im->png, im->pixels + y * step, NULL);
            if (pass + 1 == passes)
                convert_line(im, im->pixels + y * step, y);
        }
}

/* False: im->problem or im->status says why. */
static bool read_image(image *im)
{
    if (setjmp(png_jmpbuf(im->png)))
        return false;
    png_set_user_limits(im->png, MOST_SIDE, MOST_SIDE);
    png_set_chunk_malloc_max(im->png, 1 << 20);
    png_set_chunk_cache_max(im->png, 64);
    png_set_crc_action(im->png, PNG_CRC_ERROR_QUIT, PNG_CRC_WARN_DISCARD);
    png_set_read_fn(im->png, im, read_data);
    png_read_info(im->png, im->info);
    im->columns = png_get_image_width(im->png, im->info);
    im->rows = png_get_image_height(im->png, im->info);
    if (im->columns > CSG_HEIGHTS_MOST / im->rows) {
        im->status = csg_problem_set(im->problem, CSGM_ERR_LIMIT,
                                     "the image has more than %zu pixels", CSG_HEIGHTS_MOST);
        return false;
    }
    set_transformations(im);
    if (!make_room(im))
        return false;
    read_lines(im);
    return true;
}

static double lowest_of(const double *values, size_t count)
{
    double lowest = INFINITY;
    for (size_t i = 0; i < count; i++)
        lowest = fmin(lowest, values[i]);
    return lowest;
}

csgm_status csg_heights_from_png(csg_memory *memory, const void *data, size_t size, bool invert,
                                 csg_heights *out, csg_problem *problem)
{
    image im = {.memory = memory,
                .problem = problem,
                .data = data,
                .size = size,
                .invert = invert,
                .status = CSGM_ERR_FORMAT};
    *out = (csg_heights){.memory = memory};
    im.png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &im, on_error, on_warning, &im,
                                      allocate, deallocate);
    im.info = im.png ? png_create_info_struct(im.png) : NULL;
    bool made = im.info != NULL, done = made && read_image(&im);
    size_t count = im.columns * im.rows;
    png_destroy_read_struct(&im.png, &im.info, NULL);
    csg_memory_release(memory, im.pixels, im.pixel_bytes);
    if (!done) {
        csg_memory_release(memory, im.values, count * sizeof(double));
        return made ? im.status : CSGM_ERR_MEMORY;
    }
    *out = (csg_heights){memory, im.columns, im.rows, im.values, lowest_of(im.values, count), 0};
    return CSGM_OK;
}
