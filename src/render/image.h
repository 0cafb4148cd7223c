/* SPDX-License-Identifier: MIT
 * A picture: sRGB with alpha, a byte a channel, rows from the top; and its files. PNG is libpng's
 * (png.c, or no_png.c where it is missing), PPM is written here.
 */
#ifndef CSG_RENDER_IMAGE_H
#define CSG_RENDER_IMAGE_H

#include "base/context.h"
#include "io/sink.h"

struct csgm_image {
    csgm_context *context;
    uint32_t width, height;
    uint8_t *pixels; /* 4 * width * height */
};

enum { CSG_IMAGE_MOST_SIDE = 16384 };

static inline size_t csg_image_bytes(const csgm_image *image)
{
    return (size_t)image->width * image->height * 4;
}

/* Not filled. Sizes out of range and memory are reported. */
csgm_status csg_image_create(csgm_context *context, uint32_t width, uint32_t height,
                             csgm_image **out);
void csg_image_destroy(csgm_image *image);

csgm_image_format csg_image_format_from_path(const char *path);
bool csg_image_format_available(csgm_image_format format);
/* Report what fails. */
csgm_status csg_image_write(csgm_context *context, const csgm_image *image, const char *path,
                            csgm_image_format format);
csgm_status csg_image_write_fd(csgm_context *context, const csgm_image *image, int fd,
                               const char *name, csgm_image_format format);

/* ---- png.c, no_png.c ----------------------------------------------------------------- */

bool csg_png_is_available(void);
/* Into the sink, whose own errors stick there. False: out of memory. */
bool csg_png_put(csg_sink *sink, const csgm_image *image);

#endif
