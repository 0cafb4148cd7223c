/* SPDX-License-Identifier: MIT
 * Layers of a solid as files for printers, in millimetres: what is written before, for each and
 * after all of them. Layers are put onto pages by any worker and go to the file in their order.
 */
#ifndef CSG_IO_LAYERS_H
#define CSG_IO_LAYERS_H

#include "csgmesh/slicing.h"
#include "io/drawings/drawings.h"

csgm_layers_format csg_layers_format_from_path(const char *path); /* NULL gives NONE */
csgm_layers_format csg_layers_format_from_name(const char *name);
const char *csg_layers_format_name(csgm_layers_format format);
/* Are the libraries there that it needs? False for what is no format. */
bool csg_layers_format_available(csgm_layers_format format);

/* A picture in an archive, and where its layer is, in millimetres. */
typedef struct csg_mask_entry {
    uint32_t crc, bytes;
    double low, high;
} csg_mask_entry;

/* What is the same for all layers of a file; scene units. */
typedef struct csg_layers_head {
    csg_box box;        /* of the solid */
    double tolerance;   /* of the contours */
    double scale;       /* from scene units to millimetres */
    double lowest;      /* layer's height */
    double bottom, top; /* of all layers */
    size_t count;
    /* of masks, in millimetres: pixels, the upper left corner, and an entry for each layer that its
     * worker fills */
    double pixel;
    uint32_t width, height;
    csg_vec2 corner;
    csg_mask_entry *masks;
} csg_layers_head;

typedef struct csg_sliced_layer {
    size_t number;        /* from 0, from below */
    double low, high;     /* where it begins and ends */
    double at;            /* where the solid was cut */
    csg_outline contours; /* outer ones counter-clockwise, holes clockwise */
} csg_sliced_layer;

/* An empty page for such layers. */
csg_page csg_layers_page(csg_memory *memory, const csg_layers_head *head);
void csg_layers_release_page(csg_page *page);

/* Archives end at 4 GiB, and so does each file in them. */
#define CSG_LAYERS_ARCHIVE_BYTES 0xf0000000

typedef struct csg_layers_writer {
    void (*begin)(csg_page *page, const csg_layers_head *head);
    void (*layer)(csg_page *page, const csg_layers_head *head, const csg_sliced_layer *layer);
    void (*end)(csg_page *page, const csg_layers_head *head);
    bool has_masks;      /* pixels and entries are asked for */
    bool is_package;     /* what is put is the text of a 3MF package's model */
    size_t most_layers;  /* 0: any */
    uint64_t most_bytes; /* of all pages; 0: any */
} csg_layers_writer;

const csg_layers_writer *csg_layers_writer_of(csgm_layers_format format);

/* Is zlib there? */
bool csg_masks_available(void);

#define CSG_LAYERS(ID, name, title, remarks) extern const csg_layers_writer csg_layers_##name;
#include "io/layers/layers.def"
#undef CSG_LAYERS

#endif
