/* SPDX-License-Identifier: MIT
 * See threemf_package.h; Open Packaging Conventions (ECMA-376, part 2) as the 3MF core
 * specification, chapter 2, uses them.
 */
#include "io/threemf/threemf_package.h"

#include <string.h>

static void put_file(csg_zip *zip, const char *name, const char *text)
{
    csg_zip_file(zip, name);
    csg_zip_text(zip, text, strlen(text));
}

void csg_3mf_begin(csg_zip *zip)
{
    put_file(
        zip, "[Content_Types].xml",
        CSG_XML_HEAD
        "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\n"
        "<Default Extension=\"rels\" "
        "ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\n"
        "<Default Extension=\"model\" "
        "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/>\n</Types>\n");
    put_file(zip, "_rels/.rels",
             CSG_XML_HEAD
             "<Relationships "
             "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\n"
             "<Relationship Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
             "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>\n"
             "</Relationships>\n");
    csg_zip_file(zip, "3D/3dmodel.model");
}
