/* SPDX-License-Identifier: MIT
 * FreeType's own options without what no outline of a TrueType font needs: pictures and colours of
 * glyphs, names of glyphs, resource forks.
 */
#ifndef CSGMESH_FREETYPE_OPTIONS_H
#define CSGMESH_FREETYPE_OPTIONS_H

#include <freetype/config/ftoption.h>

#undef FT_CONFIG_OPTION_GUESSING_EMBEDDED_RFORK
#undef FT_CONFIG_OPTION_INCREMENTAL
#undef FT_CONFIG_OPTION_MAC_FONTS
#undef FT_CONFIG_OPTION_POSTSCRIPT_NAMES
#undef FT_CONFIG_OPTION_SUBPIXEL_RENDERING
#undef FT_CONFIG_OPTION_SVG
#undef TT_CONFIG_OPTION_BDF
#undef TT_CONFIG_OPTION_COLOR_LAYERS
#undef TT_CONFIG_OPTION_EMBEDDED_BITMAPS
#undef TT_CONFIG_OPTION_POSTSCRIPT_NAMES
#undef TT_SUPPORT_COLRV1

#endif
