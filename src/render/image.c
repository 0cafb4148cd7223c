/* SPDX-License-Identifier: MIT
 * Pictures in memory and their way into files; see image.h.
 */
#include "render/image.h"

#include <strings.h>

#include "base/mesh_codes.h"
#include "base/trace.h"
#include "io/file.h"

csgm_status csg_image_create(csgm_context *context, uint32_t width, uint32_t height,
                             csgm_image **out)
{
    *out = NULL;
    if (width < 1 || height < 1 || width > CSG_IMAGE_MOST_SIDE || height > CSG_IMAGE_MOST_SIDE) {
        csg_diag_plain(&context->diags, CSG_DIAG_BAD_PICTURE, NULL, NULL,
                       "a picture has from 1 to %d pixels along a side, not %u x %u",
                       CSG_IMAGE_MOST_SIDE, width, height);
        return CSGM_ERR_ARGUMENT;
    }
    csgm_image *image = csg_memory_alloc(&context->memory, sizeof *image);
    if (!image)
        return csg_context_no_memory(context);
    *image = (csgm_image){.context = context, .width = width, .height = height};
    image->pixels = csg_memory_alloc(&context->memory, csg_image_bytes(image));
    if (!image->pixels) {
        csg_memory_release(&context->memory, image, sizeof *image);
        return csg_context_no_memory(context);
    }
    *out = image;
    return CSGM_OK;
}

void csg_image_destroy(csgm_image *image)
{
    if (!image)
        return;
    csg_memory *memory = &image->context->memory;
    csg_memory_release(memory, image->pixels, csg_image_bytes(image));
    csg_memory_release(memory, image, sizeof *image);
}

/* ---- files ------------------------------------------------------------------------------ */

csgm_image_format csg_image_format_from_path(const char *path)
{
    const char *dot = strrchr(path, '.');
    if (dot && strcasecmp(dot, ".png") == 0)
        return CSGM_IMAGE_PNG;
    return dot && strcasecmp(dot, ".ppm") == 0 ? CSGM_IMAGE_PPM : CSGM_IMAGE_AUTO;
}

bool csg_image_format_available(csgm_image_format format)
{
    return format == CSGM_IMAGE_PPM || (format == CSGM_IMAGE_PNG && csg_png_is_available());
}

static uint8_t over_white(uint8_t value, uint8_t alpha)
{
    return (uint8_t)((value * alpha + 255 * (255 - alpha) + 127) / 255);
}

static void put_ppm(csg_sink *sink, const csgm_image *image)
{
    csg_sink_format(sink, "P6\n%u %u\n255\n", image->width, image->height);
    const uint8_t *pixel = image->pixels, *end = pixel + csg_image_bytes(image);
    for (; pixel < end; pixel += 4) {
        uint8_t *at = csg_sink_room(sink, 3);
        for (int c = 0; c < 3; c++)
            at[c] = over_white(pixel[c], pixel[3]);
        csg_sink_took(sink, at + 3);
    }
}

static csgm_status find_format(csgm_context *context, const char *name, csgm_image_format *format)
{
    if (*format == CSGM_IMAGE_AUTO)
        *format = csg_image_format_from_path(name);
    if (*format == CSGM_IMAGE_AUTO) {
        csg_diag_plain(&context->diags, CSG_DIAG_UNKNOWN_FORMAT, name, "pictures are .png or .ppm",
                       "the name tells no format of pictures");
        return CSGM_ERR_UNSUPPORTED;
    }
    if (csg_image_format_available(*format))
        return CSGM_OK;
    csg_diag_plain(&context->diags, CSG_DIAG_NO_LIBRARY, name, "write a .ppm",
                   "this build cannot write PNG pictures (made without libpng)");
    return CSGM_ERR_UNSUPPORTED;
}

/* The format is known and there. */
static csgm_status put_image(csgm_context *context, const csgm_image *image, int fd,
                             const char *name, csgm_image_format format)
{
    CSG_ZONE(context, "write picture");
    csg_sink sink;
    csgm_status status = csg_sink_open(&sink, context, fd, name);
    if (status != CSGM_OK)
        return status;
    bool made = true;
    if (format == CSGM_IMAGE_PPM)
        put_ppm(&sink, image);
    else
        made = csg_png_put(&sink, image);
    if (made)
        return csg_sink_close(&sink);
    csg_sink_discard(&sink);
    return csg_context_no_memory(context);
}

csgm_status csg_image_write(csgm_context *context, const csgm_image *image, const char *path,
                            csgm_image_format format)
{
    csg_atomic_file file;
    csgm_status status = find_format(context, path, &format);
    if (status == CSGM_OK)
        status = csg_file_create(&file, context, path);
    if (status != CSGM_OK)
        return status;
    file.sync = false; /* a picture is made again sooner than a disk is waited for */
    status = put_image(context, image, file.fd, path, format);
    if (status == CSGM_OK)
        return csg_file_commit(&file);
    csg_file_abandon(&file);
    return status;
}

csgm_status csg_image_write_fd(csgm_context *context, const csgm_image *image, int fd,
                               const char *name, csgm_image_format format)
{
    csgm_status status = find_format(context, name, &format);
    return status == CSGM_OK ? put_image(context, image, fd, name, format) : status;
}
