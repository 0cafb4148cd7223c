/* SPDX-License-Identifier: MIT
 *
 * Layers of solids, for printers. The conventions are those of csgmesh.h.
 */
#ifndef CSGMESH_SLICING_H
#define CSGMESH_SLICING_H

#include "csgmesh/csgmesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What layers are written as. */
typedef enum csgm_layers_format {
    CSGM_LAYERS_NONE,
    CSGM_LAYERS_SVG, /* a group for each layer */
    CSGM_LAYERS_CLI, /* Common Layer Interface, ASCII */
    CSGM_LAYERS_3MF, /* slice extension */
    CSGM_LAYERS_ZIP, /* masks for printers with a screen: an archive with a PNG for each layer */
    CSGM_LAYERS_COUNT
} csgm_layers_format;

CSGM_API csgm_layers_format csgm_layers_format_from_path(const char *path);
CSGM_API csgm_layers_format csgm_layers_format_from_name(const char *name);
CSGM_API const char *csgm_layers_format_name(csgm_layers_format format);
/* Masks need zlib, 3MF libzip and expat, too. */
CSGM_API bool csgm_layers_format_available(csgm_layers_format format);

typedef struct csgm_slice_options {
    uint32_t struct_size; /* set by csgm_slice_options_default; do not touch */
    double height;        /* > 0: of a layer; 0 (default) is none */
    double tolerance;     /* >= 0: how far contours may be from the surface; 0 (default): a 10000th
                             of the longest side */
    csgm_unit unit; /* the length of a scene unit, default CSGM_UNIT_MM: files have millimetres */
    double pixel;   /* > 0: the edge of a mask's pixel in millimetres, default 0.05 */
    bool sync;      /* default true: the file is on the disk before it has its name */
    csgm_monitor monitor; /* stage CSGM_STAGE_WRITE */
    /* Layers of different heights, from `height` to this: each as high as the cusp allows.
     * > height; 0 (default): all are `height`. */
    double most_height;
    /* > 0 with most_height, else 0 (default): how far the steps of layers may stand off the
     * surface, at right angles to it: height times |n_z| of the normals of the surface there. */
    double cusp;
    const char *part; /* of this name alone; NULL (default): all of it */
} csgm_slice_options;

CSGM_API csgm_slice_options csgm_slice_options_default(void);

typedef struct csgm_slice_stats {
    uint32_t struct_size; /* set by csgm_slice_stats_default; do not touch */
    uint64_t layers, contours, points;
    uint64_t unsettled; /* smallest cubes where something thinner than the tolerance may be that no
                           layer shows */
    double smallest;    /* the edge of these */
    double tolerance;
    double volume;          /* of the layers' areas, each times its height */
    double lowest, highest; /* heights of layers */
    /* Smallest cubes, of this edge, where normals are sampled for layers' heights, as their
     * gradients have no bounds; elsewhere |n_z| is proven to be no more. */
    uint64_t sampled;
    double sampled_edge;
} csgm_slice_stats;

/* All zeros but struct_size. */
CSGM_API csgm_slice_stats csgm_slice_stats_default(void);

/* Layers of {f >= 0} from below, straight from the field (docs/slice.md): the solid is cut in the
 * middle of each. Contours are closed, have the solid on their left and cross neither others nor
 * themselves; they are within the tolerance of the surface, and what is not shown is thinner than
 * it. The file appears complete or not at all, and has the same bytes for any number of threads.
 * stats: NULL, or written on CSGM_OK. CSGM_ERR_ARGUMENT: an option out of range, or no part has
 * that name (csgm_field_part). CSGM_ERR_SCENE (reported): the solid is empty or unbounded.
 * CSGM_ERR_UNSUPPORTED: this build lacks the format.
 */
CSGM_API csgm_status csgm_slice_field(csgm_context *context, const csgm_field *field,
                                      const char *path, csgm_layers_format format,
                                      const csgm_slice_options *options, csgm_slice_stats *stats);
/* name: for diagnostics. The descriptor stays open. */
CSGM_API csgm_status csgm_slice_field_fd(csgm_context *context, const csgm_field *field, int fd,
                                         const char *name, csgm_layers_format format,
                                         const csgm_slice_options *options,
                                         csgm_slice_stats *stats);

#ifdef __cplusplus
}
#endif

#endif
