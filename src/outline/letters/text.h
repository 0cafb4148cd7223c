/* SPDX-License-Identifier: MIT
 * Text -> an outline, as text() of OpenSCAD 2021.01 sets it: a capital letter of size 10 is about
 * 10 high (an em is size * 100 / 72), and letters stand at 1000 / 1024 of the font's distances.
 * Beyond OpenSCAD: characters that the font lacks are taken from other fonts, scripts are set in
 * their own runs, those from right to left in their order (UAX #9, see bidi.h).
 */
#ifndef CSG_OUTLINE_TEXT_H
#define CSG_OUTLINE_TEXT_H

#include "outline/letters/fonts.h"
#include "outline/letters/text_request.h"

/* Loops as of csg_svg_outline (svg.h), but without that file's need of a library. CSGM_ERR_IO,
 * CSGM_ERR_FORMAT: a font file that cannot be read; CSGM_ERR_SCENE: no font at all;
 * CSGM_ERR_UNSUPPORTED. *out is initialised, and empty unless CSGM_OK. */
csgm_status csg_text_outline(csg_fonts *fonts, const csg_text_request *request, csg_outline *out,
                             csg_text_report *report);

/* fontmetrics(): of the font that text of this size would be set in. */
csgm_status csg_text_font_metrics(csg_fonts *fonts, const char *font, double size,
                                  csg_font_metrics *out, csg_text_report *report);

#endif
