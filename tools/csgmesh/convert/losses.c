/* SPDX-License-Identifier: MIT
 * What a format has no place for, in one warning per file. Normals are not counted: readers make
 * them of the triangles.
 */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "convert/convert.h"
#include "core/options.h"
#include "csgmesh/reshaping.h"

typedef struct list {
    char text[400];
    size_t length;
    int count;
} list;

__attribute__((format(printf, 2, 3))) static void add(list *l, const char *format, ...)
{
    va_list arguments;
    if (l->count++ && l->length < sizeof l->text)
        l->length += (size_t)snprintf(l->text + l->length, sizeof l->text - l->length, ", ");
    va_start(arguments, format);
    if (l->length < sizeof l->text)
        l->length +=
            (size_t)vsnprintf(l->text + l->length, sizeof l->text - l->length, format, arguments);
    va_end(arguments);
}

/* "names of parts (body, lid ...)". */
static void add_names(list *l, const csgm_mesh_view *mesh)
{
    enum { SHOWN = 4 };
    char names[200] = "";
    size_t named = 0, length = 0;
    for (size_t i = 0; i < mesh->part_count; i++) {
        const char *name = mesh->parts[i].name;
        if (!name || !*name)
            continue;
        if (named++ < SHOWN && length < sizeof names)
            length += (size_t)snprintf(names + length, sizeof names - length, "%s%.40s",
                                       named > 1 ? ", " : "", name);
    }
    if (named)
        add(l, "the name%s of %zu part%s (%s%s)", named > 1 ? "s" : "", named, named > 1 ? "s" : "",
            names, named > SHOWN ? " ..." : "");
    else if (mesh->part_count > 1)
        add(l, "which of %zu parts a triangle is of", (size_t)mesh->part_count);
}

static bool has_alpha(const csgm_mesh_view *mesh)
{
    for (uint64_t i = 0; i < mesh->vertex_count; i++)
        if (mesh->colors[4 * i + 3] != 255)
            return true;
    return false;
}

enum { LOOK_BYTES = 4 }; /* of a colour, and of a pair of metallic and roughness */

/* Do all corners of these triangles have one value? */
static bool is_plain(const csgm_mesh_view *mesh, const void *array, const csgm_mesh_part *part)
{
    const uint8_t *all = array;
    const uint32_t *corners = mesh->indices + 3 * part->first_triangle;
    for (uint64_t i = 0; i < 3 * part->triangle_count; i++)
        if (memcmp(all + (size_t)LOOK_BYTES * corners[i], all + (size_t)LOOK_BYTES * corners[0],
                   LOOK_BYTES) != 0)
            return false;
    return true;
}

static bool is_opaque(const csgm_mesh_view *mesh, const csgm_mesh_part *part)
{
    const uint32_t *corners = mesh->indices + 3 * part->first_triangle;
    for (uint64_t i = 0; i < 3 * part->triangle_count; i++)
        if (mesh->colors[LOOK_BYTES * (size_t)corners[i] + 3] != 255)
            return false;
    return true;
}

/* A part's colours say nothing of opacity where all are opaque. */
static bool are_plain(const csgm_mesh_view *mesh, const void *array)
{
    const csgm_mesh_part whole = {NULL, 0, mesh->triangle_count};
    uint64_t count = mesh->part_count ? mesh->part_count : 1;
    for (uint64_t i = 0; i < count; i++) {
        const csgm_mesh_part *part = mesh->part_count ? &mesh->parts[i] : &whole;
        bool is_told = array != mesh->colors || !is_opaque(mesh, part);
        if (is_told && !is_plain(mesh, array, part))
            return false;
    }
    return true;
}

/* What is kept of parts that look the same all over. */
static void add_looks(list *l, const csgm_mesh_view *mesh, uint32_t traits)
{
    bool keeps_plain = traits & CSGM_KEEPS_PLAIN_LOOKS;
    if (mesh->colors && !(traits & CSGM_KEEPS_COLORS))
        add(l, "colours");
    else if (mesh->colors && !(traits & CSGM_KEEPS_ALPHA) && has_alpha(mesh) &&
             !(keeps_plain && are_plain(mesh, mesh->colors)))
        add(l, "how transparent colours are");
    if (mesh->materials && !(traits & CSGM_KEEPS_MATERIALS)) {
        bool varies = keeps_plain && !are_plain(mesh, mesh->materials);
        if (varies || !keeps_plain)
            add(l, varies ? "metallic and roughness that vary within a part"
                          : "metallic and roughness");
    }
}

static void add_unit(list *l, const csgm_mesh *read, uint32_t traits)
{
    static const char *const names[] = {"", "", "centimetre", "metre", "inch"};
    csgm_unit unit;
    if (!(traits & CSGM_HEEDS_UNIT) && csgm_mesh_unit(read, &unit) && *names[unit])
        add(l, "the unit (%s)", names[unit]);
}

void cli_convert_warn_of_losses(cli_app *app, const csgm_mesh *read, const csgm_mesh_view *mesh,
                                const char *path, csgm_format format)
{
    uint32_t traits = csgm_format_traits(format);
    list lost = {.length = 0};
    const char *left_out = csgm_mesh_left_out(read);
    const char *name = strcmp(path, "-") == 0 ? "standard output" : path;
    if (mesh->part_count && !(traits & CSGM_KEEPS_NAMES))
        add_names(&lost, mesh);
    add_looks(&lost, mesh, traits);
    add_unit(&lost, read, traits);
    csgm_severity severity = app->options->warnings == 1 ? CSGM_ERROR : CSGM_WARNING;
    if (lost.count)
        cli_console_say(&app->console, severity, NULL, "%s: %s has no place for %s%s%s", name,
                        csgm_format_title(format), lost.text, left_out ? "; not read: " : "",
                        left_out ? left_out : "");
    else if (left_out)
        cli_console_say(&app->console, severity, NULL, "%s: lost, since it is not read: %s", name,
                        left_out);
}
