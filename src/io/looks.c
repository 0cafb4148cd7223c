/* SPDX-License-Identifier: MIT
 * Looks of parts; see looks.h. The names of colours are those that scenes use.
 */
#include "io/looks.h"

#include <math.h>
#include <stdio.h>

#include "io/adapter.h"

typedef struct named_color {
    const char *name;
    uint32_t rgb;
} named_color;

static const named_color named_colors[] = {
#define CSG_COLOR(name, rgb) {#name, rgb},
#include "lang/modules/colors.def"
};

csg_part_look csg_look_plain(void)
{
    csg_part_look look;
    memset(&look, 0, sizeof look); /* padding, too */
    look.material[0] = CSG_MATERIAL_METALLIC;
    look.material[1] = CSG_MATERIAL_ROUGHNESS;
    look.is_opaque = true;
    return look;
}

csg_part_look csg_look_of(const csgm_mesh_view *mesh, const csg_part_stretch *part)
{
    csg_part_look look = csg_look_plain();
    look.each_material = !csg_part_has_one_material(mesh, part, look.material);
    if (look.each_material)
        look.material[0] = look.material[1] = 0;
    if (!mesh->colors)
        return look;
    look.is_colored = true;
    const uint8_t *colors = mesh->colors + 4 * part->first_vertex;
    for (uint64_t i = 0; i < part->vertex_count; i++) {
        look.is_opaque &= colors[4 * i + 3] == 255;
        look.each_color |= memcmp(colors, colors + 4 * i, 4) != 0;
    }
    if (!look.each_color && part->vertex_count)
        memcpy(look.color, colors, 4);
    return look;
}

static int put_color(const csg_part_look *look, char *name, size_t room)
{
    if (!look->is_colored || look->each_color)
        return snprintf(name, room, look->is_colored ? "painted" : "plain");
    uint32_t rgb = (uint32_t)look->color[0] << 16 | (uint32_t)look->color[1] << 8 | look->color[2];
    for (size_t i = 0; i < sizeof named_colors / sizeof *named_colors; i++)
        if (named_colors[i].rgb == rgb)
            return snprintf(name, room, "%s", named_colors[i].name);
    return snprintf(name, room, "#%06X", (unsigned)rgb);
}

/* In percent; the same in all locales. */
static char *put_percent(char *at, const char *before, double value)
{
    size_t length = strlen(before);
    memcpy(at, before, length);
    return csg_number_put_fixed(at + length, value, 2);
}

void csg_look_name(const csg_part_look *look, char name[CSG_LOOK_NAME_MOST])
{
    const csg_part_look plain = csg_look_plain();
    char *at = name + put_color(look, name, CSG_LOOK_NAME_MOST / 2);
    if (look->each_color && !look->is_opaque)
        at = stpcpy(at, "-glass");
    else if (!look->is_opaque)
        at = put_percent(at, "-alpha", floor(look->color[3] * 1000 / 255.0 + 0.5) / 10);
    if (look->each_material) {
        at = stpcpy(at, "-finishes");
    } else if (memcmp(look->material, plain.material, sizeof plain.material) != 0) {
        at = put_percent(at, "-metal", look->material[0] / 100.0);
        at = put_percent(at, "-rough", look->material[1] / 100.0);
    }
    *at = '\0';
}
