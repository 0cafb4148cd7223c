/* SPDX-License-Identifier: MIT
 * What a format has no place for, in one warning a file. Normals are not counted: readers make them
 * of the triangles.
 */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "convert/convert.h"

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

void cli_convert_warn_of_losses(cli_app *app, const csgm_mesh_view *mesh, const char *path,
                                csgm_format format)
{
    uint32_t traits = csgm_format_traits(format);
    list lost = {.length = 0};
    if (mesh->part_count && !(traits & CSGM_KEEPS_NAMES))
        add_names(&lost, mesh);
    if (mesh->colors && !(traits & CSGM_KEEPS_COLORS))
        add(&lost, "colours");
    else if (mesh->colors && !(traits & CSGM_KEEPS_ALPHA) && has_alpha(mesh))
        add(&lost, "how transparent colours are");
    if (mesh->materials && !(traits & CSGM_KEEPS_MATERIALS))
        add(&lost, "metallic and roughness");
    csgm_severity severity = app->options.warnings == 1 ? CSGM_ERROR : CSGM_WARNING;
    if (lost.count)
        cli_console_say(&app->console, severity, NULL, "%s: %s has no place for %s",
                        strcmp(path, "-") == 0 ? "standard output" : path,
                        csgm_format_title(format), lost.text);
}
