/* SPDX-License-Identifier: MIT
 * What all 3MF packages begin with, whatever their model has: meshes (threemf_write.c) or slices
 * (io/layers/threemf_layers.c).
 */
#ifndef CSG_IO_THREEMF_PACKAGE_H
#define CSG_IO_THREEMF_PACKAGE_H

#include "io/threemf/zip_write.h"
#include "io/writers.h"

#define CSG_XML_HEAD "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
/* Of the element `model`: the language of its texts, and the namespace of the core specification.
 */
#define CSG_3MF_CORE                                                                               \
    "xml:lang=\"en-US\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\""
#define CSG_3MF_APPLICATION "<metadata name=\"Application\">" CSG_WRITTEN_BY "</metadata>\n"

/* The two small files that say where the model is; then the model's, to be filled with text. */
void csg_3mf_begin(csg_zip *zip);

#endif
