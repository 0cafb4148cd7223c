/* SPDX-License-Identifier: MIT
 * Formats of layers, and what their writers share; see layers.h.
 */
#include "io/layers/layers.h"

#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/elementary.h"
#include "io/adapter.h"

static const struct {
    const char *name;
    const csg_layers_writer *writer;
} rows[] = {
    [CSGM_LAYERS_NONE] = {"none", NULL},
#define CSG_LAYERS(ID, name, title, remarks) [CSGM_LAYERS_##ID] = {#name, &csg_layers_##name},
#include "io/layers/layers.def"
#undef CSG_LAYERS
};

_Static_assert(sizeof rows / sizeof *rows == CSGM_LAYERS_COUNT, "a row for each format");

csgm_layers_format csg_layers_format_from_name(const char *name)
{
    for (int i = 1; name && i < CSGM_LAYERS_COUNT; i++)
        if (strcasecmp(rows[i].name, name) == 0)
            return (csgm_layers_format)i;
    return CSGM_LAYERS_NONE;
}

csgm_layers_format csg_layers_format_from_path(const char *path)
{
    const char *dot = path ? strrchr(path, '.') : NULL;
    return dot && !strchr(dot, '/') ? csg_layers_format_from_name(dot + 1) : CSGM_LAYERS_NONE;
}

const char *csg_layers_format_name(csgm_layers_format format)
{
    return (int)format > 0 && format < CSGM_LAYERS_COUNT ? rows[format].name : rows[0].name;
}

bool csg_layers_format_available(csgm_layers_format format)
{
    return (int)format > CSGM_LAYERS_NONE && format < CSGM_LAYERS_COUNT &&
           (!rows[format].writer->has_masks || csg_masks_available()) &&
           (!rows[format].writer->is_package || csg_package_available());
}

const csg_layers_writer *csg_layers_writer_of(csgm_layers_format format)
{
    return rows[format].writer;
}

/* A thousandth of the tolerance is the last digit: points that are apart stay apart; of the lowest
 * layer's height, if that is less: so do layers. */
csg_page csg_layers_page(csg_memory *memory, const csg_layers_head *head)
{
    csg_page page = {.memory = memory, .scale = head->scale};
    double digits = 3 - floor(csg_log10(fmin(head->tolerance, head->lowest) * head->scale));
    page.decimals = (int)fmin(fmax(digits, 0), 15);
    page.box = (csg_box){csg_vec3_scale(head->box.min, head->scale),
                         csg_vec3_scale(head->box.max, head->scale)};
    return page;
}

void csg_layers_release_page(csg_page *page)
{
    csg_memory_release(page->memory, page->data, page->capacity);
}
