/* SPDX-License-Identifier: MIT
 * Finding and keeping fonts; see fonts.h and text.h.
 */
#include "outline/letters/fonts.h"

#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "outline/letters/font_find.h"

typedef struct open_font {
    char path[1024];
    unsigned index;
    csg_font *font;
    struct open_font *next;
} open_font;

struct csg_fonts {
    csg_memory *memory;
    csg_font_finder *finder; /* made at the first name */
    open_font *open;         /* the latest first */
    csg_font *latest;        /* that lent a character: text asks for many of one script */
    char latest_name[176];
};

csgm_status csg_fonts_create(csg_memory *memory, csg_fonts **out)
{
    *out = csg_memory_alloc(memory, sizeof **out);
    if (!*out)
        return CSGM_ERR_MEMORY;
    **out = (csg_fonts){.memory = memory};
    return CSGM_OK;
}

void csg_fonts_destroy(csg_fonts *fonts)
{
    if (!fonts)
        return;
    while (fonts->open) {
        open_font *next = fonts->open->next;
        csg_font_close(fonts->open->font);
        csg_memory_release(fonts->memory, fonts->open, sizeof *fonts->open);
        fonts->open = next;
    }
    csg_font_finder_destroy(fonts->finder);
    csg_memory_release(fonts->memory, fonts, sizeof *fonts);
}

csg_memory *csg_fonts_memory(const csg_fonts *fonts)
{
    return fonts->memory;
}

static csgm_status open_file(csg_fonts *fonts, const char *path, unsigned index, csg_font **out,
                             csg_problem *problem)
{
    csg_bytes bytes;
    for (open_font *o = fonts->open; o; o = o->next)
        if (o->index == index && strcmp(o->path, path) == 0) {
            *out = o->font;
            return CSGM_OK;
        }
    if (strlen(path) >= sizeof fonts->open->path)
        return csg_problem_set(problem, CSGM_ERR_IO, "the font file's path is too long");
    csgm_status status = csg_bytes_read(fonts->memory, path, &bytes, problem);
    if (status != CSGM_OK)
        return status;
    open_font *o = csg_memory_alloc(fonts->memory, sizeof *o);
    if (!o) {
        csg_bytes_release(&bytes);
        return CSGM_ERR_MEMORY;
    }
    *o = (open_font){.index = index, .next = fonts->open};
    snprintf(o->path, sizeof o->path, "%s", path);
    status = csg_font_open(&bytes, index, &o->font, problem);
    if (status != CSGM_OK) {
        csg_memory_release(fonts->memory, o, sizeof *o);
        return status;
    }
    fonts->open = o;
    *out = o->font;
    return CSGM_OK;
}

const char *csg_fonts_file(const csg_fonts *fonts, size_t index)
{
    size_t count = 0;
    for (const open_font *o = fonts->open; o; o = o->next)
        count++;
    const open_font *o = fonts->open;
    for (size_t i = index + 1; o && i < count; i++)
        o = o->next;
    return index < count ? o->path : NULL;
}

static csgm_status need_finder(csg_fonts *fonts, csg_problem *problem)
{
    if (!csg_font_finder_exists())
        return csg_problem_set(problem, CSGM_ERR_UNSUPPORTED,
                               "this build finds no fonts by name (made without fontconfig); name "
                               "a font file");
    if (!fonts->finder)
        fonts->finder = csg_font_finder_create();
    return fonts->finder ? CSGM_OK : CSGM_ERR_MEMORY;
}

csgm_status csg_fonts_add_file(csg_fonts *fonts, const char *path, csg_problem *problem)
{
    csg_font *font;
    csgm_status status = open_file(fonts, path, 0, &font, problem); /* says what is wrong with it */
    if (status == CSGM_OK)
        status = need_finder(fonts, problem);
    if (status == CSGM_OK && !csg_font_finder_add(fonts->finder, path))
        status =
            csg_problem_set(problem, CSGM_ERR_FORMAT, "the font file cannot be found by name here");
    return status;
}

static bool is_file_name(const char *name)
{
    static const char *const ends[] = {".ttf", ".otf", ".ttc", ".otc"};
    size_t length = strlen(name);
    for (size_t i = 0; i < 4 && length > 4; i++)
        if (strcasecmp(name + length - 4, ends[i]) == 0)
            return true;
    return strchr(name, '/') != NULL;
}

static void write_name(const csg_font_place *place, char *out, size_t size)
{
    snprintf(out, size, "%s%s%s", place->family, place->style[0] ? ":style=" : "", place->style);
}

csgm_status csg_fonts_choose(csg_fonts *fonts, const char *name, csg_font_choice *out,
                             csg_problem *problem)
{
    csg_font_place place;
    *out = (csg_font_choice){.font = NULL};
    if (name && *name && is_file_name(name)) {
        snprintf(out->name, sizeof out->name, "%s", name);
        return open_file(fonts, name, 0, &out->font, problem);
    }
    csgm_status status = need_finder(fonts, problem);
    if (status != CSGM_OK)
        return status;
    name = name && *name ? name : "Liberation Sans";
    if (!csg_font_find(fonts->finder, name, 0, &place)) {
        if (!csg_font_find(fonts->finder, "DejaVu Sans", 0, &place))
            return csg_problem_set(problem, CSGM_ERR_SCENE,
                                   "no TrueType or OpenType font is installed");
        place.same_family = false;
    }
    out->font_missing = !place.same_family;
    out->style_missing = place.same_family && !place.same_style;
    write_name(&place, out->name, sizeof out->name);
    return open_file(fonts, place.path, place.index, &out->font, problem);
}

csgm_status csg_fonts_choose_for(csg_fonts *fonts, const char *name, uint32_t character,
                                 csg_font_choice *out, csg_problem *problem)
{
    csg_font_place place;
    *out = (csg_font_choice){.font = NULL};
    if (fonts->latest && csg_font_has(fonts->latest, character)) {
        out->font = fonts->latest;
        memcpy(out->name, fonts->latest_name, sizeof out->name);
        return CSGM_OK;
    }
    if (!csg_font_finder_exists())
        return CSGM_OK;
    csgm_status status = need_finder(fonts, problem);
    if (status != CSGM_OK)
        return status;
    name = name && *name && !is_file_name(name) ? name : "Liberation Sans";
    if (!csg_font_find(fonts->finder, name, character, &place))
        return CSGM_OK;
    csg_problem unused = {""}; /* a broken fallback is none */
    status = open_file(fonts, place.path, place.index, &out->font, &unused);
    if (status != CSGM_OK || !csg_font_has(out->font, character)) {
        out->font = NULL;
        return status == CSGM_ERR_MEMORY ? status : CSGM_OK;
    }
    write_name(&place, out->name, sizeof out->name);
    fonts->latest = out->font;
    memcpy(fonts->latest_name, out->name, sizeof out->name);
    return CSGM_OK;
}
