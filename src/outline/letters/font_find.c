/* SPDX-License-Identifier: MIT
 * Fonts by fontconfig; the only file that knows it. See font_find.h.
 */
#include "outline/letters/font_find.h"

#include <fontconfig/fontconfig.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct csg_font_finder {
    FcConfig *config;
};

csg_font_finder *csg_font_finder_create(void)
{
    csg_font_finder *finder = malloc(sizeof *finder);
    if (!finder)
        return NULL;
    finder->config = FcInitLoadConfigAndFonts();
    if (finder->config)
        return finder;
    free(finder);
    return NULL;
}

void csg_font_finder_destroy(csg_font_finder *finder)
{
    if (finder)
        FcConfigDestroy(finder->config);
    free(finder);
}

bool csg_font_finder_exists(void)
{
    return true;
}

bool csg_font_finder_add(csg_font_finder *finder, const char *path)
{
    return FcConfigAppFontAddFile(finder->config, (const FcChar8 *)path);
}

/* Does one of the strings of `found` stand among those of `asked`, or is nothing asked? */
static bool share_string(FcPattern *asked, FcPattern *found, const char *object)
{
    FcChar8 *a, *b;
    if (FcPatternGetString(asked, object, 0, &a) != FcResultMatch)
        return true;
    for (int i = 0; FcPatternGetString(asked, object, i, &a) == FcResultMatch; i++)
        for (int j = 0; FcPatternGetString(found, object, j, &b) == FcResultMatch; j++)
            if (FcStrCmpIgnoreCase(a, b) == 0)
                return true;
    return false;
}

static void copy_string(FcPattern *pattern, const char *object, char *out, size_t size)
{
    FcChar8 *text;
    bool has = FcPatternGetString(pattern, object, 0, &text) == FcResultMatch;
    snprintf(out, size, "%s", has ? (const char *)text : "");
}

static bool is_usable(FcPattern *found, uint32_t character)
{
    FcChar8 *format;
    FcCharSet *characters;
    if (FcPatternGetString(found, FC_FONTFORMAT, 0, &format) == FcResultMatch &&
        strcmp((char *)format, "TrueType") != 0 && strcmp((char *)format, "CFF") != 0)
        return false;
    return character == 0 ||
           (FcPatternGetCharSet(found, FC_CHARSET, 0, &characters) == FcResultMatch &&
            FcCharSetHasChar(characters, character));
}

/* The language of fontconfig's default comes from the environment; ours does not. */
static FcPattern *complete(FcConfig *config, FcPattern *asked, uint32_t character)
{
    FcPattern *pattern = FcPatternDuplicate(asked);
    FcCharSet *characters = FcCharSetCreate();
    FcValue value;
    if (pattern && characters) {
        if (character) {
            FcCharSetAddChar(characters, character);
            FcPatternAddCharSet(pattern, FC_CHARSET, characters);
        }
        if (FcPatternGet(pattern, FC_LANG, 0, &value) != FcResultMatch)
            FcPatternAddString(pattern, FC_LANG, (const FcChar8 *)"en");
        FcPatternAddBool(pattern, FC_SCALABLE, FcTrue);
        FcConfigSubstitute(config, pattern, FcMatchPattern);
        FcDefaultSubstitute(pattern);
    }
    if (characters)
        FcCharSetDestroy(characters);
    return pattern;
}

static void describe(FcPattern *asked, FcPattern *found, csg_font_place *out)
{
    int index = 0;
    FcPatternGetInteger(found, FC_INDEX, 0, &index);
    out->index = (unsigned)index;
    copy_string(found, FC_FILE, out->path, sizeof out->path);
    copy_string(found, FC_FAMILY, out->family, sizeof out->family);
    copy_string(found, FC_STYLE, out->style, sizeof out->style);
    out->same_family = share_string(asked, found, FC_FAMILY);
    out->same_style = share_string(asked, found, FC_STYLE);
}

bool csg_font_find(csg_font_finder *finder, const char *name, uint32_t character,
                   csg_font_place *out)
{
    FcResult result = FcResultNoMatch;
    FcPattern *asked = FcNameParse((const FcChar8 *)name);
    if (!asked)
        asked = FcPatternCreate();
    FcPattern *pattern = asked ? complete(finder->config, asked, character) : NULL;
    FcPattern *found = pattern ? FcFontMatch(finder->config, pattern, &result) : NULL;
    bool good = found && result == FcResultMatch && is_usable(found, character);
    if (good)
        describe(asked, found, out);
    if (found)
        FcPatternDestroy(found);
    if (pattern)
        FcPatternDestroy(pattern);
    if (asked)
        FcPatternDestroy(asked);
    return good;
}
